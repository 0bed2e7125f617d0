//! Triangles from all of whose points a light is seen, or from none: their queries need neither place nor cell.

use super::verdict::Verdict;
use crate::geometry::batch::{InstructionSet, LANES};
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::geometry::masks::{Bits, bits};
use crate::visibility::RoundedPoint;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// In some cell the triangle is not lit as a whole, for all that is known.
const NOT_LIT: u8 = 1;
/// In some cell it is not dark as a whole.
const NOT_DARK: u8 = 2;

/// What the cells of a triangle say of it, put together; those of a triangle that is in no cell say nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct State(u8);

impl State {
    /// Adds what one more cell says.
    #[inline(always)]
    pub fn add(&mut self, verdict: Verdict) {
        self.0 |= match verdict {
            Verdict::Open => NOT_LIT | NOT_DARK,
            Verdict::Lit => NOT_DARK,
            Verdict::Dark => NOT_LIT,
        };
    }
}

/// The states of all triangles, while cells are made.
pub(super) struct States(Vec<AtomicU8>);

impl States {
    /// Of so many triangles, in no cell yet. One more is always open.
    pub fn new(triangles: usize) -> States {
        States((0..=triangles).map(|_| AtomicU8::new(0)).collect())
    }

    /// Adds what some cells say.
    #[inline(always)]
    pub fn add(&self, triangle: u32, State(state): State) {
        let of_triangle = &self.0[triangle as usize];
        if of_triangle.load(Relaxed) & state != state {
            of_triangle.fetch_or(state, Relaxed);
        }
    }

    /// When all cells are made.
    pub fn finish(self) -> ByTriangle {
        let word = |states: &[AtomicU8]| {
            states.iter().rev().fold(0, |word, state| word << BITS | u32::from(state.load(Relaxed)))
        };
        ByTriangle { words: self.0.chunks(PER_WORD).map(word).collect(), last: self.0.len() as u32 - 1 }
    }
}

/// How far ahead points are fetched, four of which are in a line of the cache.
const AHEAD: usize = 256;
/// One of so many points is a sample.
const SAMPLED: usize = 64;
/// Bits of a state.
const BITS: u32 = 2;
/// States in a word.
const PER_WORD: usize = (u32::BITS / BITS) as usize;

/// The states of all triangles, packed: as few lines of the cache as can be.
pub(super) struct ByTriangle {
    words: Vec<u32>,
    /// The number of the last, which is nothing's and open.
    last: u32,
}

impl ByTriangle {
    /// The state of a triangle.
    #[inline(always)]
    fn state(&self, triangle: u32) -> u32 {
        let triangle = if triangle < self.last { triangle } else { self.last };
        // SAFETY: there is a word for every number up to the last.
        let word = unsafe { *self.words.get_unchecked(triangle as usize / PER_WORD) };
        word >> (triangle % PER_WORD as u32 * BITS) & ((1 << BITS) - 1)
    }

    /// Whether so many of some points lie on triangles that are lit or dark as a whole that it is worth asking for all: one in four, of a few.
    #[inline(always)]
    pub fn is_worth_asking(&self, points: &[RoundedPoint]) -> bool {
        let (mut asked, mut answered) = (0, 0);
        for point in points.iter().step_by(SAMPLED) {
            let state = self.state(point.primitive_or_most());
            asked += 1;
            answered += u32::from((state == u32::from(NOT_LIT)) | (state == u32::from(NOT_DARK)));
        }
        4 * answered > asked
    }

    /// Answers for points on triangles that are lit or dark as a whole. Returns how many others there are, whose numbers and points are the first of
    /// `numbers` and `open`.
    pub fn answer(
        &self,
        set: InstructionSet,
        points: &[RoundedPoint],
        occluded: &mut [bool],
        numbers: &mut [u32],
        open: &mut [RoundedPoint],
    ) -> usize {
        let mut found = 0;
        answer(set, self, points, occluded, &mut Open { numbers, points: open, found: &mut found });
        found
    }

    /// Triangles that are lit, and dark, as a whole.
    pub fn counts(&self) -> [u64; 2] {
        let of = |state| (0..self.last).filter(|&triangle| self.state(triangle) == state).count() as u64;
        [NOT_DARK, NOT_LIT].map(|state| of(u32::from(state)))
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.words[..])
    }
}

/// Points whose triangle does not answer for them.
struct Open<'a> {
    numbers: &'a mut [u32],
    points: &'a mut [RoundedPoint],
    found: &'a mut usize,
}

impl Open<'_> {
    /// Appends those of up to sixteen points that have a bit in `open`. Mostly these are all or none.
    #[inline(always)]
    fn extend(&mut self, first: usize, points: &[RoundedPoint], open: u32) {
        let found = *self.found;
        if open == u32::MAX >> (32 - points.len()) {
            let end = found + points.len();
            self.points[found..end].copy_from_slice(points);
            for (number, i) in self.numbers[found..end].iter_mut().zip(first as u32..) {
                *number = i;
            }
            *self.found = end;
            return;
        }
        for (place, i) in (found..).zip(Bits(open)) {
            (self.numbers[place], self.points[place]) = ((first + i) as u32, points[i]);
        }
        *self.found = found + open.count_ones() as usize;
    }
}

for_instruction_sets! {
    fn answer = answer_body, (
        states: &ByTriangle,
        points: &[RoundedPoint],
        occluded: &mut [bool],
        open: &mut Open<'_>,
    )
}

#[inline(always)]
fn answer_body(
    set: InstructionSet,
    states: &ByTriangle,
    points: &[RoundedPoint],
    occluded: &mut [bool],
    open: &mut Open<'_>,
) {
    let all = points;
    for (some, (points, occluded)) in points.chunks(LANES).zip(occluded.chunks_mut(LANES)).enumerate() {
        for ahead in all.iter().skip(some * LANES + AHEAD).step_by(4).take(LANES / 4) {
            fetch(ahead);
        }
        let mut of_points = [0u32; LANES];
        for (state, point) in of_points.iter_mut().zip(points) {
            *state = point.primitive_or_most();
        }
        let mut is_open = [0u32; LANES];
        for i in 0..LANES {
            let state = states.state(of_points[i]);
            is_open[i] = u32::from((state != u32::from(NOT_LIT)) & (state != u32::from(NOT_DARK)));
            of_points[i] = state;
        }
        for (occluded, state) in occluded.iter_mut().zip(&of_points) {
            *occluded = *state == u32::from(NOT_LIT);
        }
        let there = u32::MAX >> (32 - points.len());
        let is_open = bits(set, &is_open) & there;
        if is_open != 0 {
            open.extend(some * LANES, points, is_open);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::{PointSource, SurfacePoint};
    use glam::{DVec3, Vec3};

    #[test]
    fn only_what_all_cells_agree_on_is_answered() {
        use Verdict::{Dark, Lit, Open};
        let states = States::new(7);
        let cells: [&[Verdict]; 7] =
            [&[Lit], &[Dark], &[Lit, Dark], &[], &[Lit, Open], &[Dark, Dark], &[Open]];
        for (triangle, verdicts) in (0..).zip(cells) {
            for &verdict in verdicts {
                let mut state = State::default();
                state.add(verdict);
                states.add(triangle, state);
            }
        }
        let by_triangle = states.finish();
        assert_eq!(by_triangle.counts(), [1, 2]);
        let on = |primitive| {
            let source = PointSource::Ray { origin: Vec3::ZERO, direction: Vec3::X, primitive };
            RoundedPoint::from(&SurfacePoint { position: DVec3::splat(primitive.into()), source })
        };
        let mut points: Vec<_> = (0..9).map(on).collect();
        points.push(RoundedPoint::from(&SurfacePoint::bare(Vec3::ONE).expect("finite")));
        let (mut occluded, mut numbers, mut open) = ([true; 10], [99; 10], points.clone());
        let set = InstructionSet::Portable;
        assert_eq!(by_triangle.answer(set, &points, &mut occluded, &mut numbers, &mut open), 7);
        assert_eq!(numbers[..7], [2, 3, 4, 6, 7, 8, 9]);
        assert!(numbers[..7].iter().zip(&open).all(|(&number, open)| *open == points[number as usize]));
        assert_eq!([occluded[0], occluded[1], occluded[5]], [false, true, true]);
    }
}
