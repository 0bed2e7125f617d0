//! Where a light is: a point of space, or infinitely far away in a direction.

use glam::Vec3;

/// A light as the far end of all its segments, in homogeneous coordinates (x, y, z, w).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightPosition {
    /// A point in world space, w = 1.
    At(Vec3),
    /// Infinitely far away in this direction, w = 0: from surfaces towards the light, in world space, not
    /// zero and not normalised. Its segments are half-lines.
    Towards(Vec3),
}

impl From<Vec3> for LightPosition {
    fn from(point: Vec3) -> LightPosition {
        LightPosition::At(point)
    }
}

impl LightPosition {
    /// Point or direction, and the weight that tells which: 1 or 0.
    pub fn homogeneous(self) -> (Vec3, f32) {
        match self {
            LightPosition::At(point) => (point, 1.0),
            LightPosition::Towards(direction) => (direction, 0.0),
        }
    }
}
