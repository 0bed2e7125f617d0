//! Where the vertices of a scene are in a picture, once for all triangles that share them.

use super::view::{PLACE_ERROR, View};
use crate::float_environment::InStandardFloats;
use glam::Vec3;
use rayon::prelude::*;

/// Vertices that one task projects.
const TASK: usize = 1 << 12;

/// Where a vertex is seen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// In pixels, from the centre of the first: within [`PLACE_ERROR`] and 2^-23 of itself.
    pub column: f32,
    /// The same.
    pub row: f32,
    /// At least 1 / depth. [`BEHIND`] if the vertex is behind the camera for certain; NaN if not even that is known, and the
    /// place neither.
    pub nearness: f32,
}

/// The nearness of what is behind the camera.
pub(super) const BEHIND: f32 = -1.0;

/// Places of all vertices.
pub(super) fn places(view: &View) -> Vec<Place> {
    let vertices = &view.scene.vertices;
    let mut places = vec![Place { column: 0.0, row: 0.0, nearness: f32::NAN }; vertices.len()];
    places.par_chunks_mut(TASK).zip(vertices.par_chunks(TASK)).in_standard_floats().for_each(
        |(places, vertices)| {
            for (place, &vertex) in places.iter_mut().zip(vertices) {
                *place = Place::new(view, vertex);
            }
        },
    );
    places
}

impl Place {
    fn new(view: &View, vertex: Vec3) -> Place {
        let seen = vertex.as_dvec3() - view.camera.origin.as_dvec3();
        let unknown = |nearness| Place { column: 0.0, row: 0.0, nearness };
        let Some(point) = view.frame.project(seen) else {
            return unknown(if view.frame.is_behind(seen) { BEHIND } else { f32::NAN });
        };
        let pixel = |axis: usize| (point.on_grid[axis] - view.grid.origin[axis]) / view.grid.step[axis];
        let error = point.error / view.grid.step[0].abs().min(view.grid.step[1].abs());
        let [column, row] = [pixel(0), pixel(1)];
        // Half of the error is for the roundings of the division and of the two before it.
        let nearness = 1.000_001 / point.least_depth;
        let is_known = error < 0.5 * PLACE_ERROR
            && column.abs().max(row.abs()) < 1e9
            && (1e-30..1e30).contains(&nearness);
        match is_known {
            true => Place { column: column as f32, row: row as f32, nearness: nearness as f32 },
            false => unknown(f32::NAN),
        }
    }
}
