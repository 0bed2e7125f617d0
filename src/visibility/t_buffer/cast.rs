//! Triangles as linear functions of the picture: three edges, and how near it is.

use super::bins::Touched;
use super::view::View;
use crate::geometry::Sign;
use crate::geometry::batch::LANES;
use crate::geometry::footprint::Linear;
use crate::geometry::planes::{OrientedPlanes, Plane, orientation};
use crate::scene::PrimitiveIndex;
use glam::{DVec3, Vec3};

/// A linear function over the picture in f64, and its steps from pixel to pixel in f32.
///
/// At the start of each run of sixteen pixels it is computed in f64 and rounded; from there it goes on by at most fifteen
/// steps, of both kinds together. Its value v is then wrong by no more than `slack` and 2^-22 of |v|: a roundoff (2^-24) of
/// the start, which is at most |v| and sixteen of the larger step; one of each step, of each product and of their sum, at
/// most sixteen steps each; and one of the last sum. That is 2^-23 |v| and 64 * 2^-24 steps, for which `slack` has 2^-17
/// steps. So v has the sign of the exact value where |v| is
/// more than `slack` and 2^-22 of itself, which is less than a millionth, for which `slack` has another.
#[derive(Debug, Clone, Copy, Default)]
struct Ramp {
    a: f64,
    b: f64,
    c: f64,
    /// From one column to the next, and from one row to the next.
    step: [f32; 2],
    /// How far the value can be from that of the pixel's ray, as said above; where it is further from 0, its sign is
    /// certain.
    slack: f32,
}

/// Where a side ends in the rows of a triangle, in columns: nothing of it is before `low` and nothing behind `high` in the
/// first row of its box, both of which move by `slope` from row to row. One of them is infinite.
#[derive(Debug, Clone, Copy, Default)]
struct Border {
    low: f32,
    high: f32,
    slope: f32,
}

/// Three edge functions, positive inside, scaled so that they change by about 1 from pixel to pixel, and 1 / depth.
const FUNCTIONS: usize = 4;

/// A triangle that is ready to be drawn: a number of each [function](FUNCTIONS).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cast {
    a: [f64; FUNCTIONS],
    b: [f64; FUNCTIONS],
    c: [f64; FUNCTIONS],
    /// From one column to the next.
    pub across: [f32; FUNCTIONS],
    /// From one row to the next.
    pub down: [f32; FUNCTIONS],
    /// How far a value can be from that of the pixel's ray; see [`Ramp`].
    pub slack: [f32; FUNCTIONS],
    borders: [Border; 3],
}

impl Ramp {
    /// The values of a linear function times a factor, within its spread.
    #[inline(always)]
    fn new(view: &View, linear: &Linear, spread: f64, factor: f64) -> Ramp {
        let [across, down] = [linear.a * factor * view.grid.step[0], linear.b * factor * view.grid.step[1]];
        let step = across.abs().max(down.abs());
        Ramp {
            a: linear.a * factor,
            b: linear.b * factor,
            c: linear.c * factor,
            step: [across as f32, down as f32],
            // With a millionth for the sign, more for roundoffs of its own, and what would be lost to denormal numbers.
            slack: ((spread * factor.abs() + step * (1.0 / 131_072.0)) * 1.000_002 + 1e-37) as f32,
        }
    }
}

impl Border {
    /// Of a linear function that is negative outside, within its spread; `row` is the first of the box.
    ///
    /// In f64 each term of the numerator is wrong by a few roundoffs of itself (2^-53), and so is the quotient: together by
    /// less than 1e-14 of all terms. In f32 what is said of the first row is rounded, and so are `slope` and its product with
    /// up to 31 rows, twice: by less than 2^-22 of the one and of 64 of the other, of which there is twice as much. A border
    /// that is out of the range of that, or no number, says nothing.
    #[inline(always)]
    fn new(view: &View, linear: &Linear, spread: f64, row: u32) -> Border {
        let [x, y] = view.grid.origin;
        let per_step = 1.0 / (linear.a * view.grid.step[0]);
        let [across, down] = [linear.a * x, linear.b * (y + view.grid.step[1] * f64::from(row))];
        let terms =
            (linear.a * view.reach[0]).abs() + (linear.b * view.reach[1]).abs() + linear.c.abs() + spread;
        let at = -(across + down + linear.c + spread) * per_step;
        let slope = -(linear.b * view.grid.step[1]) * per_step;
        let size = at.abs() + 64.0 * slope.abs();
        let margin = 1e-3 + terms * per_step.abs() * 1e-14 + size * (1.0 / 2_097_152.0);
        let is_known = size + margin < 1e30;
        Border {
            low: if is_known & (per_step > 0.0) { at - margin } else { f64::NEG_INFINITY } as f32,
            high: if is_known & (per_step < 0.0) { at + margin } else { f64::INFINITY } as f32,
            slope: if is_known { slope } else { 0.0 } as f32,
        }
    }
}

/// Ramp and border of the plane through an edge, which is turned over if `sign` is -1.
#[inline(always)]
fn side(view: &View, plane: &Plane, sign: f64, row: u32) -> (Ramp, Border) {
    let linear = Linear::through_apex(plane, &view.frame, view.reach);
    let steps = [linear.a * view.grid.step[0], linear.b * view.grid.step[1]];
    // An edge that hardly changes over the picture keeps its value in the range of f32.
    let largest = steps[0].abs().max(steps[1].abs()).max(linear.c.abs() * (1.0 / (1u64 << 60) as f64));
    let factor = reciprocal_power_of_two(largest) * sign;
    let spread = linear.spread(&view.grid);
    let turned = Linear { a: linear.a * sign, b: linear.b * sign, c: linear.c * sign, ..linear };
    (Ramp::new(view, &linear, spread, factor), Border::new(view, &turned, spread, row))
}

/// 1 / 2^n of the 2^n next below a positive number; of other numbers, and such as are near the ends of f64, anything.
#[inline(always)]
fn reciprocal_power_of_two(number: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits((2046u64 << 52).wrapping_sub(number.to_bits() & EXPONENT) & EXPONENT)
}

impl Cast {
    /// Of planes whose corners may go round the wrong way, which is so if `sign` is -1: all of them are then turned over,
    /// which is exact. `row` is the first of the triangle's box.
    #[inline(always)]
    fn of_planes(view: &View, planes: &OrientedPlanes, sign: f64, row: u32) -> Cast {
        let own = Linear::through_apex(&planes.own, &view.frame, view.reach);
        let (height, error) = planes.height;
        // An error of the height moves nearness by as much of itself, which 2^-22 of it holds. Otherwise nothing is known.
        let is_known = error < height.abs() * (1.0 / 1_073_741_824.0);
        let spread = if is_known { own.spread(&view.grid) * (1.0 + 1e-8) } else { f64::INFINITY };
        let [a, b, c] = &planes.edges;
        let (a, of_a) = side(view, a, sign, row);
        let (b, of_b) = side(view, b, sign, row);
        let (c, of_c) = side(view, c, sign, row);
        // The height has the same sign as the plane.
        let nearness = Ramp::new(view, &own, spread, 1.0 / height);
        Cast {
            a: [a.a, b.a, c.a, nearness.a],
            b: [a.b, b.b, c.b, nearness.b],
            c: [a.c, b.c, c.c, nearness.c],
            across: [a.step[0], b.step[0], c.step[0], nearness.step[0]],
            down: [a.step[1], b.step[1], c.step[1], nearness.step[1]],
            slack: [a.slack, b.slack, c.slack, nearness.slack],
            borders: [of_a, of_b, of_c],
        }
    }

    /// One of which f64 does not know which way its corners go round; `None` if the camera is in the triangle's plane.
    #[inline(never)]
    fn uncertain(view: &View, primitive: PrimitiveIndex, row: u32) -> Option<Cast> {
        let corners = view.scene.corners(primitive);
        let planes = OrientedPlanes::from_apex(view.apex, corners.map(Vec3::as_dvec3));
        match orientation(view.camera.origin, corners) {
            Sign::Zero => None,
            Sign::Positive => Some(Cast::of_planes(view, &planes, 1.0, row)),
            Sign::Negative => Some(Cast::of_planes(view, &planes, -1.0, row)),
        }
    }

    /// What the functions are at a pixel.
    #[inline(always)]
    pub fn at(&self, view: &View, [column, row]: [u32; 2]) -> [f32; FUNCTIONS] {
        let x = view.grid.origin[0] + view.grid.step[0] * f64::from(column);
        let y = view.grid.origin[1] + view.grid.step[1] * f64::from(row);
        let mut values = [0.0; FUNCTIONS];
        for (i, value) in values.iter_mut().enumerate() {
            *value = (self.a[i] * x + (self.b[i] * y + self.c[i])) as f32;
        }
        values
    }

    /// Of the columns from first to last those that rays of some rows may hit the triangle in: `count` rows, no more than
    /// [`LANES`], the first of which is that far below the first of its box.
    #[inline(always)]
    pub fn spans(&self, [first, last]: [u32; 2], from: u32, count: u32) -> Spans {
        let mut spans = Spans::NOTHING;
        let (first, last) = (first as f32, last as f32);
        for i in 0..LANES {
            let row = from as f32 + i as f32;
            let (mut low, mut high) = (first, last);
            for border in &self.borders {
                let moved = border.slope * row;
                let (after, before) = (border.low + moved, border.high + moved);
                low = if after > low { after } else { low };
                high = if before < high { before } else { high };
            }
            // Where there are none, columns beside those that are looked at.
            low = if low > last { last + 1.0 } else { low };
            high = if high < first { first - 1.0 } else { high };
            let up = low as i32;
            let up = up + i32::from((up as f32) < low);
            let down = (high + 1.0) as i32 - 1;
            let is_there = (up <= down) & (i < count as usize);
            spans.first[i] = if is_there { up } else { i32::MAX };
            spans.last[i] = if is_there { down } else { -1 };
        }
        spans
    }
}

/// The columns of up to sixteen rows, and three without any.
pub(super) struct Spans {
    first: [i32; LANES + 3],
    last: [i32; LANES + 3],
}

impl Spans {
    const NOTHING: Spans = Spans { first: [i32::MAX; LANES + 3], last: [-1; LANES + 3] };

    /// The first and the last column of so many rows from a row on; there are none if the first is larger.
    #[inline(always)]
    pub fn of<const ROWS: usize>(&self, row: usize) -> [i32; 2] {
        let (mut first, mut last) = (i32::MAX, -1);
        for i in row..row + ROWS {
            (first, last) = (first.min(self.first[i]), last.max(self.last[i]));
        }
        [first, last]
    }
}

/// Triangles that are made ready together.
pub(super) const GROUP: usize = 8;

/// A number of each triangle of a group.
type Of<T> = [T; GROUP];

/// A group of triangles. What is of one kind lies together, so that one instruction makes as many as it can.
pub(super) struct Casts {
    primitives: Of<PrimitiveIndex>,
    rows: Of<u32>,
    a: [Of<f64>; FUNCTIONS],
    b: [Of<f64>; FUNCTIONS],
    c: [Of<f64>; FUNCTIONS],
    across: [Of<f32>; FUNCTIONS],
    down: [Of<f32>; FUNCTIONS],
    slack: [Of<f32>; FUNCTIONS],
    low: [Of<f32>; 3],
    high: [Of<f32>; 3],
    slope: [Of<f32>; 3],
    /// Whether f64 knows which way the corners go round.
    is_certain: Of<bool>,
}

impl Casts {
    /// Makes triangles of a band ready; of a shorter group the rest may be any.
    #[inline(always)]
    pub fn new(view: &View, first_row: u32, triangles: &Of<Touched>) -> Casts {
        let mut corners = [[[0.0; GROUP]; 3]; 3];
        let (mut primitives, mut rows) = ([0; GROUP], [0; GROUP]);
        for i in 0..GROUP {
            primitives[i] = triangles[i].primitive;
            rows[i] = triangles[i].rows_from(first_row)[0];
            let vertices = &view.scene.triangles[primitives[i] as usize].vertices;
            for k in 0..3 {
                let vertex = view.scene.vertices[vertices[k] as usize];
                corners[k][0][i] = vertex.x;
                corners[k][1][i] = vertex.y;
                corners[k][2][i] = vertex.z;
            }
        }
        let (doubles, floats) = ([[0.0; GROUP]; FUNCTIONS], [[0.0; GROUP]; FUNCTIONS]);
        let of_sides = [[0.0; GROUP]; 3];
        let mut casts = Casts {
            primitives,
            rows,
            a: doubles,
            b: doubles,
            c: doubles,
            across: floats,
            down: floats,
            slack: floats,
            low: of_sides,
            high: of_sides,
            slope: of_sides,
            is_certain: [false; GROUP],
        };
        casts.prepare(view, &corners);
        casts
    }

    #[inline(always)]
    fn prepare(&mut self, view: &View, [a, b, c]: &[[Of<f32>; 3]; 3]) {
        for i in 0..GROUP {
            let [a, b, c] = [
                DVec3::new(a[0][i].into(), a[1][i].into(), a[2][i].into()),
                DVec3::new(b[0][i].into(), b[1][i].into(), b[2][i].into()),
                DVec3::new(c[0][i].into(), c[1][i].into(), c[2][i].into()),
            ];
            let planes = OrientedPlanes::from_apex(view.apex, [a, b, c]);
            let (height, bound) = planes.height;
            let cast = Cast::of_planes(view, &planes, if height < 0.0 { -1.0 } else { 1.0 }, self.rows[i]);
            for k in 0..FUNCTIONS {
                (self.a[k][i], self.b[k][i], self.c[k][i]) = (cast.a[k], cast.b[k], cast.c[k]);
                (self.across[k][i], self.down[k][i]) = (cast.across[k], cast.down[k]);
                self.slack[k][i] = cast.slack[k];
            }
            for k in 0..3 {
                let Border { low, high, slope } = cast.borders[k];
                (self.low[k][i], self.high[k][i], self.slope[k][i]) = (low, high, slope);
            }
            self.is_certain[i] = height.abs() > bound;
        }
    }

    /// One of them; `None` if the camera is in the triangle's plane.
    #[inline(always)]
    pub fn get(&self, view: &View, i: usize) -> Option<Cast> {
        if !self.is_certain[i] {
            return Cast::uncertain(view, self.primitives[i], self.rows[i]);
        }
        let mut cast = Cast::default();
        for k in 0..FUNCTIONS {
            (cast.a[k], cast.b[k], cast.c[k]) = (self.a[k][i], self.b[k][i], self.c[k][i]);
            (cast.across[k], cast.down[k]) = (self.across[k][i], self.down[k][i]);
            cast.slack[k] = self.slack[k][i];
        }
        for k in 0..3 {
            cast.borders[k] = Border { low: self.low[k][i], high: self.high[k][i], slope: self.slope[k][i] };
        }
        Some(cast)
    }
}
