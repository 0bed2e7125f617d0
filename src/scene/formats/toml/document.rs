//! One file by itself: what it holds as a scene of its own, and what it includes.

use super::schema::{Document, MaterialEntry, TransformEntry};
use super::values::Number;
use super::{cameras, lights, meshes, transforms};
use crate::scene::formats::limits::{MAX_CAMERAS, MAX_LIGHTS, MAX_OBJECTS};
use crate::scene::formats::text::printable;
use crate::scene::{Coverage, Material, Scene, SceneBuilder};
use glam::DAffine3;
use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

/// The largest Phong exponent.
const SHINIEST: f64 = 1000.0;

/// Where something is wrong, as a place in the file's bytes, and what.
pub(super) type Complaint = (usize, String);

/// A file by itself.
pub(super) struct Content {
    /// The scene's name, if the file gives it one.
    pub(super) name: Option<String>,
    /// Its materials, meshes, lights and cameras, before anything is moved.
    pub(super) scene: Scene,
    /// Where each object goes.
    pub(super) transforms: Vec<Option<DAffine3>>,
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

/// Reads a text.
///
/// # Errors
/// A place and a line for whatever is no TOML or no scene.
pub(super) fn read(text: &str) -> Result<Content, Complaint> {
    let document = parse(text)?;
    let mut builder = SceneBuilder::new("");
    let materials = materials(&document.materials, &mut builder)?;
    limit(&document.meshes, MAX_OBJECTS, "meshes")?;
    let mut transforms = Vec::new();
    let mut crossed = 0;
    for (index, entry) in document.meshes.iter().enumerate() {
        let read = meshes::read(entry, index, &materials)?;
        crossed += read.crossed;
        transforms.push(self::transform(entry.get_ref().transform.as_ref())?);
        builder.add_object(read.input).map_err(|error| (entry.span().start, error.to_string()))?;
    }
    meshes::warn(crossed, &mut builder);
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
            material: entry.material.as_ref().map(|name| find(&materials, name)).transpose()?,
            path: entry.path,
        });
    }
    let name = document.name.as_deref().map(printable);
    Ok(Content { name, scene: builder.finish(), transforms, includes })
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

fn transform(entry: Option<&Spanned<TransformEntry>>) -> Result<Option<DAffine3>, Complaint> {
    let Some(entry) = entry else { return Ok(None) };
    transforms::read(entry.get_ref()).map_err(|why| (entry.span().start, why))
}

/// The scene's numbers of the file's materials.
pub(super) type Materials = BTreeMap<String, u32>;

/// The material of a name.
///
/// # Errors
/// If there is none.
pub(super) fn find(materials: &Materials, name: &Spanned<String>) -> Result<u32, Complaint> {
    let found = materials.get(name.get_ref()).copied();
    found.ok_or_else(|| (name.span().start, format!("no material `{}`", printable(name.get_ref()))))
}

fn materials(entries: &[Spanned<MaterialEntry>], builder: &mut SceneBuilder) -> Result<Materials, Complaint> {
    let mut materials = Materials::new();
    for entry in entries {
        let (at, entry) = (entry.span().start, entry.get_ref());
        let material = material(entry).map_err(|why| (at, why))?;
        if materials.insert(entry.name.clone(), builder.add_material(material)).is_some() {
            return Err((at, format!("a second material `{}`", printable(&entry.name))));
        }
    }
    Ok(materials)
}

fn material(entry: &MaterialEntry) -> Result<Material, String> {
    let plain = Material::default();
    let shininess = entry.shininess.map_or(f64::from(plain.shininess), |Number(number)| number);
    if !(1.0..=SHINIEST).contains(&shininess) {
        let name = printable(&entry.name);
        return Err(format!(
            "material `{name}`: expected a shininess from 1 to {SHINIEST}, found {shininess}"
        ));
    }
    Ok(Material {
        name: printable(&entry.name),
        diffuse: entry.diffuse.map_or(plain.diffuse, |share| share.0),
        specular: entry.specular.map_or(plain.specular, |share| share.0),
        shininess: shininess as f32,
        coverage: Coverage::Solid,
        ..plain
    })
}
