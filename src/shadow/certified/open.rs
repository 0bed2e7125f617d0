//! Queries that headers leave open.

use super::projection::{Projector, ROUNDOFF};
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::scene::PrimitiveIndex;
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

/// Queries that were held against headers.
pub(super) struct Chunk<'a> {
    /// The number of the first.
    pub first: usize,
    pub points: Points<'a>,
    pub cells: &'a [u32],
    pub undecided: &'a [bool],
}

/// Open queries, and keys that sort them by cell.
#[derive(Debug, Default)]
pub(super) struct OpenQueries {
    pub all: Vec<Open>,
    /// The cell of each in the upper half, and its place in `all` in the lower.
    pub keys: Vec<u64>,
    /// Those of a chunk: all are on their way from memory before the first is looked at.
    found: Vec<u32>,
}

impl OpenQueries {
    /// Appends the undecided queries of a chunk. `side_of` says the side of a cell.
    #[inline(always)]
    pub fn extend(
        &mut self,
        set: InstructionSet,
        projector: &Projector,
        chunk: &Chunk<'_>,
        side_of: impl Fn(u32) -> u32,
    ) {
        let Chunk { first, points, cells, undecided } = *chunk;
        self.found.clear();
        for (eight, undecided) in undecided.chunks(8).enumerate() {
            // Mostly none of them.
            if !undecided.contains(&true) {
                continue;
            }
            for (i, _) in (8 * eight..).zip(undecided).filter(|(_, undecided)| **undecided) {
                fetch(&points.exact()[i].position);
                self.found.push(i as u32);
            }
        }
        let mut placed = Placed::default();
        for found in self.found.chunks(PORTION) {
            for (lane, &i) in found.iter().enumerate() {
                let at = points.exact()[i as usize].position;
                (placed.x[lane], placed.y[lane], placed.z[lane]) = (at.x, at.y, at.z);
                placed.side[lane] = u64::from(side_of(cells[i as usize]));
            }
            place(set, projector, &mut placed);
            for (lane, &i) in found.iter().enumerate() {
                let (query, point) = (first as u32 + i, &points.rounded()[i as usize]);
                self.keys.push(u64::from(cells[i as usize]) << 32 | self.all.len() as u64);
                self.all.push(Open {
                    query,
                    base: point.primitive().unwrap_or(PrimitiveIndex::MAX),
                    u: placed.u[lane],
                    v: placed.v[lane],
                    w_low: placed.w_low[lane],
                    w_high: placed.w_high[lane],
                });
            }
        }
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

    /// What is known of a point, the second of a chunk that begins with query 3, whose cell is on the side that looks along x.
    fn open(point: DVec3) -> Open {
        let point = SurfacePoint { position: point, ..SurfacePoint::bare(Vec3::ZERO).expect("finite") };
        let (projector, exact) = (Projector::new(Vec3::new(1.0, 0.0, 0.0), 8), [point; 3]);
        let rounded = RoundedPoint::all(&exact);
        let points = Points::new(&rounded, &exact);
        let of_set = |set: InstructionSet| {
            let mut open = OpenQueries::default();
            let undecided = [false, true, false];
            let chunk = Chunk { first: 3, points, cells: &[7, 8, 9], undecided: &undecided };
            open.extend(set, &projector, &chunk, |_| 0);
            assert_eq!(open.keys, [8 << 32]);
            open.all[0]
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
        assert_eq!((found.query, found.base), (4, PrimitiveIndex::MAX));
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
            let mut open = OpenQueries { keys: (0..count).map(key).collect(), ..OpenQueries::default() };
            let mut expected = open.keys.clone();
            expected.sort_unstable();
            open.sort(cells as usize);
            assert_eq!(open.keys, expected);
        }
    }
}
