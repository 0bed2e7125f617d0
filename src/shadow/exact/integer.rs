//! Exact geometry in big integers: all coordinates of a problem times one power of two.

use super::point::{RelativePoint, scale_of};
use super::surd::Surd;
use crate::geometry::{ExactPosition, LightPosition};
use dashu_int::IBig;
use glam::Vec3;

/// A vector of integers.
pub type IntegerVector = [IBig; 3];

/// A point x / w or, where w is 0, a direction x, as (x, w).
pub type Homogeneous = [IBig; 4];

/// A scale that makes integers of some floats: multiply by 2^-exponent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scale {
    exponent: i32,
}

/// Sign, mantissa and exponent of a finite f32: (-1)^sign mantissa 2^exponent, the mantissa odd or zero.
pub fn decode(value: f32) -> (i64, i32) {
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

    /// The power of two that a unit is.
    pub fn exponent(self) -> i32 {
        self.exponent
    }

    /// A length in this scale.
    pub fn number(self, value: f32) -> IBig {
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

/// A light in units of a scale.
#[derive(Debug, Clone)]
pub enum IntegerLight {
    /// At a point.
    At(IntegerVector),
    /// Infinitely far away in a direction; its scale is its own, since only signs with it matter.
    Towards(IntegerVector),
}

impl IntegerLight {
    /// A light, at a point in the given scale.
    pub fn new(light: LightPosition, scale: Scale) -> IntegerLight {
        match light {
            LightPosition::At(point) => IntegerLight::At(scale.point(point)),
            LightPosition::Towards(direction) => {
                IntegerLight::Towards(Scale::of([direction]).point(direction))
            }
        }
    }

    /// The light relative to its origin, in homogeneous coordinates.
    pub fn homogeneous(&self) -> Homogeneous {
        match self {
            IntegerLight::At(_) => [IBig::ZERO, IBig::ZERO, IBig::ZERO, IBig::ONE],
            IntegerLight::Towards([x, y, z]) => [x.clone(), y.clone(), z.clone(), IBig::ZERO],
        }
    }

    /// What points are taken relative to: the light, or the origin.
    pub fn origin(&self) -> IntegerVector {
        match self {
            IntegerLight::At(point) => point.clone(),
            IntegerLight::Towards(_) => [IBig::ZERO, IBig::ZERO, IBig::ZERO],
        }
    }
}

/// The scale that a light's position asks for.
pub fn scale_of_light(light: LightPosition) -> Scale {
    match light {
        LightPosition::At(point) => Scale::of([point]),
        LightPosition::Towards(_) => Scale::of([]),
    }
}

/// The planes of a triangle as a light sees it, turned so that the light is on the negative side of the
/// triangle's own.
#[derive(Debug, Clone)]
pub struct LitTriangle {
    /// Normals of the planes through the light and an edge, positive inside, and their values on the edge.
    pub edges: [(IntegerVector, IBig); 3],
    /// The triangle's own plane, and its value there.
    pub own: (IntegerVector, IBig),
}

impl LitTriangle {
    /// `None` if the triangle's plane holds the light.
    pub fn new(light: &IntegerLight, corners: [Vec3; 3], scale: Scale) -> Option<LitTriangle> {
        let from = light.origin();
        let u = corners.map(|c| minus(&scale.point(c), &from));
        let normal = cross(&minus(&u[1], &u[0]), &minus(&u[2], &u[0]));
        let height = dot(&normal, &u[0]);
        // For a light at a point the first terms alone are left: edge planes hold the origin.
        let (away, edges) = match light {
            IntegerLight::At(_) => {
                let edge = |i: usize, j: usize| (cross(&u[i], &u[j]), IBig::ZERO);
                (sign(&height), [edge(0, 1), edge(1, 2), edge(2, 0)])
            }
            IntegerLight::Towards(direction) => {
                let edge = |i: usize, j: usize| {
                    let normal = cross(&minus(&u[j], &u[i]), direction);
                    let value = dot(&normal, &u[i]);
                    (normal, value)
                };
                (-sign(&dot(&normal, direction)), [edge(0, 1), edge(1, 2), edge(2, 0)])
            }
        };
        let turned = |(normal, value): (IntegerVector, IBig)| (normal.map(|x| -x), -value);
        match away {
            0 => None,
            1 => Some(LitTriangle { edges, own: (normal, height) }),
            _ => Some(LitTriangle { edges: edges.map(turned), own: turned((normal, height)) }),
        }
    }
}

/// What a plane, given by normal and value, says of a point: 0 on it.
pub fn side_value((normal, value): &(IntegerVector, IBig), point: &RelativePoint) -> Surd {
    let mut side = point.dot(normal);
    side.rational -= value * &point.w;
    side
}

/// The side of a plane that a point is on: -1, 0 or 1.
pub fn side(plane: &(IntegerVector, IBig), point: &RelativePoint) -> i32 {
    point.field.sign(&side_value(plane, point))
}

/// Whether a float is at most numerator / denominator, exactly; the denominator is positive. Infinities are
/// beyond every quotient.
pub fn at_most(value: f32, numerator: &IBig, denominator: &IBig) -> bool {
    if value.is_infinite() {
        return value < 0.0;
    }
    let (mantissa, exponent) = decode(value);
    let product = denominator * IBig::from(mantissa);
    if exponent >= 0 {
        product << exponent as usize <= *numerator
    } else {
        product <= numerator << (-exponent) as usize
    }
}

/// How a closed primitive lies to the open segment between a light and a point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Meeting {
    /// No common point that counts.
    Misses,
    /// The segment passes through the primitive, off its boundary.
    Interior,
    /// The segment passes through the boundary, or touches a curved surface. Of a triangle these are the planes of
    /// the edges there, oriented inwards; of a curved surface none.
    Boundary(Vec<IntegerVector>),
    /// The point itself lies on the primitive, and the segment does not meet it otherwise.
    EndsOn,
}

/// Meets a triangle exactly, by the definition of TRUTH, "Occluded".
pub fn meet(light: LightPosition, corners: [Vec3; 3], position: &ExactPosition) -> Meeting {
    let scale = scale_of(position, light).finer(Scale::of(corners));
    let light = IntegerLight::new(light, scale);
    let point = RelativePoint::new(position, &light, scale);
    let Some(triangle) = LitTriangle::new(&light, corners, scale) else { return Meeting::Misses };
    let mut boundary = Vec::new();
    for edge in triangle.edges {
        match side(&edge, &point) {
            -1 => return Meeting::Misses,
            0 => boundary.push(edge.0),
            _ => {}
        }
    }
    match side(&triangle.own, &point) {
        1 if boundary.is_empty() => Meeting::Interior,
        1 => Meeting::Boundary(boundary),
        0 => Meeting::EndsOn,
        _ => Meeting::Misses,
    }
}

/// Whether the segment between a light and a point passes through a triangle once the point is moved to
/// P + (e, e^2, e^3) with an e > 0 too small to matter otherwise (TRUTH, "Transparent"): of the triangles that
/// share an edge the segment then passes through as many as if it missed the edge.
pub fn crosses(light: LightPosition, corners: [Vec3; 3], position: &ExactPosition) -> bool {
    let scale = scale_of(position, light).finer(Scale::of(corners));
    let light = IntegerLight::new(light, scale);
    let point = RelativePoint::new(position, &light, scale);
    LitTriangle::new(&light, corners, scale).is_some_and(|triangle| triangle.is_crossed(&point))
}

impl LitTriangle {
    /// [`crosses`], for a triangle whose plane does not hold the light.
    pub fn is_crossed(&self, point: &RelativePoint) -> bool {
        let is_inside = |edge: &(IntegerVector, IBig)| match side(edge, point) {
            0 => edge.0.iter().map(sign).find(|&sign| sign != 0) == Some(1),
            side => side > 0,
        };
        side(&self.own, point) > 0 && self.edges.iter().all(is_inside)
    }
}
