//! Where results go: files that appear whole or not at all, and standard output.

use crate::error::{Error, Result};
use crate::film::{ImagePlanes, ToneMap, write_atomically, write_png_rgb};
use serde::Serialize;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Finds out before long work whether a file could be written: its folder must be there, and no folder may
/// have its name. The name `-` is standard output.
///
/// # Errors
/// What writing would report at the end.
pub fn expect_writable(path: &Path) -> Result<()> {
    if path == Path::new("-") {
        return Ok(());
    }
    let refused = |source| Err(Error::io(path, "write", source));
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match folder.metadata() {
        Err(source) => refused(source),
        Ok(metadata) if !metadata.is_dir() => refused(ErrorKind::NotADirectory.into()),
        Ok(_) if path.is_dir() => refused(ErrorKind::IsADirectory.into()),
        Ok(_) => Ok(()),
    }
}

/// Finds out before long work whether a folder is there or could be made: what exists of its path must be
/// folders.
///
/// # Errors
/// What making it would report at the end.
pub fn expect_folder(path: &Path) -> Result<()> {
    let there = path.ancestors().find(|ancestor| ancestor.exists());
    match there {
        Some(ancestor) if !ancestor.is_dir() => {
            Err(Error::io(path, "create the folder", ErrorKind::NotADirectory.into()))
        }
        _ => Ok(()),
    }
}

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

/// A PNG of the planes R, G and B, over the background where they are not opaque.
///
/// # Errors
/// If the file cannot be written.
pub fn write_preview(path: &Path, planes: &ImagePlanes, background: [f32; 3], exposure: f32) -> Result<()> {
    let alpha = planes.channel("A").unwrap_or_default();
    let [red, green, blue] = [("R", 0), ("G", 1), ("B", 2)].map(|(name, channel)| {
        let samples = planes.channel(name).unwrap_or_default().iter().zip(alpha);
        samples.map(|(value, alpha)| value + (1.0 - alpha) * background[channel]).collect::<Vec<_>>()
    });
    let rgb = ToneMap::new(exposure).apply_planes(&red, &green, &blue);
    write_png_rgb(path, planes.size(), &rgb)
}
