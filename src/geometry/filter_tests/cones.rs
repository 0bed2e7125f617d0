//! Whether a point is inside the cone of a spot light.

use super::cases;
use super::inputs::situation;
use super::rational::{self as exact, Rational, rational};
use crate::geometry::cone::LightCone;
use crate::geometry::{ExactPosition, LightPosition};
use glam::Vec3;
use proptest::prelude::*;

proptest! {
    #![proptest_config(cases(6000))]

    /// Cones whose border passes as near to the point as a float cosine can.
    #[test]
    fn cones_hold_what_rationals_say(s in situation(), axis in prop::array::uniform3(-4..=4_i8), steps in -2..=2_i8, scale in -100..=60_i32) {
        prop_assume!(s.is_finite() && axis != [0; 3]);
        let LightPosition::At(apex) = s.space.light() else { return Ok(()) };
        let Some(p) = exact::point(&s.position) else { return Ok(()) };
        let axis = Vec3::from(axis.map(f32::from)) * 2.0_f32.powi(scale);
        let v = s.position.rounded() - apex.as_dvec3();
        let cosine = (v.normalize_or_zero().dot(axis.as_dvec3().normalize()) as f32).clamp(0.0, 1.0);
        let cosine = (0..steps.abs()).fold(cosine, |c, _| if steps > 0 { c.next_up() } else { c.next_down() });
        let cosine = cosine.clamp(0.0, 1.0);
        let (v, d) = (exact::minus(&p, &exact::vector(apex)), exact::vector(axis));
        let (along, c) = (exact::dot(&v, &d), rational(f64::from(cosine)));
        let inside = &along * &along > &c * &c * exact::dot(&v, &v) * exact::dot(&d, &d);
        let truth = along > Rational::ZERO && inside;
        let cone = LightCone { apex, axis, cosine };
        prop_assert_eq!(cone.holds(s.position.rounded(), || s.position), truth);
    }

    /// A half-space and a point of its border, or a few roundings of f64 beside it: where a ray meets a triangle in the
    /// border's plane.
    #[test]
    fn the_border_of_a_half_space_is_outside(
        s in situation(),
        axis in prop::array::uniform3(-4..=4_i8),
        across in prop::array::uniform2(prop::array::uniform3(-4..=4_i8)),
        origin in prop::array::uniform3(-9.0..9.0_f32),
        direction in prop::array::uniform3(-1.0..1.0_f32),
    ) {
        let LightPosition::At(apex) = s.space.light() else { return Ok(()) };
        prop_assume!(apex.abs().max_element() < 1e7 && axis != [0; 3]);
        let axis = Vec3::from(axis.map(f32::from));
        let [u, v] = across.map(|w| axis.cross(Vec3::from(w.map(f32::from))));
        let triangle = [apex + u, apex + v, apex - u - v];
        let position = ExactPosition::OnRay { origin: origin.into(), direction: direction.into(), triangle };
        let Some(p) = exact::point(&position) else { return Ok(()) };
        let along = exact::dot(&exact::minus(&p, &exact::vector(apex)), &exact::vector(axis));
        let cone = LightCone { apex, axis, cosine: 0.0 };
        prop_assert_eq!(cone.holds(position.rounded(), || position), along > Rational::ZERO);
    }
}
