//! The planes of a triangle as a light or a camera sees it, in f64 with error bounds.
//!
//! All segments of a light meet in it, at a point or infinitely far away. A triangle is then three planes,
//! each through the light and an edge, and its own. With corners a, b, c relative to an apex at a point the
//! plane through edge ab has the normal a x b and holds the origin; for a light in the direction L it has the
//! normal (b - a) x L and holds a. Both are the same plane in homogeneous coordinates, so that everything
//! that follows is one theory: a point p is blocked exactly if the three edge functions are not negative and
//! N . (p - a) > 0, where N = (b - a) x (c - a) points away from the light.

use super::expansion::{self, Expansion};
use super::{LightPosition, LightSpace, ROUNDOFF, Sign};
use glam::{DVec3, Vec3};

/// The exact side of a triangle's plane that a light is on: the sign of det(a - l, b - l, c - l) for a light
/// at l, and of -N . L for one in the direction L. Positive where N points away from it.
pub fn orientation(light: impl Into<LightPosition>, [a, b, c]: [Vec3; 3]) -> Sign {
    match light.into() {
        LightPosition::At(point) => {
            // Adaptive and exact for f32 coordinates, denormal ones too: no product of it underflows.
            let coord = |p: Vec3| robust::Coord3D { x: f64::from(p.x), y: f64::from(p.y), z: f64::from(p.z) };
            Sign::of(robust::orient3d(coord(a), coord(b), coord(c), coord(point)))
        }
        LightPosition::Towards(direction) => {
            let [p, q, r] = [a, b, c].map(Vec3::as_dvec3);
            let (value, bound) = Plane::through(q - p, r - p).dot(direction.as_dvec3(), DVec3::ZERO);
            -Sign::certain(value, bound).unwrap_or_else(|| {
                let normal = expansion::cross(&expansion::difference(b, a), &expansion::difference(c, a));
                expansion::dot(&normal, &direction.to_array().map(Expansion::from)).sign()
            })
        }
    }
}

/// The corners in the order that makes the orientation positive, or `None` if the triangle's plane holds the
/// light: such triangles never block.
pub fn oriented(light: impl Into<LightPosition>, corners: [Vec3; 3]) -> Option<[Vec3; 3]> {
    match orientation(light, corners) {
        Sign::Zero => None,
        Sign::Positive => Some(corners),
        Sign::Negative => Some([corners[0], corners[2], corners[1]]),
    }
}

/// A plane normal in f64, and for each component the sum of the absolute values of its two terms.
///
/// A component is p q - r s with each factor a difference rounded once: 2 roundoffs from the factors, 1 from the
/// product and 1 from the difference, which is at most its `size`. So it is wrong by 4 roundoffs of the exact size,
/// and by less than 5 of the computed one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    pub normal: DVec3,
    pub size: DVec3,
}

impl Plane {
    #[inline(always)]
    pub fn through(a: DVec3, b: DVec3) -> Plane {
        let (ayz, azy) = (a.y * b.z, a.z * b.y);
        let (azx, axz) = (a.z * b.x, a.x * b.z);
        let (axy, ayx) = (a.x * b.y, a.y * b.x);
        Plane {
            normal: DVec3::new(ayz - azy, azx - axz, axy - ayx),
            size: DVec3::new(ayz.abs() + azy.abs(), azx.abs() + axz.abs(), axy.abs() + ayx.abs()),
        }
    }

    /// The normal in f32 with its largest component 1; NaN, which leaves every test undecided, if f64 was
    /// not precise enough for a relative error of 2^-27.
    pub fn scaled_to_f32(&self) -> [f32; 3] {
        let largest = self.normal.abs().max_element();
        let error = 8.0 * ROUNDOFF * self.size.max_element();
        if error <= largest * (1.0 / 134_217_728.0) && largest.is_finite() {
            (self.normal / largest).as_vec3().to_array()
        } else {
            [f32::NAN; 3]
        }
    }

    /// A value of this plane in the scale of [`Plane::scaled_to_f32`]; NaN if it is not known within 2^-27
    /// of itself and `allowance`.
    pub fn scaled_value(&self, (value, bound): (f64, f64), allowance: f64) -> f32 {
        let largest = self.normal.abs().max_element();
        let scaled = (value / largest) as f32;
        let precise = bound <= value.abs() * (1.0 / 134_217_728.0) + allowance * largest;
        if precise && scaled.is_finite() { scaled } else { f32::NAN }
    }

    /// The scalar product with a vector whose components are wrong by at most `error`, and its bound.
    ///
    /// Per component: 5 roundoffs of `size` from the normal, 1 from the product, 2 from the sums, 8 in all of
    /// size * |v|, and |normal| times the vector's own error; 12 roundoffs of size * |v| and twice size * error are
    /// above that, since |normal| <= size. Products with a tiny position may underflow, each by at most 2^-1074.
    #[inline(always)]
    pub fn dot(&self, v: DVec3, error: DVec3) -> (f64, f64) {
        let n = self.normal;
        let value = (n.x * v.x + n.y * v.y) + n.z * v.z;
        let bound = self.size.dot(v.abs() * (12.0 * ROUNDOFF) + error * 2.0);
        (value, bound * (1.0 + 8.0 * ROUNDOFF) + 1e-300)
    }
}

/// The planes of a triangle with positive orientation, relative to an origin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OrientedPlanes {
    /// Corners relative to the origin, each coordinate rounded once.
    pub corners: [DVec3; 3],
    /// Planes through the light and edges 01, 12, 20, positive inside.
    pub edges: [Plane; 3],
    /// Value of each edge's normal on that edge, and the bound of its error: exactly 0 for planes that hold
    /// the origin.
    pub offsets: [(f64, f64); 3],
    /// The triangle's own plane, with its normal pointing away from the light.
    pub own: Plane,
    /// own . u0, and the bound of its error; positive if the light is the origin.
    pub height: (f64, f64),
}

impl OrientedPlanes {
    /// Seen from a camera or a light at the origin of the coordinates.
    #[inline(always)]
    pub fn from_apex(apex: DVec3, corners: [DVec3; 3]) -> OrientedPlanes {
        let [a, b, c] = corners;
        let u = [a - apex, b - apex, c - apex];
        let own = Plane::through(b - a, c - a);
        OrientedPlanes {
            corners: u,
            // u x (v - u) = u x v, and keeps the digits of small triangles far away.
            edges: [Plane::through(u[0], b - a), Plane::through(u[1], c - b), Plane::through(u[2], a - c)],
            offsets: [(0.0, 0.0); 3],
            own,
            height: own.dot(u[0], rounded_once(u[0])),
        }
    }

    /// A triangle of a hull seen from an apex, whichever way its corners go round; `None` if it is seen so nearly
    /// edge-on that the hull's margin covers what it would cover.
    pub fn of_hull(apex: DVec3, [a, b, c]: [DVec3; 3]) -> Option<OrientedPlanes> {
        let planes = OrientedPlanes::from_apex(apex, [a, b, c]);
        let (height, bound) = planes.height;
        match Sign::certain(height, bound)? {
            Sign::Positive => Some(planes),
            _ => Some(OrientedPlanes::from_apex(apex, [a, c, b])),
        }
    }

    /// A triangle of a hull seen by a light, as [`of_hull`](OrientedPlanes::of_hull) from an apex.
    pub fn of_hull_for(space: &LightSpace, [a, b, c]: [DVec3; 3]) -> Option<OrientedPlanes> {
        match space.light() {
            LightPosition::At(light) => OrientedPlanes::of_hull(light.as_dvec3(), [a, b, c]),
            LightPosition::Towards(direction) => {
                let direction = direction.as_dvec3();
                let (away, bound) = Plane::through(b - a, c - a).dot(-direction, DVec3::ZERO);
                match Sign::certain(away, bound)? {
                    Sign::Positive => Some(OrientedPlanes::new(space, [a, b, c])),
                    _ => Some(OrientedPlanes::new(space, [a, c, b])),
                }
            }
        }
    }

    /// Seen by a light.
    pub fn new(space: &LightSpace, corners: [DVec3; 3]) -> OrientedPlanes {
        let origin = space.origin().as_dvec3();
        match space.light() {
            LightPosition::At(_) => OrientedPlanes::from_apex(origin, corners),
            LightPosition::Towards(direction) => {
                let [a, b, c] = corners;
                let u = corners.map(|p| p - origin);
                let own = Plane::through(b - a, c - a);
                let edges = [b - a, c - b, a - c].map(|edge| Plane::through(edge, direction.as_dvec3()));
                OrientedPlanes {
                    corners: u,
                    edges,
                    offsets: [0, 1, 2].map(|i| edges[i].dot(u[i], rounded_once(u[i]))),
                    own,
                    height: own.dot(u[0], rounded_once(u[0])),
                }
            }
        }
    }
}

/// More than one rounding of each coordinate.
#[inline(always)]
fn rounded_once(v: DVec3) -> DVec3 {
    v.abs() * (2.0 * ROUNDOFF)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn coordinates() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(prop_oneof![-1.0f32..1.0, (-3i8..4).prop_map(f32::from)]).prop_map(Vec3::from)
    }

    proptest! {
        /// A point light very far away in a direction is on the same side as one infinitely far away,
        /// unless the latter lies in the plane.
        #[test]
        fn a_direction_is_the_limit_of_points(direction in coordinates(), corners in prop::array::uniform3(coordinates())) {
            let sign = orientation(LightPosition::Towards(direction), corners);
            prop_assume!(sign != Sign::Zero);
            prop_assert_eq!(orientation(direction * 2.0f32.powi(100), corners), sign);
        }
    }

    #[test]
    fn a_direction_in_the_plane_has_no_side() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let towards = |z: f32| orientation(LightPosition::Towards(Vec3::new(0.3, -0.7, z)), corners);
        assert_eq!(
            [towards(0.0), towards(1e-40), towards(-1e-40)],
            [Sign::Zero, Sign::Negative, Sign::Positive]
        );
    }

    #[test]
    fn planes_that_f64_knows_less_well_than_f32_needs_are_not_numbers() {
        // 8 roundoffs of 2^23 are 2^-27.
        let most = 8_388_608.0;
        let scaled = |largest: f64, size: f64| {
            let normal = DVec3::new(0.0, -largest, 0.5 * largest);
            Plane { normal, size: DVec3::splat(size) }.scaled_to_f32()
        };
        assert_eq!(scaled(4.0, 4.0 * most), [0.0, -1.0, 0.5]);
        assert!(scaled(4.0, f64::next_up(4.0 * most)).iter().all(|x| x.is_nan()));
        assert!(scaled(f64::INFINITY, 1.0).iter().all(|x| x.is_nan()));
    }

    #[test]
    fn offsets_are_known_within_their_share_and_the_allowance_or_are_not_numbers() {
        let plane = Plane { normal: DVec3::new(0.0, 4.0, -2.0), size: DVec3::splat(4.0) };
        let value = |bound: f64| plane.scaled_value((-8.0, bound), 0.25);
        // 8 / 2^27 and 0.25 * 4.
        let most = 8.0 / 134_217_728.0 + 1.0;
        assert_eq!(value(most), -2.0);
        assert!(value(f64::next_up(most)).is_nan());
        assert!(plane.scaled_value((1e300, 0.0), 0.25).is_nan(), "beyond f32");
    }

    #[test]
    fn the_bound_of_a_scalar_product_is_what_is_derived() {
        let plane = Plane { normal: DVec3::new(0.0, 2.0, 0.0), size: DVec3::new(0.0, 3.0, 0.0) };
        let (value, bound) = plane.dot(DVec3::Y * -5.0, DVec3::Y * (7.0 * ROUNDOFF));
        assert_eq!(value, -10.0);
        // 3 (12 * 5 + 2 * 7) roundoffs.
        assert!((bound / (222.0 * ROUNDOFF) - 1.0).abs() < 1e-9, "{bound:e}");
        // The bound itself is rounded, and a little larger for that.
        assert!(bound > 222.0 * ROUNDOFF);
    }

    #[test]
    fn triangles_of_hulls_are_turned_towards_who_sees_them() {
        let [a, b, c] =
            [DVec3::new(-5.0, -5.0, 0.0), DVec3::new(-4.0, -5.0, 0.0), DVec3::new(-5.0, -4.0, 0.0)];
        let bounds = (Vec3::splat(-9.0), Vec3::splat(9.0));
        for above in [1.0, -1.0] {
            let lights = [LightPosition::At(Vec3::Z * above), LightPosition::Towards(Vec3::Z * above)];
            for light in lights {
                let space = LightSpace::new(light, bounds);
                for corners in [[a, b, c], [a, c, b]] {
                    let planes =
                        OrientedPlanes::of_hull_for(&space, corners).expect("it is seen from the front");
                    // Away from the light, and with the edges the same way round.
                    assert_eq!(planes.own.normal, DVec3::Z * -f64::from(above));
                    let inside = (a + b + c) / 3.0 - space.origin().as_dvec3();
                    let value = |i: usize| planes.edges[i].normal.dot(inside) - planes.offsets[i].0;
                    assert!((0..3).all(|i| value(i) > 0.0));
                }
            }
        }
        let edge_on =
            |light| OrientedPlanes::of_hull_for(&LightSpace::new(light, bounds), [a, b, c]).is_none();
        assert!(edge_on(LightPosition::At(Vec3::X)) && edge_on(LightPosition::Towards(Vec3::Y)));
    }
}
