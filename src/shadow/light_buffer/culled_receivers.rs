//! Points on the far sides of solids, which were culled (row 4 of the notes on the 1986 paper).
//!
//! Such a side is in no list, so that the simplifications of a list (rows 10 and 11) would be wrong for points on
//! it. They would be void everywhere if it were a receiver all the same: under every near side there is a far
//! side. But nearly all of its points need no list. The light is outside of the solid, and its ray reaches the
//! inside of such a triangle from the inside of the solid, which it entered before: the point is occluded. Only on
//! an edge may the ray have passed beside the solid; there everything that is cast is tested.
//!
//! Hardly anybody asks: from outside of the solid its far sides face away from the light.

use super::LightBuffer;
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::{ExactPosition, LightTriangle};
use crate::scene::{PrimitiveIndex, Scene};
use crate::shadow::Counters;
use crate::shadow::duplicates::duplicate_key;
use crate::visibility::SurfacePoint;
use rayon::prelude::*;
use std::collections::HashSet;

/// The triangles of a scene that are culled for one light, and their exact duplicates.
pub(super) struct CulledReceivers {
    is_culled: Vec<bool>,
}

impl CulledReceivers {
    /// `None` if nothing is culled. Exact duplicates of a culled triangle count too: they are cast as one.
    pub fn new(scene: &Scene, culled: &[PrimitiveIndex]) -> Option<CulledReceivers> {
        if culled.is_empty() {
            return None;
        }
        let keys: HashSet<_> = culled.iter().map(|&triangle| duplicate_key(scene, triangle)).collect();
        let is_culled = |triangle| keys.contains(&duplicate_key(scene, triangle));
        let is_culled = (0..scene.triangles.len() as u32).into_par_iter().map(is_culled).collect();
        Some(CulledReceivers { is_culled })
    }

    /// Whether a point lies on one of them.
    pub fn hold(&self, point: &SurfacePoint) -> bool {
        let is_culled = |primitive: PrimitiveIndex| self.is_culled.get(primitive as usize) == Some(&true);
        point.primitive().is_some_and(is_culled)
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.is_culled.len()
    }
}

impl LightBuffer<'_> {
    /// Whether a point on a culled triangle is occluded.
    pub(super) fn is_culled_point_occluded<F: Fn() -> ExactPosition>(
        &self,
        point: &SurfacePoint,
        query: &PreciseQuery<F>,
        counters: &mut Counters,
    ) -> bool {
        let asked = self.asked(point, query);
        let inside = |base| {
            let planes = LightTriangle::new(&self.casters.space, self.scene.corners(base));
            planes.is_some_and(|planes| planes.certainly_holds(asked.relative()))
        };
        point.primitive().is_some_and(inside)
            || (0..self.casters.planes.len() as u32).any(|caster| self.blocks(caster, &asked, counters))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ObjectInput, SceneBuilder};
    use crate::shadow::{BuildInput, Culling, Resolution, SceneIndex, exact};
    use glam::Vec3;

    /// A box from one corner to the other, its outside outside.
    fn cuboid(low: [f32; 3], high: [f32; 3]) -> ObjectInput {
        let corner =
            |i: usize| Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] }));
        let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        ObjectInput::new("box", (0..8).map(corner).collect(), triangles)
    }

    #[test]
    fn from_inside_of_a_solid_its_far_sides_are_dark_but_for_edges_that_the_light_grazes() {
        // The second box has a side in common with the first: that is cast once, for the first.
        let mut builder = SceneBuilder::new("test");
        builder.add_object(cuboid([-2.0, -2.0, -2.0], [2.0, 2.0, 2.0])).unwrap();
        builder.add_object(cuboid([-2.0, -2.0, -6.0], [2.0, 2.0, -2.0])).unwrap();
        let scene = builder.finish();
        let index = SceneIndex::new(&scene);
        let eye = Vec3::new(0.5, -0.25, 1.0);
        let light = Vec3::new(3.0, 5.0, 9.0);
        let inside = |t: u32, u: i32, v: i32| {
            let [a, b, c] = scene.corners(t);
            let target = a + (b - a) * (u as f32 / 4.0) + (c - a) * (v as f32 / 4.0);
            SurfacePoint::on_ray(&scene, eye, target - eye, t)
        };
        // Corners, edges and insides of all triangles of the first box, and of the common side of the second.
        let towards = |&t: &u32| t < 12 || scene.corners(t).iter().all(|p| p.z == -2.0);
        let points: Vec<_> = (0..scene.triangles.len() as u32)
            .filter(towards)
            .flat_map(|t| (0..=4).flat_map(move |u| (0..=4 - u).map(move |v| (t, u, v))))
            .map(|(t, u, v)| inside(t, u, v))
            .collect();
        let answers = |build: &crate::shadow::Build, resolution: u32| {
            let input = BuildInput {
                resolution: Resolution::Cells(resolution),
                culling: Culling::ClosedSolids,
                ..BuildInput::new(&scene, &index, light)
            };
            let mut answers = vec![false; points.len()];
            let counters = build(&input).unwrap().occluded(&points, &mut answers).unwrap();
            (answers, counters.tests)
        };
        let (truth, _) = answers(exact::ENTRY.build, 1);
        assert!(truth.iter().any(|&t| t) && !truth.iter().all(|&t| t));
        for resolution in [1, 7, 64] {
            let (found, tests) = answers(&|input| Ok(Box::new(LightBuffer::new(input)?)), resolution);
            assert_eq!(found, truth, "R = {resolution}");
            assert!(tests < 12 * points.len() as u64, "points inside of a triangle need no test");
        }
    }
}
