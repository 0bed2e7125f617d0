//! Triangles as linear functions of the picture: three edges, and how near it is.

use super::bins::Touched;
use super::view::View;
use crate::geometry::Sign;
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
pub(super) struct Ramp {
    a: f64,
    b: f64,
    c: f64,
    /// From one column to the next, and from one row to the next.
    pub step: [f32; 2],
    /// How far the value can be from that of the pixel's ray, as said above; where it is further from 0, its sign is
    /// certain.
    pub slack: f32,
}

/// One edge function, positive inside, scaled so that it changes by about 1 from pixel to pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Side {
    pub ramp: Ramp,
    /// That of the ramp from column to column, before it was rounded.
    step: f64,
    /// As that of the ramp, without what f32 adds.
    slack: f64,
}

/// A triangle that is ready to be drawn.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cast {
    pub sides: [Side; 3],
    /// 1 / depth.
    pub nearness: Ramp,
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
    /// Of the plane through an edge, which is turned over if `sign` is -1.
    #[inline(always)]
    fn new(view: &View, plane: &Plane, sign: f64) -> Side {
        let linear = Linear::through_apex(plane, &view.frame, view.reach);
        let steps = [linear.a * view.grid.step[0], linear.b * view.grid.step[1]];
        // An edge that hardly changes over the picture keeps its value in the range of f32.
        let largest = steps[0].abs().max(steps[1].abs()).max(linear.c.abs() * (1.0 / (1u64 << 60) as f64));
        let factor = reciprocal_power_of_two(largest) * sign;
        let spread = linear.spread(&view.grid);
        Side {
            ramp: Ramp::new(view, &linear, spread, factor),
            step: steps[0] * factor,
            slack: spread * factor.abs(),
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
    /// Of planes whose corners may go round the wrong way, which is so if `sign` is -1: all of them are then turned over,
    /// which is exact.
    #[inline(always)]
    fn of_planes(view: &View, planes: &OrientedPlanes, sign: f64) -> Cast {
        let own = Linear::through_apex(&planes.own, &view.frame, view.reach);
        let (height, error) = planes.height;
        // An error of the height moves nearness by as much of itself, which 2^-22 of it holds. Otherwise nothing is known.
        let is_known = error < height.abs() * (1.0 / 1_073_741_824.0);
        let spread = if is_known { own.spread(&view.grid) * (1.0 + 1e-8) } else { f64::INFINITY };
        let [a, b, c] = &planes.edges;
        Cast {
            sides: [Side::new(view, a, sign), Side::new(view, b, sign), Side::new(view, c, sign)],
            // The height has the same sign as the plane.
            nearness: Ramp::new(view, &own, spread, 1.0 / height),
        }
    }

    /// One of which f64 does not know which way its corners go round; `None` if the camera is in the triangle's plane.
    #[inline(never)]
    fn uncertain(view: &View, primitive: PrimitiveIndex) -> Option<Cast> {
        let corners = view.scene.corners(primitive);
        let planes = OrientedPlanes::from_apex(view.apex, corners.map(Vec3::as_dvec3));
        match orientation(view.camera.origin, corners) {
            Sign::Zero => None,
            Sign::Positive => Some(Cast::of_planes(view, &planes, 1.0)),
            Sign::Negative => Some(Cast::of_planes(view, &planes, -1.0)),
        }
    }
}

/// Triangles that are made ready together.
pub(super) const GROUP: usize = 8;

/// A number of each triangle of a group.
type Of<T> = [T; GROUP];

/// Some function of each triangle of a group, number by number.
#[derive(Default)]
struct Ramps {
    a: Of<f64>,
    b: Of<f64>,
    c: Of<f64>,
    across: Of<f32>,
    down: Of<f32>,
    slack: Of<f32>,
}

/// Some side of each.
#[derive(Default)]
struct Sides {
    ramps: Ramps,
    step: Of<f64>,
    slack: Of<f64>,
}

/// A group of triangles. What is of one kind lies together, so that one instruction makes as many as it can.
pub(super) struct Casts {
    primitives: Of<PrimitiveIndex>,
    sides: [Sides; 3],
    nearness: Ramps,
    /// Whether f64 knows which way the corners go round.
    is_certain: Of<bool>,
}

impl Ramps {
    #[inline(always)]
    fn set(&mut self, i: usize, ramp: Ramp) {
        (self.a[i], self.b[i], self.c[i]) = (ramp.a, ramp.b, ramp.c);
        [self.across[i], self.down[i]] = ramp.step;
        self.slack[i] = ramp.slack;
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Ramp {
        Ramp {
            a: self.a[i],
            b: self.b[i],
            c: self.c[i],
            step: [self.across[i], self.down[i]],
            slack: self.slack[i],
        }
    }
}

impl Sides {
    #[inline(always)]
    fn set(&mut self, i: usize, side: Side) {
        self.ramps.set(i, side.ramp);
        (self.step[i], self.slack[i]) = (side.step, side.slack);
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Side {
        Side { ramp: self.ramps.get(i), step: self.step[i], slack: self.slack[i] }
    }
}

impl Casts {
    /// Makes triangles ready; of a shorter group the rest may be any.
    #[inline(always)]
    pub fn new(view: &View, triangles: &Of<Touched>) -> Casts {
        let mut corners = [[[0.0; GROUP]; 3]; 3];
        let mut primitives = [0; GROUP];
        for i in 0..GROUP {
            primitives[i] = triangles[i].primitive;
            let vertices = &view.scene.triangles[primitives[i] as usize].vertices;
            for k in 0..3 {
                let vertex = view.scene.vertices[vertices[k] as usize];
                corners[k][0][i] = vertex.x;
                corners[k][1][i] = vertex.y;
                corners[k][2][i] = vertex.z;
            }
        }
        let mut casts = Casts {
            primitives,
            sides: [Sides::default(), Sides::default(), Sides::default()],
            nearness: Ramps::default(),
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
            let cast = Cast::of_planes(view, &planes, if height < 0.0 { -1.0 } else { 1.0 });
            let [side, next, last] = cast.sides;
            self.sides[0].set(i, side);
            self.sides[1].set(i, next);
            self.sides[2].set(i, last);
            self.nearness.set(i, cast.nearness);
            self.is_certain[i] = height.abs() > bound;
        }
    }

    /// One of them; `None` if the camera is in the triangle's plane.
    #[inline(always)]
    pub fn get(&self, view: &View, i: usize) -> Option<Cast> {
        if !self.is_certain[i] {
            return Cast::uncertain(view, self.primitives[i]);
        }
        let [a, b, c] = &self.sides;
        Some(Cast { sides: [a.get(i), b.get(i), c.get(i)], nearness: self.nearness.get(i) })
    }
}

/// Where the rows of a wide triangle begin and end.
pub(super) struct Spans<'a> {
    cast: &'a Cast,
    /// 1 / step of each side.
    per_step: [f64; 3],
}

impl Spans<'_> {
    #[inline(always)]
    pub fn of(cast: &Cast) -> Spans<'_> {
        let [a, b, c] = &cast.sides;
        Spans { cast, per_step: [1.0 / a.step, 1.0 / b.step, 1.0 / c.step] }
    }

    /// Of the columns from first to last those that a row's rays may hit the triangle in.
    #[inline(always)]
    pub fn of_row(&self, view: &View, of_row: &[f64; 4], [first, last]: [u32; 2]) -> Option<[u32; 2]> {
        let (mut low, mut high) = (f64::from(first), f64::from(last));
        for ((side, of_row), per_step) in self.cast.sides.iter().zip(of_row).zip(self.per_step) {
            let at_zero = side.ramp.at(*of_row, view.grid.origin[0]) + side.slack;
            let crossing = -at_zero * per_step;
            // A little wider than the roundings of these lines.
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
