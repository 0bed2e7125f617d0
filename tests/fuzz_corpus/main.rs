//! The corpus of `fuzz/`, file by file, through the checks of the fuzzer: no tool is needed for that.

#[path = "../../fuzz/src/checks/mod.rs"]
mod checks;
#[allow(dead_code, reason = "the seeds need a part of it")]
#[path = "../formats/fixtures.rs"]
mod fixtures;
#[path = "../formats/gltf_parts.rs"]
mod gltf_parts;
#[path = "../formats/ply_writer.rs"]
mod ply_writer;
#[path = "../hostile_input/samples.rs"]
mod samples;
mod seeds;

use checks::{Desk, Outcome, Target, assert_whole};
use lightbuffer::scene::{ObjectInput, Scene, SceneBuilder};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A second is the limit of the fuzzer, without debug assertions of everything and with a machine to itself.
const LONGEST: Duration = Duration::from_secs(10);

fn fuzz() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz")
}

/// Names and bytes of what lies in a folder, sorted.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = folder.read_dir().unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = entries
        .map(|entry| {
            let entry = entry.unwrap();
            (entry.file_name().into_string().unwrap(), std::fs::read(entry.path()).unwrap())
        })
        .collect();
    files.sort();
    files
}

/// Replays the corpus of a target. What is called valid must load, what is called refused must not.
fn replay(target: Target) {
    let mut desk = Desk::new();
    let mut valid = 0;
    for (name, input) in files(&fuzz().join("corpus").join(target.name())) {
        let start = Instant::now();
        println!("{}/{name}", target.name());
        match (target.check(&input, &mut desk), name.split_once('-').map(|(kind, _)| kind)) {
            (Outcome::Loaded, Some("valid")) => valid += 1,
            (Outcome::Refused(_), Some("refused")) => {}
            (Outcome::Loaded | Outcome::Refused(_), Some("finding")) => {}
            (outcome, _) => panic!("{name}: {outcome:?}; names begin with valid-, refused- or finding-"),
        }
        assert!(start.elapsed() < LONGEST, "{name} took {:?}", start.elapsed());
    }
    assert!(valid > 0, "a fuzzer that begins with nothing valid finds little");
}

macro_rules! replays {
    ($($test:ident: $target:ident,)*) => {
        $(#[test] fn $test() { replay(Target::$target); })*

        const REPLAYED: &[Target] = &[$(Target::$target),*];
    };
}

replays! {
    obj: Obj,
    ply: Ply,
    nff: Nff,
    gltf: Gltf,
    glb: Glb,
    toml: Toml,
    picture: Picture,
    shadow_buffer: ShadowBuffer,
    exr: Exr,
}

#[test]
fn every_target_is_replayed_and_has_a_program_and_a_dictionary() {
    let mut names: Vec<String> = Target::ALL.map(|target| target.name().into()).to_vec();
    names.sort();
    assert!(Target::ALL.iter().all(|target| REPLAYED.contains(target)));
    let folders = fuzz().join("corpus").read_dir().unwrap();
    let mut folders: Vec<_> = folders.map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    folders.sort();
    assert_eq!(folders, names);
    for (folder, ending) in [("fuzz_targets", ".rs"), ("dictionaries", ".dict")] {
        let files = files(&fuzz().join(folder));
        let files: Vec<_> =
            files.iter().map(|(name, _)| name.strip_suffix(ending).unwrap().replace('_', "-")).collect();
        assert_eq!(files, names, "{folder}");
    }
}

/// Not a test: `cargo test --test fuzz_corpus -- --ignored` writes the seeds anew, after a format has changed.
#[test]
#[ignore = "writes fuzz/corpus"]
fn write_the_seeds() {
    seeds::write(&fuzz().join("corpus"));
}

/// The targets are built with `--locked`, so what this crate depends on must be in their lock file too.
#[test]
fn the_lock_file_of_the_targets_knows_what_we_depend_on() {
    let read = |path: &Path| std::fs::read_to_string(path).unwrap().parse::<toml::Table>().unwrap();
    let manifest = read(&fuzz().join("../Cargo.toml"));
    let lock = read(&fuzz().join("Cargo.lock"));
    let is_ours = |package: &&toml::Value| package["name"].as_str() == Some("lightbuffer");
    let ours = lock["package"].as_array().unwrap().iter().find(is_ours).expect("the crate itself");
    let locked: Vec<&str> =
        ours["dependencies"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    let optional =
        |dependency: &toml::Value| dependency.get("optional").is_some_and(|o| o.as_bool() == Some(true));
    for (name, dependency) in manifest["dependencies"].as_table().unwrap() {
        let known = locked.iter().any(|entry| entry.split(' ').next() == Some(name));
        assert!(known || optional(dependency), "{name}: say `cargo update --workspace` in fuzz/");
    }
}

#[test]
fn the_corpus_stays_small() {
    let all = Target::ALL.iter().flat_map(|target| files(&fuzz().join("corpus").join(target.name())));
    let bytes: usize = all.map(|(_, bytes)| bytes.len()).sum();
    assert!(bytes < 300_000, "{bytes} bytes");
}

fn triangle() -> Scene {
    let mut builder = SceneBuilder::new("a triangle");
    let corners = vec![glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y];
    builder.add_object(ObjectInput::new("it", corners, vec![[0, 1, 2]])).unwrap();
    builder.finish()
}

/// What the checks are for: each of these scenes has a defect that a loader must not let through.
#[test]
fn the_checks_see_defects() {
    assert_whole(&triangle());
    let defects: [fn(&mut Scene); 8] = [
        |scene| scene.vertices[1].y = f32::NAN,
        |scene| scene.triangles[0].vertices[2] = 3,
        |scene| scene.triangles[0].object = 1,
        |scene| scene.objects[0].count = 0,
        |scene| scene.objects[0].material = 1,
        |scene| scene.objects[0].name = "two\nlines".into(),
        |scene| scene.materials[0].diffuse[1] = f32::INFINITY,
        |scene| scene.warnings.push("\u{1b}[31m".into()),
    ];
    for (number, defect) in defects.into_iter().enumerate() {
        let mut scene = triangle();
        defect(&mut scene);
        assert!(std::panic::catch_unwind(|| assert_whole(&scene)).is_err(), "defect {number} is not seen");
    }
}

/// Without mending, a changed byte tests the checksum and nothing behind it.
#[test]
fn mended_files_are_read_to_the_end() {
    let mut desk = Desk::new();
    let mut check = |mut input: Vec<u8>, at: usize, how: u8| {
        input[0] = how;
        input[at] ^= 1;
        matches!(Target::ShadowBuffer.check(&input, &mut desk), Outcome::Loaded)
    };
    let valid = checks::shadow_buffer::valid_inputs().remove(0);
    let last = valid.len() - 1;
    assert!(!check(valid.clone(), 60, b'r') && check(valid.clone(), 60, b'c'));
    assert!(!check(valid.clone(), 20, b'c') && check(valid.clone(), 20, b'h'));
    assert!(!check(valid.clone(), last, b'r') && check(valid, last, b'c'));
    let png = std::fs::read(fuzz().join("corpus/picture/valid-mask")).unwrap();
    let mut spoilt = png[1..].to_vec();
    let end = spoilt.len() - 1;
    spoilt[end] ^= 1;
    spoilt[0] = 0;
    assert_eq!(checks::mend::png(&spoilt), png[1..]);
}
