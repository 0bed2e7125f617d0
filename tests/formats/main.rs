//! What valid scene files become.

mod animations;
mod demo_scenes;
mod fixtures;
mod gltf_accessors;
mod gltf_alpha;
mod gltf_files;
mod gltf_lights;
mod gltf_parts;
mod gltf_poses;
mod nff_files;
mod obj_files;
mod ply_files;
mod ply_writer;
mod polygon_writers;
mod same_scene;
mod toml_curved;
mod toml_files;
mod toml_page;
mod toml_transforms;
mod written;

use lightbuffer::scene::Scene;

/// The corners of all triangles.
fn corners(scene: &Scene) -> Vec<[[f32; 3]; 3]> {
    (0..scene.triangles.len() as u32).map(|t| scene.corners(t).map(|p| p.to_array())).collect()
}

/// Asserts that one warning holds the words, and returns how many warnings there are.
fn warned(scene: &Scene, words: &str) -> usize {
    let found = scene.warnings.iter().filter(|w| w.contains(words)).count();
    assert_eq!(found, 1, "{words:?} among {:?}", scene.warnings);
    scene.warnings.len()
}
