//! Which texel of an image a point of a triangle shows, exactly.
//!
//! Texture coordinates are linear on the triangle: with barycentric weights proportional to w0, w1, w2 the
//! coordinate u is (w0 u0 + w1 u1 + w2 u2) / (w0 + w1 + w2), and in an image of n texels the place is the
//! floor of n u. Weights are the edge functions of a ray or segment, of degree 6 in the inputs at most.

use super::dyadic::Dyadic;
use super::exact_number::ExactNumber;
use super::number::{Number, dot};
use super::rounding::units;
use super::surd::Surd;
use super::{ROUNDOFF, Sign};
use dashu_int::IBig;
use dashu_int::ops::DivRemEuclid;

/// An axis of an image over a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexelAxis {
    /// Texture coordinates of the three corners.
    pub coordinates: [f32; 3],
    /// Texels from coordinate 0 to 1, at least 1.
    pub size: u32,
}

impl TexelAxis {
    /// The axis for corners in the order that makes an orientation positive: as they are, or the last two
    /// exchanged.
    pub(super) fn for_corners(self, as_they_are: bool) -> TexelAxis {
        let [a, b, c] = self.coordinates;
        let coordinates = if as_they_are { [a, b, c] } else { [a, c, b] };
        TexelAxis { coordinates, ..self }
    }
}

/// The three weights of a point, not negative and not all zero.
pub struct Weights<F> {
    /// Values, and the bounds of their errors.
    pub rounded: [(f64, f64); 3],
    /// The same exactly, for when rounding leaves the texel open.
    pub exact: F,
}

impl<F: Fn() -> [ExactNumber; 3]> Weights<F> {
    /// The texels of two axes that the point shows, counted from coordinate 0 over all repetitions of the
    /// image. Places beyond 64 bits are moved by multiples of twice the size, which no repetition notices.
    pub fn texels(&self, axes: &[TexelAxis; 2]) -> [Place; 2] {
        let rounded = axes.map(|axis| self.rounded_place(&axis));
        if let [Some(column), Some(row)] = rounded {
            return [Place::Near(column), Place::Near(row)];
        }
        let exact = (self.exact)();
        axes.map(|axis| exact_place(&exact, &axis))
    }

    /// The place, if the bounds allow no other.
    fn rounded_place(&self, axis: &TexelAxis) -> Option<i64> {
        let (value, error) = self.quotient(axis)?;
        // The error is more than 16 roundoffs of the value: what passes is far within 64 bits.
        let certain = (value - error).floor() == (value + error).floor();
        certain.then(|| value.floor() as i64)
    }

    /// Coordinate times size, and the bound of its error; `None` if the sum of the weights may be zero.
    fn quotient(&self, axis: &TexelAxis) -> Option<(f64, f64)> {
        let [w0, w1, w2] = self.rounded;
        let [u0, u1, u2] = axis.coordinates.map(|u| f64::from(u) * f64::from(axis.size));
        // The sum adds 2 roundoffs of its terms to the weights' own bounds; the weighted one 1 for each coordinate, 1
        // for each product and 2 for the sums. The quotient is as in `RayTriangle::hit`: its divisor is more than
        // twice its bound.
        let sum = w0.0 + w1.0 + w2.0;
        let sum_error = w0.1 + w1.1 + w2.1 + 4.0 * ROUNDOFF * (w0.0.abs() + w1.0.abs() + w2.0.abs());
        let terms = [w0.0 * u0, w1.0 * u1, w2.0 * u2];
        let size = terms.map(f64::abs).iter().sum::<f64>();
        let total_error = w0.1 * u0.abs() + w1.1 * u1.abs() + w2.1 * u2.abs() + 8.0 * ROUNDOFF * size;
        let value = (terms[0] + terms[1] + terms[2]) / sum;
        let error = 2.0 * (total_error + value.abs() * sum_error) / (sum - sum_error)
            + 4.0 * ROUNDOFF * value.abs()
            + f64::MIN_POSITIVE;
        (sum > 2.0 * sum_error).then_some((value, error))
    }
}

/// A texel along one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Counted from coordinate 0.
    Near(i64),
    /// The same, too far away to be counted: on that side, and shown like this place by repetition.
    Far {
        /// Whether coordinates grow towards it.
        beyond: bool,
        /// From 0 up, below twice the size.
        repeated: i64,
    },
}

fn exact_place(weights: &[ExactNumber; 3], axis: &TexelAxis) -> Place {
    let [ExactNumber::Expansion(w0), ExactNumber::Expansion(w1), ExactNumber::Expansion(w2)] = weights else {
        return place_by_signs(weights, axis);
    };
    // Weights and coordinates count in units of 2^-1074 each, so the quotient counts in one too.
    let weights = [w0, w1, w2].map(units);
    let sum = &weights[0] + &weights[1] + &weights[2];
    let weighted = |i: usize| &weights[i] * units(&axis.coordinates[i].into());
    let numerator = (weighted(0) + weighted(1) + weighted(2)) * IBig::from(axis.size);
    let (place, _) = numerator.div_rem_euclid(sum << 1074usize);
    place_of(place, axis)
}

/// The same for numbers with a square root: the floor of a quotient by bisection with exact signs.
fn place_by_signs(weights: &[ExactNumber; 3], axis: &TexelAxis) -> Place {
    let weights = weights.each_ref().map(|w| w.to_surd());
    let sum = weights[0].plus(&weights[1]).plus(&weights[2]);
    let numerator = dot(&weights, &axis.coordinates.map(Surd::exactly));
    let numerator = numerator.times(&Surd::rational(Dyadic::from_f64(f64::from(axis.size))));
    let is_at_least = |place: &IBig| {
        let scaled = sum.times(&Surd::rational(Dyadic::from_integer(place.clone())));
        numerator.minus(&scaled).exact_sign() != Sign::Negative
    };
    let mut reach = IBig::ONE;
    while is_at_least(&reach) || !is_at_least(&-&reach) {
        reach <<= 8;
    }
    let (mut low, mut high) = (-&reach, reach);
    while &high - &low > IBig::ONE {
        let middle: IBig = (&low + &high) >> 1;
        if is_at_least(&middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    place_of(low, axis)
}

/// A place counted from coordinate 0.
fn place_of(place: IBig, axis: &TexelAxis) -> Place {
    i64::try_from(&place).map_or_else(
        |_| {
            let period = IBig::from(2 * i64::from(axis.size));
            let beyond = place > IBig::ZERO;
            let (_, repeated) = place.div_rem_euclid(period);
            Place::Far {
                beyond,
                repeated: i64::try_from(&IBig::from(repeated)).expect("below twice the size"),
            }
        },
        Place::Near,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn texels(weights: [f32; 3], error: f64, coordinates: [f32; 3], size: u32) -> Place {
        let axis = TexelAxis { coordinates, size };
        let exact = || weights.map(ExactNumber::from);
        Weights { rounded: weights.map(|w| (f64::from(w), error)), exact }.texels(&[axis; 2])[0]
    }

    #[test]
    fn the_bound_of_a_place_is_what_is_derived() {
        // In roundoffs: each weight is off by as many as its size, coordinates times the size of 2 are 6, 10 and 14.
        for (weights, coordinates, expected, roundoffs) in [
            // The sum of 7 by 7 + 4 * 7, the weighted one of 82 by 82 + 8 * 82.
            ([1.0, 2.0, 4.0], [3.0, 5.0, 7.0], 82.0 / 7.0, 2.0 * (738.0 + 410.0) / 7.0 + 4.0 * 82.0 / 7.0),
            ([1.0, 2.0, 4.0], [-3.0, 5.0, 7.0], 10.0, 2.0 * (738.0 + 350.0) / 7.0 + 40.0),
            ([1.0, 2.0, 4.0], [3.0, -5.0, -7.0], -10.0, 2.0 * (738.0 + 350.0) / 7.0 + 40.0),
            // A weight of the wrong sign within its bound.
            ([-1.0, 2.0, 4.0], [3.0, 5.0, 7.0], 14.0, 2.0 * (738.0 + 14.0 * 35.0) / 5.0 + 56.0),
        ] {
            let rounded = weights.map(|w: f64| (w, w.abs() * ROUNDOFF));
            let weights = Weights { rounded, exact: || unreachable!() };
            let (value, error) =
                weights.quotient(&TexelAxis { coordinates, size: 2 }).expect("a sum above zero");
            assert!((value / expected - 1.0).abs() < 1e-12, "{value}");
            assert!((error / (roundoffs * ROUNDOFF) - 1.0).abs() < 1e-9, "{} roundoffs", error / ROUNDOFF);
        }
    }

    #[test]
    fn a_sum_that_may_be_zero_and_a_place_far_away_are_left_open() {
        let place = |weight: f64, error: f64, coordinate: f32| {
            let weights = Weights { rounded: [(weight, error); 3], exact: || unreachable!() };
            weights.rounded_place(&TexelAxis { coordinates: [coordinate; 3], size: 1 })
        };
        assert_eq!(place(1.0, 0.0, 0.5), Some(0));
        assert_eq!(place(1.0, 0.0, -0.5), Some(-1));
        assert_eq!(place(1.0, 0.51, 0.5), None);
        assert_eq!([1e16, f32::MAX].map(|far| place(1.0, 0.0, far)), [None; 2]);
        assert_eq!(place(1e-200, 0.0, 0.5), Some(0));
        assert_eq!(place(1e-200, 1e-203, 0.5), Some(0));
        // From 0.75 to 1.05: the lower end alone, or the product of both, would be certain.
        assert_eq!(place(1.0, 0.04, 0.9), None);
        // The sum is three, within 1.5 and what lies below by rounding.
        let error = 0.5 - 4.0 * ROUNDOFF;
        assert_eq!([place(1.0, error, 0.0), place(1.0, error.next_down(), 0.0)], [None; 2]);
        let quotient = |error: f64, coordinate: f32| {
            let weights = Weights { rounded: [(1.0, error); 3], exact: || unreachable!() };
            weights.quotient(&TexelAxis { coordinates: [coordinate; 3], size: 1 })
        };
        assert!(quotient(error, 0.0).is_none() && quotient(error.next_down(), 0.0).is_some());
        // 2 (0.75 + 0.75) / (3 - 0.75), and nothing but what may underflow.
        assert!(quotient(0.25, 1.0).is_some_and(|(_, error)| (error * 0.75 - 1.0).abs() < 1e-12));
        assert_eq!(quotient(0.0, 0.0), Some((0.0, f64::MIN_POSITIVE)));
    }

    #[test]
    fn borders_belong_to_the_texel_that_they_begin() {
        let place = |weights, coordinates| texels(weights, 0.0, coordinates, 4);
        assert_eq!(place([1.0, 0.0, 0.0], [0.25, 9.0, 9.0]), Place::Near(1));
        assert_eq!(place([1.0, 0.0, 0.0], [0.25f32.next_down(), 9.0, 9.0]), Place::Near(0));
        assert_eq!(place([1.0, 1.0, 2.0], [0.0, 1.0, 0.5]), Place::Near(2));
        assert_eq!(place([1.0, 0.0, 0.0], [-f32::from_bits(1), 0.0, 0.0]), Place::Near(-1));
    }

    #[test]
    fn places_beyond_64_bits_are_repeated() {
        // 3e38 * 3 is a multiple of 6 plus what its bits say; both ways of counting must agree.
        let far = 2f32.powi(100);
        let Place::Far { beyond, repeated } = texels([1.0, 0.0, 0.0], 0.0, [far, 0.0, 0.0], 3) else {
            panic!()
        };
        // 3 * 2^100 is an odd multiple of 3 doubled a hundred times: a multiple of 6.
        assert_eq!((beyond, repeated), (true, 0));
        let Place::Far { beyond, repeated } = texels([1.0, 0.0, 0.0], 0.0, [-far, 0.0, 0.0], 5) else {
            panic!()
        };
        assert_eq!((beyond, repeated), (false, 0));
    }

    proptest! {
        #[test]
        fn rounding_never_decides_wrongly(
            weights in prop::array::uniform3(0.0f32..1.0),
            coordinates in prop::array::uniform3(-3.0f32..3.0),
            noise in -1.0f64..1.0,
            size in 1u32..2000,
        ) {
            prop_assume!(weights.iter().sum::<f32>() > 0.0);
            let exact = texels(weights, f64::INFINITY, coordinates, size);
            prop_assert_eq!(texels(weights, 0.0, coordinates, size), exact);
            // Weights that are off by as much as they say they may be.
            let axis = TexelAxis { coordinates, size };
            for bound in [1e-12, 1e-6, 1e-3] {
                let rounded = weights.map(|w| (f64::from(w) + noise * bound, bound));
                let found = Weights { rounded, exact: || weights.map(ExactNumber::from) }.texels(&[axis; 2])[0];
                prop_assert_eq!(found, exact);
            }
        }
    }

    proptest! {
        #[test]
        fn places_by_signs_are_those_by_division(
            weights in prop::array::uniform3(0..9_u8),
            coordinates in prop::array::uniform3(prop_oneof![-3.0f32..3.0, (-4..5_i8).prop_map(f32::from), -1e6f32..1e6]),
            size in prop::sample::select(vec![1_u32, 2, 3, 256, 4096]),
        ) {
            prop_assume!(weights != [0; 3]);
            let weights = weights.map(|w| ExactNumber::from(f32::from(w)));
            let axis = TexelAxis { coordinates, size };
            prop_assert_eq!(place_by_signs(&weights, &axis), exact_place(&weights, &axis));
        }
    }
}
