//! The exact coordinates of points: expansions where those suffice, surds on curved surfaces.

use super::Sign;
use super::curved::root;
use super::dyadic::Dyadic;
use super::expansion::Expansion;
use super::number::Number;
use super::surd::Surd;
use std::ops::{Add, Mul, Neg, Sub};

/// An exact number.
#[derive(Debug, Clone)]
pub enum ExactNumber {
    /// Of low degree in f32 numbers.
    Expansion(Expansion),
    /// Of any degree, perhaps with a square root.
    Surd(Surd),
}

impl ExactNumber {
    /// The exact sign.
    pub fn sign(&self) -> Sign {
        match self {
            ExactNumber::Expansion(x) => x.sign(),
            ExactNumber::Surd(x) => x.exact_sign(),
        }
    }

    /// The absolute value.
    pub fn magnitude(&self) -> ExactNumber {
        if self.sign() == Sign::Negative { -self } else { self.clone() }
    }

    /// `self / divisor`, correctly rounded to the nearest f64, ties to even; the divisor must be positive.
    pub fn divide_rounded(&self, divisor: &ExactNumber) -> f64 {
        match (self, divisor) {
            (ExactNumber::Expansion(x), ExactNumber::Expansion(d)) => x.divide_rounded(d),
            _ => root::round(&self.to_surd(), &divisor.to_surd()),
        }
    }

    pub(crate) fn to_surd(&self) -> Surd {
        match self {
            ExactNumber::Expansion(x) => Surd::rational(Dyadic::from_expansion(x)),
            ExactNumber::Surd(x) => x.clone(),
        }
    }
}

impl From<Expansion> for ExactNumber {
    fn from(value: Expansion) -> ExactNumber {
        ExactNumber::Expansion(value)
    }
}

impl From<f32> for ExactNumber {
    fn from(value: f32) -> ExactNumber {
        ExactNumber::Expansion(value.into())
    }
}

impl Neg for &ExactNumber {
    type Output = ExactNumber;

    fn neg(self) -> ExactNumber {
        match self {
            ExactNumber::Expansion(x) => ExactNumber::Expansion(-x),
            ExactNumber::Surd(x) => ExactNumber::Surd(x.negated()),
        }
    }
}

macro_rules! operation {
    ($trait:ident, $method:ident, $surd:ident) => {
        impl $trait for &ExactNumber {
            type Output = ExactNumber;

            fn $method(self, other: &ExactNumber) -> ExactNumber {
                match (self, other) {
                    (ExactNumber::Expansion(a), ExactNumber::Expansion(b)) => {
                        ExactNumber::Expansion($trait::$method(a, b))
                    }
                    _ => ExactNumber::Surd(self.to_surd().$surd(&other.to_surd())),
                }
            }
        }
    };
}

operation!(Add, add, plus);
operation!(Sub, sub, minus);
operation!(Mul, mul, times);

/// A vector of exact numbers.
pub type ExactVector = [ExactNumber; 3];

/// The exact scalar product.
pub fn dot(a: &ExactVector, b: &ExactVector) -> ExactNumber {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

/// A vector of expansions.
pub fn vector(v: [Expansion; 3]) -> ExactVector {
    v.map(ExactNumber::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_magnitude_is_not_negative() {
        for number in [-2.5, 0.0, 2.5].map(ExactNumber::from) {
            let magnitude = number.magnitude();
            assert_eq!((&magnitude - &number).sign() == Sign::Zero, number.sign() != Sign::Negative);
            assert_eq!((&magnitude + &number).sign() == Sign::Zero, number.sign() != Sign::Positive);
        }
    }
}
