//! What the float filter leaves open, decided in f64 with a bound and then exactly.

use super::expansion::{self, Expansion};
use super::light_triangle::{OrientedPlanes, orientation};
use super::position::{ExactPosition, HomogeneousPoint};
use super::{ROUNDOFF, Sign};
use glam::{DVec3, Vec3};
use std::cell::OnceCell;

/// The precision that it took to decide a test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// f64 with an error bound.
    Double,
    /// Expansions.
    Exact,
}

/// One light and one point, with the exact point made when it is first needed.
pub struct PreciseQuery<F> {
    light: Vec3,
    rounded: DVec3,
    position: F,
    homogeneous: OnceCell<HomogeneousPoint>,
}

impl<F: Fn() -> ExactPosition> PreciseQuery<F> {
    /// `rounded` is what `position` returns with each coordinate correctly rounded.
    pub fn new(light: Vec3, rounded: DVec3, position: F) -> PreciseQuery<F> {
        PreciseQuery { light, rounded, position, homogeneous: OnceCell::new() }
    }

    /// The exact point relative to the light.
    pub fn exact(&self) -> &HomogeneousPoint {
        self.homogeneous.get_or_init(|| (self.position)().relative_to(self.light))
    }

    /// Whether the triangle blocks the open segment between point and light (TRUTH, "Occluded").
    pub fn blocks(&self, corners: [Vec3; 3]) -> (bool, Stage) {
        let corners = match orientation(self.light, corners) {
            Sign::Zero => return (false, Stage::Double),
            Sign::Positive => corners,
            Sign::Negative => [corners[0], corners[2], corners[1]],
        };
        match self.blocks_in_f64(corners) {
            Some(answer) => (answer, Stage::Double),
            None => (self.blocks_exactly(corners), Stage::Exact),
        }
    }

    /// Half an ulp of the rounded point and one rounding of a difference with it.
    fn difference_error(&self, difference: DVec3) -> DVec3 {
        (self.rounded.abs() + difference.abs()) * (2.0 * ROUNDOFF)
    }

    fn blocks_in_f64(&self, corners: [Vec3; 3]) -> Option<bool> {
        let light = self.light.as_dvec3();
        let planes = OrientedPlanes::new(light, corners.map(Vec3::as_dvec3));
        let p = self.rounded - light;
        let error = self.difference_error(p);
        let mut undecided = false;
        for edge in &planes.edges {
            let (value, bound) = edge.dot(p, error);
            match Sign::certain(value, bound) {
                Some(Sign::Negative) => return Some(false),
                Some(_) => {}
                None => undecided = true,
            }
        }
        let beyond = self.rounded - corners[0].as_dvec3();
        let (value, bound) = planes.own.dot(beyond, self.difference_error(beyond));
        match Sign::certain(value, bound) {
            Some(Sign::Negative) => Some(false),
            Some(_) if !undecided => Some(true),
            _ => None,
        }
    }

    /// Corners are ordered so that det(u0, u1, u2) > 0.
    fn blocks_exactly(&self, [a, b, c]: [Vec3; 3]) -> bool {
        let p = self.exact();
        let u = [a, b, c].map(|corner| expansion::difference(corner, self.light));
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            if expansion::dot(&expansion::cross(&u[i], &u[j]), &p.xyz).sign() == Sign::Negative {
                return false;
            }
        }
        let normal = expansion::cross(&expansion::difference(b, a), &expansion::difference(c, a));
        let beyond: [Expansion; 3] = [0, 1, 2].map(|i| &p.xyz[i] - &(&u[0][i] * &p.w));
        expansion::dot(&normal, &beyond).sign() == Sign::Positive
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Filtered, LightPoint, LightTriangle};
    use proptest::prelude::*;

    fn coordinates() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1.0f32..1.0).prop_map(Vec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        /// Points behind an edge of the triangle, as seen from the light, are as near to undecidable as f32
        /// positions come; far from the origin the coordinates of everything carry few digits.
        #[test]
        fn no_filter_contradicts_exact_arithmetic(
            light in coordinates(),
            corners in prop::array::uniform3(coordinates()),
            along in 0.0f32..1.0,
            depth in 0.9f32..1.6,
            offset in prop::sample::select(vec![0.0f32, 100.0, 1e5]),
            scale in prop::sample::select(vec![1.0f32, 1e-20, 1e15]),
        ) {
            let place = |p: Vec3| (p + Vec3::splat(offset)) * scale;
            let corners = corners.map(place);
            let light = place(light);
            let on_edge = corners[0] + along * (corners[1] - corners[0]);
            let point = light + depth * (on_edge - light);
            let query = PreciseQuery::new(light, point.as_dvec3(), || ExactPosition::Bare(point));
            let oriented = match orientation(light, corners) {
                Sign::Zero => return Ok(()),
                Sign::Positive => corners,
                Sign::Negative => [corners[0], corners[2], corners[1]],
            };
            let exact = query.blocks_exactly(oriented);
            if let Some(answer) = query.blocks_in_f64(oriented) {
                prop_assert_eq!(answer, exact);
            }
            let record = LightTriangle::new(light, corners).expect("a light off the plane");
            match record.classify(&LightPoint::new(light, point.as_dvec3())) {
                Filtered::Blocks => prop_assert!(exact),
                Filtered::Clear => prop_assert!(!exact),
                Filtered::Undecided => {}
            }
        }
    }
}
