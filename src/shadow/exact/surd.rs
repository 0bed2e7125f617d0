//! Numbers a + b sqrt(D) with integers a, b and one D: the coordinates of points on curved surfaces.
//!
//! A sign is found by enclosing sqrt(D) between neighbouring multiples of 2^-p for growing p. A number that is
//! zero would be enclosed for ever, so that is settled by algebra before p grows.

use super::integer::sign;
use dashu_int::IBig;
use dashu_int::ops::{DivRemEuclid, SquareRoot};
use std::cell::OnceCell;
use std::ops::{Add, Neg, Sub};

/// a + b sqrt(D); what D is, its [`Field`] knows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Surd {
    /// a
    pub rational: IBig,
    /// b
    pub irrational: IBig,
}

/// The D of some numbers, not negative. It may be a square: then numbers are zero in more than one way, and
/// signs are right all the same.
#[derive(Debug, Clone)]
pub struct Field {
    square: IBig,
    /// The root of the square, rounded down.
    root: OnceCell<IBig>,
}

impl Surd {
    /// 0
    pub const ZERO: Surd = Surd { rational: IBig::ZERO, irrational: IBig::ZERO };

    /// A number times an integer.
    pub fn times(&self, factor: &IBig) -> Surd {
        Surd { rational: &self.rational * factor, irrational: &self.irrational * factor }
    }
}

impl From<IBig> for Surd {
    fn from(rational: IBig) -> Surd {
        Surd { rational, irrational: IBig::ZERO }
    }
}

impl Add for &Surd {
    type Output = Surd;

    fn add(self, other: &Surd) -> Surd {
        Surd { rational: &self.rational + &other.rational, irrational: &self.irrational + &other.irrational }
    }
}

impl Sub for &Surd {
    type Output = Surd;

    fn sub(self, other: &Surd) -> Surd {
        Surd { rational: &self.rational - &other.rational, irrational: &self.irrational - &other.irrational }
    }
}

impl Neg for &Surd {
    type Output = Surd;

    fn neg(self) -> Surd {
        Surd { rational: -&self.rational, irrational: -&self.irrational }
    }
}

impl Field {
    /// Numbers with the root of `square`, which is not negative.
    pub fn new(square: IBig) -> Field {
        Field { square, root: OnceCell::new() }
    }

    /// Rational numbers alone.
    pub fn rational() -> Field {
        Field::new(IBig::ZERO)
    }

    /// D
    pub fn square(&self) -> &IBig {
        &self.square
    }

    /// Product.
    pub fn product(&self, x: &Surd, y: &Surd) -> Surd {
        if x.irrational == IBig::ZERO {
            return y.times(&x.rational);
        }
        if y.irrational == IBig::ZERO {
            return x.times(&y.rational);
        }
        Surd {
            rational: &x.rational * &y.rational + &x.irrational * &y.irrational * &self.square,
            irrational: &x.rational * &y.irrational + &x.irrational * &y.rational,
        }
    }

    /// Sign as -1, 0 or 1.
    pub fn sign(&self, x: &Surd) -> i32 {
        let rational = sign(&x.rational);
        let irrational = if self.square == IBig::ZERO { 0 } else { sign(&x.irrational) };
        if irrational == 0 || rational == irrational {
            return rational;
        }
        if rational == 0 {
            return irrational;
        }
        let mut precision = 0;
        loop {
            let (low, high) = self.enclosed(x, precision);
            if sign(&low) > 0 || sign(&high) < 0 {
                return sign(&high);
            }
            if precision == 0 && self.is_zero(x) {
                return 0;
            }
            precision = 64.max(precision * 2);
        }
    }

    /// The largest integer not above `numerator / denominator`; the denominator is positive.
    pub fn floor_of_quotient(&self, numerator: &Surd, denominator: &Surd) -> IBig {
        let mut precision = 0;
        loop {
            let (low, high) = self.enclosed(numerator, precision);
            let (least, most) = self.enclosed(denominator, precision);
            if sign(&least) > 0 {
                let floor = |n: IBig, d: &IBig| n.div_rem_euclid(d.clone()).0;
                let divisor_for =
                    |n: &IBig, towards_zero, away| if sign(n) < 0 { away } else { towards_zero };
                let below = divisor_for(&low, &most, &least);
                let above = divisor_for(&high, &least, &most);
                let (below, above) = (floor(low, below), floor(high, above));
                if below == above {
                    return below;
                }
                if &below + IBig::ONE == above {
                    let reaches = self.sign(&(numerator - &denominator.times(&above))) >= 0;
                    return if reaches { above } else { below };
                }
            }
            precision = 64.max(precision * 2);
        }
    }

    /// Integers between which the number times 2^precision lies.
    fn enclosed(&self, x: &Surd, precision: usize) -> (IBig, IBig) {
        let rational = &x.rational << precision;
        if x.irrational == IBig::ZERO {
            return (rational.clone(), rational);
        }
        let root = match precision {
            0 => self.root.get_or_init(|| IBig::from(self.square.sqrt())).clone(),
            _ => IBig::from((&self.square << (2 * precision)).sqrt()),
        };
        let one = &rational + &x.irrational * &root;
        let other = &one + &x.irrational;
        if one <= other { (one, other) } else { (other, one) }
    }

    /// Whether a + b sqrt(D) = 0, for a and b of opposite signs.
    fn is_zero(&self, x: &Surd) -> bool {
        &x.rational * &x.rational == &x.irrational * &x.irrational * &self.square
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn surd(rational: i64, irrational: i64) -> Surd {
        Surd { rational: rational.into(), irrational: irrational.into() }
    }

    #[test]
    fn convergents_of_the_root_of_two_lie_on_alternate_sides() {
        let field = Field::new(2.into());
        let (mut p, mut q) = (IBig::ONE, IBig::ONE);
        let mut expected = -1;
        // p / q is within 1 / (2 q^2), which at the end is 2^-500.
        for _ in 0..200 {
            let x = Surd { rational: p.clone(), irrational: -&q };
            assert_eq!((field.sign(&x), field.sign(&-&x)), (expected, -expected));
            (p, q) = (&p + &q * IBig::from(2), p + q);
            expected = -expected;
        }
    }

    #[test]
    fn zero_is_found_where_the_root_is_an_integer() {
        let field = Field::new(49.into());
        assert_eq!(field.sign(&surd(21, -3)), 0);
        assert_eq!((field.sign(&surd(22, -3)), field.sign(&surd(20, -3))), (1, -1));
        assert_eq!(Field::rational().sign(&surd(0, 5)), 0);
    }

    #[test]
    fn quotients_round_down() {
        let field = Field::new(2.into());
        let floor = |n, d| field.floor_of_quotient(&n, &d);
        // sqrt 2 = 1.41, -sqrt 2, (10 sqrt 2) / 2, and (6 + 4 sqrt 2) / (2 + sqrt 2) = 2 + sqrt 2.
        assert_eq!(floor(surd(0, 1), surd(1, 0)), 1.into());
        assert_eq!(floor(surd(0, -1), surd(1, 0)), (-2).into());
        assert_eq!(floor(surd(0, 10), surd(2, 0)), 7.into());
        assert_eq!(floor(surd(6, 4), surd(2, 1)), 3.into());
        // Exactly 3, and exactly -3.
        assert_eq!(floor(surd(3, 6), surd(1, 2)), 3.into());
        assert_eq!(floor(surd(-3, -6), surd(1, 2)), (-3).into());
    }

    proptest! {
        #[test]
        fn products_and_sums_have_the_signs_of_their_values(
            a in -99i64..99, b in -99i64..99, c in -99i64..99, d in -99i64..99, square in 0i64..50,
        ) {
            let field = Field::new(square.into());
            let root = (square as f64).sqrt();
            let value = |x: i64, y: i64| x as f64 + y as f64 * root;
            let (x, y) = (surd(a, b), surd(c, d));
            let product = field.product(&x, &y);
            let expected = value(a, b) * value(c, d);
            if expected.abs() > 1e-6 {
                prop_assert_eq!(field.sign(&product), expected.signum() as i32);
            }
            prop_assert_eq!(field.sign(&product), field.sign(&x) * field.sign(&y));
            prop_assert_eq!(field.sign(&(&x - &x)), 0);
        }
    }
}
