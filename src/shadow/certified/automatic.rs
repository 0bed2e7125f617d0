//! How large triangles are, in which directions receivers lie, and how many cells a view that is drawn once should have.
//!
//! More cells decide more queries; but each costs something, and where triangles are long, so does each cell that
//! one crosses. Around a light far away a scene is a speck on one side, and has as many cells there as it would have around one in
//! its middle. Measured with lights over 1.2 to 1.9 million receivers, on scenes of 70,000 to a million triangles, from amid
//! them and from afar: a cell for twelve receivers is within a tenth of the best time everywhere, but where triangles are long.

use super::projection::{Projected, Projector};
use super::{Certified, MOST_CELLS};
use crate::visibility::{Points, RoundedPoint};

/// Triangles that are looked at.
const SAMPLES: usize = 1024;
/// Receivers that are looked at.
const SAMPLES_OF_RECEIVERS: usize = 4096;
/// Cells for each of them, if triangles are small.
const CELLS_OF_A_RECEIVER: f64 = 0.08;
/// The width and height of triangles together, in cells, up to which more cells cost little.
const SMALL: f64 = 1.5;
/// The sample is taken as if there were so many cells along an edge.
pub(super) const CELLS: u32 = 1024;

impl Certified<'_> {
    /// The number of cells along an edge for some receivers.
    pub fn automatic_resolution(&self, points: Points<'_>) -> u32 {
        let receivers = points.len() as f64;
        let most = (receivers * CELLS_OF_A_RECEIVER / (6.0 * self.share_of_directions(points))).sqrt();
        let size = self.size_of_triangles() * most / f64::from(CELLS);
        let triangles = self.scene.triangles.len() as f64;
        let fewer = match size > SMALL {
            true => (SMALL / size).powf(0.75),
            false => 1.0,
        };
        // A few large triangles are in all cells soon.
        let least = if triangles * size < receivers { 0.5 } else { 0.1 };
        ((most * fewer.max(least)) as u32).next_multiple_of(16).clamp(16, MOST_CELLS)
    }

    /// In which part of all directions receivers lie: what is left of the cube where cells without any are left out, of such a
    /// width that the others have some of a sample each.
    fn share_of_directions(&self, points: Points<'_>) -> f64 {
        let projector = Projector::new(self.light, MOST_CELLS);
        let step = points.len().div_ceil(SAMPLES_OF_RECEIVERS).max(1);
        // One of each step, but not always the first: pictures have rows.
        let one_of = |some: (usize, &[RoundedPoint])| {
            let (number, some) = some;
            some[((number as u32).wrapping_mul(0x9e37_79b9) >> 16) as usize % some.len()]
        };
        let mut places: Vec<u64> = points
            .rounded()
            .chunks(step)
            .enumerate()
            .map(one_of)
            .map(|point| projector.project(point.position))
            .filter(|at| at.side != Projected::NOWHERE)
            .map(|at| u64::from(at.side) << 32 | spread(at.u) << 1 | spread(at.v))
            .collect();
        places.sort_unstable();
        let occupied = |bits: u32| places.chunk_by(|a, b| a >> (2 * bits) == b >> (2 * bits)).count();
        let bits = MOST_CELLS.ilog2();
        let coarser = (0..bits).find(|&coarser| 4 * occupied(coarser) <= places.len()).unwrap_or(bits);
        let all = 6 << (2 * (bits - coarser));
        occupied(coarser).max(1) as f64 / f64::from(all)
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

/// The bits of the cell that a coordinate lies in, each with a zero beside it.
fn spread(coordinate: f32) -> u64 {
    let cell = (coordinate.max(0.0) as u32).min(MOST_CELLS - 1);
    (0..MOST_CELLS.ilog2()).map(|bit| u64::from(cell >> bit & 1) << (2 * bit)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::batch::InstructionSet;
    use crate::memory::MemoryLimit;
    use crate::scene::{ObjectInput, SceneBuilder};
    use crate::visibility::SurfacePoint;
    use glam::Vec3;

    /// How many cells a light has for points all over a square of side 1 around the origin, in which one small triangle lies.
    fn resolution(light: Vec3) -> (u32, f64) {
        let mut builder = SceneBuilder::new("square");
        let corners = vec![Vec3::ZERO, Vec3::new(1e-4, 0.0, 0.0), Vec3::new(0.0, 1e-4, 0.0)];
        builder.add_object(ObjectInput::new("small", corners, vec![[0, 1, 2]])).expect("indices in range");
        let scene = builder.finish();
        let at = |i: u16| (f32::from(i) + 0.5) / 256.0 - 0.5;
        let all = (0..1u32 << 16).map(|i| Vec3::new(at(i as u16 & 255), at((i >> 8) as u16), 0.0));
        let exact: Vec<_> = all.map(|p| SurfacePoint::bare(p).expect("finite")).collect();
        let rounded = RoundedPoint::all(&exact);
        let (set, memory) = (InstructionSet::Portable, MemoryLimit::bytes(1 << 30));
        let certified = Certified { scene: &scene, light, set, memory };
        let points = Points::new(&rounded, &exact);
        (certified.automatic_resolution(points), certified.share_of_directions(points))
    }

    #[test]
    fn a_light_far_away_has_as_many_cells_where_receivers_are() {
        // A square of side 1 at a distance d is (R / 2 d) cells wide.
        for distance in [2.0f32, 8.0, 32.0] {
            let (resolution, share) = resolution(Vec3::new(0.0, 0.0, distance));
            let expected = 1.0 / (24.0 * f64::from(distance).powi(2));
            assert!((0.7..3.0).contains(&(share / expected)), "{distance}: {share}");
            let across = f64::from(resolution) / (2.0 * f64::from(distance));
            let cells = across * across / f64::from(1 << 16);
            assert!((0.02..0.2).contains(&cells), "{distance}: {cells} cells for each receiver");
        }
        assert_eq!(resolution(Vec3::new(0.0, 0.0, 1e6)).0, MOST_CELLS);
    }

    #[test]
    fn who_asks_nothing_has_a_few_cells() {
        let mut builder = SceneBuilder::new("nothing");
        let corners = vec![Vec3::X, Vec3::Y, Vec3::Z];
        builder.add_object(ObjectInput::new("one", corners, vec![[0, 1, 2]])).expect("indices in range");
        let scene = builder.finish();
        let (set, memory) = (InstructionSet::Portable, MemoryLimit::bytes(1 << 30));
        let certified = Certified { scene: &scene, light: Vec3::ZERO, set, memory };
        assert_eq!(certified.automatic_resolution(Points::new(&[], &[])), 16);
    }
}
