//! What is crossed on the way to the light.

use super::*;
use crate::shadow::exact::Meeting;

const GLASS: Matter = Matter::Glass;

const NONE: [PrimitiveIndex; 0] = [];

fn glass(triangles: &[[Vec3; 3]], curved: &[Shape]) -> Scene {
    World::new().with(GLASS, triangles, curved).scene()
}

fn corner(x: f32, y: f32, z: f32) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Two triangles that share the edge from (-1, -1) to (1, 1) at z = 1.
fn pane() -> [[Vec3; 3]; 2] {
    let (low, high) = (corner(-1.0, -1.0, 1.0), corner(1.0, 1.0, 1.0));
    [[low, high, corner(-1.0, 1.0, 1.0)], [low, corner(1.0, -1.0, 1.0), high]]
}

#[test]
fn glass_never_makes_dark() {
    let scene = glass(&pane(), &[Shape::sphere(Vec3::Z * 3.0, 0.5)]);
    let light = at(0.25, 0.0, 5.0);
    assert_eq!(truth(&scene, light, bare(0.25, 0.0, 0.0)), LIT);
    assert_eq!(crossed(&scene, light, bare(0.25, 0.0, 0.0)), [1, 2, 2]);
    let behind = World::new()
        .with(GLASS, &pane(), &[])
        .with(Matter::Opaque, &[], &[Shape::sphere(Vec3::Z * 3.0, 0.5)])
        .scene();
    assert_eq!(truth(&behind, light, bare(0.25, 0.0, 0.0)), OCCLUDED);
}

#[test]
fn a_shared_edge_counts_once_from_wherever_it_is_met() {
    let scene = glass(&pane(), &[]);
    for (light, point) in [
        (at(0.0, 0.0, 5.0), bare(0.0, 0.0, 0.0)),
        (at(0.5, 0.5, 5.0), bare(0.5, 0.5, 0.0)),
        (towards(0.0, 0.0, 1.0), bare(0.25, 0.25, 0.0)),
        (towards(1.0, 1.0, 1.0), bare(-1.0, -1.0, 0.0)),
        (at(2.0, 2.0, -1.0), bare(-2.0, -2.0, 3.0)),
    ] {
        assert_eq!(crossed(&scene, light, point).len(), 1, "{point:?}");
    }
}

#[test]
fn the_hub_of_a_fan_counts_once_and_its_rim_at_most_once() {
    let rim = [corner(1.0, 0.0, 1.0), corner(0.0, 1.0, 1.0), corner(-1.0, 0.0, 1.0), corner(0.0, -1.0, 1.0)];
    let fan: Vec<_> = (0..4).map(|i| [Vec3::Z, rim[i], rim[(i + 1) % 4]]).collect();
    let scene = glass(&fan, &[]);
    for light in [at(0.0, 0.0, 5.0), towards(0.0, 0.0, 1.0)] {
        assert_eq!(crossed(&scene, light, bare(0.0, 0.0, 0.0)).len(), 1);
        assert!(crossed(&scene, towards(0.0, 0.0, 1.0), bare(1.0, 0.0, 0.0)).len() <= 1);
    }
    // P moves towards x first, so a segment through the rim at x = 1 gets out, and one at x = -1 in.
    let up = towards(0.0, 0.0, 1.0);
    assert_eq!(crossed(&scene, up, bare(1.0, 0.0, 0.0)), NONE);
    assert_eq!(crossed(&scene, up, bare(-1.0, 0.0, 0.0)).len(), 1);
    // Each corner's turn: along y where x does not decide.
    assert_eq!(crossed(&glass(&pane(), &[]), up, bare(0.0, 1.0, 0.0)), NONE);
    assert_eq!(crossed(&glass(&pane(), &[]), up, bare(0.0, -1.0, 0.0)), [1]);
}

#[test]
fn silhouettes_count_twice_or_not_at_all() {
    // A roof with its ridge along y, seen along x: both sides, or none.
    let (near, far) = (corner(0.0, -1.0, 2.0), corner(0.0, 1.0, 2.0));
    let roof = [[near, far, corner(-1.0, 0.0, 1.0)], [near, far, corner(1.0, 0.0, 1.0)]];
    let scene = glass(&roof, &[]);
    let over = crossed(&scene, at(5.0, 0.0, 2.0), bare(-5.0, 0.0, 2.0));
    assert_eq!(over, NONE, "P moves up, over the ridge");
    let turned = glass(&roof.map(|t| t.map(|c| corner(c.x, c.y, -c.z))), &[]);
    assert_eq!(crossed(&turned, at(5.0, 0.0, -2.0), bare(-5.0, 0.0, -2.0)), [0, 1]);
}

#[test]
fn ends_do_not_count() {
    let scene = glass(&pane(), &[]);
    assert_eq!(crossed(&scene, at(0.25, 0.0, 5.0), bare(0.25, 0.0, 1.0)), NONE);
    assert_eq!(crossed(&scene, at(0.25, 0.0, 1.0), bare(0.25, 0.0, 0.0)), NONE, "its plane holds the light");
    assert_eq!(crossed(&scene, at(0.25, 0.0, 5.0), below(1, 0.25, 0.0)), NONE);
    assert_eq!(crossed(&scene, at(0.25, 0.0, -5.0), below(1, 0.25, 0.0)), NONE);
}

#[test]
fn spheres_are_crossed_twice_once_or_not_at_all() {
    let scene = glass(&[], &[Shape::sphere(Vec3::ZERO, 1.0)]);
    let light = at(5.0, 0.0, 0.0);
    assert_eq!(crossed(&scene, light, bare(-5.0, 0.0, 0.0)), [0, 0]);
    assert_eq!(crossed(&scene, light, bare(0.0, 0.5, 0.0)), [0]);
    assert_eq!(crossed(&scene, at(5.0, 1.0, 0.0), bare(-5.0, 1.0, 0.0)), NONE, "touched");
    assert_eq!(
        crossed(&scene, at(5.0, 1.0f32.next_down(), 0.0), bare(-5.0, 1.0f32.next_down(), 0.0)),
        [0, 0]
    );
    assert_eq!(crossed(&scene, at(0.5, 0.0, 0.0), bare(0.0, 0.5, 0.0)), NONE);
    // From the sphere itself, outwards and through it.
    let near = on(0, Vec3::new(3.0, 0.5, 0.0), Vec3::NEG_X, Crossing::Entering);
    assert_eq!(crossed(&scene, light, near), NONE);
    assert_eq!(crossed(&scene, at(-5.0, 0.0, 0.0), near), [0]);
    assert_eq!(crossed(&scene, towards(-1e-38, 0.0, 1.0), near), [0]);
    assert_eq!(crossed(&scene, towards(0.0, 0.0, 1.0), near), NONE);
    assert_eq!(crossed(&scene, at(1.0, 0.0, 0.0), bare(-5.0, 0.0, 0.0)), [0], "the light is on it");
}

#[test]
fn rims_count_and_tips_do_not() {
    let cylinder = glass(&[], &[Shape::cylinder(Vec3::ZERO, Vec3::Z, 1.0)]);
    assert_eq!(crossed(&cylinder, at(5.0, 0.0, 1.0), bare(-5.0, 0.0, 1.0)), [0, 0]);
    assert_eq!(crossed(&cylinder, at(2.0, 0.0, 1.5), bare(-2.0, 0.0, -0.5)), [0, 0], "both rims");
    assert_eq!(crossed(&cylinder, at(1.0, 0.0, 4.0), bare(1.0, 0.0, -2.0)), NONE, "along it");
    let cone = glass(&[], &[Shape::cone(Vec3::ZERO, 1.0, Vec3::Z, 0.0)]);
    assert_eq!(crossed(&cone, at(5.0, 0.0, 1.0), bare(-5.0, 0.0, 1.0)), NONE);
    assert_eq!(crossed(&cone, at(0.0, 0.0, 5.0), bare(0.0, 0.0, 0.5)), NONE);
}

#[test]
fn copies_of_transparent_things_each_count() {
    let [triangle, _] = pane();
    let scene = glass(&[triangle, triangle], &[Shape::sphere(Vec3::Z * 3.0, 0.5); 2]);
    assert_eq!(crossed(&scene, at(-0.25, 0.0, 5.0), bare(-0.25, 0.0, 0.0)), [0, 1, 2, 2, 3, 3]);
}

#[test]
fn the_tester_lists_what_the_arbiter_finds() {
    use crate::shadow::{Crossings, ShadowTester};
    let scene = glass(&pane(), &[Shape::sphere(Vec3::Z * 3.0, 0.5)]);
    let index = SceneIndex::new(&scene);
    let arbiter = Arbiter::new(&BuildInput::new(&scene, &index, at(0.25, 0.0, 5.0)));
    let mut crossings = Crossings::default();
    let tester: &dyn ShadowTester = &arbiter;
    tester.crossed(&[bare(9.0, 0.0, 0.0), bare(0.25, 0.0, 0.0)], &mut crossings).unwrap();
    assert_eq!((crossings.of(0), crossings.of(1)), (&[][..], &[1, 2, 2][..]));
    let meetings = arbiter.meetings(&bare(0.25, 0.0, 0.0));
    assert_eq!(meetings, [(1, Meeting::Interior), (2, Meeting::Interior)]);
}
