//! Meshes and curved surfaces, and the objects that they are parts of.
//!
//! A part without the key `object` is an object by itself. Parts that give one key are one object together:
//! what one of them says about its name, its material and its part in shadows is said for all, and they may
//! not contradict each other. Objects come in the order of their first parts in the file, whatever their kind.

use super::document::{Complaint, Library, describe, moved, name_of, transform};
use super::keyframes;
use super::meshes;
use super::schema::{About, Document, MeshEntry};
use super::shapes;
use crate::geometry::curved::Shape;
use crate::scene::animation::Track;
use crate::scene::formats::limits::MAX_OBJECTS;
use crate::scene::formats::text::printable;
use crate::scene::{FrameRate, ObjectInput, Scene, SceneBuilder, Shadowing};
use glam::DAffine3;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
use toml::Spanned;

/// How a file's objects are put together from the objects of its scene, each of which is a part.
#[derive(Default)]
pub(super) struct Layout {
    /// Where each part goes, at rest.
    pub(super) transforms: Vec<Option<DAffine3>>,
    /// How that changes.
    pub(super) tracks: Vec<Option<Arc<dyn Track<DAffine3>>>>,
    /// The parts of each object.
    pub(super) objects: Vec<Range<usize>>,
}

impl Layout {
    /// Of a scene whose objects stay as they are.
    pub(super) fn of(scene: &Scene) -> Layout {
        let count = scene.objects.len();
        Layout {
            transforms: vec![None; count],
            tracks: vec![None; count],
            objects: (0..count).map(|i| i..i + 1).collect(),
        }
    }
}

/// A part before it is an object of the file's scene.
struct Part<'a> {
    /// A place in the file's bytes.
    at: usize,
    kind: &'static str,
    /// Among its kind, from 0.
    index: usize,
    about: About<'a>,
    body: Body<'a>,
}

enum Body<'a> {
    Mesh(&'a Spanned<MeshEntry>),
    Curved(Shape),
}

impl Part<'_> {
    fn describe(&self) -> String {
        describe(self.kind, self.index, self.about.name.or(self.about.object))
    }
}

/// What is said about an object by any of its parts.
#[derive(Default)]
struct Group<'a> {
    parts: Vec<Part<'a>>,
    name: Option<&'a str>,
    material: Option<u32>,
    casts: Option<bool>,
    receives: Option<bool>,
}

/// Reads all meshes and curved surfaces and adds a scene's object for each.
///
/// # Errors
/// A place and a line for whatever is no mesh or surface, parts of one object that contradict each other, and
/// transforms that a surface cannot take.
pub(super) fn read(
    document: &Document,
    library: &Library,
    rate: FrameRate,
    builder: &mut SceneBuilder,
) -> Result<Layout, Complaint> {
    let mut layout = Layout::default();
    let mut crossed = 0;
    for group in groups(all(document)?, library)? {
        let first = layout.transforms.len();
        let (material, shadowing) = (group.material.unwrap_or_default(), group.shadowing());
        let name = group.name();
        for part in &group.parts {
            let base = part.about.transform;
            let keyframes = keyframes::of_transform(part.about.keyframes, base, &part.describe(), rate)?;
            let (transform, track) = moved(transform(base)?, keyframes);
            let input = ObjectInput {
                name: name.clone(),
                material,
                shadowing,
                ..match &part.body {
                    Body::Mesh(entry) => {
                        let read = meshes::read(entry, &part.describe())?;
                        crossed += read.crossed;
                        read.input
                    }
                    Body::Curved(shape) => {
                        can_be_placed(part, shape, transform.as_ref())?;
                        ObjectInput { curved: vec![*shape], ..ObjectInput::new("", Vec::new(), Vec::new()) }
                    }
                }
            };
            if library.by_coordinates.contains(&material) && input.texture_coordinates.is_none() {
                let why = match part.body {
                    Body::Mesh(_) => "expected `texture_coordinates` for the texture of its material",
                    Body::Curved(_) => "it has no coordinates for the texture of its material",
                };
                return Err((part.at, format!("{}: {why}", part.describe())));
            }
            builder.add_object(input).map_err(|error| (part.at, error.to_string()))?;
            layout.transforms.push(transform);
            layout.tracks.push(track);
        }
        layout.objects.push(first..layout.transforms.len());
    }
    meshes::warn(crossed, builder);
    Ok(layout)
}

fn can_be_placed(part: &Part, shape: &Shape, transform: Option<&DAffine3>) -> Result<(), Complaint> {
    let Some(transform) = transform else { return Ok(()) };
    let placed = shape.transformed(transform);
    let at = part.about.transform.map_or(part.at, |entry| entry.span().start);
    placed.map(drop).map_err(|why| (at, format!("{}: {why}", part.describe())))
}

/// All parts, in the order of the file.
fn all(document: &Document) -> Result<Vec<Part<'_>>, Complaint> {
    let mut parts = Vec::new();
    for (index, entry) in document.meshes.iter().enumerate() {
        let (at, about) = (entry.span().start, entry.get_ref().about());
        parts.push(Part { at, kind: "mesh", index, about, body: Body::Mesh(entry) });
    }
    macro_rules! curved {
        ($entries:ident, $kind:ident) => {
            for (index, entry) in document.$entries.iter().enumerate() {
                let (at, kind) = (entry.span().start, stringify!($kind));
                let about = entry.get_ref().about();
                let shape = shapes::$kind(entry.get_ref()).map_err(|why| {
                    (at, format!("{}: {why}", describe(kind, index, about.name.or(about.object))))
                })?;
                parts.push(Part { at, kind, index, about, body: Body::Curved(shape) });
            }
        };
    }
    curved!(spheres, sphere);
    curved!(ellipsoids, ellipsoid);
    curved!(cylinders, cylinder);
    curved!(cones, cone);
    curved!(discs, disc);
    curved!(planes, plane);
    curved!(quadrics, quadric);
    parts.sort_by_key(|part| part.at);
    Ok(parts)
}

/// The parts by their objects.
fn groups<'a>(parts: Vec<Part<'a>>, library: &Library) -> Result<Vec<Group<'a>>, Complaint> {
    let mut groups: Vec<Group> = Vec::new();
    let mut known = HashMap::new();
    for part in parts {
        let next = groups.len();
        let number = part.about.object.map_or(next, |key| *known.entry(key).or_insert(next));
        if number == next {
            if next as u64 == MAX_OBJECTS {
                return Err((part.at, format!("expected at most {MAX_OBJECTS} objects")));
            }
            groups.push(Group::default());
        }
        groups[number].add(part, library)?;
    }
    Ok(groups)
}

impl<'a> Group<'a> {
    fn add(&mut self, part: Part<'a>, library: &Library) -> Result<(), Complaint> {
        let about = part.about;
        let material = about.material.map(|name| library.find(name)).transpose()?;
        let agreed = agree(&mut self.name, about.name, "name")
            .and_then(|()| agree(&mut self.material, material, "material"))
            .and_then(|()| agree(&mut self.casts, about.cast_shadows, "cast_shadows"))
            .and_then(|()| agree(&mut self.receives, about.receive_shadows, "receive_shadows"));
        if let Err(key) = agreed {
            let object = printable(about.object.unwrap_or_default());
            let why = format!("another `{key}` than other parts of object `{object}`");
            return Err((part.at, format!("{}: {why}", part.describe())));
        }
        self.parts.push(part);
        Ok(())
    }

    /// Its name, or its key, or its kind and number.
    fn name(&self) -> String {
        let Part { kind, index, about, .. } = &self.parts[0];
        name_of(kind, *index, self.name.or(about.object))
    }

    fn shadowing(&self) -> Shadowing {
        let usual = Shadowing::default();
        Shadowing {
            casts: self.casts.unwrap_or(usual.casts),
            receives: self.receives.unwrap_or(usual.receives),
        }
    }
}

/// Takes what a part says, unless another has said something else.
fn agree<T: PartialEq>(
    known: &mut Option<T>,
    said: Option<T>,
    key: &'static str,
) -> Result<(), &'static str> {
    match (&known, said) {
        (Some(known), Some(said)) if *known != said => Err(key),
        (None, said) => {
            *known = said;
            Ok(())
        }
        _ => Ok(()),
    }
}
