//! Where rays from one origin meet a triangle: exact hit signs and exact order of two hits.
//!
//! Seen from the origin of the rays a triangle is the same four planes as from a light: with the corners
//! ordered so that det(u0, u1, u2) > 0, a direction d hits the closed triangle at some t > 0 exactly if
//! (ui x uj) . d >= 0 for the three edges. Then t = h / (N . d), a quotient of positive numbers of degree 3.

use super::curved::{ExactParameter, RayStart};
use super::expansion::{self, Expansion};
use super::planes::{OrientedPlanes, Plane, oriented};
use super::texel::{Place, TexelAxis, Weights};
use super::{LightPosition, ROUNDOFF, Sign};
use glam::{DVec3, Vec3};
use std::cmp::Ordering;

/// A triangle prepared for rays from one origin.
#[derive(Debug, Clone, Copy)]
pub struct RayTriangle {
    origin: Vec3,
    /// Ordered so that det(u0, u1, u2) > 0.
    oriented: [Vec3; 3],
    planes: OrientedPlanes,
}

/// The ray parameter of a hit in f64, within `error` of the exact one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayParameter {
    /// Nearest known value.
    pub value: f64,
    /// Bound of its error.
    pub error: f64,
}

impl RayTriangle {
    /// Prepares a triangle; `None` if its plane holds the origin, so that no ray hits it at t > 0.
    pub fn new(origin: Vec3, corners: [Vec3; 3]) -> Option<RayTriangle> {
        let oriented = oriented(origin, corners)?;
        let planes = OrientedPlanes::from_apex(origin.as_dvec3(), oriented.map(Vec3::as_dvec3));
        Some(RayTriangle { origin, oriented, planes })
    }

    /// The planes that a footprint on an image or a cube face is made from.
    pub(crate) fn planes(&self) -> &OrientedPlanes {
        &self.planes
    }

    /// Where the ray in an exact direction hits the closed triangle.
    pub fn hit(&self, direction: Vec3) -> Option<RayParameter> {
        let d = direction.as_dvec3();
        for (k, edge) in self.planes.edges.iter().enumerate() {
            let (value, bound) = edge.dot(d, DVec3::ZERO);
            let sign = Sign::certain(value, bound).unwrap_or_else(|| self.exact_edge(k, direction).sign());
            if sign == Sign::Negative {
                return None;
            }
        }
        let (height, height_error) = self.planes.height;
        let (slope, slope_error) = self.planes.own.dot(d, DVec3::ZERO);
        let value = height / slope;
        // |h / s - H / S| = |h (S - s) + s (h - H)| / (s S) <= (t |S - s| + |h - H|) / S for the computed t = h / s,
        // and S > s / 2 where s is more than twice its bound. The division is wrong by a roundoff of t.
        let certain = slope > 2.0 * slope_error && value.is_finite();
        let error = if certain {
            2.0 * (height_error + value * slope_error) / slope + 4.0 * ROUNDOFF * value
        } else {
            f64::INFINITY
        };
        Some(RayParameter { value, error })
    }

    fn exact_edge(&self, k: usize, direction: Vec3) -> Expansion {
        let u = |i: usize| expansion::difference(self.oriented[i % 3], self.origin);
        expansion::dot(&expansion::cross(&u(k), &u(k + 1)), &direction.to_array().map(Expansion::from))
    }

    /// The texels of an image that a ray that hits shows; `corners` are in the order of the image's axes.
    pub fn texels(&self, corners: [Vec3; 3], direction: Vec3, axes: &[TexelAxis; 2]) -> [Place; 2] {
        let axes = axes.map(|axis| axis.for_corners(self.oriented[1] == corners[1]));
        // Each edge function is the weight of the corner across.
        let edges = [1, 2, 0];
        let rounded = edges.map(|k| self.planes.edges[k].dot(direction.as_dvec3(), DVec3::ZERO));
        Weights { rounded, exact: || edges.map(|k| self.exact_edge(k, direction).into()) }.texels(&axes)
    }

    /// Order of the hits of one ray with two triangles of the same origin, exactly.
    pub fn exact_order(direction: Vec3, first: &RayTriangle, second: &RayTriangle) -> Ordering {
        let place = |t: &RayTriangle| exact_parameter(t.origin, direction, t.oriented);
        place(first).order(&place(second))
    }
}

/// Where a ray hits the closed triangle beyond its start. A ray parallel to the triangle's plane misses it.
pub fn hit_beyond(
    origin: Vec3,
    direction: Vec3,
    corners: [Vec3; 3],
    start: &RayStart,
) -> Option<RayParameter> {
    // Seen along the ray, from infinitely far behind it, the triangle's edges are planes along the ray.
    let corners = oriented(LightPosition::Towards(-direction), corners)?;
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (o, d) = (origin.as_dvec3(), direction.as_dvec3());
    for (k, (p, q)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
        let (value, bound) = rounded_edge_along(o, d, [p, q]);
        let sign = Sign::certain(value, bound).unwrap_or_else(|| edge_along(origin, direction, corners, k));
        if sign == Sign::Negative {
            return None;
        }
    }
    let own = Plane::through(b - a, c - a);
    let (height, height_error) = own.dot(a - o, (a - o).abs() * f64::EPSILON);
    let (slope, slope_error) = own.dot(d, DVec3::ZERO);
    let value = height / slope;
    // As in `RayTriangle::hit`; here the height has either sign.
    let certain = slope > 2.0 * slope_error && value.is_finite();
    let error = if certain {
        2.0 * (height_error + value.abs() * slope_error) / slope + 4.0 * ROUNDOFF * value.abs()
    } else {
        f64::INFINITY
    };
    let hit = RayParameter { value, error };
    let order = hit.certain_order(start.rounded()).unwrap_or_else(|| {
        exact_parameter(origin, direction, corners).order(&start.exact(origin, direction))
    });
    (order == Ordering::Greater).then_some(hit)
}

/// The side of the plane through an edge along a ray that its origin is on, and the bound of its error.
fn rounded_edge_along(origin: DVec3, direction: DVec3, [p, q]: [DVec3; 2]) -> (f64, f64) {
    // One rounding of each difference, twice over.
    let relative = origin - p;
    Plane::through(q - p, -direction).dot(relative, relative.abs() * f64::EPSILON)
}

/// The exact side of the plane through edge k along a ray.
fn edge_along(origin: Vec3, direction: Vec3, corners: [Vec3; 3], k: usize) -> Sign {
    let (p, q) = (corners[k], corners[(k + 1) % 3]);
    let backwards = (-direction).to_array().map(Expansion::from);
    let normal = expansion::cross(&expansion::difference(q, p), &backwards);
    expansion::dot(&normal, &expansion::difference(origin, p)).sign()
}

/// Where the line of a ray meets the plane of a triangle that it is not parallel to, exactly.
pub fn exact_parameter(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> ExactParameter {
    let normal = expansion::cross(&expansion::difference(b, a), &expansion::difference(c, a));
    let height = expansion::dot(&normal, &expansion::difference(a, origin));
    let slope = expansion::dot(&normal, &direction.to_array().map(Expansion::from));
    match slope.sign() {
        Sign::Negative => ExactParameter::quotient(&-&height, &-&slope),
        _ => ExactParameter::quotient(&height, &slope),
    }
}

impl RayParameter {
    /// The order of two hits of one ray, if their bounds decide it.
    pub fn certain_order(self, other: RayParameter) -> Option<Ordering> {
        let bound = (self.error + other.error) * (1.0 + 8.0 * ROUNDOFF);
        Sign::certain(self.value - other.value, bound).map(|sign| match sign {
            Sign::Negative => Ordering::Less,
            _ => Ordering::Greater,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shared_edges_and_vertices_hit_both_triangles_at_the_same_parameter() {
        let (a, b, c, d) = (
            Vec3::new(0.0, 0.0, -3.0),
            Vec3::new(1.0, 0.0, -2.0),
            Vec3::new(0.0, 1.0, -5.0),
            Vec3::new(1.0, 1.0, -4.0),
        );
        let first = RayTriangle::new(Vec3::ZERO, [a, b, c]).unwrap();
        let second = RayTriangle::new(Vec3::ZERO, [b, c, d]).unwrap();
        for direction in [b, c, b + c] {
            let (t, s) = (first.hit(direction).unwrap(), second.hit(direction).unwrap());
            assert_eq!(t.certain_order(s), None);
            let [first, second] = [[a, b, c], [b, c, d]].map(|t| exact_parameter(Vec3::ZERO, direction, t));
            assert_eq!(first.order(&second), Ordering::Equal);
        }
        assert!(first.hit(-b).is_none());
        assert!(second.hit(a).is_none());
    }

    #[test]
    fn a_ray_in_the_plane_misses() {
        assert!(RayTriangle::new(Vec3::ZERO, [Vec3::X, Vec3::Y, Vec3::ONE - Vec3::Z]).is_none());
    }

    #[test]
    fn the_error_of_a_parameter_is_what_is_derived() {
        // Across the z axis. With n = (0, 0, 4) the height is 8 within 4 (2 * 12 + 2 * 4) = 128 roundoffs, the slope 4
        // within 48, and t = 2 within 2 (128 + 2 * 48) / 4 + 4 * 2 = 120.
        let corners = [Vec3::new(-1.0, -1.0, 2.0), Vec3::new(1.0, -1.0, 2.0), Vec3::new(0.0, 1.0, 2.0)];
        let direction = Vec3::Z;
        for (scale, origin) in [(1.0_f32, Vec3::ZERO), (2.0_f32.powi(-20), Vec3::ZERO), (1.0, Vec3::Z * 16.0)]
        {
            let corners = corners.map(|p| p * scale + origin);
            let found = [
                RayTriangle::new(origin, corners).and_then(|t| t.hit(direction)),
                hit_beyond(origin, direction, corners, &RayStart::origin()),
            ];
            for RayParameter { value, error } in found.map(|hit| hit.expect("a hit")) {
                let expected = f64::from(scale) * 120.0 * ROUNDOFF;
                assert_eq!(value, 2.0 * f64::from(scale));
                assert!((error / expected - 1.0).abs() < 1e-9, "{} roundoffs", error / ROUNDOFF);
            }
        }
    }

    #[test]
    fn hits_are_in_order_where_their_bounds_are_apart() {
        let at = |value: f64, error: f64| RayParameter { value, error };
        assert_eq!(at(1.0, 0.25).certain_order(at(2.0, 0.5)), Some(Ordering::Less));
        assert_eq!(at(2.0, 0.25).certain_order(at(1.0, 0.5)), Some(Ordering::Greater));
        assert_eq!(at(1.0, 0.5).certain_order(at(2.0, 0.5)), None);
        assert_eq!(at(1.0, 1.0).certain_order(at(2.0, 0.5)), None);
        // The sum of the bounds is rounded down to what lies between.
        let tiny = ROUNDOFF * 0.75;
        assert_eq!(at(0.0, 1.0).certain_order(at(1.0 + 2.0 * ROUNDOFF, tiny)), None);
    }

    #[test]
    fn exact_places_do_not_depend_on_the_order_of_corners() {
        let at = |z: f32| [Vec3::new(-1.0, -1.0, z), Vec3::new(1.0, -1.0, z), Vec3::new(0.0, 1.0, z)];
        let place = |[a, b, c]: [Vec3; 3]| {
            [[a, b, c], [a, c, b]].map(|t| exact_parameter(Vec3::ZERO, Vec3::new(0.1, 0.1, 1.0), t))
        };
        for near in &place(at(2.0)) {
            assert!(place(at(2.0)).iter().all(|same| near.order(same) == Ordering::Equal));
            assert!(place(at(3.0)).iter().all(|far| near.order(far) == Ordering::Less));
            assert!(place(at(-3.0)).iter().all(|behind| near.order(behind) == Ordering::Greater));
        }
    }

    #[test]
    fn the_side_of_an_edge_is_as_uncertain_as_is_derived() {
        // Along z, beside an edge along x: n = (0, 6, 0), the origin 5 beside it.
        let (value, bound) =
            rounded_edge_along(DVec3::Y * -5.0, DVec3::Z * 2.0, [DVec3::ZERO, DVec3::X * 3.0]);
        assert_eq!(value, -30.0);
        // 6 (12 * 5 + 2 * 2 * 5).
        assert!((bound / (480.0 * ROUNDOFF) - 1.0).abs() < 1e-9, "{}", bound / ROUNDOFF);
    }

    #[test]
    fn a_slope_that_floats_hardly_know_tells_no_place() {
        // The normal is (0, 0, 1), the difference of products of 2^48.
        let large = 16_777_216.0;
        let a = Vec3::Z;
        let corners =
            [a, a + Vec3::new(large - 1.0, large - 2.0, 0.0), a + Vec3::new(large, large - 1.0, 0.0)];
        let hit = RayTriangle::new(Vec3::ZERO, corners)
            .and_then(|triangle| triangle.hit(Vec3::Z))
            .expect("a corner");
        assert_eq!((hit.value, hit.error), (1.0, f64::INFINITY));
        let hit = hit_beyond(Vec3::ZERO, Vec3::Z, corners, &RayStart::origin()).expect("a corner");
        assert_eq!((hit.value, hit.error), (1.0, f64::INFINITY));
    }

    #[test]
    fn texels_do_not_depend_on_the_side_that_a_triangle_is_seen_from() {
        use crate::geometry::ExactPosition;
        use crate::geometry::LightSpace;
        use crate::geometry::occlusion::PreciseQuery;
        // Four columns along x and two rows along y.
        let corners = [Vec3::new(0.0, 0.0, 2.0), Vec3::new(4.0, 0.0, 2.0), Vec3::new(0.0, 4.0, 2.0)];
        let axis = |coordinates: [f32; 3], size: u32| TexelAxis { coordinates, size };
        let axes = [axis([0.0, 1.0, 0.0], 4), axis([0.0, 0.0, 1.0], 2)];
        let (x, y) = (2.5, 0.5);
        for z in [0.0, 4.0] {
            let origin = Vec3::new(x, y, z);
            let direction = Vec3::Z * (2.0 - z);
            let expected = [Place::Near(2), Place::Near(0)];
            let triangle = RayTriangle::new(origin, corners).expect("seen");
            assert_eq!(triangle.texels(corners, direction, &axes), expected);
            let point = Vec3::new(x, y, 4.0 - z);
            let query =
                PreciseQuery::new(&LightSpace::from(origin), point.as_dvec3(), || ExactPosition::Bare(point));
            assert_eq!(query.texels(corners, &axes), expected);
        }
    }
}
