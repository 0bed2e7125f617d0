//! Illumination of both papers: ambient, Lambert and Phong.
//!
//! Shading never asks who sees a light; it is handed the lights that are seen. Everything is pure and built
//! from operations that IEEE 754 rounds correctly, with powers from `libm`, so that a picture has the same
//! bits on every platform.

mod light;
mod normal;
mod picture;
mod ray_tree;
mod shade;
mod texture;

pub use light::{LightSample, sample_light};
pub use normal::{geometric_normal, normal_at, shading_normal};
pub use picture::{ShadedPoint, Textures, shade_picture};
pub use ray_tree::{
    Branch, Following, Kind, RayForest, TreeRules, TreeStatistics, USUAL_DEPTH, branches, reflected,
    refracted,
};
pub use shade::{Ambient, shade};
pub use texture::surface_colour;
