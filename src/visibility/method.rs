//! The ways to find first hits. They share every test of a ray against a primitive and the rule for ties, and
//! differ in which tests they make (2004 paper, section V: what REALITY compares).

use super::{FirstHits, classical, hierarchy, t_buffer};
use crate::scene::{Camera, ImageSize, Scene};

/// Who finds out what a camera sees. No picture depends on it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FirstHitMethod {
    /// Object by object, with the rays that its projection covers.
    #[default]
    TBuffer,
    /// Every object for every ray.
    Classical,
    /// Ray by ray, through a tree of boxes.
    Hierarchy,
}

impl FirstHitMethod {
    /// All of them.
    pub const ALL: [FirstHitMethod; 3] =
        [FirstHitMethod::TBuffer, FirstHitMethod::Classical, FirstHitMethod::Hierarchy];

    /// The name on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            FirstHitMethod::TBuffer => "t-buffer",
            FirstHitMethod::Classical => "classical",
            FirstHitMethod::Hierarchy => "hierarchy",
        }
    }

    /// What the camera sees, pixel by pixel.
    pub fn first_hits(self, scene: &Scene, camera: &Camera, size: ImageSize) -> FirstHits {
        match self {
            FirstHitMethod::TBuffer => t_buffer::first_hits(scene, camera, size),
            FirstHitMethod::Classical => classical::first_hits(scene, camera, size),
            FirstHitMethod::Hierarchy => hierarchy::first_hits(scene, camera, size),
        }
    }
}
