//! Exact sums and products of floats: expansions after Shewchuk, "Adaptive Precision Floating-Point
//! Arithmetic and Fast Robust Geometric Predicates", 1997.
//!
//! An expansion is a sum of f64 components that do not overlap, smallest first, so that the last one
//! carries the sign. A polynomial of degree n in f32 inputs is a multiple of 2^(-149 n) and below
//! 2^(128 n) times its number of terms: up to degree 7 no component can overflow, and every rounding error
//! is itself a float, subnormals included. The floating-point mode must be the default one (round to
//! nearest, subnormals kept).

use super::Sign;
use std::ops::{Add, Mul, Neg, Sub};

/// An exact real number as a sum of non-overlapping f64 components in order of increasing magnitude.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion(Vec<f64>);

/// a + b as its rounding and the error of that rounding.
pub(crate) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_virtual = sum - a;
    let a_virtual = sum - b_virtual;
    (sum, (a - a_virtual) + (b - b_virtual))
}

/// As [`two_sum`], for |a| >= |b|.
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// A float as two halves of at most 26 bits (Veltkamp, Dekker).
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let c = SPLITTER * a;
    let high = c - (c - a);
    (high, a - high)
}

/// a * b as its rounding and the error of that rounding; exact if neither overflows nor underflows.
pub(crate) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    (product, al * bl - (((product - ah * bh) - al * bh) - ah * bl))
}

impl Expansion {
    /// Zero.
    pub fn zero() -> Expansion {
        Expansion(Vec::new())
    }

    /// The exact difference of two f32 numbers.
    pub fn difference(a: f32, b: f32) -> Expansion {
        let (high, low) = two_sum(f64::from(a), -f64::from(b));
        Expansion::from_two(high, low)
    }

    fn from_two(high: f64, low: f64) -> Expansion {
        Expansion([low, high].into_iter().filter(|&c| c != 0.0).collect())
    }

    /// The exact sign.
    pub fn sign(&self) -> Sign {
        Sign::of(self.0.last().copied().unwrap_or(0.0))
    }

    /// The components, smallest first; none is zero.
    pub fn components(&self) -> &[f64] {
        &self.0
    }

    /// This number times one float (Shewchuk's SCALE-EXPANSION).
    fn scale(&self, factor: f64) -> Expansion {
        let mut out = Vec::with_capacity(2 * self.0.len());
        let Some((&first, rest)) = self.0.split_first() else { return Expansion(out) };
        let push = |value: f64, out: &mut Vec<f64>| {
            if value != 0.0 {
                out.push(value);
            }
        };
        let (mut carry, low) = two_product(first, factor);
        push(low, &mut out);
        for &component in rest {
            let (high, low) = two_product(component, factor);
            let (sum, error) = two_sum(carry, low);
            push(error, &mut out);
            let (next, error) = fast_two_sum(high, sum);
            push(error, &mut out);
            carry = next;
        }
        push(carry, &mut out);
        Expansion(out)
    }
}

impl From<f32> for Expansion {
    fn from(value: f32) -> Expansion {
        Expansion::from_two(f64::from(value), 0.0)
    }
}

impl Neg for &Expansion {
    type Output = Expansion;

    fn neg(self) -> Expansion {
        Expansion(self.0.iter().map(|c| -c).collect())
    }
}

impl Add for &Expansion {
    type Output = Expansion;

    fn add(self, other: &Expansion) -> Expansion {
        self.plus(other)
    }
}

impl Expansion {
    /// Components are added one by one (Shewchuk's GROW-EXPANSION), which holds for any non-overlapping
    /// expansions.
    fn plus(&self, other: &Expansion) -> Expansion {
        let mut sum = self.0.clone();
        for &component in &other.0 {
            let mut carry = component;
            let mut kept = 0;
            for i in 0..sum.len() {
                let (high, low) = two_sum(carry, sum[i]);
                carry = high;
                if low != 0.0 {
                    sum[kept] = low;
                    kept += 1;
                }
            }
            sum.truncate(kept);
            if carry != 0.0 {
                sum.push(carry);
            }
        }
        Expansion(sum)
    }
}

impl Sub for &Expansion {
    type Output = Expansion;

    fn sub(self, other: &Expansion) -> Expansion {
        self + &-other
    }
}

impl Mul for &Expansion {
    type Output = Expansion;

    fn mul(self, other: &Expansion) -> Expansion {
        let (few, many) = if self.0.len() < other.0.len() { (self, other) } else { (other, self) };
        let partial_products = few.0.iter().map(|&c| many.scale(c));
        partial_products.fold(Expansion::zero(), |sum, product| sum.plus(&product))
    }
}

/// A vector of exact numbers.
pub type ExactVector = [Expansion; 3];

/// The exact scalar product.
pub fn dot(a: &ExactVector, b: &ExactVector) -> Expansion {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

/// The exact vector product.
pub fn cross(a: &ExactVector, b: &ExactVector) -> ExactVector {
    let minor = |i: usize, j: usize| &(&a[i] * &b[j]) - &(&a[j] * &b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The exact difference of two points.
pub fn difference(a: glam::Vec3, b: glam::Vec3) -> ExactVector {
    [Expansion::difference(a.x, b.x), Expansion::difference(a.y, b.y), Expansion::difference(a.z, b.z)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rounding::tests_support::integer;
    use proptest::prelude::*;

    fn any_f32() -> impl Strategy<Value = f32> {
        // Any finite bit pattern: all exponents, subnormals, both zeros.
        any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |x| x.is_finite())
    }

    proptest! {
        #[test]
        fn degree_six_polynomials_equal_big_integers(x in prop::array::uniform6(any_f32()), y in prop::array::uniform6(any_f32())) {
            // x0 x1 x2 x3 x4 x5 - y0 y1 y2 y3 y4 y5 + x0 y1 x2 y3 x4 y5
            let product = |v: &[f32]| v.iter().skip(1).fold(Expansion::from(v[0]), |p, &f| &p * &Expansion::from(f));
            let mixed = [x[0], y[1], x[2], y[3], x[4], y[5]];
            let ours = &(&product(&x) - &product(&y)) + &product(&mixed);
            let exact_product = |v: &[f32]| v.iter().fold(dashu_int::IBig::from(1), |p, &f| p * integer(f64::from(f)));
            let exact = exact_product(&x) - exact_product(&y) + exact_product(&mixed);
            // Components are multiples of 2^-1074 and `integer` counts in those, the product of six in 2^-6444.
            let shift = 5 * 1074;
            let sum = ours.components().iter().fold(dashu_int::IBig::from(0), |s, &c| s + (integer(c) << shift));
            prop_assert_eq!(sum, exact);
        }

        #[test]
        fn cancelling_sums_are_exact(a in any_f32(), b in any_f32(), c in any_f32()) {
            let (ea, eb, ec) = (Expansion::from(a), Expansion::from(b), Expansion::from(c));
            let left = &(&(&ea + &eb) * &ec) - &(&ea * &ec);
            let right = &eb * &ec;
            prop_assert_eq!((&left - &right).sign(), Sign::Zero);
            prop_assert_eq!(left.sign(), right.sign());
        }
    }
}
