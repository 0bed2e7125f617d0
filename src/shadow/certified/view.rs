//! All queries of a view at once, with nothing made where nobody asks.

use super::answer::{Asked, QUERIES, sum};
use super::bins::{Bins, Budget};
use super::lists::{Lister, Stored};
use super::projection::Projector;
use super::receivers::Filed;
use super::stored::{Header, Run};
use super::tiles::AREA;
use super::{Certified, Counters, MOST_BYTES, Work};
use crate::error::Result;
use crate::float_environment::StandardFloats;
use crate::geometry::LightSpace;
use crate::memory::MemoryLimit;
use crate::visibility::Points;
use rayon::prelude::*;

impl Certified<'_> {
    /// Sets `occluded[i]` to whether one of the triangles blocks the open segment between point i and the light.
    /// With fewer cells than asked for where their lists would need more memory than there may be.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::error::Error::Usage) for a resolution outside 1 to 4096, 2^28 triangles and more, or too little memory for what does not
    /// depend on the resolution, or for one cell along an edge.
    pub fn occluded(&self, points: Points<'_>, resolution: u32, occluded: &mut [bool]) -> Result<Work> {
        let _floats = StandardFloats::new();
        let of_points = points.len() * (size_of::<u32>() + size_of::<f32>() + 3);
        let memory = self.checked(resolution, of_points)?;
        let make = |resolution| Ok(self.at_resolution(points, resolution, memory, occluded));
        let work = self.with_fewer_cells(resolution, make)?;
        Ok(Work { bytes: work.bytes + (of_points + self.fixed_bytes()) as u64, ..work })
    }

    /// The same, or `None` if the lists of that many cells are too long.
    fn at_resolution(
        &self,
        points: Points<'_>,
        resolution: u32,
        memory: MemoryLimit,
        occluded: &mut [bool],
    ) -> Option<Work> {
        let scene = self.scene;
        let projector = Projector::new(self.light, resolution);
        let filed = Filed::new(self.set, &projector, scene, points);
        let projected = self.projected(&projector);
        let Filed { windows, horizon, .. } = &filed;
        let cells = filed.tiles.len() * AREA as usize;
        let cell_bytes = cells * (size_of::<Header>() + size_of::<Run>() + size_of::<u32>())
            + windows.count() * size_of::<u32>();
        let budget = Budget::new(memory.left().saturating_sub(cell_bytes as u64).min(MOST_BYTES) as usize);
        let mut survey = self.survey(projector, *windows, horizon, &projected);
        let bins = self.bins(&mut survey, &budget)?;
        let lister = Lister {
            scene,
            projector,
            windows: *windows,
            horizon,
            projected: &projected,
            bins: &bins,
            budget: &budget,
        };
        let stored: Vec<_> = filed.tiles.iter().map(|&tile| Stored { level: 0, tile }).collect();
        let lists = self.lists(&[lister], None, &stored)?;
        let bin_bytes: usize = bins.iter().map(Bins::bytes).sum();
        let mut work = Work {
            bytes: (lists.bytes() + bin_bytes + cells * size_of::<u32>()) as u64,
            ..lists.work(resolution)
        };
        drop(bins);
        let (size, space) = (self.size(), LightSpace::from(self.light));
        let asked = Asked {
            certified: *self,
            cast: survey.cast,
            projector: &projector,
            space: &space,
            size,
            projected: &projected,
            lists: &lists,
            has_verdicts: false,
        };
        let Filed { cells, depths, .. } = &filed;
        work.counters = (points.par_chunks(QUERIES), cells.par_chunks(QUERIES), depths.par_chunks(QUERIES))
            .into_par_iter()
            .zip(occluded.par_chunks_mut(QUERIES))
            .map(|((points, cells, depths), occluded)| {
                let _floats = StandardFloats::new();
                asked.answer(points, cells, depths, occluded)
            })
            .reduce(Counters::default, sum);
        work.by_header = work.counters.cells - work.counters.lists;
        Some(work)
    }
}
