//! A triangle as one light sees it: four planes in 64 bytes, and a float filter with a proven bound.
//!
//! All segments of one light share an end, so a triangle is three planes through the light and an edge,
//! and its own plane. With coordinates relative to the light and the corners u0, u1, u2 ordered so that
//! h = det(u0, u1, u2) > 0, a point p is blocked exactly if (ui x uj) . p >= 0 for the three edges and
//! N . p > h for N = (u1 - u0) x (u2 - u0). (TRUTH: strictly opposite depth signs, no two edge signs
//! opposite. With h > 0 all edge signs negative would put p on the light's side of the plane.)

use super::{ROUNDOFF, Sign};
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

/// Four planes relative to the light, one a lane: three edges (offset 0) and the triangle's own plane.
/// Every plane is scaled so that its largest coefficient is 1.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct LightTriangle {
    pub(crate) x: [f32; 4],
    pub(crate) y: [f32; 4],
    pub(crate) z: [f32; 4],
    pub(crate) offset: [f32; 4],
}

/// A point relative to the light in 16 bytes: coordinates rounded to f32 and the error bound of
/// [`LightTriangle::classify`].
///
/// The bound, with u = 2^-24 and |p| the sum of absolute coordinates. Coefficients are at most 1 and wrong
/// by at most 1.25 u (one rounding to f32 and 2^-27 from f64, checked when they are made); p is wrong by
/// u |p| and by what its f64 position is wrong; three products add u |p|, two sums 2 u |p|, and subtracting
/// the offset another u (|p| + h). For edges h is 0: less than 7 u |p| in all. For the own plane h itself is
/// wrong by 1.25 u h; a bound of 16 u |p| covers that where h <= 3 |p|, and where h is larger N . p - h is
/// below -2 |p|, so that its computed sign is right by far. Underflow of a product or of a coordinate adds
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
    pub fn new(light: Vec3, rounded: DVec3) -> LightPoint {
        let p = rounded - light.as_dvec3();
        let size = p.x.abs() + p.y.abs() + p.z.abs();
        // Half an ulp of the position and half an ulp of the difference, generously.
        let position_error = 4.0 * ROUNDOFF * (rounded.x.abs() + rounded.y.abs() + rounded.z.abs() + size);
        let bound = (size * (1.0 / 1_048_576.0) + position_error) * 1.000_001 + 1e-36;
        let slack = if size < f64::from(f32::MAX) * 0.25 { bound } else { f64::INFINITY };
        LightPoint { x: p.x as f32, y: p.y as f32, z: p.z as f32, slack: slack as f32 }
    }
}

impl LightTriangle {
    /// The planes of a triangle, or `None` if its plane holds the light (such triangles never block).
    pub fn new(light: Vec3, corners: [Vec3; 3]) -> Option<LightTriangle> {
        let [a, b, c] = match orientation(light, corners) {
            Sign::Zero => return None,
            Sign::Positive => corners,
            Sign::Negative => [corners[0], corners[2], corners[1]],
        };
        let planes = OrientedPlanes::new(light.as_dvec3(), [a, b, c].map(Vec3::as_dvec3));
        let mut record = LightTriangle { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4], offset: [0.0; 4] };
        for (lane, plane) in planes.edges.iter().chain([&planes.own]).enumerate() {
            let [x, y, z] = plane.scaled_to_f32();
            (record.x[lane], record.y[lane], record.z[lane]) = (x, y, z);
        }
        record.offset[3] = planes.scaled_height();
        Some(record)
    }

    /// The four plane values at a point, in one fixed order of operations.
    #[inline(always)]
    fn values(&self, p: &LightPoint) -> [f32; 4] {
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
}

/// The exact sign of det(a - light, b - light, c - light).
pub fn orientation(light: Vec3, [a, b, c]: [Vec3; 3]) -> Sign {
    let coord = |p: Vec3| robust::Coord3D { x: f64::from(p.x), y: f64::from(p.y), z: f64::from(p.z) };
    Sign::of(robust::orient3d(coord(a), coord(b), coord(c), coord(light)))
}

/// A plane normal in f64, and for each component the sum of the absolute values of its two terms.
///
/// A component is p q - r s with each factor a difference rounded once: it is wrong by at most 5 roundoffs
/// of its `size`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    pub normal: DVec3,
    pub size: DVec3,
}

impl Plane {
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
    fn scaled_to_f32(&self) -> [f32; 3] {
        let largest = self.normal.abs().max_element();
        let error = 8.0 * ROUNDOFF * self.size.max_element();
        if error <= largest * (1.0 / 134_217_728.0) && largest.is_finite() {
            (self.normal / largest).as_vec3().to_array()
        } else {
            [f32::NAN; 3]
        }
    }

    /// The scalar product with a vector whose components are wrong by at most `error`, and its bound.
    ///
    /// Per component: 5 roundoffs of `size` from the normal, 1 from the product, 2 from the sums, and the
    /// vector's own error; 12 roundoffs of size * |v| and twice size * error are above that.
    pub fn dot(&self, v: DVec3, error: DVec3) -> (f64, f64) {
        let n = self.normal;
        let value = (n.x * v.x + n.y * v.y) + n.z * v.z;
        let bound = self.size.dot(v.abs() * (12.0 * ROUNDOFF) + error * 2.0);
        (value, bound * (1.0 + 8.0 * ROUNDOFF) + 1e-300)
    }
}

/// The planes of a triangle with det(u0, u1, u2) > 0 relative to an apex (a light or a camera), in f64.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OrientedPlanes {
    /// Corners relative to the apex, each coordinate rounded once.
    pub corners: [DVec3; 3],
    /// Planes through the apex and edges 01, 12, 20, positive inside.
    pub edges: [Plane; 3],
    /// The triangle's own plane, with its normal pointing away from the apex.
    pub own: Plane,
    /// own . u0 > 0, and the bound of its error.
    pub height: (f64, f64),
}

impl OrientedPlanes {
    pub fn new(apex: DVec3, corners: [DVec3; 3]) -> OrientedPlanes {
        let [a, b, c] = corners;
        let u = corners.map(|p| p - apex);
        let own = Plane::through(b - a, c - a);
        OrientedPlanes {
            corners: u,
            // u x (v - u) = u x v, and keeps the digits of small triangles far away.
            edges: [Plane::through(u[0], b - a), Plane::through(u[1], c - b), Plane::through(u[2], a - c)],
            own,
            height: own.dot(u[0], u[0].abs() * (2.0 * ROUNDOFF)),
        }
    }

    fn scaled_height(&self) -> f32 {
        let (value, bound) = self.height;
        let scaled = (value / self.own.normal.abs().max_element()) as f32;
        if bound <= value * (1.0 / 134_217_728.0) && scaled.is_finite() { scaled } else { f32::NAN }
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
        assert!(LightTriangle::new(Vec3::new(7.0, -3.0, 0.0), corners).is_none());
        assert!(
            LightTriangle::new(Vec3::new(7.0, -3.0, f32::from_bits(1)), [Vec3::X, Vec3::Y, -Vec3::X])
                .is_some()
        );
    }
}
