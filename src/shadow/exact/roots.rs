//! Where a polynomial of degree 2 has roots above zero, and on which side of a bound they are.
//!
//! All points of an open segment between two homogeneous points P and L are P + s L with s > 0, wherever L is.
//! So roots are counted by Descartes' rule of signs: a polynomial all of whose roots are real has as many
//! positive ones as its coefficients have changes of sign. Those below some z are counted by the same rule in
//! the polynomial's Bernstein form between 0 and z. No root is ever computed.

use super::surd::{Field, Surd};

/// c + b s + a s^2 with coefficients of one field.
pub struct Quadratic<'f> {
    field: &'f Field,
    /// Coefficients of 1, s and s^2.
    coefficients: [Surd; 3],
}

/// The roots above zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Roots {
    /// The polynomial is zero.
    Everywhere,
    /// This many, each simple.
    Simple(usize),
    /// One, and it is double.
    Double,
}

/// A positive fraction of a field.
struct Fraction {
    numerator: Surd,
    denominator: Surd,
}

/// What must be at least zero where a root counts.
pub enum Bound<'f> {
    /// Constant term and slope.
    Linear([Surd; 2]),
    /// For roots of polynomials of degree 1 alone.
    Quadratic(Quadratic<'f>),
}

impl<'f> Quadratic<'f> {
    /// The polynomial with these coefficients of 1, s and s^2.
    pub fn new(field: &'f Field, coefficients: [Surd; 3]) -> Quadratic<'f> {
        Quadratic { field, coefficients }
    }

    /// Sign of the value at 0.
    pub fn sign_at_zero(&self) -> i32 {
        self.field.sign(&self.coefficients[0])
    }

    /// The roots above zero.
    pub fn roots(&self) -> Roots {
        let [c, b, a] = &self.coefficients;
        let signs = self.coefficients.each_ref().map(|coefficient| self.field.sign(coefficient));
        if signs == [0; 3] {
            return Roots::Everywhere;
        }
        let field = self.field;
        let discriminant = &field.product(b, b) - &field.product(a, c).times(&4.into());
        match (field.sign(&discriminant), changes(signs)) {
            (..0, _) | (_, 0) => Roots::Simple(0),
            // A change of sign and no discriminant: neither a nor c is zero.
            (0, _) => Roots::Double,
            (_, count) => Roots::Simple(count),
        }
    }

    /// Sign of a bound at a root above zero: the first or second of simple roots, or the double one.
    pub fn sign_at_root(&self, roots: Roots, number: usize, bound: &Bound) -> i32 {
        match bound {
            Bound::Linear(linear) => self.sign_of_linear(roots, number, linear),
            Bound::Quadratic(bound) => {
                let [c, b, _] = self.coefficients.each_ref().map(|x| self.absolute(x));
                let root = Fraction { numerator: c, denominator: b };
                self.field.sign(&bound.value_at(&root))
            }
        }
    }

    fn sign_of_linear(&self, roots: Roots, number: usize, [start, slope]: &[Surd; 2]) -> i32 {
        let (before, after) = (self.field.sign(start), self.field.sign(slope));
        if after == 0 {
            return before;
        }
        if before != -after {
            return after;
        }
        let zero = Fraction { numerator: self.absolute(start), denominator: self.absolute(slope) };
        let last = self.value_at(&zero);
        let is_root = self.field.sign(&last) == 0;
        let below = self.changes_before(&zero, last);
        let is_below = if roots == Roots::Double { below == 2 } else { number < below };
        let is_first_from_here = roots == Roots::Double || number == below;
        if is_below {
            before
        } else if is_root && is_first_from_here {
            0
        } else {
            after
        }
    }

    /// The value at a fraction, times the square of its denominator.
    fn value_at(&self, at: &Fraction) -> Surd {
        let [c, b, a] = &self.coefficients;
        let Fraction { numerator: n, denominator: m } = at;
        let product = |x: &Surd, y: &Surd| self.field.product(x, y);
        // (c m + b n) m + a n^2
        &product(&(&product(c, m) + &product(b, n)), m) + &product(a, &product(n, n))
    }

    /// Changes of sign in the Bernstein form between 0 and a fraction, where the value is `last`.
    fn changes_before(&self, end: &Fraction, last: Surd) -> usize {
        let [c, b, _] = &self.coefficients;
        let twice = self.field.product(c, &end.denominator).times(&2.into());
        let middle = &twice + &self.field.product(b, &end.numerator);
        changes([c, &middle, &last].map(|x| self.field.sign(x)))
    }

    fn absolute(&self, x: &Surd) -> Surd {
        if self.field.sign(x) < 0 { -x } else { x.clone() }
    }
}

impl Bound<'_> {
    /// Sign at 0.
    pub fn sign_at_zero(&self, field: &Field) -> i32 {
        match self {
            Bound::Linear([start, _]) => field.sign(start),
            Bound::Quadratic(bound) => bound.sign_at_zero(),
        }
    }
}

/// How often signs change, zeros left out.
fn changes(signs: [i32; 3]) -> usize {
    let mut last = 0;
    let mut count = 0;
    for sign in signs.into_iter().filter(|&sign| sign != 0) {
        count += usize::from(last == -sign);
        last = sign;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn quadratic(field: &Field, coefficients: [i64; 3]) -> Quadratic<'_> {
        Quadratic::new(field, coefficients.map(|x| Surd::from(dashu_int::IBig::from(x))))
    }

    /// (s - p) (s - q)
    fn with_roots(field: &Field, p: i64, q: i64) -> Quadratic<'_> {
        quadratic(field, [p * q, -p - q, 1])
    }

    #[test]
    fn only_roots_above_zero_count() {
        let field = Field::rational();
        let roots = |p, q| with_roots(&field, p, q).roots();
        assert_eq!(
            (roots(1, 2), roots(-1, 2), roots(0, 2)),
            (Roots::Simple(2), Roots::Simple(1), Roots::Simple(1))
        );
        assert_eq!(
            (roots(3, 3), roots(-3, -3), roots(0, 0)),
            (Roots::Double, Roots::Simple(0), Roots::Simple(0))
        );
        assert_eq!(quadratic(&field, [1, 0, 1]).roots(), Roots::Simple(0));
        assert_eq!(quadratic(&field, [0, 0, 0]).roots(), Roots::Everywhere);
        assert_eq!(quadratic(&field, [3, -1, 0]).roots(), Roots::Simple(1));
        assert_eq!(quadratic(&field, [3, 0, 0]).roots(), Roots::Simple(0));
    }

    proptest! {
        #[test]
        fn bounds_have_the_signs_of_their_values(
            p in 1i64..9, q in 1i64..9, turn in prop::bool::ANY, start in -20i64..20, slope in -4i64..4,
        ) {
            let field = Field::rational();
            let mut polynomial = with_roots(&field, p, q);
            if turn {
                polynomial.coefficients = polynomial.coefficients.each_ref().map(|x| -x);
            }
            let roots = polynomial.roots();
            let linear = [start, slope].map(|x| Surd::from(dashu_int::IBig::from(x)));
            let bound = Bound::Linear(linear);
            let sign_at = |root: i64| (start + slope * root).signum() as i32;
            if p == q {
                prop_assert_eq!(roots, Roots::Double);
                prop_assert_eq!(polynomial.sign_at_root(roots, 0, &bound), sign_at(p));
            } else {
                prop_assert_eq!(roots, Roots::Simple(2));
                prop_assert_eq!(polynomial.sign_at_root(roots, 0, &bound), sign_at(p.min(q)));
                prop_assert_eq!(polynomial.sign_at_root(roots, 1, &bound), sign_at(p.max(q)));
            }
        }
    }
}
