//! Random small scenes on a coarse grid: shared edges, coplanar and crossing faces, slivers, nothing nice.

use crate::cases::{Case, lamp, soup, sun};
use crate::runner::{Asked, Setting, ask};
use glam::Vec3;
use lightbuffer::scene::{Camera, ImageSize};
use lightbuffer::shadow::{Basis, REGISTRY, Resolution};
use proptest::prelude::*;

fn grid_point() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-4i8..5).prop_map(|p| Vec3::from(p.map(|x| f32::from(x) * 0.5)))
}

fn case() -> impl Strategy<Value = Case> {
    let triangles = prop::collection::vec(prop::array::uniform3(grid_point()), 2..14);
    let light = prop_oneof![
        grid_point().prop_map(lamp),
        grid_point().prop_map(|p| lamp(p * 1.37)),
        grid_point().prop_filter("a direction", |d| *d != Vec3::ZERO).prop_map(sun),
    ];
    let lights = prop::collection::vec(light, 1..4);
    (triangles, lights, grid_point(), 1usize..4).prop_map(|(triangles, lights, eye, objects)| {
        let parts = triangles.chunks(triangles.len().div_ceil(objects)).map(<[_]>::to_vec);
        let scene = soup("random", parts);
        Case {
            name: "random".into(),
            scene,
            camera: Camera::look_at("eye", eye * 2.1, Vec3::ZERO, Vec3::Y, 60.0),
            size: ImageSize { width: 24, height: 16 },
            lights,
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn all_exact_testers_agree_with_the_definition_on_random_scenes(
        case in case(),
        resolution in prop::sample::select(vec![1u32, 2, 3, 8, 33, 256]),
    ) {
        let asked = Asked::of(&case);
        let truth = asked.plain_truth();
        for entry in REGISTRY.iter().filter(|entry| entry.basis != Basis::Measured) {
            let answers = ask(entry, &asked, Setting { resolution: Resolution::Cells(resolution), threads: 1 });
            prop_assert_eq!(&answers, &truth, "{} at R = {}", entry.name, resolution);
        }
    }
}
