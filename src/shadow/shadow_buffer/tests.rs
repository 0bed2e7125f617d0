//! What is lit by which look-up, who is asked how, and files in place of filling.

use super::*;
use crate::geometry::curved::Shape;
use crate::scene::{
    AlphaMask, Coverage, Material, ObjectInput, SceneBuilder, Shadowing, TextureCoordinates, Transmission,
    Wrap,
};
use crate::visibility::PointSource;
use glam::DVec3;

/// A square floor at y = 0 and a smaller one at y = 1 above it, under a light at y = 2.
fn two_squares(shadowing: Shadowing) -> Scene {
    let mut builder = SceneBuilder::new("two squares");
    add_square(&mut builder, "floor", 8.0, 0.0, 0, Shadowing::default());
    add_square(&mut builder, "lid", 1.0, 1.0, 0, shadowing);
    builder.finish()
}

fn add_square(
    builder: &mut SceneBuilder,
    name: &str,
    half: f32,
    y: f32,
    material: u32,
    shadowing: Shadowing,
) {
    let corner = |x: f32, z: f32| Vec3::new(x * half, y, z * half);
    let corners = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    let input =
        ObjectInput { material, shadowing, ..ObjectInput::new(name, corners, vec![[0, 1, 2], [0, 2, 3]]) };
    builder.add_object(input).unwrap();
}

const LIGHT: Vec3 = Vec3::new(0.0, 2.0, 0.0);

fn settings(rows: u32, lookup: Lookup) -> ShadowBufferSettings {
    ShadowBufferSettings { rows, columns: 2 * rows, lookup, ..ShadowBufferSettings::default() }
}

/// A point of an object as a ray straight down from a little above it finds it.
fn above(scene: &Scene, object: usize, x: f32, z: f32) -> SurfacePoint {
    let first = scene.objects[object].first;
    let y = scene.corners(first)[0].y;
    let origin = Vec3::new(x, y + 0.25, z);
    let hit = |&p: &u32| {
        let planes = crate::geometry::ray_triangle::RayTriangle::new(origin, scene.corners(p));
        planes.is_some_and(|triangle| triangle.hit(Vec3::NEG_Y).is_some())
    };
    let primitive = (first..first + scene.objects[object].count).find(hit).expect("a hit");
    SurfacePoint::on_ray(scene, origin, Vec3::NEG_Y, primitive)
}

/// Who is occluded, by a buffer with these settings.
fn answers(scene: &Scene, shadow_buffer: ShadowBufferSettings, points: &[SurfacePoint]) -> Vec<bool> {
    let index = SceneIndex::new(scene);
    let buffer =
        ShadowBuffer::new(&BuildInput { shadow_buffer, ..BuildInput::new(scene, &index, LIGHT) }).unwrap();
    let mut answers = vec![false; points.len()];
    buffer.occluded(points, &mut answers).unwrap();
    answers
}

#[test]
fn a_lid_shadows_the_floor_and_not_itself() {
    let scene = two_squares(Shadowing::default());
    let points = [above(&scene, 0, 0.5, 0.7), above(&scene, 0, 3.0, 0.7), above(&scene, 1, 0.3, -0.4)];
    for lookup in [Lookup::Identity, Lookup::Depth] {
        assert_eq!(answers(&scene, settings(200, lookup), &points), [true, false, false], "{lookup:?}");
    }
}

#[test]
fn an_object_that_is_not_convex_shadows_itself_by_depth_alone() {
    let mut builder = SceneBuilder::new("one object");
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let positions = vec![
        corner(-8.0, 0.0, -8.0),
        corner(0.0, 0.0, 8.0),
        corner(8.0, 0.0, -8.0),
        corner(-1.0, 1.0, -1.0),
        corner(0.0, 1.0, 1.0),
        corner(1.0, 1.0, -1.0),
    ];
    builder.add_object(ObjectInput::new("both", positions, vec![[0, 1, 2], [3, 4, 5]])).unwrap();
    let scene = builder.finish();
    let origin = Vec3::new(0.0, 0.25, -0.5);
    let point = SurfacePoint::on_ray(&scene, origin, Vec3::NEG_Y, 0);
    assert_eq!(answers(&scene, settings(200, Lookup::Identity), &[point]), [false]);
    assert_eq!(answers(&scene, settings(200, Lookup::Depth), &[point]), [true]);
}

#[test]
fn what_is_not_in_the_buffer_is_looked_up_by_depth() {
    let scene = two_squares(Shadowing { casts: false, receives: true });
    let points = [above(&scene, 0, 0.5, 0.7), above(&scene, 1, 0.3, -0.4)];
    assert_eq!(answers(&scene, settings(200, Lookup::Identity), &points), [false, false]);
    let mut builder = SceneBuilder::new("glass under a lid");
    let glass = Material {
        transmission: Some(Transmission { transmittance: [0.5; 3], refractive_index: 1.0 }),
        ..Material::default()
    };
    let glass = builder.add_material(glass);
    add_square(&mut builder, "glass", 8.0, 0.0, glass, Shadowing::default());
    add_square(&mut builder, "lid", 1.0, 1.0, 0, Shadowing::default());
    let scene = builder.finish();
    let points = [above(&scene, 0, 0.5, 0.7), above(&scene, 0, 3.0, 0.7), above(&scene, 1, 0.3, -0.4)];
    assert_eq!(answers(&scene, settings(200, Lookup::Identity), &points), [true, false, false]);
    let index = SceneIndex::new(&scene);
    let buffer = ShadowBuffer::new(&BuildInput::new(&scene, &index, LIGHT)).unwrap();
    assert_eq!(buffer.bytes(), 400 * 800 * 8);
    // The glass is in nobody's way but that of what lies under it.
    let mut crossings = Crossings::default();
    let below = SurfacePoint { position: DVec3::new(3.0, -1.0, 0.5), source: PointSource::Bare };
    buffer.crossed(&[points[2], below], &mut crossings).unwrap();
    assert_eq!((crossings.of(0).len(), crossings.of(1).len()), (0, 1));
}

#[test]
fn points_in_space_are_looked_up_by_depth_where_they_may_be_asked_about() {
    let scene = two_squares(Shadowing::default());
    let index = SceneIndex::new(&scene);
    let input = BuildInput::new(&scene, &index, LIGHT);
    let points = [Vec3::new(0.2, 0.5, 0.1), Vec3::new(0.2, 1.5, 0.1), Vec3::new(5.0, 0.5, 0.0), LIGHT];
    let points = points.map(|p| SurfacePoint::bare(p).unwrap());
    let mut answers = [false; 4];
    let refused = ShadowBuffer::new(&input).unwrap().occluded(&points, &mut answers).unwrap_err();
    assert!(refused.to_string().ends_with("build it with Receivers::Anywhere"), "{refused}");
    let anywhere = BuildInput { receivers: Receivers::Anywhere, ..input };
    ShadowBuffer::new(&anywhere).unwrap().occluded(&points, &mut answers).unwrap();
    assert_eq!(answers, [true, false, false, false]);
}

#[test]
fn light_passes_through_the_holes_of_a_mask() {
    let mut builder = SceneBuilder::new("half a lid");
    add_square(&mut builder, "floor", 8.0, 0.0, 0, Shadowing::default());
    // The left half of the image is a hole.
    let mask = AlphaMask::new(2, 1, [Wrap::ClampToEdge; 2], |column, _| column == 1);
    let mask = builder.add_alpha_mask(mask);
    let material = builder.add_material(Material { coverage: Coverage::Masked(mask), ..Material::default() });
    let corner = |x: f32, z: f32| Vec3::new(x, 1.0, z);
    let lid = ObjectInput {
        material,
        texture_coordinates: Some(TextureCoordinates {
            coordinates: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            corners: vec![[0, 1, 2], [0, 2, 3]],
        }),
        ..ObjectInput::new(
            "lid",
            vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
            vec![[0, 1, 2], [0, 2, 3]],
        )
    };
    builder.add_object(lid).unwrap();
    let scene = builder.finish();
    let points = [above(&scene, 0, -0.8, 0.3), above(&scene, 0, 0.8, 0.3), above(&scene, 1, 0.5, 0.2)];
    for lookup in [Lookup::Identity, Lookup::Depth] {
        assert_eq!(answers(&scene, settings(200, lookup), &points), [false, true, false], "{lookup:?}");
    }
}

#[test]
fn a_filter_makes_edges_soft_and_a_mask_of_its_halves() {
    let scene = two_squares(Shadowing::default());
    let index = SceneIndex::new(&scene);
    let points: Vec<_> = (0..200).map(|i| above(&scene, 0, 1.0 + i as f32 * 0.01, 0.3)).collect();
    let soft = |lookup: Lookup, cells: u32| {
        let filter = FilterWidth::new(cells).unwrap();
        let shadow_buffer = ShadowBufferSettings { filter, ..settings(100, lookup) };
        let input = BuildInput { shadow_buffer, ..BuildInput::new(&scene, &index, LIGHT) };
        let buffer = ShadowBuffer::new(&input).unwrap();
        let (mut shares, mut answers) = (vec![-1.0; points.len()], vec![false; points.len()]);
        let counters = buffer.lit_share(&points, &mut shares).unwrap();
        buffer.occluded(&points, &mut answers).unwrap();
        (counters.is_some(), shares, answers)
    };
    let (is_soft, shares, _) = soft(Lookup::Identity, 1);
    assert!(!is_soft && shares.iter().all(|&share| share == -1.0));
    for lookup in [Lookup::Identity, Lookup::Depth] {
        let (is_soft, shares, answers) = soft(lookup, 5);
        assert!(is_soft && shares.iter().all(|share| (0.0..=1.0).contains(share)));
        assert!(shares.iter().filter(|&&share| share > 0.0 && share < 1.0).count() > 5, "{shares:?}");
        assert_eq!(answers, shares.iter().map(|&share| share < 0.5).collect::<Vec<_>>());
        assert_eq!((shares[0], shares[199]), (0.0, 1.0), "{lookup:?}");
    }
}

#[test]
fn what_makes_no_sense_is_refused_in_a_line() {
    let scene = two_squares(Shadowing::default());
    let index = SceneIndex::new(&scene);
    let refusal = |change: &dyn Fn(&mut BuildInput<'_>)| {
        let mut input = BuildInput::new(&scene, &index, LIGHT);
        change(&mut input);
        let line = ShadowBuffer::new(&input).err().expect("a refusal").to_string();
        assert!(!line.contains('\n'));
        line
    };
    let line = refusal(&|input| input.light = LightPosition::Towards(Vec3::Y));
    assert!(line.contains("infinitely far away"), "{line}");
    let line = refusal(&|input| input.shadow_buffer.rows = 0);
    assert_eq!(line, "shadow-buffer: 0x800 cells; expected 1 to 65536 each");
    assert!(refusal(&|input| input.shadow_buffer.columns = u32::MAX).contains("400x4294967295"));
    let line = refusal(&|input| input.shadow_buffer.bias = DepthBias::Share(f32::NAN));
    assert!(line.contains("a bias of NaN"), "{line}");
    let line = refusal(&|input| {
        input.memory = crate::memory::MemoryLimit::bytes(1 << 30);
        input.shadow_buffer = settings(65536, Lookup::Identity);
        input.shadow_buffer.columns = 65536;
    });
    assert!(line.starts_with("a shadow-buffer of 65536x65536 cells would need about"), "{line}");
}

#[test]
fn nothing_is_dark_in_an_empty_world_and_nothing_panics_in_a_tiny_buffer() {
    let mut builder = SceneBuilder::new("one ball");
    let curved = vec![Shape::sphere(Vec3::ZERO, 1.0)];
    builder.add_object(ObjectInput { curved, ..ObjectInput::new("ball", vec![], vec![]) }).unwrap();
    let scene = builder.finish();
    let index = SceneIndex::new(&scene);
    let far = SurfacePoint::bare(Vec3::new(9.0, 9.0, 9.0)).unwrap();
    for (rows, columns) in [(1, 1), (1, 7), (5, 1), (3, 3)] {
        for lookup in [Lookup::Identity, Lookup::Depth] {
            for cells in [1, 3, 63] {
                let filter = FilterWidth::new(cells).unwrap();
                let bias = DepthBias::CellWidth;
                let shadow_buffer = ShadowBufferSettings { rows, columns, lookup, filter, bias };
                let receivers = Receivers::Anywhere;
                let input = BuildInput { shadow_buffer, receivers, ..BuildInput::new(&scene, &index, LIGHT) };
                let buffer = ShadowBuffer::new(&input).unwrap();
                let mut answers = [true];
                buffer.occluded(&[far], &mut answers).unwrap();
                assert_eq!(answers, [false]);
            }
        }
    }
}

#[test]
fn a_loaded_buffer_answers_as_the_one_that_was_saved() {
    let scene = two_squares(Shadowing::default());
    let index = SceneIndex::new(&scene);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lamp.shadow-buffer");
    let points: Vec<_> =
        (0..300).map(|i| above(&scene, 0, i as f32 * 0.025 - 3.5, 0.01 * i as f32)).collect();
    let ask = |tester: &dyn ShadowTester| {
        let mut answers = vec![false; points.len()];
        tester.occluded(&points, &mut answers).unwrap();
        answers
    };
    for lookup in [Lookup::Identity, Lookup::Depth] {
        let shadow_buffer = settings(90, lookup);
        let input = BuildInput { shadow_buffer, ..BuildInput::new(&scene, &index, LIGHT) };
        let build = |shadow_buffer_file| (ENTRY.build)(&BuildInput { shadow_buffer_file, ..input }).unwrap();
        let fresh = build(BufferFile::Save(&path));
        let loaded = build(BufferFile::Load(&path));
        assert_eq!(ask(fresh.as_ref()), ask(loaded.as_ref()));
        assert_eq!(ask(fresh.as_ref()), ask(build(BufferFile::Unused).as_ref()));
        assert!(ask(fresh.as_ref()).contains(&true) && ask(fresh.as_ref()).contains(&false));
        assert_eq!(fresh.bytes(), loaded.bytes());
        assert!(loaded.statistics().contains(&("filled", "no, loaded".into())));
        // A filter is no part of a file, what is looked up is.
        let softer = ShadowBufferSettings { filter: FilterWidth::new(3).unwrap(), ..shadow_buffer };
        assert!(ShadowBuffer::load(&BuildInput { shadow_buffer: softer, ..input }, &path).is_ok());
        let other = if lookup == Lookup::Depth { Lookup::Identity } else { Lookup::Depth };
        let other = BuildInput { shadow_buffer: settings(90, other), ..input };
        assert!(ShadowBuffer::load(&other, &path).err().unwrap().to_string().contains("another look-up"));
        let moved = BuildInput { light: LightPosition::At(Vec3::new(0.0, 2.0, 0.1)), ..input };
        assert!(ShadowBuffer::load(&moved, &path).err().unwrap().to_string().contains("another light"));
    }
}
