//! The arithmetic that filters and exact stages are made of.

use super::cases;
use super::rational::{Rational, absolute, is_rounded, is_within, rational, sign};
use crate::geometry::bounded::Bounded;
use crate::geometry::bounded_double::BoundedDouble;
use crate::geometry::double_double::DoubleDouble;
use crate::geometry::expansion::Expansion;
use crate::geometry::number::Number;
use dashu_int::{IBig, UBig};
use proptest::prelude::*;

/// Floats of all sizes, many of them equal, small or neighbours.
fn float() -> impl Strategy<Value = f32> {
    prop_oneof![
        (-4..=4_i8).prop_map(f32::from),
        (-4..=4_i8, -149..=120_i32).prop_map(|(x, e)| (f64::from(x) * 2.0_f64.powi(e)) as f32),
        any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |x| x.is_finite() && x.abs() < 1e30),
        prop::sample::select(vec![
            1.0_f32.next_up(),
            1.0_f32.next_down(),
            f32::MIN_POSITIVE,
            f32::from_bits(1),
            0.0,
            -0.0
        ]),
    ]
}

/// A formula: what is done with the last two numbers of a stack, or one more number.
#[derive(Debug, Clone, Copy)]
enum Step {
    Number(f32),
    Plus,
    Minus,
    Times,
}

/// Formulas of degree at most 6, as the predicates have them.
fn formula() -> impl Strategy<Value = Vec<Step>> {
    let step = prop_oneof![
        4 => float().prop_map(Step::Number),
        2 => Just(Step::Plus),
        2 => Just(Step::Minus),
        2 => Just(Step::Times),
    ];
    prop::collection::vec(step, 1..24)
}

/// Every intermediate result of a formula, with its degree.
fn run<T: Clone>(formula: &[Step], exactly: impl Fn(f32) -> T, apply: impl Fn(Step, &T, &T) -> T) -> Vec<T> {
    let mut stack: Vec<(T, u32)> = Vec::new();
    let mut all = Vec::new();
    for &step in formula {
        let next = match step {
            Step::Number(x) => (exactly(x), 1),
            _ if stack.len() < 2 => continue,
            Step::Times if stack[stack.len() - 1].1 + stack[stack.len() - 2].1 > 6 => continue,
            operation => {
                let (b, a) = (stack.pop().expect("two"), stack.pop().expect("one"));
                let degree = if matches!(operation, Step::Times) { a.1 + b.1 } else { a.1.max(b.1) };
                (apply(operation, &a.0, &b.0), degree)
            }
        };
        all.push(next.0.clone());
        stack.push(next);
    }
    all
}

fn in_numbers<N: Number + Clone>(formula: &[Step]) -> Vec<N> {
    run(formula, N::exactly, |step, a, b| match step {
        Step::Plus => a.plus(b),
        Step::Minus => a.minus(b),
        _ => a.times(b),
    })
}

fn in_rationals(formula: &[Step]) -> Vec<Rational> {
    run(
        formula,
        |x| rational(f64::from(x)),
        |step, a, b| match step {
            Step::Plus => a + b,
            Step::Minus => a - b,
            _ => a * b,
        },
    )
}

/// The exact value of an unevaluated sum.
fn sum(d: DoubleDouble) -> Rational {
    rational(d.high) + rational(d.low)
}

proptest! {
    #![proptest_config(cases(4000))]

    #[test]
    fn running_bounds_hold(formula in formula()) {
        for (number, exact) in in_numbers::<Bounded>(&formula).iter().zip(in_rationals(&formula)) {
            prop_assert!(is_within(number.value, number.error, &exact), "{:?}", number);
            if let Some(found) = number.sign() {
                prop_assert_eq!(found, sign(&exact));
            }
        }
    }

    #[test]
    fn running_bounds_of_quotients_and_roots_hold(formula in formula(), other in formula()) {
        let (numbers, exact) = (in_numbers::<Bounded>(&formula), in_rationals(&formula));
        let (divisors, exact_divisors) = (in_numbers::<Bounded>(&other), in_rationals(&other));
        for ((a, exact), (b, divisor)) in numbers.iter().zip(&exact).zip(divisors.iter().zip(&exact_divisors)) {
            let quotient = a.divided_by(b);
            if quotient.error.is_finite() {
                prop_assert!(is_within(quotient.value, quotient.error, &(exact / divisor)), "{:?} / {:?}", a, b);
            }
            if *exact >= Rational::ZERO {
                let root = a.square_root();
                prop_assert!(is_root_within(root.value, root.error, exact), "root of {:?}", a);
            }
        }
    }

    #[test]
    fn running_bounds_of_two_floats_hold(formula in formula(), other in formula()) {
        let (numbers, exact) = (in_numbers::<BoundedDouble>(&formula), in_rationals(&formula));
        let (divisors, exact_divisors) = (in_numbers::<BoundedDouble>(&other), in_rationals(&other));
        for (number, exact) in numbers.iter().zip(&exact) {
            let (value, error) = number.parts();
            prop_assert!(absolute(sum(value) - exact) <= rational(error), "{:?}", number);
            if let Some(found) = number.sign() {
                prop_assert_eq!(found, sign(exact));
            }
            if let Some(found) = number.rounded() {
                prop_assert!(is_rounded(found, exact), "{:?}", number);
            }
        }
        for ((a, exact), (b, divisor)) in numbers.iter().zip(&exact).zip(divisors.iter().zip(&exact_divisors)) {
            let (value, error) = a.divided_by(b).parts();
            if error.is_finite() {
                prop_assert!(absolute(sum(value) - exact / divisor) <= rational(error), "{:?} / {:?}", a, b);
            }
            if *exact >= Rational::ZERO {
                let (value, error) = a.square_root().parts();
                let (low, high) = (sum(value) - rational(error), sum(value) + rational(error));
                prop_assert!((low <= Rational::ZERO || &low * &low <= *exact) && *exact <= &high * &high, "root of {:?}", a);
            }
        }
    }

    /// Sums, products and quotients lose at most what is said of them, where nothing underflows.
    #[test]
    fn two_floats_lose_no_more_than_is_said(a in 1.0_f64..2.0, b in -1.0_f64..1.0, c in -2.0_f64..2.0, d in -1.0_f64..1.0, e in -60..60_i32) {
        let pair = |high: f64, low: f64| {
            let (high, low) = crate::geometry::expansion::two_sum(high, low * high.abs() * 2.0_f64.powi(-53));
            DoubleDouble { high, low }
        };
        let (x, y) = (pair(a, b), pair(c * 2.0_f64.powi(e), d));
        let loss = rational(DoubleDouble::ROUNDOFF);
        let (exact_x, exact_y) = (sum(x), sum(y));
        let sizes = absolute(exact_x.clone()) + absolute(exact_y.clone());
        prop_assert!(absolute(sum(x.add(y)) - (&exact_x + &exact_y)) <= &loss * sizes);
        let product = &exact_x * &exact_y;
        prop_assert!(absolute(sum(x.multiply(y)) - &product) <= &loss * absolute(product));
        if y.high != 0.0 {
            let quotient = &exact_x / &exact_y;
            prop_assert!(absolute(sum(x.divide(y)) - &quotient) <= &loss * absolute(quotient));
        }
    }

    #[test]
    fn expansions_are_exact(formula in formula()) {
        let expansions = run(&formula, Expansion::from, |step, a, b| match step {
            Step::Plus => a + b,
            Step::Minus => a - b,
            _ => a * b,
        });
        for (number, exact) in expansions.iter().zip(in_rationals(&formula)) {
            let total = number.components().iter().fold(Rational::ZERO, |sum, &c| sum + rational(c));
            prop_assert_eq!(number.sign(), sign(&exact));
            prop_assert!(total == exact, "{:?}", number);
        }
    }

    #[test]
    fn quotients_are_correctly_rounded(formula in formula(), other in formula()) {
        let expansion = |formula: &[Step]| run(formula, Expansion::from, |step, a, b| match step {
            Step::Plus => a + b,
            Step::Minus => a - b,
            _ => a * b,
        });
        let (a, b) = (expansion(&formula), expansion(&other));
        let (exact, divisors) = (in_rationals(&formula), in_rationals(&other));
        for ((a, exact), (b, divisor)) in a.iter().zip(&exact).zip(b.iter().zip(&divisors)) {
            if *divisor == Rational::ZERO {
                continue;
            }
            let quotient = exact / divisor;
            // Results beyond f64 are no coordinates.
            if absolute(quotient.clone()) < Rational::from(IBig::ONE << 1000_usize) {
                prop_assert!(is_rounded(a.divide_rounded(b), &quotient));
            }
        }
    }
}

/// Whether a float is within a bound of the square root of a number.
fn is_root_within(value: f64, bound: f64, square: &Rational) -> bool {
    if !bound.is_finite() {
        return true;
    }
    let (low, high) = (rational(value) - rational(bound), rational(value) + rational(bound));
    (low <= Rational::ZERO || &low * &low <= *square) && *square <= &high * &high
}

#[test]
fn the_reference_reads_floats() {
    assert!(rational(0.75) == Rational::from_parts(IBig::from(3), UBig::from(4_u8)));
    assert!(rational(-6.0) == Rational::from(IBig::from(-6)));
    assert!(rational(f64::from_bits(1)) == Rational::from_parts(IBig::ONE, UBig::ONE << 1074_usize));
    assert!(is_rounded(1.0, &rational(1.0)) && !is_rounded(1.0_f64.next_up(), &rational(1.0)));
}
