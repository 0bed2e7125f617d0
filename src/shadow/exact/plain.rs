//! The definition itself, in integers: every triangle, no filter, no culling. It checks the arbiter.

use super::Occlusion;
use super::integer::{IntegerVector, RelativePoint, Scale, cross, dot, minus, scale_of, sign};
use crate::scene::Scene;
use crate::visibility::SurfacePoint;
use dashu_int::IBig;
use glam::Vec3;

/// All triangles of a scene as exact planes relative to one light, in one scale.
pub struct PlainTest<'a> {
    scene: &'a Scene,
    light: Vec3,
    scale: Scale,
    triangles: Vec<ExactPlanes>,
}

/// Edge planes oriented inwards, and the plane's normal and height, oriented away from the light.
struct ExactPlanes {
    edges: [IntegerVector; 3],
    normal: IntegerVector,
    height: IBig,
}

impl<'a> PlainTest<'a> {
    /// Prepares the planes; the scale holds every vertex, the light and the points that will be asked.
    pub fn new(scene: &'a Scene, light: Vec3, points: &[SurfacePoint]) -> PlainTest<'a> {
        let corners = (0..scene.triangles.len() as u32).flat_map(|t| scene.corners(t));
        let scale = points
            .iter()
            .map(|p| scale_of(&p.exact(scene), light))
            .fold(Scale::of(corners.chain([light])), Scale::finer);
        let origin = scale.point(light);
        let planes = |t: u32| {
            let u = scene.corners(t).map(|c| minus(&scale.point(c), &origin));
            let mut edges = [cross(&u[0], &u[1]), cross(&u[1], &u[2]), cross(&u[2], &u[0])];
            let mut normal = cross(&minus(&u[1], &u[0]), &minus(&u[2], &u[0]));
            let mut height = dot(&normal, &u[0]);
            if sign(&height) < 0 {
                edges = edges.map(|e| e.map(|x| -x));
                normal = normal.map(|x| -x);
                height = -height;
            }
            (sign(&height) != 0).then_some(ExactPlanes { edges, normal, height })
        };
        let triangles = (0..scene.triangles.len() as u32).filter_map(planes).collect();
        PlainTest { scene, light, scale, triangles }
    }

    /// Whether any triangle blocks the open segment from the point to the light.
    pub fn decide(&self, point: &SurfacePoint) -> Occlusion {
        let p = RelativePoint::new(&point.exact(self.scene), self.light, self.scale);
        let blocks = |t: &ExactPlanes| {
            t.edges.iter().all(|edge| sign(&dot(edge, &p.xyz)) >= 0)
                && dot(&t.normal, &p.xyz) > &t.height * &p.w
        };
        if self.triangles.iter().any(blocks) { Occlusion::Occluded } else { Occlusion::Lit }
    }
}
