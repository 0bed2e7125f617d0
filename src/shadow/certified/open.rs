//! Queries that headers leave open.

use super::projection::{Projector, ROUNDOFF};
use crate::geometry::fetch::fetch;
use crate::scene::PrimitiveIndex;
use crate::visibility::SurfacePoint;

/// What the lists have to know of a query.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(32))]
pub(super) struct Open {
    /// Its number.
    pub query: u32,
    /// The primitive that it lies on.
    pub base: u32,
    /// Where it is on the side of its cell.
    pub u: f32,
    pub v: f32,
    /// Whether f32 knows nothing of that.
    pub is_lost: bool,
    /// At most w, and at least.
    pub w_low: f32,
    pub w_high: f32,
}

impl Open {
    /// A query whose cell is on a side.
    ///
    /// Its coordinates are f64 numbers, wrong by half an ulp of theirs. While they are less than 2^20 of its depth, u and v
    /// are wrong by 2^-31 H before they are rounded to f32, which takes r R more: together by less than a quarter of
    /// [`Projector::delta`], which is 10 r H. w is wrong by 1.1 r of itself then.
    #[inline(always)]
    pub fn new(projector: &Projector, side: u32, query: u32, point: &SurfacePoint) -> Open {
        let at = point.position;
        let offset = at - projector.light.as_dvec3();
        let [a, b, c] = match side / 2 {
            0 => [offset.y, offset.z, offset.x],
            1 => [offset.z, offset.x, offset.y],
            _ => [offset.x, offset.y, offset.z],
        };
        let depth = if side % 2 == 1 { -c } else { c };
        let (per_depth, half) = (1.0 / depth, f64::from(projector.half));
        let (u, v) = ((a * per_depth * half + half) as f32, (b * per_depth * half + half) as f32);
        let w = per_depth as f32;
        let is_known = (a.abs() <= depth)
            & (b.abs() <= depth)
            & (at.x.abs().max(at.y.abs()).max(at.z.abs()) * per_depth < 1_048_576.0)
            & (depth > 8.7e-19)
            & (depth < 1.1e18);
        let base = point.primitive().unwrap_or(PrimitiveIndex::MAX);
        let (w_low, w_high) = match is_known {
            true => (w * (1.0 - 3.0 * ROUNDOFF), w * (1.0 + 3.0 * ROUNDOFF)),
            false => (0.0, f32::INFINITY),
        };
        Open { query, base, u, v, is_lost: !is_known, w_low, w_high }
    }
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
    /// Appends the undecided queries of a chunk, the first of which has the number `first`. `side_of` says the side of a cell.
    #[inline(always)]
    pub fn extend(
        &mut self,
        projector: &Projector,
        first: usize,
        points: &[SurfacePoint],
        cells: &[u32],
        undecided: &[bool],
        side_of: impl Fn(u32) -> u32,
    ) {
        self.found.clear();
        for (eight, undecided) in undecided.chunks(8).enumerate() {
            // Mostly none of them.
            if !undecided.contains(&true) {
                continue;
            }
            for (i, _) in (8 * eight..).zip(undecided).filter(|(_, undecided)| **undecided) {
                fetch(&points[i].position);
                fetch(&points[i].source);
                self.found.push(i as u32);
            }
        }
        for i in self.found.iter().map(|&i| i as usize) {
            self.keys.push(u64::from(cells[i]) << 32 | self.all.len() as u64);
            self.all.push(Open::new(projector, side_of(cells[i]), (first + i) as u32, &points[i]));
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
    use glam::{DVec3, Vec3};

    /// What is known of a point whose cell is on the side that looks along x.
    fn open(point: DVec3) -> Open {
        let point = SurfacePoint { position: point, ..SurfacePoint::bare(Vec3::ZERO).expect("finite") };
        Open::new(&Projector::new(Vec3::new(1.0, 0.0, 0.0), 8), 0, 3, &point)
    }

    #[test]
    fn places_and_depths_are_those_of_the_side() {
        let found = open(DVec3::new(5.0, 1.0, -4.0));
        assert_eq!((found.query, found.base, found.is_lost), (3, PrimitiveIndex::MAX, false));
        assert_eq!((found.u, found.v), (5.0, 0.0));
        assert!(
            found.w_low < 0.25 && found.w_low > 0.249_999 && found.w_high > 0.25 && found.w_high < 0.250_001
        );
    }

    #[test]
    fn queries_beyond_the_edge_of_their_side_are_lost() {
        for beyond in [DVec3::new(5.0, 4.001, 0.0), DVec3::new(5.0, 0.0, -4.001), DVec3::new(-5.0, 1.0, 1.0)]
        {
            let found = open(beyond);
            assert!(found.is_lost && found.w_low == 0.0 && found.w_high == f32::INFINITY, "{beyond}");
        }
        // In the light itself, and too far away for differences with it to say anything.
        assert!(open(DVec3::new(1.0, 0.0, 0.0)).is_lost);
        assert!(open(DVec3::new(1.0 + 1e-7, 0.0, 0.0)).is_lost);
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
