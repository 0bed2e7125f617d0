//! What belongs to the scene and not to one light, made once for all of them.

use super::Solids;
use crate::geometry::convexity::{self, Convexity};
use crate::geometry::{LightPosition, LightSpace, LightTriangle};
use crate::scene::{PrimitiveIndex, Scene};
use glam::Vec3;
use rayon::prelude::*;
use std::collections::HashSet;
use std::sync::OnceLock;

/// Which triangles are cast, and which objects are convex.
pub struct SceneIndex {
    /// Triangles that block light: of objects that cast, exact duplicates once unless they have
    /// holes (TRUTH, "Surface points and
    /// rays").
    pub casting: Vec<PrimitiveIndex>,
    /// Lowest and highest corner of a box around them; both zero if there are none.
    pub bounds: (Vec3, Vec3),
    /// For each object its verified convexity.
    pub convexity: Vec<Option<Convexity>>,
    solids: OnceLock<Solids>,
}

impl SceneIndex {
    /// Examines a scene.
    pub fn new(scene: &Scene) -> SceneIndex {
        let mut seen = HashSet::with_capacity(scene.triangles.len());
        let casting: Vec<_> = (0..scene.triangles.len() as u32)
            .filter(|&t| {
                let mut is_new = || scene.masked(t).is_some() || seen.insert(key(scene, t));
                scene.object(t).shadowing.casts && is_new()
            })
            .collect();
        let corners = || casting.iter().flat_map(|&t| scene.corners(t));
        let first = corners().next().unwrap_or_default();
        let bounds = corners().fold((first, first), |(low, high), p| (low.min(p), high.max(p)));
        let convexity = scene
            .objects
            .par_iter()
            .map(|object| {
                let triangles: Vec<_> =
                    (object.first..object.first + object.count).map(|t| scene.corners(t)).collect();
                convexity::verify(&triangles)
            })
            .collect();
        SceneIndex { casting, bounds, convexity, solids: OnceLock::new() }
    }

    /// The closed solids of the scene that this index was made of, found when they are first asked for.
    pub fn solids(&self, scene: &Scene) -> &Solids {
        self.solids.get_or_init(|| Solids::new(scene))
    }
}

/// The same for triangles with the same three corners in any order.
fn key(scene: &Scene, triangle: PrimitiveIndex) -> [[u32; 3]; 3] {
    // Adding zero makes both zeros one.
    let mut corners = scene.corners(triangle).map(|p| p.to_array().map(|x| (x + 0.0).to_bits()));
    corners.sort_unstable();
    corners
}

/// Casting triangles as one light sees them; those whose plane holds the light are left out.
pub struct Casters {
    /// Planes of each caster.
    pub planes: Vec<LightTriangle>,
    /// Its triangle in the scene.
    pub primitives: Vec<PrimitiveIndex>,
    /// What the planes are relative to.
    pub space: LightSpace,
}

impl Casters {
    /// All that casts, relative to a light.
    pub fn new(scene: &Scene, index: &SceneIndex, light: LightPosition) -> Casters {
        Casters::some(scene, index, light, &index.casting)
    }

    /// Some of the triangles that cast, relative to a light.
    pub fn some(
        scene: &Scene,
        index: &SceneIndex,
        light: LightPosition,
        casting: &[PrimitiveIndex],
    ) -> Casters {
        let space = LightSpace::new(light, index.bounds);
        let (planes, primitives) = casting
            .par_iter()
            .filter_map(|&primitive| Some((LightTriangle::new(&space, scene.corners(primitive))?, primitive)))
            .unzip();
        Casters { planes, primitives, space }
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.planes.len() * (size_of::<LightTriangle>() + size_of::<PrimitiveIndex>())
    }
}
