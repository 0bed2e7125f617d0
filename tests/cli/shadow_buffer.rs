//! The shadow-buffer on the command line: its row, its options, its files, and the lights that it does not serve.

use crate::{BLOCKS, Folder, SIZE, json, lightbuffer, names, validate};
use lightbuffer::film::{ImagePlanes, read_exr};
use std::path::{Path, PathBuf};

/// Three objects and two cameras.
const OBJECTS: &str = r#"
version = 1

[[plane]]
name = "ground"
point = [0, 0, 0]
normal = [0, 1, 0]

[[sphere]]
name = "low"
centre = [0, 1, 0]
radius = 1

[[sphere]]
name = "high"
centre = [0, 2.5, 0]
radius = 0.5

[[camera]]
name = "front"
position = [0, 3, 8]
target = [0, 1, 0]
size = [60, 40]

[[camera]]
name = "side"
position = [7, 4, -3]
target = [0, 1, 0]
size = [60, 40]
"#;

const LAMPS: &str = r#"
[[light]]
name = "lamp"
type = "point"
position = [3, 6, 2]
intensity = 60

[[light]]
name = "other"
type = "point"
position = [-4, 5, 3]
intensity = 40
"#;

const SUN: &str = r#"
[[light]]
name = "sun"
type = "directional"
direction = [1, -4, 2]
irradiance = 3
"#;

const SMALL: [&str; 6] =
    ["--shadow", "shadow-buffer", "--no-verdict", "--shadow-buffer-size", "100x200", "-q"];

fn scene(folder: &Folder) -> PathBuf {
    folder.write("scene.toml", format!("{OBJECTS}{LAMPS}"))
}

fn render(scene: &Path, output: &Path, options: &[&str]) -> crate::Run {
    let arguments = ["render", scene.to_str().unwrap(), "-o", output.to_str().unwrap()];
    lightbuffer(arguments.iter().chain(&SMALL).chain(options))
}

fn channel<'i>(image: &'i ImagePlanes, name: &str) -> &'i [f32] {
    image.channel(name).unwrap_or_else(|| panic!("no channel {name}"))
}

#[test]
fn its_errors_are_reported_and_do_not_decide_the_exit_code() {
    let folder = Folder::new();
    let out = folder.path("out");
    let options = ["--shadow", "shadow-buffer", "--shadow-buffer-size", "50x100", "--json", "-"];
    let report = json(&validate(BLOCKS, &out, &options).done().stdout);
    let light = &report["lights"][0];
    let tester = &light["testers"]["shadow-buffer"];
    let [wrong, false_shadow, false_light] =
        ["wrong", "false_shadow", "false_light"].map(|key| tester[key].as_u64().unwrap());
    assert!(wrong > 20 && wrong == false_shadow + false_light, "{tester}");
    assert_eq!(light["verdicts"]["native_wrong"], 0);
    let image = read_exr(&out.join("image.exr")).unwrap();
    let [mask, truth, verdict] =
        ["shadow-buffer", "exact", "verdict"].map(|name| channel(&image, &format!("shadow.key.{name}")));
    assert_eq!(image.attribute("shadowBuffer"), Some("50x100 identity"));
    let differs = (0..mask.len()).filter(|&i| mask[i] != truth[i]).count();
    assert_eq!(differs as u64, wrong);
    let called_wrong = verdict.iter().filter(|&&v| [4.0, 6.0].contains(&(v % 10.0))).count();
    assert_eq!(called_wrong as u64, wrong);
    assert!(names(&out).contains(&"key.verdict.png".to_string()));
    // Finer cells, fewer errors.
    let fine = ["--testers", "shadow-buffer", "--shadow-buffer-size", "800x1600", "--json", "-"];
    let report = json(&validate(BLOCKS, &folder.path("fine"), &fine).done().stdout);
    let fine = report["totals"]["testers"]["shadow-buffer"]["wrong"].as_u64().unwrap();
    assert!(fine < wrong, "{fine} and {wrong}");
}

#[test]
fn options_out_of_range_are_refused() {
    let folder = Folder::new();
    let run = |option: &str| validate(BLOCKS, &folder.path("out"), &[option]);
    for size in ["0x800", "400", "400x", "65537x2", "4x4x4", "-1x5"] {
        run(&format!("--shadow-buffer-size={size}")).misused("expected ROWSxCOLUMNS, such as 400x800");
    }
    for filter in ["0", "2", "65", "-1", "x"] {
        run(&format!("--shadow-buffer-filter={filter}")).misused("expected an odd number from 1 to 63");
    }
    run("--shadow-buffer-lookup=best").misused("expected identity or depth");
    run("--shadow-buffer-bias=1").misused("expected a number in [0, 1)");
    let large = ["--testers", "shadow-buffer", "--shadow-buffer-size", "65536x65536", "--memory-limit", "1G"];
    let line = validate(BLOCKS, &folder.path("out"), &large).failed();
    assert!(line.contains("a shadow-buffer of 65536x65536 cells would need about"), "{line}");
    assert!(!folder.path("out").exists());
}

#[test]
fn lights_infinitely_far_away_are_left_out_unless_it_is_named() {
    let folder = Folder::new();
    let only_sun = folder.write("sun.toml", format!("{OBJECTS}{SUN}"));
    let out = folder.path("out");
    let run = validate(&only_sun, &out, &[]).done();
    assert!(
        run.stdout.contains("skipped: shadow-buffer has no answer for lights infinitely"),
        "{}",
        run.stdout
    );
    let report = json(&std::fs::read_to_string(out.join("validate.json")).unwrap());
    assert_eq!(report["skipped"], json("[\"shadow-buffer\"]"));
    assert!(report["totals"]["testers"]["shadow-buffer"].is_null());
    for option in ["--testers", "--shadow"] {
        let line = validate(&only_sun, &folder.path("none"), &[option, "shadow-buffer"]).failed();
        assert!(line.contains("shadow-buffer: the light sun is infinitely far away"), "{line}");
    }
    let line = render(&only_sun, &folder.path("none.exr"), &[]).failed();
    assert!(line.contains("the light sun is infinitely far away"), "{line}");
    assert!(!folder.path("none").exists() && !folder.path("none.exr").exists());
    let replayed =
        lightbuffer(["replay", "-q", only_sun.to_str().unwrap(), "--pixel", "30,30", "--json", "-"]);
    assert!(json(&replayed.done().stdout)["testers"].get("shadow-buffer").is_none());
    // Beside a sun the lamps have their rows.
    let both = folder.write("both.toml", format!("{OBJECTS}{LAMPS}{SUN}"));
    let report = json(&validate(&both, &folder.path("both"), &["--json", "-"]).done().stdout);
    let asked = |light: usize| !report["lights"][light]["testers"]["shadow-buffer"].is_null();
    assert_eq!([asked(0), asked(1), asked(2)], [true, true, false]);
    let image = read_exr(&folder.path("both").join("image.exr")).unwrap();
    assert!(image.attribute("testers").unwrap().contains("shadow-buffer"));
}

#[test]
fn saved_buffers_serve_other_views_of_the_scene() {
    let folder = Folder::new();
    let (scene, buffers) = (scene(&folder), folder.path("buffers"));
    let [save, load] =
        ["--save-shadow-buffers", "--load-shadow-buffers"].map(|option| [option, buffers.to_str().unwrap()]);
    render(&scene, &folder.path("front.exr"), &save).done();
    assert_eq!(names(&buffers), ["lamp.shadow-buffer", "other.shadow-buffer"]);
    for (camera, filter) in [("front", "1"), ("side", "1"), ("side", "5")] {
        let view = ["--camera", camera, "--shadow-buffer-filter", filter];
        render(&scene, &folder.path("fresh.exr"), &view).done();
        render(&scene, &folder.path("loaded.exr"), &[&view[..], &load].concat()).done();
        let [fresh, loaded] =
            ["fresh.exr", "loaded.exr"].map(|name| std::fs::read(folder.path(name)).unwrap());
        assert!(fresh == loaded, "the camera {camera} sees other shadows");
    }
    let front = std::fs::read(folder.path("front.exr")).unwrap();
    assert!(front != std::fs::read(folder.path("fresh.exr")).unwrap());
}

#[test]
fn buffers_that_do_not_fit_are_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let (scene, buffers) = (scene(&folder), folder.path("buffers"));
    let [save, load] =
        ["--save-shadow-buffers", "--load-shadow-buffers"].map(|option| [option, buffers.to_str().unwrap()]);
    render(&scene, &folder.path("first.exr"), &save).done();
    let none = folder.path("none.exr");
    let refused = |options: &[&str], words: &str| {
        let line = render(&scene, &none, &[&load[..], options].concat()).failed();
        assert!(line.contains(words), "{words:?} is not in {line}");
        assert!(!none.exists() && !none.with_extension("png").exists());
    };
    refused(&["--shadow-buffer-lookup", "depth"], "another look-up");
    let other_light = ["--light", "1,2,3"];
    refused(&other_light, "light-1.shadow-buffer: cannot read");
    let file = buffers.join("other.shadow-buffer");
    let whole = std::fs::read(&file).unwrap();
    let mut damaged = whole.clone();
    damaged[5000] ^= 4;
    std::fs::write(&file, damaged).unwrap();
    refused(&[], "other.shadow-buffer: damaged");
    std::fs::write(&file, &whole[..whole.len() - 1]).unwrap();
    refused(&[], "a shadow-buffer of this size has");
    std::fs::write(&file, std::fs::read(buffers.join("lamp.shadow-buffer")).unwrap()).unwrap();
    refused(&[], "another light");
    std::fs::write(&file, &whole).unwrap();
    folder.write("scene.toml", format!("{OBJECTS}{LAMPS}").replace("radius = 0.5", "radius = 0.6"));
    refused(&[], "the scene has changed");
    for option in [save, load] {
        let arguments = ["render", BLOCKS, SIZE[0], SIZE[1], "-q", "-o", none.to_str().unwrap()];
        let line = lightbuffer(arguments.iter().chain(&option)).failed();
        assert!(line.contains("only with --shadow shadow-buffer"), "{line}");
    }
}

#[test]
fn a_filter_makes_edges_of_the_picture_soft_and_leaves_masks_hard() {
    let folder = Folder::new();
    let scene = scene(&folder);
    let image = |filter: &str| {
        let output = folder.path(&format!("{filter}.exr"));
        render(&scene, &output, &["--shadow-buffer-filter", filter]).done();
        read_exr(&output).unwrap()
    };
    let [hard, soft] = ["1", "7"].map(image);
    for image in [&hard, &soft] {
        assert!(channel(image, "shadow.lamp.shadow-buffer").iter().all(|&m| m == 0.0 || m == 1.0));
    }
    let differ =
        |name: &str| channel(&hard, name).iter().zip(channel(&soft, name)).filter(|(a, b)| a != b).count();
    assert!(differ("R") > 50, "{}", differ("R"));
    assert!(differ("shadow.lamp.shadow-buffer") < differ("R"));
}
