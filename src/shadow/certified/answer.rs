//! Queries whose cells are known: against headers, and what these leave open against lists.

use super::Certified;
use super::headers::{self, Headers};
use super::is_plain;
use super::making::Lists;
use super::open::{Chunk, OpenQueries};
use super::projection::{Projected, Projector};
use super::receivers::{CHUNK, OPEN};
use super::survey::Cast;
use super::walk::{Walk, walk};
use crate::geometry::LightSpace;
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
}

/// Queries that are being answered, chunk by chunk.
pub(super) struct Answering<'a> {
    asked: &'a Asked<'a>,
    open: OpenQueries,
    undecided: [bool; CHUNK],
}

impl<'a> Answering<'a> {
    /// None yet.
    pub fn new(asked: &'a Asked<'a>) -> Answering<'a> {
        Answering { asked, open: OpenQueries::default(), undecided: [false; CHUNK] }
    }

    /// Answers up to [`CHUNK`] more, the first of which has the number `first`, as far as headers do.
    pub fn add(
        &mut self,
        first: usize,
        points: Points<'_>,
        cells: &[u32],
        depths: &[f32],
        occluded: &mut [bool],
    ) {
        let Asked { certified, projector, size, lists, .. } = self.asked;
        let headers = Headers { projector, size: *size, headers: &lists.headers };
        let undecided = &mut self.undecided[..points.len()];
        headers::decide(certified.set, &headers, cells, depths, occluded, undecided);
        if self.asked.cast == Cast::Plain {
            self.asked.leave_open_what_is_not_cast(points.rounded(), cells, occluded, undecided);
        }
        let chunk = Chunk { first, points, cells, undecided };
        self.open.extend(certified.set, projector, &chunk, |cell| lists.side_of(cell));
    }

    /// Answers what headers left open of all these.
    pub fn finish(mut self, points: Points<'_>, occluded: &mut [bool]) -> Counters {
        let Asked { certified, projector, space, projected, lists, .. } = *self.asked;
        let Certified { scene, set, .. } = certified;
        self.open.sort(lists.headers.len());
        let OpenQueries { all, keys, .. } = self.open;
        let mut counters =
            Counters { cells: points.len() as u64, lists: all.len() as u64, ..Counters::default() };
        let shared = Walk { scene, space, points: points.exact(), projected, lists, delta: projector.delta };
        walk(set, &shared, &all, &keys, occluded, &mut counters);
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
            answering.add(first, chunk, cells, depths, &mut occluded[first..first + chunk.len()]);
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

/// The sum of what some did.
pub(super) fn sum(mut one: Counters, other: Counters) -> Counters {
    one += other;
    one
}
