//! Points on the far sides of solids, which were culled (row 4 of the notes on the 1986 paper).
//!
//! Such a side is in no list, so that the simplifications of a list (rows 10 and 11) would be wrong for points on
//! it. They would be void everywhere if it were a receiver all the same: under every near side there is a far
//! side. But nearly all of its points need no list. The light is outside of the solid, and its ray reaches the
//! inside of such a triangle from the inside of the solid, which it entered before: the point is occluded. Only on
//! an edge may the ray have passed beside the solid; there everything that is cast is tested.
//!
//! Hardly anybody asks: from outside of the solid its far sides face away from the light.

use super::LightBuffer;
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::{ExactPosition, LightTriangle};
use crate::scene::{PrimitiveIndex, Scene};
use crate::shadow::Counters;
use crate::shadow::scene_index::duplicate_key;
use crate::visibility::SurfacePoint;
use rayon::prelude::*;
use std::collections::HashSet;

/// The triangles of a scene that are culled for one light, and their exact duplicates.
pub(super) struct CulledReceivers {
    is_culled: Vec<bool>,
}

impl CulledReceivers {
    /// `None` if nothing is culled. Exact duplicates of a culled triangle count too: they are cast as one.
    pub fn new(scene: &Scene, culled: &[PrimitiveIndex]) -> Option<CulledReceivers> {
        if culled.is_empty() {
            return None;
        }
        let keys: HashSet<_> = culled.iter().map(|&triangle| duplicate_key(scene, triangle)).collect();
        let is_culled = |triangle| keys.contains(&duplicate_key(scene, triangle));
        let is_culled = (0..scene.triangles.len() as u32).into_par_iter().map(is_culled).collect();
        Some(CulledReceivers { is_culled })
    }

    /// Whether a point lies on one of them.
    pub fn hold(&self, point: &SurfacePoint) -> bool {
        let is_culled = |primitive: PrimitiveIndex| self.is_culled.get(primitive as usize) == Some(&true);
        point.primitive().is_some_and(is_culled)
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.is_culled.len()
    }
}

impl LightBuffer<'_> {
    /// Whether a point on a culled triangle is occluded.
    pub(super) fn is_culled_point_occluded<F: Fn() -> ExactPosition>(
        &self,
        point: &SurfacePoint,
        query: &PreciseQuery<F>,
        counters: &mut Counters,
    ) -> bool {
        let asked = self.asked(point, query);
        let inside = |base| {
            let planes = LightTriangle::new(&self.casters.space, self.scene.corners(base));
            planes.is_some_and(|planes| planes.certainly_holds(asked.relative()))
        };
        point.primitive().is_some_and(inside)
            || (0..self.casters.planes.len() as u32).any(|caster| self.blocks(caster, &asked, counters))
    }
}
