//! Our own scene format, in TOML: what no interchange format says, and files of the others by path.
//!
//! `docs/SCENE-FORMAT.md` explains it element by element. In short: `[[include]]` places another file, `[[mesh]]`
//! and a table for each kind of curved surface are parts of objects, `[[material]]`, `[[light]]` and `[[camera]]`
//! say the rest. What a file holds itself comes before what it includes.
//!
//! Coordinates are rounded to 32 bits where they are read. Transforms are in f64, those of nested files are
//! multiplied there, and each coordinate is rounded once after them. Where nothing moves an object its numbers
//! stay bit by bit.
//!
//! [`library`] reads every file once, [`document`] what a file says itself, [`parts`] what becomes of its meshes and
//! surfaces. [`totals`] counts how much all
//! that would become, so that a scene that is too large is refused before any of it is placed here.

mod cameras;
mod document;
mod keyframes;
mod library;
mod lights;
mod materials;
mod meshes;
mod moving;
mod parts;
mod schema;
mod shapes;
mod totals;
mod transforms;
mod values;

pub(super) use self::transforms::cosine_of_degrees;
pub(super) use self::values::BRIGHTEST;

use self::library::{Library, Source};
use self::moving::{Grafted, Movers, Space};
use super::scene_name;
use super::text::printable;
use crate::error::{Error, Place, Result};
use crate::memory::MemoryLimit;
use crate::scene::animation::MovingElement;
use crate::scene::{Adopted, Animation, ObjectInput, Placement, SceneBuilder};
use glam::DAffine3;
use std::path::Path;

/// Reads a TOML scene.
///
/// # Errors
/// One line with file and place for whatever cannot be read in it or in a file that it includes.
pub(super) fn load(path: &Path, limit: MemoryLimit) -> Result<Animation> {
    let (library, name) = Library::read(path, limit)?;
    let builder = SceneBuilder::new(name.unwrap_or_else(|| scene_name(path)));
    let adopted = library.sources.iter().map(|_| None).collect();
    let mut assembly = Assembly { library: &library, builder, adopted, movers: Movers::default() };
    assembly.place(library.sources.len() - 1, &Circumstances::usual())?;
    let background = library.sources.last().and_then(|source| source.background);
    assembly.builder.set_background(background.unwrap_or_default());
    let folder = path.parent().unwrap_or(Path::new(""));
    for source in &library.sources {
        for warning in &source.scene.warnings {
            assembly.builder.warn(match source.path == path {
                true => warning.clone(),
                false => format!("{}: {warning}", shown(folder, &source.path)),
            });
        }
    }
    let rate = library.sources.last().and_then(|source| source.rate);
    Ok(Animation { rest: assembly.builder.finish(), motion: assembly.movers.motion, rate })
}

/// An included file as seen from the scene's folder.
fn shown(folder: &Path, path: &Path) -> String {
    printable(&path.strip_prefix(folder).unwrap_or(path).to_string_lossy())
}

/// What the files around one say about everything in it.
#[derive(Clone)]
struct Circumstances {
    /// At rest.
    placement: Placement,
    /// The same as it moves.
    space: Space,
    lights: bool,
    cameras: bool,
}

impl Circumstances {
    /// Of the scene file itself.
    fn usual() -> Circumstances {
        Circumstances {
            placement: Placement::default(),
            space: Space::default(),
            lights: true,
            cameras: true,
        }
    }
}

/// Files on their way into one scene.
struct Assembly<'a> {
    library: &'a Library,
    builder: SceneBuilder,
    /// What each file's numbers have become, once it has been placed.
    adopted: Vec<Option<Adopted>>,
    /// What moves in it.
    movers: Movers,
}

impl Assembly<'_> {
    /// Places a file: what it holds itself, then what it includes.
    fn place(&mut self, number: usize, around: &Circumstances) -> Result<()> {
        let source = &self.library.sources[number];
        let mut adopted = match self.adopted[number].take() {
            Some(adopted) => adopted,
            None => self.builder.adopt(&source.scene),
        };
        let outer = &around.placement;
        let wrong = |error: Error| Error::input(&source.path, Place::File, error.to_string());
        let grafted =
            self.movers.graft(&source.motion, &around.space).map_err(|why| wrong(Error::Usage(why)))?;
        for object in &source.layout.objects {
            let mut parts = Vec::with_capacity(object.len());
            let mut spaces = Vec::with_capacity(object.len());
            for index in object.clone() {
                let own = source.layout.transforms[index];
                let part = &source.scene.objects[index];
                let name = || format!("object `{}`", part.name);
                let space =
                    self.movers.within(&around.space, own, source.layout.tracks[index].as_ref(), name);
                spaces.push(space.map_err(|why| wrong(Error::Usage(why)))?);
                let placement = Placement { transform: within(outer.transform, own), ..*outer };
                let placed = self.builder.placed(&source.scene, part, &mut adopted, &placement);
                parts.push(placed.map_err(wrong)?);
            }
            let index = self.builder.object_count();
            if let Some(moving) = grafted.objects.get(&object.start) {
                self.movers.add_grafted(index, moving);
            } else if spaces.iter().any(Space::moves) {
                let still = Placement { transform: None, ..*outer };
                let own = object.clone().map(|part| {
                    let part = &source.scene.objects[part];
                    self.builder.placed(&source.scene, part, &mut adopted, &still)
                });
                let own = own.collect::<Result<Vec<_>>>().map_err(wrong)?;
                self.movers.add_object(index, own, spaces);
            }
            if let Some(whole) = ObjectInput::join(parts) {
                self.builder.add_object(whole).map_err(wrong)?;
            }
        }
        self.builder.count_dropped(source.scene.dropped);
        self.look_and_light(source, around, &grafted)?;
        for inclusion in &source.inclusions {
            let entry = &inclusion.entry;
            let transform = within(outer.transform, entry.transform);
            if !transform.is_none_or(|transform| transform.is_finite()) {
                let why = "its transform inside those around it is not finite";
                return Err(Error::input(&source.path, Place::Line(inclusion.line), why));
            }
            let placement = Placement {
                transform,
                casts: outer.casts.or(entry.casts),
                receives: outer.receives.or(entry.receives),
                material: outer.material.or(entry.material.map(|index| adopted.material(index))),
            };
            let name = || format!("include `{}`", printable(&entry.path));
            let space = self.movers.within(&around.space, entry.transform, entry.track.as_ref(), name);
            let at_line = |why| Error::input(&source.path, Place::Line(inclusion.line), why);
            let inner = Circumstances {
                placement,
                space: space.map_err(at_line)?,
                lights: around.lights && entry.lights,
                cameras: around.cameras && entry.cameras,
            };
            self.place(inclusion.source, &inner)?;
        }
        self.adopted[number] = Some(adopted);
        Ok(())
    }

    /// Places the lights and cameras that a file holds itself.
    fn look_and_light(&mut self, source: &Source, around: &Circumstances, grafted: &Grafted) -> Result<()> {
        let transform = &around.placement.transform;
        let nowhere = |element: String| {
            let why = "the transform of an include leaves it no place or no direction";
            Error::input(&source.path, Place::Element(element), why)
        };
        let wrong = |why: String| Error::input(&source.path, Place::File, why);
        for (index, light) in source.scene.lights.iter().enumerate().filter(|_| around.lights) {
            let own = source.moving.lights.get(&index);
            let moving = self.movers.element(&around.space, light, own, grafted.lights.get(&index));
            if let Some((subject, hold)) = moving.map_err(wrong)? {
                let index = self.builder.light_count();
                self.movers.motion.lights.push(MovingElement { index, subject, hold });
            }
            let placed = match transform {
                Some(transform) => light.transformed(transform),
                None => Some(light.clone()),
            };
            self.builder.add_light(placed.ok_or_else(|| nowhere(format!("light `{}`", light.name)))?);
        }
        for (index, camera) in source.scene.cameras.iter().enumerate().filter(|_| around.cameras) {
            let own = source.moving.cameras.get(&index);
            let moving = self.movers.element(&around.space, camera, own, grafted.cameras.get(&index));
            if let Some((subject, hold)) = moving.map_err(wrong)? {
                let index = self.builder.camera_count();
                self.movers.motion.cameras.push(MovingElement { index, subject, hold });
            }
            let placed = match transform {
                Some(transform) => camera.transformed(transform),
                None => Some(camera.clone()),
            };
            self.builder.add_camera(placed.ok_or_else(|| nowhere(format!("camera `{}`", camera.name)))?);
        }
        Ok(())
    }
}

/// A transform inside another.
fn within(outer: Option<DAffine3>, inner: Option<DAffine3>) -> Option<DAffine3> {
    match (outer, inner) {
        (Some(outer), Some(inner)) => Some(outer * inner),
        (outer, inner) => outer.or(inner),
    }
}
