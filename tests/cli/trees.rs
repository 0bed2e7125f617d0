//! Curved, mirroring and transparent surfaces on the command line: depth, subdivision, replay.

use crate::{Folder, json, lightbuffer};
use lightbuffer::film::read_exr;
use serde_json::Value;
use std::path::PathBuf;

/// A glass ball over a mirror, with an opaque cylinder that the light passes on its way.
const SCENE: &str = r#"
version = 1
background = [0.2, 0.3, 0.4]

[[material]]
name = "mirror"
mirror = 0.5

[[material]]
name = "glass"
transmittance = [0.5, 0.7, 0.9]
refractive_index = 1.5

[[mesh]]
name = "floor"
material = "mirror"
vertices = [[-4, 0, -4], [-4, 0, 4], [4, 0, 4], [4, 0, -4]]
faces = [[0, 1, 2, 3]]

[[sphere]]
name = "ball"
material = "glass"
centre = [0, 1, 0]
radius = 0.75

[[cylinder]]
name = "post"
base = [1.5, 0, 0]
apex = [1.5, 2, 0]
radius = 0.25

[[light]]
name = "lamp"
type = "point"
position = [3, 5, 2]
intensity = 60

[[camera]]
position = [0, 2.5, 6]
target = [0, 0.75, 0]
size = [60, 40]
"#;

fn scene(folder: &Folder) -> PathBuf {
    folder.write("glass.toml", SCENE)
}

fn lamp(report: &Value) -> &Value {
    &report["lights"][0]
}

#[test]
fn deeper_levels_are_judged_and_nothing_native_is_wrong() {
    let folder = Folder::new();
    let scene = scene(&folder);
    let queries = |depth: &str| {
        let output = folder.path(depth);
        let arguments =
            ["validate", scene.to_str().unwrap(), "--depth", depth, "-o", output.to_str().unwrap()];
        lightbuffer(arguments).done();
        let report = json(&std::fs::read_to_string(output.join("validate.json")).unwrap());
        for tester in ["brute-force", "bounding-volumes", "light-buffer"] {
            assert_eq!(lamp(&report)["testers"][tester]["wrong"], 0, "{tester}");
        }
        assert!(lamp(&report)["from_behind"].as_u64().unwrap() > 10);
        lamp(&report)["queries"].as_u64().unwrap()
    };
    let [alone, deep] = ["1", "5"].map(queries);
    assert!(deep > alone + 300, "{alone} and {deep}");
}

#[test]
fn a_subdivided_picture_has_shares_for_answers() {
    let folder = Folder::new();
    let (scene, output) = (scene(&folder), folder.path("fine.exr"));
    let arguments = ["render", scene.to_str().unwrap(), "--subdivide", "3", "-o", output.to_str().unwrap()];
    lightbuffer(arguments).done();
    let image = read_exr(&output).unwrap();
    assert_eq!((image.size().width, image.size().height), (60, 40));
    let shadow = image.channel("shadow.lamp.light-buffer").unwrap();
    assert!(shadow.iter().all(|share| (0.0..=1.0).contains(share)));
    assert!(shadow.iter().any(|&share| share > 0.0 && share < 1.0));
    assert!(image.channel("shadow.lamp.verdict").is_none());
}

#[test]
fn mirrors_show_the_background_and_glass_colours_its_shadow() {
    let folder = Folder::new();
    let scene = scene(&folder);
    let render = |depth: &str| {
        let output = folder.path(&format!("{depth}.exr"));
        let arguments = [
            "render",
            scene.to_str().unwrap(),
            "--depth",
            depth,
            "--no-verdict",
            "-o",
            output.to_str().unwrap(),
        ];
        lightbuffer(arguments).done();
        read_exr(&output).unwrap()
    };
    let [alone, deep] = ["1", "5"].map(render);
    let brighter = |name: &str| {
        let pairs = alone.channel(name).unwrap().iter().zip(deep.channel(name).unwrap());
        pairs.filter(|(a, b)| b > a).count()
    };
    assert!(["R", "G", "B"].into_iter().all(|name| brighter(name) > 300));
    // Where the ball dims the floor, red is dimmed most.
    let channel = |name: &str| alone.channel(name).unwrap();
    let tinted = (0..60 * 40).filter(|&i| channel("B")[i] > 1.5 * channel("R")[i] && channel("A")[i] > 0.0);
    assert!(tinted.count() > 20);
}

#[test]
fn a_curved_primitive_is_replayed_by_its_numbers() {
    let folder = Folder::new();
    let scene = scene(&folder);
    let arguments = ["replay", scene.to_str().unwrap(), "--light", "lamp", "--pixel", "30,17", "--json", "-"];
    let run = lightbuffer(arguments).done();
    let replay: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(
        (&replay["primitive"]["kind"], &replay["primitive"]["name"]),
        (&"sphere".into(), &"ball".into())
    );
    assert_eq!(replay["primitive"]["numbers"], serde_json::json!([0.0, 1.0, 0.0, 0.75]));
    assert!(replay["primitive"].get("vertices").is_none());
}
