//! A camera, a key light and a floor for a scene that comes without them.

use super::{Camera, Falloff, Light, Material, ObjectInput, PointLight, Scene, SceneBuilder};
use crate::error::{Error, Result};
use crate::float_environment::StandardFloats;
use glam::Vec3;

/// Whether a mesh that gets its lights from us gets a floor too.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Framing {
    /// A square floor under the lowest point.
    WithFloor,
    /// Nothing is added but what is missing to see anything.
    WithoutFloor,
}

/// Half the edge of the floor, in radii of the scene.
const FLOOR_RADII: f32 = 6.0;

/// Completes a scene: a camera if there is none, a key light and a floor if there is no light. What was
/// added is returned, a line each.
///
/// The scene's up axis is taken to be y. The floor is a new last object, so the numbers of the file's
/// objects stay.
///
/// # Errors
/// [`Error::Usage`] if something is missing and the scene holds nothing that has an end, or is so large that
/// what is added would not be finite.
pub fn frame(scene: &mut Scene, framing: Framing) -> Result<Vec<String>> {
    let _floats = StandardFloats::new();
    if !scene.cameras.is_empty() && !scene.lights.is_empty() {
        return Ok(Vec::new());
    }
    let endless = || {
        let why = "nothing in it has an end, so that it needs a camera and a light of its own";
        Error::Usage(format!("{}: {why}", scene.name))
    };
    let (low, high) = scene.bounds().ok_or_else(endless)?;
    let centre = (low * 0.5) + (high * 0.5);
    // Squares of f32 lengths overflow from 1e19 on and vanish below 1e-22.
    let diagonal = (high.as_dvec3() - low.as_dvec3()).length();
    let radius = ((diagonal * 0.5) as f32).max(f32::MIN_POSITIVE);
    let finite = |what: &str, is_finite: bool| match is_finite {
        true => Ok(()),
        false => Err(Error::Usage(format!("{}: too large to be given a {what}", scene.name))),
    };
    let mut added = Vec::new();
    if scene.cameras.is_empty() {
        let origin = centre + radius * Vec3::new(0.9, 0.85, 2.7);
        finite("camera", (origin - centre).is_finite() && origin.is_finite())?;
        scene.cameras.push(Camera::look_at(
            "framed",
            origin,
            centre - 0.12 * radius * Vec3::Y,
            Vec3::Y,
            38.0,
        ));
        added.push("camera `framed`".into());
    }
    if scene.lights.is_empty() {
        let offset = radius * Vec3::new(-2.2, 3.4, 2.4);
        let strength = (3.0 * offset.length_squared()).max(f32::MIN_POSITIVE);
        finite("light", strength.is_finite() && (centre + offset).is_finite())?;
        scene.lights.push(Light::point(
            "key",
            PointLight {
                position: centre + offset,
                intensity: [strength, strength * 0.97, strength * 0.92],
                falloff: Falloff::InverseSquare,
            },
        ));
        added.push("light `key`".into());
        if framing == Framing::WithFloor {
            add_floor(scene, centre, low.y, radius)?;
            added.push("object `floor`".into());
        }
    }
    Ok(added)
}

fn add_floor(scene: &mut Scene, centre: Vec3, height: f32, radius: f32) -> Result<()> {
    let half = FLOOR_RADII * radius;
    let corner = |sx: f32, sz: f32| Vec3::new(centre.x + sx * half, height, centre.z + sz * half);
    let mut builder = SceneBuilder::extend(std::mem::replace(scene, Scene::empty("")));
    let material =
        builder.add_material(Material { name: "floor".into(), diffuse: [0.55; 3], ..Material::default() });
    builder.add_object(ObjectInput {
        material,
        ..ObjectInput::new(
            "floor",
            vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)],
            vec![[0, 1, 2], [0, 2, 3]],
        )
    })?;
    *scene = builder.into_scene();
    Ok(())
}
