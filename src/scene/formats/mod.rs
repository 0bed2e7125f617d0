//! Scene files: one module a format, one entry for all.

use super::Scene;
use crate::error::{Error, Place, Result};
use std::path::Path;

/// Reads a scene file; the extension of its name decides the format.
///
/// # Errors
/// One line with file and place for whatever cannot be read.
pub fn load(path: &Path) -> Result<Scene> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match extension.as_str() {
        _ => Err(Error::input(path, Place::File, "expected a name that ends in .obj, .gltf or .glb")),
    }
}
