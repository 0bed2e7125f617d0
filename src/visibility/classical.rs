//! Classical ray tracing: every ray against every triangle, as REALITY's reference tracer does (2004
//! paper, section IV). It is what the t-buffer must equal, pixel by pixel.

use super::hit::{FirstHits, Hit, is_there, keep_nearer};
use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::geometry::curved::RayStart;
use crate::geometry::ray_triangle::RayTriangle;
use crate::scene::{Camera, ImageSize, Scene};
use rayon::prelude::*;

/// First hits by testing everything.
pub fn first_hits(scene: &Scene, camera: &Camera, size: ImageSize) -> FirstHits {
    let _floats = StandardFloats::new();
    let prepared: Vec<_> = (0..scene.triangles.len() as u32)
        .filter_map(|primitive| Some((primitive, RayTriangle::new(camera.origin, scene.corners(primitive))?)))
        .collect();
    let curved = scene.triangles.len() as u32..scene.primitive_count();
    let start = RayStart::origin();
    let raster = camera.raster(size);
    let primitives = (0..size.pixels())
        .into_par_iter()
        .in_standard_floats()
        .map(|pixel| {
            let (x, y) = (pixel as u32 % size.width, pixel as u32 / size.width);
            let direction = camera.direction(&raster, x, y);
            let mut nearest: Option<Hit> = None;
            for (primitive, triangle) in &prepared {
                if let Some(t) = triangle.hit(direction)
                    && is_there(scene, *primitive, triangle, direction)
                {
                    keep_nearer(&mut nearest, Hit::flat(*primitive, t), scene, camera.origin, direction);
                }
            }
            for primitive in curved.clone() {
                if let Some(hit) = Hit::curved(scene, primitive, camera.origin, direction, &start) {
                    keep_nearer(&mut nearest, hit, scene, camera.origin, direction);
                }
            }
            nearest.map(|hit| hit.primitive)
        })
        .collect();
    let tests = size.pixels() as u64 * (prepared.len() + scene.curved.len()) as u64;
    FirstHits { size, primitives, tests }
}
