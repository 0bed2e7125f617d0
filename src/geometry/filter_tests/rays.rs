//! Where rays hit triangles, and in which order.

use super::cases;
use super::inputs::{Situation, situation};
use super::rational::{self as exact, Rational, is_within, sign};
use crate::geometry::curved::RayStart;
use crate::geometry::ray_triangle::{self, RayParameter, RayTriangle};
use crate::geometry::{ExactPosition, LightPosition, Sign};
use glam::Vec3;
use proptest::prelude::*;
use std::cmp::Ordering;

/// A ray that passes close by the border of the situation's triangle: from the light, or along it, to the point.
fn ray(s: &Situation) -> (Vec3, Vec3) {
    let end = match s.position {
        ExactPosition::Bare(p) => p,
        ExactPosition::OnRay { triangle, .. } => triangle[0],
        ExactPosition::OnCurved { .. } => unreachable!("none is made"),
    };
    match s.space.light() {
        LightPosition::At(light) => (light, end - light),
        LightPosition::Towards(direction) => (end, direction),
    }
}

/// The definition: off the plane, no two edges on strictly different sides, ahead.
fn hit(origin: Vec3, direction: Vec3, corners: &[Vec3; 3]) -> Option<Rational> {
    let (o, d) = (exact::vector(origin), exact::vector(direction));
    let t = exact::plane_parameter(&o, &d, corners)?;
    let [a, b, c] = *corners;
    // Along the ray: seen from infinitely far behind it.
    let signs = [(a, b), (b, c), (c, a)]
        .map(|(a, b)| sign(&exact::edge(LightPosition::Towards(direction), a, b, &o)));
    let inside = !(signs.contains(&Sign::Negative) && signs.contains(&Sign::Positive));
    (inside && sign(&t) == Sign::Positive).then_some(t)
}

fn check(found: Option<RayParameter>, truth: &Option<Rational>) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.is_some(), truth.is_some());
    if let (Some(found), Some(t)) = (found, truth) {
        prop_assert!(is_within(found.value, found.error, t), "{:?}", found);
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(6000))]

    #[test]
    fn hits_are_exact_and_parameters_within_their_bounds(s in situation()) {
        let (origin, direction) = ray(&s);
        prop_assume!(s.is_finite() && direction.is_finite() && direction != Vec3::ZERO);
        let truth = hit(origin, direction, &s.corners);
        check(RayTriangle::new(origin, s.corners).and_then(|t| t.hit(direction)), &truth)?;
        check(ray_triangle::hit_beyond(origin, direction, s.corners, &RayStart::origin()), &truth)?;
    }

    #[test]
    fn two_hits_are_in_their_exact_order(s in situation(), moved in 0..=2_usize, to in prop::array::uniform3(-4..=4_i8)) {
        let (origin, direction) = ray(&s);
        prop_assume!(s.is_finite() && direction.is_finite() && direction != Vec3::ZERO);
        // A neighbour with a common edge or vertex, or nearly.
        let mut other = s.corners;
        let step = (s.corners[(moved + 1) % 3] - s.corners[moved]) * 0.25;
        other[moved] += Vec3::from(to.map(f32::from)) * step;
        prop_assume!(other[moved].is_finite());
        let (Some(first), Some(second)) = (hit(origin, direction, &s.corners), hit(origin, direction, &other)) else {
            return Ok(());
        };
        let (one, two) = (RayTriangle::new(origin, s.corners).unwrap(), RayTriangle::new(origin, other).unwrap());
        let truth = first.partial_cmp(&second).unwrap();
        if let Some(order) = one.hit(direction).unwrap().certain_order(two.hit(direction).unwrap()) {
            prop_assert_eq!(order, truth);
        }
        prop_assert_eq!(RayTriangle::exact_order(direction, &one, &two), truth);
        prop_assert_eq!(RayTriangle::exact_order(direction, &two, &one), truth.reverse());
        prop_assert_eq!(RayTriangle::exact_order(direction, &one, &one), Ordering::Equal);
    }
}
