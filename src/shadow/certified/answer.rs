//! Queries whose cells are known: against headers, and what these leave open against lists.

use super::Certified;
use super::headers::{self, Headers};
use super::is_plain;
use super::judge;
use super::making::Lists;
use super::open::OpenQueries;
use super::projection::{Projected, Projector};
use super::receivers::OPEN;
use super::selected::{CHUNK, Selected};
use super::stored::Record;
use super::survey::Cast;
use super::verdict::{self, Verdict};
use super::walk::{Walk, walk};
use crate::geometry::LightSpace;
use crate::scene::PrimitiveIndex;
use crate::shadow::Counters;
use crate::visibility::{Points, RoundedPoint};

/// Queries of a task: those of a cell come together, and all that is looked up is near.
pub(super) const QUERIES: usize = 1 << 15;

/// What queries are held against.
pub(super) struct Asked<'a> {
    pub certified: Certified<'a>,
    pub cast: Cast,
    pub projector: &'a Projector,
    pub space: &'a LightSpace,
    /// No coordinate of a triangle is larger.
    pub size: f32,
    /// The scene's vertices.
    pub projected: &'a [Projected],
    pub lists: &'a Lists,
    /// Whether they hold verdicts.
    pub has_verdicts: bool,
}

/// Queries that are being answered, chunk by chunk.
pub(super) struct Answering<'a> {
    asked: &'a Asked<'a>,
    open: OpenQueries,
    dark: [bool; CHUNK],
    undecided: [bool; CHUNK],
}

impl<'a> Answering<'a> {
    /// None yet.
    pub fn new(asked: &'a Asked<'a>) -> Answering<'a> {
        let (dark, undecided) = ([false; CHUNK], [false; CHUNK]);
        Answering { asked, open: OpenQueries::default(), dark, undecided }
    }

    /// Answers some of up to [`CHUNK`] more, the first of which has the number `first`, as far as headers do. `occluded` are the answers of
    /// all of these.
    pub fn add(
        &mut self,
        first: usize,
        points: Selected<'_>,
        cells: &[u32],
        depths: &[f32],
        occluded: &mut [bool],
    ) {
        let Asked { certified, projector, size, lists, .. } = self.asked;
        let headers = Headers { projector, size: *size, headers: &lists.headers };
        let (dark, undecided) = (&mut self.dark[..points.len()], &mut self.undecided[..points.len()]);
        headers::decide(certified.set, &headers, cells, depths, dark, undecided);
        if self.asked.cast == Cast::Plain {
            self.asked.leave_open_what_is_not_cast(points.rounded(), cells, dark, undecided);
        }
        for (&number, &dark) in points.numbers().iter().zip(&*dark) {
            occluded[number as usize] = dark;
        }
        for (eight, undecided) in undecided.chunks(8).enumerate() {
            // Mostly none of them.
            if !undecided.contains(&true) {
                continue;
            }
            for (i, _) in (8 * eight..).zip(undecided).filter(|(_, undecided)| **undecided) {
                self.open.push(cells[i], first as u32 + points.numbers()[i]);
            }
        }
    }

    /// Answers what headers left open of all these.
    pub fn finish(mut self, points: Points<'_>, occluded: &mut [bool]) -> Counters {
        let Asked { certified, projector, space, projected, lists, .. } = *self.asked;
        let Certified { scene, light, set, .. } = certified;
        self.open.sort(lists.headers.len());
        if self.asked.has_verdicts {
            ask_verdicts(lists, points.rounded(), &mut self.open.keys, occluded);
        }
        let open = self.open.placed(set, projector, points, |cell| lists.side_of(cell));
        let mut counters =
            Counters { cells: points.len() as u64, lists: open.len() as u64, ..Counters::default() };
        let shared =
            Walk { scene, light, space, points: points.exact(), projected, lists, delta: projector.delta };
        walk(set, &shared, &open, &self.open.keys, occluded, &mut counters);
        counters
    }
}

impl Asked<'_> {
    /// Answers up to [`QUERIES`] queries by their cells and depths.
    pub fn answer(
        &self,
        points: Points<'_>,
        cells: &[u32],
        depths: &[f32],
        occluded: &mut [bool],
    ) -> Counters {
        let mut answering = Answering::new(self);
        let chunks = points.chunks(CHUNK).zip(cells.chunks(CHUNK)).zip(depths.chunks(CHUNK));
        for (i, ((chunk, cells), depths)) in chunks.enumerate() {
            let first = i * CHUNK;
            let occluded = &mut occluded[first..first + chunk.len()];
            answering.add(first, Selected::all(chunk), cells, depths, occluded);
        }
        answering.finish(points, occluded)
    }

    /// Certificates light what lies on a triangle that is cast; all else that is not dark asks the lists.
    fn leave_open_what_is_not_cast(
        &self,
        points: &[RoundedPoint],
        cells: &[u32],
        occluded: &[bool],
        undecided: &mut [bool],
    ) {
        let is_cast = |primitive| is_plain(self.certified.scene, primitive);
        for (i, point) in points.iter().enumerate() {
            let may_be_lit = point.primitive().is_some_and(is_cast) || cells[i] == OPEN;
            undecided[i] |= !may_be_lit && !occluded[i];
        }
    }
}

/// Lists are fetched so many queries ahead.
const AHEAD: usize = 32;

/// Answers queries for which the list of their cell has a verdict on their triangle, and takes them away. Those of a cell follow each other.
fn ask_verdicts(lists: &Lists, points: &[RoundedPoint], keys: &mut Vec<u64>, occluded: &mut [bool]) {
    let cell_of = |key: u64| (key >> 32) as usize;
    let (mut cell, mut records): (_, &[Record]) = (usize::MAX, &[]);
    let (mut triangle, mut verdict) = (PrimitiveIndex::MAX, Verdict::Open);
    let mut left = 0;
    for i in 0..keys.len() {
        let key = keys[i];
        if let Some(&key) = keys.get(i + 2 * AHEAD) {
            lists.fetch(cell_of(key));
        }
        if let Some(&key) = keys.get(i + AHEAD)
            && cell_of(key) != cell_of(keys[i + AHEAD - 1])
        {
            lists.fetch_records(cell_of(key));
        }
        let query = key as u32 as usize;
        let of_query = points[query].primitive_or_most();
        let is_new = cell_of(key) != cell;
        if is_new {
            (cell, records) = (cell_of(key), lists.of(cell_of(key)));
        }
        if is_new || of_query != triangle {
            triangle = of_query;
            verdict = match records.len() {
                ..=judge::MOST => verdict::find(records.iter().map(|record| &record.listed), triangle),
                _ => Verdict::Open,
            };
        }
        occluded[query] |= verdict == Verdict::Dark;
        keys[left] = key;
        left += usize::from(verdict == Verdict::Open);
    }
    keys.truncate(left);
}

/// The sum of what some did.
pub(super) fn sum(mut one: Counters, other: Counters) -> Counters {
    one += other;
    one
}
