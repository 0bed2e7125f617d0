//! Options of what is looked at: lights, camera, floor, warnings.

use crate::fixtures::triangle;
use crate::{BLOCKS, Folder, json, lightbuffer, validate};
use serde_json::json;

fn info(arguments: &[&str]) -> serde_json::Value {
    json(&lightbuffer(["info", "--json", "-"].iter().chain(arguments)).done().stdout)
}

#[test]
fn lights_of_the_command_line_replace_those_of_the_scene() {
    let lights = |arguments: &[&str]| {
        let lights = info(arguments)["lights"].take();
        let light = |l: &serde_json::Value| (l["name"].as_str().unwrap().to_owned(), l["position"].clone());
        lights.as_array().unwrap().iter().map(light).collect::<Vec<_>>()
    };
    assert_eq!(lights(&["scenes/courtyard.glb"]).iter().map(|l| &l.0).collect::<Vec<_>>(), ["key", "fill"]);
    let given = lights(&["scenes/courtyard.glb", "--light", "1,2,3", "--light=-4.5, 5,6"]);
    assert_eq!(
        given,
        [("light-1".into(), json!([1.0, 2.0, 3.0])), ("light-2".into(), json!([-4.5, 5.0, 6.0]))]
    );
    let rig = lights(&[BLOCKS, "--lights", "5"]);
    assert_eq!(rig.len(), 5);
    assert_eq!(rig, lights(&[BLOCKS, "--lights", "5"]));
    assert!((1..5).all(|i| rig[i].1 != rig[0].1 && rig[i].1[1] == rig[0].1[1]));
}

#[test]
fn a_mesh_without_light_gets_a_floor_unless_told_otherwise() {
    let (with, without) = (info(&[BLOCKS]), info(&[BLOCKS, "--no-floor"]));
    assert_eq!(with["added"], json!(["camera `framed`", "light `key`", "object `floor`"]));
    assert_eq!(without["added"], json!(["camera `framed`", "light `key`"]));
    let triangles = |facts: &serde_json::Value| facts["primitives"].as_u64().unwrap();
    assert_eq!(triangles(&with), triangles(&without) + 2);
    let run = lightbuffer(["info", BLOCKS]).done();
    assert_eq!(
        run.stderr,
        "lightbuffer: the scene came without: added camera `framed`, light `key`, object `floor`\n"
    );
}

#[test]
fn a_camera_is_chosen_by_name() {
    let folder = Folder::new();
    let mut document = triangle();
    document["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } }]);
    let nodes = document["nodes"].as_array_mut().unwrap();
    nodes.push(json!({ "name": "near", "camera": 0, "translation": [0.3, 0.3, 2] }));
    nodes.push(json!({ "name": "far", "camera": 0, "translation": [0.3, 0.3, 9] }));
    document["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let scene = folder.write("scene.gltf", document.to_string());
    let points = |options: &[&str]| {
        let options: Vec<_> =
            options.iter().chain(&["--testers", "exact", "--no-floor", "--json", "-"]).copied().collect();
        let run = validate(&scene, &folder.path("out"), &[&options[..], &["--shadow", "exact"]].concat());
        let light = json(&run.done().stdout)["lights"][0].take();
        light["queries"].as_u64().unwrap() + light["facing_away"].as_u64().unwrap()
    };
    assert_eq!(points(&[]), points(&["--camera", "near"]));
    assert!(points(&["--camera", "near"]) > 10 * points(&["--camera", "far"]));
    let out = folder.path("none");
    let line = validate(&scene, &out, &["--camera", "middle"]).failed();
    assert!(line.ends_with("no camera `middle`; the scene has: near, far"), "{line}");
    assert!(!out.exists());
}

#[test]
fn a_camera_may_bring_the_size_of_its_image() {
    let folder = Folder::new();
    let view = |name: &str, size: &str| {
        folder.write(
            name,
            format!(
                "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\n{size}l 0 0 9\np 3\n-1 -1 0\n1 -1 0\n0 1 0\n"
            ),
        )
    };
    let scene = view("scene.nff", "resolution 24 16\n");
    let size = |scene: &std::path::Path, options: &[&str]| {
        let out = folder.path("out.exr");
        let fixed = ["render", "-q", "--no-verdict", "--json", "-", "-o", out.to_str().unwrap()];
        let arguments = fixed.iter().copied().chain([scene.to_str().unwrap()]).chain(options.iter().copied());
        let facts = json(&lightbuffer(arguments).done().stdout);
        (facts["width"].as_u64().unwrap(), facts["height"].as_u64().unwrap())
    };
    assert_eq!(size(&scene, &[]), (24, 16));
    assert_eq!(size(&scene, &["--size", "20x30"]), (20, 30));
    let mesh = folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(size(&mesh, &[]), (1280, 720));
    let line =
        lightbuffer(["info".as_ref(), view("large.nff", "resolution 9999 9999\n").as_os_str()]).failed();
    assert!(line.ends_with("large.nff:6: resolution 9999 9999: more than 16777216 pixels"), "{line}");
}

#[test]
fn warnings_are_said_and_are_errors_when_strict() {
    let folder = Folder::new();
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n";
    let scene = folder.write("flat.obj", text);
    let scene = scene.to_str().unwrap();
    let warning = "dropped 1 triangles of zero area";
    let run = lightbuffer(["info", scene]).done();
    assert!(run.stderr.contains(&format!("lightbuffer: warning: {warning}\n")), "{}", run.stderr);
    assert_eq!(info(&[scene, "-q"])["warnings"], json!([warning]));
    let line = lightbuffer(["info", scene, "--strict"]).failed();
    assert!(line.ends_with(&format!("flat.obj: {warning} (--strict)")), "{line}");
    let out = folder.path("out");
    validate(scene, &out, &["--strict"]).failed();
    assert!(!out.exists());
}
