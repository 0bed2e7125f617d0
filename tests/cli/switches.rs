//! REALITY's switches of `render`: what is left out is not there, and who finds first hits changes nothing.

use crate::{Folder, Run, json, lightbuffer};
use lightbuffer::film::{ImagePlanes, read_exr};

const SMALL: [&str; 4] = ["-q", "--no-verdict", "--size", "32x24"];

fn render(folder: &Folder, scene: &str, name: &str, options: &[&str]) -> Run {
    let path = folder.path(name);
    let arguments = ["render", scene, "-o", path.to_str().unwrap()];
    lightbuffer(arguments.iter().chain(&SMALL).chain(options)).done()
}

fn image(folder: &Folder, scene: &str, options: &[&str]) -> ImagePlanes {
    render(folder, scene, "picture.exr", options);
    read_exr(&folder.path("picture.exr")).unwrap()
}

fn samples<'a>(image: &'a ImagePlanes, name: &str) -> &'a [f32] {
    image.channel(name).unwrap_or_else(|| panic!("no channel {name}"))
}

#[test]
fn pictures_are_the_same_bytes_whoever_finds_first_hits() {
    let folder = Folder::new();
    let in_repository = std::fs::read_dir("scenes").unwrap().map(|entry| entry.unwrap().path());
    let is_scene = |path: &std::path::PathBuf| path.extension().is_some_and(|extension| extension != "mtl");
    let mut scenes: Vec<String> =
        in_repository.filter(is_scene).map(|path| path.to_str().unwrap().into()).collect();
    assert!(scenes.len() >= 5, "{scenes:?}");
    scenes.extend(
        ["three-spheres", "stacked-spheres", "stacked-triangles"].map(|name| format!("builtin:{name}")),
    );
    for scene in scenes {
        let bytes = |method: &str| {
            render(&folder, &scene, "picture.exr", &["--first-hits", method]);
            ["picture.exr", "picture.png"].map(|name| std::fs::read(folder.path(name)).unwrap())
        };
        let by_t_buffer = bytes("t-buffer");
        assert!(by_t_buffer == bytes("classical"), "{scene}: classical");
        assert!(by_t_buffer == bytes("hierarchy"), "{scene}: hierarchy");
    }
}

#[test]
fn without_shadows_nobody_is_asked_and_nothing_is_dark_that_is_faced() {
    let folder = Folder::new();
    for scene in ["builtin:stacked-spheres", "scenes/courtyard-spots.toml"] {
        let options = ["--no-reflections", "--no-refractions"];
        let with = image(&folder, scene, &options);
        let run =
            render(&folder, scene, "picture.exr", &[&options[..], &["--no-shadows", "--json", "-"]].concat());
        let without = read_exr(&folder.path("picture.exr")).unwrap();
        let masks = |image: &ImagePlanes| -> Vec<String> {
            let names = image.channels().iter().map(|c| c.name.clone());
            names.filter(|name| name.starts_with("shadow.")).collect()
        };
        assert!(!masks(&with).is_empty() && masks(&without).is_empty(), "{scene}");
        let facts = json(&run.stdout);
        assert!(facts["shadow"].is_null());
        assert_eq!(facts["left_out"], serde_json::json!(["shadows", "reflections", "refractions"]));
        for light in facts["lights"].as_array().unwrap() {
            assert_eq!(light["queries"], 0);
            assert!(light["shadowed"].is_null() && light["build_seconds"].is_null());
        }
        assert_eq!(without.attribute("leftOut"), Some("shadows reflections refractions"));
        assert_eq!(without.attribute("shadow"), None);
        let masks: Vec<&[f32]> = masks(&with).iter().map(|name| samples(&with, name)).collect();
        let (dark, bright) = (samples(&with, "G"), samples(&without, "G"));
        let mut brighter = 0;
        for pixel in 0..dark.len() {
            if masks.iter().all(|mask| mask[pixel] == 0.0) {
                assert_eq!(dark[pixel], bright[pixel], "{scene}: pixel {pixel}");
            } else {
                assert!(bright[pixel] >= dark[pixel], "{scene}: pixel {pixel}");
                brighter += u32::from(bright[pixel] > dark[pixel]);
            }
        }
        assert!(brighter > 10, "{scene}: {brighter}");
    }
}

#[test]
fn without_rays_of_mirrors_and_glass_a_picture_is_one_ray_deep() {
    let folder = Folder::new();
    let colours = |scene: &str, options: &[&str]| {
        let image = image(&folder, scene, options);
        ["R", "G", "B"].map(|name| samples(&image, name).to_vec())
    };
    let mirrors = "builtin:three-spheres";
    let flat = colours(mirrors, &["--depth", "1"]);
    assert_eq!(colours(mirrors, &["--no-reflections"]), flat);
    assert_ne!(colours(mirrors, &[]), flat);
    assert_eq!(colours(mirrors, &["--no-refractions"]), colours(mirrors, &[]));
    let glass = "builtin:glass-leaved-tree";
    let flat = colours(glass, &["--depth", "1"]);
    assert_eq!(colours(glass, &["--no-refractions", "--no-reflections"]), flat);
    let (refracted, reflected) =
        (colours(glass, &["--no-reflections"]), colours(glass, &["--no-refractions"]));
    assert!(refracted != flat && reflected != flat && refracted != reflected);
}

#[test]
fn without_textures_every_object_has_one_colour() {
    let folder = Folder::new();
    let colours = |options: &[&str]| {
        let image = image(&folder, "builtin:three-spheres", options);
        let objects = samples(&image, "id.object").iter().map(|&id| id as u32);
        let mut pairs: Vec<_> =
            objects.zip(samples(&image, "albedo.R").iter().map(|albedo| albedo.to_bits())).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs.iter().filter(|(object, _)| *object > 0).count()
    };
    // Ground and top sphere are chequered.
    assert_eq!((colours(&[]), colours(&["--no-textures"])), (6, 4));
}

#[test]
fn switches_that_contradict_each_other_are_refused() {
    let folder = Folder::new();
    let out = folder.path("picture.exr");
    let run = |options: &[&str]| {
        let arguments = ["render", "builtin:three-spheres", "-o", out.to_str().unwrap()];
        lightbuffer(arguments.iter().chain(options))
    };
    run(&["--no-shadows", "--shadow", "exact"]).misused("--no-shadows");
    run(&["--first-hits", "z-buffer"]).misused("t-buffer, classical, hierarchy");
    assert!(!out.exists());
}
