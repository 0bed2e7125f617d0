//! Random small scenes on a coarse grid: shared edges, coplanar and crossing faces, slivers, nothing nice.

use crate::cases::{Case, lamp, soup, sun};
use crate::exact_testers;
use crate::runner::{Asked, Setting, ask};
use glam::Vec3;
use lightbuffer::scene::{Camera, ImageSize, Shadowing};
use lightbuffer::shadow::{Culling, ObjectCoherence, Resolution, VolumeThreshold};
use proptest::prelude::*;

fn grid_point() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-4i8..5).prop_map(|p| Vec3::from(p.map(|x| f32::from(x) * 0.5)))
}

/// Mostly both; nothing may neither cast nor receive, or queries would be few.
fn shadowing() -> impl Strategy<Value = Shadowing> {
    let both = Shadowing::default();
    prop_oneof![
        4 => Just(both),
        1 => Just(Shadowing { casts: false, ..both }),
        1 => Just(Shadowing { receives: false, ..both }),
    ]
}

type Object = (Vec<[Vec3; 3]>, Shadowing);

fn triangles() -> impl Strategy<Value = Vec<Object>> {
    let triangles = prop::collection::vec(prop::array::uniform3(grid_point()), 2..14);
    (triangles, prop::array::uniform3(shadowing()), 1usize..4).prop_map(|(triangles, shadowing, objects)| {
        let parts = triangles.chunks(triangles.len().div_ceil(objects)).map(<[_]>::to_vec);
        parts.zip(shadowing).collect()
    })
}

/// Double pyramids over grid points, which may be turned inside out, cross themselves or be flat; and
/// tetrahedra. Most are solids, and many touch or cross each other.
fn solids() -> impl Strategy<Value = Vec<Object>> {
    let tetrahedron = prop::array::uniform4(grid_point())
        .prop_map(|[a, b, c, d]| vec![[a, b, c], [a, c, d], [a, d, b], [b, d, c]]);
    let pyramids = (grid_point(), prop::array::uniform6(1u8..5)).prop_map(|(centre, arms)| {
        let arm = |i: usize, axis: Vec3| centre + axis * f32::from(arms[i]) * 0.5;
        let tips = [arm(0, Vec3::Y), arm(1, Vec3::NEG_Y)];
        let rim = [arm(2, Vec3::X), arm(3, Vec3::Z), arm(4, Vec3::NEG_X), arm(5, Vec3::NEG_Z)];
        let sides = (0..4).map(|i| (rim[i], rim[(i + 1) % 4]));
        sides.flat_map(|(p, q)| [[tips[0], q, p], [tips[1], p, q]]).collect::<Vec<_>>()
    });
    let floor = grid_point().prop_map(|p| {
        let corner = |x: f32, z: f32| Vec3::new(x * 4.0, p.y - 1.0, z * 4.0);
        vec![[corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)]]
    });
    let object = prop_oneof![2 => tetrahedron, 4 => pyramids, 1 => floor];
    prop::collection::vec((object, shadowing()), 2..6)
}

fn case(objects: impl Strategy<Value = Vec<Object>>) -> impl Strategy<Value = Case> {
    let light = prop_oneof![
        grid_point().prop_map(lamp),
        grid_point().prop_map(|p| lamp(p * 1.37)),
        grid_point().prop_filter("a direction", |d| *d != Vec3::ZERO).prop_map(sun),
    ];
    let lights = prop::collection::vec(light, 1..4);
    (objects, lights, grid_point()).prop_map(|(objects, lights, eye)| {
        let scene = soup("random", objects.into_iter());
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
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn all_exact_testers_agree_with_the_definition_on_random_scenes(
        case in prop_oneof![case(triangles()).boxed(), case(solids()).boxed()],
        resolution in prop::sample::select(vec![1u32, 2, 3, 8, 33, 256]),
    ) {
        let asked = Asked::of(&case);
        let truth = asked.plain_truth();
        for entry in exact_testers() {
            for culling in [Culling::Off, Culling::ClosedSolids] {
                let setting =
                    Setting { culling, threads: 1, ..Setting::of(Resolution::Cells(resolution)) };
                let answers = ask(entry, &asked, setting);
                prop_assert_eq!(&answers, &truth, "{} with {:?}", entry.name, setting);
            }
            let thresholds: &[u32] = if entry.name == "light-buffer" { &[0, 2] } else { &[] };
            for &most_single in thresholds {
                let setting = Setting {
                    bounding_volumes: VolumeThreshold::MoreThan(most_single),
                    object_coherence: ObjectCoherence::LastOccluder,
                    threads: 1,
                    ..Setting::of(Resolution::Cells(resolution))
                };
                let answers = ask(entry, &asked, setting);
                prop_assert_eq!(&answers, &truth, "{} with {:?}", entry.name, setting);
            }
        }
    }
}
