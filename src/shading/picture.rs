//! A whole picture: every visible point shaded by the lights that it sees.

use super::{Ambient, LightSample, normal_at, sample_light, shade};
use crate::scene::{Camera, Light, Scene};
use crate::visibility::{SurfacePoint, VisibleSurfaces};
use glam::DVec3;
use rayon::prelude::*;

/// One visible point as the film needs it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadedPoint {
    /// Radiance towards the camera, linear Rec. 709.
    pub radiance: [f32; 3],
    /// Shading normal, unit length, towards the camera's side.
    pub normal: DVec3,
    /// Diffuse colour.
    pub albedo: [f32; 3],
    /// Distance from the camera along its view direction.
    pub depth: f64,
}

/// Shades all visible points. `sees[l][i]` says whether point i sees light l.
pub fn shade_picture(
    scene: &Scene,
    camera: &Camera,
    lights: &[Light],
    visible: &VisibleSurfaces,
    sees: &[Vec<bool>],
) -> Vec<ShadedPoint> {
    let ambient = Ambient::default();
    visible
        .points
        .par_iter()
        .enumerate()
        .map(|(i, point)| {
            let seen = lights.iter().zip(sees).filter(|(_, sees)| sees[i]);
            let samples: Vec<LightSample> =
                seen.filter_map(|(light, _)| sample_light(light, point.position)).collect();
            shade_point(scene, camera, point, &ambient, &samples)
        })
        .collect()
}

fn shade_point(
    scene: &Scene,
    camera: &Camera,
    point: &SurfacePoint,
    ambient: &Ambient,
    samples: &[LightSample],
) -> ShadedPoint {
    let from_eye = point.position - camera.origin.as_dvec3();
    let depth = from_eye.dot(camera.forward.as_dvec3());
    let view = -from_eye.normalize_or(-camera.forward.as_dvec3());
    let Some(primitive) = point.primitive() else {
        return ShadedPoint { radiance: [0.0; 3], normal: view, albedo: [0.0; 3], depth };
    };
    let normal = normal_at(scene, primitive, point.position, view);
    let material = scene.material(primitive);
    let radiance = shade(material, normal, view, ambient, samples);
    ShadedPoint { radiance, normal, albedo: material.diffuse, depth }
}
