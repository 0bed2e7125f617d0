//! Where results go: files that appear whole or not at all, and standard output.

use crate::error::{Error, Result};
use crate::film::{ImagePlanes, ToneMap, write_atomically, write_png_rgb};
use serde::Serialize;
use std::io::Write;
use std::path::Path;

/// Creates a folder, or finds it there.
///
/// # Errors
/// If it cannot be made, or something else has the name.
pub fn folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path).map_err(|e| Error::io(path, "create the folder", e))
}

/// Writes a document as JSON; the name `-` is standard output.
///
/// # Errors
/// If the file cannot be written.
pub fn write_json(path: &Path, document: &impl Serialize) -> Result<()> {
    let mut text = serde_json::to_string_pretty(document).map_err(|e| Error::Usage(format!("JSON: {e}")))?;
    text.push('\n');
    if path == Path::new("-") {
        print(&text)
    } else {
        write_atomically(path, |file| file.write_all(text.as_bytes()))
    }
}

/// Writes a result to standard output; a reader that has gone away is no error.
///
/// # Errors
/// If it cannot be written for another reason.
pub fn print(text: &str) -> Result<()> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::io(Path::new("standard output"), "write", e))
        }
        _ => Ok(()),
    }
}

/// A PNG of the planes R, G and B.
///
/// # Errors
/// If the file cannot be written.
pub fn write_preview(path: &Path, planes: &ImagePlanes, exposure: f32) -> Result<()> {
    let plane = |name: &str| planes.channel(name).unwrap_or_default();
    let rgb = ToneMap::new(exposure).apply_planes(plane("R"), plane("G"), plane("B"));
    write_png_rgb(path, planes.size(), &rgb)
}
