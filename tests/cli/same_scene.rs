//! One scene in every format: the same shadows, bit by bit.

use crate::polygon_writers::{gltf, nff, obj, ply, toml};
use crate::{BLOCKS, Folder, validate};
use lightbuffer::film::read_exr;
use lightbuffer::scene::formats;
use std::path::Path;

/// The polygons of the blocks, some of them concave.
fn polygons() -> Vec<Vec<[f32; 3]>> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(BLOCKS)).unwrap();
    let mut vertices: Vec<[f32; 3]> = Vec::new();
    let mut polygons = Vec::new();
    for line in text.lines() {
        let (keyword, rest) = line.split_once(' ').unwrap_or((line, ""));
        match keyword {
            "v" => {
                let numbers: Vec<f32> = rest.split(' ').map(|number| number.parse().unwrap()).collect();
                vertices.push(numbers.try_into().unwrap());
            }
            "f" => {
                let corner = |number: &str| vertices[number.parse::<usize>().unwrap() - 1];
                polygons.push(rest.split(' ').map(corner).collect());
            }
            _ => {}
        }
    }
    polygons
}

/// Every channel of a mask or of what is said about masks, as bits.
fn shadows(folder: &Folder, name: &str, bytes: &[u8]) -> Vec<(String, Vec<u32>)> {
    let (scene, out) = (folder.write(name, bytes), folder.path("out"));
    // By identity the shadow-buffer's shadows depend on what a format calls an object.
    let lookup = ["--shadow-buffer-lookup", "depth"];
    let options = ["--light", "-9,2,3", "--light", "7,2,6", "--no-floor"];
    validate(&scene, &out, &[&options[..], &lookup].concat()).done();
    let image = read_exr(&out.join("image.exr")).unwrap();
    let masks = image.channels().iter().filter(|plane| plane.name.starts_with("shadow."));
    masks.map(|plane| (plane.name.clone(), plane.samples.iter().map(|s| s.to_bits()).collect())).collect()
}

#[test]
fn one_scene_has_the_same_shadows_in_every_format() {
    let folder = Folder::new();
    let polygons = polygons();
    let reference = shadows(&folder, "scene.obj", obj(&polygons).as_bytes());
    // Every tester's mask for both lights, with shadows in it.
    assert!(reference.len() >= 2 * lightbuffer::shadow::REGISTRY.len());
    let occluded = |name: &str| {
        let (_, samples) = reference.iter().find(|(channel, _)| channel == name).unwrap();
        samples.iter().filter(|bits| **bits == 1f32.to_bits()).count()
    };
    assert!(occluded("shadow.light-1.light-buffer") > 20 && occluded("shadow.light-2.exact") > 20);
    let scene = formats::load(&folder.path("scene.obj")).unwrap();
    let triangles: Vec<[[f32; 3]; 3]> =
        (0..scene.triangles.len() as u32).map(|t| scene.corners(t).map(|p| p.to_array())).collect();
    for (name, bytes) in [
        ("scene.ply", ply(&polygons)),
        ("scene.nff", nff(&polygons)),
        ("scene.gltf", gltf(&triangles)),
        ("scene.toml", toml(&polygons)),
        ("included.toml", "version = 1\n[[include]]\npath = 'scene.ply'\n".into()),
    ] {
        assert!(shadows(&folder, name, bytes.as_bytes()) == reference, "{name} has other shadows");
    }
}
