//! How many primitives of which kind a scene has, for `info`.

use crate::film::grouped;
use crate::scene::{Object, Scene};
use serde::Serialize;
use std::collections::BTreeMap;

/// Numbers of things in a scene.
#[derive(Debug, Serialize)]
pub(super) struct Counts {
    /// Triangles and curved surfaces.
    primitives: usize,
    pub(super) triangles: usize,
    /// As the scene file has them, before they were cut into triangles.
    pub(super) polygons: usize,
    /// Curved surfaces by their kind.
    pub(super) curved: BTreeMap<&'static str, usize>,
    pub(super) transparent_objects: usize,
    pub(super) mirror_objects: usize,
    pub(super) textures: usize,
}

impl Counts {
    pub(super) fn of(scene: &Scene) -> Counts {
        let mut curved = BTreeMap::new();
        for primitive in &scene.curved {
            *curved.entry(primitive.shape.kind()).or_default() += 1;
        }
        let material = |object: &Object| &scene.materials[object.material as usize];
        let objects = || scene.objects.iter().filter(|object| object.count + object.curved_count > 0);
        Counts {
            primitives: scene.primitive_count() as usize,
            triangles: scene.triangles.len(),
            polygons: scene.objects.iter().map(|object| object.polygons as usize).sum(),
            curved,
            transparent_objects: objects().filter(|o| material(o).transmission.is_some()).count(),
            mirror_objects: objects().filter(|o| material(o).mirror != [0.0; 3]).count(),
            textures: scene.textures.len(),
        }
    }
}

/// `12 cones, 1 sphere`.
pub(super) fn shapes_in_words(curved: &BTreeMap<&'static str, usize>) -> String {
    let words = |(kind, &count): (&&str, &usize)| {
        format!("{} {kind}{}", grouped(count as u64), if count == 1 { "" } else { "s" })
    };
    curved.iter().map(words).collect::<Vec<_>>().join(", ")
}
