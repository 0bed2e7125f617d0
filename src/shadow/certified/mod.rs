//! Certified cells: most queries decided by two depths of their cell, whatever lies in it.
//!
//! A view's queries of one light are filed in the cells of a cube around it ([`receivers`]). Triangles are then held, sixteen at
//! a time, against the farthest receiver of each tile of cells that they touch ([`survey`], [`large`]). Tile by tile those
//! that remain are entered in the cells where they may be in front of a receiver ([`lists`], [`small`], [`block`]), and
//! the edges that two of them share are found ([`edges`]). For each cell that leaves a list, and out of it a
//! certificate: where the nearest surface is complete and covers the cell once, receivers on it are lit and what is
//! behind it is dark ([`certificate`], TRUTH "Certified cells"). Queries are held against these two depths ([`headers`]);
//! what is left walks through the lists, sixteen triangles at a time ([`answer`], [`open`], [`walk`], [`blockers`]), and where f32 leaves a
//! test open, f64 and exact arithmetic decide it.
//!
//! That is the way of a view that is drawn once ([`view`]). Cells that are [`kept`] for many are made wherever triangles lie, as
//! if receivers were infinitely far away, and a query is only filed in its cell.
//!
//! Everything is computed with bounds that stand where it is computed: cells are supersets, depths are intervals,
//! a receiver's cell is that of its exact point. So no answer depends on the resolution, the number of threads or the
//! instruction set.

mod answer;
mod automatic;
mod bins;
mod block;
mod blockers;
mod by_triangle;
mod cell_lists;
mod certificate;
mod corners;
mod edges;
mod entries;
mod facing;
mod headers;
mod joints;
mod judge;
mod kept;
mod large;
mod layers;
mod levels;
mod lists;
mod making;
mod open;
mod pairs;
mod projection;
mod pyramids;
mod receivers;
mod second_look;
mod selected;
mod small;
mod stored;
mod survey;
mod tiles;
mod verdict;
mod view;
mod walk;
mod windows;

pub use kept::Kept;

use super::Counters;
use crate::error::{Error, Result};
use crate::float_environment::StandardFloats;
use crate::geometry::batch::InstructionSet;
use crate::memory::MemoryLimit;
use crate::scene::{PrimitiveIndex, Scene};
use cell_lists::Item;
use glam::Vec3;
use projection::{Projected, Projector};
use rayon::prelude::*;
use receivers::Horizon;
use selected::CHUNK;
use survey::{Cast, Survey};
use windows::Windows;

/// The largest number of cells along an edge.
pub const MOST_CELLS: u32 = 4096;

/// A light over the triangles of a scene that block light and have no holes.
#[derive(Clone, Copy)]
pub struct Certified<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// A light at a point.
    pub light: Vec3,
    /// What the kernels run on.
    pub set: InstructionSet,
    /// The most memory that may be needed.
    pub memory: MemoryLimit,
}

/// How much is done for cells that are kept, before anybody asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BuildQuality {
    /// What pays from the second view on.
    Medium,
    /// What pays after some tens of views: also a verdict on the points of every triangle in every cell, and on whole triangles.
    High,
}

/// What making cells took, and asking a view.
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

/// The most bytes for what depends on the number of cells, if memory is no matter.
const MOST_BYTES: u64 = 4 << 30;

/// Primitives that the cells hold: triangles that block light and are whole.
pub fn is_plain(scene: &Scene, primitive: PrimitiveIndex) -> bool {
    !scene.is_curved(primitive)
        && scene.object(primitive).shadowing.casts
        && !scene.is_transparent(primitive)
        && scene.masked(primitive).is_none()
}

/// The memory that cells that are kept may need if nobody says how many there are to be: 16 MiB and 64 bytes a triangle, no more than
/// production hierarchies take for large scenes.
pub fn usual_bytes(scene: &Scene) -> u64 {
    (16 << 20) + 64 * scene.triangles.len() as u64
}

impl Certified<'_> {
    /// Checks what does not depend on the number of cells, and hands on the memory that is left; so many bytes are spoken for.
    fn checked(&self, resolution: u32, bytes: usize) -> Result<MemoryLimit> {
        if !(1..=MOST_CELLS).contains(&resolution) {
            let expected = format!("expected 1 to {MOST_CELLS}");
            return Err(Error::Usage(format!("{resolution} cells along an edge; {expected}")));
        }
        if self.scene.triangles.len() >= Item::MOST {
            return Err(Error::Usage(format!("more than {} triangles around a light", Item::MOST - 1)));
        }
        self.memory.beside("the projection of all vertices and points", (bytes + self.fixed_bytes()) as u64)
    }

    /// Bytes that do not depend on the number of cells.
    fn fixed_bytes(&self) -> usize {
        self.scene.vertices.len() * size_of::<Projected>() + self.scene.triangles.len()
    }

    /// Makes something with so many cells along an edge, or fewer if the lists of so many are too long (`None`).
    fn with_fewer_cells<T>(
        &self,
        resolution: u32,
        mut make: impl FnMut(u32) -> Result<Option<T>>,
    ) -> Result<T> {
        let mut resolution = resolution;
        loop {
            if let Some(made) = make(resolution)? {
                return Ok(made);
            }
            if resolution == 1 {
                let limit = "lists of all triangles around a light, in one cell a side, need more memory than there may be";
                return Err(Error::Usage(limit.into()));
            }
            resolution = resolution.div_ceil(2);
        }
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

    /// What is cast as receivers see it, with all duplicates.
    fn survey<'s>(
        &self,
        projector: Projector,
        windows: Windows,
        horizon: &'s Horizon,
        projected: &'s [Projected],
    ) -> Survey<'s>
    where
        Self: 's,
    {
        let (scene, cast, duplicates) = (self.scene, self.cast(), Vec::new());
        Survey { scene, cast, duplicates, projector, windows, horizon, projected }
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

    /// At least every coordinate of a point on a triangle.
    fn size(&self) -> f32 {
        let largest = |v: &Vec3| v.abs().max_element();
        self.scene.vertices.par_iter().map(largest).reduce(|| 0.0, f32::max)
    }
}
