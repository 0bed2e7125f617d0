//! What can go wrong, each as one line that a person can act on.

use std::fmt;
use std::path::{Path, PathBuf};

/// Where in a file something was found: a line, or an element by name (`mesh 3, primitive 0`).
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line, counted from 1.
    Line(usize),
    /// A named element of the file.
    Element(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => Ok(()),
            Place::Line(line) => write!(f, ":{line}"),
            Place::Element(element) => write!(f, ": {element}"),
        }
    }
}

/// Every error of the library. Its `Display` is one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A scene file says something that cannot be read as a scene.
    #[error("{}{place}: {message}", path.display())]
    Input { path: PathBuf, place: Place, message: String },
    /// A request that makes no sense, whatever the files say.
    #[error("{0}")]
    Usage(String),
    /// The operating system refused.
    #[error("{}: cannot {action}: {source}", path.display())]
    Io { path: PathBuf, action: &'static str, source: std::io::Error },
    /// Embree reported an error.
    #[error("Embree: {0}")]
    Embree(String),
}

/// Result of everything that can fail.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// An input error at a place of a file.
    pub fn input(path: &Path, place: Place, message: impl Into<String>) -> Error {
        Error::Input { path: path.to_path_buf(), place, message: message.into() }
    }

    /// An operating-system error on a file: `cannot ACTION`.
    pub fn io(path: &Path, action: &'static str, source: std::io::Error) -> Error {
        Error::Io { path: path.to_path_buf(), action, source }
    }
}
