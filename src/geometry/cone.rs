//! Whether a point is inside the cone of a spot light, exactly.

use super::number::{Number, dot, vector};
use super::position::HomogeneousPoint;
use super::surd::Surd;
use super::{ExactPosition, ROUNDOFF, Sign};
use glam::{DVec3, Vec3};

/// The points that a spot light at the apex shines on: those whose exact cosine from the axis is above a
/// float from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightCone {
    /// The light, in world space.
    pub apex: Vec3,
    /// Where it looks; not zero, not normalised.
    pub axis: Vec3,
    /// Cosine of half the opening, from 0 to 1.
    pub cosine: f32,
}

impl LightCone {
    /// Whether a point is inside. `rounded` is its exact position with each coordinate correctly rounded.
    pub fn holds(&self, rounded: DVec3, exact: impl FnOnce() -> ExactPosition) -> bool {
        let (difference, bound) = self.difference(rounded);
        match Sign::certain(difference, bound) {
            Some(sign) => sign == Sign::Positive,
            None => self.holds_exactly(&exact().relative_to(self.apex)),
        }
    }

    /// v . axis less cosine |v| |axis|, where v leads from the apex to the point, and the bound of its error.
    fn difference(&self, rounded: DVec3) -> (f64, f64) {
        let v = rounded - self.apex.as_dvec3();
        let axis = self.axis.as_dvec3();
        let error = (rounded.abs() + v.abs()) * (2.0 * ROUNDOFF);
        // v is known within `error`: half a roundoff of the position and one of
        // the difference, twice over. The scalar product adds 3 roundoffs of |v| . |axis|. A length is wrong by no
        // more than the sum of the errors of its components and by 3 roundoffs (the squares and sums count half under
        // the root), so that the product of both is by 7; 16 are taken, and 8 for the product with the cosine and the
        // last difference. Squares must not underflow.
        if v.length_squared() < 1e-280 {
            return (0.0, f64::INFINITY);
        }
        let along = v.dot(axis);
        let along_error = (error * 2.0 + v.abs() * (8.0 * ROUNDOFF)).dot(axis.abs());
        let size = v.length() * axis.length();
        let size_error = error.element_sum() * 2.0 * axis.length() + 16.0 * ROUNDOFF * size;
        let cosine = f64::from(self.cosine);
        let bound = along_error + cosine * size_error + 8.0 * ROUNDOFF * (along.abs() + size);
        (along - cosine * size, bound)
    }

    /// Products of degree 12 are beyond what floats hold.
    fn holds_exactly(&self, point: &HomogeneousPoint) -> bool {
        let v = point.xyz.each_ref().map(|x| x.to_surd());
        let axis = vector::<Surd>(self.axis);
        let along = dot(&v, &axis);
        let sizes = dot(&v, &v).times(&dot(&axis, &axis));
        let cosine = Surd::exactly(self.cosine);
        let difference = along.squared().minus(&cosine.squared().times(&sizes));
        along.exact_sign() == Sign::Positive && difference.exact_sign() == Sign::Positive
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn holds(cone: &LightCone, p: Vec3) -> bool {
        cone.holds(p.as_dvec3(), || ExactPosition::Bare(p))
    }

    #[test]
    fn the_border_is_outside_and_one_ulp_decides() {
        // (1, 1, 0) is at exactly 60 degrees from (1, 0, 1).
        let cone = LightCone { apex: Vec3::ZERO, axis: Vec3::new(1.0, 0.0, 1.0), cosine: 0.5 };
        assert!(!holds(&cone, Vec3::new(1.0, 1.0, 0.0)));
        assert!(holds(&cone, Vec3::new(1.0, 1.0f32.next_down(), 0.0)));
        assert!(!holds(&cone, Vec3::new(1.0, 1.0f32.next_up(), 0.0)));
        assert!(holds(&LightCone { cosine: 0.5f32.next_down(), ..cone }, Vec3::new(1.0, 1.0, 0.0)));
        assert!(!holds(&cone, Vec3::new(-1.0, -1.0, 0.0)), "the mirrored cone behind the apex");
        assert!(!holds(&cone, Vec3::ZERO), "the apex itself");
    }

    #[test]
    fn a_half_space_ends_at_its_plane() {
        let half = LightCone { apex: Vec3::ONE, axis: Vec3::NEG_Y, cosine: 0.0 };
        assert!(holds(&half, Vec3::new(100.0, 1.0f32.next_down(), -7.0)));
        assert!(!holds(&half, Vec3::new(100.0, 1.0, -7.0)));
    }

    #[test]
    fn the_bound_is_the_sum_of_what_is_derived() {
        // On one axis everything is counted by hand, in roundoffs.
        let cone = |x: f32| LightCone { apex: Vec3::X * x, axis: Vec3::X * 3.0, cosine: 0.5 };
        for (apex, x, expected, roundoffs) in [
            // The position and the difference 2 (2 + 2), along it 3 (2 * 8 + 8 * 2), the sizes 2 * 3 * 8 + 16 * 6 and half
            // of that, the last 8 (6 + 6).
            (0.0, 2.0, 3.0, 96.0 + 72.0 + 96.0),
            (0.0, -2.0, -9.0, 96.0 + 72.0 + 96.0),
            // Digits that the position loses far away: 2 (5 + 2), 3 (2 * 14 + 8 * 2), 2 * 3 * 14 + 16 * 6.
            (3.0, 5.0, 3.0, 132.0 + 90.0 + 96.0),
        ] {
            let (value, bound) = cone(apex).difference(DVec3::X * x);
            assert_eq!(value, expected);
            assert!((bound / (roundoffs * ROUNDOFF) - 1.0).abs() < 1e-9, "{} roundoffs", bound / ROUNDOFF);
        }
        // A length whose square underflows says nothing.
        assert_eq!(cone(0.0).difference(DVec3::new(1e-170, 1e-165, 0.0)).1, f64::INFINITY);
    }

    proptest! {
        #[test]
        fn the_filter_says_what_integers_say(
            apex in prop::array::uniform3(-2.0f32..2.0),
            axis in prop::array::uniform3(-1.0f32..1.0),
            across in prop::array::uniform3(-1.0f32..1.0),
            length in 0.1f32..9.0,
            offset in prop::sample::select(vec![0.0f32, 1e3, 1e6]),
        ) {
            let (apex, axis, v) = (Vec3::from(apex) + offset, Vec3::from(axis), Vec3::from(across));
            prop_assume!(axis.length() > 0.1 && v.length() > 0.1);
            // A cone whose border passes as near to the point as an f32 cosine can.
            let cosine = (v.dot(axis) / (v.length() * axis.length())).clamp(0.0, 1.0);
            let p = apex + v * length;
            for cosine in [cosine.next_down().max(0.0), cosine, cosine.next_up().min(1.0)] {
                let cone = LightCone { apex, axis, cosine };
                let exact = cone.holds_exactly(&ExactPosition::Bare(p).relative_to(apex));
                prop_assert_eq!(holds(&cone, p), exact);
            }
        }
    }
}
