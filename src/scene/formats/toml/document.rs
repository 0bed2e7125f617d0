//! One file by itself: what it holds as a scene of its own, and what it includes.

use super::keyframes::{self, Moved};
use super::materials::{self, Pictures};
use super::parts::{self, Layout};
use super::schema::{Document, TransformEntry};
use super::{cameras, lights, transforms};
use crate::scene::animation::{Subject, Track};
use crate::scene::formats::limits::{MAX_CAMERAS, MAX_LIGHTS};
use crate::scene::formats::text::printable;
use crate::scene::{Camera, FrameRate, Light, Scene, SceneBuilder};
use glam::DAffine3;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

/// Where something is wrong, as a place in the file's bytes, and what.
pub(super) type Complaint = (usize, String);

/// How a transform changes.
pub(super) type Course = Arc<dyn Track<DAffine3>>;

/// A file by itself.
pub(super) struct Content {
    /// The scene's name, if the file gives it one.
    pub(super) name: Option<String>,
    /// The background, if it says one.
    pub(super) background: Option<[f32; 3]>,
    /// Frames a second, if it says so.
    pub(super) rate: Option<FrameRate>,
    /// Its lights and cameras that move.
    pub(super) moving: Moving,
    /// Its materials, lights and cameras, and each mesh and curved surface as an object, before anything is
    /// moved.
    pub(super) scene: Scene,
    /// What becomes of those.
    pub(super) layout: Layout,
    pub(super) includes: Vec<Include>,
}

/// Lights and cameras that move, by their numbers in the file's scene.
#[derive(Default)]
pub(super) struct Moving {
    pub(super) lights: BTreeMap<usize, MovingElement<Light>>,
    pub(super) cameras: BTreeMap<usize, MovingElement<Camera>>,
}

/// A light or camera that moves.
pub(super) struct MovingElement<T> {
    /// What it is in its own space.
    pub(super) subject: Subject<T>,
    /// How that space moves in the file's.
    pub(super) track: Option<Course>,
}

/// An `[[include]]`, checked but for its path.
pub(super) struct Include {
    /// A place in the file's bytes.
    pub(super) at: usize,
    pub(super) path: String,
    /// At rest.
    pub(super) transform: Option<DAffine3>,
    /// How that changes.
    pub(super) track: Option<Course>,
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
    let rate = document
        .fps
        .as_ref()
        .map(|fps| FrameRate::near(fps.get_ref().0).map_err(|why| (fps.span().start, format!("fps: {why}"))));
    let rate = rate.transpose()?;
    let frames = rate.unwrap_or_default();
    let mut builder = SceneBuilder::new("");
    let library = materials::read(&document.materials, pictures, &mut builder)?;
    let layout = parts::read(&document, &library, frames, &mut builder)?;
    limit(&document.lights, MAX_LIGHTS as u64, "lights")?;
    let mut moving = Moving::default();
    for (index, entry) in document.lights.iter().enumerate() {
        let about = describe("light", index, entry.get_ref().name.as_deref());
        let at = |why: String| (entry.span().start, format!("{about}: {why}"));
        let light = match keyframes::of_light(entry.get_ref(), index, &about, frames)? {
            None => lights::read(entry.get_ref(), index).map_err(at)?,
            Some(element) => {
                let own = lights::read(&element.rest, index).map_err(at)?;
                let (rest, track) = at_rest(&own, element.moved, Light::transformed).map_err(at)?;
                let subject = element.own.map_or(Subject::Still(own), Subject::Moving);
                moving.lights.insert(index, MovingElement { subject, track });
                rest
            }
        };
        builder.add_light(light);
    }
    limit(&document.cameras, MAX_CAMERAS, "cameras")?;
    for (index, entry) in document.cameras.iter().enumerate() {
        let about = describe("camera", index, entry.get_ref().name.as_deref());
        let at = |why: String| (entry.span().start, format!("{about}: {why}"));
        let camera = match keyframes::of_camera(entry.get_ref(), index, &about, frames)? {
            None => cameras::read(entry.get_ref(), index).map_err(at)?,
            Some(element) => {
                let own = cameras::read(&element.rest, index).map_err(at)?;
                let (rest, track) = at_rest(&own, element.moved, Camera::transformed).map_err(at)?;
                let subject = element.own.map_or(Subject::Still(own), Subject::Moving);
                moving.cameras.insert(index, MovingElement { subject, track });
                rest
            }
        };
        builder.add_camera(camera);
    }
    let mut includes = Vec::new();
    for entry in document.includes {
        let at = entry.span().start;
        let entry = entry.into_inner();
        let about = format!("include `{}`", printable(&entry.path));
        let base = entry.transform.as_ref();
        let (transform, track) =
            moved(transform(base)?, keyframes::of_transform(entry.keyframes.as_ref(), base, &about, frames)?);
        includes.push(Include {
            at,
            transform,
            track,
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
    Ok(Content { name, background, rate, moving, scene: builder.finish(), layout, includes })
}

/// A light or camera at rest, where its keyframes move it as a whole, and how they do.
fn at_rest<T: Clone>(
    own: &T,
    moved: Option<Moved>,
    transformed: impl Fn(&T, &DAffine3) -> Option<T>,
) -> Result<(T, Option<Course>), String> {
    let Some(Moved { rest, track }) = moved else { return Ok((own.clone(), None)) };
    let rest = rest.map_or_else(|| Some(own.clone()), |rest| transformed(own, &rest));
    Ok((rest.ok_or("its keyframes leave it no place or no direction")?, Some(track)))
}

/// A transform at rest, and how it changes: by keyframes, if there are such.
pub(super) fn moved(still: Option<DAffine3>, moved: Option<Moved>) -> (Option<DAffine3>, Option<Course>) {
    match moved {
        None => (still, None),
        Some(Moved { rest, track }) => (rest, Some(track)),
    }
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
