//! Materials and their textures.

use super::document::{Complaint, Library};
use super::schema::{MaterialEntry, TextureEntry, WrapName};
use super::shapes::rounded;
use super::values::{Number, Share};
use crate::scene::formats::text::printable;
use crate::scene::{Image, Mapping, Material, Pattern, SceneBuilder, Texture, Transmission, Wrap};
use glam::Vec3;
use std::sync::Arc;
use toml::Spanned;

/// The index of refraction of what lets light through and says none: that of window glass.
const USUAL_INDEX: f32 = 1.5;

/// Finds or reads a picture by the name that a file gives it.
pub(super) type Pictures<'a> = dyn FnMut(&str) -> Result<Arc<Image>, String> + 'a;

/// Adds all materials of a file.
///
/// # Errors
/// A place and a line for numbers out of range, keys that do not go together, names that are there twice and
/// pictures that cannot be read.
pub(super) fn read(
    entries: &[Spanned<MaterialEntry>],
    pictures: &mut Pictures,
    builder: &mut SceneBuilder,
) -> Result<Library, Complaint> {
    let mut library = Library::default();
    for entry in entries {
        let (at, entry) = (entry.span().start, entry.get_ref());
        let about = |why: String| format!("material `{}`: {why}", printable(&entry.name));
        let mut material = material(entry).map_err(|why| (at, about(why)))?;
        let mut by_coordinates = false;
        if let Some(texture) = &entry.texture {
            let at = texture.span().start;
            let texture = self::texture(texture.get_ref(), pictures).map_err(|why| (at, about(why)))?;
            by_coordinates = texture.mapping == Mapping::Coordinates;
            let added = builder.add_texture(texture);
            material.texture = Some(added.map_err(|error| (at, about(error.to_string())))?);
        }
        let index = builder.add_material(material);
        if by_coordinates {
            library.by_coordinates.insert(index);
        }
        if library.materials.insert(entry.name.clone(), index).is_some() {
            return Err((at, format!("a second material `{}`", printable(&entry.name))));
        }
    }
    Ok(library)
}

fn material(entry: &MaterialEntry) -> Result<Material, String> {
    let plain = Material::default();
    let shininess = entry.shininess.map_or(Ok(plain.shininess), rounded)?;
    if shininess < 1.0 {
        return Err(format!("expected a shininess of at least 1, found {shininess}"));
    }
    // A picture times grey would be darker than it is.
    let is_picture = entry.texture.as_ref().is_some_and(|texture| texture.get_ref().image.is_some());
    let diffuse = if is_picture { [1.0; 3] } else { plain.diffuse };
    let share = |given: Option<Share>, usual: [f32; 3]| given.map_or(usual, |share| share.0);
    Ok(Material {
        name: printable(&entry.name),
        diffuse: share(entry.diffuse, diffuse),
        specular: share(entry.specular, plain.specular),
        shininess,
        mirror: share(entry.mirror, plain.mirror),
        transmission: transmission(entry)?,
        ..plain
    })
}

fn transmission(entry: &MaterialEntry) -> Result<Option<Transmission>, String> {
    match (entry.transmittance, entry.refractive_index) {
        (None, None) => Ok(None),
        (None, Some(_)) => Err("`refractive_index` is for materials with a `transmittance`".into()),
        (Some(Share(transmittance)), index) => {
            let refractive_index = index.map_or(Ok(USUAL_INDEX), rounded)?;
            if refractive_index <= 0.0 {
                return Err(format!("expected a refractive index above 0, found {refractive_index}"));
            }
            let lets_through = transmittance != [0.0; 3];
            Ok(lets_through.then_some(Transmission { transmittance, refractive_index }))
        }
    }
}

fn texture(entry: &TextureEntry, pictures: &mut Pictures) -> Result<Texture, String> {
    let mapping = mapping(entry)?;
    let pattern = match (entry.checker, &entry.image) {
        (Some(Share(other)), None) => {
            if entry.wrap_u.or(entry.wrap_v).is_some() {
                return Err("`wrap_u` and `wrap_v` are for images".into());
            }
            Pattern::Checker { other }
        }
        (None, Some(path)) => {
            let wrap = [entry.wrap_u, entry.wrap_v].map(|name| match name {
                None | Some(WrapName::Repeat) => Wrap::Repeat,
                Some(WrapName::Mirror) => Wrap::MirroredRepeat,
                Some(WrapName::Clamp) => Wrap::ClampToEdge,
            });
            Pattern::Image { image: pictures(path)?, wrap }
        }
        (None, None) => return Err("expected a texture with `checker` or `image`, found neither".into()),
        (Some(_), Some(_)) => {
            return Err("expected a texture with either `checker` or `image`, found both".into());
        }
    };
    Ok(Texture { pattern, mapping })
}

fn mapping(entry: &TextureEntry) -> Result<Mapping, String> {
    let origin = entry.origin.map_or(Vec3::ZERO, |origin| origin.0);
    match (entry.size, entry.u, entry.v, entry.coordinates) {
        (Some(Number(given)), None, None, None) => {
            let size = given as f32;
            match size > 0.0 && size.is_finite() {
                true => Ok(Mapping::Solid { origin, size }),
                false => {
                    Err(format!("expected a `size` above 0 and in the range of 32-bit floats, found {given}"))
                }
            }
        }
        (None, Some(u), Some(v), None) => Ok(Mapping::Planar { origin, u: u.0, v: v.0 }),
        (None, None, None, Some(true)) if entry.origin.is_none() => Ok(Mapping::Coordinates),
        (None, None, None, Some(true)) => Err("`origin` is for textures with `size` or `u` and `v`".into()),
        _ => Err("expected a texture with one of `size`, `u` and `v`, and `coordinates = true`".into()),
    }
}
