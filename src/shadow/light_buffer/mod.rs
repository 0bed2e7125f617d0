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
mod cube_coherence;
mod culled_receivers;
mod curved_cast;
mod flatness;
mod groups;
mod occupancy;
mod roles;
pub mod sheet;
#[cfg(test)]
mod tests;
mod transparent;
mod walk;

pub use audit::Audit;
pub use occupancy::Occupancy;

use super::{BuildInput, Casters, Counters, Crossings, ObjectCoherence, Receivers, Resolution, ShadowTester};
use crate::error::{Error, Result};
use crate::float_environment::StandardFloats;
use crate::geometry::ExactPosition;
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::volume::Volume;
use crate::scene::{Primitive, Scene};
use crate::shadow::bounding_volumes::is_endless;
use crate::visibility::SurfacePoint;
use cells::Cells;
use convex_self::HarmlessObjects;
use culled_receivers::CulledReceivers;
use glam::Vec3;
use groups::{CellGroups, Group};
use roles::Roles;
use transparent::TransparentLists;

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
#[derive(Debug, Clone, PartialEq)]
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
    /// Records of transparent primitives; they are not among the records.
    pub transparent_records: u64,
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
    /// What was culled, if something was.
    culled: Option<CulledReceivers>,
    coherence: ObjectCoherence,
    /// Casters without end, which no cell lists: all of them may block any point.
    endless: Vec<u32>,
    /// What attenuates light, if the scene has such.
    transparent: Option<TransparentLists>,
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
        let _floats = StandardFloats::new();
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
        let cells = Cells::new(&casters.space, corners(input.scene, &casters));
        // Lists are checked when their length is known.
        let headers = cells.sides() as u64 * u64::from(resolution).pow(2) * size_of::<Header>() as u64;
        input.memory.check(format!("a light buffer of {resolution} cells along an edge"), headers)?;
        let volumes = groups::object_volumes(input, &casters);
        let (sides, statistics) = build::build(input, &casters, &roles.receiving_only, &cells, resolution)?;
        let statistics = Statistics { culled: roles.culled.len() as u64, ..statistics };
        let endless = endless(input.scene, &casters);
        Ok(LightBuffer {
            scene: input.scene,
            receivers: input.receivers,
            casters,
            harmless: HarmlessObjects::new(input),
            culled: CulledReceivers::new(input.scene, &roles.culled),
            coherence: input.object_coherence,
            endless,
            transparent: TransparentLists::new(input, resolution)?,
            volumes,
            cells,
            sides,
            statistics,
        })
    }

    /// What was built.
    pub fn counts(&self) -> Statistics {
        let mut counts = self.statistics;
        if let Some(transparent) = &self.transparent {
            counts.transparent_records = transparent.records();
        }
        counts
    }

    /// What occludes a point.
    fn occluder<F: Fn() -> ExactPosition>(
        &self,
        point: &SurfacePoint,
        query: &PreciseQuery<F>,
        counters: &mut Counters,
    ) -> Occluder {
        if !self.endless.is_empty() {
            let asked = self.asked(point, query);
            if let Some(&caster) = self.endless.iter().find(|&&caster| self.blocks(caster, &asked, counters))
            {
                return Occluder::Caster(caster);
            }
        }
        let (space, resolution) = (&self.casters.space, self.statistics.resolution);
        let Some((at, exactly)) = self.cells.locate(space, point.position, resolution, query) else {
            return Occluder::Nothing;
        };
        counters.cells += 1;
        counters.exact += u64::from(exactly);
        let Some(lists) = &self.sides[at.side] else { return Occluder::Nothing };
        let Some(cell) = lists.cell(at.column, at.row) else { return Occluder::Nothing };
        let (full_occlusion, list) = lists.list(cell);
        if f64::from(full_occlusion) < at.z_low {
            counters.full_occlusions += 1;
            return Occluder::FullOcclusion;
        }
        counters.lists += u64::from(!list.is_empty());
        let asked = self.asked(point, query);
        let blocking = self.blocking_caster(list, lists.groups.of(cell), &asked, at.z_high, counters);
        blocking.map_or(Occluder::Nothing, Occluder::Caster)
    }

    /// Whether a point is occluded. With object coherence (row 20) `last` is the caster that occluded the one
    /// before, if it is known, and is tried first: by the whole predicate, so that no answer depends on it.
    fn is_occluded(
        &self,
        point: &SurfacePoint,
        last: Option<&mut Option<u32>>,
        counters: &mut Counters,
    ) -> bool {
        let query = PreciseQuery::new(&self.casters.space, point.position, || point.exact(self.scene));
        if self.culled.as_ref().is_some_and(|culled| culled.hold(point)) {
            return self.is_culled_point_occluded(point, &query, counters);
        }
        let Some(last) = last else { return self.occluder(point, &query, counters) != Occluder::Nothing };
        if let Some(caster) = *last
            && self.blocks(caster, &self.asked(point, &query), counters)
        {
            counters.coherence_hits += 1;
            return true;
        }
        let occluder = self.occluder(point, &query, counters);
        *last = match occluder {
            Occluder::Caster(caster) => Some(caster),
            Occluder::FullOcclusion | Occluder::Nothing => None,
        };
        occluder != Occluder::Nothing
    }
}

/// Corners of all casters that have an end, or of boxes around them.
fn corners<'c>(scene: &'c Scene, casters: &'c Casters) -> impl Iterator<Item = Vec3> + 'c {
    casters.primitives.iter().flat_map(|&p| match scene.primitive(p) {
        Primitive::Triangle(corners) => corners.to_vec(),
        Primitive::Curved(shape) => shape.bounds().map_or(Vec::new(), |(low, high)| {
            let corner = |i: usize| Vec3::from_array([0, 1, 2].map(|k| [low, high][i >> k & 1][k]));
            (0..8).map(corner).collect()
        }),
    })
}

/// Casters without end.
fn endless(scene: &Scene, casters: &Casters) -> Vec<u32> {
    let is_endless = |caster: &u32| is_endless(scene, casters.primitives[*caster as usize]);
    (0..casters.primitives.len() as u32).filter(is_endless).collect()
}

/// What keeps the light from a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Occluder {
    Nothing,
    /// What covers the whole cell.
    FullOcclusion,
    /// The caster with this index.
    Caster(u32),
}

impl ShadowTester for LightBuffer<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let _floats = StandardFloats::new();
        let mut counters = Counters::default();
        let mut last = None;
        for (point, answer) in points.iter().zip(answers) {
            if self.receivers == Receivers::Surfaces && point.primitive().is_none() {
                return Err(Error::Usage(
                    "light buffer: built for points on surfaces; build it with Receivers::Anywhere".into(),
                ));
            }
            let last = (self.coherence == ObjectCoherence::LastOccluder).then_some(&mut last);
            *answer = self.is_occluded(point, last, &mut counters);
        }
        Ok(counters)
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        let _floats = StandardFloats::new();
        let mut counters = Counters::default();
        for point in points {
            let lists = self.transparent.as_ref();
            crossings.push(lists.map_or(Vec::new(), |lists| lists.crossed(self.scene, point, &mut counters)));
        }
        Ok(counters)
    }

    fn bytes(&self) -> usize {
        self.casters.bytes()
            + self.harmless.bytes()
            + self.culled.as_ref().map_or(0, CulledReceivers::bytes)
            + self.transparent.as_ref().map_or(0, TransparentLists::bytes)
            + self.volumes.len() * size_of::<Option<Volume>>()
            + self.sides.iter().flatten().map(SideLists::bytes).sum::<usize>()
    }

    fn statistics(&self) -> Vec<(&'static str, String)> {
        let s = &self.counts();
        let all_cells = self.cells.sides() as f64 * f64::from(s.resolution).powi(2);
        vec![
            ("resolution", s.resolution.to_string()),
            ("casters culled", s.culled.to_string()),
            ("sides built", s.sides.to_string()),
            ("cells built", s.cells.to_string()),
            ("list items", s.records.to_string()),
            ("transparent list items", s.transparent_records.to_string()),
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
