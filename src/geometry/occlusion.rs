//! What the float filter leaves open, decided in f64 with a bound and then exactly.

use super::curved::segment::{self, Base};
use super::curved::{Meetings, Shape};
use super::exact_number::{self, ExactNumber, ExactVector};
use super::expansion;
use super::planes::{Plane, oriented};
use super::position::{ExactPosition, HomogeneousPoint};
use super::texel::{Place, TexelAxis, Weights};
use super::{LightPosition, LightSpace, ROUNDOFF, Sign};
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
    space: LightSpace,
    rounded: DVec3,
    position: F,
    homogeneous: OnceCell<HomogeneousPoint>,
}

impl<F: Fn() -> ExactPosition> PreciseQuery<F> {
    /// `rounded` is what `position` returns with each coordinate correctly rounded.
    pub fn new(space: &LightSpace, rounded: DVec3, position: F) -> PreciseQuery<F> {
        PreciseQuery { space: *space, rounded, position, homogeneous: OnceCell::new() }
    }

    /// The exact point relative to the origin of the light's space.
    pub fn exact(&self) -> &HomogeneousPoint {
        self.homogeneous.get_or_init(|| (self.position)().relative_to(self.space.origin()))
    }

    /// Whether the triangle blocks the open segment between point and light (TRUTH, "Occluded").
    pub fn blocks(&self, corners: [Vec3; 3]) -> (bool, Stage) {
        let Some(corners) = oriented(self.space.light(), corners) else { return (false, Stage::Double) };
        match self.blocks_in_f64(corners) {
            Some(answer) => (answer, Stage::Double),
            None => (self.blocks_exactly(corners), Stage::Exact),
        }
    }

    /// Half an ulp of the rounded point and one rounding of a difference with it.
    fn difference_error(&self, difference: DVec3) -> DVec3 {
        (self.rounded.abs() + difference.abs()) * (2.0 * ROUNDOFF)
    }

    /// Whether the open segment crosses the triangle, where a segment that meets an edge is decided as if the
    /// point were moved by (e, e^2, e^3) for a very small e > 0 and stayed on its side of the triangle's plane: of
    /// triangles that share the edge and lie on different sides of it, one is crossed.
    pub fn crosses(&self, corners: [Vec3; 3]) -> (bool, Stage) {
        let Some(corners) = oriented(self.space.light(), corners) else { return (false, Stage::Double) };
        // Inside in f64 is strictly inside.
        if let Some(answer) = self.blocks_in_f64(corners) {
            return (answer, Stage::Double);
        }
        let is_inside = |i: usize| match self.exact_edge(corners, i).sign() {
            Sign::Zero => self.perturbed_edge(corners, i) == Sign::Positive,
            sign => sign == Sign::Positive,
        };
        ((0..3).all(is_inside) && self.is_beyond(corners), Stage::Exact)
    }

    /// Where the point moves to against an edge that the segment meets: the first component of the edge's
    /// plane that is not zero decides.
    fn perturbed_edge(&self, corners: [Vec3; 3], i: usize) -> Sign {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        let normal = match self.space.light() {
            LightPosition::At(light) => {
                expansion::cross(&expansion::difference(a, light), &expansion::difference(b, light))
            }
            LightPosition::Towards(direction) => {
                let direction = direction.to_array().map(expansion::Expansion::from);
                expansion::cross(&expansion::difference(b, a), &direction)
            }
        };
        normal.iter().map(|n| n.sign()).find(|&sign| sign != Sign::Zero).unwrap_or(Sign::Zero)
    }

    pub(super) fn blocks_in_f64(&self, corners: [Vec3; 3]) -> Option<bool> {
        let [a, b, c] = corners;
        let corners = [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()];
        // Plane by plane, since the first one often says that it does not.
        let mut undecided = false;
        for i in 0..3 {
            let (value, bound) = self.edge_in_f64(corners, i);
            match Sign::certain(value, bound) {
                Some(Sign::Negative) => return Some(false),
                Some(_) => {}
                None => undecided = true,
            }
        }
        let (value, bound) = self.height_in_f64(corners);
        match Sign::certain(value, bound) {
            Some(Sign::Negative) => Some(false),
            Some(_) if !undecided => Some(true),
            _ => None,
        }
    }

    /// What the plane through the light and edge i of some corners, in the order of positive orientation, says
    /// of the point, in f64 and with the bound of the error. Both ends of the segment give the same.
    #[inline(always)]
    pub(super) fn edge_in_f64(&self, corners: [DVec3; 3], i: usize) -> (f64, f64) {
        let (a, b) = (corners[i], corners[if i == 2 { 0 } else { i + 1 }]);
        // Relative to a point of the plane: the light, or a corner of the edge.
        let (plane, p) = match self.space.light() {
            LightPosition::At(light) => {
                let light = light.as_dvec3();
                (Plane::through(a - light, b - a), self.rounded - light)
            }
            LightPosition::Towards(direction) => {
                (Plane::through(b - a, direction.as_dvec3()), self.rounded - a)
            }
        };
        plane.dot(p, self.difference_error(p))
    }

    /// What the plane of some corners says of the point, in f64 and with the bound of the error.
    #[inline(always)]
    pub(super) fn height_in_f64(&self, [a, b, c]: [DVec3; 3]) -> (f64, f64) {
        let beyond = self.rounded - a;
        Plane::through(b - a, c - a).dot(beyond, self.difference_error(beyond))
    }

    /// An edge exactly.
    pub(super) fn exact_edge(&self, corners: [Vec3; 3], i: usize) -> ExactNumber {
        let p = self.exact();
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        match self.space.light() {
            LightPosition::At(light) => {
                let (u, v) = (expansion::difference(a, light), expansion::difference(b, light));
                exact_number::dot(&exact_number::vector(expansion::cross(&u, &v)), &p.xyz)
            }
            LightPosition::Towards(direction) => {
                let direction = direction.to_array().map(expansion::Expansion::from);
                let normal = expansion::cross(&expansion::difference(b, a), &direction);
                exact_number::dot(&exact_number::vector(normal), &self.beyond_corner(a))
            }
        }
    }

    /// The exact point relative to a corner, times its denominator.
    fn beyond_corner(&self, corner: Vec3) -> ExactVector {
        let u = exact_number::vector(expansion::difference(corner, self.space.origin()));
        let p = self.exact();
        std::array::from_fn(|k| &p.xyz[k] - &(&u[k] * &p.w))
    }

    /// Corners are in the order of positive orientation.
    pub(super) fn blocks_exactly(&self, corners: [Vec3; 3]) -> bool {
        (0..3).all(|i| self.exact_edge(corners, i).sign() != Sign::Negative) && self.is_beyond(corners)
    }

    /// Whether the point is strictly behind the triangle's plane, as the light sees it.
    fn is_beyond(&self, corners: [Vec3; 3]) -> bool {
        let [a, b, c] = corners;
        let normal = expansion::cross(&expansion::difference(b, a), &expansion::difference(c, a));
        exact_number::dot(&exact_number::vector(normal), &self.beyond_corner(a)).sign() == Sign::Positive
    }

    /// How the open segment between point and light meets a curved surface.
    pub fn meets(&self, shape: &Shape, base: Base) -> (Meetings, Stage) {
        let (light, origin) = (self.space.light(), self.space.origin());
        segment::meets(shape, base, light, self.rounded, || self.exact(), origin)
    }

    /// The side of a curved surface's tangent plane that the light is on, at this point of the surface.
    pub fn side_of_light(&self, shape: &Shape) -> Sign {
        let (light, origin) = (self.space.light(), self.space.origin());
        segment::side_of_light(shape, light, self.rounded, || self.exact(), origin)
    }

    /// The texels of an image that the segment passes through a triangle that blocks it.
    pub fn texels(&self, corners: [Vec3; 3], axes: &[TexelAxis; 2]) -> [Place; 2] {
        let oriented = oriented(self.space.light(), corners).expect("a triangle that blocks");
        let axes = axes.map(|axis| axis.for_corners(oriented[1] == corners[1]));
        let in_f64 = oriented.map(Vec3::as_dvec3);
        // Each edge function is the weight of the corner across.
        let rounded = [1, 2, 0].map(|edge| self.edge_in_f64(in_f64, edge));
        Weights { rounded, exact: || [1, 2, 0].map(|edge| self.exact_edge(oriented, edge)) }.texels(&axes)
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
            is_far in any::<bool>(),
            corners in prop::array::uniform3(coordinates()),
            along in 0.0f32..1.0,
            depth in 0.9f32..1.6,
            offset in prop::sample::select(vec![0.0f32, 100.0, 1e5]),
            scale in prop::sample::select(vec![1.0f32, 1e-20, 1e15]),
        ) {
            let place = |p: Vec3| (p + Vec3::splat(offset)) * scale;
            let corners = corners.map(place);
            let on_edge = corners[0] + along * (corners[1] - corners[0]);
            let bounds = corners[1..].iter().fold((corners[0], corners[0]), |(low, high), &c| (low.min(c), high.max(c)));
            let (space, point) = if is_far {
                (LightSpace::new(LightPosition::Towards(light), bounds), on_edge - (depth - 1.0) * scale * light)
            } else {
                let light = place(light);
                (LightSpace::from(light), light + depth * (on_edge - light))
            };
            let query = PreciseQuery::new(&space, point.as_dvec3(), || ExactPosition::Bare(point));
            let Some(oriented) = oriented(space.light(), corners) else { return Ok(()) };
            let exact = query.blocks_exactly(oriented);
            if let Some(answer) = query.blocks_in_f64(oriented) {
                prop_assert_eq!(answer, exact);
            }
            let record = LightTriangle::new(&space, corners).expect("a light off the plane");
            match record.classify(&LightPoint::new(&space, point.as_dvec3())) {
                Filtered::Blocks => prop_assert!(exact),
                Filtered::Clear => prop_assert!(!exact),
                Filtered::Undecided => {}
            }
        }
    }

    #[test]
    fn what_is_clear_is_decided_in_f64() {
        let corners = [Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.0, -1.0), Vec3::new(0.0, 1.0, 1.0)];
        let ask = |light: LightPosition, point: Vec3| {
            let space = LightSpace::new(light, (Vec3::NEG_ONE, Vec3::ONE));
            let query = PreciseQuery::new(&space, point.as_dvec3(), || ExactPosition::Bare(point));
            (query.blocks(corners), query.crosses(corners))
        };
        for light in [LightPosition::At(Vec3::Y * 2.0), LightPosition::Towards(Vec3::Y)] {
            let of = |answer: bool, stage: Stage| ((answer, stage), (answer, stage));
            assert_eq!(ask(light, Vec3::new(0.1, 0.0, 0.1)), of(true, Stage::Double), "behind it");
            assert_eq!(ask(light, Vec3::new(0.1, 1.5, 0.1)), of(false, Stage::Double), "before it");
            assert_eq!(ask(light, Vec3::new(7.0, 0.0, 0.1)), of(false, Stage::Double), "beside it");
            assert_eq!(ask(light, Vec3::new(0.0, 1.0, 0.0)), of(false, Stage::Exact), "on it");
        }
    }

    #[test]
    fn a_difference_with_the_point_is_wrong_by_half_an_ulp_of_it_and_one_rounding() {
        let space = LightSpace::from(Vec3::ZERO);
        let query = PreciseQuery::new(&space, DVec3::new(3.0, 0.0, -1.0), || unreachable!());
        let error = query.difference_error(DVec3::new(-5.0, 0.25, 0.0));
        assert_eq!(error, DVec3::new(16.0, 0.5, 2.0) * ROUNDOFF);
    }
}
