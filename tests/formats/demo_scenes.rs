//! The scenes of `scenes/`: written by the example, read by two readers.

#[path = "../../examples/generate_scenes/scenes/mod.rs"]
mod scenes;

use lightbuffer::scene::{ImageSize, Scene, formats};
use std::path::{Path, PathBuf};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

fn load(name: &str) -> Scene {
    formats::load(&path(name)).unwrap()
}

#[test]
fn the_files_are_what_the_example_writes() {
    for (name, bytes) in scenes::all() {
        let committed = std::fs::read(path(name)).unwrap();
        assert!(committed == bytes, "scenes/{name} differs: run `cargo run --example generate_scenes`");
    }
}

#[test]
fn the_courtyard_is_large_for_its_file_and_complete() {
    let scene = load("courtyard.glb");
    assert_eq!(scene.triangles.len(), 112_492);
    assert!(std::fs::metadata(path("courtyard.glb")).unwrap().len() < 400_000);
    assert_eq!((scene.lights.len(), scene.cameras.len(), scene.objects.len()), (2, 1, 220));
    assert_eq!(scene.dropped, Default::default());
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let (low, high) = scene.bounds().unwrap();
    assert!(low.min_element() >= -12.5 && high.max_element() <= 12.5, "{low} {high}");
}

#[test]
fn the_blocks_are_few_and_their_concave_faces_are_filled() {
    let scene = load("blocks.obj");
    assert_eq!(scene.triangles.len(), 732);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!(scene.bounds().unwrap().0.y, 0.0);
}

/// How often a ray from a point meets the scene, by parity: odd means inside a solid.
fn crossings(scene: &Scene, from: glam::Vec3) -> usize {
    let from = from.as_dvec3();
    // Not along anything that the scene is aligned to.
    let towards = glam::DVec3::new(0.123, 0.871, 0.377);
    let meets = |t: u32| {
        let [a, b, c] = scene.corners(t).map(|p| p.as_dvec3() - from);
        let [u, v, w] = [(b, c), (c, a), (a, b)].map(|(p, q)| towards.dot(p.cross(q)));
        let same_side = (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
        let normal = (b - a).cross(c - a);
        same_side && normal.dot(a) / normal.dot(towards) > 0.0
    };
    (0..scene.triangles.len() as u32).filter(|&t| meets(t)).count()
}

#[test]
fn camera_and_lights_of_the_courtyard_stand_in_the_open() {
    let scene = load("courtyard.glb");
    for light in &scene.lights {
        assert_eq!(crossings(&scene, light.position().homogeneous().0) % 2, 0, "{}", light.name);
    }
    assert_eq!(crossings(&scene, scene.cameras[0].origin) % 2, 0);
    // The knot is in the picture, and the courtyard fills all of it.
    let (size, camera) = (ImageSize { width: 16, height: 9 }, &scene.cameras[0]);
    let raster = camera.raster(size);
    let mut knot = 0;
    for (x, y) in (0..size.width).flat_map(|x| (0..size.height).map(move |y| (x, y))) {
        let (origin, towards) = (camera.origin.as_dvec3(), camera.direction(&raster, x, y).as_dvec3());
        let distance = |t: u32| {
            let [a, b, c] = scene.corners(t).map(|p| p.as_dvec3() - origin);
            let sides = [(b, c), (c, a), (a, b)].map(|(p, q)| towards.dot(p.cross(q)));
            let met = sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
            let normal = (b - a).cross(c - a);
            Some(normal.dot(a) / normal.dot(towards)).filter(|t| met && *t > 0.0)
        };
        let all = (0..scene.triangles.len() as u32).filter_map(|t| Some((distance(t)?, t)));
        let nearest = all.min_by(|a, b| a.0.total_cmp(&b.0));
        let (_, seen) = nearest.unwrap_or_else(|| panic!("pixel {x}, {y} sees nothing"));
        knot += usize::from(scene.objects[scene.triangles[seen as usize].object as usize].name == "knot");
    }
    assert!(knot >= 4, "{knot}");
}

#[test]
fn every_solid_of_both_scenes_is_closed() {
    for name in ["courtyard.glb", "blocks.obj"] {
        let scene = load(name);
        for object in &scene.objects {
            let mut edges = std::collections::HashMap::new();
            for t in object.first..object.first + object.count {
                let corners = scene.corners(t).map(|p| p.to_array().map(f32::to_bits));
                for k in 0..3 {
                    let (a, b) = (corners[k], corners[(k + 1) % 3]);
                    // Each edge must be used as often one way as the other.
                    *edges.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
                }
            }
            assert!(edges.values().all(|&balance| balance == 0), "{name}: {}", object.name);
        }
    }
}

/// The `gltf` crate reads the courtyard too. It takes the file's quaternions, rounded to millionths, without
/// making them unit again, so positions twelve metres out agree to some hundredths of a millimetre.
#[test]
fn another_reader_finds_the_same_triangles() {
    let bytes = std::fs::read(path("courtyard.glb")).unwrap();
    let file = gltf::Gltf::from_slice(&bytes).unwrap();
    let scene = load("courtyard.glb");
    let mut next = 0;
    for node in file.default_scene().unwrap().nodes() {
        let Some(mesh) = node.mesh() else { continue };
        let matrix = glam::Mat4::from_cols_array_2d(&node.transform().matrix());
        for primitive in mesh.primitives() {
            let reader = primitive.reader(|_| file.blob.as_deref());
            let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
            for index in reader.read_indices().unwrap().into_u32() {
                let expected = matrix.transform_point3(positions[index as usize].into());
                let found = scene.corners(next / 3)[next as usize % 3];
                assert!((found - expected).abs().max_element() < 5e-5, "corner {next}: {found} {expected}");
                next += 1;
            }
        }
    }
    assert_eq!(next as usize, scene.triangles.len() * 3);
}

#[test]
fn the_scenes_in_toml_put_the_others_together() {
    let counts = |name: &str| {
        let scene = load(name);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        assert_eq!(scene.cameras[0].name, "view");
        let kinds: Vec<_> = scene.lights.iter().map(|light| light.kind()).collect();
        let apart =
            |of: fn(&lightbuffer::scene::Object) -> bool| scene.objects.iter().filter(|o| of(o)).count();
        (
            scene.triangles.len(),
            kinds.join(" "),
            [apart(|o| !o.shadowing.casts), apart(|o| !o.shadowing.receives)],
        )
    };
    assert_eq!(counts("courtyard-sun.toml"), (112_492, "directional".into(), [0, 0]));
    assert_eq!(counts("courtyard-spots.toml"), (112_492, "spot spot".into(), [0, 0]));
    // The blocks twice, a floor of two triangles and a carpet of four.
    assert_eq!(counts("blocks-lights.toml"), (2 * 732 + 6, "point spot directional".into(), [15, 1]));
}
