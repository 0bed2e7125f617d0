//! Exact geometry in big integers: all coordinates of a problem times one power of two.

use crate::geometry::ExactPosition;
use dashu_int::IBig;
use glam::Vec3;

/// A vector of integers.
pub type IntegerVector = [IBig; 3];

/// A scale that makes integers of some floats: multiply by 2^-exponent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scale {
    exponent: i32,
}

/// Sign, mantissa and exponent of a finite f32: (-1)^sign mantissa 2^exponent, the mantissa odd or zero.
fn decode(value: f32) -> (i64, i32) {
    let bits = value.to_bits();
    let biased = (bits >> 23 & 0xff) as i32;
    let fraction = i64::from(bits & 0x007f_ffff);
    let (mantissa, exponent) =
        if biased == 0 { (fraction, -149) } else { (fraction | 1 << 23, biased - 150) };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    let mantissa = mantissa >> zeros;
    (if bits >> 31 == 1 { -mantissa } else { mantissa }, exponent + zeros as i32)
}

impl Scale {
    /// The coarsest scale that all coordinates of some points are integers in.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Scale {
        let coordinates = points.into_iter().flat_map(|p| p.to_array());
        let exponent = coordinates.map(decode).filter(|d| d.0 != 0).map(|d| d.1).min().unwrap_or(0);
        Scale { exponent }
    }

    /// The finer of two scales.
    pub fn finer(self, other: Scale) -> Scale {
        Scale { exponent: self.exponent.min(other.exponent) }
    }

    fn number(self, value: f32) -> IBig {
        let (mantissa, exponent) = decode(value);
        if mantissa == 0 { IBig::ZERO } else { IBig::from(mantissa) << (exponent - self.exponent) as usize }
    }

    /// A point in this scale.
    pub fn point(self, p: Vec3) -> IntegerVector {
        p.to_array().map(|x| self.number(x))
    }
}

/// a - b.
pub fn minus(a: &IntegerVector, b: &IntegerVector) -> IntegerVector {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// Scalar product.
pub fn dot(a: &IntegerVector, b: &IntegerVector) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Vector product.
pub fn cross(a: &IntegerVector, b: &IntegerVector) -> IntegerVector {
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// Sign as -1, 0 or 1.
pub fn sign(value: &IBig) -> i32 {
    match value.cmp(&IBig::ZERO) {
        std::cmp::Ordering::Less => -1,
        std::cmp::Ordering::Equal => 0,
        std::cmp::Ordering::Greater => 1,
    }
}

/// An exact point relative to a light: xyz / w with w > 0, in units of a scale.
#[derive(Debug, Clone)]
pub struct RelativePoint {
    /// Numerators.
    pub xyz: IntegerVector,
    /// Denominator.
    pub w: IBig,
}

impl RelativePoint {
    /// The position minus the light.
    pub fn new(position: &ExactPosition, light: Vec3, scale: Scale) -> RelativePoint {
        let light = scale.point(light);
        match *position {
            ExactPosition::Bare(p) => RelativePoint { xyz: minus(&scale.point(p), &light), w: IBig::ONE },
            ExactPosition::OnRay { origin, direction, triangle } => {
                let [a, b, c] = triangle.map(|p| scale.point(p));
                let (o, d) = (scale.point(origin), scale.point(direction));
                let normal = cross(&minus(&b, &a), &minus(&c, &a));
                let (t, w) = (dot(&normal, &minus(&a, &o)), dot(&normal, &d));
                let start = minus(&o, &light);
                let xyz = [0, 1, 2].map(|i| &start[i] * &w + &t * &d[i]);
                if sign(&w) < 0 {
                    RelativePoint { xyz: xyz.map(|x| -x), w: -w }
                } else {
                    RelativePoint { xyz, w }
                }
            }
        }
    }
}

/// The scale of a light and everything that a position is made of.
pub fn scale_of(position: &ExactPosition, light: Vec3) -> Scale {
    let own = match *position {
        ExactPosition::Bare(p) => Scale::of([p]),
        ExactPosition::OnRay { origin, direction, triangle } => {
            Scale::of([origin, direction].into_iter().chain(triangle))
        }
    };
    own.finer(Scale::of([light]))
}

/// How a closed triangle lies to the open segment between a light and a point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Meeting {
    /// No common point that counts.
    Misses,
    /// The segment passes through the triangle's interior.
    Interior,
    /// The segment passes through the triangle's boundary: planes of the edges there, oriented inwards.
    Boundary(Vec<IntegerVector>),
    /// The point itself lies on the triangle.
    EndsOn,
}

/// Meets a triangle exactly, by the definition of TRUTH, "Occluded".
pub fn meet(light: Vec3, corners: [Vec3; 3], position: &ExactPosition) -> Meeting {
    let scale = scale_of(position, light).finer(Scale::of(corners));
    let point = RelativePoint::new(position, light, scale);
    let origin = scale.point(light);
    let u = corners.map(|c| minus(&scale.point(c), &origin));
    let volume = sign(&dot(&u[0], &cross(&u[1], &u[2])));
    if volume == 0 {
        return Meeting::Misses;
    }
    let mut boundary = Vec::new();
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let edge = cross(&u[i], &u[j]);
        let edge = if volume < 0 { edge.map(|x| -x) } else { edge };
        match sign(&dot(&edge, &point.xyz)) {
            -1 => return Meeting::Misses,
            0 => boundary.push(edge),
            _ => {}
        }
    }
    // The triangle's plane: positive beyond it, seen from the light.
    let normal = cross(&minus(&u[1], &u[0]), &minus(&u[2], &u[0]));
    let height = dot(&normal, &u[0]);
    let depth = dot(&normal, &point.xyz) - height * &point.w;
    match sign(&depth) * volume {
        1 if boundary.is_empty() => Meeting::Interior,
        1 => Meeting::Boundary(boundary),
        0 => Meeting::EndsOn,
        _ => Meeting::Misses,
    }
}

/// Whether two triangles lie in one plane, exactly.
pub fn is_coplanar(a: [Vec3; 3], b: [Vec3; 3]) -> bool {
    let scale = Scale::of(a.into_iter().chain(b));
    let [o, p, q] = a.map(|c| scale.point(c));
    let normal = cross(&minus(&p, &o), &minus(&q, &o));
    b.iter().all(|&c| sign(&dot(&normal, &minus(&scale.point(c), &o))) == 0)
}
