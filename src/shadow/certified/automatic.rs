//! How large triangles are, and how many cells a view that is drawn once should have.
//!
//! More cells decide more queries; but each costs something, and where triangles are long, so does each cell that
//! one crosses. Measured with a light over 1.2 to 1.6 million receivers, on scenes of 70,000 to a million triangles whose
//! size, at a thousand cells along an edge, is 1.4 cells (mountains) to 14 (hair): the fastest resolutions were from 1000 down to
//! 200, and this is within a tenth of the time of each.

use super::Certified;
use super::projection::{Projected, Projector};

/// Triangles that are looked at.
const SAMPLES: usize = 1024;
/// The width and height of triangles together, in cells, up to which more cells cost little.
const SMALL: f64 = 1.5;
/// The sample is taken as if there were so many cells along an edge.
pub(super) const CELLS: u32 = 1024;

impl Certified<'_> {
    /// The number of cells along an edge for so many receivers.
    pub fn automatic_resolution(&self, receivers: usize) -> u32 {
        let most = (receivers as f64 * 0.6).sqrt();
        let size = self.size_of_triangles() * most / f64::from(CELLS);
        let triangles = self.scene.triangles.len() as f64;
        let fewer = match size > SMALL {
            true => (SMALL / size).powf(0.75),
            false => 1.0,
        };
        // A few large triangles are in all cells soon.
        let least = if triangles * size < receivers as f64 { 0.5 } else { 0.1 };
        ((most * fewer.max(least)) as u32).next_multiple_of(16).clamp(16, 2048)
    }

    /// Width and height of triangles together, in cells if there were [`CELLS`] along an edge: the mean of some of them.
    pub(super) fn size_of_triangles(&self) -> f64 {
        let projector = Projector::new(self.light, CELLS);
        let triangles = &self.scene.triangles;
        let (mut sum, mut count) = (0.0, 0);
        for triangle in triangles.iter().step_by(triangles.len().div_ceil(SAMPLES).max(1)) {
            let corners = triangle
                .vertices
                .map(|vertex| projector.project(self.scene.vertices[vertex as usize].into()));
            // What lies on several sides is rare, unless there are few.
            let side = corners[0].side;
            if side == Projected::NOWHERE || corners.iter().any(|corner| corner.side != side) {
                continue;
            }
            let extent = |of: fn(&Projected) -> f32| {
                let values = corners.each_ref().map(of);
                values.into_iter().fold(f32::MIN, f32::max) - values.into_iter().fold(f32::MAX, f32::min)
            };
            let size = extent(|corner| corner.u) + extent(|corner| corner.v);
            sum += f64::from(size.clamp(0.0, CELLS as f32));
            count += 1;
        }
        if count == 0 { 0.0 } else { sum / f64::from(count) }
    }
}
