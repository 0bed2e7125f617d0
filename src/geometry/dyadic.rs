//! Whole numbers times powers of two: sums and products of floats of any size, exactly.

use super::Sign;
use super::expansion::Expansion;
use dashu_int::IBig;
use std::cmp::Ordering;

/// mantissa * 2^exponent.
#[derive(Debug, Clone)]
pub(crate) struct Dyadic {
    mantissa: IBig,
    exponent: i64,
}

impl Dyadic {
    /// A float, exactly; it must be finite.
    pub fn from_f64(value: f64) -> Dyadic {
        debug_assert!(value.is_finite());
        let bits = value.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i64;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (mantissa, exponent) =
            if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
        let zeros = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
        let mantissa = IBig::from(mantissa >> zeros);
        let mantissa = if value.is_sign_negative() { -mantissa } else { mantissa };
        Dyadic { mantissa, exponent: exponent + i64::from(zeros) }
    }

    /// An expansion, exactly.
    pub fn from_expansion(value: &Expansion) -> Dyadic {
        let components = value.components().iter();
        components.fold(Dyadic::zero(), |sum, &component| sum.plus(&Dyadic::from_f64(component)))
    }

    /// A whole number.
    pub fn from_integer(value: IBig) -> Dyadic {
        Dyadic { mantissa: value, exponent: 0 }
    }

    /// Zero.
    pub fn zero() -> Dyadic {
        Dyadic { mantissa: IBig::ZERO, exponent: 0 }
    }

    pub fn plus(&self, other: &Dyadic) -> Dyadic {
        let exponent = self.exponent.min(other.exponent);
        let aligned = |x: &Dyadic| &x.mantissa << (x.exponent - exponent) as usize;
        match (self.is_zero(), other.is_zero()) {
            (true, _) => other.clone(),
            (_, true) => self.clone(),
            _ => Dyadic { mantissa: aligned(self) + aligned(other), exponent },
        }
    }

    pub fn negated(&self) -> Dyadic {
        Dyadic { mantissa: -&self.mantissa, exponent: self.exponent }
    }

    pub fn minus(&self, other: &Dyadic) -> Dyadic {
        self.plus(&other.negated())
    }

    pub fn times(&self, other: &Dyadic) -> Dyadic {
        Dyadic { mantissa: &self.mantissa * &other.mantissa, exponent: self.exponent + other.exponent }
    }

    pub fn is_zero(&self) -> bool {
        self.mantissa == IBig::ZERO
    }

    pub fn sign(&self) -> Sign {
        match self.mantissa.cmp(&IBig::ZERO) {
            Ordering::Less => Sign::Negative,
            Ordering::Equal => Sign::Zero,
            Ordering::Greater => Sign::Positive,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_floats_are_exact() {
        let power = |exponent: i32| Dyadic::from_f64(2.0_f64.powi(exponent));
        let smallest = Dyadic::from_f64(f64::from_bits(1));
        assert_eq!(smallest.minus(&power(-537).times(&power(-537))).sign(), Sign::Zero);
        assert_eq!(
            Dyadic::from_f64(f64::from_bits(6))
                .minus(&smallest.times(&power(1)).times(&Dyadic::from_f64(3.0)))
                .sign(),
            Sign::Zero
        );
    }
}
