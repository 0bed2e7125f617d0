//! The two places where a line meets a quadric, as exact numbers and as bounded ones.

use super::Crossing;
use super::meeting::discriminant;
use super::on_line::{Line, OnLine};
use super::shape::Shape;
use crate::geometry::Sign;
use crate::geometry::bounded::Bounded;
use crate::geometry::bounded_double::BoundedDouble;
use crate::geometry::dyadic::Dyadic;
use crate::geometry::expansion::Expansion;
use crate::geometry::number::{Number, vector};
use crate::geometry::surd::Surd;
use glam::{DVec3, Vec3};
use std::cmp::Ordering;
use std::sync::Arc;

/// A place on a line: a quotient with a positive rational denominator.
#[derive(Debug, Clone)]
pub struct ExactParameter {
    pub(crate) numerator: Surd,
    pub(crate) denominator: Dyadic,
}

impl ExactParameter {
    /// Zero.
    pub fn zero() -> ExactParameter {
        ExactParameter { numerator: Surd::exactly(0.0), denominator: Dyadic::from_f64(1.0) }
    }

    /// A quotient of expansions with a positive denominator.
    pub(crate) fn quotient(numerator: &Expansion, denominator: &Expansion) -> ExactParameter {
        ExactParameter {
            numerator: Surd::rational(Dyadic::from_expansion(numerator)),
            denominator: Dyadic::from_expansion(denominator),
        }
    }

    /// The order of two places on one line.
    pub fn order(&self, other: &ExactParameter) -> Ordering {
        let scaled = |x: &Surd, by: &Dyadic| x.times(&Surd::rational(by.clone()));
        let (one, two) =
            (scaled(&self.numerator, &other.denominator), scaled(&other.numerator, &self.denominator));
        match one.sign_of_difference(&two) {
            Sign::Negative => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Positive => Ordering::Greater,
        }
    }
}

/// A ray's line: (origin + t direction).
pub(super) fn ray_line<N: Number>(origin: Vec3, direction: Vec3) -> Line<N> {
    Line { start: vector(origin), weight: N::exactly(1.0), along: vector(direction) }
}

/// Numbers that roots can be computed with.
pub(super) trait Field: Number {
    fn quotient(&self, divisor: &Self) -> Self;
    fn root(&self) -> Self;
}

impl Field for Bounded {
    fn quotient(&self, divisor: &Bounded) -> Bounded {
        self.divided_by(divisor)
    }

    fn root(&self) -> Bounded {
        self.square_root()
    }
}

impl Field for BoundedDouble {
    fn quotient(&self, divisor: &BoundedDouble) -> BoundedDouble {
        self.divided_by(divisor)
    }

    fn root(&self) -> BoundedDouble {
        self.square_root()
    }
}

/// The place of a crossing of a polynomial whose discriminant is not negative, without cancellation: of the
/// two forms `(-b -+ s) / 2a` and `2c / (-b +- s)`, the one that adds numbers of one sign.
pub(super) fn place<N: Field>(q @ [c, b, a]: &[N; 3], crossing: Crossing) -> Option<N> {
    if a.sign() == Some(Sign::Zero) {
        return Some(c.negated().quotient(b));
    }
    let s = discriminant(q).root();
    let falls = b.sign()? != Sign::Negative;
    let far = if falls { b.negated().minus(&s) } else { s.minus(b) };
    // -b - s is what the entering root has above 2a, -b + s the leaving one.
    let is_far = (crossing == Crossing::Entering) == falls;
    Some(if is_far { far.quotient(&a.plus(a)) } else { c.plus(c).quotient(&far) })
}

/// Whether a line has a crossing with a polynomial, bounds aside; `None` if rounding leaves that open.
pub(super) fn has_crossing<N: Number>(q @ [_, b, a]: &[N; 3], crossing: Crossing) -> Option<bool> {
    if a.sign()? == Sign::Zero {
        let wanted = if crossing == Crossing::Entering { Sign::Negative } else { Sign::Positive };
        return Some(b.sign()? == wanted);
    }
    Some(discriminant(q).sign()? != Sign::Negative)
}

/// The place of a crossing, exactly; `None` if the line does not meet the surface there, bounds aside.
pub(super) fn exact_place(q @ [c, b, a]: &[Surd; 3], crossing: Crossing) -> Option<ExactParameter> {
    let rational = |x: &Surd| x.rational_part().clone();
    if a.exact_sign() == Sign::Zero {
        let wanted = if crossing == Crossing::Entering { Sign::Negative } else { Sign::Positive };
        let sign = b.exact_sign();
        let (numerator, denominator) =
            if sign == Sign::Negative { (c.clone(), b.negated()) } else { (c.negated(), b.clone()) };
        return (sign == wanted).then(|| ExactParameter { numerator, denominator: rational(&denominator) });
    }
    let d = discriminant(q);
    if d.exact_sign() == Sign::Negative {
        return None;
    }
    let turn = a.exact_sign() == Sign::Negative;
    let along = if (crossing == Crossing::Leaving) != turn { 1.0 } else { -1.0 };
    let middle = if turn { rational(b) } else { rational(b).negated() };
    let width = rational(&a.plus(a));
    Some(ExactParameter {
        numerator: Surd::new(middle, Dyadic::from_f64(along), Arc::new(rational(&d))),
        denominator: if turn { width.negated() } else { width },
    })
}

/// Where on its line a ray passes through a surface.
///
/// # Panics
/// If it does not.
pub(crate) fn exact_parameter(
    origin: Vec3,
    direction: Vec3,
    shape: &Shape,
    crossing: Crossing,
) -> ExactParameter {
    let on_line = OnLine::new(shape, &ray_line::<Surd>(origin, direction));
    exact_place(&on_line.surface, crossing).expect("the crossing of a point on a curved surface")
}

/// The point of a crossing in double-double arithmetic, rounded, if the bounds allow no other rounding.
pub(crate) fn rounded(origin: Vec3, direction: Vec3, shape: &Shape, crossing: Crossing) -> Option<DVec3> {
    let line = ray_line::<BoundedDouble>(origin, direction);
    let t = place(&OnLine::new(shape, &line).surface, crossing)?;
    let coordinate = |i: usize| line.start[i].plus(&line.along[i].times(&t)).rounded();
    Some(DVec3::new(coordinate(0)?, coordinate(1)?, coordinate(2)?))
}

/// `numerator / denominator`, correctly rounded to the nearest f64, ties to even, by bisection with exact signs.
pub(crate) fn round(numerator: &Surd, denominator: &Surd) -> f64 {
    let above = |value: f64| {
        let scaled = denominator.times(&Surd::rational(Dyadic::from_f64(value)));
        numerator.minus(&scaled).exact_sign()
    };
    // Floats in their order as integers.
    let float =
        |key: i128| f64::from_bits(key.unsigned_abs() as u64).copysign(if key < 0 { -1.0 } else { 1.0 });
    let largest = i128::from(f64::MAX.to_bits());
    let (mut low, mut high) = (-largest, largest);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if above(float(middle)) == Sign::Negative {
            high = middle;
        } else {
            low = middle;
        }
    }
    let (below, next) = (float(low), float(high));
    let twice = numerator.plus(numerator);
    let sum = Surd::rational(Dyadic::from_f64(below).plus(&Dyadic::from_f64(next)));
    match twice.minus(&denominator.times(&sum)).exact_sign() {
        Sign::Negative => below,
        Sign::Positive => next,
        Sign::Zero => {
            if low % 2 == 0 {
                below
            } else {
                next
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_without_cancellation() {
        // t^2 -+ 1e8 t + 1: the roots are next to 1e8 and next to 1e-8.
        for b in [-1e8_f32, 1e8] {
            let q = [1.0, b, 1.0].map(Bounded::exactly);
            let roots =
                [Crossing::Entering, Crossing::Leaving].map(|crossing| place(&q, crossing).expect("a root"));
            assert!(roots[0].value < roots[1].value);
            assert!(roots.iter().all(|root| root.error < root.value.abs() * 1e-14), "{roots:?}");
        }
    }

    #[test]
    fn points_on_ordinary_surfaces_need_no_exact_arithmetic() {
        let ball = Shape::sphere(Vec3::new(0.1, 0.2, 5.3), 1.7);
        let meets = |direction: Vec3, crossing: Crossing| {
            has_crossing(&OnLine::new(&ball, &ray_line::<Bounded>(Vec3::ZERO, direction)).surface, crossing)
        };
        for crossing in [Crossing::Entering, Crossing::Leaving] {
            assert_eq!(
                [0.1, 0.5].map(|x| meets(Vec3::new(x, -0.03, 0.9), crossing)),
                [Some(true), Some(false)]
            );
            assert!(rounded(Vec3::ZERO, Vec3::new(0.1, -0.03, 0.9), &ball, crossing).is_some());
        }
    }

    #[test]
    fn ties_are_rounded_to_even() {
        let rational = |value: f64| Surd::rational(Dyadic::from_f64(value));
        let one = rational(1.0);
        for sign in [1.0, -1.0] {
            // Half an ulp above one, and three halves.
            for (halves, expected) in
                [(1.0, 1.0), (3.0, 1.0 + 2.0 * f64::EPSILON), (0.9, 1.0), (1.1, 1.0 + f64::EPSILON)]
            {
                let number = rational(sign).plus(&rational(sign * halves * 0.5 * f64::EPSILON));
                assert_eq!(round(&number, &one), sign * expected, "{halves}");
            }
        }
    }
}
