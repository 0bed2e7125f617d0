//! Whether casters lie in one plane, exactly: the paper's polygons are triangles here, and those of one polygon
//! shadow each other no more than the polygon itself (row 11 of the notes on the 1986 paper).

use super::cell::Candidate;
use crate::geometry::Sign;
use crate::geometry::planes::orientation;
use crate::scene::Scene;
use crate::shadow::Casters;
use glam::Vec3;

/// The triangles behind the candidates.
pub(super) struct Flatness<'a> {
    pub scene: &'a Scene,
    pub casters: &'a Casters,
}

impl Flatness<'_> {
    /// Whether all candidates are casting triangles of one plane.
    pub fn in_one_plane(&self, candidates: &[Candidate]) -> bool {
        let mut planes = candidates.iter().map(|candidate| self.corners(candidate));
        let Some(Some(first)) = planes.next() else { return false };
        planes.all(|corners| corners.is_some_and(|corners| lie_in_plane(first, corners)))
    }

    fn corners(&self, candidate: &Candidate) -> Option<[Vec3; 3]> {
        let primitive = self.casters.primitives[candidate.role.caster()? as usize];
        (!self.scene.is_curved(primitive)).then(|| self.scene.corners(primitive))
    }
}

/// Whether points lie in the plane of a triangle.
fn lie_in_plane(triangle: [Vec3; 3], points: [Vec3; 3]) -> bool {
    points.iter().all(|&point| orientation(point, triangle) == Sign::Zero)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_ulp_out_of_the_plane_is_another_plane() {
        let triangle = [Vec3::new(0.1, 0.2, 0.3), Vec3::new(1.7, 0.2, 0.3), Vec3::new(0.4, 5.0, 0.3)];
        let other = triangle.map(|p| p + Vec3::new(100.0, 7.0, 0.0));
        assert!(lie_in_plane(triangle, other));
        let mut tilted = other;
        tilted[2].z = tilted[2].z.next_up();
        assert!(!lie_in_plane(triangle, tilted));
    }
}
