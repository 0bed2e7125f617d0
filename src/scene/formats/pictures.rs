//! PNG files as pictures for textures.

use super::limits::{MAX_ALL_TEXELS, MAX_IMAGE_TEXELS};
use crate::scene::{Image, Texels};
use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, Limits};
use std::io::Cursor;

/// The most bytes that deflate makes of one: a file that declares more than that cannot hold it.
const MAX_INFLATION: u64 = 1032;

/// Reads a PNG file as sRGB of 8 bits; deeper channels are rounded, grey has three equal ones, alpha goes.
/// `texels_left` is what may still be read of [`MAX_ALL_TEXELS`].
///
/// # Errors
/// A line if it is no PNG, is broken, declares more than its bytes can hold, or has too many texels.
pub(super) fn read(bytes: &[u8], texels_left: &mut u64) -> Result<Image, String> {
    if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return Err("expected PNG".into());
    }
    let broken = |error: image::ImageError| format!("it cannot be read as PNG: {error}");
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_IMAGE_TEXELS * 8);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    let count = u64::from(width) * u64::from(height);
    if count > MAX_IMAGE_TEXELS {
        return Err(format!("{width} x {height} texels, expected at most {MAX_IMAGE_TEXELS}"));
    }
    let bits = u64::from(decoder.original_color_type().bits_per_pixel());
    if count * bits / 8 / MAX_INFLATION > bytes.len() as u64 {
        return Err(format!("{width} x {height} texels, more than {} bytes can hold", bytes.len()));
    }
    *texels_left = texels_left
        .checked_sub(count)
        .ok_or_else(|| format!("all pictures together have more than {MAX_ALL_TEXELS} texels"))?;
    let picture = DynamicImage::from_decoder(decoder).map_err(broken)?.into_rgb8();
    let texels = Texels::Srgb(picture.as_raw().as_chunks().0.to_vec());
    if (picture.width(), picture.height()) != (width, height) || texels.len() as u64 != count {
        return Err("it cannot be read as PNG: its size is in doubt".into());
    }
    Ok(Image { width, height, texels })
}
