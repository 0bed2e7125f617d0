//! Dark by facing: what turns its back to the light is no shadow query (row 12 of the notes on the 1986
//! paper, TRUTH "Facing").

use crate::geometry::Sign;
use crate::geometry::light_triangle::orientation;
use crate::scene::Scene;
use crate::visibility::{PointSource, SurfacePoint};
use glam::Vec3;
use rayon::prelude::*;

/// The exact side of every triangle's plane that some point lies on.
pub struct Sides(Vec<Sign>);

impl Sides {
    /// Sides of all planes for one point.
    pub fn of(scene: &Scene, point: Vec3) -> Sides {
        let triangles = 0..scene.triangles.len() as u32;
        Sides(triangles.into_par_iter().map(|t| orientation(point, scene.corners(t))).collect())
    }
}

/// Whether a surface point faces the light: the start of its ray and the light lie strictly on the same
/// side of its plane. Bare points have no face and always count as facing.
///
/// `light` are the sides of the light, `eye` those of the start of the point's ray.
pub fn faces(point: &SurfacePoint, light: &Sides, eye: &Sides) -> bool {
    match point.source {
        PointSource::Ray { primitive, .. } => {
            light.0[primitive as usize] * eye.0[primitive as usize] == Sign::Positive
        }
        PointSource::Bare => true,
    }
}
