//! Queries whose cells are known: against headers, and what these leave open against lists.

use super::Certified;
use super::headers::{self, Headers};
use super::is_plain;
use super::making::Lists;
use super::open::OpenQueries;
use super::projection::{Projected, Projector};
use super::receivers::{CHUNK, OPEN};
use super::survey::Cast;
use super::walk::{Walk, walk};
use crate::geometry::LightSpace;
use crate::shadow::Counters;
use crate::visibility::SurfacePoint;

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

impl Asked<'_> {
    /// Answers up to [`QUERIES`] queries by their cells and depths.
    pub fn answer(
        &self,
        points: &[SurfacePoint],
        cells: &[u32],
        depths: &[f32],
        occluded: &mut [bool],
    ) -> Counters {
        let Certified { scene, set, .. } = self.certified;
        let headers = Headers { projector: self.projector, size: self.size, headers: &self.lists.headers };
        let mut open = OpenQueries::default();
        let side_of = |cell| self.lists.side_of(cell);
        for first in (0..points.len()).step_by(CHUNK) {
            let chunk = first..points.len().min(first + CHUNK);
            let (points, cells) = (&points[chunk.clone()], &cells[chunk.clone()]);
            let occluded = &mut occluded[chunk.clone()];
            let mut undecided = [false; CHUNK];
            let undecided = &mut undecided[..chunk.len()];
            headers::decide(set, &headers, cells, &depths[chunk], occluded, undecided);
            if self.cast == Cast::Plain {
                self.leave_open_what_is_not_cast(points, cells, occluded, undecided);
            }
            open.extend(self.projector, first, points, cells, undecided, side_of);
        }
        open.sort(headers.headers.len());
        let OpenQueries { all, keys } = open;
        let mut counters =
            Counters { cells: points.len() as u64, lists: all.len() as u64, ..Counters::default() };
        let (projected, lists) = (self.projected, self.lists);
        let shared = Walk { scene, space: self.space, points, projected, lists, delta: self.projector.delta };
        walk(set, &shared, &all, &keys, occluded, &mut counters);
        counters
    }

    /// Certificates light what lies on a triangle that is cast; all else that is not dark asks the lists.
    fn leave_open_what_is_not_cast(
        &self,
        points: &[SurfacePoint],
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
