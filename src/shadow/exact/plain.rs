//! The definition itself, in integers: every triangle, no filter, no culling. It checks the arbiter.

use super::Occlusion;
use super::integer::{IntegerLight, LitTriangle, RelativePoint, Scale, scale_of, scale_of_light, side};
use super::mask;
use crate::geometry::LightPosition;
use crate::scene::{PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;

/// All triangles of a scene as exact planes relative to one light, in one scale.
pub struct PlainTest<'a> {
    scene: &'a Scene,
    light: IntegerLight,
    scale: Scale,
    triangles: Vec<(PrimitiveIndex, LitTriangle)>,
}

impl<'a> PlainTest<'a> {
    /// Prepares the planes; the scale holds every vertex, the light and the points that will be asked.
    pub fn new(scene: &'a Scene, light: LightPosition, points: &[SurfacePoint]) -> PlainTest<'a> {
        let casting = || (0..scene.triangles.len() as u32).filter(|&t| scene.object(t).shadowing.casts);
        let corners = casting().flat_map(|t| scene.corners(t));
        let scale = points
            .iter()
            .map(|p| scale_of(&p.exact(scene), light))
            .fold(Scale::of(corners).finer(scale_of_light(light)), Scale::finer);
        let light = IntegerLight::new(light, scale);
        let lit = |t: u32| Some((t, LitTriangle::new(&light, scene.corners(t), scale)?));
        let triangles = casting().filter_map(lit).collect();
        PlainTest { scene, light, scale, triangles }
    }

    /// Whether any triangle blocks the open segment from the point to the light.
    pub fn decide(&self, point: &SurfacePoint) -> Occlusion {
        let p = RelativePoint::new(&point.exact(self.scene), &self.light, self.scale);
        let blocks = |(primitive, t): &(PrimitiveIndex, LitTriangle)| {
            t.edges.iter().all(|edge| side(edge, &p) >= 0)
                && side(&t.own, &p) > 0
                && self.scene.masked(*primitive).is_none_or(|masked| mask::is_there(&masked, t, &p))
        };
        if self.triangles.iter().any(blocks) { Occlusion::Occluded } else { Occlusion::Lit }
    }
}
