//! Where the vertices of a scene are in a picture, once for all triangles that share them.

use super::view::{PLACE_ERROR, View};
use crate::float_environment::InStandardFloats;
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::footprint::OnGrid;
use glam::{DVec3, Vec3};
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
    /// At least 1 / depth. [`BEHIND`] if the vertex is behind the camera for certain; NaN if not even that is known. The place
    /// then means nothing.
    pub nearness: f32,
}

/// The nearness of what is behind the camera.
pub(super) const BEHIND: f32 = -1.0;

/// Places of all vertices.
pub(super) fn places(set: InstructionSet, view: &View) -> Vec<Place> {
    let vertices = &view.scene.vertices;
    let mut places = vec![Place { column: 0.0, row: 0.0, nearness: 0.0 }; vertices.len()];
    let tasks = places.par_chunks_mut(TASK).zip(vertices.par_chunks(TASK)).in_standard_floats();
    tasks.for_each(|(places, vertices)| project(set, view, vertices, places));
    places
}

for_instruction_sets! {
    /// Projects some vertices.
    fn project = project_body, (view: &View, vertices: &[Vec3], places: &mut [Place])
}

/// Eight at a time, of which numbers of one kind lie together.
#[inline(always)]
fn project_body(_: InstructionSet, view: &View, vertices: &[Vec3], places: &mut [Place]) {
    const GROUP: usize = 8;
    for (vertices, places) in vertices.chunks(GROUP).zip(places.chunks_mut(GROUP)) {
        let mut coordinates = [[0.0; GROUP]; 3];
        for (i, vertex) in vertices.iter().enumerate() {
            (coordinates[0][i], coordinates[1][i], coordinates[2][i]) = (vertex.x, vertex.y, vertex.z);
        }
        let (mut columns, mut rows, mut nearness) = ([0.0; GROUP], [0.0; GROUP], [0.0; GROUP]);
        for i in 0..GROUP {
            let [x, y, z] = &coordinates;
            let place = Place::new(view, DVec3::new(x[i].into(), y[i].into(), z[i].into()));
            (columns[i], rows[i], nearness[i]) = (place.column, place.row, place.nearness);
        }
        for (i, place) in places.iter_mut().enumerate() {
            *place = Place { column: columns[i], row: rows[i], nearness: nearness[i] };
        }
    }
}

impl Place {
    #[inline(always)]
    fn new(view: &View, vertex: DVec3) -> Place {
        let OnGrid { on_grid, error, least_depth, is_before, is_behind } =
            view.frame.look_at(vertex - view.apex);
        let [left, top] = view.grid.origin;
        let [across, down] = view.grid.step;
        let (column, row) = ((on_grid[0] - left) / across, (on_grid[1] - top) / down);
        let error = error / view.smallest_step;
        // Half of the error is for the roundings of these divisions and of what goes before them.
        let most = 1.000_001 / least_depth;
        let is_known = is_before
            & (error < 0.5 * PLACE_ERROR)
            & (column.abs() < 1e9)
            & (row.abs() < 1e9)
            & (most > 1e-30)
            & (most < 1e30);
        let unknown = if is_behind { BEHIND } else { f32::NAN };
        Place {
            column: column as f32,
            row: row as f32,
            nearness: if is_known { most as f32 } else { unknown },
        }
    }
}
