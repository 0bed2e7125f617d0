//! How a surface reflects light: the Lambert and Phong terms of both papers. And where it is at all.

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
    /// Where it is there.
    pub coverage: Coverage,
}

/// Where a surface is there to be seen and to block light.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Coverage {
    /// Everywhere.
    #[default]
    Solid,
    /// Where the mask with this index in [`Scene::alpha_masks`](super::Scene::alpha_masks) is opaque.
    Masked(u32),
}

impl Default for Material {
    /// A neutral matt grey.
    fn default() -> Material {
        Material {
            name: "default".into(),
            diffuse: [0.7; 3],
            specular: [0.0; 3],
            shininess: 1.0,
            coverage: Coverage::Solid,
        }
    }
}

impl Coverage {
    /// The index of its mask, if it has one.
    pub fn mask(self) -> Option<u32> {
        match self {
            Coverage::Solid => None,
            Coverage::Masked(mask) => Some(mask),
        }
    }
}
