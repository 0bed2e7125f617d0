//! PNG files: as pictures for textures, and for whatever else is looked for in one.

use super::limits::{MAX_ALL_TEXELS, MAX_IMAGE_TEXELS};
use crate::memory::MemoryLimit;
use crate::scene::{Image, Texels};
use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, ImageError, Limits};
use std::io::Cursor;

/// The most bytes that deflate makes of one: a file that declares more than that cannot hold it.
const MAX_INFLATION: u64 = 1032;

/// A PNG file whose header was read.
pub(super) type Decoder<'a> = PngDecoder<Cursor<&'a [u8]>>;

/// What to say of a file that the decoder gives up.
pub(super) fn broken(error: ImageError) -> String {
    format!("it cannot be read as PNG: {error}")
}

/// Reads the header of a PNG file.
///
/// # Errors
/// A line if it is no PNG or is broken.
pub(super) fn decoder(bytes: &[u8]) -> Result<Decoder<'_>, String> {
    if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return Err("expected PNG".into());
    }
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_IMAGE_TEXELS * 8);
    PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(broken)
}

/// Checks what a header declares before memory is asked for. `texels_left` is what may still be read of
/// [`MAX_ALL_TEXELS`]; a texel takes so many bytes beside its own while and after it is decoded.
///
/// # Errors
/// A line if it declares more than its bytes can hold, has too many texels, or needs more than the limit.
pub(super) fn check_size(
    decoder: &Decoder,
    bytes: &[u8],
    beside: u64,
    texels_left: &mut u64,
    limit: MemoryLimit,
) -> Result<(), String> {
    let (width, height) = decoder.dimensions();
    let count = u64::from(width) * u64::from(height);
    if count > MAX_IMAGE_TEXELS {
        return Err(format!("{width} x {height} texels, expected at most {MAX_IMAGE_TEXELS}"));
    }
    let bits = u64::from(decoder.original_color_type().bits_per_pixel());
    if count * bits / 8 / MAX_INFLATION > bytes.len() as u64 {
        return Err(format!("{width} x {height} texels, more than {} bytes can hold", bytes.len()));
    }
    let needed = decoder.total_bytes().saturating_add(count * beside);
    limit.check(format!("{width} x {height} texels"), needed).map_err(|error| error.to_string())?;
    *texels_left = texels_left
        .checked_sub(count)
        .ok_or_else(|| format!("all pictures together have more than {MAX_ALL_TEXELS} texels"))?;
    Ok(())
}

/// Reads a PNG file as sRGB of 8 bits; deeper channels are rounded, grey has three equal ones, alpha goes.
///
/// # Errors
/// A line if it is no PNG, is broken, or [`check_size`] refuses it.
pub(super) fn read(bytes: &[u8], texels_left: &mut u64, limit: MemoryLimit) -> Result<Image, String> {
    let decoder = decoder(bytes)?;
    let (width, height) = decoder.dimensions();
    // Three channels of one byte, twice.
    check_size(&decoder, bytes, 6, texels_left, limit)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(broken)?.into_rgb8();
    let texels = Texels::Srgb(picture.as_raw().as_chunks().0.to_vec());
    let count = u64::from(width) * u64::from(height);
    if (picture.width(), picture.height()) != (width, height) || texels.len() as u64 != count {
        return Err("it cannot be read as PNG: its size is in doubt".into());
    }
    Ok(Image { width, height, texels })
}
