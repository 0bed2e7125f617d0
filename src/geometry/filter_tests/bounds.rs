//! Bounds of errors are what the analysis asks for: not less, and hardly more. A bound that is much too large breaks
//! no answer, but leaves to exact arithmetic what floats could decide.

use super::cases;
use super::rational::{Rational, absolute, rational};
use crate::geometry::bounded::Bounded;
use crate::geometry::bounded_double::BoundedDouble;
use crate::geometry::double_double::DoubleDouble;
use crate::geometry::expansion::two_sum;
use crate::geometry::number::Number;
use crate::geometry::{ROUNDOFF, Sign};
use proptest::prelude::*;

/// Numbers and errors that neither overflow nor underflow in what follows.
fn number() -> impl Strategy<Value = Bounded> {
    let value = (1.0_f64..2.0, any::<bool>(), -60..60_i32)
        .prop_map(|(x, negative, e)| if negative { -x } else { x } * 2.0_f64.powi(e));
    (value, 0.0..1.0_f64, prop::sample::select(vec![1, 2, 10, 40, 52]))
        .prop_map(|(value, share, bits)| Bounded { value, error: value.abs() * share * 2.0_f64.powi(-bits) })
}

/// At least what is needed, and no more than that and the roundings of the bound itself.
fn check(found: f64, needed: Rational) -> Result<(), TestCaseError> {
    let most = &needed * rational(1.0 + 40.0 * ROUNDOFF) + rational(16.0 * f64::MIN_POSITIVE);
    prop_assert!(needed <= rational(found), "{:e} is too small", found);
    prop_assert!(rational(found) <= most, "{:e} is too large", found);
    Ok(())
}

/// What one rounding to a value can be wrong by.
fn rounding(value: f64) -> Rational {
    absolute(rational(value)) * rational(ROUNDOFF)
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn running_bounds_are_no_larger_than_they_must_be(a in number(), b in number()) {
        let [x, y, e, f] = [a.value.abs(), b.value.abs(), a.error, b.error].map(rational);
        let sum = a.plus(&b);
        check(sum.error, &e + &f + rounding(sum.value))?;
        let difference = a.minus(&b);
        prop_assert_eq!(difference.value, a.value - b.value);
        check(difference.error, &e + &f + rounding(difference.value))?;
        let product = a.times(&b);
        check(product.error, &x * &f + &y * &e + &e * &f + rounding(product.value))?;
        let quotient = a.divided_by(&b);
        let ratio = absolute(rational(quotient.value));
        check(quotient.error, (&e + &ratio * &f) / (&y - &f) + rounding(quotient.value))?;
        let square = Bounded { value: a.value.abs(), ..a };
        let root = square.square_root();
        // The smaller of two bounds: of a number with a small error, and of one that may be zero.
        let by_slope = &e / rational(root.value);
        let by_root = rational(a.error.sqrt());
        let smaller = if by_slope < by_root { by_slope } else { by_root };
        check(root.error, smaller + rounding(root.value))?;
    }

    #[test]
    fn running_bounds_of_two_floats_are_no_larger_than_they_must_be(
        a in number(),
        b in number(),
        lows in prop::array::uniform2(-1.0..=1.0_f64),
    ) {
        let [a, b] = [(a, lows[0]), (b, lows[1])].map(|(number, low)| {
            let (high, low) = two_sum(number.value, number.value * low * ROUNDOFF);
            BoundedDouble::from_parts(DoubleDouble { high, low }, number.error)
        });
        let size = |number: &BoundedDouble| {
            let DoubleDouble { high, low } = number.parts().0;
            absolute(rational(high) + rational(low))
        };
        let (x, y, loss) = (size(&a), size(&b), rational(DoubleDouble::ROUNDOFF));
        let [e, f] = [&a, &b].map(|number| rational(number.parts().1));
        for sum in [a.plus(&b), a.minus(&b)] {
            check(sum.parts().1, &e + &f + &loss * (&x + &y))?;
        }
        check(a.times(&b).parts().1, &x * &f + &y * &e + &e * &f + &loss * (&x * &y))?;
        let quotient = a.divided_by(&b);
        let ratio = size(&quotient);
        check(quotient.parts().1, (&e + &ratio * &f) / (&y - &f) + &loss * &ratio)?;
        let (value, error) = a.parts();
        let positive = if value.high > 0.0 { value } else { value.negate() };
        let root = BoundedDouble::from_parts(positive, error).square_root();
        let size = rational(root.parts().0.high);
        check(root.parts().1, &e / &size + &loss * (&size + &size))?;
    }
}

#[test]
fn an_exact_zero_stays_exact_and_leaves_other_bounds_alone() {
    let (zero, tenth) = (Bounded::exactly(0.0), Bounded::rounded(0.1));
    assert_eq!(zero.times(&tenth).sign(), Some(Sign::Zero));
    assert_eq!(tenth.times(&zero).sign(), Some(Sign::Zero));
    for sum in [zero.plus(&tenth), tenth.plus(&zero), tenth.minus(&zero)] {
        assert_eq!((sum.value, sum.error), (tenth.value, tenth.error));
    }
    // What is zero within its bound is not zero.
    assert_eq!(Bounded { value: 0.0, error: 1e-9 }.times(&tenth).sign(), None);
    assert_eq!(tenth.minus(&tenth).sign(), None);
}

#[test]
fn a_correct_rounding_is_wrong_by_half_an_ulp() {
    for value in [0.0, f64::from_bits(1), 1e-310, 1.0, -3.7, 1e300] {
        let half_an_ulp = (rational(value.abs().next_up()) - rational(value.abs())) * rational(0.5);
        let found = rational(Bounded::rounded(value).error);
        assert!(half_an_ulp <= found, "{value:e}");
        assert!(found <= rounding(value) + rational(f64::MIN_POSITIVE), "{value:e}");
    }
}

#[test]
fn nothing_is_known_of_a_quotient_whose_divisor_may_be_zero() {
    let one = Bounded::exact(1.0);
    for divisor in [0.0, 0.5, -1.0] {
        assert_eq!(one.divided_by(&Bounded { value: divisor, error: 1.0 }).error, f64::INFINITY);
    }
    assert!(one.divided_by(&Bounded { value: 2.0, error: 1.0 }).error.is_finite());
    // The low part of a divisor counts where its bound nearly reaches zero.
    let one = BoundedDouble::exactly(1.0);
    let divisor = |low: f64, error: f64| BoundedDouble::from_parts(DoubleDouble { high: 1.0, low }, error);
    for low in [-ROUNDOFF, ROUNDOFF] {
        let error = 1.0 - 8.0 * ROUNDOFF;
        let needed = rational(error) / (rational(1.0) + rational(low) - rational(error));
        assert!(needed <= rational(one.divided_by(&divisor(low, error)).parts().1));
        assert_eq!(one.divided_by(&divisor(low, 1.0)).parts().1, f64::INFINITY);
    }
}
