//! Scene files: one module a format, one entry for all, [`load`]; and [`save`] for those that are written.
//!
//! Input is hostile. Every loader reads its bytes through `confined`, checks what a file declares against
//! what it holds before memory is asked for, keeps within [`limits`], and turns whatever it cannot read into
//! one line with file and place. What is left out without being an error is among the scene's warnings.

mod confined;
mod estimate;
mod gltf;
pub mod limits;
mod looking;
mod nff;
mod obj;
mod pictures;
mod ply;
pub(super) mod polygon;
mod save;
pub(super) mod shading_normals;
mod text;
mod toml;

pub use save::save;

use super::{Animation, Dropped, Scene, procedural};
use crate::error::{Error, Place, Result};
use crate::float_environment::StandardFloats;
use crate::memory::MemoryLimit;
use std::path::{Path, PathBuf};

/// Reads a scene file; the extension of its name decides the format: `.obj`, `.ply`, `.gltf`, `.glb`,
/// `.nff` or `.toml`. `builtin:NAME` is no file but the scene of that name in
/// [`procedural::BUILTIN`], at its standard size.
///
/// Files that the scene names are read only from the folder that holds it, or from below.
///
/// # Errors
/// One line with file and place for whatever cannot be read, and for a file without a single primitive.
pub fn load(path: &Path) -> Result<Scene> {
    load_within(path, MemoryLimit::NONE)
}

/// The same within a limit for what no file bounds by its own bytes: instances, files that are included more than
/// once, pictures, and accessors of zeros. Each is estimated before any memory is asked for.
///
/// # Errors
/// As [`load`], and [`Error::Input`] for what would need more.
pub fn load_within(path: &Path, limit: MemoryLimit) -> Result<Scene> {
    Ok(load_animation(path, limit)?.rest)
}

/// The same with what moves in it.
///
/// # Errors
/// As [`load_within`].
pub fn load_animation(path: &Path, limit: MemoryLimit) -> Result<Animation> {
    let _floats = StandardFloats::new();
    if let Some(name) = path.to_str().and_then(|path| path.strip_prefix(BUILTIN_PREFIX)) {
        return Ok(procedural::find(name)?.build(None)?.into());
    }
    let animation = match Format::of(path) {
        Some(Format::Obj) => obj::load(path)?.into(),
        Some(Format::Ply) => ply::load(path)?.into(),
        Some(Format::Gltf) => gltf::load(path, gltf::Container::Text, limit)?,
        Some(Format::Glb) => gltf::load(path, gltf::Container::Binary, limit)?,
        Some(Format::Nff) => nff::load(path)?.into(),
        Some(Format::Toml) => toml::load(path, limit)?,
        None => return Err(Error::input(path, Place::File, Format::EXPECTED)),
    };
    if animation.rest.primitive_count() == 0 {
        let Dropped { degenerate, non_finite, curved } = animation.rest.dropped;
        let why = match degenerate + non_finite + curved {
            0 => "expected at least one triangle or curved surface, found none".to_owned(),
            dropped => format!(
                "expected at least one triangle or curved surface, found {dropped} of zero area or with \
                 numbers that are not finite or out of range"
            ),
        };
        return Err(Error::input(path, Place::File, why));
    }
    if !animation.motion.objects.is_empty() {
        // A frame's scene stands beside that at rest, and what moves is there in its own space too.
        let (objects, triangles) = (animation.rest.objects.len(), animation.rest.triangles.len());
        let estimate = estimate::Estimate {
            objects: 2 * objects as u64,
            triangles: 2 * triangles as u64,
            curved: 2 * animation.rest.curved.len() as u64,
            ..estimate::Estimate::default()
        };
        estimate.check(limit).map_err(|why| Error::input(path, Place::File, format!("animated: {why}")))?;
    }
    Ok(animation)
}

/// The files that a scene was read from: its own, and those that it names.
#[derive(Debug, Clone, Default)]
pub struct SceneFiles(Vec<PathBuf>);

impl SceneFiles {
    /// Whether a file is one of them.
    pub fn contain(&self, file: &Path) -> bool {
        self.0.iter().any(|read| read == file)
    }

    /// A checksum of what is in them, wherever they are and in whatever order they were read; pipes and devices are left
    /// out.
    ///
    /// # Errors
    /// If one of them cannot be read any more.
    pub fn checksum(&self) -> Result<u32> {
        let mut all = Vec::new();
        for path in self.0.iter().filter(|path| path.is_file()) {
            all.push(crate::atomic::FileState::of(path)?);
        }
        all.sort();
        let mut hasher = crc32fast::Hasher::new();
        for state in all {
            hasher.update(&state.bytes.to_le_bytes());
            hasher.update(&state.crc32.to_le_bytes());
        }
        Ok(hasher.finalize())
    }
}

/// The same as [`load_animation`], and the files that were read for it.
///
/// # Errors
/// As [`load_within`].
pub fn load_with_files(path: &Path, limit: MemoryLimit) -> Result<(Animation, SceneFiles)> {
    confined::files_read();
    let animation = load_animation(path, limit)?;
    let canonical = |file: PathBuf| file.canonicalize().unwrap_or(file);
    Ok((animation, SceneFiles(confined::files_read().into_iter().map(canonical).collect())))
}

/// What a name begins with that is of a built-in scene and not of a file.
pub const BUILTIN_PREFIX: &str = "builtin:";

/// What the extension of a file's name says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Obj,
    Ply,
    Gltf,
    Glb,
    Nff,
    Toml,
}

impl Format {
    const EXPECTED: &str = "expected a name that ends in .obj, .ply, .gltf, .glb, .nff or .toml";

    fn of(path: &Path) -> Option<Format> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "obj" => Some(Format::Obj),
            "ply" => Some(Format::Ply),
            "gltf" => Some(Format::Gltf),
            "glb" => Some(Format::Glb),
            "nff" => Some(Format::Nff),
            "toml" => Some(Format::Toml),
            _ => None,
        }
    }
}

/// The name that a scene is reported under: its file's name.
fn scene_name(path: &Path) -> String {
    path.file_name().map_or_else(|| "scene".into(), |name| text::printable(&name.to_string_lossy()))
}

/// The name of an object in a file that does not name its objects: the file's, without its extension.
fn file_stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "object".into(), |stem| text::printable(&stem.to_string_lossy()))
}
