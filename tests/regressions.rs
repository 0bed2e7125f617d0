//! Wrong answers of the past, each with the input that showed it.

use glam::Vec3;
use lightbuffer::geometry::LightPosition;
use lightbuffer::geometry::batch::InstructionSet;
use lightbuffer::scene::{
    AlphaMask, Camera, Coverage, Framing, ImageSize, Material, ObjectInput, Scene, SceneBuilder, Shadowing,
    TextureCoordinates, Wrap, frame,
};
use lightbuffer::shadow::brute_force::BruteForce;
use lightbuffer::shadow::exact::Occlusion;
use lightbuffer::shadow::exact::plain::PlainTest;
use lightbuffer::shadow::light_buffer::LightBuffer;
use lightbuffer::shadow::{BuildInput, Culling, Receivers, Resolution, SceneIndex, ShadowTester, exact};
use lightbuffer::visibility::{SurfacePoint, classical, t_buffer};

fn scene(objects: &[Vec<[Vec3; 3]>]) -> Scene {
    let mut builder = SceneBuilder::new("regression");
    for triangles in objects {
        let input = ObjectInput::new(
            "object",
            triangles.iter().flatten().copied().collect(),
            (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        );
        builder.add_object(input).unwrap();
    }
    builder.finish()
}

/// Every tester says what the definition says.
fn all_agree(scene: &Scene, light: impl Into<LightPosition>, points: &[SurfacePoint], receivers: Receivers) {
    let light = light.into();
    let plain = PlainTest::new(scene, light, points);
    let truth: Vec<bool> = points.iter().map(|p| plain.decide(p) == Occlusion::Occluded).collect();
    let index = SceneIndex::new(scene);
    let input = |resolution| BuildInput { resolution, receivers, ..BuildInput::new(scene, &index, light) };
    let check = |name: String, tester: &dyn ShadowTester| {
        let mut answers = vec![false; points.len()];
        tester.occluded(points, &mut answers).unwrap();
        assert_eq!(answers, truth, "{name}");
    };
    check("exact".into(), &exact::Arbiter::new(&input(Resolution::Auto)));
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        check(format!("brute force, {set:?}"), &BruteForce::new(&input(Resolution::Auto), set));
    }
    for cells in [1, 2, 3, 7, 64] {
        for culling in [Culling::Off, Culling::ClosedSolids] {
            let input = BuildInput { culling, ..input(Resolution::Cells(cells)) };
            let buffer = LightBuffer::new(&input).unwrap();
            buffer.validate().unwrap();
            check(format!("light buffer, {cells} cells, {culling:?}"), &buffer);
        }
    }
}

fn both_sides(triangle: [Vec3; 3]) -> [[Vec3; 3]; 2] {
    let [a, b, c] = triangle;
    [[a, b, c], [a, c, b]]
}

/// Two sheets with a gap between them, their outer corners raised by `bend`, in front of a floor.
fn gap_between_sheets(bend: f32) -> Scene {
    let left = [Vec3::new(-0.25, -9.0, 1.0), Vec3::new(-0.25, 9.0, 1.0), Vec3::new(-9.0, 0.0, 1.0 + bend)];
    let right = left.map(|p| Vec3::new(-p.x, p.y, p.z));
    let sheets = both_sides(left).into_iter().chain(both_sides(right)).collect();
    let floor = vec![[Vec3::new(-9.0, -9.0, 4.0), Vec3::new(9.0, -9.0, 4.0), Vec3::new(0.0, 9.0, 4.0)]];
    scene(&[sheets, floor])
}

#[test]
fn sheets_modelled_from_both_sides_leave_the_gap_between_them_open() {
    // Every edge belongs to two triangles and every plane supports the object, yet it is no solid.
    for bend in [0.0, 0.25] {
        let scene = gap_between_sheets(bend);
        let point = SurfacePoint::on_ray(&scene, Vec3::ZERO, Vec3::new(0.0, 0.1, 1.0), 4);
        all_agree(&scene, Vec3::ZERO, &[point], Receivers::Surfaces);
    }
}

#[test]
fn differences_beyond_the_range_of_f32_are_decided() {
    // p - light overflows in x alone, so that a float filter sees (inf, finite, finite).
    let (light, huge) = (Vec3::new(-3e38, 0.0, 0.0), 3e38f32);
    let triangle =
        vec![[Vec3::new(0.0, -huge, -huge), Vec3::new(0.0, huge, -huge), Vec3::new(0.0, 1e37, huge)]];
    let scene = scene(&[triangle]);
    let steps = [-3e38f32, -2e38, -1e38, -1e37, 0.0, 1e30, 1e37, 1e38, 1.7e38, 2e38, 3e38, 3.4e38];
    let points: Vec<_> = steps
        .iter()
        .flat_map(|&x| {
            steps.iter().flat_map(move |&y| steps.map(|z| SurfacePoint::bare(Vec3::new(x, y, z)).unwrap()))
        })
        .collect();
    all_agree(&scene, light, &points, Receivers::Anywhere);
}

#[test]
fn lights_far_outside_a_scene_are_decided_as_lights_inside_are() {
    // A sheet above a grid of points, some of them straight behind its edges as seen from any light this way.
    let way = Vec3::new(-0.5, 0.75, 0.25);
    let [a, b, c, d] =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| Vec3::new(x, 1.5, z));
    let scene = scene(&[vec![[a, b, c], [a, c, d]]]);
    let steps = [-2.0f32, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0];
    let points: Vec<_> = steps
        .iter()
        .flat_map(|&x| steps.map(|z| SurfacePoint::bare(Vec3::new(x, 0.0, z)).unwrap()))
        .collect();
    for distance in [0.5f32, 2.0, 3.0, 1e3, 1e6, 1e12, 1e18, 2e18, f32::MAX] {
        all_agree(&scene, way * distance, &points, Receivers::Anywhere);
    }
    for length in [f32::from_bits(1) * 4.0, 1e-20, 1.0, f32::MAX] {
        all_agree(&scene, LightPosition::Towards(way * length), &points, Receivers::Anywhere);
    }
}

#[test]
fn fields_of_view_just_below_a_half_turn_are_seen_alike() {
    // Directions lose the view's own share to rounding and run in the image plane or behind it.
    let behind = vec![[Vec3::new(1.0, -1.0, -1.0), Vec3::new(1.0, 1.0, -1.0), Vec3::new(-1.0, 0.0, -3.0)]];
    let scene = scene(&[behind]);
    let size = ImageSize { width: 31, height: 17 };
    for below in [1e-2, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-12] {
        let camera = Camera::look_at("c", Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0), Vec3::Y, 180.0 - below);
        let filled = t_buffer::first_hits(&scene, &camera, size);
        let traced = classical::first_hits(&scene, &camera, size);
        assert_eq!(filled.primitives, traced.primitives, "{below:e} degrees below");
    }
}

#[test]
fn a_solid_that_shares_faces_with_an_earlier_object_does_not_darken_them_from_inside() {
    // The shared faces are cast once, for the cap; what remains of the solid ends before the cap's peak.
    let ring = |half: f32, z: f32| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x * half, y * half, z))
    };
    let (inner, outer, bottom) = (ring(1.0, 1.6), ring(3.0, 0.5), ring(3.0, -3.0));
    let peak = Vec3::new(0.0, 0.0, 2.0);
    let cap: Vec<_> = (0..4).map(|i| [peak, inner[i], inner[(i + 1) % 4]]).collect();
    let band = |a: [Vec3; 4], b: [Vec3; 4], i: usize| {
        let j = (i + 1) % 4;
        [[a[i], b[i], b[j]], [a[i], b[j], a[j]]]
    };
    let mut solid = cap.clone();
    solid.extend((0..4).flat_map(|i| band(inner, outer, i)));
    solid.extend((0..4).flat_map(|i| band(outer, bottom, i)));
    solid.extend([[bottom[0], bottom[1], bottom[2]], [bottom[0], bottom[2], bottom[3]]]);
    let scene = scene(&[cap, solid]);
    let up = Vec3::new(0.01, -0.02, 1.0);
    let points = [0, 4].map(|cap| SurfacePoint::on_ray(&scene, Vec3::ZERO, up, cap));
    all_agree(&scene, Vec3::new(0.1, 0.03, 0.0), &points, Receivers::Surfaces);
}

#[test]
fn scenes_of_any_size_are_framed_or_refused() {
    let triangle = |size: f32| scene(&[vec![[Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * size)]]);
    for size in [1e-36, 1e-25, 1e-20, 1.0, 1e17] {
        let mut scene = triangle(size);
        frame(&mut scene, Framing::WithFloor).unwrap();
        let image = ImageSize { width: 16, height: 16 };
        let seen = t_buffer::first_hits(&scene, &scene.cameras[0], image).primitives;
        assert!(seen.contains(&Some(0)), "{size:e}");
    }
    for size in [1e20, 1e38] {
        assert!(frame(&mut triangle(size), Framing::WithFloor).is_err(), "{size:e}");
    }
}

#[test]
fn audits_reach_triangles_at_the_end_of_the_range() {
    let far = [Vec3::new(3e38, 0.0, 1e38), Vec3::new(3e38, 1e38, 0.0), Vec3::new(2e38, 3e38, 3e38)];
    let point = SurfacePoint::bare(Vec3::new(3e38, 3e37, 3e37)).unwrap();
    all_agree(&scene(&[vec![far]]), Vec3::ZERO, &[point], Receivers::Anywhere);
}

#[test]
fn what_casts_no_shadow_lies_in_that_of_a_lone_polygon() {
    // A sheet that casts nothing, under one polygon and under two of which one covers whole cells: a cell's
    // list, or its full occlusion, seemed good for nothing, because the sheet is not among the casters.
    let square = |half: f32, z: f32| {
        let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, z);
        let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        vec![[a, b, c], [a, c, d]]
    };
    let above = square(4.0, 2.0);
    for casting in [vec![vec![above[0]]], vec![above.clone()], vec![above.clone(), square(1.0, 1.5)]] {
        let mut builder = SceneBuilder::extend(scene(&casting));
        let positions = square(8.0, 4.0).concat();
        let mut sheet = ObjectInput::new("sheet", positions, vec![[0, 1, 2], [3, 4, 5]]);
        sheet.shadowing = Shadowing { casts: false, receives: true };
        builder.add_object(sheet).unwrap();
        let scene = builder.finish();
        let first = scene.triangles.len() as u32 - 2;
        let points: Vec<_> = (-9..10)
            .flat_map(|i| (-9..10).map(move |j| Vec3::new(i as f32 * 0.2, j as f32 * 0.2, 4.0)))
            .map(|d| SurfacePoint::on_ray(&scene, Vec3::ZERO, d, first + u32::from(d.y > d.x)))
            .collect();
        all_agree(&scene, Vec3::ZERO, &points, Receivers::Surfaces);
        all_agree(&scene, LightPosition::Towards(Vec3::new(0.1, 0.2, -1.0)), &points, Receivers::Surfaces);
    }
}

#[test]
fn a_solid_with_holes_covers_no_cell_and_keeps_its_far_sides() {
    // A box with holes and a polygon with holes, which fills whole cells, between a light and a floor.
    let mut builder = SceneBuilder::new("holes");
    let wrap = [Wrap::Repeat; 2];
    let mask = builder.add_alpha_mask(AlphaMask::new(8, 8, wrap, |column, row| (column + row) % 3 == 0));
    let material = builder.add_material(Material { coverage: Coverage::Masked(mask), ..Material::default() });
    let corner = |i: usize| Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.0 } else { -1.0 }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let positions = (0..8).map(corner).map(|p| p + Vec3::Z * 4.0).collect();
    let halves = faces.iter().flat_map(|&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]]).collect();
    let polygon = vec![Vec3::new(-9.0, -9.0, 2.0), Vec3::new(9.0, -9.0, 2.0), Vec3::new(0.0, 9.0, 2.0)];
    for (positions, triangles) in [(positions, halves), (polygon, vec![[0, 1, 2]])] {
        let mut input = ObjectInput::new("with holes", positions, triangles);
        input.material = material;
        let coordinates = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let corners = vec![[0, 1, 2]; input.triangles.len()];
        input.texture_coordinates = Some(TextureCoordinates { coordinates, corners });
        builder.add_object(input).unwrap();
    }
    let floor = vec![Vec3::new(-30.0, -30.0, 8.0), Vec3::new(30.0, -30.0, 8.0), Vec3::new(0.0, 30.0, 8.0)];
    builder.add_object(ObjectInput::new("floor", floor, vec![[0, 1, 2]])).unwrap();
    let scene = builder.finish();
    let points: Vec<_> = (-14..15)
        .flat_map(|i| (-14..15).map(move |j| Vec3::new(i as f32 * 0.021, j as f32 * 0.021, 1.0)))
        .map(|d| SurfacePoint::on_ray(&scene, Vec3::ZERO, d, scene.triangles.len() as u32 - 1))
        .collect();
    all_agree(&scene, Vec3::ZERO, &points, Receivers::Surfaces);
    all_agree(&scene, Vec3::new(0.3, 0.2, 0.1), &points, Receivers::Surfaces);
    all_agree(&scene, LightPosition::Towards(Vec3::new(0.1, 0.2, -1.0)), &points, Receivers::Surfaces);
}
