//! One query through every tester.

use crate::{BLOCKS, Folder, HEIGHT, SIZE, WIDTH, json, lightbuffer, validate};
use lightbuffer::film::read_exr;
use serde_json::{Value, json};

/// An epsilon that lets Embree miss much, in a reproducible way.
#[cfg(feature = "embree")]
const EPSILON: [&str; 2] = ["--embree-epsilon", "0.3"];

fn replay(options: &[&str]) -> Value {
    let arguments = ["replay", "-q", SIZE[0], SIZE[1], "--json", "-"];
    json(&lightbuffer(arguments.iter().chain(options)).done().stdout)
}

/// The verdict channel of a run, a code a pixel.
fn verdicts(scene: &str, light: &str, options: &[&str]) -> Vec<f32> {
    let folder = Folder::new();
    validate(scene, &folder.path("out"), options).done();
    let image = read_exr(&folder.path("out").join("image.exr")).unwrap();
    image.channel(&format!("shadow.{light}.verdict")).unwrap().to_vec()
}

fn pixel_with(codes: &[f32], code: f32) -> String {
    let at = codes.iter().position(|&c| c == code).unwrap_or_else(|| panic!("no pixel of code {code}"));
    assert_eq!(codes.len(), WIDTH * HEIGHT);
    format!("{},{}", at % WIDTH, at / WIDTH)
}

#[cfg(feature = "embree")]
#[test]
fn a_pixel_where_embree_errs_says_what_everyone_answered_and_why() {
    let codes = verdicts(BLOCKS, "key", &EPSILON);
    let pixel = pixel_with(&codes, 105.0);
    let replayed = replay(&[BLOCKS, "--pixel", &pixel, EPSILON[0], EPSILON[1]]);
    assert_eq!(replayed["status"], "query");
    // Only what is left out at the ends can be missing: the light is let through.
    assert_eq!(replayed["truth"], true);
    assert_eq!(replayed["cause"], "epsilon");
    assert_eq!(replayed["causes"]["embree"], "epsilon");
    let answers = replayed["testers"].as_object().unwrap();
    for name in ["exact", "brute-force", "bounding-volumes", "light-buffer"] {
        assert_eq!(answers[name], true, "{name}");
    }
    assert_eq!(answers["embree"], false);
    assert_eq!(replayed["traced"]["embree"]["t_near"].as_f64().unwrap() as f32, 0.3);
    assert_eq!(replayed["meets"][0]["at"], "interior");
    let text =
        lightbuffer(["replay", "-q", SIZE[0], SIZE[1], BLOCKS, "--pixel", &pixel, EPSILON[0], EPSILON[1]]);
    let text = text.done().stdout;
    assert!(text.contains("truth: occluded") && text.contains("WRONG by epsilon"), "{text}");
}

#[test]
fn floats_read_back_exactly() {
    let codes = verdicts(BLOCKS, "key", &[]);
    let arguments = [BLOCKS, "--pixel", &pixel_with(&codes, 3.0)];
    let replayed = replay(&arguments);
    let text = lightbuffer(["replay", "-q", SIZE[0], SIZE[1]].iter().chain(&arguments)).done().stdout;
    let numbers = |value: &Value| -> Vec<f64> {
        value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
    };
    let vectors =
        [&replayed["ray"]["origin"], &replayed["ray"]["direction"], &replayed["primitive"]["vertices"][2]];
    for value in vectors.into_iter().flat_map(numbers) {
        let bits = format!("({:08x})", (value as f32).to_bits());
        assert!(text.contains(&bits), "{value} {bits} is not in {text}");
    }
    for value in numbers(&replayed["point"]) {
        assert!(text.contains(&format!("({:016x})", value.to_bits())), "{value} is not in {text}");
    }
    assert_eq!(replayed["truth"], true);
    assert_eq!(replayed["cause"], Value::Null);
    let object = replayed["primitive"]["object"].as_u64().unwrap();
    assert!(object >= 1 && replayed["primitive"]["surface"].as_u64().unwrap() >= 1);
}

#[test]
fn what_is_no_query_says_so() {
    let codes = verdicts(BLOCKS, "key", &[]);
    for (code, status) in [(0.0, "background"), (1.0, "facing-away")] {
        let replayed = replay(&[BLOCKS, "--pixel", &pixel_with(&codes, code)]);
        assert_eq!(replayed["status"], status);
        assert_eq!((&replayed["truth"], &replayed["testers"]), (&Value::Null, &json!({})));
    }
}

#[test]
fn a_light_is_put_somewhere_or_chosen_by_name() {
    let lit = |options: &[&str]| replay(&[&[BLOCKS, "--pixel", "48,40"], options].concat())["light"].take();
    assert_eq!(lit(&[])["name"], "key");
    assert_eq!(lit(&["--light", "1,2,3"])["position"], json!([1.0, 2.0, 3.0]));
    let chosen = lit(&["--light", "1,2,3", "--light", "4,5,6", "--light", "light-2"]);
    assert_eq!(chosen["position"], json!([4.0, 5.0, 6.0]));
    assert_eq!(lit(&["--lights", "3", "--light", "light-3"])["name"], "light-3");
    let fails = |options: &[&str]| {
        lightbuffer(["replay", "-q", SIZE[0], SIZE[1], BLOCKS].iter().chain(options)).failed()
    };
    let line = fails(&["--pixel", "1,1", "--lights", "2"]);
    assert!(line.ends_with("which --light? The scene has: light-1, light-2"), "{line}");
    let line = fails(&["--pixel", "1,1", "--light", "sun"]);
    assert!(line.ends_with("no light `sun`; the scene has: key"), "{line}");
    let line = fails(&["--pixel", "96,0"]);
    assert!(line.ends_with("--pixel 96,0: the image is 96x54"), "{line}");
}
