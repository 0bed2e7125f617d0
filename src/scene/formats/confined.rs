//! The files that a scene may read: itself, and what lies in its own folder.

use super::limits::{MAX_REFERENCED_BYTES, MAX_SCENE_BYTES};
use super::text::printable;
use crate::error::{Error, Place, Result};
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// Reads the scene file itself.
///
/// # Errors
/// If it cannot be opened, is not a regular file, or is larger than [`MAX_SCENE_BYTES`].
pub(super) fn read_scene(path: &Path) -> Result<Vec<u8>> {
    read_scene_within(path, MAX_SCENE_BYTES)
}

/// The same for a file that may hold so many bytes.
///
/// # Errors
/// As [`read_scene`].
pub(super) fn read_scene_within(path: &Path, limit: u64) -> Result<Vec<u8>> {
    read_regular(path, limit).map_err(|denial| match denial {
        Denial::Missing(source) | Denial::Unreadable(source) => Error::io(path, "read", source),
        Denial::Refused(why) => Error::input(path, Place::File, why),
    })
}

/// Why a file is not read.
#[derive(Debug)]
pub(super) enum Denial {
    /// There is no such file.
    Missing(io::Error),
    /// The operating system refused for another reason.
    Unreadable(io::Error),
    /// It must not be read; the text says why and goes on after `NAME: `.
    Refused(String),
}

impl Denial {
    /// What to tell the user about a name that a scene file gives.
    pub(super) fn message(&self, name: &str) -> String {
        let name = printable(name);
        match self {
            Denial::Missing(source) | Denial::Unreadable(source) => format!("cannot read `{name}`: {source}"),
            Denial::Refused(why) => format!("will not read `{name}`: {why}"),
        }
    }
}

/// The folder of one scene file. Names that the scene uses are resolved strictly inside it.
pub(super) struct Room {
    /// Canonical, so that links cannot lead out.
    folder: PathBuf,
    /// The scene file, canonical: it is no resource of itself.
    scene: PathBuf,
    /// Bytes that may still be read.
    budget: Cell<u64>,
    /// Files that were read, canonical.
    seen: RefCell<BTreeSet<PathBuf>>,
}

impl Room {
    /// The room of a scene file, with [`MAX_REFERENCED_BYTES`] to read in it.
    ///
    /// # Errors
    /// If the file or its folder cannot be resolved.
    pub(super) fn beside(scene: &Path) -> Result<Room> {
        let folder = match scene.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let canonical = |path: &Path| path.canonicalize().map_err(|e| Error::io(path, "resolve", e));
        Ok(Room {
            folder: canonical(folder)?,
            scene: canonical(scene)?,
            budget: Cell::new(MAX_REFERENCED_BYTES),
            seen: RefCell::default(),
        })
    }

    /// The same room with less to read.
    pub(super) fn with_budget(self, bytes: u64) -> Room {
        self.budget.set(bytes);
        self
    }

    /// Reads a file by the relative URI that glTF uses: percent-encoded, without a scheme.
    ///
    /// # Errors
    /// A [`Denial`] if the name leaves the folder or the file may not or cannot be read.
    pub(super) fn read_uri(&self, uri: &str) -> std::result::Result<Vec<u8>, Denial> {
        // Decoded first and checked afterwards: `%2e%2e` is `..`.
        let decoded = percent_encoding::percent_decode_str(uri).decode_utf8();
        let name = decoded.map_err(|_| Denial::Refused("its percent-encoding is not UTF-8".into()))?;
        self.read(&self.locate(&name)?)
    }

    /// Reads a file that [`Room::locate`] found.
    ///
    /// # Errors
    /// A [`Denial`] if it is not a regular file or exceeds what may still be read.
    pub(super) fn read(&self, located: &Path) -> std::result::Result<Vec<u8>, Denial> {
        let bytes = read_regular(located, self.budget.get())?;
        self.budget.set(self.budget.get() - bytes.len() as u64);
        Ok(bytes)
    }

    /// Resolves a name to a canonical path inside the folder.
    ///
    /// # Errors
    /// [`Denial::Missing`] if nothing is there, [`Denial::Refused`] if the name leads out of the folder, has
    /// a scheme, or is the scene file itself.
    pub(super) fn locate(&self, name: &str) -> std::result::Result<PathBuf, Denial> {
        let refused = |why: &str| Err(Denial::Refused(why.into()));
        // Windows reads backslashes as separators, and exporters there write them; they mean the same here.
        let name = name.replace('\\', "/");
        if name.is_empty() {
            return refused("the name is empty");
        }
        if name.contains('\0') {
            return refused("the name holds a zero byte");
        }
        if name.contains(':') {
            return refused("expected a relative path, without scheme or drive");
        }
        let inside = |c: Component| matches!(c, Component::Normal(_) | Component::CurDir);
        if name.starts_with('/') || !Path::new(&name).components().all(inside) {
            return refused("it leaves the scene's folder");
        }
        let path = self.folder.join(&name).canonicalize().map_err(Denial::from_io)?;
        if !path.starts_with(&self.folder) {
            return refused("a link leads out of the scene's folder");
        }
        if path == self.scene {
            return refused("it is the scene file itself");
        }
        Ok(path)
    }

    /// Whether a located file is asked for the first time.
    pub(super) fn first_visit(&self, located: &Path) -> bool {
        self.seen.borrow_mut().insert(located.to_path_buf())
    }
}

impl Denial {
    fn from_io(source: io::Error) -> Denial {
        match source.kind() {
            io::ErrorKind::NotFound => Denial::Missing(source),
            _ => Denial::Unreadable(source),
        }
    }
}

thread_local! {
    /// Files that were read on this thread, in the order of reading. Every loader ends in [`read_regular`], and none
    /// of them has another reason to know.
    static READ: RefCell<Vec<PathBuf>> = const { RefCell::new(Vec::new()) };
}

/// The files that were read on this thread since the last time that this was asked.
pub(super) fn files_read() -> Vec<PathBuf> {
    READ.take()
}

/// Reads a file whole if it is a regular one of at most `limit` bytes.
fn read_regular(path: &Path, limit: u64) -> std::result::Result<Vec<u8>, Denial> {
    // Asked before opening: to open a pipe that nobody writes to would wait for ever.
    let metadata = std::fs::metadata(path).map_err(Denial::from_io)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "a folder" } else { "a device or pipe" };
        return Err(Denial::Refused(format!("expected a regular file, found {what}")));
    }
    let too_large =
        |bytes: u64| Denial::Refused(format!("it holds {bytes} bytes, and {limit} may be read at most"));
    if metadata.len() > limit {
        return Err(too_large(metadata.len()));
    }
    let file = File::open(path).map_err(Denial::from_io)?;
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // One byte more than allowed tells a file that grew meanwhile.
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(Denial::from_io)?;
    if bytes.len() as u64 > limit {
        return Err(too_large(bytes.len() as u64));
    }
    READ.with_borrow_mut(|read| read.push(path.to_path_buf()));
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room() -> (tempfile::TempDir, Room) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("scene")).unwrap();
        std::fs::write(folder.path().join("secret"), "secret").unwrap();
        std::fs::write(folder.path().join("scene/a b.bin"), "inside").unwrap();
        let scene = folder.path().join("scene/scene.gltf");
        std::fs::write(&scene, "{}").unwrap();
        let room = Room::beside(&scene).unwrap();
        (folder, room)
    }

    #[test]
    fn names_inside_are_read_and_names_outside_are_not() {
        let (_folder, room) = room();
        for name in ["a b.bin", "a%20b.bin", "./a b.bin", ".\\a b.bin"] {
            assert_eq!(room.read_uri(name).unwrap(), b"inside", "{name}");
        }
        for name in [
            "../secret",
            "%2e%2e/secret",
            "..%5csecret",
            "x/../../secret",
            "/etc/passwd",
            "//etc/passwd",
            "C:/secret",
            "file:///etc/passwd",
            "http://localhost/a",
            "scene.gltf",
            "",
            "%00",
            "%ff",
            ".",
        ] {
            assert!(matches!(room.read_uri(name), Err(Denial::Refused(_))), "{name}");
        }
        assert!(matches!(room.read_uri("none.bin"), Err(Denial::Missing(_))));
    }

    #[test]
    fn all_files_together_stay_within_the_budget() {
        let (_folder, room) = room();
        let room = room.with_budget(10);
        assert!(room.read_uri("a b.bin").is_ok());
        let denial = room.read_uri("a b.bin").unwrap_err();
        assert_eq!(denial.message("x"), "will not read `x`: it holds 6 bytes, and 4 may be read at most");
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_lead_out() {
        let (folder, room) = room();
        let link = |to: &str, name: &str| {
            std::os::unix::fs::symlink(to, folder.path().join("scene").join(name)).unwrap();
        };
        link("../secret", "out");
        link("/dev/zero", "zero");
        link("a b.bin", "in");
        assert!(matches!(room.read_uri("out"), Err(Denial::Refused(_))));
        assert!(matches!(room.read_uri("zero"), Err(Denial::Refused(_))));
        assert_eq!(room.read_uri("in").unwrap(), b"inside");
    }
}
