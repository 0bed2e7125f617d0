//! Pictures of other files within the page, as data of their own.

use crate::error::{Error, Place, Result};
use crate::scene::ImageSize;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use std::path::{Component, Path, PathBuf};

/// The longest file of a picture, in bytes.
const LONGEST: u64 = 256 << 20;

/// The largest side of a picture, in pixels.
const LARGEST: u32 = 32_768;

/// A picture as an address that holds all of it.
#[derive(Debug, Clone)]
pub(super) struct Embedded {
    /// `data:` and so on.
    pub(super) address: String,
    pub(super) size: ImageSize,
}

/// A PNG file, once it has been decoded.
///
/// # Errors
/// If it cannot be read or is none.
pub(super) fn png(path: &Path) -> Result<Embedded> {
    let bytes = bytes(path)?;
    let mut reader = ImageReader::with_format(Cursor::new(&bytes), ImageFormat::Png);
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST);
    limits.max_image_height = Some(LARGEST);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| Error::input(path, Place::File, format!("PNG: {error}")))?;
    let size = ImageSize { width: image.width(), height: image.height() };
    Ok(Embedded { address: format!("data:image/png;base64,{}", STANDARD.encode(&bytes)), size })
}

/// An SVG file, for an element that runs no scripts of it.
///
/// # Errors
/// If it cannot be read.
pub(super) fn svg(path: &Path) -> Result<String> {
    Ok(format!("data:image/svg+xml;base64,{}", STANDARD.encode(bytes(path)?)))
}

/// A file beside a document, by the name that the document has for it.
///
/// # Errors
/// If that leads anywhere else.
pub(super) fn beside(document: &Path, name: &str) -> Result<PathBuf> {
    let mut components = Path::new(name).components();
    match (components.next(), components.next()) {
        (Some(Component::Normal(_)), None) => Ok(document.with_file_name(name)),
        _ => Err(Error::input(
            document,
            Place::File,
            format!("expected the name of a file beside it, found `{name}`"),
        )),
    }
}

fn bytes(path: &Path) -> Result<Vec<u8>> {
    let unreadable = |source| Error::io(path, "read", source);
    let length = std::fs::metadata(path).map_err(unreadable)?.len();
    if length > LONGEST {
        return Err(Error::input(path, Place::File, format!("{length} bytes are too long for a picture")));
    }
    std::fs::read(path).map_err(unreadable)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_beside_the_document_or_refused() {
        let document = Path::new("out/2004/reproduce.json");
        assert_eq!(beside(document, "figure-9.png").unwrap(), Path::new("out/2004/figure-9.png"));
        for bad in ["../secret.png", "/etc/passwd", "a/b.png", "", ".", ".."] {
            assert!(beside(document, bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("image.png");
        std::fs::write(&path, "no picture").unwrap();
        let error = png(&path).unwrap_err().to_string();
        assert!(error.contains("image.png: PNG: "), "{error}");
        crate::film::write_png_rgb(&path, ImageSize { width: 2, height: 1 }, &[1; 6]).unwrap();
        let embedded = png(&path).unwrap();
        assert_eq!((embedded.size.width, embedded.size.height), (2, 1));
        assert!(embedded.address.starts_with("data:image/png;base64,iVBOR"));
    }
}
