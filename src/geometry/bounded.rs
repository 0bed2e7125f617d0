//! f64 numbers that carry a bound of their error through every operation (running error analysis).

use super::number::Number;
use super::{ROUNDOFF, Sign};

/// A number within `error` of `value`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bounded {
    pub value: f64,
    pub error: f64,
}

/// The bound itself is computed in floats: at most eight operations a step, each wrong by one roundoff.
const INFLATION: f64 = 1.0 + 16.0 * ROUNDOFF;

impl Bounded {
    /// A float that is exact.
    pub fn exact(value: f64) -> Bounded {
        Bounded { value, error: 0.0 }
    }

    /// A float that is the correct rounding of an exact number.
    pub fn rounded(value: f64) -> Bounded {
        Bounded { value, error: value.abs() * ROUNDOFF + f64::MIN_POSITIVE }
    }

    fn is_zero(&self) -> bool {
        self.value == 0.0 && self.error == 0.0
    }

    /// The quotient; its error is infinite if the divisor may be zero.
    pub fn divided_by(&self, divisor: &Bounded) -> Bounded {
        let smallest = divisor.value.abs() - divisor.error;
        if smallest.is_nan() || smallest <= 0.0 {
            return Bounded { value: 0.0, error: f64::INFINITY };
        }
        let value = self.value / divisor.value;
        let error = (self.error + value.abs() * divisor.error) / smallest;
        Bounded { value, error: (error + value.abs() * ROUNDOFF + f64::MIN_POSITIVE) * INFLATION }
    }

    /// The square root of a number that is not negative, whatever its bound says.
    pub fn square_root(&self) -> Bounded {
        let value = self.value.max(0.0).sqrt();
        // |sqrt x - sqrt v| = |x - v| / (sqrt x + sqrt v), and at most sqrt |x - v|. Zero over zero is NaN, which `min`
        // passes over.
        let error = (self.error / value).min(self.error.sqrt());
        Bounded { value, error: (error + value * ROUNDOFF + f64::MIN_POSITIVE) * INFLATION }
    }
}

impl Number for Bounded {
    fn exactly(value: f32) -> Bounded {
        Bounded::exact(f64::from(value))
    }

    fn plus(&self, other: &Bounded) -> Bounded {
        let value = self.value + other.value;
        if self.is_zero() || other.is_zero() {
            return Bounded { value, error: self.error + other.error };
        }
        Bounded { value, error: (self.error + other.error + value.abs() * ROUNDOFF) * INFLATION }
    }

    fn minus(&self, other: &Bounded) -> Bounded {
        self.plus(&Bounded { value: -other.value, error: other.error })
    }

    fn times(&self, other: &Bounded) -> Bounded {
        if self.is_zero() || other.is_zero() {
            return Bounded::exact(0.0);
        }
        let value = self.value * other.value;
        let error = self.value.abs() * other.error
            + other.value.abs() * self.error
            + self.error * other.error
            + value.abs() * ROUNDOFF;
        // Below the smallest normal number products lose more than a roundoff, or all where denormals are zero;
        // so may the terms of the bound.
        Bounded { value, error: (error + 4.0 * f64::MIN_POSITIVE) * INFLATION }
    }

    fn sign(&self) -> Option<Sign> {
        if self.is_zero() { Some(Sign::Zero) } else { Sign::certain(self.value, self.error) }
    }
}
