//! Writes PNG files.

use super::FileSet;
use crate::error::{Error, Result};
use crate::scene::ImageSize;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes 8-bit RGB as PNG, complete or not at all. `rgb` holds three bytes a pixel, row by row from the
/// top left, in sRGB.
///
/// # Errors
/// [`Error::Usage`] if `rgb` is not of that length; [`Error::Io`] if the file cannot be written.
pub fn write_png_rgb(path: &Path, size: ImageSize, rgb: &[u8]) -> Result<()> {
    let mut files = FileSet::new();
    add_png_rgb(&mut files, path, size, rgb)?;
    files.publish()
}

/// The same as one file of several that appear together.
///
/// # Errors
/// As [`write_png_rgb`].
pub fn add_png_rgb(files: &mut FileSet, path: &Path, size: ImageSize, rgb: &[u8]) -> Result<()> {
    if rgb.len() != size.pixels() * 3 {
        let (have, want) = (rgb.len(), size.pixels());
        return Err(Error::Usage(format!("{}: {have} bytes of RGB for {want} pixels", path.display())));
    }
    files.write(path, |file| {
        let mut buffered = BufWriter::new(file);
        PngEncoder::new_with_quality(&mut buffered, CompressionType::Default, FilterType::Adaptive)
            .write_image(rgb, size.width, size.height, ExtendedColorType::Rgb8)
            .map_err(|error| match error {
                ImageError::IoError(source) => source,
                other => io::Error::other(other),
            })?;
        buffered.flush()
    })
}
