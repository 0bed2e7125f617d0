//! Random small scenes of curved and transparent surfaces and mirrors: every answer, and what lies in the way.

use crate::cases::{Case, lamp, sun};
use crate::exact_testers;
use crate::runner::{Asked, Setting, ask_all};
use glam::Vec3;
use lightbuffer::geometry::curved::{Cone, Disc, Ellipsoid, InfinitePlane, Quadric, Shape};
use lightbuffer::scene::{Camera, ImageSize, Material, ObjectInput, SceneBuilder, Shadowing, Transmission};
use lightbuffer::shadow::{Resolution, VolumeThreshold, testers};
use proptest::prelude::*;

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![3 => (-4i8..5).prop_map(|x| f32::from(x) * 0.5), 1 => -2.0f32..2.0]
}

fn point() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(coordinate()).prop_map(Vec3::from)
}

fn radius() -> impl Strategy<Value = f32> {
    prop_oneof![(1i8..4).prop_map(|x| f32::from(x) * 0.5), 0.05f32..1.5]
}

fn shape() -> impl Strategy<Value = Shape> {
    let ellipsoid = (point(), prop::array::uniform3(point()))
        .prop_map(|(centre, axes)| Shape::Ellipsoid(Ellipsoid { centre, axes }));
    let ends = || prop_oneof![4 => radius(), 1 => Just(0.0)];
    let cone = (point(), ends(), point(), ends()).prop_map(|(base, base_radius, apex, apex_radius)| {
        Shape::Cone(Cone { base, base_radius, apex, apex_radius })
    });
    let disc = (point(), point(), radius())
        .prop_map(|(centre, normal, radius)| Shape::Disc(Disc { centre, normal, radius }));
    let plane = (point(), point()).prop_map(|(p, normal)| {
        Shape::Plane(InfinitePlane { point: p - Vec3::Y * 2.0, normal: normal + Vec3::Y * 3.0 })
    });
    let quadric = (point(), prop::array::uniform6(coordinate()), point(), coordinate(), point(), point())
        .prop_map(|(reference, second, first, constant, low, size)| {
            let high = low + size.abs() + Vec3::splat(0.25);
            Shape::Quadric(Quadric { reference, second, first, constant, low, high })
        });
    let sphere = (point(), radius()).prop_map(|(centre, radius)| Shape::sphere(centre, radius));
    prop_oneof![4 => sphere, 2 => ellipsoid, 4 => cone, 2 => disc, 1 => plane, 2 => quadric]
        .prop_filter("no defect", |shape| shape.defect().is_none())
}

/// Opaque, mirroring, or of two kinds of glass.
const MATERIALS: u32 = 4;

fn materials(builder: &mut SceneBuilder) {
    let glass = |transmittance: [f32; 3], refractive_index: f32| {
        let transmission = Some(Transmission { transmittance, refractive_index });
        Material { transmission, ..Material::default() }
    };
    builder.add_material(Material { mirror: [0.5; 3], ..Material::default() });
    builder.add_material(glass([0.5, 0.6, 0.7], 1.5));
    builder.add_material(glass([0.9, 0.3, 0.8], 1.0));
}

type Object = (Vec<Shape>, Vec<[Vec3; 3]>, u32, Shadowing);

fn object() -> impl Strategy<Value = Object> {
    let shadowing = prop_oneof![
        6 => Just(Shadowing::default()),
        1 => Just(Shadowing { casts: false, receives: true }),
    ];
    let shapes = prop::collection::vec(shape(), 0..4);
    let triangles = prop::collection::vec(prop::array::uniform3(point()), 0..4);
    (shapes, triangles, 0..MATERIALS, shadowing)
}

fn case() -> impl Strategy<Value = Case> {
    let light = prop_oneof![
        point().prop_map(lamp),
        point().prop_map(|p| lamp(p * 1.37 + Vec3::Y * 2.0)),
        point().prop_filter("a direction", |d| *d != Vec3::ZERO).prop_map(sun),
    ];
    let lights = prop::collection::vec(light, 1..3);
    (prop::collection::vec(object(), 1..4), lights, point()).prop_map(|(objects, lights, eye)| {
        let mut builder = SceneBuilder::new("random");
        materials(&mut builder);
        for (curved, triangles, material, shadowing) in objects {
            let positions = triangles.concat();
            let corners = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            let input = ObjectInput::new("object", positions, corners);
            builder.add_object(ObjectInput { curved, material, shadowing, ..input }).unwrap();
        }
        Case {
            name: "random".into(),
            scene: builder.finish(),
            camera: Camera::look_at("eye", eye * 2.1, Vec3::ZERO, Vec3::Y, 60.0),
            size: ImageSize { width: 16, height: 12 },
            lights,
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn all_exact_testers_agree_on_curved_and_transparent_surfaces(
        case in case(),
        resolution in prop::sample::select(vec![1u32, 2, 3, 8, 33, 256]),
    ) {
        let asked = Asked::with_trees(&case, 3);
        let truth = asked.plain_truth_all();
        for entry in exact_testers() {
            let setting = Setting { threads: 1, ..Setting::of(Resolution::Cells(resolution)) };
            let answers = ask_all(entry, &asked, setting);
            prop_assert_eq!(&answers, &truth, "{} with {:?}", entry.name, setting);
        }
        let light_buffer = testers().find(|entry| entry.name == "light-buffer").unwrap();
        let grouped = Setting {
            threads: 1,
            bounding_volumes: VolumeThreshold::MoreThan(1),
            ..Setting::of(Resolution::Cells(resolution))
        };
        prop_assert_eq!(&ask_all(light_buffer, &asked, grouped), &truth, "{:?}", grouped);
    }
}

/// Glass panes side by side and one behind the other, seen from a grid of points whose segments pass through
/// their common edges and corners: each pane of a layer is crossed once, wherever it is crossed.
#[test]
fn panes_that_share_edges_are_crossed_once() {
    let mut builder = SceneBuilder::new("panes");
    let glass = Transmission { transmittance: [0.9; 3], refractive_index: 1.0 };
    let material = builder.add_material(Material { transmission: Some(glass), ..Material::default() });
    let layers = 64;
    for layer in 0..layers {
        let y = 1.0 + layer as f32 / 64.0;
        let corner = |i: usize| Vec3::new((i % 3) as f32 - 1.0, y, (i / 3) as f32 - 1.0) * 4.0;
        let cells = [0u32, 1, 3, 4];
        let triangles = cells.iter().flat_map(|&c| [[c, c + 1, c + 4], [c, c + 4, c + 3]]).collect();
        let input = ObjectInput::new("pane", (0..9).map(corner).collect(), triangles);
        builder.add_object(ObjectInput { material, ..input }).unwrap();
    }
    let floor = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
    builder.add_object(ObjectInput::new("floor", floor.to_vec(), vec![[0, 1, 2], [0, 2, 3]])).unwrap();
    let case = Case {
        name: "panes".into(),
        scene: builder.finish(),
        camera: Camera::look_at("eye", Vec3::new(0.0, 0.5, 0.0), Vec3::ZERO, Vec3::Z, 120.0),
        size: ImageSize { width: 17, height: 17 },
        // Straight above the middle of the panes, whose edges and diagonals cross there.
        lights: vec![lamp(Vec3::new(0.0, 16.0, 0.0)), sun(Vec3::Y)],
    };
    let asked = Asked::with_trees(&case, 1);
    let truth = asked.plain_truth_all();
    assert!(truth.iter().all(|(occluded, crossed)| !occluded && crossed.len() == layers));
    for entry in exact_testers() {
        assert_eq!(ask_all(entry, &asked, Setting::of(Resolution::Cells(33))), truth, "{}", entry.name);
    }
}
