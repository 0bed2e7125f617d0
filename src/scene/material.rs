//! How a surface reflects light: the Lambert and Phong terms of both papers.

/// Reflection of a surface. Colours are linear Rec. 709, each channel in [0, 1].
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The name that the scene file gives it.
    pub name: String,
    /// Share of light reflected diffusely.
    pub diffuse: [f32; 3],
    /// Weight of the Phong highlight.
    pub specular: [f32; 3],
    /// Phong exponent, at least 1.
    pub shininess: f32,
}

impl Default for Material {
    /// A neutral matt grey.
    fn default() -> Material {
        Material { name: "default".into(), diffuse: [0.7; 3], specular: [0.0; 3], shininess: 1.0 }
    }
}
