//! Queries that headers leave open.

use super::projection::{Projector, ROUNDOFF};
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::visibility::Points;

/// What the lists have to know of a query.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(32))]
pub(super) struct Open {
    /// Its number.
    pub query: u32,
    /// The primitive that it lies on.
    pub base: u32,
    /// Where it is on the side of its cell; NaN, of which no comparison says anything, if f32 does not know.
    pub u: f32,
    pub v: f32,
    /// At most w, and at least.
    pub w_low: f32,
    pub w_high: f32,
}

/// Up to so many are placed at a time.
const PORTION: usize = 16;

/// Some exact points, and where they are on the sides of their cells.
#[derive(Debug, Default)]
#[repr(C, align(64))]
struct Placed {
    /// Position, axis by axis, and side.
    x: [f64; PORTION],
    y: [f64; PORTION],
    z: [f64; PORTION],
    side: [u64; PORTION],
    /// As in [`Open`].
    u: [f32; PORTION],
    v: [f32; PORTION],
    w_low: [f32; PORTION],
    w_high: [f32; PORTION],
}

for_instruction_sets! {
    fn place = place_body, (projector: &Projector, placed: &mut Placed)
}

/// Coordinates are f64 numbers, wrong by half an ulp of theirs. While they are less than 2^20 of its depth, u and v
/// are wrong by 2^-31 H before they are rounded to f32, which takes r R more: together by less than a quarter of
/// [`Projector::delta`], which is 10 r H. w is wrong by 1.1 r of itself then.
#[inline(always)]
fn place_body(_: InstructionSet, projector: &Projector, placed: &mut Placed) {
    let light = projector.light.as_dvec3();
    let half = f64::from(projector.half);
    for i in 0..PORTION {
        let (x, y, z) = (placed.x[i], placed.y[i], placed.z[i]);
        let (dx, dy, dz) = (x - light.x, y - light.y, z - light.z);
        let axis = placed.side[i] / 2;
        let pick = |of: [f64; 3]| {
            if axis == 0 {
                of[0]
            } else if axis == 1 {
                of[1]
            } else {
                of[2]
            }
        };
        let (a, b, c) = (pick([dy, dz, dx]), pick([dz, dx, dy]), pick([dx, dy, dz]));
        let depth = if placed.side[i] % 2 == 1 { -c } else { c };
        let per_depth = 1.0 / depth;
        let (x, y, z) = (x.abs(), y.abs(), z.abs());
        let size = if x > y { x } else { y };
        let size = if size > z { size } else { z };
        let is_known = (a.abs() <= depth)
            & (b.abs() <= depth)
            & (size * per_depth < 1_048_576.0)
            & (depth > 8.7e-19)
            & (depth < 1.1e18);
        let of_known = |value: f32, otherwise: f32| if is_known { value } else { otherwise };
        let w = per_depth as f32;
        placed.u[i] = of_known((a * per_depth * half + half) as f32, f32::NAN);
        placed.v[i] = of_known((b * per_depth * half + half) as f32, f32::NAN);
        placed.w_low[i] = of_known(w * (1.0 - 3.0 * ROUNDOFF), 0.0);
        placed.w_high[i] = of_known(w * (1.0 + 3.0 * ROUNDOFF), f32::INFINITY);
    }
}

/// Open queries by keys that sort them by cell: the cell of each in the upper half, and its number in the lower.
#[derive(Debug, Default)]
pub(super) struct OpenQueries {
    pub keys: Vec<u64>,
}

/// Points that are fetched ahead of those that are placed.
const AHEAD: usize = 2 * PORTION;

impl OpenQueries {
    /// Adds a query in a cell.
    #[inline(always)]
    pub fn push(&mut self, cell: u32, query: u32) {
        self.keys.push(u64::from(cell) << 32 | u64::from(query));
    }

    /// Places all of them, in the order of their keys. `side_of` says the side of a cell.
    #[inline(always)]
    pub fn placed(
        &self,
        set: InstructionSet,
        projector: &Projector,
        points: Points<'_>,
        side_of: impl Fn(u32) -> u32,
    ) -> Vec<Open> {
        let mut all = Vec::with_capacity(self.keys.len());
        let mut placed = Placed::default();
        for (first, keys) in (0..).step_by(PORTION).zip(self.keys.chunks(PORTION)) {
            for &key in self.keys.iter().skip(first + AHEAD).take(PORTION) {
                fetch(&points.exact()[key as u32 as usize].position);
            }
            for (lane, &key) in keys.iter().enumerate() {
                let at = points.exact()[key as u32 as usize].position;
                (placed.x[lane], placed.y[lane], placed.z[lane]) = (at.x, at.y, at.z);
                placed.side[lane] = u64::from(side_of((key >> 32) as u32));
            }
            place(set, projector, &mut placed);
            for (lane, &key) in keys.iter().enumerate() {
                all.push(Open {
                    query: key as u32,
                    base: points.rounded()[key as u32 as usize].primitive_or_most(),
                    u: placed.u[lane],
                    v: placed.v[lane],
                    w_low: placed.w_low[lane],
                    w_high: placed.w_high[lane],
                });
            }
        }
        all
    }

    /// Sorts the keys by cell; none is above `cells`.
    pub fn sort(&mut self, cells: usize) {
        if self.keys.len() < DIGIT_VALUES / 8 {
            return self.keys.sort_unstable();
        }
        let mut sorted = vec![0; self.keys.len()];
        let mut shift = 32;
        while cells >> (shift - 32) != 0 {
            let digit = |key: u64| (key >> shift) as usize & (DIGIT_VALUES - 1);
            let mut next = [0u32; DIGIT_VALUES];
            self.keys.iter().for_each(|&key| next[digit(key)] += 1);
            let mut start = 0;
            for next in &mut next {
                start += std::mem::replace(next, start);
            }
            for &key in &self.keys {
                let next = &mut next[digit(key)];
                sorted[*next as usize] = key;
                *next += 1;
            }
            std::mem::swap(&mut self.keys, &mut sorted);
            shift += DIGIT_VALUES.ilog2();
        }
    }
}

/// Keys are sorted by digits with so many values.
const DIGIT_VALUES: usize = 1 << 12;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::{RoundedPoint, SurfacePoint};
    use glam::{DVec3, Vec3};

    /// What is known of a point, the second of three, whose cell is on the side that looks along x.
    fn open(point: DVec3) -> Open {
        let point = SurfacePoint { position: point, ..SurfacePoint::bare(Vec3::ZERO).expect("finite") };
        let (projector, exact) = (Projector::new(Vec3::new(1.0, 0.0, 0.0), 8), [point; 3]);
        let rounded = RoundedPoint::all(&exact);
        let points = Points::new(&rounded, &exact);
        let of_set = |set: InstructionSet| {
            let mut open = OpenQueries::default();
            open.push(8, 1);
            open.placed(set, &projector, points, |cell| cell - 8)[0]
        };
        let sets = [InstructionSet::Avx2, InstructionSet::Avx512];
        let portable = of_set(InstructionSet::Portable);
        for set in sets.into_iter().filter(|set| set.is_available()) {
            assert_eq!(format!("{:?}", of_set(set)), format!("{portable:?}"));
        }
        portable
    }

    fn is_lost(open: Open) -> bool {
        open.u.is_nan() && open.v.is_nan() && open.w_low == 0.0 && open.w_high == f32::INFINITY
    }

    #[test]
    fn places_and_depths_are_those_of_the_side() {
        let found = open(DVec3::new(5.0, 1.0, -4.0));
        assert_eq!((found.query, found.base), (1, u32::MAX));
        assert_eq!((found.u, found.v), (5.0, 0.0));
        assert!(
            found.w_low < 0.25 && found.w_low > 0.249_999 && found.w_high > 0.25 && found.w_high < 0.250_001
        );
    }

    #[test]
    fn queries_beyond_the_edge_of_their_side_are_lost() {
        for beyond in [DVec3::new(5.0, 4.001, 0.0), DVec3::new(5.0, 0.0, -4.001), DVec3::new(-5.0, 1.0, 1.0)]
        {
            assert!(is_lost(open(beyond)), "{beyond}");
        }
        // In the light itself, and too far away for differences with it to say anything.
        assert!(is_lost(open(DVec3::new(1.0, 0.0, 0.0))));
        assert!(is_lost(open(DVec3::new(1.0 + 1e-7, 0.0, 0.0))));
    }

    #[test]
    fn keys_are_sorted_by_cell_and_keep_their_order() {
        for (count, cells) in [(10u64, 7u64), (5000, 3), (5000, 4096), (20_000, 5_000_000)] {
            let key = |i: u64| (i * 7_654_321 % cells) << 32 | i;
            let mut open = OpenQueries { keys: (0..count).map(key).collect() };
            let mut expected = open.keys.clone();
            expected.sort_unstable();
            open.sort(cells as usize);
            assert_eq!(open.keys, expected);
        }
    }
}
