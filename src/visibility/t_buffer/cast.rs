//! A triangle as linear functions of the picture: its three edges, and how near it is.

use super::view::View;
use crate::geometry::batch::LANES;
use crate::geometry::footprint::Linear;
use crate::geometry::planes::{OrientedPlanes, Plane};
use crate::scene::PrimitiveIndex;

/// A linear function over the picture in f64, and its steps from pixel to pixel in f32.
///
/// At the start of each run of sixteen pixels it is computed in f64 and rounded; from there it goes on in steps. Its
/// value v is then wrong by no more than `slack` and 2^-22 of |v|: a roundoff (2^-24) of the start, which is at most |v|
/// and sixteen steps; one of the step and one of the product, at most sixteen steps each; and one of the sum. That is
/// 2^-23 |v| and 48 * 2^-24 steps, for which `slack` has 2^-17 steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ramp {
    a: f64,
    b: f64,
    c: f64,
    /// From one column to the next.
    pub step: f32,
    /// How far the value can be from that of the pixel's ray, as said above.
    pub slack: f32,
}

/// One edge function, positive inside, scaled so that it changes by about 1 from pixel to pixel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    pub ramp: Ramp,
    /// That of the ramp before it was rounded.
    step: f64,
    /// As that of the ramp, without what f32 adds.
    slack: f64,
}

/// A triangle that is ready to be drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cast {
    pub primitive: PrimitiveIndex,
    pub sides: [Side; 3],
    /// 1 / depth.
    pub nearness: Ramp,
}

impl Ramp {
    /// The values of a linear function times a factor, within its spread.
    #[inline(always)]
    fn new(view: &View, linear: &Linear, spread: f64, factor: f64) -> Ramp {
        let step = linear.a * factor * view.grid.step[0];
        Ramp {
            a: linear.a * factor,
            b: linear.b * factor,
            c: linear.c * factor,
            step: step as f32,
            // Beyond a roundoff of its own, and what would be lost to denormal numbers.
            slack: ((spread * factor + step.abs() * (1.0 / 131_072.0)) * 1.000_001 + 1e-37) as f32,
        }
    }

    /// What does not change along a row.
    #[inline(always)]
    pub fn of_row(&self, y: f64) -> f64 {
        self.b * y + self.c
    }

    /// The value at a place of the row.
    #[inline(always)]
    pub fn at(&self, of_row: f64, x: f64) -> f64 {
        self.a * x + of_row
    }
}

impl Side {
    #[inline(always)]
    fn new(view: &View, plane: &Plane) -> Side {
        let linear = Linear::through_apex(plane, &view.frame, view.reach);
        let steps = [linear.a * view.grid.step[0], linear.b * view.grid.step[1]];
        // An edge that hardly changes over the picture keeps its value in the range of f32.
        let largest = steps[0].abs().max(steps[1].abs()).max(linear.c.abs() * (1.0 / (1u64 << 60) as f64));
        let factor = reciprocal_power_of_two(largest);
        let spread = linear.spread(&view.grid);
        Side {
            ramp: Ramp::new(view, &linear, spread, factor),
            step: steps[0] * factor,
            slack: spread * factor,
        }
    }
}

/// 1 / 2^n of the 2^n next below a positive number; of other numbers, and such as are near the ends of f64, anything.
#[inline(always)]
fn reciprocal_power_of_two(number: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits((2046u64 << 52).wrapping_sub(number.to_bits() & EXPONENT) & EXPONENT)
}

impl Cast {
    /// `None` if the camera is in the triangle's plane.
    #[inline(always)]
    pub fn new(view: &View, primitive: PrimitiveIndex) -> Option<Cast> {
        let [a, b, c] = view.scene.triangles[primitive as usize].vertices;
        let vertices = &view.scene.vertices;
        let corners = [vertices[a as usize], vertices[b as usize], vertices[c as usize]];
        let planes = OrientedPlanes::seen_from(view.camera.origin, corners)?;
        let own = Linear::through_apex(&planes.own, &view.frame, view.reach);
        let (height, error) = planes.height;
        // An error of the height moves nearness by as much of itself, which 2^-22 of it holds. Otherwise nothing is known.
        let is_known = error < height * (1.0 / 1_073_741_824.0);
        let spread = if is_known { own.spread(&view.grid) * (1.0 + 1e-8) } else { f64::INFINITY };
        Some(Cast {
            primitive,
            sides: [
                Side::new(view, &planes.edges[0]),
                Side::new(view, &planes.edges[1]),
                Side::new(view, &planes.edges[2]),
            ],
            nearness: Ramp::new(view, &own, spread, 1.0 / height),
        })
    }

    /// Of the columns from first to last those that a row's rays may hit the triangle in.
    #[inline(always)]
    pub fn span(&self, view: &View, of_row: &[f64; 3], [first, last]: [u32; 2]) -> Option<[u32; 2]> {
        let (mut low, mut high) = (f64::from(first), f64::from(last));
        for (side, &of_row) in self.sides.iter().zip(of_row) {
            let at_zero = side.ramp.at(of_row, view.grid.origin[0]) + side.slack;
            let crossing = -at_zero / side.step;
            // A little wider than the roundings of these two lines.
            let margin = 1e-9 + crossing.abs() * 1e-13;
            if side.step > 0.0 {
                low = low.max(crossing - margin);
            } else if side.step < 0.0 {
                high = high.min(crossing + margin);
            } else if at_zero < 0.0 {
                return None;
            }
        }
        if low > high {
            return None;
        }
        // From here on both are columns of the picture.
        let first = low as u32;
        let first = first + u32::from(f64::from(first) < low);
        let last = high as u32;
        (first <= last).then_some([first, last])
    }
}

/// The numbers of lanes.
pub(super) const LANE: [f32; LANES] =
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
