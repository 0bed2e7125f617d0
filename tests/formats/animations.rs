//! Animations of glTF and keyframes of TOML: the scene at a time is the scene that somebody would have written for it.

use crate::fixtures::{Folder, triangle, triangle_glb};
use crate::gltf_parts::{accessor, float_accessor, normalized};
use glam::Vec3;
use lightbuffer::geometry::LightPosition;
use lightbuffer::memory::MemoryLimit;
use lightbuffer::scene::formats;
use lightbuffer::scene::{Animation, Scene};
use serde_json::{Value, json};

fn load(name: &str, bytes: impl AsRef<[u8]>) -> Animation {
    let folder = Folder::new();
    formats::load_animation(&folder.write(name, bytes), MemoryLimit::NONE).unwrap()
}

fn gltf(document: &Value) -> Animation {
    load("scene.gltf", document.to_string())
}

/// Plays a property of a node: times, values, and how it goes on.
fn play(document: &mut Value, node: usize, path: &str, times: &[f32], values: &[f32], interpolation: &str) {
    let input = float_accessor(document, "SCALAR", times);
    let output = float_accessor(document, if path == "rotation" { "VEC4" } else { "VEC3" }, values);
    if document["animations"].is_null() {
        document["animations"] = json!([{ "channels": [], "samplers": [] }]);
    }
    let animation = &mut document["animations"][0];
    let sampler = animation["samplers"].as_array().unwrap().len();
    let entry = json!({ "input": input, "output": output, "interpolation": interpolation });
    animation["samplers"].as_array_mut().unwrap().push(entry);
    let channel = json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    animation["channels"].as_array_mut().unwrap().push(channel);
}

fn bits(scene: &Scene) -> Vec<[u32; 3]> {
    let corners = (0..scene.triangles.len() as u32).flat_map(|t| scene.corners(t));
    corners.map(|p| p.to_array().map(f32::to_bits)).collect()
}

/// Asserts that at a time the triangles, lights and cameras are those of another document without animations.
#[track_caller]
fn same_as(animation: &Animation, time: f64, document: &Value) {
    let (found, expected) = (animation.scene_at(time).unwrap(), gltf(document).rest);
    assert_eq!(bits(&found), bits(&expected), "at {time} s");
    assert_eq!((&found.lights, &found.cameras), (&expected.lights, &expected.cameras), "at {time} s");
}

/// A parent that stands, a child with everything that moves, and a grandchild; a triangle that stands still beside.
fn family() -> Value {
    let mut document = triangle();
    document["nodes"] = json!([
        { "name": "still", "mesh": 0 },
        { "name": "parent", "translation": [0.1, 0.2, 0.3], "rotation": [0.0, 0.6, 0.0, 0.8], "children": [2] },
        { "name": "child", "mesh": 0, "camera": 0, "scale": [1.0, 2.0, 1.0], "children": [3],
          "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "name": "grandchild", "mesh": 0, "translation": [0.0, 0.0, 1.5],
          "extensions": { "KHR_lights_punctual": { "light": 1 } } },
    ]);
    document["scenes"] = json!([{ "nodes": [0, 1] }]);
    document["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } }]);
    document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    document["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "spot", "spot": { "outerConeAngle": 0.5 } }, { "type": "directional" }] } });
    document
}

#[test]
fn nodes_take_meshes_cameras_and_lights_along() {
    let mut document = family();
    let still = document.clone();
    play(&mut document, 2, "translation", &[1.0, 2.0], &[0.0, 0.0, 0.0, 2.0, 4.0, -1.0], "LINEAR");
    play(&mut document, 2, "scale", &[1.0, 3.0], &[1.0, 2.0, 1.0, 2.0, 2.0, 2.0], "STEP");
    let half = 0.5f32.sqrt();
    play(&mut document, 2, "rotation", &[1.0, 2.0], &[0.0, 0.0, 0.0, 1.0, half, 0.0, 0.0, half], "STEP");
    let animation = gltf(&document);
    assert_eq!(animation.motion.range(), Some((1.0, 3.0)));
    assert_eq!((animation.motion.objects.len(), animation.motion.lights.len()), (2, 2));
    let at = |translation: [f64; 3], scale: [f64; 3], rotation: [f32; 4]| {
        let mut document = still.clone();
        document["nodes"][2]["translation"] = json!(translation);
        document["nodes"][2]["scale"] = json!(scale);
        document["nodes"][2]["rotation"] = json!(rotation.map(f64::from));
        document
    };
    let (unit, turned) = ([0.0, 0.0, 0.0, 1.0], [half, 0.0, 0.0, half]);
    for (time, expected) in [
        (0.0, at([0.0; 3], [1.0, 2.0, 1.0], unit)),
        (1.0, at([0.0; 3], [1.0, 2.0, 1.0], unit)),
        (1.25, at([0.5, 1.0, -0.25], [1.0, 2.0, 1.0], unit)),
        (1.999755859375, at([1.99951171875, 3.9990234375, -0.999755859375], [1.0, 2.0, 1.0], unit)),
        (2.0, at([2.0, 4.0, -1.0], [1.0, 2.0, 1.0], turned)),
        (3.0, at([2.0, 4.0, -1.0], [2.0; 3], turned)),
        (100.0, at([2.0, 4.0, -1.0], [2.0; 3], turned)),
    ] {
        same_as(&animation, time, &expected);
    }
    // At rest nothing is played, and nothing is said to be missing.
    assert_eq!(bits(&animation.rest), bits(&gltf(&still).rest));
    assert!(animation.rest.warnings.is_empty(), "{:?}", animation.rest.warnings);
}

#[test]
fn a_spline_goes_through_its_values_by_its_slopes() {
    let mut document = triangle();
    // Two keys of slope, value, slope: x goes at one speed, y rests at both ends.
    let values = [9.0, 9.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 4.0, 4.0, 0.0, 9.0, 9.0, 0.0];
    play(&mut document, 0, "translation", &[0.0, 2.0], &values, "CUBICSPLINE");
    let animation = gltf(&document);
    let moved = |time: f64| animation.scene_at(time).unwrap().corners(0)[0];
    for (time, expected) in [(0.0, [0.0, 0.0]), (0.5, [1.0, 0.625]), (1.0, [2.0, 2.0]), (2.0, [4.0, 4.0])] {
        assert!(moved(time).abs_diff_eq(Vec3::new(expected[0], expected[1], 0.0), 1e-6), "{}", moved(time));
    }
    // A rotation by a spline is a rotation wherever it is.
    let mut document = triangle();
    let values = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0; 4], [0.0, 0.0, 1.0, 0.0], [0.0; 4]];
    play(&mut document, 0, "rotation", &[0.0, 2.0], values.as_flattened(), "CUBICSPLINE");
    let corner = gltf(&document).scene_at(1.0).unwrap().corners(0)[1];
    assert!(corner.abs_diff_eq(Vec3::Y, 1e-6), "{corner}");
}

#[test]
fn rotations_go_the_shorter_way_and_may_be_integers() {
    let mut document = triangle();
    let half = 0.5f32.sqrt();
    // A quarter turn around z, written with the other sign.
    let values = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -half, -half];
    play(&mut document, 0, "rotation", &[0.0, 1.0], &values, "LINEAR");
    let corner = gltf(&document).scene_at(0.5).unwrap().corners(0)[1];
    assert!(corner.abs_diff_eq(Vec3::new(half, half, 0.0), 1e-6), "{corner}");
    let mut integers = triangle();
    play(&mut integers, 0, "rotation", &[0.0, 1.0], &values, "STEP");
    let bytes: Vec<u8> = [0i16, 0, 0, 32767, 0, 0, 32767, 0].iter().flat_map(|n| n.to_le_bytes()).collect();
    let output = normalized(&mut integers, &bytes, (5122, "VEC4"), 2);
    integers["animations"][0]["samplers"][0]["output"] = json!(output);
    let corner = gltf(&integers).scene_at(1.0).unwrap().corners(0)[1];
    assert!(corner.abs_diff_eq(-Vec3::X, 1e-6), "{corner}");
}

#[test]
fn what_is_not_played_is_said_in_a_line() {
    let warned = |document: &Value, words: &str| {
        let warnings = gltf(document).rest.warnings;
        assert!(warnings.iter().any(|line| line.contains(words)), "{words} is not in {warnings:?}");
    };
    let mut document = triangle();
    play(&mut document, 0, "translation", &[0.0], &[1.0, 0.0, 0.0], "STEP");
    let mut weights = document.clone();
    weights["animations"][0]["channels"][0]["target"]["path"] = json!("weights");
    warned(&weights, "animated weights of morph targets are not supported yet (animation 0, channel 0)");
    assert!(gltf(&weights).motion.is_empty());
    let mut pointer = document.clone();
    pointer["animations"][0]["channels"][0]["target"] = json!({ "path": "pointer" });
    warned(&pointer, "animated properties other than translation, rotation and scale are not supported yet");
    let mut twice = document.clone();
    let take = twice["animations"][0].clone();
    twice["animations"] = json!([take, take]);
    warned(&twice, "animations of what an earlier one moves are not played (1 animation)");
    let mut skinned = document.clone();
    let joints = accessor(&mut skinned, &[0; 12], (5121, "VEC4"), 3);
    let one = [1.0, 0.0, 0.0, 0.0].repeat(3);
    let ones = float_accessor(&mut skinned, "VEC4", &one);
    skinned["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    skinned["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(ones);
    skinned["skins"] = json!([{ "joints": [0] }]);
    skinned["nodes"][0]["skin"] = json!(0);
    warned(&skinned, "animated joints of skins are not supported yet (node 0 `corner`)");
    assert!(gltf(&skinned).motion.objects.is_empty());
}

#[test]
fn objects_that_a_scale_of_zero_hides_are_dropped_and_said() {
    let mut document = family();
    play(&mut document, 3, "scale", &[0.0, 1.0], &[1.0, 1.0, 1.0, 0.0, 0.0, 0.0], "STEP");
    let animation = gltf(&document);
    assert_eq!(animation.scene_at(0.5).unwrap().triangles.len(), 3);
    // The light of that node looks nowhere then.
    let error = animation.scene_at(1.0).unwrap_err().to_string();
    assert!(error.contains("light `grandchild` at 1 s") && error.lines().count() == 1, "{error}");
    document["nodes"][3]["extensions"] = json!({});
    let hidden = gltf(&document).scene_at(1.0).unwrap();
    assert_eq!((hidden.triangles.len(), hidden.objects.len(), hidden.dropped.degenerate), (2, 3, 1));
    assert_eq!(hidden.warnings, ["dropped 1 triangles of zero area"]);
}

/// A TOML scene of a triangle, with more text.
fn toml(text: &str) -> Animation {
    let mesh =
        "[[mesh]]\nname = 'still'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";
    load("scene.toml", format!("version = 1\n{text}\n{mesh}"))
}

fn seconds(frame: f64) -> f64 {
    frame / 24.0
}

#[test]
fn keyframes_move_objects_from_one_to_the_next_and_steps_wait() {
    let animation = toml(
        "[[mesh]]\nname = 'moving'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n\
         transform = { scale = 2 }\nkeyframes = [\n\
         { frame = 1, translate = [0, 0, 0] },\n\
         { frame = 5, translate = [4, 0, 0], interpolation = 'step' },\n\
         { frame = 7, rotate = { axis = [0, 0, 1], degrees = 90 } },\n\
         { frame = 9, translate = [0, 0, 8] },\n]\n",
    );
    assert_eq!(animation.motion.objects.len(), 1);
    let corners = |frame: f64| animation.scene_at(seconds(frame)).unwrap().corners(0).map(|p| p.to_array());
    // One rotation is there throughout, since nothing says another.
    for (frame, x, z) in
        [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 1.0, 0.0), (5.0, 4.0, 0.0), (8.9, 4.0, 0.0), (9.0, 0.0, 8.0)]
    {
        let expected = [[x, 0.0, z], [x, 2.0, z], [x - 2.0, 0.0, z]];
        let close = corners(frame)
            .as_flattened()
            .iter()
            .zip(expected.as_flattened())
            .all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(close, "{:?} in frame {frame}, expected {expected:?}", corners(frame));
    }
    assert_eq!(animation.scene_at(seconds(5.0)).unwrap().corners(1), animation.rest.corners(1));
}

#[test]
fn turns_around_one_axis_go_all_the_way_and_others_the_shortest() {
    let turn = |last: &str| {
        toml(&format!(
            "[[mesh]]\nvertices = [[1, 0, 0], [2, 0, 0], [1, 1, 0]]\nfaces = [[0, 1, 2]]\nkeyframes = [\n\
             {{ frame = 0, rotate = {{ axis = [0, 1, 0], degrees = 0 }} }},\n\
             {{ frame = 24, rotate = {{ {last} }} }},\n]\n"
        ))
    };
    let around = turn("axis = [0, 1, 0], degrees = 360");
    let corner = |animation: &Animation, time: f64| animation.scene_at(time).unwrap().corners(0)[0];
    for (time, expected) in [(0.25, -Vec3::Z), (0.5, -Vec3::X), (0.75, Vec3::Z), (1.0, Vec3::X)] {
        assert!(corner(&around, time).abs_diff_eq(expected, 1e-6), "{}", corner(&around, time));
    }
    let other = turn("axis = [0, 0, 2], degrees = 90");
    let half = 0.5f32.sqrt();
    assert!(corner(&other, 0.5).abs_diff_eq(Vec3::new(half, half, 0.0), 1e-6));
}

#[test]
fn lights_and_cameras_have_keyframes_of_their_own() {
    let animation = toml(
        "fps = 12\n[[light]]\nname = 'lamp'\ntype = 'spot'\ntarget = [0, 0, 0]\nkeyframes = [\n\
         { frame = 0, position = [0, 4, 0], intensity = 10 },\n\
         { frame = 6, position = [2, 4, 0] },\n{ frame = 12, intensity = [20, 30, 10] },\n]\n\
         [[light]]\nname = 'sun'\ntype = 'directional'\ntowards = [1, 0, 0]\nkeyframes = [\n\
         { frame = 0, rotate = { axis = [0, 0, 1], degrees = 0 } },\n\
         { frame = 12, rotate = { axis = [0, 0, 1], degrees = 90 } },\n]\n\
         [[camera]]\ntarget = [0, 0, 0]\nkeyframes = [\n\
         { frame = 0, position = [0, 0, 5], vertical_degrees = 40 },\n\
         { frame = 12, position = [5, 0, 5], vertical_degrees = 60 },\n]\n",
    );
    assert_eq!(animation.rate.unwrap().to_string(), "12");
    assert_eq!(animation.rest.lights[0].position(), LightPosition::At(Vec3::new(0.0, 4.0, 0.0)));
    let half = animation.scene_at(0.5).unwrap();
    assert_eq!(half.lights[0].position(), LightPosition::At(Vec3::new(2.0, 4.0, 0.0)));
    assert_eq!(half.lights[0].strength(), [15.0, 20.0, 10.0]);
    let axis = half.lights[0].cone().unwrap().axis.normalize();
    assert!(axis.abs_diff_eq(Vec3::new(-2.0, -4.0, 0.0).normalize(), 1e-6), "{axis}");
    let LightPosition::Towards(sun) = half.lights[1].position() else { panic!("no sun") };
    assert!(sun.abs_diff_eq(Vec3::new(1.0, 1.0, 0.0).normalize(), 1e-6), "{sun}");
    assert_eq!((half.cameras[0].origin, half.lights[0].name.as_str()), (Vec3::new(2.5, 0.0, 5.0), "lamp"));
    assert!((half.cameras[0].tan_half_height - 25f64.to_radians().tan()).abs() < 1e-12);
}

#[test]
fn included_files_move_with_all_that_moves_in_them() {
    let folder = Folder::new();
    let mut document = family();
    play(&mut document, 2, "translation", &[0.0, 1.0], &[0.0, 0.0, 0.0, 0.0, 8.0, 0.0], "LINEAR");
    folder.write("family.gltf", document.to_string());
    folder.write("triangle.glb", triangle_glb());
    folder.write(
        "inner.toml",
        "version = 1\n[[include]]\npath = 'family.gltf'\ntransform = { translate = [0, 0, 1] }\n",
    );
    let outer = "version = 1\n[[include]]\npath = 'inner.toml'\nkeyframes = [\n\
        { frame = 0, translate = [0, 0, 0] }, { frame = 24, translate = [16, 0, 0] }]\n\
        [[include]]\npath = 'triangle.glb'\n";
    let path = folder.write("outer.toml", outer);
    let animation = formats::load_animation(&path, MemoryLimit::NONE).unwrap();
    assert_eq!((animation.motion.objects.len(), animation.rest.objects.len()), (3, 4));
    assert_eq!((animation.motion.lights.len(), animation.motion.cameras.len()), (2, 1));
    let (rest, half) = (animation.scene_at(0.0).unwrap(), animation.scene_at(0.5).unwrap());
    let moved = |object: usize| {
        let first = rest.objects[object].first;
        half.corners(first)[0] - rest.corners(first)[0]
    };
    // Half of 8 up in a parent that is turned around y alone, and half of 16 to the right.
    for (object, expected) in
        [(0, [8.0, 0.0, 0.0]), (1, [8.0, 4.0, 0.0]), (2, [8.0, 4.0, 0.0]), (3, [0.0; 3])]
    {
        assert!(
            moved(object).abs_diff_eq(expected.into(), 1e-5),
            "object {object} moved by {}",
            moved(object)
        );
    }
    let camera = half.cameras[0].origin - rest.cameras[0].origin;
    assert!(camera.abs_diff_eq(Vec3::new(8.0, 4.0, 0.0), 1e-5), "{camera}");
}

#[test]
fn a_still_scene_is_the_same_at_every_time_bit_by_bit() {
    for path in ["scenes/courtyard-spots.toml", "scenes/blocks.obj"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let animation = formats::load_animation(&path, MemoryLimit::NONE).unwrap();
        assert!(animation.motion.is_empty() && animation.motion.range().is_none());
        let later = animation.scene_at(1e6).unwrap();
        assert_eq!((later.hash(), bits(&later)), (animation.rest.hash(), bits(&animation.rest)));
    }
}

#[test]
fn still_objects_keep_all_that_they_have_beside_moving_ones() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/carousel.toml");
    let animation = formats::load_animation(&path, MemoryLimit::NONE).unwrap();
    let (rest, first) = (&animation.rest, animation.scene_at(seconds(1.0)).unwrap());
    assert_eq!((rest.hash(), bits(rest)), (first.hash(), bits(&first)));
    for (one, other) in rest.objects.iter().zip(&first.objects) {
        assert_eq!((&one.name, one.material, one.polygons), (&other.name, other.material, other.polygons));
        assert_eq!((one.first, one.count, one.curved_count), (other.first, other.count, other.curved_count));
    }
    assert_ne!(animation.scene_at(seconds(6.0)).unwrap().hash(), rest.hash());
}
