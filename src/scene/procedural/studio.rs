//! Where a scene is put together.

use super::shapes::Body;
use crate::error::Result;
use crate::scene::formats::BUILTIN_PREFIX;
use crate::scene::{
    Camera, Falloff, ImageSize, Light, Material, ObjectInput, PointLight, Scene, SceneBuilder, Texture,
    Transmission,
};
use glam::Vec3;

/// The image size of most figures of the 1986 paper.
pub(super) const PAPER_SIZE: ImageSize = ImageSize { width: 512, height: 480 };

/// A scene in the making.
pub(super) struct Studio {
    builder: SceneBuilder,
}

impl Studio {
    /// An empty one for the scene of this name.
    pub fn new(name: &str) -> Studio {
        Studio { builder: SceneBuilder::new(format!("{BUILTIN_PREFIX}{name}")) }
    }

    /// A material by its number.
    pub fn material(&mut self, material: Material) -> u32 {
        self.builder.add_material(material)
    }

    /// A texture by its number.
    ///
    /// # Errors
    /// As [`SceneBuilder::add_texture`].
    pub fn texture(&mut self, texture: Texture) -> Result<u32> {
        self.builder.add_texture(texture)
    }

    /// Adds an object.
    ///
    /// # Errors
    /// As [`SceneBuilder::add_object`].
    pub fn add(&mut self, name: impl Into<String>, material: u32, body: impl Into<Body>) -> Result<()> {
        let Body { mesh, curved } = body.into();
        let input = mesh.into_object(name)?;
        self.builder.add_object(ObjectInput { material, curved, ..input })
    }

    /// Adds an object that is not made of a mesh of ours.
    ///
    /// # Errors
    /// As [`SceneBuilder::add_object`].
    pub fn add_input(&mut self, input: ObjectInput) -> Result<()> {
        self.builder.add_object(input)
    }

    /// A light that is as strong at any distance: a white surface that faces it has this radiance.
    pub fn lamp(&mut self, name: &str, position: [f32; 3], radiance: [f32; 3]) {
        let intensity = radiance.map(|channel| (f64::from(channel) * std::f64::consts::PI) as f32);
        self.point_light(name, position, intensity, Falloff::Constant);
    }

    /// A light that thins out with the square of the distance: a white surface that faces it from a distance
    /// of 1 has this radiance.
    pub fn near_lamp(&mut self, name: &str, position: [f32; 3], radiance: [f32; 3]) {
        let intensity = radiance.map(|channel| (f64::from(channel) * std::f64::consts::PI) as f32);
        self.point_light(name, position, intensity, Falloff::InverseSquare);
    }

    fn point_light(&mut self, name: &str, position: [f32; 3], intensity: [f32; 3], falloff: Falloff) {
        let position = Vec3::from(position);
        self.builder.add_light(Light::point(name, PointLight { position, intensity, falloff }));
    }

    /// A camera with a full vertical field of view in degrees, y up.
    pub fn camera(&mut self, from: [f32; 3], at: [f32; 3], degrees: f64, size: ImageSize) {
        let camera = Camera::look_at("view", from.into(), at.into(), Vec3::Y, degrees);
        self.builder.add_camera(Camera { size: Some(size), ..camera });
    }

    /// What rays that leave the scene see.
    pub fn background(&mut self, colour: [f32; 3]) {
        self.builder.set_background(colour);
    }

    /// A camera that is ready.
    pub fn add_camera(&mut self, camera: Camera) {
        self.builder.add_camera(camera);
    }

    /// The scene.
    pub fn finish(self) -> Scene {
        self.builder.finish()
    }
}

/// A surface without gloss.
pub(super) fn matt(name: &str, diffuse: [f32; 3]) -> Material {
    Material { name: name.into(), diffuse, ..Material::default() }
}

/// A surface with a highlight.
pub(super) fn glossy(name: &str, diffuse: [f32; 3], specular: f32, shininess: f32) -> Material {
    Material { specular: [specular; 3], shininess, ..matt(name, diffuse) }
}

/// A surface with a highlight that mirrors this share of what is around it.
pub(super) fn polished(name: &str, diffuse: [f32; 3], mirror: f32) -> Material {
    Material { mirror: [mirror; 3], ..glossy(name, diffuse, 0.4, 60.0) }
}

/// A metal: its mirror and its highlight have its colour.
pub(super) fn metal(name: &str, diffuse: [f32; 3], mirror: [f32; 3]) -> Material {
    Material { mirror, specular: mirror, shininess: 40.0, ..matt(name, diffuse) }
}

/// Glass through which this share passes at each surface.
pub(super) fn glass(name: &str, transmittance: [f32; 3], refractive_index: f32) -> Material {
    Material {
        mirror: [0.08; 3],
        specular: [0.6; 3],
        shininess: 120.0,
        transmission: Some(Transmission { transmittance, refractive_index }),
        ..matt(name, [0.02, 0.03, 0.025])
    }
}
