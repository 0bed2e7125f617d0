//! Where a result goes.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What has a result's name already, with links followed: a link stays, and what it leads to is replaced.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Destination {
    /// A regular file, or nothing yet.
    File(PathBuf),
    /// A device or a pipe, which is written into: replacing `/dev/null` would be the end of it.
    Special(PathBuf),
}

/// As many links as Linux follows.
const MOST_LINKS: usize = 40;

impl Destination {
    /// Of this name.
    ///
    /// # Errors
    /// If it is a folder, its own folder is missing, or links go round in a circle.
    pub fn of(path: &Path) -> io::Result<Destination> {
        match path.metadata() {
            Ok(there) if there.is_dir() => Err(ErrorKind::IsADirectory.into()),
            Ok(there) if there.is_file() => Ok(Destination::File(path.canonicalize()?)),
            Ok(_) => Ok(Destination::Special(path.to_path_buf())),
            Err(error) if error.kind() == ErrorKind::NotFound => missing(path),
            Err(error) => Err(error),
        }
    }

    /// The folder in which a file appears.
    pub fn folder(&self) -> Option<&Path> {
        match self {
            Destination::File(path) => path.parent(),
            Destination::Special(_) => None,
        }
    }
}

fn missing(path: &Path) -> io::Result<Destination> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        let folder = folder_of(&path).canonicalize()?;
        if !folder.is_dir() {
            return Err(ErrorKind::NotADirectory.into());
        }
        match path.read_link() {
            Ok(target) => path = folder.join(target),
            Err(_) => {
                let name = path.file_name().ok_or(ErrorKind::InvalidFilename)?;
                return Ok(Destination::File(folder.join(name)));
            }
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

/// The folder that a name is in.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
