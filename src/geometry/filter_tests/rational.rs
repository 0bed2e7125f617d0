//! The reference: rational numbers, and the definitions of TRUTH written out with them. Shares nothing with what
//! it judges.

use crate::geometry::{ExactPosition, LightPosition, Sign};
use dashu_int::{IBig, UBig};
use dashu_ratio::Relaxed;
use glam::Vec3;

pub type Rational = Relaxed;
pub type Vector = [Rational; 3];

/// A finite float.
pub fn rational(value: f64) -> Rational {
    let bits = value.to_bits();
    let (exponent, fraction) = ((bits >> 52 & 0x7ff) as i64, bits & ((1 << 52) - 1));
    assert!(exponent < 0x7ff, "{value}");
    let (magnitude, exponent) =
        if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    let whole = if value.is_sign_negative() { -IBig::from(magnitude) } else { IBig::from(magnitude) };
    match usize::try_from(exponent) {
        Ok(up) => Rational::from(whole << up),
        Err(_) => Rational::from_parts(whole, UBig::ONE << (-exponent) as usize),
    }
}

pub fn vector(v: Vec3) -> Vector {
    v.to_array().map(|x| rational(f64::from(x)))
}

pub fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

pub fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

pub fn dot(a: &Vector, b: &Vector) -> Rational {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// a + t b
pub fn along(a: &Vector, b: &Vector, t: &Rational) -> Vector {
    [0, 1, 2].map(|i| &a[i] + &b[i] * t)
}

pub fn sign(value: &Rational) -> Sign {
    match value.partial_cmp(&Rational::ZERO).expect("an order") {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

pub fn absolute(value: Rational) -> Rational {
    if sign(&value) == Sign::Negative { -value } else { value }
}

/// Whether a float is within a bound of an exact number; a bound that is not finite says nothing.
pub fn is_within(value: f64, bound: f64, exact: &Rational) -> bool {
    assert!(!bound.is_nan());
    !bound.is_finite() || value.is_finite() && absolute(rational(value) - exact) <= rational(bound)
}

/// Whether a float is an exact number correctly rounded, ties to even.
pub fn is_rounded(value: f64, exact: &Rational) -> bool {
    let half = Rational::from_parts(IBig::ONE, UBig::from(2_u8));
    let middle = |other: f64| (rational(value) + rational(other)) * &half;
    let even = value.to_bits() & 1 == 0;
    let (low, high) = (middle(value.next_down()), middle(value.next_up()));
    if even { &low <= exact && exact <= &high } else { &low < exact && exact < &high }
}

/// Where a point is; `None` if its ray is parallel to its plane.
pub fn point(position: &ExactPosition) -> Option<Vector> {
    match position {
        ExactPosition::Bare(p) => Some(vector(*p)),
        ExactPosition::OnRay { origin, direction, triangle } => {
            let (o, d) = (vector(*origin), vector(*direction));
            Some(along(&o, &d, &plane_parameter(&o, &d, triangle)?))
        }
        ExactPosition::OnCurved { .. } => panic!("no rational point"),
    }
}

fn normal(triangle: &[Vec3; 3]) -> Vector {
    let [a, b, c] = triangle.map(vector);
    cross(&minus(&b, &a), &minus(&c, &a))
}

/// Where a line meets the plane of a triangle.
pub fn plane_parameter(origin: &Vector, direction: &Vector, triangle: &[Vec3; 3]) -> Option<Rational> {
    let n = normal(triangle);
    let slope = dot(&n, direction);
    (sign(&slope) != Sign::Zero).then(|| dot(&n, &minus(&vector(triangle[0]), origin)) / slope)
}

/// The side of a plane through the light and an edge that a point is on.
pub fn edge(light: LightPosition, a: Vec3, b: Vec3, p: &Vector) -> Rational {
    let (a, b) = (vector(a), vector(b));
    match light {
        LightPosition::At(light) => {
            let l = vector(light);
            dot(&cross(&minus(&a, &l), &minus(&b, &l)), &minus(p, &l))
        }
        LightPosition::Towards(direction) => dot(&cross(&minus(&b, &a), &vector(direction)), &minus(p, &a)),
    }
}

/// The side of a triangle's plane that a point is on, in the order of its corners.
pub fn height(triangle: &[Vec3; 3], p: &Vector) -> Rational {
    dot(&normal(triangle), &minus(p, &vector(triangle[0])))
}

/// TRUTH, "Occluded": the light and the point are strictly on different sides of the triangle's plane, and no two
/// edges have them on strictly different sides.
pub fn blocks(light: LightPosition, triangle: &[Vec3; 3], p: &Vector) -> bool {
    let of_light = match light {
        LightPosition::At(light) => height(triangle, &vector(light)),
        LightPosition::Towards(direction) => dot(&normal(triangle), &vector(direction)),
    };
    let [a, b, c] = *triangle;
    let edges = [(a, b), (b, c), (c, a)].map(|(a, b)| sign(&edge(light, a, b, p)));
    sign(&of_light) * sign(&height(triangle, p)) == Sign::Negative
        && !(edges.contains(&Sign::Negative) && edges.contains(&Sign::Positive))
}
