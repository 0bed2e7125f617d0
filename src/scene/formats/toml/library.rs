//! The files of a scene, each read once however often it is included.

use super::document::{self, Complaint, Content, Include, Moving};
use super::parts::Layout;
use super::totals::{Held, Totals};
use crate::error::{Error, Place, Result};
use crate::memory::MemoryLimit;
use crate::scene::animation::Motion;
use crate::scene::formats::confined::{self, Room};
use crate::scene::formats::limits::{MAX_ALL_TEXELS, MAX_INCLUDE_DEPTH};
use crate::scene::formats::limits::{MAX_REFERENCED_BYTES, MAX_TOML_BYTES};
use crate::scene::formats::pictures;
use crate::scene::formats::text::printable;
use crate::scene::formats::{self, Format};
use crate::scene::{Animation, FrameRate, Image, Scene};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// All files of a scene.
pub(super) struct Library {
    /// Those that a file includes come before it.
    pub(super) sources: Vec<Source>,
    /// By canonical path, the number of a file that was read.
    known: HashMap<PathBuf, usize>,
    /// Canonical paths of the files that are being read, each included by the one before it.
    open: Vec<PathBuf>,
    held: Held,
    /// Bytes that TOML files may still hold.
    text_left: u64,
    /// Bytes that files of other formats may still hold.
    bytes_left: u64,
    /// By canonical path, the pictures of textures.
    pictures: HashMap<PathBuf, Arc<Image>>,
    /// Texels that pictures may still have.
    texels_left: u64,
    /// What the whole scene may take.
    limit: MemoryLimit,
}

/// A file.
pub(super) struct Source {
    /// As it is shown in messages.
    pub(super) path: PathBuf,
    /// What it holds itself.
    pub(super) scene: Scene,
    /// What becomes of the objects of that.
    pub(super) layout: Layout,
    /// Its lights and cameras that move.
    pub(super) moving: Moving,
    /// What moves in a file of another format.
    pub(super) motion: Motion,
    /// Frames a second, if it says so.
    pub(super) rate: Option<FrameRate>,
    /// The background, if it or what it includes says one.
    pub(super) background: Option<[f32; 3]>,
    pub(super) inclusions: Vec<Inclusion>,
    /// With everything that it includes.
    totals: Totals,
}

/// A file in another.
pub(super) struct Inclusion {
    /// Its number in [`Library::sources`].
    pub(super) source: usize,
    /// The line that includes it.
    pub(super) line: usize,
    pub(super) entry: Include,
}

impl Library {
    /// Reads a scene file and whatever it includes; its name and its number, the last, come back beside.
    ///
    /// # Errors
    /// One line with file and place for what cannot be read, leads out of a file's folder, includes itself,
    /// or would become more than a scene may hold.
    pub(super) fn read(path: &Path, limit: MemoryLimit) -> Result<(Library, Option<String>)> {
        let mut library = Library {
            sources: Vec::new(),
            known: HashMap::new(),
            open: Vec::new(),
            held: Held::default(),
            text_left: MAX_TOML_BYTES,
            bytes_left: MAX_REFERENCED_BYTES,
            pictures: HashMap::new(),
            texels_left: MAX_ALL_TEXELS,
            limit,
        };
        let canonical = path.canonicalize().map_err(|error| Error::io(path, "read", error))?;
        let name = library.read_document(path, canonical)?;
        Ok((library, name))
    }

    /// Reads a TOML file, which becomes the last source, and returns the name that it gives its scene.
    fn read_document(&mut self, path: &Path, canonical: PathBuf) -> Result<Option<String>> {
        let bytes = confined::read_scene_within(path, self.text_left)?;
        self.text_left -= bytes.len() as u64;
        let at_line = |line: usize, why: String| Error::input(path, Place::Line(line), why);
        let lines = Lines::of(&bytes);
        let complaint = |(at, why): Complaint| at_line(lines.line(at), why);
        let text = str::from_utf8(&bytes)
            .map_err(|error| complaint((error.valid_up_to(), "expected text in UTF-8".into())))?;
        let room = Room::beside(path)?;
        let content = document::read(text, &mut |name| self.picture(&room, name)).map_err(complaint)?;
        let Content { name, mut background, rate, moving, scene, layout, includes } = content;
        self.held.add(&scene).map_err(|why| Error::input(path, Place::File, why))?;
        let own = Totals { objects: layout.objects.len() as u64, ..Totals::of(&scene) };
        let mut totals =
            Totals::default().plus(own, self.limit).map_err(|why| Error::input(path, Place::File, why))?;
        self.open.push(canonical);
        let mut inclusions = Vec::with_capacity(includes.len());
        // The operating system need not be asked twice about one name.
        let mut named = HashMap::new();
        for entry in includes {
            let line = lines.line(entry.at);
            let source = match named.get(&entry.path) {
                Some(&known) => known,
                None => self.include(path, &room, &entry, &|why| at_line(line, why))?,
            };
            named.insert(entry.path.clone(), source);
            background = background.or(self.sources[source].background);
            let mut added = self.sources[source].totals;
            if !entry.lights {
                added.lights = 0;
            }
            if !entry.cameras {
                added.cameras = 0;
            }
            totals = totals.plus(added, self.limit).map_err(|why| at_line(line, why))?;
            inclusions.push(Inclusion { source, line, entry });
        }
        let canonical = self.open.pop().expect("pushed above");
        let motion = Motion::default();
        let path = path.into();
        self.keep(
            canonical,
            Source { path, scene, layout, moving, motion, rate, background, inclusions, totals },
        );
        Ok(name)
    }

    /// Finds or reads an included file and returns its number.
    fn include(
        &mut self,
        path: &Path,
        room: &Room,
        entry: &Include,
        error: &dyn Fn(String) -> Error,
    ) -> Result<usize> {
        let located = room.locate(&entry.path).map_err(|denial| error(denial.message(&entry.path)))?;
        if let Some(&known) = self.known.get(&located) {
            return Ok(known);
        }
        if self.open.contains(&located) {
            return Err(error(format!("`{}` includes this file", printable(&entry.path))));
        }
        let shown = path.with_file_name("").join(entry.path.replace('\\', "/"));
        match Format::of(&located) {
            None => {
                return Err(error(format!("`{}`: {}", printable(&entry.path), Format::EXPECTED)));
            }
            Some(Format::Toml) if self.open.len() == MAX_INCLUDE_DEPTH => {
                return Err(error(format!("expected at most {MAX_INCLUDE_DEPTH} files inside each other")));
            }
            Some(Format::Toml) => {
                self.read_document(&shown, located)?;
            }
            Some(_) => {
                // The loader asks again; here only the sum of all files is of interest.
                let bytes = std::fs::metadata(&located).map_or(0, |metadata| metadata.len());
                self.bytes_left = self.bytes_left.checked_sub(bytes).ok_or_else(|| {
                    error(format!("all included files hold more than {MAX_REFERENCED_BYTES} bytes"))
                })?;
                let Animation { rest: scene, motion, rate } = formats::load_animation(&shown, self.limit)?;
                self.held.add(&scene).map_err(error)?;
                let totals = Totals::of(&scene);
                let source = Source {
                    path: shown,
                    layout: Layout::of(&scene),
                    moving: Moving::default(),
                    motion,
                    rate,
                    background: Some(scene.background).filter(|colour| *colour != [0.0; 3]),
                    scene,
                    inclusions: Vec::new(),
                    totals,
                };
                self.keep(located, source);
            }
        }
        Ok(self.sources.len() - 1)
    }

    /// Finds or reads a picture.
    fn picture(&mut self, room: &Room, name: &str) -> std::result::Result<Arc<Image>, String> {
        let located = room.locate(name).map_err(|denial| denial.message(name))?;
        if let Some(known) = self.pictures.get(&located) {
            return Ok(known.clone());
        }
        let bytes = room.read(&located).map_err(|denial| denial.message(name))?;
        let left = self.bytes_left.checked_sub(bytes.len() as u64);
        self.bytes_left =
            left.ok_or_else(|| format!("all included files hold more than {MAX_REFERENCED_BYTES} bytes"))?;
        let picture = pictures::read(&bytes, &mut self.texels_left, self.limit);
        let picture = Arc::new(picture.map_err(|why| format!("`{}`: {why}", printable(name)))?);
        self.pictures.insert(located, picture.clone());
        Ok(picture)
    }

    fn keep(&mut self, canonical: PathBuf, source: Source) {
        self.known.insert(canonical, self.sources.len());
        self.sources.push(source);
    }
}

/// Where the lines of a text end.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &[u8]) -> Lines {
        Lines(text.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at).collect())
    }

    /// The line, from 1, of a place in the text.
    fn line(&self, at: usize) -> usize {
        1 + self.0.partition_point(|&end| end < at)
    }
}
