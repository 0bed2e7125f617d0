//! A triangle as one light sees it: four planes in 64 bytes, and a float filter with a proven bound.
//!
//! The planes are those of [`planes`](super::planes): three through the light and an edge, and the triangle's
//! own. With corners in the order that makes the orientation positive, a point is blocked exactly if it is
//! not outside any edge and beyond the triangle's own plane. (TRUTH: strictly opposite depth signs, no two
//! edge signs opposite. For that order all edge signs negative would put the point on the light's side.)

use super::planes::{OrientedPlanes, oriented};
use super::{LightSpace, ROUNDOFF};
use glam::{DVec3, Vec3};

/// What the filter can say about one triangle and one point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filtered {
    /// The triangle certainly blocks.
    Blocks,
    /// The triangle certainly does not block.
    Clear,
    /// The bound does not allow an answer.
    Undecided,
}

/// Four planes relative to the origin of the light's space, one a lane: three edges (their offsets are 0 for
/// a light at a point) and the triangle's own plane. Every plane is scaled so that its largest coefficient
/// is 1.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct LightTriangle {
    pub(crate) x: [f32; 4],
    pub(crate) y: [f32; 4],
    pub(crate) z: [f32; 4],
    pub(crate) offset: [f32; 4],
}

/// A point relative to the origin of the light's space in 16 bytes: coordinates rounded to f32 and the error bound of
/// [`LightTriangle::classify`].
///
/// The bound, with u = 2^-24 and |p| the sum of absolute coordinates. Coefficients are at most 1 and wrong
/// by at most 1.25 u (one rounding to f32 and 2^-27 from f64, checked when they are made); p is wrong by
/// u |p| and by what its f64 position is wrong; three products add u |p|, two sums 2 u |p|, and subtracting
/// the offset h another u (|p| + |h|). Where h is 0 that is less than 7 u |p| in all. Otherwise h itself is
/// wrong by 1.25 u |h| and the allowance below; a bound of 16 u |p| covers that where |h| <= 3 |p|, and where
/// |h| is larger, N . p - h is beyond 2 |p| on the side of -h, so that its computed sign is right by far.
/// The allowance is for offsets that nearly cancel, of planes that pass the origin closely: 2^-40 of the
/// space's reach, 0 for a light at a point, where only the own plane has an offset. Underflow of a product or of a coordinate adds
/// at most 2^-126 each, subnormals flushed or not. Where |p| is so large that a coordinate or a sum could
/// overflow, the slack is infinite, which leaves every test undecided.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct LightPoint {
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    pub(crate) slack: f32,
}

impl LightPoint {
    /// A point whose exact coordinates are within half an ulp of `rounded`.
    pub fn new(space: &LightSpace, rounded: DVec3) -> LightPoint {
        let p = rounded - space.origin().as_dvec3();
        let size = p.x.abs() + p.y.abs() + p.z.abs();
        // Half an ulp of the position and half an ulp of the difference, generously.
        let position_error = 4.0 * ROUNDOFF * (rounded.x.abs() + rounded.y.abs() + rounded.z.abs() + size);
        let bound = (size * (1.0 / 1_048_576.0) + position_error + allowance(space)) * 1.000_001 + 1e-36;
        let slack = if size < f64::from(f32::MAX) * 0.25 { bound } else { f64::INFINITY };
        LightPoint { x: p.x as f32, y: p.y as f32, z: p.z as f32, slack: slack as f32 }
    }
}

/// How far an offset may be wrong beyond its relative error.
fn allowance(space: &LightSpace) -> f64 {
    space.reach() * (1.0 / 1_099_511_627_776.0)
}

impl LightTriangle {
    /// What leaves every test undecided: stands for primitives that are not triangles among those that are.
    pub const UNDECIDED: LightTriangle =
        LightTriangle { x: [f32::NAN; 4], y: [f32::NAN; 4], z: [f32::NAN; 4], offset: [0.0; 4] };

    /// The planes of a triangle, or `None` if its plane holds the light (such triangles never block).
    pub fn new(space: &LightSpace, corners: [Vec3; 3]) -> Option<LightTriangle> {
        let planes = OrientedPlanes::new(space, oriented(space.light(), corners)?.map(Vec3::as_dvec3));
        let mut record = LightTriangle { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4], offset: [0.0; 4] };
        let offsets = planes.offsets.iter().chain([&planes.height]);
        for (lane, (plane, &offset)) in planes.edges.iter().chain([&planes.own]).zip(offsets).enumerate() {
            let [x, y, z] = plane.scaled_to_f32();
            (record.x[lane], record.y[lane], record.z[lane]) = (x, y, z);
            if offset != (0.0, 0.0) {
                record.offset[lane] = plane.scaled_value(offset, allowance(space));
            }
        }
        Some(record)
    }

    /// The four plane values at a point, in one fixed order of operations.
    #[inline(always)]
    pub(super) fn values(&self, p: &LightPoint) -> [f32; 4] {
        std::array::from_fn(|i| ((self.x[i] * p.x + self.y[i] * p.y) + self.z[i] * p.z) - self.offset[i])
    }

    /// Whether the triangle blocks the open segment from the light to the point, as far as floats can tell.
    #[inline(always)]
    pub fn classify(&self, p: &LightPoint) -> Filtered {
        let values = self.values(p);
        if values.iter().any(|&v| v < -p.slack) {
            Filtered::Clear
        } else if values.iter().all(|&v| v > p.slack) {
            Filtered::Blocks
        } else {
            Filtered::Undecided
        }
    }

    /// Whether the ray through a point certainly passes through the inside of the triangle.
    pub fn certainly_holds(&self, p: &LightPoint) -> bool {
        self.values(p)[..3].iter().all(|&v| v > p.slack)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_fills_one_cache_line() {
        assert_eq!(size_of::<LightTriangle>(), 64);
        assert_eq!(size_of::<LightPoint>(), 16);
    }

    #[test]
    fn a_triangle_whose_plane_holds_the_light_has_no_record() {
        let corners = [Vec3::X, Vec3::Y, Vec3::new(0.5, 0.5, 0.0)];
        assert!(LightTriangle::new(&Vec3::new(7.0, -3.0, 0.0).into(), corners).is_none());
        assert!(
            LightTriangle::new(&Vec3::new(7.0, -3.0, f32::from_bits(1)).into(), [Vec3::X, Vec3::Y, -Vec3::X])
                .is_some()
        );
    }

    #[test]
    fn the_slack_of_a_point_is_what_is_derived() {
        let slack = |space: &LightSpace, p: DVec3| f64::from(LightPoint::new(space, p).slack);
        let is_about = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-5;
        // 16 roundoffs of f32 of the sum of coordinates.
        let p = DVec3::new(1.0, -2.0, 5.0);
        assert!(is_about(slack(&Vec3::ZERO.into(), p), 8.0 * 2.0_f64.powi(-20)));
        // Far from the origin the position's own rounding: 4 of f64, of 2^40 in three coordinates.
        let far = Vec3::splat(2.0_f32.powi(40));
        assert!(is_about(slack(&far.into(), far.as_dvec3()), 12.0 * 2.0_f64.powi(40) * ROUNDOFF));
        // Where there are offsets, 2^-40 of the reach.
        let bounds = (Vec3::splat(-2.0), Vec3::splat(2.0));
        let space = LightSpace::new(crate::geometry::LightPosition::Towards(Vec3::Y), bounds);
        assert!(is_about(slack(&space, DVec3::ZERO), 6.0 * 2.0_f64.powi(-40)));
        assert!(is_about(slack(&space, p), 8.0 * 2.0_f64.powi(-20)));
        assert_eq!(slack(&Vec3::ZERO.into(), DVec3::X * 1e38), f64::INFINITY);
    }

    #[test]
    fn a_value_at_the_very_bound_decides_nothing() {
        let t = LightTriangle { x: [1.0; 4], y: [0.0; 4], z: [0.0; 4], offset: [0.0, 0.0, 0.0, -8.0] };
        let at = |x: f32| LightPoint { x, y: 0.0, z: 0.0, slack: 0.25 };
        let next = 0.25_f32.next_up();
        assert_eq!(
            [next, 0.25, 0.0, -0.25, -next].map(|x| t.classify(&at(x))),
            [
                Filtered::Blocks,
                Filtered::Undecided,
                Filtered::Undecided,
                Filtered::Undecided,
                Filtered::Clear
            ]
        );
        assert_eq!([next, 0.25, -next].map(|x| t.certainly_holds(&at(x))), [true, false, false]);
        // Only the edges are asked whether a point is held: here it is before the triangle.
        let behind = LightTriangle { offset: [0.0, 0.0, 0.0, 8.0], ..t };
        assert!(behind.certainly_holds(&at(1.0)));
        assert_eq!(behind.classify(&at(1.0)), Filtered::Clear);
    }
}
