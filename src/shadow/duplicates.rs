//! Triangles that are the same set of points: of them one is cast (TRUTH, "Surface points and rays").

use crate::scene::{PrimitiveIndex, Scene};
use std::collections::HashSet;

/// The same for triangles with the same three corners in any order.
pub(super) fn duplicate_key(scene: &Scene, triangle: PrimitiveIndex) -> [[u32; 3]; 3] {
    // Adding zero makes both zeros one.
    let mut corners = scene.corners(triangle).map(|p| p.to_array().map(|x| (x + 0.0).to_bits()));
    corners.sort_unstable();
    corners
}

/// For each triangle of the scene whether it is a duplicate of one with a smaller number; of those that are asked for.
pub(super) fn duplicates(scene: &Scene, is_asked_for: impl Fn(PrimitiveIndex) -> bool) -> Vec<bool> {
    let mut seen = HashSet::with_capacity(scene.triangles.len());
    let is_duplicate = |t| is_asked_for(t) && !seen.insert(duplicate_key(scene, t));
    (0..scene.triangles.len() as PrimitiveIndex).map(is_duplicate).collect()
}
