//! `render --frames`: a picture a frame, and buffers that are kept from one to the next.

use crate::{BLOCKS, Folder, Run, SIZE, json, lightbuffer, names};
use lightbuffer::film::read_exr;
use serde_json::Value;
use std::path::Path;

const TURNTABLE: &str = "scenes/turntable.toml";
const CAROUSEL: &str = "scenes/carousel.toml";
const SMALL: [&str; 2] = ["--size", "48x27"];

fn render(scene: &str, out: &Path, options: &[&str]) -> Run {
    let arguments = ["render", scene, SMALL[0], SMALL[1], "-q", "-o", out.to_str().unwrap()];
    lightbuffer(arguments.iter().chain(options))
}

/// For each frame whether the first tester of a light was built in it, and the frame that it was built in.
fn builds(facts: &Value, light: &str) -> Vec<(bool, u64)> {
    let of_frame = |frame: &Value| {
        let lights = frame["lights"].as_array().unwrap();
        let light = lights.iter().find(|found| found["name"] == light).unwrap();
        let tester = &light["testers"][0];
        (tester["build"] == "built", tester["built_in_frame"].as_u64().unwrap())
    };
    facts["frames"].as_array().unwrap().iter().map(of_frame).collect()
}

/// A small scene that a camera goes around, under one light.
fn going_around(folder: &Folder) -> String {
    for name in ["blocks.obj", "blocks.mtl"] {
        folder.write(name, std::fs::read(Path::new("scenes").join(name)).unwrap());
    }
    let scene = "version = 1\n\
        [[include]]\npath = 'blocks.obj'\n\
        [[light]]\nname = 'lamp'\ntype = 'point'\nposition = [3, 6, 4]\nintensity = 60\n\
        [[camera]]\nposition = [0, 4, 9]\ntarget = [0, 1, 0]\nkeyframes = [\n\
        { frame = 1, rotate = { axis = [0, 1, 0], degrees = 0 } },\n\
        { frame = 65, rotate = { axis = [0, 1, 0], degrees = 360 } },\n]\n";
    folder.write("around.toml", scene).to_str().unwrap().into()
}

#[test]
fn a_still_light_is_built_once_for_64_frames_of_a_moving_camera() {
    let folder = Folder::new();
    let scene = going_around(&folder);
    for tester in ["light-buffer", "bounding-volumes"] {
        let out = folder.path(&format!("{tester}.exr"));
        let options = ["--frames", "1-64", "--no-verdict", "--shadow", tester, "--json", "-"];
        let facts = json(&render(&scene, &out, &options).done().stdout);
        assert_eq!(facts["frames"].as_array().unwrap().len(), 64);
        let expected: Vec<_> = (0..64).map(|frame| (frame == 0, 1)).collect();
        assert_eq!(builds(&facts, "lamp"), expected, "{tester}");
        assert_eq!((&facts["totals"]["built"], &facts["totals"]["kept"]), (&1.into(), &63.into()));
    }
    let read = |frame: u32| read_exr(&folder.path(&format!("light-buffer.{frame:04}.exr"))).unwrap();
    let mask = |frame| read(frame).channel("shadow.lamp.light-buffer").unwrap().to_vec();
    assert!(mask(1).contains(&1.0) && mask(1) != mask(17) && mask(17) != mask(33));
}

#[test]
fn kept_and_rebuilt_frames_are_the_same_files() {
    let folder = Folder::new();
    let frames = |name: &str, options: &[&str]| {
        let out = folder.path(&format!("{name}/f.##.exr"));
        std::fs::create_dir_all(out.parent().unwrap()).unwrap();
        let options = [&["--frames", "1-4,11-14,24", "--json", "-"][..], options].concat();
        json(&render(CAROUSEL, &out, &options).done().stdout)
    };
    let kept = frames("kept", &[]);
    let rebuilt = frames("rebuilt", &["--rebuild"]);
    let all = names(&folder.path("kept"));
    assert_eq!((all.len(), names(&folder.path("rebuilt"))), (19, all.clone()));
    // The manifest holds times.
    for name in all.iter().filter(|name| *name != "f.manifest.json") {
        let read = |folder_name: &str| std::fs::read(folder.path(folder_name).join(name)).unwrap();
        assert!(read("kept") == read("rebuilt"), "{name}");
    }
    // The plate turns up to frame 12; from there on only one of the lights and the camera move.
    let built = |facts: &Value, light| builds(facts, light).iter().map(|build| build.0).collect::<Vec<_>>();
    assert_eq!(built(&kept, "still"), [true, true, true, true, true, true, false, false, false]);
    assert_eq!(builds(&kept, "still")[8], (false, 12));
    assert_eq!(built(&kept, "swinging"), [true; 9]);
    assert_eq!(built(&rebuilt, "still"), [true; 9]);
    assert_eq!(kept["frames_per_second"], "24");
}

#[test]
fn every_tester_is_right_in_every_frame() {
    let folder = Folder::new();
    for tester in ["exact", "brute-force", "irregular-z-buffer", "auto", "light-buffer"] {
        let out = folder.path(&format!("{tester}.exr"));
        // With a verdict: the exit code says whether an answer was wrong.
        render(CAROUSEL, &out, &["--frames", "1,7,12,13", "--shadow", tester]).done();
    }
    for frame in ["0001", "0007", "0012", "0013"] {
        let mask = |tester: &str| {
            let image = read_exr(&folder.path(&format!("{tester}.{frame}.exr"))).unwrap();
            ["still", "swinging"].map(|l| image.channel(&format!("shadow.{l}.{tester}")).unwrap().to_vec())
        };
        for tester in ["brute-force", "irregular-z-buffer", "auto", "light-buffer"] {
            assert_eq!(mask(tester), mask("exact"), "{tester} in frame {frame}");
        }
    }
}

#[test]
fn files_say_which_frame_they_are_and_how_many_there_are_a_second() {
    let folder = Folder::new();
    let frame = |options: &[&str]| {
        let options = [&["--frames", "7", "--no-shadows"][..], options].concat();
        render(CAROUSEL, &folder.path("x.exr"), &options).done();
        read_exr(&folder.path("x.0007.exr")).unwrap()
    };
    let image = frame(&[]);
    assert_eq!((image.attribute("frame"), image.frame_rate().unwrap().fraction()), (Some("7"), (24, 1)));
    let bytes = std::fs::read(folder.path("x.0007.exr")).unwrap();
    let standard = b"framesPerSecond\0rational\0\x08\0\0\0\x18\0\0\0\x01\0\0\0";
    assert!(bytes.windows(standard.len()).any(|window| window == standard));
    assert_eq!(frame(&["--fps", "23.976"]).frame_rate().unwrap().fraction(), (24000, 1001));
    // A picture of no frame says neither.
    render(CAROUSEL, &folder.path("rest.exr"), &["--no-shadows"]).done();
    let rest = read_exr(&folder.path("rest.exr")).unwrap();
    assert_eq!((rest.attribute("frame"), rest.frame_rate()), (None, None));
}

#[test]
fn frames_are_at_their_number_over_the_frames_a_second() {
    let folder = Folder::new();
    let mask = |name: &str, options: &[&str]| {
        render(CAROUSEL, &folder.path("t.##.exr"), &[options, &["--no-verdict"]].concat()).done();
        read_exr(&folder.path(name)).unwrap().channel("shadow.still.light-buffer").unwrap().to_vec()
    };
    let sixth = mask("t.06.exr", &["--frames", "6"]);
    assert_eq!(mask("t.12.exr", &["--frames", "12", "--fps", "48"]), sixth);
    assert_eq!(mask("t.03.exr", &["--frames", "3", "--fps", "12"]), sixth);
    assert_ne!(mask("t.12.exr", &["--frames", "12"]), sixth);
    // Before the first keyframe everything is where that says, and at rest too where the table says no more.
    assert_eq!(mask("t.00.exr", &["--frames", "0"]), mask("t.01.exr", &["--frames", "1"]));
}

#[test]
fn lists_and_names_that_cannot_be_are_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let refused = |out: &str, options: &[&str], words: &str| {
        render(CAROUSEL, &folder.path(out), options).misused(words);
        assert!(names(&folder.path("")).is_empty(), "{words}");
    };
    refused("x.exr", &["--frames", "9-1"], "the first frame of a range before its last one");
    refused("x.exr", &["--frames", "-3"], "frames count from 0");
    refused("x.exr", &["--frames", "0-9999999"], "at most 100000 frames");
    refused("x.exr", &["--frames", "1", "--fps", "0"], "frames a second above 0");
    refused("x_##_##.exr", &["--frames", "1-2"], "several in `x_##_##.exr`");
    refused("x.exr", &["--fps", "24"], "--frames");
    refused("x.exr", &["--rebuild"], "--frames");
    refused("x.exr", &["--frames", "1", "--save-shadow-buffers", "buffers"], "cannot be used with");
    refused("none/x.exr", &["--frames", "1"], "cannot write");
    let same = folder.path("x.0002.png");
    refused("x.exr", &["--frames", "1-3", "--json", same.to_str().unwrap()], "two results have this name");
}

#[test]
fn a_frame_that_cannot_be_is_found_before_the_first_is_drawn() {
    let folder = Folder::new();
    let scene = "version = 1\n[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\n\
        [[light]]\ntype = 'point'\nposition = [3, 6, 4]\n\
        [[camera]]\nposition = [0, 0, 9]\ntarget = [0, 0, 0]\nkeyframes = [\n\
        { frame = 0, position = [0, 0, 8] }, { frame = 8, position = [0, 0, -8] }]\n";
    let scene = folder.write("through.toml", scene);
    let out = folder.path("x.exr");
    let failed = render(scene.to_str().unwrap(), &out, &["--frames", "0-8"]).failed();
    assert!(failed.contains("frame 4: camera `camera-1` at 0.16666666666666666 s: "), "{failed}");
    assert!(failed.contains("leave no direction to look in"), "{failed}");
    assert_eq!(names(&folder.path("")), ["through.toml"]);
}

#[test]
fn a_scene_in_which_nothing_moves_is_the_same_in_all_frames_and_says_so() {
    let folder = Folder::new();
    let out = folder.path("x.exr");
    let arguments = ["render", BLOCKS, SIZE[0], SIZE[1], "--no-verdict", "--frames", "0,5", "-o"];
    let run = lightbuffer(arguments.iter().copied().chain([out.to_str().unwrap()])).done();
    assert!(run.stderr.contains("nothing moves in the scene"), "{}", run.stderr);
    assert!(run.stderr.contains("1 buffers built in"), "{}", run.stderr);
    let [one, other] = ["x.0000.png", "x.0005.png"].map(|name| std::fs::read(folder.path(name)).unwrap());
    assert!(one == other);
}

#[test]
fn info_says_what_moves_and_when() {
    let text = lightbuffer(["info", "-q", CAROUSEL]).done().stdout;
    let line = "animated from 0.041666666666666664 to 1 s, frames 1 to 24 at 24 a second; what moves: 1 objects, \
                light swinging, camera front";
    assert!(text.contains(line), "{text}");
    let facts = json(&lightbuffer(["info", "-q", TURNTABLE, "--json", "-"]).done().stdout);
    assert_eq!(facts["animation"]["last_frame"], 65);
    assert_eq!(facts["animation"]["cameras"], serde_json::json!(["turntable"]));
    let still = json(&lightbuffer(["info", "-q", BLOCKS, "--json", "-"]).done().stdout);
    assert!(still["animation"].is_null());
}

#[cfg(unix)]
#[test]
fn a_signal_leaves_whole_frames_alone() {
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Command, Stdio};
    let folder = Folder::new();
    let out = folder.path("x.exr");
    for round in 0..4_u32 {
        let mut command = Command::new("env");
        command.arg("--default-signal=INT,TERM").arg(env!("CARGO_BIN_EXE_lightbuffer"));
        command.args(["render", CAROUSEL, "-q", "--size", "96x54", "--frames", "1-2000", "-o"]).arg(&out);
        command.current_dir(env!("CARGO_MANIFEST_DIR")).stdout(Stdio::null()).stderr(Stdio::piped());
        let child = command.spawn().unwrap();
        let third = folder.path(&format!("x.{:04}.exr", 3 + round));
        let began = std::time::Instant::now();
        while !third.exists() && began.elapsed().as_secs() < 60 {
            std::thread::sleep(std::time::Duration::from_millis(3));
        }
        std::thread::sleep(std::time::Duration::from_millis(u64::from(7 * round)));
        let signal = ["INT", "TERM"][round as usize % 2];
        assert!(
            Command::new("kill")
                .arg(format!("-{signal}"))
                .arg(child.id().to_string())
                .status()
                .unwrap()
                .success()
        );
        let output = child.wait_with_output().unwrap();
        assert!(output.status.signal().is_some(), "{}", output.status);
        let all = names(&folder.path(""));
        let pictures: Vec<_> = all.iter().filter(|name| name.ends_with(".exr")).collect();
        assert!(pictures.len() >= 3 && pictures.len() < 2000, "{}", pictures.len());
        assert_eq!(
            all.len(),
            2 * pictures.len() + 1,
            "a picture without its preview, no manifest, or something else: {all:?}"
        );
        for name in pictures {
            read_exr(&folder.path(name)).unwrap();
            assert!(all.contains(&name.replace(".exr", ".png")));
        }
    }
}
