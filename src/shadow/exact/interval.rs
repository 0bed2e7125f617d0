//! Interval arithmetic in f64: every result is widened by more than a correctly rounded operation can be
//! off.

use std::ops::{Add, Mul, Neg, Sub};

/// A closed interval that holds an exact real number. An end may be infinite; NaN never is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// At most the exact number.
    pub low: f64,
    /// At least the exact number.
    pub high: f64,
}

/// What an interval says about a sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decided {
    Below,
    Above,
    Open,
}

impl Interval {
    /// All numbers.
    pub const EVERYTHING: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// A float, exactly.
    pub fn exactly(value: f32) -> Interval {
        Interval { low: f64::from(value), high: f64::from(value) }
    }

    /// Widens the ends of a rounded result. Rounding is off by at most half an ulp, 2^-53 of the result or
    /// 2^-1075 in absolute terms; what is taken off here is more, its own rounding included.
    fn outward(low: f64, high: f64) -> Interval {
        let margin = |end: f64| end.abs() * (2.0 * f64::EPSILON) + f64::MIN_POSITIVE;
        let interval = Interval { low: low - margin(low), high: high + margin(high) };
        // An infinite end comes out as NaN.
        if interval.low.is_nan() || interval.high.is_nan() { Interval::EVERYTHING } else { interval }
    }

    /// The sign of the number, if the interval does not hold zero.
    pub fn decided(self) -> Decided {
        if self.low > 0.0 {
            Decided::Above
        } else if self.high < 0.0 {
            Decided::Below
        } else {
            Decided::Open
        }
    }

    /// Quotient; everything if the divisor may be zero.
    pub fn divided_by(self, divisor: Interval) -> Interval {
        if divisor.decided() == Decided::Open {
            return Interval::EVERYTHING;
        }
        let ends = [
            self.low / divisor.low,
            self.low / divisor.high,
            self.high / divisor.low,
            self.high / divisor.high,
        ];
        Interval::hull(ends)
    }

    /// Root of a number that is not negative, whatever the interval's lower end says.
    pub fn root(self) -> Interval {
        let root = Interval::outward(self.low.max(0.0).sqrt(), self.high.max(0.0).sqrt());
        Interval { low: root.low.max(0.0), high: root.high }
    }

    /// Square.
    pub fn squared(self) -> Interval {
        let square = self * self;
        Interval { low: square.low.max(0.0), high: square.high }
    }

    /// Where both of two intervals that hold the same number say it is.
    pub fn and(self, other: Interval) -> Interval {
        Interval { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    /// Whether no number is in it.
    pub fn is_empty(self) -> bool {
        self.low > self.high
    }

    /// Whether it is the number zero itself.
    pub fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }

    fn hull(ends: [f64; 4]) -> Interval {
        if ends.iter().any(|e| e.is_nan()) {
            return Interval::EVERYTHING;
        }
        Interval::outward(
            ends.into_iter().fold(f64::INFINITY, f64::min),
            ends.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )
    }
}

impl Add for Interval {
    type Output = Interval;

    fn add(self, other: Interval) -> Interval {
        Interval::outward(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Interval;

    fn sub(self, other: Interval) -> Interval {
        Interval::outward(self.low - other.high, self.high - other.low)
    }
}

impl Neg for Interval {
    type Output = Interval;

    fn neg(self) -> Interval {
        Interval { low: -self.high, high: -self.low }
    }
}

impl Mul for Interval {
    type Output = Interval;

    fn mul(self, other: Interval) -> Interval {
        Interval::hull([
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ])
    }
}

/// Three intervals.
pub type Box3 = [Interval; 3];

/// The exact point of three floats.
pub fn point(p: glam::Vec3) -> Box3 {
    p.to_array().map(Interval::exactly)
}

/// Difference of two vectors.
pub fn minus(a: &Box3, b: &Box3) -> Box3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Scalar product.
pub fn dot(a: &Box3, b: &Box3) -> Interval {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The point at some place of a line.
pub fn along(start: &Box3, direction: &Box3, place: Interval) -> Box3 {
    [0, 1, 2].map(|i| start[i] + direction[i] * place)
}

/// Vector product.
pub fn cross(a: &Box3, b: &Box3) -> Box3 {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn results_hold_the_exact_number(a in any::<f32>(), b in any::<f32>()) {
            prop_assume!(a.is_finite() && b.is_finite() && a != 0.0 && b != 0.0);
            let (ia, ib) = (Interval::exactly(a), Interval::exactly(b));
            let (fa, fb) = (f64::from(a), f64::from(b));
            // A product of two f32 is exact in f64; sums and quotients are rounded once.
            prop_assert!((ia * ib).low < fa * fb && fa * fb < (ia * ib).high);
            for (interval, rounded) in [(ia + ib, fa + fb), (ia - ib, fa - fb), (ia.divided_by(ib), fa / fb)] {
                prop_assert!(interval.low < rounded && rounded < interval.high);
            }
            let root = Interval::exactly(a.abs()).root();
            prop_assert!(root.low < fa.abs().sqrt() && fa.abs().sqrt() < root.high);
        }
    }

    #[test]
    fn a_divisor_around_zero_gives_everything() {
        let one = Interval::exactly(1.0);
        assert_eq!(one.divided_by(Interval { low: -1.0, high: 1.0 }), Interval::EVERYTHING);
    }
}
