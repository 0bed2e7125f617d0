//! A whole picture: every visible point shaded by the lights that it sees.

use super::{Ambient, LightSample, RayForest, normal_at, sample_light, shade, surface_colour};
use crate::scene::{Camera, Light, Scene};
use crate::visibility::SurfacePoint;
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

/// Whether textures are looked at (2004 paper, section IV: a switch of REALITY).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Textures {
    /// Surfaces have the colours of theirs.
    #[default]
    On,
    /// Every surface has the one colour of its material.
    Off,
}

/// Shades what the camera sees, with what it sees in mirrors and through glass. `arriving[l][i]` is the share
/// of light l that arrives at point i of the forest.
pub fn shade_picture(
    scene: &Scene,
    camera: &Camera,
    lights: &[Light],
    forest: &RayForest,
    arriving: &[Vec<[f32; 3]>],
    textures: Textures,
) -> Vec<ShadedPoint> {
    let ambient = Ambient::default();
    let nodes = &forest.nodes;
    let mut shaded: Vec<ShadedPoint> = nodes
        .points
        .par_iter()
        .enumerate()
        .map(|(i, point)| {
            let seen = lights.iter().zip(arriving).filter(|(_, arriving)| arriving[i] != [0.0; 3]);
            let sample = |(light, arriving): (&Light, &Vec<[f32; 3]>)| {
                let sample = sample_light(light, point.position)?;
                let share = arriving[i];
                let irradiance = std::array::from_fn(|c| sample.irradiance[c] * f64::from(share[c]));
                Some(LightSample { irradiance, ..sample })
            };
            let samples: Vec<LightSample> = seen.filter_map(sample).collect();
            shade_point(scene, camera, point, &ambient, &samples, textures)
        })
        .collect();
    if shaded.len() > nodes.seen || !forest.sky.is_empty() {
        add_trees(scene, forest, &mut shaded);
    }
    shaded.truncate(nodes.seen);
    shaded
}

/// Adds what deeper levels of the trees show to the points that the camera sees, in f64 and in the order of the
/// levels.
fn add_trees(scene: &Scene, forest: &RayForest, shaded: &mut [ShadedPoint]) {
    let nodes = &forest.nodes;
    let mut sums: Vec<[f64; 3]> =
        shaded[..nodes.seen].iter().map(|point| point.radiance.map(f64::from)).collect();
    // The camera's points are in the order of their pixels.
    let root = |pixel: u32| nodes.pixels[..nodes.seen].binary_search(&pixel).expect("the pixel of a tree");
    let mut add = |pixel: u32, weight: [f32; 3], radiance: [f32; 3]| {
        let sum = &mut sums[root(pixel)];
        *sum = std::array::from_fn(|c| sum[c] + f64::from(weight[c]) * f64::from(radiance[c]));
    };
    for (i, point) in shaded.iter().enumerate().skip(nodes.seen) {
        add(nodes.pixels[i], forest.weights[i], point.radiance);
    }
    for &(pixel, weight) in &forest.sky {
        add(pixel, weight, scene.background);
    }
    for (point, sum) in shaded.iter_mut().zip(sums) {
        point.radiance = sum.map(|channel| channel as f32);
    }
}

fn shade_point(
    scene: &Scene,
    camera: &Camera,
    point: &SurfacePoint,
    ambient: &Ambient,
    samples: &[LightSample],
    textures: Textures,
) -> ShadedPoint {
    let from_eye = point.position - camera.origin.as_dvec3();
    let depth = from_eye.dot(camera.forward.as_dvec3());
    let (Some(primitive), Some(direction)) = (point.primitive(), point.direction()) else {
        let normal = -from_eye.normalize_or(-camera.forward.as_dvec3());
        return ShadedPoint { radiance: [0.0; 3], normal, albedo: [0.0; 3], depth };
    };
    let view = -direction.as_dvec3().normalize();
    let normal = normal_at(scene, primitive, point.position, view);
    let material = scene.material(primitive);
    let (albedo, radiance) = match (textures, material.texture) {
        (Textures::Off, _) | (_, None) => (material.diffuse, shade(material, normal, view, ambient, samples)),
        (Textures::On, Some(_)) => {
            let albedo = surface_colour(scene, primitive, material, point.position);
            (albedo, shade(&material.painted(albedo), normal, view, ambient, samples))
        }
    };
    ShadedPoint { radiance, normal, albedo, depth }
}
