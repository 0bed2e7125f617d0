//! Transparent surfaces in the cells (row 19 of the notes on the 1986 paper).
//!
//! The paper marks their records and puts them aside until no opaque one has been hit. Here they stand in lists of
//! their own, which nobody reads for a point that is occluded, and which a scene without them does not have.
//! Nothing is culled, nothing covers a cell, and no list is left out: light shines through from both sides.

use super::cells::Cells;
use super::{Casters, SideLists, build, corners, endless};
use crate::error::Result;
use crate::geometry::occlusion::PreciseQuery;
use crate::scene::{PrimitiveIndex, Scene};
use crate::shadow::precise::crossed_among;
use crate::shadow::{BuildInput, Counters, Receivers, VolumeThreshold};
use crate::visibility::SurfacePoint;

/// The lists of all transparent casters.
pub(super) struct TransparentLists {
    casters: Casters,
    endless: Vec<u32>,
    cells: Cells,
    resolution: u32,
    pub(super) sides: Vec<Option<SideLists>>,
}

impl TransparentLists {
    /// `None` for a scene that needs none.
    ///
    /// # Errors
    /// As for a light buffer.
    pub fn new(input: &BuildInput, resolution: u32) -> Result<Option<TransparentLists>> {
        if input.index.transparent.is_empty() {
            return Ok(None);
        }
        let input =
            &BuildInput { receivers: Receivers::Anywhere, bounding_volumes: VolumeThreshold::Off, ..*input };
        let casters = Casters::transparent(input.scene, input.index, input.light);
        let cells = Cells::new(&casters.space, corners(input.scene, &casters));
        let (sides, _) = build::build(input, &casters, &[], &cells, resolution)?;
        let endless = endless(input.scene, &casters);
        Ok(Some(TransparentLists { casters, endless, cells, resolution, sides }))
    }

    /// What the segment of a point crosses.
    pub fn crossed(
        &self,
        scene: &Scene,
        point: &SurfacePoint,
        counters: &mut Counters,
    ) -> Vec<PrimitiveIndex> {
        let space = &self.casters.space;
        let query = PreciseQuery::new(space, point.position, || point.exact(scene));
        let mut casters = self.endless.clone();
        if let Some((at, exactly)) = self.cells.locate(space, point.position, self.resolution, &query) {
            counters.cells += 1;
            counters.exact += u64::from(exactly);
            let lists = self.sides[at.side].as_ref();
            let list = lists.and_then(|lists| Some(lists.list(lists.cell(at.column, at.row)?).1));
            let list = list.unwrap_or_default().iter();
            let before = list.take_while(|record| f64::from(record.near) < at.z_high);
            casters.extend(before.map(|record| record.caster));
        }
        let primitives = casters.into_iter().map(|caster| self.casters.primitives[caster as usize]);
        crossed_among(scene, primitives, point.primitive(), &query, counters)
    }

    /// Records in all lists.
    pub fn records(&self) -> u64 {
        self.sides.iter().flatten().map(|lists| lists.records.len() as u64).sum()
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.casters.bytes() + self.sides.iter().flatten().map(SideLists::bytes).sum::<usize>()
    }
}
