//! What can go wrong, each as one line that a person can act on.

use std::fmt::{self, Write};
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

/// Whether a character would break a line of text, or do worse to a terminal.
pub(crate) fn breaks_line(character: char) -> bool {
    character.is_control() || matches!(character, '\u{2028}' | '\u{2029}')
}

/// Text that stays on one line, whatever a path or a library's message brings along: characters that would
/// break it are escaped.
pub(crate) struct OneLine<T>(pub T);

impl<T: fmt::Display> fmt::Display for OneLine<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        struct Escaped<'a, 'f>(&'a mut fmt::Formatter<'f>);
        impl fmt::Write for Escaped<'_, '_> {
            fn write_str(&mut self, text: &str) -> fmt::Result {
                text.chars().try_for_each(|c| {
                    if breaks_line(c) {
                        write!(self.0, "{}", c.escape_default())
                    } else {
                        self.0.write_char(c)
                    }
                })
            }
        }
        write!(Escaped(f), "{}", self.0)
    }
}

/// Every error of the library. Its `Display` is one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A scene file says something that cannot be read as a scene.
    #[error("{}{}: {}", OneLine(path.display()), OneLine(place), OneLine(message))]
    Input {
        /// The file.
        path: PathBuf,
        /// Where in it.
        place: Place,
        /// What was expected, or what is wrong there.
        message: String,
    },
    /// A request that makes no sense, whatever the files say.
    #[error("{}", OneLine(.0))]
    Usage(String),
    /// The operating system refused.
    #[error("{}: cannot {action}: {}", OneLine(path.display()), OneLine(source))]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What could not be done: "read".
        action: &'static str,
        /// What the system says.
        source: std::io::Error,
    },
    /// Embree reported an error.
    #[error("Embree: {}", OneLine(.0))]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_is_one_line_whatever_it_quotes() {
        let path = Path::new("a\nb\u{1b}[31m.obj");
        let place = Place::Element("mesh\r1".into());
        let refused = std::io::Error::other("no\u{2028}way");
        let lines = [
            Error::input(path, place, "says\ttwo\nlines").to_string(),
            Error::io(path, "read", refused).to_string(),
            Error::Usage("no camera `a\nb`".into()).to_string(),
            Error::Embree("line\nbreak".into()).to_string(),
        ];
        assert_eq!(lines[0], "a\\nb\\u{1b}[31m.obj: mesh\\r1: says\\ttwo\\nlines");
        assert_eq!(lines[1], "a\\nb\\u{1b}[31m.obj: cannot read: no\\u{2028}way");
        assert_eq!(lines[2], "no camera `a\\nb`");
        assert_eq!(lines[3], "Embree: line\\nbreak");
    }
}
