//! The light buffer of Haines and Greenberg (1986): a cube of cells around each light, each with a
//! depth-sorted list of what can block it. A light infinitely far away has a sheet of cells instead.
//!
//! Row numbers in these rooms are those of section 1 of the notes in ARCHITECTURE.md. The order of a query
//! is the paper's: face and cell of the direction; the full-occlusion depth first; then the list from the
//! front until a triangle blocks or the next one begins behind the point.

mod audit;
mod build;
mod cell;
pub mod cells;
mod convex_cover;
mod convex_self;
pub mod cube;
mod groups;
mod roles;
pub mod sheet;
#[cfg(test)]
mod tests;
mod walk;

pub use audit::Audit;

use super::{Basis, BuildInput, Casters, Counters, Receivers, Resolution, ShadowTester, TesterEntry};
use crate::error::{Error, Result};
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::volume::Volume;
use crate::scene::Scene;
use crate::visibility::SurfacePoint;
use cells::Cells;
use convex_self::HarmlessObjects;
use groups::{CellGroups, Group};
use roles::Roles;

/// `light-buffer` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "light-buffer",
    basis: Basis::Exact,
    build: &|input| Ok(Box::new(LightBuffer::new(input)?)),
    expected_tests: |_, queries| 10.0 * queries,
};

/// The largest number of cells along an edge.
pub const MOST_CELLS: u32 = 4096;

/// A record of a cell's list (row 2): which caster, and at most its nearest z' in the cell.
///
/// The paper's object m and surface n follow from the caster through [`Scene::object_and_surface`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
struct Record {
    near: f32,
    caster: u32,
}

/// Where a cell's list begins (it ends where the next begins), and the depth behind which all is dark.
///
/// The paper appends the full-occlusion record to the list and looks at the last record first (row 14);
/// here it stands in front, so that one cache line decides.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
struct Header {
    start: u32,
    full_occlusion: f32,
}

/// The lists of the part of one side that triangles project on.
#[derive(Debug, Clone)]
struct SideLists {
    first: [u32; 2],
    count: [u32; 2],
    /// One a cell, row by row, and one behind the last.
    headers: Vec<Header>,
    records: Vec<Record>,
    groups: CellGroups,
}

impl SideLists {
    /// Index of a cell's header; `None` outside the part that is stored, where nothing projects.
    fn cell(&self, column: u32, row: u32) -> Option<usize> {
        let (x, y) = (column.wrapping_sub(self.first[0]), row.wrapping_sub(self.first[1]));
        (x < self.count[0] && y < self.count[1]).then(|| y as usize * self.count[0] as usize + x as usize)
    }

    fn list(&self, cell: usize) -> (f32, &[Record]) {
        let (header, next) = (self.headers[cell], self.headers[cell + 1]);
        (header.full_occlusion, &self.records[header.start as usize..next.start as usize])
    }

    fn bytes(&self) -> usize {
        self.headers.len() * size_of::<Header>()
            + self.records.len() * size_of::<Record>()
            + self.groups.bytes()
    }
}

/// What was built (row 23).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Cells along an edge of the cube.
    pub resolution: u32,
    /// Triangles that are not cast because they are the far sides of solids.
    pub culled: u64,
    /// Sides that triangles project on.
    pub sides: u64,
    /// Cells that are stored.
    pub cells: u64,
    /// Cells that at least one triangle touches, before anything was simplified.
    pub touched_cells: u64,
    /// Cells with a list.
    pub non_empty: u64,
    /// Records in all lists: the paper's list items.
    pub records: u64,
    /// Bounding-volume records; they are not among the records.
    pub bounding_volumes: u64,
    /// Records in the longest list.
    pub longest_list: u64,
    /// Records cut off behind a full occlusion.
    pub pruned: u64,
    /// Cells with a full-occlusion depth.
    pub full_occlusions: u64,
    /// Lists of one polygon that were left out.
    pub dropped_lists: u64,
    /// Full-occlusion depths that were left out because nothing lies behind them.
    pub dropped_full_occlusions: u64,
}

/// The light buffer of one light, good for every view of its scene.
pub struct LightBuffer<'a> {
    scene: &'a Scene,
    receivers: Receivers,
    casters: Casters,
    harmless: HarmlessObjects,
    /// The volume of each object; empty if no list has bounding-volume records.
    volumes: Vec<Option<Volume>>,
    cells: Cells,
    sides: Vec<Option<SideLists>>,
    statistics: Statistics,
}

impl<'a> LightBuffer<'a> {
    /// Builds the buffer of one light.
    ///
    /// # Errors
    /// [`Error::Usage`] for a resolution outside 1 to 4096, or lists too long for 32-bit offsets.
    pub fn new(input: &BuildInput<'a>) -> Result<LightBuffer<'a>> {
        let roles = Roles::new(input);
        let casters = Casters::some(input.scene, input.index, input.light, &roles.casting);
        let resolution = match input.resolution {
            Resolution::Auto => automatic_resolution(casters.planes.len()),
            Resolution::Cells(cells) if (1..=MOST_CELLS).contains(&cells) => cells,
            Resolution::Cells(cells) => {
                return Err(Error::Usage(format!(
                    "light buffer: {cells} cells along an edge; expected 1 to {MOST_CELLS}"
                )));
            }
        };
        let corners = casters.primitives.iter().flat_map(|&primitive| input.scene.corners(primitive));
        let cells = Cells::new(&casters.space, corners);
        // Lists are checked when their length is known.
        let headers = cells.sides() as u64 * u64::from(resolution).pow(2) * size_of::<Header>() as u64;
        input.memory.check(format!("a light buffer of {resolution} cells along an edge"), headers)?;
        let volumes = groups::object_volumes(input, &casters);
        let (sides, statistics) = build::build(input, &casters, &roles.receiving_only, &cells, resolution)?;
        let statistics = Statistics { culled: roles.culled, ..statistics };
        Ok(LightBuffer {
            scene: input.scene,
            receivers: input.receivers,
            casters,
            harmless: HarmlessObjects::new(input),
            volumes,
            cells,
            sides,
            statistics,
        })
    }

    /// What was built.
    pub fn counts(&self) -> Statistics {
        self.statistics
    }

    /// Whether one point is occluded.
    fn is_occluded(&self, point: &SurfacePoint, counters: &mut Counters) -> bool {
        let space = &self.casters.space;
        let query = PreciseQuery::new(space, point.position, || point.exact(self.scene));
        let resolution = self.statistics.resolution;
        let Some((at, exactly)) = self.cells.locate(space, point.position, resolution, &query) else {
            return false;
        };
        counters.cells += 1;
        counters.exact += u64::from(exactly);
        let Some(lists) = &self.sides[at.side] else { return false };
        let Some(cell) = lists.cell(at.column, at.row) else { return false };
        let (full_occlusion, list) = lists.list(cell);
        if f64::from(full_occlusion) < at.z_low {
            counters.full_occlusions += 1;
            return true;
        }
        counters.lists += u64::from(!list.is_empty());
        let asked = self.asked(point, &query);
        self.blocking_caster(list, lists.groups.of(cell), &asked, at.z_high, counters).is_some()
    }
}

impl ShadowTester for LightBuffer<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let mut counters = Counters::default();
        for (point, answer) in points.iter().zip(answers) {
            if self.receivers == Receivers::Surfaces && point.primitive().is_none() {
                return Err(Error::Usage(
                    "light buffer: built for points on surfaces; build it with Receivers::Anywhere".into(),
                ));
            }
            *answer = self.is_occluded(point, &mut counters);
        }
        Ok(counters)
    }

    fn bytes(&self) -> usize {
        self.casters.bytes()
            + self.harmless.bytes()
            + self.volumes.len() * size_of::<Option<Volume>>()
            + self.sides.iter().flatten().map(SideLists::bytes).sum::<usize>()
    }

    fn statistics(&self) -> Vec<(&'static str, String)> {
        let s = &self.statistics;
        let all_cells = self.cells.sides() as f64 * f64::from(s.resolution).powi(2);
        vec![
            ("resolution", s.resolution.to_string()),
            ("casters culled", s.culled.to_string()),
            ("sides built", s.sides.to_string()),
            ("cells built", s.cells.to_string()),
            ("list items", s.records.to_string()),
            ("bounding-volume records", s.bounding_volumes.to_string()),
            ("list items per square", format!("{:.3}", s.records as f64 / all_cells)),
            ("non-empty squares", format!("{:.1} %", 100.0 * s.non_empty as f64 / all_cells)),
            ("longest list", s.longest_list.to_string()),
            ("full-occlusion cells", s.full_occlusions.to_string()),
            ("records pruned", s.pruned.to_string()),
            ("one-polygon lists dropped", s.dropped_lists.to_string()),
        ]
    }
}

/// The resolution that `auto` takes: lists of a few records, from the number of casters alone.
fn automatic_resolution(casters: usize) -> u32 {
    let wanted = (casters as f64).sqrt();
    (wanted as u32).next_power_of_two().clamp(32, 1024)
}
