//! Cells of all that a light sees, kept for whatever is asked later: the light buffer.

use super::answer::{Answering, Asked, QUERIES, sum};
use super::automatic;
use super::bins::{Budget, touched};
use super::certificate::{Header, Record, Run};
use super::layers::is_crowded;
use super::levels::{FINER, Levels};
use super::making::Lists;
use super::projection::{Projected, Projector};
use super::receivers::{CHUNK, Horizon};
use super::survey::Cast;
use super::tiles::{AREA, TileGrid};
use super::{Certified, Counters, MOST_BYTES, MOST_CELLS, Work};
use crate::error::Result;
use crate::float_environment::StandardFloats;
use crate::geometry::LightSpace;
use crate::memory::MemoryLimit;
use crate::visibility::Points;
use rayon::prelude::*;

/// The resolution at which is looked where triangles lie.
const FEW_CELLS: u32 = 256;

/// Levels of cells where nobody says how many cells there are to be.
const LEVELS: usize = 2;

/// Resolutions are looked at in these steps.
const STEP: u32 = 64;

/// Fewer than this save no memory that would be worth it.
const LEAST_CELLS: u32 = 32;

/// More cells on a side than so many for each triangle are of no use: small scenes are as fast with few.
const MOST_A_TRIANGLE: u64 = 64;

/// Headers and lists of all cells that a light's triangles lie in.
pub struct Kept<'a> {
    certified: Certified<'a>,
    space: LightSpace,
    cast: Cast,
    /// No coordinate of a triangle is larger.
    size: f32,
    levels: Levels,
    /// The scene's vertices, on the finest cells.
    projected: Vec<Projected>,
    lists: Lists,
    work: Work,
}

/// What needs memory, in words.
fn what(resolution: u32) -> String {
    format!("a light buffer of {resolution} cells along an edge")
}

impl<'a> Certified<'a> {
    /// Makes cells that are good for any query. With fewer than asked for where their lists would be longer than lists are made, whatever
    /// memory there is: thousands of triangles before one another that fill every cell. [`Kept::work`] says how many there are.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::error::Error::Usage) for a resolution outside 1 to 4096, 2^28 triangles and more, or more memory than there may be.
    pub fn keep(self, resolution: u32) -> Result<Kept<'a>> {
        let _floats = StandardFloats::new();
        let memory = self.checked(resolution, 0)?;
        self.keep_at_most(resolution, 1, memory)
    }

    /// The same with as many cells as are of use and need no more than so many bytes, if that can be: large ones, and small ones
    /// where many triangles lie.
    ///
    /// # Errors
    /// As [`keep`](Certified::keep), if the fewest cells need too much.
    pub fn keep_within(self, bytes: u64) -> Result<Kept<'a>> {
        let _floats = StandardFloats::new();
        let memory = self.checked(1, 0)?;
        let mut resolution = self.resolution_within(bytes, memory);
        loop {
            let kept = self.keep_at_most(resolution, LEVELS, memory);
            let is_small = kept.as_ref().is_ok_and(|kept| kept.bytes() as u64 <= bytes);
            if is_small || resolution <= LEAST_CELLS {
                return kept;
            }
            // What cells need grows with their number.
            let share = kept.map_or(0.5, |kept| (bytes as f64 / kept.bytes() as f64).sqrt().clamp(0.25, 1.0));
            resolution = (f64::from(resolution) * share * 0.95) as u32;
        }
    }

    /// The most cells for which so many bytes are to be expected: what a few cells show of the part of the directions in which triangles
    /// lie, and many of them, a header each, records of triangles in so many cells as they are wide and high, and vertices.
    fn resolution_within(&self, bytes: u64, memory: MemoryLimit) -> u32 {
        let projector = Projector::new(self.light, FEW_CELLS);
        let grid = TileGrid::new(FEW_CELLS);
        let (projected, horizon) = (self.projected(&projector), Horizon::endless(&grid));
        let mut survey = self.survey(projector, grid, &horizon, &projected);
        let budget = Budget::new(memory.left().min(MOST_BYTES) as usize);
        let Some(bins) = self.bins(&mut survey, &budget) else { return LEAST_CELLS };
        // Of small cells the crowded tiles have as many as all would, if the others had them.
        let tiles = touched(&bins, &grid).map(|tile| match is_crowded(&bins, tile) {
            true => f64::from(FINER * FINER),
            false => 1.0,
        });
        let tiles: f64 = tiles.sum();
        let triangles = self.scene.triangles.len() as u64;
        let a_cell = (size_of::<Header>() + size_of::<Run>() + size_of::<Record>()) as f64;
        let size = self.size_of_triangles();
        let expected = |resolution: u32| {
            let large = f64::from(resolution) / f64::from(FINER * FEW_CELLS);
            let across = size * f64::from(resolution) / f64::from(automatic::CELLS);
            let of_records = triangles as f64 * (2.0 + across) * size_of::<Record>() as f64;
            (tiles * f64::from(AREA) * large * large * a_cell + of_records) as u64 + self.fixed_bytes() as u64
        };
        let is_enough = |resolution: &u32| {
            expected(*resolution) <= bytes && u64::from(*resolution).pow(2) <= MOST_A_TRIANGLE * triangles
        };
        let steps = (FEW_CELLS / STEP..=MOST_CELLS / STEP).map(|step| step * STEP);
        steps.rev().find(is_enough).unwrap_or(FEW_CELLS)
    }

    /// A limit that somebody set is kept by refusing, and that of all lists by taking fewer cells.
    fn keep_at_most(&self, resolution: u32, levels: usize, memory: MemoryLimit) -> Result<Kept<'a>> {
        self.with_fewer_cells(resolution, |cells| match self.keep_at(cells, levels, memory)? {
            None if memory.left() <= MOST_BYTES => Err(memory.exceeded(what(cells))),
            kept => Ok(kept),
        })
    }

    /// `None` if lists are too long.
    fn keep_at(&self, resolution: u32, levels: usize, memory: MemoryLimit) -> Result<Option<Kept<'a>>> {
        let resolution = resolution.next_multiple_of(Levels::unit(levels));
        // Projections of all but one level are needed while lists are made.
        let of_levels = (levels - 1) * self.scene.vertices.len() * size_of::<Projected>()
            + TileGrid::new(resolution).count() * (size_of::<u32>() + size_of::<u64>());
        let memory = memory.beside(what(resolution), of_levels as u64)?;
        let budget = Budget::new(memory.left().min(MOST_BYTES) as usize);
        let Some(layers) = self.layers(resolution, levels, &budget) else { return Ok(None) };
        let (bin_bytes, cast) = (layers.bin_bytes(), layers.cast);
        let needed = layers.cell_bytes() + bin_bytes;
        let left = memory.beside(what(resolution), needed as u64)?.left();
        let Some(lists) = self.lists_of(&layers, &Budget::new(left.min(MOST_BYTES) as usize)) else {
            return Ok(None);
        };
        let (levels, projected) = layers.into_finest();
        let kept = levels.bytes() + size_of_val(&projected[..]) + lists.bytes();
        let work = Work { bytes: (kept + bin_bytes) as u64, ..lists.work(levels.projector.resolution) };
        let (certified, space, size) = (*self, LightSpace::from(self.light), self.size());
        Ok(Some(Kept { certified, space, cast, size, levels, projected, lists, work }))
    }
}

impl Kept<'_> {
    /// Sets `occluded[i]` to whether one of the triangles blocks the open segment between point i and the light.
    pub fn occluded(&self, points: Points<'_>, occluded: &mut [bool]) -> Counters {
        (points.par_chunks(QUERIES), occluded.par_chunks_mut(QUERIES))
            .into_par_iter()
            .map(|(points, occluded)| self.some(points, occluded))
            .reduce(Counters::default, sum)
    }

    /// What making it took.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.levels.bytes() + size_of_val(&self.projected[..]) + self.lists.bytes()
    }

    fn some(&self, points: Points<'_>, occluded: &mut [bool]) -> Counters {
        let _floats = StandardFloats::new();
        let Certified { scene, set, .. } = self.certified;
        let asked = Asked {
            certified: self.certified,
            cast: self.cast,
            projector: &self.levels.projector,
            space: &self.space,
            size: self.size,
            projected: &self.projected,
            lists: &self.lists,
        };
        let mut answering = Answering::new(&asked);
        let (mut cells, mut depths) = ([0; CHUNK], [0.0; CHUNK]);
        for (i, chunk) in points.chunks(CHUNK).enumerate() {
            let first = i * CHUNK;
            let (cells, depths) = (&mut cells[..chunk.len()], &mut depths[..chunk.len()]);
            self.levels.find(set, scene, chunk, cells, depths);
            answering.add(first, chunk, cells, depths, &mut occluded[first..first + chunk.len()]);
        }
        answering.finish(points, occluded)
    }
}
