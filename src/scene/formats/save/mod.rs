//! Scenes written as files that are read back as the same scene.
//!
//! What a format cannot say is an error, and then no file is written.

mod cameras;
mod nff;
mod numbers;
mod textures;
mod toml;

use crate::atomic::{FileSet, write_atomically};
use crate::error::{Error, Place, Result};
use crate::scene::{Light, Object, Scene};
use std::io::Write;
use std::path::Path;

/// The element that cannot be said, and why.
type Complaint = (String, String);

/// Writes a scene; the extension of the name decides the format: `.toml`, or `.nff` for what that can say.
///
/// From TOML, [`load`](super::load) makes the same primitives, objects, materials, lights, cameras and textures,
/// number by number; images of textures are written beside the file, as `NAME-texture-1.png`. NFF has no names,
/// and places and intensities of cameras and lights may be off by a rounding; its primitives are the same.
///
/// # Errors
/// One line with the file and the element that the format cannot say, and what the operating system refuses.
pub fn save(scene: &Scene, path: &Path) -> Result<()> {
    let refuse = |(element, why): Complaint| {
        let place = if element.is_empty() { Place::File } else { Place::Element(element) };
        Error::input(path, place, why)
    };
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    match extension.to_ascii_lowercase().as_str() {
        "toml" => {
            let pictures = textures::Files::of(scene, path).map_err(refuse)?;
            let text = toml::text(scene, &pictures).map_err(refuse)?;
            let mut files = FileSet::new();
            pictures.write(path, &mut files)?;
            files.write(path, |file| file.write_all(text.as_bytes()))?;
            files.publish()
        }
        "nff" => {
            let text = nff::text(scene).map_err(refuse)?;
            write_atomically(path, |file| file.write_all(text.as_bytes()))
        }
        _ => Err(Error::input(path, Place::File, "expected a name that ends in .toml or .nff")),
    }
}

/// `object 2`, with its name, for complaints.
fn object(scene: &Scene, object: &Object) -> String {
    let index = scene.objects.iter().position(|other| std::ptr::eq(other, object)).unwrap_or_default();
    format!("object {} `{}`", index + 1, super::text::printable(&object.name))
}

/// The same of a light.
fn light(light: &Light) -> String {
    format!("light `{}`", super::text::printable(&light.name))
}
