//! Reads JSON that this program wrote, and trusts none of it.

use super::settings::printable;
use crate::error::{Error, Place, Result};
use serde::de::DeserializeOwned;
use std::io::Read;
use std::path::Path;

/// The longest document that is read.
const MOST_BYTES: u64 = 1 << 30;

/// What a file that was opened at a path says. `expected` names it for the error.
///
/// # Errors
/// [`Error::Io`] if it cannot be read, [`Error::Input`] if it says something else.
pub fn read_json<T: DeserializeOwned>(file: impl Read, path: &Path, expected: &str) -> Result<T> {
    let mut bytes = Vec::new();
    file.take(MOST_BYTES).read_to_end(&mut bytes).map_err(|source| Error::io(path, "read", source))?;
    serde_json::from_slice(&bytes).map_err(|error| unexpected(path, expected, &error.to_string()))
}

/// The error of a document that says something else.
pub fn unexpected(path: &Path, expected: &str, why: &str) -> Error {
    Error::input(path, Place::File, format!("expected {expected}: {}", printable(why)))
}
