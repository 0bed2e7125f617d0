//! What belongs to the scene and not to one light, made once for all of them.

use crate::geometry::LightTriangle;
use crate::geometry::convexity::{self, Convexity};
use crate::scene::{PrimitiveIndex, Scene};
use glam::Vec3;
use rayon::prelude::*;
use std::collections::HashSet;

/// Which triangles are cast, and which objects are convex.
pub struct SceneIndex {
    /// Triangles that block light, exact duplicates once (TRUTH, "Surface points and rays").
    pub casting: Vec<PrimitiveIndex>,
    /// For each object its verified convexity.
    pub convexity: Vec<Option<Convexity>>,
}

impl SceneIndex {
    /// Examines a scene.
    pub fn new(scene: &Scene) -> SceneIndex {
        let mut seen = HashSet::with_capacity(scene.triangles.len());
        let casting = (0..scene.triangles.len() as u32).filter(|&t| seen.insert(key(scene, t))).collect();
        let convexity = scene
            .objects
            .par_iter()
            .map(|object| {
                let triangles: Vec<_> =
                    (object.first..object.first + object.count).map(|t| scene.corners(t)).collect();
                convexity::verify(&triangles)
            })
            .collect();
        SceneIndex { casting, convexity }
    }
}

/// The same for triangles with the same three corners in any order.
fn key(scene: &Scene, triangle: PrimitiveIndex) -> [[u32; 3]; 3] {
    // Adding zero makes both zeros one.
    let mut corners = scene.corners(triangle).map(|p| p.to_array().map(|x| (x + 0.0).to_bits()));
    corners.sort_unstable();
    corners
}

/// The casting triangles as one light sees them; those whose plane holds the light are left out.
pub struct Casters {
    /// Planes of each caster.
    pub planes: Vec<LightTriangle>,
    /// Its triangle in the scene.
    pub primitives: Vec<PrimitiveIndex>,
}

impl Casters {
    /// Planes relative to a light.
    pub fn new(scene: &Scene, index: &SceneIndex, light: Vec3) -> Casters {
        let (planes, primitives) = index
            .casting
            .par_iter()
            .filter_map(|&primitive| Some((LightTriangle::new(light, scene.corners(primitive))?, primitive)))
            .unzip();
        Casters { planes, primitives }
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.planes.len() * (size_of::<LightTriangle>() + size_of::<PrimitiveIndex>())
    }
}
