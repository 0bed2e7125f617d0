//! One file by itself: what it holds as a scene of its own, and what it includes.

use super::materials::{self, Pictures};
use super::parts::{self, Layout};
use super::schema::{Document, TransformEntry};
use super::{cameras, lights, transforms};
use crate::scene::formats::limits::{MAX_CAMERAS, MAX_LIGHTS};
use crate::scene::formats::text::printable;
use crate::scene::{Scene, SceneBuilder};
use glam::DAffine3;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

/// Where something is wrong, as a place in the file's bytes, and what.
pub(super) type Complaint = (usize, String);

/// A file by itself.
pub(super) struct Content {
    /// The scene's name, if the file gives it one.
    pub(super) name: Option<String>,
    /// The background, if it says one.
    pub(super) background: Option<[f32; 3]>,
    /// Its materials, lights and cameras, and each mesh and curved surface as an object, before anything is
    /// moved.
    pub(super) scene: Scene,
    /// What becomes of those.
    pub(super) layout: Layout,
    pub(super) includes: Vec<Include>,
}

/// An `[[include]]`, checked but for its path.
pub(super) struct Include {
    /// A place in the file's bytes.
    pub(super) at: usize,
    pub(super) path: String,
    pub(super) transform: Option<DAffine3>,
    pub(super) casts: Option<bool>,
    pub(super) receives: Option<bool>,
    pub(super) lights: bool,
    pub(super) cameras: bool,
    /// A material of the file's own scene.
    pub(super) material: Option<u32>,
}

/// Reads a text; `pictures` finds what its textures name.
///
/// # Errors
/// A place and a line for whatever is no TOML or no scene.
pub(super) fn read(text: &str, pictures: &mut Pictures) -> Result<Content, Complaint> {
    let document = parse(text)?;
    let mut builder = SceneBuilder::new("");
    let library = materials::read(&document.materials, pictures, &mut builder)?;
    let layout = parts::read(&document, &library, &mut builder)?;
    limit(&document.lights, MAX_LIGHTS as u64, "lights")?;
    for (index, entry) in document.lights.iter().enumerate() {
        let light = lights::read(entry.get_ref(), index);
        builder.add_light(light.map_err(|why| {
            let name = entry.get_ref().name.as_deref();
            (entry.span().start, format!("{}: {why}", describe("light", index, name)))
        })?);
    }
    limit(&document.cameras, MAX_CAMERAS, "cameras")?;
    for (index, entry) in document.cameras.iter().enumerate() {
        let camera = cameras::read(entry.get_ref(), index);
        builder.add_camera(camera.map_err(|why| {
            let name = entry.get_ref().name.as_deref();
            (entry.span().start, format!("{}: {why}", describe("camera", index, name)))
        })?);
    }
    let mut includes = Vec::new();
    for entry in document.includes {
        let at = entry.span().start;
        let entry = entry.into_inner();
        includes.push(Include {
            at,
            transform: transform(entry.transform.as_ref())?,
            casts: entry.cast_shadows,
            receives: entry.receive_shadows,
            lights: entry.lights.unwrap_or(true),
            cameras: entry.cameras.unwrap_or(true),
            material: entry.material.as_ref().map(|name| library.for_include(name)).transpose()?,
            path: entry.path,
        });
    }
    let name = document.name.as_deref().map(printable);
    let background = document.background.map(|colour| colour.0);
    Ok(Content { name, background, scene: builder.finish(), layout, includes })
}

fn parse(text: &str) -> Result<Document, Complaint> {
    let complaint =
        |error: toml::de::Error| (error.span().map_or(0, |span| span.start), error.message().to_owned());
    let table = DeTable::parse(text).map_err(complaint)?;
    // Before anything else: a later version may have other keys.
    let found = table.get_ref().get("version").ok_or((0, "expected `version = 1`, found none".to_owned()))?;
    match found.get_ref() {
        DeValue::Integer(number) if number.as_str() == "1" => {}
        _ => return Err((found.span().start, "expected `version = 1`, found another".into())),
    }
    Document::deserialize(Deserializer::from(table)).map_err(complaint)
}

/// `light 2`, with its name if it has one; counted from 1.
pub(super) fn describe(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("{kind} {} `{}`", index + 1, printable(name)),
        None => format!("{kind} {}", index + 1),
    }
}

/// The name of an element, or one by its number.
pub(super) fn name_of(kind: &str, index: usize, name: Option<&str>) -> String {
    name.map_or_else(|| format!("{kind}-{}", index + 1), printable)
}

/// Whether there are few enough.
fn limit<T>(elements: &[Spanned<T>], most: u64, what: &str) -> Result<(), Complaint> {
    match elements.get(most as usize) {
        Some(element) => Err((element.span().start, format!("expected at most {most} {what}"))),
        None => Ok(()),
    }
}

/// The transform of a table, if there is one.
pub(super) fn transform(entry: Option<&Spanned<TransformEntry>>) -> Result<Option<DAffine3>, Complaint> {
    let Some(entry) = entry else { return Ok(None) };
    transforms::read(entry.get_ref()).map_err(|why| (entry.span().start, why))
}

/// The materials of a file.
#[derive(Default)]
pub(super) struct Library {
    /// The scene's numbers by their names.
    pub(super) materials: BTreeMap<String, u32>,
    /// Those whose textures lie by texture coordinates.
    pub(super) by_coordinates: BTreeSet<u32>,
}

impl Library {
    /// The material of a name.
    ///
    /// # Errors
    /// If there is none.
    pub(super) fn find(&self, name: &Spanned<String>) -> Result<u32, Complaint> {
        let found = self.materials.get(name.get_ref()).copied();
        found.ok_or_else(|| (name.span().start, format!("no material `{}`", printable(name.get_ref()))))
    }

    /// The same for all objects of an included file.
    ///
    /// # Errors
    /// Also if it has a texture that needs coordinates, which not all objects have.
    fn for_include(&self, name: &Spanned<String>) -> Result<u32, Complaint> {
        let found = self.find(name)?;
        match self.by_coordinates.contains(&found) {
            false => Ok(found),
            true => {
                let name_shown = printable(name.get_ref());
                let why = "its texture lies by coordinates, which included objects may lack";
                Err((name.span().start, format!("material `{name_shown}`: {why}")))
            }
        }
    }
}
