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
    /// Share of light that is reflected as by a mirror, along a ray of its own.
    pub mirror: [f32; 3],
    /// What passes through it; `None` for a surface that lets nothing through.
    pub transmission: Option<Transmission>,
    /// Index into [`Scene::textures`](super::Scene::textures) of what varies the diffuse colour.
    pub texture: Option<u32>,
}

/// How a surface lets light pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transmission {
    /// The share that passes at each crossing of the surface, each channel in [0, 1], linear Rec. 709.
    pub transmittance: [f32; 3],
    /// Speed of light outside over speed inside, above 0; at 1 rays go straight on. Of a triangle the inside
    /// is the side from which its corners go clockwise round.
    pub refractive_index: f32,
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
            mirror: [0.0; 3],
            transmission: None,
            texture: None,
        }
    }
}

impl Material {
    /// The same with another diffuse colour, and neither texture nor name.
    pub(crate) fn painted(&self, diffuse: [f32; 3]) -> Material {
        let &Material { specular, shininess, coverage, mirror, transmission, .. } = self;
        let name = String::new();
        Material { name, diffuse, specular, shininess, coverage, mirror, transmission, texture: None }
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
