//! Numbers of about 106 bits as unevaluated sums of two f64 (Dekker 1971; the error bounds are those of
//! Joldes, Muller and Popescu, "Tight and Rigorous Error Bounds for Basic Building Blocks of Double-Word
//! Arithmetic", 2017, rounded up generously).

use super::expansion::{two_product, two_sum};

/// high + low with |low| at most half an ulp of high.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DoubleDouble {
    pub high: f64,
    pub low: f64,
}

impl DoubleDouble {
    /// Relative error of one operation below, at most; sums of opposite signs have it relative to the sum
    /// of the magnitudes.
    pub const ROUNDOFF: f64 = 4.0 * super::ROUNDOFF * super::ROUNDOFF * 4.0;

    pub fn difference(a: f32, b: f32) -> DoubleDouble {
        let (high, low) = two_sum(f64::from(a), -f64::from(b));
        DoubleDouble { high, low }
    }

    pub fn add(self, other: DoubleDouble) -> DoubleDouble {
        let (s, e) = two_sum(self.high, other.high);
        let (t, f) = two_sum(self.low, other.low);
        let (s, e) = renormalise(s, e + t);
        let (high, low) = renormalise(s, e + f);
        DoubleDouble { high, low }
    }

    pub fn negate(self) -> DoubleDouble {
        DoubleDouble { high: -self.high, low: -self.low }
    }

    pub fn multiply(self, other: DoubleDouble) -> DoubleDouble {
        let (p, e) = two_product(self.high, other.high);
        let (high, low) = renormalise(p, e + (self.high * other.low + self.low * other.high));
        DoubleDouble { high, low }
    }

    /// Quotient by two steps of long division.
    pub fn divide(self, other: DoubleDouble) -> DoubleDouble {
        let first = self.high / other.high;
        let rest = self.add(other.multiply(DoubleDouble { high: first, low: 0.0 }).negate());
        let second = rest.high / other.high;
        let rest = rest.add(other.multiply(DoubleDouble { high: second, low: 0.0 }).negate());
        let third = rest.high / other.high;
        let (s, e) = renormalise(first, second);
        let (high, low) = renormalise(s, e + third);
        DoubleDouble { high, low }
    }
}

fn renormalise(a: f64, b: f64) -> (f64, f64) {
    two_sum(a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_keeps_what_its_high_parts_leave_when_they_cancel() {
        let pair = |high: f64, exponent: i32| DoubleDouble { high, low: 2.0_f64.powi(exponent) };
        // The sum of the low parts needs 57 bits.
        let sum = pair(1.0, -54).add(pair(-1.0, -110));
        assert_eq!((sum.high, sum.low), (2.0_f64.powi(-54), 2.0_f64.powi(-110)));
    }
}
