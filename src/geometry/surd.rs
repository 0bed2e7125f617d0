//! Numbers a + b sqrt(d) with the same d, exactly: where rays meet quadrics.

use super::Sign;
use super::dyadic::Dyadic;
use super::number::Number;
use std::sync::Arc;

/// a + b sqrt(d), d >= 0. Numbers that meet in one operation have the same d, or b = 0.
#[derive(Debug, Clone)]
pub struct Surd {
    a: Dyadic,
    b: Dyadic,
    d: Option<Arc<Dyadic>>,
}

impl Surd {
    /// A number without a root.
    pub(crate) fn rational(a: Dyadic) -> Surd {
        Surd { a, b: Dyadic::zero(), d: None }
    }

    /// a + b sqrt(d).
    pub(crate) fn new(a: Dyadic, b: Dyadic, d: Arc<Dyadic>) -> Surd {
        Surd { a, b, d: Some(d) }
    }

    /// The exact sign: that of both parts where they agree, otherwise of the one with the larger square.
    pub(crate) fn exact_sign(&self) -> Sign {
        let root = self.d.as_ref().filter(|d| !d.is_zero());
        let (rational, irrational) = (self.a.sign(), self.b.sign());
        let Some(d) = root.filter(|_| irrational != Sign::Zero) else { return rational };
        if rational == Sign::Zero || rational == irrational {
            return irrational;
        }
        rational * self.a.times(&self.a).minus(&self.b.times(&self.b).times(d)).sign()
    }

    fn root(&self, other: &Surd) -> Option<Arc<Dyadic>> {
        self.d.clone().or_else(|| other.d.clone())
    }

    fn is_rational(&self) -> bool {
        self.d.is_none() || self.b.is_zero()
    }

    /// a.
    pub(crate) fn rational_part(&self) -> &Dyadic {
        &self.a
    }

    /// The sign of the difference to a number that may have another root.
    pub(crate) fn sign_of_difference(&self, other: &Surd) -> Sign {
        let rational = self.a.minus(&other.a);
        let own = Surd { a: rational, b: self.b.clone(), d: self.d.clone() };
        own.sign_with(&other.b.negated(), other.d.as_deref().unwrap_or(&Dyadic::zero()))
    }

    /// The sign of `self + c sqrt(e)` for another root.
    fn sign_with(&self, c: &Dyadic, e: &Dyadic) -> Sign {
        let own = self.exact_sign();
        let other = if e.is_zero() { Sign::Zero } else { c.sign() };
        if own == Sign::Zero || other == Sign::Zero || own == other {
            return if own == Sign::Zero { other } else { own };
        }
        let other_square = Surd::rational(c.times(c).times(e));
        own * self.times(self).minus(&other_square).exact_sign()
    }
}

impl Number for Surd {
    fn exactly(value: f32) -> Surd {
        Surd::rational(Dyadic::from_f64(f64::from(value)))
    }

    fn plus(&self, other: &Surd) -> Surd {
        Surd { a: self.a.plus(&other.a), b: self.b.plus(&other.b), d: self.root(other) }
    }

    fn minus(&self, other: &Surd) -> Surd {
        Surd { a: self.a.minus(&other.a), b: self.b.minus(&other.b), d: self.root(other) }
    }

    fn times(&self, other: &Surd) -> Surd {
        let rational = self.a.times(&other.a);
        if self.is_rational() && other.is_rational() {
            return Surd { a: rational, b: Dyadic::zero(), d: self.root(other) };
        }
        let d = self.root(other).expect("an irrational part has a root");
        let irrational = self.b.times(&other.b).times(&d);
        let b = self.a.times(&other.b).plus(&self.b.times(&other.a));
        Surd { a: rational.plus(&irrational), b, d: Some(d) }
    }

    fn sign(&self) -> Option<Sign> {
        Some(self.exact_sign())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_other_roots_are_in_order() {
        let number = |a: f64, b: f64, d: f64| {
            Surd::new(Dyadic::from_f64(a), Dyadic::from_f64(b), Arc::new(Dyadic::from_f64(d)))
        };
        // sqrt 2, 3 / 2, sqrt 3, 3, 4 - sqrt 2 / 2, 2 + sqrt 3.
        let ascending = [
            number(0.0, 1.0, 2.0),
            Surd::exactly(1.5),
            number(0.0, 1.0, 3.0),
            Surd::exactly(3.0),
            number(4.0, -0.5, 2.0),
            number(2.0, 1.0, 3.0),
        ];
        for (i, one) in ascending.iter().enumerate() {
            for (j, other) in ascending.iter().enumerate() {
                let expected = Sign::of(i as f64 - j as f64);
                assert_eq!(one.sign_of_difference(other), expected, "{i} {j}");
            }
        }
        // Equal but for the root, on either side.
        let root = number(3.0, 1.0, 2.0);
        let three = Surd::exactly(3.0);
        assert_eq!(
            [three.sign_of_difference(&root), root.sign_of_difference(&three)],
            [Sign::Negative, Sign::Positive]
        );
    }
}
