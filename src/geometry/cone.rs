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
        let v = rounded - self.apex.as_dvec3();
        let axis = self.axis.as_dvec3();
        let error = (rounded.abs() + v.abs()) * (2.0 * ROUNDOFF);
        // v . axis against cosine |v| |axis|, with v known within `error`: half a roundoff of the position and one of
        // the difference, twice over. The scalar product adds 3 roundoffs of |v| . |axis|. A length is wrong by no
        // more than the sum of the errors of its components and by 3 roundoffs (the squares and sums count half under
        // the root), so that the product of both is by 7; 16 are taken, and 8 for the product with the cosine and the
        // last difference. Squares must not underflow.
        if v.length_squared() < 1e-280 {
            return self.holds_exactly(&exact().relative_to(self.apex));
        }
        let along = v.dot(axis);
        let along_error = (error * 2.0 + v.abs() * (8.0 * ROUNDOFF)).dot(axis.abs());
        let size = v.length() * axis.length();
        let size_error = error.element_sum() * 2.0 * axis.length() + 16.0 * ROUNDOFF * size;
        let cosine = f64::from(self.cosine);
        let bound = along_error + cosine * size_error + 8.0 * ROUNDOFF * (along.abs() + size) + 1e-300;
        match Sign::certain(along - cosine * size, bound) {
            Some(sign) => sign == Sign::Positive,
            None => self.holds_exactly(&exact().relative_to(self.apex)),
        }
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
