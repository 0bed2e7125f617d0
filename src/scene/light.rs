//! Lights.

use glam::Vec3;

/// A light with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// The name that the scene file gives it; unique after loading.
    pub name: String,
    /// Where it is and how strong.
    pub point: PointLight,
}

/// A light that shines from one point equally in all directions.
#[derive(Debug, Clone, PartialEq)]
pub struct PointLight {
    /// Position in world space.
    pub position: Vec3,
    /// Radiant intensity (power per solid angle), linear Rec. 709.
    pub intensity: [f32; 3],
    /// Distance at which glTF's attenuation reaches zero; `None` is the plain inverse square.
    pub range: Option<f32>,
}
