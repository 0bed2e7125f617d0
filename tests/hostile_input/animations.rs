//! Animations of glTF and keyframes of TOML that are none.

use crate::fixtures::{Folder, triangle};
use crate::gltf_parts::{FLOAT, accessor, float_accessor};
use crate::refused;
use serde_json::{Value, json};

/// The triangle, moved from one place to another.
fn moving() -> Value {
    let mut document = triangle();
    let times = float_accessor(&mut document, "SCALAR", &[0.0, 1.0]);
    let places = float_accessor(&mut document, "VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    document["animations"] = json!([{
        "name": "walk",
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
        "samplers": [{ "input": times, "output": places, "interpolation": "LINEAR" }],
    }]);
    document
}

#[track_caller]
fn spoilt(spoil: impl FnOnce(&mut Value), words: &[&str]) {
    let folder = Folder::new();
    let mut document = moving();
    spoil(&mut document);
    refused(&folder.write("bad.gltf", document.to_string()), words);
}

const CHANNEL: &str = "bad.gltf: animation 0 `walk`, channel 0: ";

fn at<'d>(document: &'d mut Value, path: &str) -> &'d mut Value {
    document.pointer_mut(&format!("/animations/0/{path}")).unwrap()
}

/// Gives the sampler other times.
fn times(values: &'static [f32]) -> impl FnOnce(&mut Value) {
    move |d| {
        let input = float_accessor(d, "SCALAR", values);
        *at(d, "samplers/0/input") = json!(input);
    }
}

#[test]
fn numbers_that_lead_astray() {
    spoilt(|d| *at(d, "channels/0/sampler") = json!(1), &[CHANNEL, "sampler 1 of 1"]);
    spoilt(|d| *at(d, "channels/0/sampler") = json!(1u64 << 32), &[CHANNEL, "sampler 4294967296 of 1"]);
    spoilt(|d| *at(d, "channels/0/target/node") = json!(7), &[CHANNEL, "node 7 of 1"]);
    spoilt(|d| *at(d, "samplers/0/input") = json!(99), &[CHANNEL, "sampler 0: accessor 99 of 5"]);
    spoilt(|d| *at(d, "samplers/0/output") = json!(99), &[CHANNEL, "sampler 0: output: accessor 99 of 5"]);
    spoilt(|d| *at(d, "samplers/0/input") = json!(4), &["input: accessor 4: expected SCALAR of FLOAT"]);
    spoilt(|d| *at(d, "samplers/0/output") = json!(3), &["output: accessor 3: expected VEC3 of FLOAT"]);
    spoilt(|d| *at(d, "samplers/0/interpolation") = json!("MAGIC"), &[CHANNEL, "found `MAGIC`"]);
    spoilt(
        |d| *at(d, "samplers/0/interpolation") = json!("CUBICSPLINE"),
        &["2 elements of output, expected 6"],
    );
    spoilt(
        |d| d["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
        &[CHANNEL, "node 0 has a matrix"],
    );
    let twice = |d: &mut Value| {
        let channel = at(d, "channels/0").clone();
        *at(d, "channels") = json!([channel, channel]);
    };
    spoilt(twice, &["channel 1: another channel of this animation changes the same"]);
}

#[test]
fn times_and_values_that_are_none() {
    spoilt(times(&[0.0, 0.0]), &[CHANNEL, "times must increase"]);
    spoilt(times(&[1.0, 0.5]), &["times must increase, and that of key 1 does not"]);
    spoilt(times(&[f32::NAN, 1.0]), &["key 0 has a number that is not finite"]);
    spoilt(times(&[0.0, f32::INFINITY]), &["key 1 has a number that is not finite"]);
    spoilt(times(&[-1.0, 1.0]), &["expected times from 0 up"]);
    spoilt(times(&[0.0, 1.0, 2.0]), &["2 elements of output, expected 3 for 3 times"]);
    let value = |number: f32| {
        move |d: &mut Value| {
            let output = float_accessor(d, "VEC3", &[0.0, number, 0.0, 0.0, 0.0, 0.0]);
            *at(d, "samplers/0/output") = json!(output);
        }
    };
    spoilt(value(f32::NAN), &["key 0 has a number that is not finite"]);
    spoilt(value(f32::NEG_INFINITY), &["key 0 has a number that is not finite"]);
    let rotation = |d: &mut Value| {
        let output = float_accessor(d, "VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        *at(d, "samplers/0/output") = json!(output);
        *at(d, "channels/0/target/path") = json!("rotation");
    };
    spoilt(rotation, &["expected unit quaternions, and that of key 1 is none"]);
    let none = |d: &mut Value| {
        for path in ["samplers/0/input", "samplers/0/output"] {
            let shape = if path.ends_with("input") { "SCALAR" } else { "VEC3" };
            let empty = accessor(d, &[], (FLOAT, shape), 0);
            *at(d, path) = json!(empty);
        }
    };
    spoilt(none, &["expected at least one key"]);
}

#[test]
fn keys_without_bytes_behind_them_are_counted_before_memory_is_asked_for() {
    let zeros = |count: u64| {
        move |d: &mut Value| {
            let accessors = d["accessors"].as_array_mut().unwrap();
            accessors.push(json!({ "componentType": FLOAT, "type": "SCALAR", "count": count }));
            let input = accessors.len() - 1;
            *at(d, "samplers/0/input") = json!(input);
        }
    };
    spoilt(zeros(u64::MAX), &["all animations together have more than 4194304 keys"]);
    spoilt(zeros((1 << 22) + 1), &["all animations together have more than 4194304 keys"]);
    spoilt(zeros(1 << 22), &["2 elements of output, expected 4194304"]);
    // Many samplers of one long list of times.
    let shared = |d: &mut Value| {
        zeros(1 << 20)(d);
        let accessors = d["accessors"].as_array_mut().unwrap();
        accessors.push(json!({ "componentType": FLOAT, "type": "VEC3", "count": 1 << 20 }));
        let output = accessors.len() - 1;
        *at(d, "samplers/0/output") = json!(output);
        let nodes: Vec<Value> = (0..9).map(|_| json!({ "mesh": 0 })).collect();
        d["nodes"] = json!(nodes);
        d["scenes"][0]["nodes"] = json!((0..9).collect::<Vec<_>>());
        let mut channel = at(d, "channels/0").clone();
        let channels = (0..9).map(|node| {
            channel["target"]["node"] = json!(node);
            channel.clone()
        });
        let channels: Vec<Value> = channels.collect();
        *at(d, "channels") = json!(channels);
    };
    // The first of them already has equal times; nothing of the kind is made nine times.
    spoilt(shared, &["channel 0: sampler 0: times must increase"]);
}

#[track_caller]
fn toml_refused(text: &str, words: &[&str]) {
    let folder = Folder::new();
    let sphere = "\n[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\n";
    refused(&folder.write("bad.toml", format!("version = 1\n{text}{sphere}")), words);
}

#[test]
fn keyframes_that_are_none() {
    let mesh = |keyframes: &str| {
        let vertices = "vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]";
        format!("[[mesh]]\n{vertices}\nkeyframes = [{keyframes}]\n")
    };
    let refused = |keyframes: &str, words: &[&str]| toml_refused(&mesh(keyframes), words);
    refused("", &["bad.toml:5: mesh 1: expected at least one keyframe, found none"]);
    refused("{ frame = 1 }", &["mesh 1, keyframe 1: it says nothing but its frame"]);
    refused("{ frame = nan, translate = [0, 0, 0] }", &["expected a finite number"]);
    refused("{ translate = [0, 0, 0] }", &["missing field `frame`"]);
    refused("{ frame = 1, position = [0, 0, 0] }", &["unknown field `position`"]);
    refused("{ frame = 1, scale = 0 }", &["mesh 1: the transform makes everything flat"]);
    refused(
        "{ frame = 1, rotate = { axis = [0, 0, 0], degrees = 1 } }",
        &["expected `axis` to be a direction"],
    );
    refused("{ frame = 1, translate = [0, 0, 0], interpolation = 'smooth' }", &["unknown variant `smooth`"]);
    let two = |one: &str, other: &str| {
        format!("{{ frame = {one}, translate = [0, 0, 0] }}, {{ frame = {other}, translate = [1, 0, 0] }}")
    };
    refused(&two("2", "2"), &["mesh 1, keyframe 2: expected a later frame than that before it"]);
    refused(&two("2", "1"), &["mesh 1, keyframe 2: expected a later frame than that before it"]);
    let matrix = "[[mesh]]\nvertices = []\nfaces = []\nkeyframes = [{ frame = 1, scale = 2 }]\n\
                  transform = { matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]] }\n";
    toml_refused(matrix, &["not with `matrix`"]);
    let camera = |keys: &str| format!("[[camera]]\ntarget = [0, 0, 0]\nkeyframes = [{keys}]\n");
    toml_refused(
        &camera("{ frame = 1, position = [0, 0, 0] }"),
        &["camera 1, keyframe 1: `position` and `target`"],
    );
    toml_refused(
        &camera("{ frame = 1, up = [0, 1, 0] }"),
        &["camera 1", "expected a `position`, found none"],
    );
    let degrees = "{ frame = 1, position = [0, 0, 5], vertical_degrees = 190 }";
    toml_refused(&camera(degrees), &["camera 1, keyframe 1: expected `vertical_degrees` between 0 and 180"]);
    let light =
        "[[light]]\ntype = 'point'\nposition = [0, 5, 0]\nkeyframes = [{ frame = 1, irradiance = 2 }]\n";
    toml_refused(light, &["light 1, keyframe 1: `irradiance` is for directional lights"]);
    toml_refused("fps = 0\n", &["bad.toml:2: fps: expected frames a second above 0"]);
    toml_refused("fps = 1e9\n", &["fps: expected frames a second"]);
    let sphere =
        "[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nkeyframes = [{ frame = 1, scale = [1, 2, 1] }]\n";
    let folder = Folder::new();
    // An ellipsoid is what a sphere becomes; a plane that is stretched stays one: nothing to refuse.
    assert!(
        lightbuffer::scene::formats::load(&folder.write("fine.toml", format!("version = 1\n{sphere}")))
            .is_ok()
    );
}
