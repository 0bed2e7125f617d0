//! Full occlusion by a convex object of several triangles (row 9 of the notes on the 1986 paper).
//!
//! The directions that pass through a convex solid form a convex cone. If the four corners of a cell lie
//! strictly inside its projection, so does the whole cell, and every direction of the cell enters the solid
//! through a triangle that faces the light strictly: whatever is deeper than all of the solid's triangles in
//! the cell is dark. (With the light inside it leaves the solid through one.)

use super::build::round_up;
use super::cell::{Candidate, Cover};
use crate::geometry::convexity::Surface;
use crate::geometry::footprint::{Footprint, Grid};
use crate::shadow::{BuildInput, Casters};

/// Which casters belong to closed convex objects that are cast whole.
pub(super) struct ConvexObjects {
    /// Object of each caster, if it is one; empty if the scene has no such object.
    objects: Vec<Option<u32>>,
}

impl ConvexObjects {
    /// An object counts only if all of its triangles are cast for it: a face that was merged with another
    /// object's would be missing from its depth, and from inside nothing else of it need be as deep.
    pub fn new(input: &BuildInput, casters: &Casters) -> ConvexObjects {
        let scene = input.scene;
        let object = |&primitive: &u32| scene.triangles[primitive as usize].object;
        let mut cast = vec![0; scene.objects.len()];
        input.index.casting.iter().map(object).for_each(|o| cast[o as usize] += 1);
        let whole = |object: u32| {
            let convexity = &input.index.convexity[object as usize];
            convexity.as_ref().is_some_and(|c| c.surface == Surface::Closed)
                && cast[object as usize] == scene.objects[object as usize].count
        };
        let objects: Vec<_> = casters.primitives.iter().map(object).map(|o| whole(o).then_some(o)).collect();
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
        let mut members: Vec<(u32, usize)> = candidates
            .iter()
            .enumerate()
            .filter(|(_, c)| c.cover == Cover::Part)
            .filter_map(|(k, c)| Some((self.objects[c.caster as usize]?, k)))
            .collect();
        members.sort_unstable();
        members
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|object| object.len() > 1)
            .filter(|object| {
                let inside = |x: f64, y: f64| object.iter().any(|&(_, k)| footprint(k).contains(x, y));
                grid.corners(column, row).iter().all(|&[x, y]| inside(x, y))
            })
            .map(|object| object.iter().map(|&(_, k)| candidates[k].far).fold(round_up(0.0), f32::max))
            .fold(f32::INFINITY, f32::min)
    }
}
