//! Curved surfaces: who is hit, from inside and outside, and what becomes of points on them.

use super::shapes::{self, crossings};
use super::*;
use glam::Vec3;
use lightbuffer::embree::SceneParts;
use lightbuffer::geometry::curved::{Cone, Disc, Ellipsoid, InfinitePlane, Quadric, Shape};

pub fn scene_of(shapes: &[Shape], options: SceneOptions) -> EmbreeScene {
    let parts = SceneParts { curved: shapes, ..SceneParts::default() };
    EmbreeScene::of_parts(&Device::new(1).unwrap(), parts, options).unwrap()
}

/// The ends of a segment, and at how many points it meets a shape.
type Case = ([f32; 3], [f32; 3], usize);

/// One of each kind around the origin, and segments.
fn cases() -> Vec<(Shape, Vec<Case>)> {
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    let paraboloid = Quadric {
        reference: Vec3::ZERO,
        second: [1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        first: -z,
        constant: 0.0,
        low: Vec3::new(-1.0, -1.0, 0.0),
        high: Vec3::ONE,
    };
    vec![
        (
            Shape::sphere(Vec3::ZERO, 1.0),
            vec![
                ([-3.0, 0.25, 0.0], [3.0, 0.25, 0.0], 2),
                ([0.0, 0.5, 0.25], [0.0, 0.5, 5.0], 1),
                ([0.0, 4.0, 0.5], [0.0, 0.25, 0.5], 1),
                ([0.0, 0.5, 0.25], [0.5, -0.5, 0.25], 0),
                ([-3.0, 1.25, 0.0], [3.0, 1.25, 0.0], 0),
                ([-3.0, 0.25, 0.0], [-1.5, 0.25, 0.0], 0),
                ([1.5, 0.0, 0.0], [3.0, 0.0, 0.0], 0),
                ([-900.0, 0.999, 0.0], [900.0, 0.999, 0.0], 2),
                ([-900.0, 1.001, 0.0], [900.0, 1.001, 0.0], 0),
            ],
        ),
        (
            // Long along x; its axes are not perpendicular.
            Shape::Ellipsoid(Ellipsoid { centre: Vec3::ZERO, axes: [4.0 * x, y + x, 0.5 * z] }),
            vec![
                ([-9.0, 0.0, 0.0], [9.0, 0.0, 0.0], 2),
                ([3.5, 0.0, -2.0], [3.5, 0.0, 2.0], 2),
                ([3.5, -0.75, -2.0], [3.5, -0.75, 2.0], 0),
                ([0.0, 0.0, 0.0], [0.0, 0.0, 0.75], 1),
                ([0.0, 0.0, 0.0], [3.5, 0.0, 0.0], 0),
                ([0.0, 0.0, 0.75], [9.0, 0.0, 0.75], 0),
            ],
        ),
        (
            Shape::cylinder(-z, z, 0.5),
            vec![
                ([-2.0, 0.0, 0.5], [2.0, 0.0, 0.5], 2),
                ([0.0, 0.0, 0.5], [2.0, 0.0, 0.5], 1),
                ([-2.0, 0.0, 1.25], [2.0, 0.0, 1.25], 0),
                // Through both open ends, and in at one and out at the wall.
                ([0.1, 0.2, 3.0], [0.2, 0.1, -3.0], 0),
                ([0.0, 0.0, 3.0], [0.0, 0.0, -3.0], 0),
                ([0.0, 0.0, 2.0], [1.0, 0.0, -0.75], 1),
                ([0.0, 0.0, 0.5], [0.25, 0.25, 0.0], 0),
            ],
        ),
        (
            // Its tip is at z = 1; what goes on behind it is no part of it.
            Shape::Cone(Cone { base: -z, base_radius: 1.0, apex: z, apex_radius: 0.0 }),
            vec![
                ([-3.0, 0.0, 0.0], [3.0, 0.0, 0.0], 2),
                ([-3.0, 0.0, 2.0], [3.0, 0.0, 2.0], 0),
                ([-3.0, 0.75, 0.0], [3.0, 0.75, 0.0], 0),
                ([0.1, 0.0, 3.0], [0.1, 0.0, -3.0], 1),
                ([0.25, 0.0, 0.0], [0.25, 0.0, -3.0], 0),
                ([0.25, 0.0, 0.0], [2.0, 0.0, 0.0], 1),
            ],
        ),
        (
            Shape::Disc(Disc { centre: Vec3::ZERO, normal: Vec3::new(0.0, 3.0, 3.0), radius: 1.0 }),
            vec![
                ([0.25, 0.0, -1.0], [0.25, 0.0, 1.0], 1),
                ([0.25, 0.0, 1.0], [0.25, 0.0, -1.0], 1),
                ([1.25, 0.0, -1.0], [1.25, 0.0, 1.0], 0),
                ([0.0, 0.625, -1.0], [0.0, 0.625, 1.0], 1),
                ([0.0, 0.75, -1.0], [0.0, 0.75, 1.0], 0),
                ([0.25, 0.0, 0.5], [0.25, 0.0, 1.0], 0),
                // Beside it, parallel.
                ([-3.0, 0.0, 0.25], [3.0, 0.0, 0.25], 0),
            ],
        ),
        (
            Shape::Plane(InfinitePlane { point: Vec3::new(5.0, 0.0, 0.0), normal: Vec3::new(0.0, 0.0, 2.0) }),
            vec![
                ([-7.0, 3.0, 1.0], [-7.0, 4.0, -1.0], 1),
                ([1e9, -1e12, -1.0], [1e9, -1e12, 1.0], 1),
                ([1e15, 1e16, 3.0], [1e15, 1e16, 1.0], 0),
                ([-3.0, 0.0, 0.25], [3.0, 0.0, 0.25], 0),
            ],
        ),
        (
            // Slanted, so that its box is as large as a box can be.
            Shape::Plane(InfinitePlane { point: Vec3::ZERO, normal: Vec3::new(1.0, 1.0, 0.5) }),
            vec![
                ([-7.0, 3.0, 1.0], [7.0, 4.0, 3.0], 1),
                ([-1e9, 3.0, 1.0], [-1e9, -4.0, -1.0], 0),
                ([-1e9, 0.0, 0.0], [1e9, 0.0, 0.0], 1),
                ([1.0, -1.0, 0.25], [-1.0, 1.0, 0.25], 0),
            ],
        ),
        (
            Shape::Quadric(paraboloid),
            vec![
                ([-2.0, 0.0, 0.25], [2.0, 0.0, 0.25], 2),
                ([0.0, 0.0, 0.5], [2.0, 0.0, 0.5], 1),
                // Along the axis its polynomial is linear; above the box it has been cut off.
                ([0.0, 0.5, 2.0], [0.0, 0.5, -2.0], 1),
                ([0.0, 0.0, 2.0], [0.0, 0.0, 0.25], 0),
                ([-2.0, 0.0, 1.25], [2.0, 0.0, 1.25], 0),
                ([-2.0, 0.0, -0.25], [2.0, 0.0, -0.25], 0),
            ],
        ),
    ]
}

#[test]
fn every_shape_is_hit_and_missed_from_all_sides() {
    let device = Device::new(1).unwrap();
    for (shape, rays) in cases() {
        let expected: Vec<bool> = rays.iter().map(|(_, _, times)| *times > 0).collect();
        let segments: Vec<ShadowRay> = rays.iter().map(|(from, to, _)| segment(*from, *to)).collect();
        let backwards: Vec<ShadowRay> = rays.iter().map(|(from, to, _)| segment(*to, *from)).collect();
        for options in all_options() {
            let what = format!("{shape:?}, {options:?}");
            let scene = scene_of(&[shape], options);
            assert_answers(&scene, &segments, &expected, &what);
            assert_answers(&scene, &backwards, &expected, &what);
            assert_answers(&scene, &segments.repeat(7), &expected.repeat(7), &what);
        }
        for (ray, (from, to, times)) in segments.iter().zip(&rays) {
            // In pieces as well.
            let piece = |t_near, t_far| ShadowRay { t_near, t_far, ..*ray };
            let scene = scene_of(&[shape], options(Receiver::Included));
            let parts = [piece(0.0, 0.37), piece(0.37, 0.73), piece(0.73, 1.0), piece(0.0, f32::INFINITY)];
            let met = ask(&scene, &parts, QUERY);
            assert_eq!(met[..3].contains(&true), *times > 0, "{shape:?} from {from:?} to {to:?}");
            assert!(met[3] || *times == 0);
            // All of glass, and how often.
            let parts = SceneParts { curved: &[shape], transparent: &[true], ..SceneParts::default() };
            let glass = EmbreeScene::of_parts(&device, parts, options(Receiver::Included)).unwrap();
            let mut found = Vec::new();
            glass.crossed(&[*ray], QUERY, &mut found).unwrap();
            let found: Vec<_> = found.iter().map(|crossing| crossing.times as usize).collect();
            assert_eq!(found, Vec::from_iter((*times > 0).then_some(*times)), "{shape:?} {ray:?}");
        }
    }
}

/// Random shapes of all kinds and triangles in one scene, against sign changes along the segment.
#[test]
fn every_mode_meets_shapes_as_sampling_does_with_any_tail() {
    let soup = soup(12, 0);
    let shapes = shapes::random(24);
    let rays = shapes::rays(400);
    let mixed: Vec<(ShadowRay, bool)> = rays
        .into_iter()
        .filter_map(|(from, to)| {
            let by_triangle = soup.crossed_by(from, to)?;
            let times: Option<Vec<usize>> = shapes.iter().map(|shape| crossings(shape, from, to)).collect();
            Some((segment(from, to), by_triangle || times?.iter().sum::<usize>() > 0))
        })
        .collect();
    let (rays, expected): (Vec<_>, Vec<_>) = mixed.into_iter().unzip();
    let blocked = expected.iter().filter(|&&blocked| blocked).count();
    assert!(rays.len() > 270 && blocked > 60 && rays.len() - blocked > 60, "{blocked} of {}", rays.len());
    let device = Device::new(2).unwrap();
    for options in all_options() {
        let parts = SceneParts {
            vertices: &soup.vertices,
            triangles: &soup.triangles,
            curved: &shapes,
            ..SceneParts::default()
        };
        let scene = EmbreeScene::of_parts(&device, parts, options).unwrap();
        for count in [1, 4, 7, 16, 17, 257, rays.len()] {
            assert_answers(&scene, &rays[..count], &expected[..count], &format!("{options:?}"));
        }
    }
}

/// Points on a sphere, as floats can have them: facing the light they are lit, whatever side of the surface rounding has
/// put them on, and facing away they lie in the shadow of its other side.
#[test]
fn a_sphere_shadows_its_far_side_and_nothing_else() {
    let (centre, radius) = (Vec3::new(3.0, -7.0, 11.0), 2.5);
    let light = Vec3::new(13.0, 20.0, 5.0);
    let mut rays = Vec::new();
    let mut expected = Vec::new();
    for normal in shapes::directions(500) {
        let point = centre + radius * normal;
        let facing = normal.dot(light - point);
        // Nearly tangential rays are decided by the point's rounding, or by the epsilon.
        if facing.abs() > 0.05 {
            rays.push(ShadowRay { excluded: 0, ..segment(point.to_array(), light.to_array()) });
            expected.push(facing < 0.0);
        }
    }
    assert!(expected.contains(&true) && expected.contains(&false));
    let sphere = Shape::sphere(centre, radius);
    for options in all_options() {
        let scene = scene_of(&[sphere], options);
        match options.receiver {
            Receiver::Excluded => assert_answers(&scene, &rays, &expected, &format!("{options:?}")),
            // Half of the points are inside, and blocked; an epsilon is what renderers have against it.
            Receiver::Included => {
                let wrong = ask(&scene, &rays, QUERY).iter().zip(&expected).filter(|(a, e)| a != e).count();
                assert!(wrong > 50, "{wrong}, {options:?}");
                let with_epsilon: Vec<_> =
                    rays.iter().map(|ray| ShadowRay { t_near: 1e-4, ..*ray }).collect();
                assert_answers(&scene, &with_epsilon, &expected, &format!("{options:?}"));
            }
        }
    }
}

/// The camera looks into an open cylinder; its inside faces a light above the rim on the other side.
#[test]
fn the_inside_of_an_open_cylinder_lies_in_the_shadow_of_the_far_wall() {
    let cylinder = Shape::cylinder(Vec3::ZERO, Vec3::new(0.0, 0.0, 4.0), 1.0);
    let point = |z| [0.6, 0.8, z];
    let light = [-6.0, -8.0, 4.5];
    let above = [0.0, 0.0, 9.0];
    let from = |point, light, excluded| ShadowRay { excluded, ..segment(point, light) };
    let rays = [
        // The ray leaves over the rim only from the top of the wall.
        from(point(0.5), light, 0),
        from(point(3.0), light, 0),
        from(point(3.99), light, 0),
        from(point(0.5), above, 0),
        // From the outside to a light on the outside, and to one behind the cylinder.
        from(point(2.0), [6.0, 8.0, 2.0], 0),
        from(point(2.0), [-6.0, -8.0, 2.0], 0),
    ];
    let expected = [true, true, false, false, false, true];
    for options in all_options().into_iter().filter(|options| options.receiver == Receiver::Excluded) {
        let scene = scene_of(&[cylinder], options);
        assert_answers(&scene, &rays.repeat(5), &expected.repeat(5), &format!("{options:?}"));
    }
}

/// Flat surfaces never block the points on them, however far rounding has moved those.
#[test]
fn flat_receivers_never_block() {
    let disc = Shape::Disc(Disc { centre: Vec3::ZERO, normal: Vec3::new(1.0, 2.0, 3.0), radius: 5.0 });
    let plane = Shape::Plane(InfinitePlane { point: Vec3::ZERO, normal: Vec3::new(1.0, 2.0, 3.0) });
    let through = segment([0.5, 0.5, -0.75], [1.0, 1.0, 9.0]);
    let rays: Vec<_> = (0..20).map(|i| ShadowRay { excluded: [0, 1, 2][i % 3], ..through }).collect();
    for shape in [disc, plane] {
        // Two copies of it, and a sphere elsewhere: excluded is one of them alone.
        let away = Shape::sphere(Vec3::splat(90.0), 1.0);
        for options in all_options().into_iter().filter(|options| options.receiver == Receiver::Excluded) {
            let scene = scene_of(&[shape, away, away], options);
            let expected: Vec<bool> = (0..20).map(|i| i % 3 != 0).collect();
            assert_answers(&scene, &rays, &expected, &format!("{shape:?}, {options:?}"));
        }
    }
}

/// Sphere i is met by ray i alone; triangles come first in the numbering.
#[test]
fn each_lane_of_a_packet_has_its_own_excluded_sphere() {
    let count: u32 = 40;
    let at = |i: u32| 4.0 * i as f32;
    let shapes: Vec<Shape> = (0..count).map(|i| Shape::sphere(Vec3::new(at(i), 0.0, 0.0), 1.0)).collect();
    let triangles = [[0, 1, 2], [0, 2, 1]];
    let far = CORNER.map(|[x, y, z]| [x, y, z - 100.0]);
    let device = Device::new(1).unwrap();
    for stride in [2, 3] {
        let own = |i: u32| i.is_multiple_of(stride);
        let rays: Vec<ShadowRay> = (0..count)
            .map(|i| ShadowRay {
                // From the top of it upwards, and out of it for those that look at another one.
                excluded: 2 + if own(i) { i } else { (i + 1) % count },
                ..segment([at(i), 0.0, 0.999], [at(i), 0.0, 9.0])
            })
            .collect();
        let expected: Vec<bool> = (0..count).map(|i| !own(i)).collect();
        for options in all_options().into_iter().filter(|options| options.receiver == Receiver::Excluded) {
            let parts = SceneParts {
                vertices: &far,
                triangles: &triangles,
                curved: &shapes,
                ..SceneParts::default()
            };
            let scene = EmbreeScene::of_parts(&device, parts, options).unwrap();
            assert_answers(&scene, &rays, &expected, &format!("{options:?}, stride {stride}"));
            let unknown = ShadowRay { excluded: 2 + count, ..rays[0] };
            let error = scene.occluded(&[unknown], QUERY, &mut [false]).unwrap_err().to_string();
            assert!(error.contains("excludes primitive 42 of 42"), "{error}");
        }
    }
}

/// A segment that starts a denormal above a plane and leads away from it.
#[test]
fn flushing_denormals_reaches_the_callback() {
    let plane = Shape::Plane(InfinitePlane { point: Vec3::ZERO, normal: Vec3::Z });
    let away = segment([0.5, 0.5, 1e-39], [0.5, 0.5, 1.0]);
    let flushes = Device::new(1).unwrap().flushes_denormals();
    for options in all_options().into_iter().filter(|options| options.receiver == Receiver::Included) {
        let scene = scene_of(&[plane], options);
        for query in QUERIES.iter().copied() {
            let expected = query.denormals == Denormals::Flushed && flushes;
            assert_eq!(ask(&scene, &[away; 21], query), [expected; 21], "{options:?}, {query:?}");
        }
    }
}

#[test]
fn curved_surfaces_count_as_memory_and_beyond_the_range_are_refused() {
    let shapes: Vec<Shape> = (0..1000).map(|i| Shape::sphere(Vec3::splat(i as f32), 0.5)).collect();
    assert!(scene_of(&shapes, options(Receiver::Included)).bytes() > 100_000);
    let far = Shape::sphere(Vec3::splat(1e19), 1.0);
    let parts = SceneParts { curved: &[shapes[0], far], ..SceneParts::default() };
    let error = EmbreeScene::of_parts(&Device::new(1).unwrap(), parts, options(Receiver::Included));
    let text = error.unwrap_err().to_string();
    assert!(text.contains("curved surface 1, a sphere"), "{text}");
}
