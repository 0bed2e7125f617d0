//! Ten thousand lights.

use crate::{Folder, lightbuffer, names};
use lightbuffer::film::read_exr;
use std::fmt::Write;

const LIGHTS: usize = 10_000;

fn scene() -> String {
    let mut text = String::from(
        "version = 1\nname = \"lights\"\n[[mesh]]\nname = \"both\"\n\
         vertices = [[-4, 0, -4], [4, 0, -4], [0, 0, 4], [-1, 1, -1], [1, 1, -1], [0, 1, 1]]\n\
         faces = [[0, 1, 2], [3, 4, 5]]\n[[camera]]\nposition = [0, 5, 7]\ntarget = [0, 0, 0]\n",
    );
    for i in 0..LIGHTS {
        let (x, z) = ((i % 100) as f32 * 0.1 - 5.0, (i / 100) as f32 * 0.1 - 5.0);
        let _ = write!(
            text,
            "[[light]]\nname = \"l{i}\"\ntype = \"point\"\nposition = [{x}, 4, {z}]\nintensity = [0.01, 0.01, 0.01]\n"
        );
    }
    text
}

/// Every light has its channel, and the file is written and read in time: nothing in it is done for all pairs of lights.
#[test]
fn all_of_them_are_drawn() {
    let folder = Folder::new();
    let scene = folder.write("lights.toml", scene());
    let picture = folder.path("p.exr");
    let arguments =
        ["render", "-q", scene.to_str().unwrap(), "--size", "16x16", "--no-verdict", "--resolution", "4"];
    lightbuffer(arguments.into_iter().chain(["-o", picture.to_str().unwrap()])).done();
    let image = read_exr(&picture).unwrap();
    let masks = image.channels().iter().filter(|channel| channel.name.ends_with(".light-buffer"));
    assert_eq!(masks.count(), LIGHTS);
    assert!(image.channel("R").unwrap().iter().any(|&red| red > 0.0));
}

#[test]
fn an_image_that_would_need_too_much_for_them_is_refused() {
    let folder = Folder::new();
    let scene = folder.write("lights.toml", scene());
    for command in ["render", "validate"] {
        let out = folder.path(if command == "render" { "p.exr" } else { "out" });
        let arguments =
            [command, "-q", scene.to_str().unwrap(), "--size", "1280x720", "--memory-limit", "16G"];
        let line = lightbuffer(arguments.into_iter().chain(["-o", out.to_str().unwrap()])).failed();
        assert!(line.contains("1280x720 pixels with 10,000 lights would need about"), "{line}");
    }
    assert_eq!(names(&folder.path("")), ["lights.toml"]);
}
