//! Points on curved surfaces, most of them irrational.

use super::*;
use crate::geometry::curved::Quadric;
use crate::scene::{AlphaMask, Coverage, TextureCoordinates, Wrap};

#[test]
fn the_far_wall_of_an_open_cylinder_is_shadowed_by_the_near_one() {
    // Through the open end to (1, 0, 3) on the inside.
    let scene = curved(&[Shape::cylinder(Vec3::ZERO, Vec3::Z * 4.0, 1.0)]);
    let inside = on(0, Vec3::new(0.0, 0.0, 5.0), Vec3::new(1.0, 0.0, -2.0), Crossing::Leaving);
    let from = |z: f32| truth(&scene, at(-3.0, 0.0, z), inside);
    assert_eq!((from(3.5), from(9.0), from(5.0)), (OCCLUDED, LIT, OCCLUDED_TOUCHING));
    assert_eq!((from(5.0f32.next_down()), from(5.0f32.next_up())), (OCCLUDED, LIT));
    assert_eq!(truth(&scene, at(0.0, 0.0, 3.0), inside), LIT, "a light inside");
    assert_eq!(truth(&scene, towards(-1.0, 0.0, 0.5), inside), OCCLUDED_TOUCHING);
    // The other side of the same point.
    let outside = on(0, Vec3::new(9.0, 0.0, 3.0), Vec3::NEG_X, Crossing::Entering);
    assert_eq!(truth(&scene, at(2.0, 0.0, 3.5), outside), LIT);
    assert_eq!(truth(&scene, at(-3.0, 0.0, 3.5), outside), OCCLUDED);
    // Up along the wall.
    assert_eq!(truth(&scene, at(1.0, 0.0, 9.0), outside), LIT);
}

#[test]
fn a_saddle_shadows_itself() {
    let shape = Shape::Quadric(Quadric {
        reference: Vec3::ZERO,
        second: [1.0, 1.0, -1.0, 0.0, 0.0, 0.0],
        first: Vec3::ZERO,
        constant: -1.0,
        low: Vec3::splat(-2.0),
        high: Vec3::splat(2.0),
    });
    let scene = curved(&[shape]);
    // (1, 0, 0) from outside; the waist is concave along z.
    let waist = on(0, Vec3::X * 3.0, Vec3::NEG_X, Crossing::Entering);
    assert_eq!(truth(&scene, at(-3.0, 0.0, 0.0), waist), OCCLUDED);
    assert_eq!(truth(&scene, at(3.0, 0.5, 0.0), waist), LIT);
    assert_eq!(truth(&scene, at(1.0, 3.0, 3.0), waist), LIT, "a generator");
    // Outwards and steeply up: x = 1 + s, z = 2 s is met again where 2 s = 3 s^2, at z = 4/3.
    assert_eq!(truth(&scene, at(2.0, 0.0, 2.0), waist), OCCLUDED);
    assert_eq!(truth(&scene, towards(1.0, 0.0, 2.0), waist), OCCLUDED);
    // Met again at z = 2 s with s (1 - 4) + 2 a = 0 for x = 1 + a s; at z = 2 for a = 3/2: at the box's rim.
    assert_eq!(truth(&scene, towards(1.5, 0.0, 2.0), waist), LIT, "x is 5/2 there");
}

#[test]
fn a_tangent_decides_within_one_ulp() {
    // (3, 4, 0) on the sphere of radius 5, where (-4, 3, 0) is a tangent.
    let scene = curved(&[Shape::sphere(Vec3::ZERO, 5.0)]);
    let point = on(0, Vec3::new(3.0, 9.0, 0.0), Vec3::NEG_Y, Crossing::Entering);
    let from = |y| truth(&scene, at(-1.0, y, 0.0), point);
    assert_eq!((from(7.0), from(7.0f32.next_up()), from(7.0f32.next_down())), (LIT, LIT, OCCLUDED));
    let towards = |x, y| truth(&scene, towards(x, y, 0.0), point);
    assert_eq!((towards(-4.0, 3.0), towards(-4.0, 3.0f32.next_up())), (LIT, LIT));
    assert_eq!(towards(-4.0, 3.0f32.next_down()), OCCLUDED);
}

#[test]
fn irrational_points_are_exact() {
    // (sqrt(3/4), 1/2, 0) on the unit sphere, where z is a tangent.
    let scene = curved(&[Shape::sphere(Vec3::ZERO, 1.0)]);
    let origin = Vec3::new(3.0, 0.5, 0.0);
    let near = on(0, origin, Vec3::NEG_X, Crossing::Entering);
    let far = on(0, origin, Vec3::NEG_X, Crossing::Leaving);
    assert_eq!(truth(&scene, towards(0.0, 0.0, 1.0), near), LIT);
    assert_eq!(truth(&scene, towards(-1e-38, 0.0, 1.0), near), OCCLUDED);
    assert_eq!(truth(&scene, towards(1e-38, 0.0, 1.0), near), LIT);
    assert_eq!(truth(&scene, towards(1e-38, 0.0, 1.0), far), OCCLUDED);
    assert_eq!(truth(&scene, towards(-1e-38, 0.0, 1.0), far), LIT);
    assert_eq!(truth(&scene, at(0.0, 0.0, 0.5), near), LIT, "a light inside");
    assert_eq!(truth(&scene, at(0.0, 0.0, 3.0), near), OCCLUDED);
    assert_eq!(truth(&scene, at(0.0, 0.0, 9.0), near), OCCLUDED);
    assert_eq!(truth(&scene, at(3.0, 0.0, 0.0), near), LIT);
}

#[test]
fn the_edge_of_a_triangle_is_met_exactly_from_an_irrational_point() {
    // A light straight above (sqrt(3/4), 1/2, 0) in y; the triangle's edge runs along y = 2, z = 0.
    let scene = |z: f32| {
        let triangle = [Vec3::new(-5.0, 2.0, z), Vec3::new(5.0, 2.0, z), Vec3::new(0.0, 2.0, z + 5.0)];
        World::new().with(Matter::Opaque, &[triangle], &[Shape::sphere(Vec3::ZERO, 1.0)]).scene()
    };
    let point = on(1, Vec3::new(3.0, 0.5, 0.0), Vec3::NEG_X, Crossing::Entering);
    for light in [at(1.0, 9.0, 0.0), towards(0.25, 1.0, 0.0)] {
        assert_eq!(truth(&scene(0.0), light, point), OCCLUDED_TOUCHING);
        assert_eq!(truth(&scene(-1e-30), light, point), OCCLUDED);
        assert_eq!(truth(&scene(1e-30), light, point), LIT);
    }
    // Two triangles that share the edge leave no gap.
    let up = [Vec3::new(-5.0, 2.0, 0.0), Vec3::new(5.0, 2.0, 0.0), Vec3::new(0.0, 2.0, 5.0)];
    let down = [up[0], up[1], Vec3::new(0.0, 3.0, -5.0)];
    let closed = World::new().with(Matter::Opaque, &[up, down], &[Shape::sphere(Vec3::ZERO, 1.0)]).scene();
    let point = on(2, Vec3::new(3.0, 0.5, 0.0), Vec3::NEG_X, Crossing::Entering);
    for light in [at(1.0, 9.0, 0.0), towards(0.25, 1.0, 0.0)] {
        assert_eq!(truth(&closed, light, point), OCCLUDED);
    }
}

#[test]
fn spheres_that_touch_each_other_touch() {
    let scene = curved(&[Shape::sphere(Vec3::ZERO, 1.0), Shape::sphere(Vec3::Y * 3.0, 2.0)]);
    let common = on(0, Vec3::new(5.0, 1.0, 0.0), Vec3::NEG_X, Crossing::Entering);
    assert_eq!(truth(&scene, at(5.0, 1.0, 0.0), common), LIT_TOUCHING);
    assert_eq!(truth(&scene, at(5.0, 1.5, 0.0), common), OCCLUDED);
    let twice = curved(&[Shape::sphere(Vec3::ZERO, 1.0); 2]);
    assert_eq!(truth(&twice, at(5.0, 2.0, 0.0), common), LIT, "the same surface twice");
    assert_eq!(truth(&twice, at(0.0, -5.0, 0.0), common), OCCLUDED);
}

#[test]
fn a_cone_is_met_from_its_own_wall() {
    // Radius 2 - z; (1, 0, 1) from outside, along x.
    let scene = curved(&[Shape::cone(Vec3::ZERO, 2.0, Vec3::Z * 2.0, 0.0)]);
    let wall = on(0, Vec3::new(5.0, 0.0, 1.0), Vec3::NEG_X, Crossing::Entering);
    assert_eq!(truth(&scene, at(5.0, 0.0, 3.0), wall), LIT);
    assert_eq!(truth(&scene, at(-5.0, 0.0, 1.5), wall), OCCLUDED);
    assert_eq!(truth(&scene, at(-5.0, 0.0, 7.0), wall), LIT, "along a generator");
    assert_eq!(truth(&scene, at(-5.0, 0.0, 7.0f32.next_down()), wall), OCCLUDED);
    assert_eq!(truth(&scene, at(-5.0, 0.0, 7.0f32.next_up()), wall), LIT);
    // A ray along a generator of the other side meets the wall once, at the same point from inside.
    let inside = on(0, Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0), Crossing::Leaving);
    assert_eq!(truth(&scene, at(0.0, 0.0, 1.5), inside), LIT);
    assert_eq!(truth(&scene, at(-5.0, 0.0, 7.0f32.next_down()), inside), OCCLUDED);
}

#[test]
fn holes_are_met_exactly_from_an_irrational_point() {
    // At z = 2, there for x from 0 to 1 and from 2 to 3, a hole from 1 to 2 and from 3 on.
    let mut world = World::new();
    let mask = world.0.add_alpha_mask(AlphaMask::new(2, 1, [Wrap::Repeat; 2], |column, _| column == 0));
    let coverage = Coverage::Masked(mask);
    let material = world.0.add_material(Material { coverage, ..Material::default() });
    let corners = vec![Vec3::new(0.0, 0.0, 2.0), Vec3::new(4.0, 0.0, 2.0), Vec3::new(0.0, 4.0, 2.0)];
    let coordinates = vec![[0.0, 0.0], [2.0, 0.0], [0.0, 0.0]];
    let texture_coordinates = Some(TextureCoordinates { coordinates, corners: vec![[0, 1, 2]] });
    let input = ObjectInput::new("holes", corners, vec![[0, 1, 2]]);
    world.0.add_object(ObjectInput { material, texture_coordinates, ..input }).unwrap();
    let scene = world.with(Matter::Opaque, &[], &[Shape::sphere(Vec3::ZERO, 1.0)]).scene();
    // From (sqrt(3/4), 1/2, 0) a slope of x against z of (1 - sqrt(3/4)) / 2 leads to x = 1.
    let point = on(1, Vec3::new(3.0, 0.5, 0.0), Vec3::NEG_X, Crossing::Entering);
    let exact = (1.0 - 0.75f64.sqrt()) / 2.0;
    let nearest = exact as f32;
    let (below, above) = if f64::from(nearest) < exact {
        (nearest, nearest.next_up())
    } else {
        (nearest.next_down(), nearest)
    };
    assert_eq!(truth(&scene, towards(below, 0.0, 1.0), point), OCCLUDED);
    assert_eq!(truth(&scene, towards(above, 0.0, 1.0), point), LIT);
    assert_eq!(truth(&scene, towards(1.0, 0.0, 1.0), point), OCCLUDED, "x is below 3");
    assert_eq!(truth(&scene, at(1.0, 0.5, 4.0), point), OCCLUDED, "x is below 1");
}
