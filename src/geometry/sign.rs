//! The sign of a number.

use std::ops::{Mul, Neg};

/// The sign of an exact real number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sign {
    /// Below zero.
    Negative,
    /// Exactly zero.
    Zero,
    /// Above zero.
    Positive,
}

impl Sign {
    /// The sign of a float that carries an exact sign; NaN is not allowed.
    pub fn of(value: f64) -> Sign {
        debug_assert!(!value.is_nan());
        if value > 0.0 {
            Sign::Positive
        } else if value < 0.0 {
            Sign::Negative
        } else {
            Sign::Zero
        }
    }

    /// The sign of a computed value whose absolute error is at most `bound`, if that decides it.
    #[inline(always)]
    pub fn certain(value: f64, bound: f64) -> Option<Sign> {
        if value > bound {
            Some(Sign::Positive)
        } else if value < -bound {
            Some(Sign::Negative)
        } else {
            None
        }
    }
}

impl Neg for Sign {
    type Output = Sign;

    fn neg(self) -> Sign {
        match self {
            Sign::Negative => Sign::Positive,
            Sign::Zero => Sign::Zero,
            Sign::Positive => Sign::Negative,
        }
    }
}

impl Mul for Sign {
    type Output = Sign;

    fn mul(self, other: Sign) -> Sign {
        match self {
            Sign::Positive => other,
            Sign::Zero => Sign::Zero,
            Sign::Negative => -other,
        }
    }
}
