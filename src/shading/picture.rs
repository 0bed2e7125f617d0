//! A whole picture: every visible point shaded by the lights that it sees.

use super::{Ambient, LightSample, geometric_normal, sample_light, shade, shading_normal, surface_colour};
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
    let corners = scene.corners(primitive);
    let object = &scene.objects[scene.triangles[primitive as usize].object as usize];
    let geometric = geometric_normal(corners, view);
    let within = (primitive - object.first) as usize;
    let weights = barycentric(corners.map(|c| c.as_dvec3()), point.position);
    let normal = shading_normal(object.normals.as_ref(), within, weights, geometric);
    let material = scene.material(primitive);
    let albedo = surface_colour(scene, primitive, material, point.position);
    let radiance = match material.texture {
        None => shade(material, normal, view, ambient, samples),
        Some(_) => shade(&material.painted(albedo), normal, view, ambient, samples),
    };
    ShadedPoint { radiance, normal, albedo, depth }
}

/// Weights of the corners at a point of the triangle; they add up to 1.
pub(super) fn barycentric([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    if area == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let wb = (p - a).cross(c - a).dot(normal) / area;
    let wc = (b - a).cross(p - a).dot(normal) / area;
    [1.0 - wb - wc, wb, wc]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_have_their_own_weight() {
        let corners = [DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 3.0, 1.0)];
        assert_eq!(barycentric(corners, corners[0]), [1.0, 0.0, 0.0]);
        assert_eq!(barycentric(corners, corners[1]), [0.0, 1.0, 0.0]);
        assert_eq!(barycentric(corners, corners[2]), [0.0, 0.0, 1.0]);
    }
}
