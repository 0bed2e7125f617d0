//! Certified cells: most queries decided by two depths of their cell, whatever lies in it.
//!
//! A view's queries of one light are filed in the cells of a cube around it ([`receivers`]). Triangles are then held, sixteen at
//! a time, against the farthest receiver of each tile of cells that they touch ([`survey`], [`large`]). Tile by tile those
//! that remain are entered in the cells where they may be in front of a receiver ([`lists`], [`small`], [`block`]), and
//! the edges that two of them share are found ([`edges`]). For each cell that leaves a list, nearest first, and out of it a
//! certificate: where the nearest surface is complete and covers the cell once, receivers on it are lit and what is
//! behind it is dark ([`certificate`], TRUTH "Certified cells"). Queries are held against these two depths ([`headers`]);
//! what is left walks through the lists, sixteen queries at a time ([`walk`]), and where f32 leaves a test open, f64 and
//! exact arithmetic decide it.
//!
//! Everything is computed with bounds that stand where it is computed: cells are supersets, depths are intervals,
//! a receiver's cell is that of its exact point. So no answer depends on the resolution, the number of threads or the
//! instruction set.

mod bins;
mod block;
mod cell_lists;
mod certificate;
mod corners;
mod dispatch;
mod edges;
mod facing;
mod headers;
mod large;
mod lists;
mod projection;
mod receivers;
mod small;
mod survey;
mod tiles;
mod walk;

use super::Counters;
use crate::error::{Error, Result};
use crate::float_environment::StandardFloats;
use crate::geometry::LightSpace;
use crate::geometry::batch::InstructionSet;
use crate::memory::MemoryLimit;
use crate::scene::{PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;
use bins::{Bins, Budget};
use cell_lists::Item;
use certificate::{Header, Kinds, Record, Run};
use glam::Vec3;
use headers::Headers;
use lists::{Lister, Part, Scratch};
use projection::{Projected, Projector};
use rayon::prelude::*;
use receivers::{CHUNK, Filed};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use survey::{Cast, Survey};
use tiles::Tiles;
use walk::{LANES, PORTIONS, Portion, Walk};

/// The largest number of cells along an edge.
pub const MOST_CELLS: u32 = 4096;

/// A light over the triangles of a scene that block light and have no holes.
pub struct Certified<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// A light at a point.
    pub light: Vec3,
    /// What the kernels run on.
    pub set: InstructionSet,
    /// The most memory that a view may need.
    pub memory: MemoryLimit,
}

/// The work that a view took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Tests and look-ups.
    pub counters: Counters,
    /// Cells along an edge of the cube.
    pub resolution: u32,
    /// Cells that were stored.
    pub cells: u64,
    /// Cells with something in front of a receiver.
    pub touched: u64,
    /// Cells whose nearest surface covers them once.
    pub once: u64,
    /// Cells covered by some other surface.
    pub covered: u64,
    /// Triangles in cells.
    pub entries: u64,
    /// Queries decided by the two depths of their cell.
    pub by_header: u64,
    /// Memory in bytes while it was done.
    pub bytes: u64,
}

/// Tiles of a task.
const TILES: usize = 64;
/// Cells of a task.
const CELLS: usize = TILES * tiles::AREA as usize;
/// Triangles that a worker takes at a time.
const TRIANGLES: usize = 2048;
/// Workers that keep lists of their own: each has a number for every tile.
const MOST_WORKERS: usize = 16;
/// The most bytes for what depends on the number of cells, if memory is no matter.
const MOST_BYTES: u64 = 4 << 30;

/// Headers and lists of all cells.
struct Lists {
    headers: Vec<Header>,
    runs: Vec<Run>,
    /// Of [`CELLS`] cells each.
    records: Vec<Vec<Record>>,
    kinds: Kinds,
    /// Triangles in cells.
    entries: u64,
}

impl Lists {
    fn of(&self, cell: usize) -> &[Record] {
        let run = self.runs[cell];
        &self.records[cell / CELLS][run.start as usize..][..run.length as usize]
    }
}

/// Primitives that the cells hold: triangles that block light and are whole.
pub fn is_plain(scene: &Scene, primitive: PrimitiveIndex) -> bool {
    !scene.is_curved(primitive)
        && scene.object(primitive).shadowing.casts
        && !scene.is_transparent(primitive)
        && scene.masked(primitive).is_none()
}

/// The resolution for a number of receivers: some four of them in a cell where they are close together.
pub fn automatic_resolution(receivers: usize) -> u32 {
    let wanted = (receivers as f64 * 0.5).sqrt();
    (wanted as u32).next_power_of_two().clamp(16, 2048)
}

impl Certified<'_> {
    /// Sets `occluded[i]` to whether one of the triangles blocks the open segment between `points[i]` and the light.
    /// With fewer cells than asked for where their lists would need more memory than there may be.
    ///
    /// # Errors
    /// [`Error::Usage`] for a resolution outside 1 to 4096, 2^28 triangles and more, or too little memory for what does not
    /// depend on the resolution, or for one cell along an edge.
    pub fn occluded(&self, points: &[SurfacePoint], resolution: u32, occluded: &mut [bool]) -> Result<Work> {
        let _floats = StandardFloats::new();
        if !(1..=MOST_CELLS).contains(&resolution) {
            let expected = format!("expected 1 to {MOST_CELLS}");
            return Err(Error::Usage(format!("{resolution} cells along an edge; {expected}")));
        }
        if self.scene.triangles.len() >= Item::MOST {
            return Err(Error::Usage(format!("more than {} triangles around a light", Item::MOST - 1)));
        }
        let fixed = self.scene.vertices.len() * size_of::<Projected>()
            + self.scene.triangles.len()
            + points.len() * (size_of::<u32>() + size_of::<f32>() + 3);
        let memory = self.memory.beside("the projection of all vertices and points", fixed as u64)?;
        let mut resolution = resolution;
        loop {
            if let Some(work) = self.at_resolution(points, resolution, memory, occluded) {
                return Ok(Work { bytes: work.bytes + fixed as u64, ..work });
            }
            if resolution == 1 {
                let limit = "lists of all triangles around a light, in one cell a side, need more memory than there may be";
                return Err(Error::Usage(limit.into()));
            }
            resolution = resolution.div_ceil(2);
        }
    }

    /// The same, or `None` if the lists of that many cells are too long.
    fn at_resolution(
        &self,
        points: &[SurfacePoint],
        resolution: u32,
        memory: MemoryLimit,
        occluded: &mut [bool],
    ) -> Option<Work> {
        let scene = self.scene;
        let projector = Projector::new(self.light, resolution);
        let mut filed = Filed::new(self.set, &projector, scene, points);
        let projected = self.projected(&projector);
        let grid = filed.tiles.grid;
        let cell_bytes = filed.tiles.cells() * (size_of::<Header>() + size_of::<Run>() + size_of::<u32>())
            + grid.count() * 2 * size_of::<u32>();
        let budget = Budget::new(memory.left().saturating_sub(cell_bytes as u64).min(MOST_BYTES) as usize);
        let horizon = &filed.horizon;
        let survey = Survey { scene, cast: self.cast(), projector, grid, horizon, projected: &projected };
        let bins = self.bins(&survey, &budget)?;
        let lister =
            Lister { scene, projector, grid, horizon, projected: &projected, bins: &bins, budget: &budget };
        let lists = self.lists(&lister, &filed.tiles)?;
        let bin_bytes: usize = bins.iter().map(Bins::bytes).sum();
        let record_bytes: usize = lists.records.iter().map(|r| r.capacity() * size_of::<Record>()).sum();
        let mut work = Work {
            resolution,
            cells: filed.tiles.cells() as u64,
            touched: lists.kinds.touched,
            once: lists.kinds.once,
            covered: lists.kinds.covered,
            entries: lists.entries,
            bytes: (cell_bytes + bin_bytes + record_bytes) as u64,
            ..Work::default()
        };
        drop(bins);
        self.leave_open_what_is_not_cast(&mut filed, points);
        let undecided = self.by_headers(&projector, &filed, &lists, occluded);
        work.by_header = (points.len() - undecided.len()) as u64;
        work.counters.cells = points.len() as u64;
        work.counters.lists = undecided.len() as u64;
        let space = LightSpace::from(self.light);
        let walk = Walk { scene, projector: &projector, space: &space, points, projected: &projected };
        work.counters += self.by_lists(&walk, &lists, undecided, occluded);
        Some(work)
    }

    /// All vertices on the sides of the cube.
    fn projected(&self, projector: &Projector) -> Vec<Projected> {
        let vertices = &self.scene.vertices;
        let mut projected = vec![Projected::default(); vertices.len()];
        vertices.par_chunks(CHUNK).zip(projected.par_chunks_mut(CHUNK)).for_each(|(vertices, projected)| {
            let _floats = StandardFloats::new();
            projection::project(self.set, projector, vertices, projected);
        });
        projected
    }

    /// Which triangles are cast.
    fn cast(&self) -> Cast {
        let scene = self.scene;
        let casts = |object: &crate::scene::Object| object.shadowing.casts;
        let all = scene.curved.is_empty()
            && scene.alpha_masks.is_empty()
            && scene.objects.iter().all(casts)
            && scene.materials.iter().all(|material| material.transmission.is_none());
        if all { Cast::All } else { Cast::Plain }
    }

    /// Triangles by tile, or `None` if there are too many.
    fn bins<'b>(&self, survey: &Survey<'_>, budget: &'b Budget) -> Option<Vec<Bins<'b>>> {
        let count = self.scene.triangles.len();
        let next = AtomicUsize::new(0);
        let worker = |_| {
            let _floats = StandardFloats::new();
            let mut bins = Bins::new(&survey.grid, budget);
            loop {
                let first = next.fetch_add(TRIANGLES, Relaxed);
                if first >= count || bins.overflowed {
                    return bins;
                }
                let end = count.min(first + TRIANGLES);
                survey::survey(self.set, survey, first as u32..end as u32, &mut bins);
            }
        };
        let workers = rayon::current_num_threads().min(MOST_WORKERS);
        let bins: Vec<_> = (0..workers).into_par_iter().with_max_len(1).map(worker).collect();
        bins.iter().all(|bins| !bins.overflowed).then_some(bins)
    }

    /// Lists of all cells, or `None` if they are too long.
    fn lists(&self, lister: &Lister<'_>, tiles: &Tiles) -> Option<Lists> {
        let cells = tiles.cells();
        let mut headers = vec![Header::EMPTY; cells];
        let mut runs = vec![Run::default(); cells];
        let parts: Vec<Part> = headers
            .par_chunks_mut(CELLS)
            .zip(runs.par_chunks_mut(CELLS))
            .zip(tiles.stored().par_chunks(TILES))
            .enumerate()
            .map_init(Scratch::new, |scratch, (part, ((headers, runs), tiles))| {
                let _floats = StandardFloats::new();
                let mut of_part = Part::new(headers, runs);
                lists::list(self.set, lister, tiles, part * CELLS, scratch, &mut of_part);
                of_part
            })
            .collect();
        if parts.iter().any(|part| part.overflowed) {
            return None;
        }
        let (mut kinds, mut entries, mut records) = (Kinds::default(), 0, Vec::new());
        for part in parts {
            kinds += part.kinds;
            entries += part.entries;
            records.push(part.records);
        }
        Some(Lists { headers, runs, records, kinds, entries })
    }

    /// Certificates light what lies on a triangle that is cast; all else asks the lists.
    fn leave_open_what_is_not_cast(&self, filed: &mut Filed, points: &[SurfacePoint]) {
        if self.cast() == Cast::All && !filed.has_bare {
            return;
        }
        (&mut filed.depths, points).into_par_iter().for_each(|(depth, point)| {
            if point.primitive().is_none_or(|primitive| !is_plain(self.scene, primitive)) {
                *depth = f32::NAN;
            }
        });
    }

    /// Answers by the two depths of each cell, and returns those that they leave open, by cell: the cell in the
    /// upper half.
    fn by_headers(
        &self,
        projector: &Projector,
        filed: &Filed,
        lists: &Lists,
        occluded: &mut [bool],
    ) -> Vec<u64> {
        let headers = Headers { projector, size: self.size(), headers: &lists.headers };
        let receivers = filed.cells.par_chunks(CHUNK).zip(filed.depths.par_chunks(CHUNK));
        let open: Vec<Vec<u64>> = receivers
            .zip(occluded.par_chunks_mut(CHUNK))
            .enumerate()
            .map(|(chunk, ((cells, depths), occluded))| {
                let _floats = StandardFloats::new();
                let mut undecided = [false; CHUNK];
                let undecided = &mut undecided[..cells.len()];
                headers::decide(self.set, &headers, cells, depths, occluded, undecided);
                open_queries(chunk * CHUNK, cells, undecided)
            })
            .collect();
        by_cell(&open, lists.headers.len())
    }

    /// At least every coordinate of a point on a triangle.
    fn size(&self) -> f32 {
        let largest = |v: &Vec3| v.abs().max_element();
        self.scene.vertices.par_iter().map(largest).reduce(|| 0.0, f32::max)
    }

    fn by_lists(&self, walk: &Walk, lists: &Lists, undecided: Vec<u64>, occluded: &mut [bool]) -> Counters {
        let of_cell = |queries: &&[u64]| lists.of((queries[0] >> 32) as usize);
        let portions: Vec<Portion> = undecided
            .chunk_by(|a, b| a >> 32 == b >> 32)
            .flat_map(|queries| queries.chunks(LANES))
            .map(|queries| Portion { queries, records: of_cell(&queries) })
            .collect();
        let answer = |portions: &[Portion]| {
            let _floats = StandardFloats::new();
            let (mut dark, mut counters) = (Vec::new(), Counters::default());
            for portions in portions.chunks(PORTIONS) {
                walk::walk(self.set, walk, portions, &mut dark, &mut counters);
            }
            (dark, counters)
        };
        let found: Vec<_> = portions.par_chunks(16 * PORTIONS).map(answer).collect();
        let mut all = Counters::default();
        for (dark, counters) in found {
            all += counters;
            for query in dark {
                occluded[query as usize] = true;
            }
        }
        all
    }
}

/// Sorts queries by their cells, which are in the upper half.
fn by_cell(portions: &[Vec<u64>], cells: usize) -> Vec<u64> {
    let cell_of = |query: u64| (query >> 32) as usize;
    let mut next = vec![0u32; cells];
    let all = || portions.iter().flatten().copied();
    all().for_each(|query| next[cell_of(query)] += 1);
    let mut start = 0;
    for next in &mut next {
        start += std::mem::replace(next, start);
    }
    let mut sorted = vec![0; start as usize];
    for query in all() {
        let next = &mut next[cell_of(query)];
        sorted[*next as usize] = query;
        *next += 1;
    }
    sorted
}

/// Undecided queries from a first one on, with their cells in the upper half.
fn open_queries(first: usize, cells: &[u32], undecided: &[bool]) -> Vec<u64> {
    let mut open = Vec::new();
    for (eight, undecided) in undecided.chunks(8).enumerate() {
        // Mostly none of them.
        if undecided.contains(&true) {
            let places = (8 * eight..).zip(undecided).filter(|(_, undecided)| **undecided);
            open.extend(places.map(|(i, _)| u64::from(cells[i]) << 32 | (first + i) as u64));
        }
    }
    open
}
