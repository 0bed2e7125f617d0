//! Holes of masked triangles, in integers.

use super::integer::{LitTriangle, decode, side_value};
use super::point::RelativePoint;
use crate::scene::MaskedTriangle;
use dashu_int::IBig;

/// Whether a masked triangle is there where the segment of a point passes through it.
pub fn is_there(masked: &MaskedTriangle, triangle: &LitTriangle, point: &RelativePoint) -> bool {
    // Each edge function is the weight of the corner across.
    let [w2, w0, w1] = triangle.edges.each_ref().map(|edge| side_value(edge, point));
    let weights = [w0, w1, w2];
    let sum = &(&weights[0] + &weights[1]) + &weights[2];
    let place = |axis: usize, size: u32| {
        let coordinates = masked.coordinates.map(|corner| decode(corner[axis]));
        let unit = coordinates.iter().map(|c| c.1).min().unwrap_or(0).min(0);
        let weighted = |i: usize| {
            let (mantissa, exponent) = coordinates[i];
            weights[i].times(&(IBig::from(mantissa) << (exponent - unit) as usize))
        };
        let numerator = (&(&weighted(0) + &weighted(1)) + &weighted(2)).times(&IBig::from(size));
        let denominator = sum.times(&(IBig::ONE << (-unit) as usize));
        let place = point.field.floor_of_quotient(&numerator, &denominator);
        masked.mask.wrap[axis].repeated(&place, size)
    };
    let column = place(0, masked.mask.width);
    let row = place(1, masked.mask.height);
    masked.mask.is_opaque(column, row)
}
