//! Discs and planes without end.

use super::*;
use crate::geometry::curved::{Disc, InfinitePlane};

fn disc(centre: Vec3, normal: Vec3, radius: f32) -> Shape {
    Shape::Disc(Disc { centre, normal, radius })
}

fn plane(point: Vec3, normal: Vec3) -> Shape {
    Shape::Plane(InfinitePlane { point, normal })
}

#[test]
fn discs_end_at_their_rims() {
    let scene = curved(&[disc(Vec3::ZERO, Vec3::Z * 7.0, 1.0)]);
    let through = |x: f32, y: f32| truth(&scene, at(x, y, 1.0), bare(x, y, -1.0));
    assert_eq!(
        (through(0.5, 0.5), through(0.6, 0.8).0),
        (OCCLUDED, Occlusion::Lit),
        "0.6 and 0.8 are rounded up"
    );
    assert_eq!((through(1.0, 0.0), through(1.0f32.next_up(), 0.0)), (OCCLUDED_TOUCHING, LIT));
    assert_eq!(through(1.0, 1e-30), LIT);
    assert_eq!(truth(&scene, at(2.0, 0.0, 0.0), bare(-2.0, 0.0, 0.0)), LIT, "along its plane");
    assert_eq!(truth(&scene, at(0.0, 0.0, -2.0), bare(0.0, 0.0, -1.0)), LIT);
    assert_eq!(truth(&scene, at(0.0, 0.0, 2.0), bare(0.0, 0.0, 0.0)), LIT_TOUCHING);
}

#[test]
fn planes_have_no_end() {
    let scene = curved(&[plane(Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.0, -3.0))]);
    assert_eq!(truth(&scene, at(1e30, 1e30, 1e30), bare(-1e30, 5.0, 0.0)), OCCLUDED);
    assert_eq!(truth(&scene, towards(1.0, 0.0, 1e-30), bare(-1e30, 5.0, 0.0)), OCCLUDED);
    assert_eq!(truth(&scene, towards(1.0, 0.0, 0.0), bare(-1e30, 5.0, 0.0)), LIT);
    assert_eq!(truth(&scene, towards(1.0, 0.0, -1e-30), bare(-1e30, 5.0, 0.0)), LIT);
    assert_eq!(truth(&scene, at(3.0, 0.0, 1.0), bare(0.0, 0.0, 0.0)), LIT_TOUCHING, "the light is on it");
    assert_eq!(truth(&scene, at(3.0, 0.0, 1.0), bare(0.0, 0.0, 1.0)), LIT_TOUCHING, "both are");
}

#[test]
fn what_lies_in_the_plane_of_the_receiver_neither_blocks_nor_is_touched() {
    // x + y + z = 1, whose points have no finite binary coordinates in general.
    let floor = [Vec3::X, Vec3::Y, Vec3::Z];
    let normal = Vec3::ONE;
    let flat = [disc(Vec3::X, normal, 5.0), plane(Vec3::Y, -normal), disc(Vec3::Z, normal * 0.1, 1.0)];
    let scene = World::new().with(Matter::Opaque, &[floor, floor], &flat).scene();
    let direction = Vec3::new(0.1, 0.2, -1.0);
    let origin = Vec3::new(0.3, 0.2, 9.0);
    let on_triangle =
        SurfacePoint { position: DVec3::ZERO, source: PointSource::Ray { origin, direction, primitive: 0 } };
    for light in [at(3.0, 4.0, 5.0), towards(1.0, 2.0, 0.3)] {
        assert_eq!(truth(&scene, light, on_triangle), LIT);
        for primitive in 2..5 {
            assert_eq!(truth(&scene, light, on(primitive, origin, direction, Crossing::Entering)), LIT);
        }
    }
    // An ulp beside it is another plane.
    let beside = plane(Vec3::new(1.0f32.next_up(), 0.0, 0.0), normal);
    let scene = World::new().with(Matter::Opaque, &[floor], &[beside]).scene();
    assert_eq!(truth(&scene, at(3.0, 4.0, 5.0), on_triangle), OCCLUDED);
    assert_eq!(truth(&scene, at(-3.0, -4.0, -5.0), on_triangle), LIT);
}

#[test]
fn points_on_discs_and_planes_see_past_their_own() {
    let scene = curved(&[plane(Vec3::ZERO, Vec3::Z), disc(Vec3::Z, Vec3::Z, 1.0)]);
    let down = |primitive, x| on(primitive, Vec3::new(x, 0.1, 9.0), Vec3::NEG_Z, Crossing::Entering);
    assert_eq!(truth(&scene, at(0.3, 0.0, 5.0), down(0, 0.3)), OCCLUDED, "the ground below the disc");
    assert_eq!(truth(&scene, at(0.3, 0.0, 5.0), down(0, 3.0)), LIT);
    assert_eq!(truth(&scene, at(0.3, 0.0, 5.0), down(1, 0.3)), LIT);
    assert_eq!(truth(&scene, at(0.3, 0.0, -5.0), down(1, 0.3)), OCCLUDED);
    assert_eq!(truth(&scene, towards(0.0, 0.0, 1.0), down(0, 0.3)), OCCLUDED);
}
