//! Points on surfaces that are asked whether they see a light.

use super::FirstHits;
use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::geometry::ExactPosition;
use crate::geometry::curved::{Crossing, RayStart};
use crate::scene::{Camera, PrimitiveIndex, Scene};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// A point to be lit. Its exact position follows from `source`; `position` is that, correctly rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// The exact position with each coordinate rounded to the nearest f64: wrong by half an ulp at most.
    pub position: DVec3,
    /// What makes it exact.
    pub source: PointSource,
}

/// Where a point comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PointSource {
    /// The exact intersection of a ray and a triangle of the scene.
    Ray {
        /// Start of the ray.
        origin: Vec3,
        /// Its direction, not normalised.
        direction: Vec3,
        /// The triangle, visible from the origin in this direction.
        primitive: PrimitiveIndex,
    },
    /// The exact point where a ray passes through a curved surface of the scene.
    OnCurved {
        /// Start of the ray.
        origin: Vec3,
        /// Its direction, not normalised.
        direction: Vec3,
        /// The curved surface, visible from the origin in this direction.
        primitive: PrimitiveIndex,
        /// Which of the points where the ray's line meets it.
        crossing: Crossing,
    },
    /// A point of a caller's own; its coordinates are f32 numbers and exact.
    Bare,
}

impl SurfacePoint {
    /// The point where a ray hits a primitive of the scene: one that it does.
    ///
    /// # Panics
    /// If it is a curved surface that the ray misses.
    pub fn on_ray(scene: &Scene, origin: Vec3, direction: Vec3, primitive: PrimitiveIndex) -> SurfacePoint {
        let _floats = StandardFloats::new();
        if let Some(shape) = scene.shape(primitive) {
            let hit = shape.first_hit(origin, direction, &RayStart::origin()).expect("a surface that is hit");
            return SurfacePoint::on_curved(scene, origin, direction, primitive, hit.crossing);
        }
        let exact = ExactPosition::OnRay { origin, direction, triangle: scene.corners(primitive) };
        SurfacePoint { position: exact.rounded(), source: PointSource::Ray { origin, direction, primitive } }
    }

    /// The point where a ray's line passes through a curved surface of the scene.
    ///
    /// # Panics
    /// If it does not, or the primitive is a triangle.
    pub fn on_curved(
        scene: &Scene,
        origin: Vec3,
        direction: Vec3,
        primitive: PrimitiveIndex,
        crossing: Crossing,
    ) -> SurfacePoint {
        let _floats = StandardFloats::new();
        let shape = *scene.shape(primitive).expect("a curved surface");
        let exact = ExactPosition::OnCurved { origin, direction, shape, crossing };
        let source = PointSource::OnCurved { origin, direction, primitive, crossing };
        SurfacePoint { position: exact.rounded(), source }
    }

    /// A point on no surface; `None` unless its coordinates are finite.
    pub fn bare(position: Vec3) -> Option<SurfacePoint> {
        let point = SurfacePoint { position: position.as_dvec3(), source: PointSource::Bare };
        position.is_finite().then_some(point)
    }

    /// The exact position.
    pub fn exact(&self, scene: &Scene) -> ExactPosition {
        match self.source {
            PointSource::Ray { origin, direction, primitive } => {
                ExactPosition::OnRay { origin, direction, triangle: scene.corners(primitive) }
            }
            PointSource::OnCurved { origin, direction, primitive, crossing } => {
                let shape = *scene.shape(primitive).expect("the source of a point on a curved surface");
                ExactPosition::OnCurved { origin, direction, shape, crossing }
            }
            PointSource::Bare => ExactPosition::Bare(self.position.as_vec3()),
        }
    }

    /// The direction of the ray that found it, not normalised.
    pub fn direction(&self) -> Option<Vec3> {
        match self.source {
            PointSource::Ray { direction, .. } | PointSource::OnCurved { direction, .. } => Some(direction),
            PointSource::Bare => None,
        }
    }

    /// The primitive it lies on, if any: the base surface of the 1986 paper.
    pub fn primitive(&self) -> Option<PrimitiveIndex> {
        match self.source {
            PointSource::Ray { primitive, .. } | PointSource::OnCurved { primitive, .. } => Some(primitive),
            PointSource::Bare => None,
        }
    }
}

/// The points that show in an image: first those that the camera sees, pixel by pixel in rows from the top, then
/// perhaps those that it sees in mirrors and through glass.
#[derive(Debug, Clone)]
pub struct VisibleSurfaces {
    /// One entry for each ray that hits a primitive.
    pub points: Vec<SurfacePoint>,
    /// The pixel that each point shows in: row * width + column.
    pub pixels: Vec<u32>,
    /// How many of them the camera sees itself.
    pub seen: usize,
}

impl VisibleSurfaces {
    /// The points behind first hits of a camera.
    pub fn new(scene: &Scene, camera: &Camera, hits: &FirstHits) -> VisibleSurfaces {
        let _floats = StandardFloats::new();
        let raster = camera.raster(hits.size);
        let (points, pixels) = hits
            .primitives
            .par_iter()
            .enumerate()
            .in_standard_floats()
            .filter_map(|(pixel, primitive)| {
                let pixel = pixel as u32;
                let (x, y) = (pixel % hits.size.width, pixel / hits.size.width);
                let direction = camera.direction(&raster, x, y);
                primitive.map(|p| (SurfacePoint::on_ray(scene, camera.origin, direction, p), pixel))
            })
            .unzip();
        let points: Vec<SurfacePoint> = points;
        VisibleSurfaces { seen: points.len(), points, pixels }
    }

    /// The pixel of a point by its number, if the camera sees it itself.
    pub fn pixel_seen(&self, point: u32) -> Option<u32> {
        ((point as usize) < self.seen).then(|| self.pixels[point as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_space_are_finite() {
        assert!(SurfacePoint::bare(Vec3::splat(f32::MAX)).is_some());
        assert!(SurfacePoint::bare(Vec3::new(0.0, f32::NAN, 0.0)).is_none());
        assert!(SurfacePoint::bare(Vec3::new(f32::INFINITY, 0.0, 0.0)).is_none());
    }
}
