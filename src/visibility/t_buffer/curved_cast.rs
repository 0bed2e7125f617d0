//! Curved surfaces in the t-buffer: the rays that the projection of a hull covers are tried.

use super::band::Band;
use super::view::View;
use crate::float_environment::InStandardFloats;
use crate::geometry::curved::RayStart;
use crate::geometry::curved::hull::{self, Hull};
use crate::geometry::footprint::{Footprint, Grid};
use crate::geometry::outline::{Outline, Projected};
use crate::geometry::planes::OrientedPlanes;
use crate::scene::PrimitiveIndex;
use crate::visibility::hit::Hit;
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
    pub fn portions<'a>(view: &'a View<'a>) -> impl Iterator<Item = Vec<CurvedCast>> + use<'a> {
        let all = view.scene.triangles.len() as u32..view.scene.primitive_count();
        let end = all.end;
        all.step_by(CHUNK as usize).map(move |first| {
            let portion = first..end.min(first + CHUNK);
            let casts = portion.into_par_iter().in_standard_floats();
            casts.filter_map(|primitive| CurvedCast::new(view, primitive)).collect()
        })
    }

    /// `None` if no ray can hit the surface.
    fn new(view: &View, primitive: PrimitiveIndex) -> Option<CurvedCast> {
        let shape = view.scene.shape(primitive)?;
        let Some(hull) = hull::outer(shape) else { return Some(CurvedCast { primitive, rays: Rays::All }) };
        let apex = view.camera.origin.as_dvec3();
        let mesh = hull.iter().map(|triangle| triangle.map(|p| p - apex));
        let rays = match Outline::project(&view.grid, &view.frame, mesh) {
            Projected::Nowhere => return None,
            Projected::Within(outline) => Rays::Within(outline),
            Projected::TooNear => Rays::Covered(footprints(view, &hull)),
        };
        Some(CurvedCast { primitive, rays })
    }

    /// Tries the rays of a band.
    pub fn draw(&self, view: &View, band: &mut Band) {
        let rows = band.rows();
        let mut draw = |(row, [left, right]): (u32, [u32; 2])| {
            band.tests += u64::from(right - left + 1);
            for column in left..=right {
                let direction = view.direction(column, row);
                let start = RayStart::origin();
                let hit = Hit::curved(view.scene, self.primitive, view.camera.origin, direction, &start);
                if let Some(hit) = hit {
                    band.offer(view, hit, direction, [column, row]);
                }
            }
        };
        match &self.rays {
            Rays::All => (rows[0]..rows[1]).for_each(|row| draw((row, [0, view.grid.count[0] - 1]))),
            Rays::Within(outline) => outline.spans(rows).for_each(draw),
            Rays::Covered(footprints) => {
                let span = |row| Some((row, covered(footprints, &view.grid, row)?));
                (rows[0]..rows[1]).filter_map(span).for_each(draw);
            }
        }
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

fn footprints(view: &View, hull: &Hull) -> Vec<Footprint> {
    let apex = view.camera.origin.as_dvec3();
    let planes = hull.iter().filter_map(|&corners| OrientedPlanes::of_hull(apex, corners));
    planes.filter_map(|planes| Footprint::new(&view.grid, &view.frame, &planes)).collect()
}
