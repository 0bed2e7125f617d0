//! Curved surfaces in the t-buffer: the rays that the projection of a hull covers are tried.

use super::hit::{Hit, keep_nearer};
use crate::float_environment::InStandardFloats;
use crate::geometry::curved::RayStart;
use crate::geometry::curved::hull::{self, Hull};
use crate::geometry::footprint::{Footprint, Frame, Grid};
use crate::geometry::outline::{Outline, Projected};
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
    /// Those of an outline.
    Within(Outline),
    /// Those that one of these projections covers: of a hull that is not all before the camera.
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
            let casts = chunk.into_par_iter().in_standard_floats();
            casts.filter_map(|p| CurvedCast::new(scene, p, camera, grid, frame)).collect()
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
        let apex = camera.origin.as_dvec3();
        let rays = match Outline::project(grid, frame, hull.iter().map(|triangle| triangle.map(|p| p - apex)))
        {
            Projected::Nowhere => return None,
            Projected::Within(outline) => Rays::Within(outline),
            Projected::TooNear => Rays::Covered(footprints(&hull, camera, grid, frame)),
        };
        Some(CurvedCast { primitive, rays })
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
        let width = grid.count[0];
        let rows = [first_row, first_row + (items.len() / width as usize) as u32];
        let mut tests = 0;
        let mut cast = |(row, [left, right]): (u32, [u32; 2])| {
            tests += u64::from(right - left + 1);
            let line = (row - first_row) as usize * width as usize;
            for column in left..=right {
                let direction = camera.direction(raster, column, row);
                let start = RayStart::origin();
                if let Some(hit) = Hit::curved(scene, self.primitive, camera.origin, direction, &start) {
                    let item = &mut items[line + column as usize];
                    keep_nearer(item, hit, scene, camera.origin, direction);
                }
            }
        };
        match &self.rays {
            Rays::All => (rows[0]..rows[1]).for_each(|row| cast((row, [0, width - 1]))),
            Rays::Within(outline) => outline.spans(rows).for_each(cast),
            Rays::Covered(footprints) => {
                let span = |row| Some((row, covered(footprints, grid, row)?));
                (rows[0]..rows[1]).filter_map(span).for_each(cast);
            }
        }
        tests
    }
}

/// First and last column in one row, if any.
fn covered(footprints: &[Footprint], grid: &Grid, row: u32) -> Option<[u32; 2]> {
    footprints
        .iter()
        .filter(|footprint| (footprint.rows()[0]..=footprint.rows()[1]).contains(&row))
        .filter_map(|footprint| footprint.span(grid, row))
        .reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
}

fn footprints(hull: &Hull, camera: &Camera, grid: &Grid, frame: &Frame) -> Vec<Footprint> {
    let apex = camera.origin.as_dvec3();
    let planes = hull.iter().filter_map(|&corners| OrientedPlanes::of_hull(apex, corners));
    planes.filter_map(|planes| Footprint::new(grid, frame, &planes)).collect()
}
