//! Rays and segments against surfaces: floats against exact numbers, and both against what is plain to see.

use super::meeting::{Reach, meetings};
use super::on_line::{Line, OnLine};
use super::root;
use super::segment::Base;
use super::*;
use crate::geometry::bounded::Bounded;
use crate::geometry::number::{Number, minus, vector};
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::surd::Surd;
use crate::geometry::{ExactPosition, LightPosition, LightSpace, Sign};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![-2.0f32..2.0, (-4i8..5).prop_map(|x| f32::from(x) * 0.5), Just(0.0)]
}

fn point() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(coordinate()).prop_map(Vec3::from)
}

fn radius() -> impl Strategy<Value = f32> {
    prop_oneof![0.01f32..2.0, (1i8..5).prop_map(|x| f32::from(x) * 0.5)]
}

/// Every kind, many with numbers on a small grid, so that rays touch, graze and run inside.
pub(crate) fn shape() -> impl Strategy<Value = Shape> {
    let ball = (point(), radius()).prop_map(|(centre, radius)| Shape::sphere(centre, radius));
    let ellipsoid = (point(), prop::array::uniform3(point()))
        .prop_map(|(centre, axes)| Shape::Ellipsoid(Ellipsoid { centre, axes }));
    let ends = || prop_oneof![radius(), Just(0.0), Just(1.0)];
    let cone = (point(), ends(), point(), ends()).prop_map(|(b, r, a, s)| Shape::cone(b, r, a, s));
    let disc = (point(), point(), radius())
        .prop_map(|(centre, normal, radius)| Shape::Disc(Disc { centre, normal, radius }));
    let plane = (point(), point()).prop_map(|(point, normal)| Shape::Plane(InfinitePlane { point, normal }));
    let quadric = (point(), prop::array::uniform6(coordinate()), point(), coordinate(), point(), point())
        .prop_map(|(reference, second, first, constant, low, size)| {
            let high = low + size.abs() + Vec3::splat(0.25);
            Shape::Quadric(Quadric { reference, second, first, constant, low, high })
        });
    prop_oneof![ball, ellipsoid, cone, disc, plane, quadric]
        .prop_filter("no defect", |shape| shape.defect().is_none())
}

/// A segment as a line in any kind of numbers.
fn segment<N: Number>(from: Vec3, to: Vec3) -> Line<N> {
    let start = vector::<N>(from);
    let along = minus(&vector(to), &start);
    Line { start, weight: N::exactly(1.0), along }
}

fn exactly(shape: &Shape, from: Vec3, to: Vec3) -> Meetings {
    meetings(&OnLine::new(shape, &segment::<Surd>(from, to)), Reach::Segment).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn floats_never_contradict_exact_numbers(shape in shape(), from in point(), to in point()) {
        prop_assume!(from != to);
        let exact = exactly(&shape, from, to);
        if let Some(found) = meetings(&OnLine::new(&shape, &segment::<Bounded>(from, to)), Reach::Segment) {
            prop_assert_eq!(found, exact);
        }
        // The other way round it meets the same.
        prop_assert_eq!(exactly(&shape, to, from), exact);
    }

    /// Rays find what segments along them meet, and segments from a hit do not meet it again before the next.
    #[test]
    fn a_ray_hits_what_its_segments_meet(shape in shape(), from in point(), direction in point()) {
        prop_assume!(direction != Vec3::ZERO);
        let hit = shape.first_hit(from, direction, &RayStart::origin());
        let line = root::ray_line::<Surd>(from, direction);
        let met = meetings(&OnLine::new(&shape, &line), Reach::HalfLine).unwrap();
        prop_assert_eq!(hit.is_some(), met.any());
        let Some(hit) = hit else { return Ok(()) };
        let exact = shape.exact_parameter(from, direction, hit.crossing);
        let value = root::round(&exact.numerator, &Surd::rational(exact.denominator.clone()));
        prop_assert!((value - hit.parameter.value).abs() <= hit.parameter.error * (1.0 + 1e-9) + value.abs() * 1e-15);
        // Beyond the hit, what is left of the ray meets one time less, unless it touched.
        let start = RayStart::on_curved(from, direction, &shape, hit.crossing).unwrap();
        let next = shape.first_hit(from, direction, &start);
        if met.crossings == 2 {
            prop_assert!(next.is_some_and(|next| next.crossing != hit.crossing));
        } else {
            prop_assert!(next.is_none());
        }
    }

    /// A point on a surface is where its rounding says, and towards a light it meets its own surface as often
    /// as exact numbers count.
    #[test]
    fn points_on_surfaces_are_exact(shape in shape(), from in point(), direction in point(), light in point()) {
        prop_assume!(direction != Vec3::ZERO);
        let Some(hit) = shape.first_hit(from, direction, &RayStart::origin()) else { return Ok(()) };
        let position = ExactPosition::OnCurved { origin: from, direction, shape, crossing: hit.crossing };
        let rounded = position.rounded();
        let exact = position.relative_to(Vec3::ZERO);
        let expected = exact.xyz.each_ref().map(|x| x.divide_rounded(&exact.w));
        prop_assert_eq!(rounded.to_array(), expected);
        for light in [LightPosition::At(light), LightPosition::Towards(light)] {
            if light == LightPosition::Towards(Vec3::ZERO) {
                continue;
            }
            let space = LightSpace::new(light, (Vec3::splat(-4.0), Vec3::splat(4.0)));
            let query = PreciseQuery::new(&space, rounded, || position);
            // Forgetting that it is its own surface leaves it to exact numbers, which notice.
            prop_assert_eq!(query.meets(&shape, Base::Own).0, query.meets(&shape, Base::Other).0);
            let away = query.side_of_light(&shape);
            let gradient = shape.gradient(rounded);
            let towards = match light {
                LightPosition::At(light) => light.as_dvec3() - rounded,
                LightPosition::Towards(direction) => direction.as_dvec3(),
            };
            let cosine = gradient.normalize_or_zero().dot(towards.normalize_or_zero());
            if cosine.abs() > 1e-4 && gradient.length() > 1e-4 {
                prop_assert_eq!(away, Sign::of(cosine));
            }
        }
    }
}

#[test]
fn one_ulp_tells_a_touch_from_a_miss_and_from_two_crossings() {
    let ball = Shape::sphere(Vec3::ZERO, 1.0);
    let at = |x: f32| exactly(&ball, Vec3::new(x, -2.0, 0.0), Vec3::new(x, 2.0, 0.0));
    assert_eq!(at(1.0), Meetings { crossings: 0, touches: true });
    assert_eq!(at(1.0f32.next_up()), Meetings::default());
    assert_eq!(at(1.0f32.next_down()), Meetings { crossings: 2, touches: false });
}

#[test]
fn a_line_in_the_wall_of_a_cylinder_does_not_meet_it_and_its_rim_belongs_to_it() {
    let wall = Shape::cylinder(Vec3::ZERO, Vec3::Z, 1.0);
    assert_eq!(exactly(&wall, Vec3::new(1.0, 0.0, -1.0), Vec3::new(1.0, 0.0, 2.0)), Meetings::default());
    let through = |z: f32| exactly(&wall, Vec3::new(-2.0, 0.0, z), Vec3::new(2.0, 0.0, z)).crossings;
    let above = 1.0f32.next_up();
    assert_eq!([through(0.0), through(1.0), through(above), through(-1e-45)], [2, 2, 0, 0]);
    // In at the rim and out through the open end.
    assert_eq!(exactly(&wall, Vec3::new(-2.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 2.0)).crossings, 1);
}

#[test]
fn the_tip_of_a_cone_is_touched() {
    let cone = Shape::cone(Vec3::ZERO, 1.0, Vec3::Z, 0.0);
    let at = |z: f32| exactly(&cone, Vec3::new(-2.0, 0.0, z), Vec3::new(2.0, 0.0, z));
    assert_eq!(at(1.0), Meetings { crossings: 0, touches: true });
    assert_eq!(at(1.0f32.next_down()).crossings, 2);
    assert!(!at(1.0f32.next_up()).any());
}

#[test]
fn open_ends_do_not_count() {
    let ball = Shape::sphere(Vec3::ZERO, 1.0);
    let (pole, inside) = (Vec3::Y, Vec3::ZERO);
    assert!(!exactly(&ball, pole, Vec3::Y * 5.0).any());
    assert!(!exactly(&ball, pole, inside).any());
    assert_eq!(exactly(&ball, pole, Vec3::Y * -5.0).crossings, 1);
    assert!(!exactly(&ball, pole, -pole).any());
}

#[test]
fn points_with_irrational_coordinates_round_correctly() {
    // x = sqrt(2) of a ball of radius 2 at height sqrt 2 is irrational, at height 0 rational.
    let ball = Shape::sphere(Vec3::ZERO, 2.0);
    let position = |origin: Vec3| {
        let direction = Vec3::NEG_X;
        let hit = ball.first_hit(origin, direction, &RayStart::origin()).unwrap();
        ExactPosition::OnCurved { origin, direction, shape: ball, crossing: hit.crossing }.rounded()
    };
    assert_eq!(position(Vec3::new(9.0, 0.0, 0.0)), DVec3::new(2.0, 0.0, 0.0));
    assert_eq!(position(Vec3::new(9.0, 1.0, 1.0)), DVec3::new(2f64.sqrt(), 1.0, 1.0));
}

/// A ball of radius sqrt 3 that the corners of its box lie on, or one beside them.
fn in_a_box(constant: f32, low: Vec3) -> Shape {
    Shape::Quadric(Quadric {
        reference: Vec3::ZERO,
        second: [1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
        first: Vec3::ZERO,
        constant,
        low,
        high: Vec3::ONE,
    })
}

#[test]
fn bounds_that_meet_a_surface_in_corners_are_told_exactly() {
    let (none, touch) = (Meetings::default(), Meetings { crossings: 0, touches: true });
    let through = |crossings: u8| Meetings { crossings, touches: false };
    let (on, beside) = (in_a_box(-3.0, Vec3::NEG_ONE), in_a_box(-2.0, Vec3::NEG_ONE));
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    // Past a corner.
    for (shape, expected) in [(on, touch), (beside, none)] {
        assert_eq!(exactly(&shape, at(3.0, -1.0, 1.0), at(-1.0, 3.0, 1.0)), expected);
    }
    // Along an edge from corner to corner, both of which belong to it, and from one that the segment begins in.
    assert_eq!(exactly(&on, at(1.0, 1.0, -3.0), at(1.0, 1.0, 3.0)), through(2));
    assert_eq!(exactly(&on, at(1.0, 1.0, -1.0), at(1.0, 1.0, 3.0)), through(1));
    assert_eq!(exactly(&on, at(1.0, 1.0, -3.0), at(1.0, 1.0, 1.0)), through(1));
    assert_eq!(exactly(&on, at(1.0, 1.0, -1.0), at(1.0, 1.0, 1.0)), none);
    // In through the surface and out through the corner, both ways.
    let deep = in_a_box(-3.0, at(-1.0, -1.0, -5.0));
    assert_eq!(exactly(&deep, at(1.0, 1.0, -4.0), at(1.0, 1.0, 3.0)), through(2));
    assert_eq!(exactly(&deep, at(1.0, 1.0, 3.0), at(1.0, 1.0, -4.0)), through(2));
    // What runs in the surface does not meet it: here the plane x = 1, between two bounds, and in one corner.
    let flat = Shape::Quadric(Quadric {
        reference: Vec3::ZERO,
        second: [0.0; 6],
        first: Vec3::X,
        constant: -1.0,
        low: Vec3::NEG_ONE,
        high: Vec3::ONE,
    });
    assert_eq!(exactly(&flat, at(1.0, 0.5, -3.0), at(1.0, 0.5, 3.0)), none);
    assert_eq!(exactly(&flat, at(1.0, 3.0, -1.0), at(1.0, -1.0, 3.0)), none);
}
