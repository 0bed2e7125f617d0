//! Segments between points in space and lights, past curved surfaces.

use super::*;
use crate::geometry::curved::{Ellipsoid, Quadric};

fn unit_sphere() -> Scene {
    curved(&[Shape::sphere(Vec3::ZERO, 1.0)])
}

/// Around the z axis from 0 to 1, radius 1.
fn unit_cylinder() -> Scene {
    curved(&[Shape::cylinder(Vec3::ZERO, Vec3::Z, 1.0)])
}

/// Its tip is above, at (0, 0, 1).
fn unit_cone() -> Scene {
    curved(&[Shape::cone(Vec3::ZERO, 1.0, Vec3::Z, 0.0)])
}

#[test]
fn a_sphere_is_touched_within_one_ulp() {
    let scene = unit_sphere();
    for (light, y, expected) in [
        (at(2.0, 1.0, 0.0), 1.0, OCCLUDED_TOUCHING),
        (at(2.0, 1.0f32.next_up(), 0.0), 1.0f32.next_up(), LIT),
        (at(2.0, 1.0f32.next_down(), 0.0), 1.0f32.next_down(), OCCLUDED),
        (towards(1.0, 0.0, 0.0), 1.0, OCCLUDED_TOUCHING),
        (towards(1.0, 0.0, 0.0), 1.0f32.next_up(), LIT),
        (towards(1.0, 0.0, 0.0), 1.0f32.next_down(), OCCLUDED),
        // Beyond the sphere, or away from it.
        (at(-1.5, 1.0, 0.0), 1.0, LIT),
        (towards(-1.0, 0.0, 0.0), 1.0, LIT),
    ] {
        assert_eq!(truth(&scene, light, bare(-2.0, y, 0.0)), expected, "{light:?} {y}");
    }
}

#[test]
fn a_grain_far_away_and_a_globe_as_ground_are_exact() {
    let grain = curved(&[Shape::sphere(Vec3::new(1e4, 0.0, 0.0), 1e-4)]);
    let light = |y| at(2e4, y, 0.0);
    assert_eq!(truth(&grain, light(0.0), bare(0.0, 0.0, 0.0)), OCCLUDED);
    assert_eq!(truth(&grain, light(1e-4), bare(0.0, 1e-4, 0.0)), OCCLUDED_TOUCHING);
    assert_eq!(truth(&grain, light(1.01e-4), bare(0.0, 1.01e-4, 0.0)), LIT);
    let globe = curved(&[Shape::sphere(Vec3::new(0.0, 0.0, -1e6), 1e6)]);
    // At a distance of 1000 the ground has sunk by half a metre.
    let point = bare(0.0, 0.0, 0.0);
    assert_eq!(truth(&globe, at(1e3, 0.0, 0.0), point), LIT_TOUCHING, "the point is on the globe");
    assert_eq!(truth(&globe, at(1e3, 0.0, -0.49), point), OCCLUDED);
    assert_eq!(truth(&globe, at(1e3, 0.0, -0.49), bare(0.0, 0.0, 1.0)), LIT);
}

#[test]
fn spheres_have_an_inside() {
    let scene = unit_sphere();
    assert_eq!(truth(&scene, at(0.5, 0.0, 0.0), bare(-0.5, 0.25, 0.0)), LIT);
    assert_eq!(truth(&scene, at(0.5, 0.0, 0.0), bare(-2.0, 0.0, 0.0)), OCCLUDED, "the light is inside");
    assert_eq!(truth(&scene, at(3.0, 0.0, 0.0), bare(0.0, 0.0, 0.0)), OCCLUDED, "the point is inside");
    assert_eq!(truth(&scene, towards(1.0, 0.0, 0.0), bare(0.0, 0.0, 0.0)), OCCLUDED);
    assert_eq!(truth(&scene, at(1.0, 0.0, 0.0), bare(0.0, 0.0, 0.0)), LIT_TOUCHING, "the light is on it");
    assert_eq!(truth(&scene, at(1.0, 0.0, 0.0), bare(3.0, 1.0, 0.0)), LIT_TOUCHING);
    assert_eq!(truth(&scene, at(1.0, 0.0, 0.0), bare(-3.0, 0.0, 0.0)), OCCLUDED);
}

#[test]
fn a_light_at_the_point_itself_is_seen() {
    let scene = unit_sphere();
    assert_eq!(truth(&scene, at(0.5, 0.0, 0.0), bare(0.5, 0.0, 0.0)), LIT);
    assert_eq!(truth(&scene, at(1.0, 0.0, 0.0), bare(1.0, 0.0, 0.0)), LIT_TOUCHING);
}

#[test]
fn cylinders_are_open_and_end_at_their_rims() {
    let scene = unit_cylinder();
    let across = |z: f32| truth(&scene, at(3.0, 0.0, z), bare(-3.0, 0.0, z));
    assert_eq!(across(0.5), OCCLUDED);
    assert_eq!((across(1.0), across(0.0)), (OCCLUDED_TOUCHING, OCCLUDED_TOUCHING));
    assert_eq!((across(1.0f32.next_up()), across(1.0f32.next_down())), (LIT, OCCLUDED));
    assert_eq!((across(-1e-45), across(1e-45)), (LIT, OCCLUDED));
    // Along the axis through both ends, and in by an end and out through the wall.
    assert_eq!(truth(&scene, at(0.5, 0.25, 3.0), bare(-0.5, 0.0, -3.0)), LIT);
    assert_eq!(truth(&scene, towards(0.0, 0.0, 1.0), bare(0.5, 0.0, -3.0)), LIT);
    assert_eq!(truth(&scene, at(3.0, 0.0, 1.0), bare(0.0, 0.0, -0.25)), OCCLUDED);
    assert_eq!(truth(&scene, at(3.0, 0.0, 1.0), bare(0.0, 0.0, -0.5)), OCCLUDED_TOUCHING);
    // Through both rims.
    assert_eq!(truth(&scene, at(2.0, 0.0, 1.5), bare(-2.0, 0.0, -0.5)), OCCLUDED_TOUCHING);
}

#[test]
fn what_runs_along_a_wall_is_not_blocked_by_it() {
    let scene = unit_cylinder();
    for light in [at(1.0, 0.0, 3.0), towards(0.0, 0.0, 1.0)] {
        assert_eq!(truth(&scene, light, bare(1.0, 0.0, -3.0)), LIT, "its ends are beyond the rims");
        assert_eq!(truth(&scene, light, bare(1.0, 0.0, 0.5)), LIT_TOUCHING);
    }
    for x in [1.0f32.next_up(), 1.0f32.next_down()] {
        assert_eq!(truth(&scene, at(x, 0.0, 3.0), bare(x, 0.0, -3.0)), LIT);
        assert_eq!(truth(&scene, towards(0.0, 0.0, 1.0), bare(x, 0.0, -3.0)), LIT);
    }
    // A little askew it passes the wall between the rims.
    let (x, light) = (1.0f32.next_up(), at(1.0f32.next_down(), 0.0, 1.5));
    assert_eq!(truth(&scene, light, bare(x, 0.0, -0.5)), OCCLUDED);
    // A generator of a cone, above its tip and beside it.
    let cone = unit_cone();
    assert_eq!(truth(&cone, at(-1.0, 0.0, 2.0), bare(2.0, 0.0, -1.0)), LIT);
    assert_eq!(truth(&cone, towards(-1.0, 0.0, 1.0), bare(2.0, 0.0, -1.0)), LIT);
    assert_eq!(truth(&cone, at(-1.0, 0.0, 2.0f32.next_down()), bare(2.0, 0.0, -1.0)), OCCLUDED);
}

#[test]
fn the_tip_of_a_cone_is_a_point_of_it() {
    let scene = unit_cone();
    assert_eq!(truth(&scene, at(2.0, 0.0, 1.0), bare(-2.0, 0.0, 1.0)), OCCLUDED_TOUCHING);
    assert_eq!(truth(&scene, at(2.0, 0.0, 1.0f32.next_up()), bare(-2.0, 0.0, 1.0f32.next_up())), LIT);
    assert_eq!(truth(&scene, at(0.0, 0.0, 2.0), bare(0.0, 0.0, 0.5)), OCCLUDED_TOUCHING, "from inside");
    assert_eq!(truth(&scene, at(0.0, 0.0, 1.0), bare(0.0, 0.0, 0.5)), LIT_TOUCHING, "a light on the tip");
    // The other nappe is no part of it.
    assert_eq!(truth(&scene, at(2.0, 0.0, 1.5), bare(-2.0, 0.0, 1.5)), LIT);
    assert_eq!(truth(&scene, at(2.0, 0.0, 0.5), bare(-2.0, 0.0, 0.5)), OCCLUDED);
    // Slopes: at height 1/2 the radius is 1/2.
    let past = |y: f32| truth(&scene, at(2.0, y, 0.5), bare(-2.0, y, 0.5));
    assert_eq!((past(0.5), past(0.5f32.next_up())), (OCCLUDED_TOUCHING, LIT));
}

#[test]
fn radii_that_hardly_differ_make_a_cone_and_no_cylinder() {
    let scene = curved(&[Shape::cone(Vec3::ZERO, 1.0, Vec3::Z, 1.0f32.next_up())]);
    // A line along x = 1, where the wall has moved out by less than half an ulp.
    assert_eq!(truth(&scene, at(1.0, 0.0, 3.0), bare(1.0, 0.0, -3.0)), OCCLUDED_TOUCHING, "the rim at z = 0");
    let outside = 1.0f32.next_up();
    assert_eq!(truth(&scene, at(outside, 0.0, 3.0), bare(outside, 0.0, -3.0)), OCCLUDED_TOUCHING);
    assert_eq!(truth(&scene, at(outside, 0.0, 3.0), bare(1.0, 0.0, -3.0)), OCCLUDED);
    assert_eq!(truth(&scene, towards(0.0, 0.0, 1.0), bare(outside.next_up(), 0.0, -3.0)), LIT);
}

#[test]
fn ellipsoids_are_where_their_axes_take_the_unit_sphere() {
    // Sheared: (1, 0, 0), (1, 1, 0), (0, 0, 2); its top in y is at y = 1, where x = 1.
    let axes = [Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Z * 2.0];
    let scene = curved(&[Shape::Ellipsoid(Ellipsoid { centre: Vec3::ZERO, axes })]);
    let past = |y: f32| truth(&scene, at(9.0, y, 0.0), bare(-9.0, y, 0.0));
    assert_eq!(
        (past(1.0f32.next_down()), past(1.0), past(1.0f32.next_up())),
        (OCCLUDED, OCCLUDED_TOUCHING, LIT)
    );
    assert_eq!(truth(&scene, at(0.5, 1.0, 0.0), bare(-9.0, 1.0, 0.0)), LIT, "it is touched beyond the light");
    let up = |z: f32| truth(&scene, towards(1.0, 0.0, 0.0), bare(-9.0, 0.0, z));
    assert_eq!((up(2.0), up(2.0f32.next_up())), (OCCLUDED_TOUCHING, LIT));
}

/// x^2 + y^2 - z^2 = 1 in a box.
fn hyperboloid(low: Vec3, high: Vec3) -> Shape {
    Shape::Quadric(Quadric {
        reference: Vec3::ZERO,
        second: [1.0, 1.0, -1.0, 0.0, 0.0, 0.0],
        first: Vec3::ZERO,
        constant: -1.0,
        low,
        high,
    })
}

#[test]
fn quadrics_end_at_their_boxes() {
    let scene = curved(&[hyperboloid(Vec3::splat(-2.0), Vec3::splat(2.0))]);
    let across = |z: f32| truth(&scene, at(9.0, 0.0, z), bare(-9.0, 0.0, z));
    assert_eq!((across(0.0), across(3.0)), (OCCLUDED, LIT));
    // At z^2 = 3 it would leave the box at x = 2: just below, and just above.
    let edge = 3.0f32.sqrt();
    assert_eq!((across(edge.next_down()), across(edge.next_up())), (OCCLUDED, LIT));
    // A generator of the surface.
    assert_eq!(truth(&scene, at(1.0, 3.0, 3.0), bare(1.0, -3.0, -3.0)), LIT);
    let half = curved(&[hyperboloid(Vec3::new(0.0, -2.0, -2.0), Vec3::splat(2.0))]);
    assert_eq!(truth(&half, at(-9.0, 0.0, 0.0), bare(0.5, 0.0, 0.0)), LIT);
    // Through (0, 1, 0), where the box ends.
    assert_eq!(truth(&half, at(0.0, 9.0, 0.0), bare(0.0, 0.0, 0.0)), OCCLUDED_TOUCHING);
    assert_eq!(truth(&half, at(-1e-30, 9.0, 0.0), bare(-1e-30, 0.0, 0.0)), LIT);
    assert_eq!(truth(&half, at(1e-30, 9.0, 0.0), bare(1e-30, 0.0, 0.0)), OCCLUDED);
}

#[test]
fn coefficients_of_any_size_are_exact() {
    // 2^-100 (x^2 - 2^-40 z) = 0, with x at 2^60.
    let size = 2f32.powi(60);
    let scene = curved(&[Shape::Quadric(Quadric {
        reference: Vec3::ZERO,
        second: [2f32.powi(-100), 0.0, 0.0, 0.0, 0.0, 0.0],
        first: Vec3::new(0.0, 0.0, -(2f32.powi(-140))),
        constant: 0.0,
        low: Vec3::splat(-size),
        high: Vec3::splat(size),
    })]);
    // At z = 2^60 the surface is at x = 2^10.
    assert_eq!(truth(&scene, at(2048.0, 0.0, size), bare(1000.0, 0.0, size)), OCCLUDED_TOUCHING, "a rim");
    let below = size.next_down();
    assert_eq!(truth(&scene, at(2048.0, 0.0, below), bare(1000.0, 0.0, below)), OCCLUDED);
    assert_eq!(truth(&scene, at(1024.0, 0.0, below), bare(1000.0, 0.0, below)), OCCLUDED);
    assert_eq!(truth(&scene, at(1024.0, 0.0, size), bare(1000.0, 0.0, size)), LIT_TOUCHING);
}

#[test]
fn a_touch_and_a_passage_are_a_passage() {
    let scene = curved(&[Shape::sphere(Vec3::ZERO, 1.0), Shape::sphere(Vec3::new(5.0, 1.0, 0.0), 0.5)]);
    assert_eq!(truth(&scene, at(9.0, 1.0, 0.0), bare(-2.0, 1.0, 0.0)), OCCLUDED);
    assert_eq!(truth(&scene, at(3.0, 1.0, 0.0), bare(-2.0, 1.0, 0.0)), OCCLUDED_TOUCHING);
}
