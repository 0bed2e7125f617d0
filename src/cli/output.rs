//! Where results go: files that appear whole or not at all, and standard output.

use super::progress::Messages;
use crate::atomic::{Destination, expect_room_in, unfinished_in};
use crate::error::{Error, Result};
use crate::film::{FileSet, ImagePlanes, ToneMap, add_png_rgb};
use crate::scene::formats::SceneFiles;
use serde::Serialize;
use std::collections::HashSet;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Standard output, as the name of a file.
const STANDARD_OUTPUT: &str = "-";

/// Whether a path is the name of standard output.
pub fn is_standard_output(path: &Path) -> bool {
    path == Path::new(STANDARD_OUTPUT)
}

/// Finds out before long work whether a file could be written: its folder must be there and have room for one, and no
/// folder may have its name. The name `-` is standard output.
///
/// # Errors
/// What writing would report at the end.
pub fn expect_writable(path: &Path) -> Result<()> {
    if is_standard_output(path) {
        return Ok(());
    }
    let refused = |source| Error::io(path, "write", source);
    let destination = Destination::of(path).map_err(refused)?;
    destination.folder().map_or(Ok(()), expect_room_in).map_err(refused)
}

/// Finds out before long work whether a folder is there or could be made, with files in it: what exists of its path
/// must be folders, and the last of them must be writable.
///
/// # Errors
/// What making it would report at the end.
pub fn expect_folder(path: &Path) -> Result<()> {
    let named = |folder: &&Path| !folder.as_os_str().is_empty();
    let there = path.ancestors().filter(named).find(|ancestor| ancestor.symlink_metadata().is_ok());
    let room = |folder: &Path| match folder.metadata() {
        Ok(metadata) if !metadata.is_dir() => Err(ErrorKind::NotADirectory.into()),
        Ok(_) => expect_room_in(folder),
        Err(error) => Err(error),
    };
    let action = if there == Some(path) && path.is_dir() { "write" } else { "create the folder" };
    room(there.unwrap_or(Path::new("."))).map_err(|source| Error::io(path, action, source))
}

/// Warns of what killed runs left in the folder of the results.
pub fn warn_of_remains(folder: &Path, messages: Messages) {
    let count = unfinished_in(folder);
    if count > 0 {
        let files =
            if count == 1 { "an unfinished file".into() } else { format!("{count} unfinished files") };
        let folder = folder.display();
        messages
            .warn(&format!("{folder}: {files} (.lightbuffer-*.part) of a run that was killed or is at work"));
    }
}

/// Fails if a result would replace a file of the scene, or two results have one name.
///
/// # Errors
/// As said.
pub fn expect_apart(results: &[PathBuf], files: &SceneFiles) -> Result<()> {
    let mut taken: HashSet<PathBuf> = HashSet::new();
    for path in results.iter().filter(|path| *path != Path::new(STANDARD_OUTPUT)) {
        // A name in a folder that is not there yet is that of no file; two such are compared as they stand.
        let place = match Destination::of(path) {
            Ok(Destination::File(place)) => place,
            Ok(Destination::Special(_)) => continue,
            Err(_) => path.clone(),
        };
        if files.contain(&place) {
            return Err(Error::Usage(format!(
                "{}: a result would replace a file of the scene",
                path.display()
            )));
        }
        if !taken.insert(place) {
            return Err(Error::Usage(format!("{}: two results have this name", path.display())));
        }
    }
    Ok(())
}

fn json_text(document: &impl Serialize) -> Result<String> {
    let mut text = serde_json::to_string_pretty(document).map_err(|e| Error::Usage(format!("JSON: {e}")))?;
    text.push('\n');
    Ok(text)
}

/// Adds a document as JSON.
///
/// # Errors
/// If the file cannot be written.
pub fn add_json(files: &mut FileSet, path: &Path, document: &impl Serialize) -> Result<()> {
    let text = json_text(document)?;
    files.write(path, |file| file.write_all(text.as_bytes()))
}

/// Adds the document of `--json`, if that was given, and returns what goes to standard output: `text`, or the
/// document in place of it if that is what `--json` names.
///
/// # Errors
/// If the file cannot be written.
pub fn add_copy(
    files: &mut FileSet,
    json: Option<&Path>,
    document: &impl Serialize,
    text: impl FnOnce() -> String,
) -> Result<String> {
    match json {
        Some(path) if path == Path::new(STANDARD_OUTPUT) => return json_text(document),
        Some(path) => add_json(files, path, document)?,
        None => {}
    }
    Ok(text())
}

/// Ends a run: all files are on the disk, so standard output is written, and then they get their names. Whatever fails
/// before that leaves what was there before.
///
/// # Errors
/// If something cannot be written.
pub fn finish(files: FileSet, standard_output: &str) -> Result<()> {
    print(standard_output)?;
    files.publish()
}

/// Writes a result to standard output; a reader that has gone away is no error.
///
/// # Errors
/// If it cannot be written for another reason.
pub fn print(text: &str) -> Result<()> {
    let mut output = std::io::stdout().lock();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Error::io(Path::new("standard output"), "write", e))
        }
        _ => Ok(()),
    }
}

/// A PNG of the planes R, G and B, over the background where they are not opaque.
///
/// # Errors
/// If the file cannot be written.
pub fn add_preview(
    files: &mut FileSet,
    path: &Path,
    planes: &ImagePlanes,
    background: [f32; 3],
    exposure: f32,
) -> Result<()> {
    let alpha = planes.channel("A").unwrap_or_default();
    let [red, green, blue] = [("R", 0), ("G", 1), ("B", 2)].map(|(name, channel)| {
        let samples = planes.channel(name).unwrap_or_default().iter().zip(alpha);
        samples.map(|(value, alpha)| value + (1.0 - alpha) * background[channel]).collect::<Vec<_>>()
    });
    let rgb = ToneMap::new(exposure).apply_planes(&red, &green, &blue);
    add_png_rgb(files, path, planes.size(), &rgb)
}
