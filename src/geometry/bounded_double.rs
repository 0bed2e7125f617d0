//! Double-double numbers that carry a bound of their error, for rounding correctly to f64.

use super::double_double::DoubleDouble;
use super::number::Number;
use super::{ROUNDOFF, Sign};

/// A number within `error` of `value`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoundedDouble {
    value: DoubleDouble,
    error: f64,
}

/// What one operation loses, relative to the magnitudes of its terms: a sum at most 3, a product 5 and a quotient 10
/// of u^2 (Joldes, Muller and Popescu 2017, theorems 3.1, 5.1 and 6.1 for the same operations or lesser ones), 16 here.
const LOSS: f64 = DoubleDouble::ROUNDOFF;

/// The bound itself is computed in floats: at most ten operations, each wrong by one roundoff.
const INFLATION: f64 = 1.0 + 16.0 * ROUNDOFF;

impl BoundedDouble {
    /// The number, and the bound of its error.
    #[cfg(test)]
    pub fn parts(&self) -> (DoubleDouble, f64) {
        (self.value, self.error)
    }

    /// A number within `error` of `value`.
    pub fn from_parts(value: DoubleDouble, error: f64) -> BoundedDouble {
        BoundedDouble { value, error }
    }

    /// The magnitude, but for a roundoff that [`INFLATION`] makes up for.
    fn size(&self) -> f64 {
        self.value.high.abs()
    }

    /// The quotient; its error is infinite if the divisor may be zero.
    pub fn divided_by(&self, divisor: &BoundedDouble) -> BoundedDouble {
        let smallest = divisor.value.high.abs() * (1.0 - 4.0 * ROUNDOFF) - divisor.error;
        if smallest.is_nan() || smallest <= 0.0 {
            return BoundedDouble { value: DoubleDouble { high: 0.0, low: 0.0 }, error: f64::INFINITY };
        }
        let value = self.value.divide(divisor.value);
        let size = value.high.abs();
        let error = (self.error + size * divisor.error) / smallest + LOSS * size + f64::MIN_POSITIVE;
        BoundedDouble { value, error: error * INFLATION }
    }

    /// The square root of a number that is not negative, whatever its bound says: of the high part, and one
    /// step of Newton's method.
    pub fn square_root(&self) -> BoundedDouble {
        if !(self.value.high.is_finite() && self.error.is_finite()) {
            // Products have overflowed, and `max` would take NaN for zero, value and error alike.
            return BoundedDouble { value: DoubleDouble { high: 0.0, low: 0.0 }, error: f64::INFINITY };
        }
        let root = self.value.high.max(0.0).sqrt();
        if root == 0.0 {
            let zero = DoubleDouble { high: 0.0, low: 0.0 };
            return BoundedDouble { value: zero, error: self.error.max(0.0).sqrt() * INFLATION };
        }
        let first = DoubleDouble { high: root, low: 0.0 };
        let rest = self.value.add(first.multiply(first).negate());
        let value = first.add(DoubleDouble { high: rest.high / (2.0 * root), low: 0.0 });
        // A root is 2^-537 at least: nothing underflows that counts beside the second term.
        let error = self.error / root + 2.0 * LOSS * root;
        BoundedDouble { value, error: error * INFLATION }
    }

    /// The f64 that every number within the bound rounds to, if they all round to one.
    pub fn rounded(&self) -> Option<f64> {
        let high = self.value.high;
        let margin = (self.value.low.abs() + self.error) * (1.0 + 4.0 * ROUNDOFF);
        // Tiny results, where products may have underflowed, are left to the exact way.
        let certain = high.abs() > 1e-200 && high + margin == high && high - margin == high;
        certain.then_some(high)
    }
}

impl Number for BoundedDouble {
    fn exactly(value: f32) -> BoundedDouble {
        BoundedDouble { value: DoubleDouble { high: f64::from(value), low: 0.0 }, error: 0.0 }
    }

    fn plus(&self, other: &BoundedDouble) -> BoundedDouble {
        let value = self.value.add(other.value);
        let error = self.error + other.error + LOSS * (self.size() + other.size());
        BoundedDouble { value, error: error * INFLATION }
    }

    fn minus(&self, other: &BoundedDouble) -> BoundedDouble {
        self.plus(&BoundedDouble { value: other.value.negate(), error: other.error })
    }

    fn times(&self, other: &BoundedDouble) -> BoundedDouble {
        let value = self.value.multiply(other.value);
        let error = self.size() * other.error
            + other.size() * self.error
            + self.error * other.error
            + LOSS * (self.size() * other.size());
        BoundedDouble { value, error: (error + 4.0 * f64::MIN_POSITIVE) * INFLATION }
    }

    fn sign(&self) -> Option<Sign> {
        Sign::certain(self.value.high, self.error + self.value.low.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_known_of_the_root_of_what_has_overflowed() {
        let huge = BoundedDouble::exactly(f32::MAX);
        let huge = huge.squared().squared().squared();
        // Infinity minus infinity, without an error that would be larger.
        let nothing = huge.times(&huge).minus(&huge.times(&huge));
        assert!(nothing.value.high.is_nan());
        for root in [nothing.square_root(), huge.times(&huge).square_root()] {
            assert_eq!((root.sign(), root.rounded()), (None, None));
        }
        let pair = |high: f64, error: f64| BoundedDouble::from_parts(DoubleDouble { high, low: 0.0 }, error);
        for root in [pair(f64::NAN, 0.0).square_root(), pair(4.0, f64::INFINITY).square_root()] {
            assert_eq!((root.sign(), root.rounded()), (None, None));
            assert_eq!(root.parts().1, f64::INFINITY);
        }
        // Of what is zero or within a bound of it, the root is at most the bound's.
        let bound = pair(0.0, 4.0).square_root().parts().1;
        assert!(bound > 2.0 && bound < 2.0 * (1.0 + 40.0 * ROUNDOFF));
        let four = BoundedDouble::exactly(4.0);
        assert_eq!(four.square_root().sign(), Some(Sign::Positive));
    }

    #[test]
    fn a_number_is_rounded_if_all_within_its_bound_round_alike() {
        let rounded = |high: f64, low: f64, error: f64| {
            BoundedDouble::from_parts(DoubleDouble { high, low }, error).rounded()
        };
        // The next number below 1 is half as far away as the next above it: so is what rounds to it.
        let half = ROUNDOFF * 0.5;
        for one in [1.0, -1.0] {
            assert_eq!(rounded(one, 0.0, 0.0), Some(one));
            assert_eq!(rounded(one, 0.0, half * 0.99), Some(one));
            assert_eq!(rounded(one, half * 0.5, half * 0.49), Some(one));
            assert_eq!(rounded(one, half * 0.5, half * 0.75), None);
            assert_eq!(rounded(one, -half * 0.5, half * 0.75), None);
            // A tie, and the bound itself is rounded.
            assert_eq!(rounded(one, 0.0, half), None);
        }
        assert_eq!([rounded(1e-200, 0.0, 0.0), rounded(-1e-300, 0.0, 0.0)], [None; 2]);
        assert_eq!(rounded(2e-200, 0.0, 0.0), Some(2e-200));
    }

    #[test]
    fn the_low_part_counts_for_the_sign() {
        let sign =
            |low: f64, error: f64| BoundedDouble::from_parts(DoubleDouble { high: 1.0, low }, error).sign();
        assert_eq!(sign(0.0, 1.0 - ROUNDOFF), Some(Sign::Positive));
        assert_eq!(sign(-ROUNDOFF, 1.0 - ROUNDOFF), None);
        assert_eq!(sign(-ROUNDOFF, 1.0 - 3.0 * ROUNDOFF), Some(Sign::Positive));
    }
}
