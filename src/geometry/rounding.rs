//! The f64 nearest to a quotient of two exact numbers.

use super::expansion::Expansion;
use dashu_int::IBig;
use dashu_int::ops::{Abs, BitTest, DivRem};

impl Expansion {
    /// `self / divisor`, correctly rounded to the nearest f64, ties to even.
    ///
    /// The divisor must not be zero. Subnormal results are rounded once, like all others.
    pub fn divide_rounded(&self, divisor: &Expansion) -> f64 {
        round_quotient(&units(self), &units(divisor))
    }
}

/// An expansion in units of 2^-1074.
pub(super) fn units(value: &Expansion) -> IBig {
    value.components().iter().fold(IBig::ZERO, |sum, &c| sum + units_of(c))
}

/// A finite float in units of 2^-1074, the smallest positive one.
fn units_of(value: f64) -> IBig {
    let bits = value.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as usize;
    let fraction = bits & ((1 << 52) - 1);
    let magnitude =
        if exponent == 0 { IBig::from(fraction) } else { IBig::from(fraction | 1 << 52) << (exponent - 1) };
    if value.is_sign_negative() { -magnitude } else { magnitude }
}

fn round_quotient(numerator: &IBig, denominator: &IBig) -> f64 {
    if *numerator == IBig::ZERO {
        return 0.0;
    }
    let negative = (*numerator < IBig::ZERO) != (*denominator < IBig::ZERO);
    let (n, d) = (numerator.abs(), denominator.abs());
    // quotient = mantissa * 2^-shift with a mantissa of 54 or 55 bits, or fewer where the result is subnormal.
    let bits = |x: &IBig| x.bit_len() as i64;
    let shift = (55 - (bits(&n) - bits(&d))).min(1075);
    let (n, d) = if shift >= 0 { (n << shift as usize, d) } else { (n, d << (-shift) as usize) };
    let (quotient, remainder) = n.div_rem(d);
    // One sticky bit below keeps ties apart from what merely looks like one.
    let sticky = u64::from(remainder != IBig::ZERO);
    let mantissa = u64::try_from(&quotient).expect("56 bits at most") << 1 | sticky;
    let magnitude = round_to_f64(mantissa, -shift - 1);
    if negative { -magnitude } else { magnitude }
}

/// mantissa * 2^exponent to the nearest f64, ties to even; the lowest mantissa bit may be sticky. A mantissa of 55 bits
/// or more, or an exponent below -1075.
fn round_to_f64(mantissa: u64, exponent: i64) -> f64 {
    let length = 64 - i64::from(mantissa.leading_zeros());
    // The last bit that fits: 53 bits, or 2^-1074. There are at least two more.
    let last = (exponent + length - 53).max(-1074);
    let drop = last - exponent;
    let half = 1u64 << (drop - 1);
    let (whole, rest) = (mantissa >> drop, mantissa & ((1 << drop) - 1));
    let kept = whole + u64::from(rest > half || (rest == half && whole & 1 == 1));
    // kept < 2^54 is exact as f64; scaling by powers of two in two steps stays exact.
    let half_scale = last / 2;
    kept as f64 * power_of_two(half_scale) * power_of_two(last - half_scale)
}

fn power_of_two(exponent: i64) -> f64 {
    debug_assert!((-1022..=1023).contains(&exponent));
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

#[cfg(test)]
pub(crate) mod tests_support {
    /// A float in units of 2^-1074.
    pub fn integer(value: f64) -> dashu_int::IBig {
        super::units_of(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn quotients_of_two_floats_round_as_the_hardware_does(a in any::<u32>(), b in any::<u32>()) {
            let (a, b) = (f32::from_bits(a), f32::from_bits(b));
            prop_assume!(a.is_finite() && b.is_finite() && b != 0.0);
            let ours = Expansion::from(a).divide_rounded(&Expansion::from(b));
            let hardware = f64::from(a) / f64::from(b);
            prop_assert!(ours == hardware, "{a:e} / {b:e}: {ours:e} {hardware:e}");
        }

        #[test]
        fn subnormal_quotients_round_once(a in 1u64..1 << 24, b in 1u64..1 << 24, drop in 1000i64..1074) {
            // The hardware rounds a/b * 2^-drop twice; with b a power of two the first step is exact.
            let b = b.next_power_of_two();
            let n = IBig::from(a);
            let d = IBig::from(b) << drop as usize;
            let expected = (a as f64 / b as f64) * power_of_two(-drop / 2) * power_of_two(-drop + drop / 2);
            prop_assert_eq!(round_quotient(&n, &d), expected);
        }
    }
}
