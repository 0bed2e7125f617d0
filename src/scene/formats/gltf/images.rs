//! The alpha channel of images, for masks alone: whatever no mask needs is never read.

use super::accessors::Accessors;
use super::buffers::Buffers;
use super::schema::Document;
use crate::memory::MemoryLimit;
use crate::scene::formats::limits::{MAX_ALL_TEXELS, MAX_REFERENCED_BYTES};
use crate::scene::formats::pictures;
use image::{ColorType, ImageDecoder};
use std::borrow::Cow;

/// Alpha by column and row.
pub(super) struct Alpha {
    pub(super) width: u32,
    pub(super) height: u32,
    layout: Layout,
    texels: Vec<u8>,
}

/// Where alpha stands in a texel.
#[derive(Clone, Copy)]
struct Layout {
    /// Bytes of a texel; those of alpha are its last.
    size: usize,
    /// Whether alpha has 16 bits and not 8.
    deep: bool,
}

impl Alpha {
    /// From 0 to 1: the stored number over the largest that there is, rounded once.
    pub(super) fn at(&self, column: u32, row: u32) -> f64 {
        let end = (row as usize * self.width as usize + column as usize + 1) * self.layout.size;
        match self.layout.deep {
            false => f64::from(self.texels[end - 1]) / 255.0,
            // The decoder writes 16 bits as the machine keeps them.
            true => f64::from(u16::from_ne_bytes([self.texels[end - 2], self.texels[end - 1]])) / 65535.0,
        }
    }
}

/// What images have cost so far. One that is read again, since other materials ask other things of it, costs
/// as much again.
pub(super) struct Spent {
    bytes: u64,
    texels_left: u64,
    limit: MemoryLimit,
}

impl Spent {
    /// Nothing yet, of what one image may take while it is decoded.
    pub(super) fn within(limit: MemoryLimit) -> Spent {
        Spent { bytes: 0, texels_left: MAX_ALL_TEXELS, limit }
    }
}

/// The alpha channel of an image, `None` if it has none, which means that all of it is opaque.
///
/// Of a JPEG file, which never has one, nothing but its first bytes is looked at.
///
/// # Errors
/// A line if there is no such image, its file or view cannot be read, it is neither PNG nor JPEG, is broken,
/// declares more than its bytes can hold, or all together have more than [`MAX_ALL_TEXELS`] or
/// [`MAX_REFERENCED_BYTES`].
pub(super) fn alpha(
    document: &Document,
    buffers: &Buffers,
    accessors: &Accessors,
    index: u64,
    spent: &mut Spent,
) -> Result<Option<Alpha>, String> {
    let at = |why: String| format!("image {index}: {why}");
    let entry = usize::try_from(index).ok().and_then(|i| document.images.get(i));
    let entry = entry.ok_or_else(|| format!("image {index} of {}", document.images.len()))?;
    let bytes = match (&entry.uri, entry.buffer_view) {
        (Some(uri), None) => buffers.resource(uri).map_err(at)?,
        (None, Some(view)) => Cow::Borrowed(accessors.view_bytes(view).map_err(at)?),
        _ => return Err(at("expected either a uri or a bufferView".into())),
    };
    spent.bytes = spent.bytes.saturating_add(bytes.len() as u64);
    if spent.bytes > MAX_REFERENCED_BYTES {
        return Err(at(format!("all images together hold more than {MAX_REFERENCED_BYTES} bytes")));
    }
    if bytes.starts_with(&[0xff, 0xd8, 0xff]) {
        return Ok(None);
    }
    if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return Err(at("expected PNG or JPEG".into()));
    }
    png_alpha(&bytes, spent).map_err(at)
}

fn png_alpha(bytes: &[u8], spent: &mut Spent) -> Result<Option<Alpha>, String> {
    let decoder = pictures::decoder(bytes)?;
    let layout = match decoder.color_type() {
        ColorType::La8 => Layout { size: 2, deep: false },
        ColorType::Rgba8 => Layout { size: 4, deep: false },
        ColorType::La16 => Layout { size: 4, deep: true },
        ColorType::Rgba16 => Layout { size: 8, deep: true },
        _ => return Ok(None),
    };
    let (width, height) = decoder.dimensions();
    // The mask that comes of it takes a bit a texel.
    pictures::check_size(&decoder, bytes, 1, &mut spent.texels_left, spent.limit)?;
    // At least one texel each way, or the decoder had refused it; at most 2^26 of at most eight bytes.
    let mut texels = vec![0; width as usize * height as usize * layout.size];
    if decoder.total_bytes() != texels.len() as u64 {
        return Err("it cannot be read as PNG: its size is in doubt".into());
    }
    decoder.read_image(&mut texels).map_err(pictures::broken)?;
    Ok(Some(Alpha { width, height, layout, texels }))
}
