//! Full occlusion by a convex object of several triangles (row 9 of the notes on the 1986 paper).
//!
//! The rays of a light that pass through a convex solid form a convex set. If the four corners of a cell lie
//! strictly inside its projection, so does the whole cell, and every ray of the cell enters the solid
//! through a triangle whose outer side the light is strictly on: whatever is deeper than all such triangles
//! of the solid in the cell is dark.

use super::cell::{Candidate, Cover};
use crate::geometry::Sign;
use crate::geometry::convexity::Surface;
use crate::geometry::footprint::{Footprint, Grid};
use crate::geometry::planes::orientation;
use crate::scene::{Object, PrimitiveIndex};
use crate::shadow::{BuildInput, Casters};

/// Which casters are the near side of closed convex objects that are cast whole.
pub(super) struct ConvexObjects {
    /// Object of each caster, if it is one and the light lies outside of that triangle; empty if the scene
    /// has none.
    objects: Vec<Option<u32>>,
}

impl ConvexObjects {
    /// An object counts only if it has no holes and all of its triangles are cast for it: a face that was
    /// merged with another object's would be missing from its depth. Far sides that were culled are not: they
    /// are no near sides.
    pub fn new(input: &BuildInput, casters: &Casters) -> ConvexObjects {
        let scene = input.scene;
        let object_of = |primitive: PrimitiveIndex| scene.object_index(primitive);
        let mut cast = vec![0; scene.objects.len()];
        input
            .index
            .casting(input.scene)
            .iter()
            .for_each(|&primitive| cast[object_of(primitive) as usize] += 1);
        let object_before = |&primitive: &PrimitiveIndex| {
            if scene.is_curved(primitive) {
                return None;
            }
            let object = object_of(primitive);
            let Object { first, count, .. } = scene.objects[object as usize];
            let convexity = input.index.convexity(input.scene)[object as usize].as_ref()?;
            let light = orientation(input.light, scene.corners(primitive));
            let outside = convexity.inner_side[(primitive - first) as usize] * light == Sign::Negative;
            // One with holes lets light through.
            let whole = scene.masked(primitive).is_none()
                && convexity.surface == Surface::Closed
                && cast[object as usize] == count;
            (whole && outside).then_some(object)
        };
        let objects: Vec<_> = casters.primitives.iter().map(object_before).collect();
        let any = objects.iter().any(Option::is_some);
        ConvexObjects { objects: if any { objects } else { Vec::new() } }
    }

    /// The least depth behind which a convex object darkens the whole cell, or infinity.
    pub fn cover_depth<'a>(
        &self,
        candidates: &[Candidate],
        footprint: impl Fn(usize) -> &'a Footprint,
        grid: &Grid,
        column: u32,
        row: u32,
    ) -> f32 {
        if self.objects.is_empty() || candidates.len() < 2 {
            return f32::INFINITY;
        }
        let members: Vec<(u32, usize)> = candidates
            .iter()
            .enumerate()
            .filter(|(_, c)| c.cover == Cover::Part)
            .filter_map(|(k, c)| Some((self.objects[c.role.caster()? as usize]?, k)))
            .collect();
        covered_depth(candidates, members, footprint, grid, column, row)
    }
}

/// The least depth behind which one of several convex shapes darkens the whole cell, or infinity. `members` are
/// candidates that are parts of shapes, each with the number of its shape: a projection holds the cell if it holds
/// its corners.
pub(super) fn covered_depth<'a>(
    candidates: &[Candidate],
    mut members: Vec<(u32, usize)>,
    footprint: impl Fn(usize) -> &'a Footprint,
    grid: &Grid,
    column: u32,
    row: u32,
) -> f32 {
    members.sort_unstable();
    members
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|shape| shape.len() > 1)
        .filter(|shape| {
            let inside = |x: f64, y: f64| shape.iter().any(|&(_, k)| footprint(k).contains(x, y));
            grid.corners(column, row).iter().all(|&[x, y]| inside(x, y))
        })
        .map(|shape| shape.iter().map(|&(_, k)| candidates[k].far).fold(f32::NEG_INFINITY, f32::max))
        .fold(f32::INFINITY, f32::min)
}
