//! One scene in every format: the same triangles, bit by bit and in the same order.

use crate::corners;
use crate::fixtures::Folder;
use crate::ply_writer::encoded;
use crate::polygon_writers::{gltf, nff, obj, ply, toml};
use lightbuffer::scene::{Scene, formats};

/// Polygons whose numbers have no short form in decimal: convex, concave, with a corner in the middle of an
/// edge, tilted, tiny and far away.
fn polygons() -> Vec<Vec<[f32; 3]>> {
    let comb: Vec<[f32; 3]> = (0..24)
        .map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / 24.0;
            let radius = if i % 2 == 0 { 1.0 } else { 0.3 };
            let (u, v) = (radius * libm::cos(angle), radius * libm::sin(angle));
            [u as f32, (0.7 * v) as f32, (0.3 * u + 0.1 * v) as f32]
        })
        .collect();
    let tiny = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [3.0, 1.0]].map(|[x, y]| [x * 1e-30, y * 1e-30, 0.0]);
    let far = [[0.0, 0.1], [1.0 / 3.0, 0.1], [2.0 / 3.0, 0.1], [2.0 / 3.0, 0.9], [0.0, 0.9]]
        .map(|[x, y]| [x * 1e7f32, 12_345.678, y * 1e7]);
    vec![
        vec![[0.1, 0.2, 0.3], [1.1, 0.2, 1.0 / 3.0], [0.1, 1.7, 0.3]],
        comb.iter().rev().copied().collect(),
        comb,
        tiny.to_vec(),
        far.to_vec(),
        vec![[-1.0, -2.0, 0.5], [3.0, -2.0, 0.5], [3.0, 2.0, 0.5], [-1.0, 2.0, 0.5]],
    ]
}

fn bits(scene: &Scene) -> Vec<[[u32; 3]; 3]> {
    corners(scene).into_iter().map(|triangle| triangle.map(|corner| corner.map(f32::to_bits))).collect()
}

#[test]
fn one_scene_has_the_same_triangles_in_every_format() {
    let polygons = polygons();
    let folder = Folder::new();
    let load = |name: &str, bytes: &[u8]| formats::load(&folder.write(name, bytes)).unwrap();
    let reference = load("scene.obj", obj(&polygons).as_bytes());
    assert_eq!(reference.triangles.len(), polygons.iter().map(|polygon| polygon.len() - 2).sum::<usize>());
    // Every corner of the polygons is there with its bits, and nothing else.
    let sorted = |mut all: Vec<[u32; 3]>| {
        all.sort_unstable();
        all.dedup();
        all
    };
    let given = polygons.iter().flatten().map(|corner| corner.map(f32::to_bits)).collect();
    assert_eq!(sorted(bits(&reference).into_iter().flatten().collect()), sorted(given));

    let others = [
        load("ascii.ply", encoded(&ply(&polygons), "ascii").as_slice()),
        load("little.ply", encoded(&ply(&polygons), "binary_little_endian").as_slice()),
        load("big.ply", encoded(&ply(&polygons), "binary_big_endian").as_slice()),
        load("scene.nff", nff(&polygons).as_bytes()),
        load("scene.gltf", gltf(&corners(&reference)).as_bytes()),
        load("scene.toml", toml(&polygons).as_bytes()),
        load("of_obj.toml", b"version = 1\n[[include]]\npath = 'scene.obj'\ntransform = {}\n"),
        load("of_gltf.toml", b"version = 1\n[[include]]\npath = 'scene.gltf'\n"),
    ];
    for scene in &others {
        assert_eq!(bits(scene), bits(&reference), "{}", scene.name);
        assert_eq!(scene.dropped, reference.dropped);
    }
}
