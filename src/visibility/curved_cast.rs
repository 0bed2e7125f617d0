//! Curved surfaces in the t-buffer: the rays that the projection of a hull covers are tried.

use super::hit::{Hit, keep_nearer};
use crate::geometry::curved::RayStart;
use crate::geometry::curved::hull::{self, Hull};
use crate::geometry::footprint::{Footprint, Frame, Grid};
use crate::geometry::planes::OrientedPlanes;
use crate::scene::{Camera, PrimitiveIndex, Raster, Scene};
use rayon::prelude::*;

/// Surfaces that are prepared at a time.
const CHUNK: u32 = 1 << 12;

/// A curved surface and the rays that can hit it.
pub(super) struct CurvedCast {
    primitive: PrimitiveIndex,
    rays: Rays,
}

enum Rays {
    /// Any.
    All,
    /// Those that one of these projections covers.
    Covered(Vec<Footprint>),
}

impl CurvedCast {
    /// All curved surfaces of a scene that can be seen, in portions.
    pub fn chunks(
        scene: &Scene,
        camera: &Camera,
        grid: &Grid,
        frame: &Frame,
    ) -> impl Iterator<Item = Vec<CurvedCast>> {
        let all = scene.triangles.len() as u32..scene.primitive_count();
        let end = all.end;
        all.step_by(CHUNK as usize).map(move |first| {
            let chunk = first..end.min(first + CHUNK);
            chunk.into_par_iter().filter_map(|p| CurvedCast::new(scene, p, camera, grid, frame)).collect()
        })
    }

    /// `None` if no ray can hit the surface.
    fn new(
        scene: &Scene,
        primitive: PrimitiveIndex,
        camera: &Camera,
        grid: &Grid,
        frame: &Frame,
    ) -> Option<CurvedCast> {
        let shape = scene.shape(primitive)?;
        let Some(hull) = hull::outer(shape) else { return Some(CurvedCast { primitive, rays: Rays::All }) };
        let footprints = footprints(&hull, camera, grid, frame);
        (!footprints.is_empty()).then_some(CurvedCast { primitive, rays: Rays::Covered(footprints) })
    }

    /// Casts into a band of rows; returns the number of rays tested.
    pub fn fill(
        &self,
        scene: &Scene,
        camera: &Camera,
        raster: &Raster,
        grid: &Grid,
        first_row: u32,
        items: &mut [Option<Hit>],
    ) -> u64 {
        let start = RayStart::origin();
        let mut tests = 0;
        for (line, row) in items.chunks_mut(grid.count[0] as usize).zip(first_row..) {
            let Some([left, right]) = self.span(grid, row) else { continue };
            tests += u64::from(right - left + 1);
            for column in left..=right {
                let direction = camera.direction(raster, column, row);
                if let Some(hit) = Hit::curved(scene, self.primitive, camera.origin, direction, &start) {
                    keep_nearer(&mut line[column as usize], hit, scene, camera.origin, direction);
                }
            }
        }
        tests
    }

    /// First and last column in one row, if any.
    fn span(&self, grid: &Grid, row: u32) -> Option<[u32; 2]> {
        match &self.rays {
            Rays::All => Some([0, grid.count[0] - 1]),
            Rays::Covered(footprints) => footprints
                .iter()
                .filter(|footprint| (footprint.rows()[0]..=footprint.rows()[1]).contains(&row))
                .filter_map(|footprint| footprint.span(grid, row))
                .reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]),
        }
    }
}

fn footprints(hull: &Hull, camera: &Camera, grid: &Grid, frame: &Frame) -> Vec<Footprint> {
    let apex = camera.origin.as_dvec3();
    let planes = hull.iter().filter_map(|&corners| OrientedPlanes::of_hull(apex, corners));
    planes.filter_map(|planes| Footprint::new(grid, frame, &planes)).collect()
}
