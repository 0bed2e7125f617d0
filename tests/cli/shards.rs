//! `render --shard`, `render --resume` and `merge`: many processes write what one would have written.

use crate::{Folder, Run, json, lightbuffer, names};
use lightbuffer::film::read_exr;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const CAROUSEL: &str = "scenes/carousel.toml";
/// Five blocks of 16 rows, the last of them of 6.
const TALL: [&str; 2] = ["--size", "40x70"];
const HEIGHT: u64 = 70;

fn render(scene: &str, out: &Path, options: &[&str]) -> Run {
    let arguments = ["render", scene, "-q", "-o", out.to_str().unwrap()];
    lightbuffer(arguments.iter().chain(options))
}

fn merge(options: &[&str], shards: &[PathBuf]) -> Run {
    let shards = shards.iter().map(|path| path.to_str().unwrap());
    lightbuffer(["merge", "-q"].into_iter().chain(options.iter().copied()).chain(shards))
}

fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Draws all shards of a picture and returns those of their files that are there.
fn strips(folder: &Folder, scene: &str, of: usize, options: &[&str]) -> Vec<PathBuf> {
    let out = folder.path("part.exr");
    for index in 1..=of {
        // By no order and any number of threads.
        let (shard, threads) = (format!("{index}/{of}"), (1 + index % 3).to_string());
        let facts = folder.path(&format!("part.{index}-of-{of}.json"));
        let own = ["--shard", &shard, "-t", &threads, "--json", facts.to_str().unwrap()];
        render(scene, &out, &[options, &own].concat()).done();
    }
    let strip = |index| folder.path(&format!("part.shard-{index}-of-{of}.exr"));
    (1..=of).map(strip).filter(|path| path.exists()).collect()
}

#[test]
fn strips_of_any_number_are_the_bytes_of_a_single_process() {
    let verdict = ["--exposure", "1.25"];
    let without = ["--no-verdict", "--shadow", "auto"];
    let fine = ["--no-verdict", "--subdivide", "2", "--corner-rays", "--no-textures"];
    let soft = ["--no-verdict", "--shadow", "shadow-buffer", "--shadow-buffer-filter", "3"];
    let cases: [(&str, &[&str], &[usize]); 6] = [
        (CAROUSEL, &verdict, &[1, 2, 3, 7]),
        (CAROUSEL, &without, &[1, 2, 3, 7]),
        (CAROUSEL, &fine, &[3]),
        (CAROUSEL, &soft, &[2]),
        // Mirrors: points of all levels are asked.
        ("builtin:three-spheres", &[], &[3]),
        (CAROUSEL, &["--no-shadows", "--first-hits", "hierarchy"], &[2]),
    ];
    for (scene, options, counts) in cases {
        let folder = Folder::new();
        let options = [&TALL[..], options].concat();
        let whole = folder.path("whole.exr");
        render(scene, &whole, &[&options[..], &["-t", "2"]].concat()).done();
        for &of in counts {
            let mut shards = strips(&folder, scene, of, &options);
            assert_eq!(shards.len(), of.min(5));
            shards.reverse();
            let merged = folder.path("merged.exr");
            merge(&["-o", merged.to_str().unwrap()], &shards).done();
            assert!(bytes(&merged) == bytes(&whole), "{scene} {options:?} {of}");
            assert!(
                bytes(&folder.path("merged.png")) == bytes(&folder.path("whole.png")),
                "{options:?} {of}"
            );
        }
    }
}

#[test]
fn a_strip_is_the_rows_of_the_whole_in_bits_and_says_where_they_belong() {
    let folder = Folder::new();
    render(CAROUSEL, &folder.path("whole.exr"), &TALL).done();
    let whole = read_exr(&folder.path("whole.exr")).unwrap();
    let mut next = 0;
    for path in strips(&folder, CAROUSEL, 3, &TALL) {
        let strip = read_exr(&path).unwrap();
        let window = strip.window().unwrap();
        assert_eq!((window.of, window.first_row), (whole.size(), next));
        assert_eq!(strip.channels().len(), whole.channels().len());
        let first = (next * 40) as usize;
        for plane in strip.channels() {
            let bits = |samples: &[f32]| samples.iter().map(|s| s.to_bits()).collect::<Vec<_>>();
            let expected = &whole.channel(&plane.name).unwrap()[first..first + strip.size().pixels()];
            assert!(bits(&plane.samples) == bits(expected), "{} from row {next}", plane.name);
        }
        next += strip.size().height;
    }
    assert_eq!(u64::from(next), HEIGHT);
}

#[test]
fn more_shards_than_blocks_leave_some_with_nothing_to_do() {
    let folder = Folder::new();
    let out = folder.path("x.exr");
    let facts = folder.path("x.json");
    let arguments = ["render", CAROUSEL, "--no-verdict", "--shard", "7/7", "--json", facts.to_str().unwrap()];
    let run = lightbuffer(arguments.iter().copied().chain(TALL).chain(["-o", out.to_str().unwrap()])).done();
    assert!(run.stderr.contains("shard 7/7: nothing to draw"), "{}", run.stderr);
    assert_eq!(names(&folder.path("")), ["x.json", "x.shard-7-of-7.manifest.json"]);
    assert_eq!(json(&String::from_utf8(bytes(&facts)).unwrap())["shard"]["rows"]["count"], 0);
}

#[test]
fn merge_refuses_what_is_missing_doubled_or_foreign_and_writes_nothing() {
    let folder = Folder::new();
    let options = [&TALL[..], &["--no-verdict"]].concat();
    let shards = strips(&folder, CAROUSEL, 3, &options);
    let out = folder.path("out/merged.exr");
    std::fs::create_dir(folder.path("out")).unwrap();
    let refused = |shards: &[PathBuf], words: &[&str]| {
        let line = merge(&["-o", out.to_str().unwrap()], shards).failed();
        assert!(words.iter().all(|words| line.contains(words)), "{line}");
        assert!(names(&folder.path("out")).is_empty());
    };
    let [top, middle, bottom] = [0, 1, 2].map(|i| shards[i].clone());
    refused(&[top.clone(), bottom.clone()], &["rows 32 to 63 are missing"]);
    refused(&[bottom.clone(), middle.clone()], &["rows 0 to 31 are missing"]);
    refused(&[top.clone(), middle.clone()], &["rows 64 to 69 are missing"]);
    refused(
        &[top.clone(), middle.clone(), bottom.clone(), middle.clone()],
        &["part.shard-2-of-3.exr: ", "rows 32 to 63 are in ", " too"],
    );
    // In a folder of their own: they have the same names.
    let others: [(&str, &[&str], &str); 5] = [
        ("depth", &["--depth", "2"], "depth is `2`, expected `5`"),
        ("tester", &["--shadow", "brute-force"], "shadow is `brute-force`, expected `light-buffer`"),
        ("exposure", &["--exposure", "1"], "exposure is `1.0`, expected `0.0`"),
        ("light", &["--light", "0,7,1"], "lights is `0.0,7.0,1.0: light-1`, expected `those of the scene: "),
        ("resolution", &["--resolution", "64"], "resolution is `64`, expected `auto`"),
    ];
    for (name, other, words) in others {
        let foreign = folder.path(&format!("{name}.exr"));
        render(CAROUSEL, &foreign, &[&options[..], other, &["--shard", "2/3"]].concat()).done();
        let foreign = folder.path(&format!("{name}.shard-2-of-3.exr"));
        refused(&[top.clone(), foreign, bottom.clone()], &[&format!("{name}.shard-2-of-3.exr: "), words]);
    }
    // One byte of the scene's file that no shadow depends on.
    let text =
        String::from_utf8(bytes(Path::new(CAROUSEL))).unwrap().replacen("diffuse = 0.6", "diffuse = 0.5", 1);
    let scene = folder.write("carousel.toml", text);
    let foreign = folder.path("scene.exr");
    render(scene.to_str().unwrap(), &foreign, &[&options[..], &["--shard", "2/3"]].concat()).done();
    refused(
        &[top.clone(), folder.path("scene.shard-2-of-3.exr"), bottom],
        &["another picture: sceneFiles is"],
    );
    let whole = folder.path("whole.exr");
    render(CAROUSEL, &whole, &options).done();
    refused(&[whole], &["whole.exr: no shard of render"]);
    refused(&[folder.path("none.exr")], &["none.exr: cannot open"]);
    let facts = folder.path("part.1-of-3.json");
    refused(std::slice::from_ref(&facts), &["-o: expected OpenEXR files of shards"]);
    refused(&[top.clone(), facts], &["part.1-of-3.json: there is no --json for JSON files"]);
    merge(&["-o", top.to_str().unwrap()], std::slice::from_ref(&top)).failed();
    assert!(read_exr(&top).unwrap().window().is_some());
}

#[test]
fn facts_of_strips_become_those_of_the_picture() {
    let folder = Folder::new();
    let whole = folder.path("whole.json");
    render(CAROUSEL, &folder.path("whole.exr"), &[&TALL[..], &["--json", whole.to_str().unwrap()]].concat())
        .done();
    strips(&folder, CAROUSEL, 7, &TALL);
    let documents: Vec<PathBuf> =
        (1..=7).rev().map(|i| folder.path(&format!("part.{i}-of-7.json"))).collect();
    let merged = json(&merge(&["--json", "-"], &documents).done().stdout);
    let whole = json(&String::from_utf8(bytes(&whole)).unwrap());
    for (light, expected) in
        merged["lights"].as_array().unwrap().iter().zip(whole["lights"].as_array().unwrap())
    {
        for key in ["name", "queries", "facing_away", "outside_cone", "not_receiving", "shadowed"] {
            assert_eq!(light[key], expected[key], "{key}");
        }
    }
    assert_eq!(merged["lights"].as_array().unwrap().len(), 2);
    assert_eq!((&merged["height"], merged["shards"].as_array().unwrap().len()), (&HEIGHT.into(), 7));
    let line = merge(&["--json", "-"], &documents[..6]).failed();
    assert!(line.contains("rows 0 to 15 are missing"), "{line}");
    let line = merge(&["--json", "-"], &[&documents[..], &documents[6..]].concat()).failed();
    assert!(line.contains("rows 0 to 15 are in another document too"), "{line}");
}

/// Frames of the carousel, by name and content.
fn frames(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let pictures = names(folder).into_iter().filter(|name| name.ends_with(".exr") || name.ends_with(".png"));
    pictures.map(|name| (name.clone(), bytes(&folder.join(name)))).collect()
}

const FRAMES: [&str; 5] = ["--size", "32x36", "--no-verdict", "--frames", "1-4,7,12-14"];

/// Folders of a name each, and a file in them.
fn inside(folder: &Folder, name: &str) -> (PathBuf, PathBuf) {
    let inner = folder.path(name);
    std::fs::create_dir(&inner).unwrap();
    let out = inner.join("f.##.exr");
    (inner, out)
}

#[test]
fn shards_by_frames_are_the_files_of_a_single_process_and_one_document() {
    let folder = Folder::new();
    let (whole, out) = inside(&folder, "whole");
    let facts = render(CAROUSEL, &out, &[&FRAMES[..], &["--json", "-"]].concat()).done().stdout;
    let facts = json(&facts);
    let expected = frames(&whole);
    assert_eq!(expected.len(), 16);
    for of in [1, 3, 9] {
        let (parts, out) = inside(&folder, &format!("parts-{of}"));
        let document = |index: usize| parts.join(format!("{index}.json"));
        for index in 1..=of {
            let (shard, threads) = (format!("{index}/{of}"), (1 + index % 2).to_string());
            let own = ["--shard", &shard, "-t", &threads, "--json", document(index).to_str().unwrap()]
                .map(str::to_owned);
            let own: Vec<&str> = own.iter().map(String::as_str).collect();
            render(CAROUSEL, &out, &[&FRAMES[..], &own].concat()).done();
        }
        assert!(frames(&parts) == expected, "{of} shards");
        let documents: Vec<PathBuf> = (1..=of).rev().map(document).collect();
        let merged = json(&merge(&["--json", "-"], &documents).done().stdout);
        let numbers = |facts: &Value| -> Vec<u64> {
            facts["frames"].as_array().unwrap().iter().map(|frame| frame["frame"].as_u64().unwrap()).collect()
        };
        assert_eq!(numbers(&merged), numbers(&facts));
        for (one, other) in
            merged["frames"].as_array().unwrap().iter().zip(facts["frames"].as_array().unwrap())
        {
            for light in 0..2 {
                assert_eq!(one["lights"][light]["shadowed"], other["lights"][light]["shadowed"]);
            }
        }
        if of == 3 {
            let line = merge(&["--json", "-"], &documents[..2]).failed();
            assert!(line.contains("3 of 8 frames are missing, frame 1 first"), "{line}");
            let line = merge(&["--json", "-"], &[&documents[..], &documents[..1]].concat()).failed();
            assert!(line.contains("frame 13 is in ") && line.contains("3.json too"), "{line}");
            let text = String::from_utf8(bytes(&documents[0])).unwrap();
            let foreign = parts.join("foreign.json");
            std::fs::write(&foreign, text.replace("\"depth\": \"5\"", "\"depth\": \"4\"")).unwrap();
            let line = merge(&["--json", "-"], &[documents[1].clone(), foreign.clone()]).failed();
            assert!(line.contains("foreign.json: ") && line.contains("depth is `4`, expected `5`"), "{line}");
            for text in ["", "{}", "[1]", "{\"frames\": 3}", "{\"lights\": []}"] {
                std::fs::write(&foreign, text).unwrap();
                let line = merge(&["--json", "-"], std::slice::from_ref(&foreign)).failed();
                assert!(line.contains("expected facts of a shard of render"), "{line}");
            }
        }
    }
}

#[test]
fn frames_by_tiles_merge_frame_by_frame() {
    let folder = Folder::new();
    let (whole, out) = inside(&folder, "whole");
    let options = ["--size", "32x36", "--no-verdict", "--frames", "3,12"];
    render(CAROUSEL, &out, &options).done();
    let (parts, out) = inside(&folder, "parts");
    for shard in ["1/2", "2/2"] {
        let facts = parts.join(format!("{}.json", &shard[..1]));
        let own = ["--shard", shard, "--shard-by", "tiles", "--json", facts.to_str().unwrap()];
        render(CAROUSEL, &out, &[&options[..], &own].concat()).done();
    }
    for frame in ["03", "12"] {
        let shards = [1, 2].map(|index| parts.join(format!("f.{frame}.shard-{index}-of-2.exr")));
        let merged = parts.join(format!("merged.{frame}.exr"));
        merge(&["-o", merged.to_str().unwrap()], &shards).done();
        assert!(bytes(&merged) == bytes(&whole.join(format!("f.{frame}.exr"))), "{frame}");
    }
    let mixed = [parts.join("f.03.shard-1-of-2.exr"), parts.join("f.12.shard-2-of-2.exr")];
    let line = merge(&["-o", folder.path("x.exr").to_str().unwrap()], &mixed).failed();
    assert!(line.contains("of another picture: frame is `12`, expected `3`"), "{line}");
    let merged = json(&merge(&["--json", "-"], &[parts.join("2.json"), parts.join("1.json")]).done().stdout);
    assert_eq!(merged["frames"].as_array().unwrap().len(), 2);
}

#[test]
fn shards_that_cannot_be_are_refused() {
    let folder = Folder::new();
    let out = folder.path("x.exr");
    for bad in ["0/3", "4/3", "1", "1/0", "x/y"] {
        render(CAROUSEL, &out, &["--shard", bad]).misused("I/N");
    }
    render(CAROUSEL, &out, &["--shard", "1/2", "--shard-by", "frames"]).misused("say --frames");
    render(CAROUSEL, &out, &["--shard-by", "tiles"]).misused("--shard");
    let save = ["--shadow", "shadow-buffer", "--save-shadow-buffers", "buffers"];
    render(CAROUSEL, &out, &[&save[..], &["--shard", "1/2"]].concat()).misused("cannot be used with");
    render(CAROUSEL, &out, &[&save[..], &["--resume"]].concat()).misused("cannot be used with");
    assert!(names(&folder.path("")).is_empty());
}

/// Pictures that a manifest lists, which must be there as it says.
fn listed(manifest: &Path) -> Vec<String> {
    let content = json(&String::from_utf8(bytes(manifest)).unwrap());
    let pictures = content["pictures"].as_object().unwrap();
    for (name, picture) in pictures {
        for (kind, file) in [("exr", name.clone()), ("png", name.replace(".exr", ".png"))] {
            let found = bytes(&manifest.with_file_name(file));
            assert_eq!(picture[kind]["bytes"], found.len());
            assert_eq!(picture[kind]["crc32"], crc32fast::hash(&found));
        }
    }
    pictures.keys().cloned().collect()
}

/// A run of many frames, and its end by a signal once so many are recorded.
fn stopped(out: &Path, options: &[&str], signal: &str, recorded: usize) -> std::process::ExitStatus {
    let mut command = Command::new("env");
    command.arg("--default-signal=INT,TERM").arg(env!("CARGO_BIN_EXE_lightbuffer"));
    command.args(["render", CAROUSEL, "-q", "-o"]).arg(out).args(options);
    command.current_dir(env!("CARGO_MANIFEST_DIR")).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child: Child = command.spawn().unwrap();
    let manifest = out.with_file_name("f.manifest.json");
    let count = || {
        let text = std::fs::read_to_string(&manifest).unwrap_or_default();
        serde_json::from_str::<Value>(&text)
            .map_or(0, |content| content["pictures"].as_object().unwrap().len())
    };
    let began = Instant::now();
    while count() < recorded && began.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(2));
    }
    let sent = Command::new("kill").arg(format!("-{signal}")).arg(child.id().to_string()).status().unwrap();
    assert!(sent.success());
    child.wait().unwrap()
}

#[cfg(unix)]
#[test]
fn a_killed_run_goes_on_and_leaves_finished_files_as_they_are() {
    use std::os::unix::fs::MetadataExt;
    use std::os::unix::process::ExitStatusExt;
    let folder = Folder::new();
    let options = ["--size", "48x36", "--frames", "1-60"];
    let (whole, out) = inside(&folder, "whole");
    render(CAROUSEL, &out, &options).done();
    let (part, out) = inside(&folder, "part");
    let manifest = part.join("f.manifest.json");
    for signal in ["KILL", "TERM"] {
        let before = if manifest.exists() { listed(&manifest).len() } else { 0 };
        let status = stopped(&out, &[&options[..], &["--resume"]].concat(), signal, before + 4);
        assert!(status.signal().is_some(), "{status}");
        let finished = listed(&manifest);
        assert!((before + 4..60).contains(&finished.len()), "{}", finished.len());
        // At most the picture that it was at is lost: none is there that is not recorded, but for one.
        let there = names(&part).into_iter().filter(|name| name.ends_with(".exr")).count();
        assert!(there <= finished.len() + 1, "{there} files, {} recorded", finished.len());
    }
    let state = |name: &String| {
        let state = std::fs::metadata(part.join(name)).unwrap();
        (state.ino(), state.mtime(), state.mtime_nsec())
    };
    let finished = listed(&manifest);
    let before: Vec<_> = finished.iter().map(state).collect();
    let arguments = ["render", CAROUSEL, "-o", out.to_str().unwrap(), "--resume", "--json", "-"];
    let run = lightbuffer(arguments.iter().chain(&options)).done();
    assert_eq!(finished.iter().map(state).collect::<Vec<_>>(), before);
    assert!(
        run.stderr.contains(&format!("{} of 60 pictures are finished", finished.len())),
        "{}",
        run.stderr
    );
    assert!(frames(&part) == frames(&whole));
    assert_eq!((json(&run.stdout)["frames"].as_array().unwrap().len(), listed(&manifest).len()), (60, 60));
    // A file that is not as recorded is drawn again, and no other.
    std::fs::write(part.join("f.07.png"), "damaged").unwrap();
    std::fs::remove_file(part.join("f.09.exr")).unwrap();
    let run = lightbuffer(arguments.iter().chain(&options)).done();
    assert!(run.stderr.contains("58 of 60 pictures are finished"), "{}", run.stderr);
    assert!(frames(&part) == frames(&whole));
    assert_eq!(
        finished.iter().filter(|name| name.as_str() < "f.07").map(state).collect::<Vec<_>>(),
        before[..6]
    );
}

#[test]
fn other_settings_than_recorded_are_refused_and_a_run_without_resume_starts_anew() {
    let folder = Folder::new();
    let out = folder.path("f.##.exr");
    let run =
        |options: &[&str]| render(CAROUSEL, &out, &[&["--size", "16x16", "--no-verdict"], options].concat());
    run(&["--frames", "1-2"]).done();
    let manifest = folder.path("f.manifest.json");
    assert_eq!(listed(&manifest), ["f.01.exr", "f.02.exr"]);
    let before = bytes(&manifest);
    for (options, words) in [
        (&["--depth", "1"][..], "depth is `5`, expected `1` by this run"),
        (&["--fps", "25"], "framesPerSecond is `24`, expected `25`"),
        (&["--light", "1,2,3"], "lights is `those of the scene: "),
    ] {
        let line = run(&[&["--frames", "1-2", "--resume"], options].concat()).failed();
        assert!(line.contains("f.manifest.json: ") && line.contains(words), "{line}");
        assert!(bytes(&manifest) == before);
    }
    // More frames of the same: those that are there stay.
    run(&["--frames", "1-3", "--resume"]).done();
    assert_eq!(listed(&manifest).len(), 3);
    run(&["--frames", "2", "--depth", "1"]).done();
    assert_eq!(listed(&manifest), ["f.02.exr"]);
    std::fs::write(&manifest, "{\"settings\": {}, \"pictures\": 1}").unwrap();
    let line = run(&["--frames", "2", "--resume"]).failed();
    assert!(line.contains("expected the manifest of a run of render"), "{line}");
}

#[test]
fn a_single_picture_and_a_strip_are_resumed_too() {
    let folder = Folder::new();
    let options = [&TALL[..], &["--no-verdict", "--resume", "--json", "-"]].concat();
    for (shard, manifest) in
        [(&[][..], "x.manifest.json"), (&["--shard", "2/3"], "x.shard-2-of-3.manifest.json")]
    {
        let run = || {
            let arguments =
                ["render", CAROUSEL, "-o", folder.path("x.exr").to_str().unwrap()].map(str::to_owned);
            let arguments = arguments.iter().map(String::as_str).chain(options.iter().copied());
            lightbuffer(arguments.chain(shard.iter().copied()).collect::<Vec<_>>()).done()
        };
        let first = run();
        let again = run();
        assert!(again.stderr.contains("1 of 1 pictures are finished"), "{}", again.stderr);
        assert_eq!(json(&first.stdout), json(&again.stdout));
        assert_eq!(listed(&folder.path(manifest)).len(), 1);
    }
}

#[test]
fn what_slurm_gives_a_job_is_kept_to() {
    let run = |variables: &[(&str, &str)], arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lightbuffer"));
        command.args(arguments).envs(variables.iter().copied()).current_dir(env!("CARGO_MANIFEST_DIR"));
        let output = command.output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let folder = Folder::new();
    let out = folder.path("x.exr");
    let render = ["render", CAROUSEL, "-q", TALL[0], TALL[1], "--no-verdict", "-o", out.to_str().unwrap()];
    for memory in
        [&[("SLURM_MEM_PER_NODE", "1")][..], &[("SLURM_MEM_PER_CPU", "1"), ("SLURM_CPUS_PER_TASK", "1")]]
    {
        let (code, said) = run(memory, &render);
        assert!(code == Some(2) && said.contains("--memory-limit is 1024 KiB"), "{said}");
        assert!(names(&folder.path("")).is_empty());
    }
    let folder = folder.path("judged");
    let validate = [
        "validate",
        CAROUSEL,
        "-q",
        "--size",
        "8x8",
        "--testers",
        "light-buffer",
        "-o",
        folder.to_str().unwrap(),
    ];
    let all = std::thread::available_parallelism().unwrap().get();
    for (given, threads) in [("1", 1), ("1000000", all)] {
        assert_eq!(run(&[("SLURM_CPUS_PER_TASK", given)], &validate).0, Some(0));
        let facts = json(&String::from_utf8(bytes(&folder.join("validate.json"))).unwrap());
        assert_eq!(facts["threads"], threads);
    }
}
