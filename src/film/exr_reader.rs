//! Reads the OpenEXR files that we write, and trusts none of them.

use super::ImagePlanes;
use super::open_exr::ATTRIBUTE_PREFIX;
use crate::error::{Error, Place, Result};
use crate::scene::{FrameRate, ImageSize, Window};
use exr::block::UncompressedBlock;
use exr::block::reader::{ChunksReader, Reader};
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{AttributeValue, SampleType};
use exr::meta::header::Header;
use exr::prelude::Compression;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

/// The most bytes that one byte of deflate can become; a file that declares more than this has to be wrong.
const DEFLATE_LIMIT: u64 = 1032;

/// Reads an OpenEXR file of one part: scan lines of 32-bit floats under no compression, RLE or ZIP. Its data window is
/// its display window, or whole lines of that, and then the image knows its [`Window`].
///
/// Channels and our own attributes come sorted by name; other attributes are left out. Memory stays within
/// what the file's length can honestly expand to.
///
/// # Errors
/// [`Error::Io`] if the file cannot be opened or read; [`Error::Input`] in one line if it is damaged or of
/// another kind.
pub fn read_exr(path: &Path) -> Result<ImagePlanes> {
    let file = File::open(path).map_err(|source| Error::io(path, "open", source))?;
    let length = file.metadata().map_err(|source| Error::io(path, "read", source))?.len();
    decode(BufReader::new(file), length).map_err(|error| match error {
        exr::error::Error::Io(source) => Error::io(path, "read", source),
        // The message may quote the file; what it quotes must not break the line.
        other => Error::input(path, Place::File, one_line(&format!("OpenEXR: {other}"))),
    })
}

fn one_line(message: &str) -> String {
    message.chars().map(|c| if c.is_control() { '?' } else { c }).collect()
}

fn invalid(message: impl Into<String>) -> exr::error::Error {
    exr::error::Error::Invalid(message.into().into())
}

fn unsupported(message: &'static str) -> exr::error::Error {
    exr::error::Error::NotSupported(message.into())
}

fn decode(reader: impl Read + Seek, length: u64) -> exr::error::Result<ImagePlanes> {
    let reader = exr::block::read(reader, true)?;
    let [header] = reader.headers() else {
        return Err(unsupported("more than one part"));
    };
    let size = check_header(header, length)?;
    let window = check_windows(header, size)?;
    let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
    let attributes = own_attributes(header);
    let rate = header.own_attributes.frames_per_second;
    let planes = decode_planes(reader, size, names.len())?;

    let wrong = |error: Error| invalid(error.to_string());
    let mut image = ImagePlanes::new(size);
    window.map_or(Ok(()), |window| image.set_window(window)).map_err(wrong)?;
    for (name, samples) in names.into_iter().zip(planes) {
        image.add_channel(name, samples).map_err(wrong)?;
    }
    for (name, text) in attributes {
        image.add_attribute(name, text).map_err(wrong)?;
    }
    let rate = rate.and_then(|(numerator, denominator)| {
        FrameRate::new(u32::try_from(numerator).ok()?, denominator).ok()
    });
    rate.into_iter().for_each(|rate| image.set_frame_rate(rate));
    Ok(image)
}

/// The size of an image of the kind we read, once the file is long enough to hold it.
fn check_header(header: &Header, length: u64) -> exr::error::Result<ImageSize> {
    if header.deep || header.blocks != BlockDescription::ScanLines {
        return Err(unsupported("deep or tiled image"));
    }
    use Compression::{RLE, Uncompressed, ZIP1, ZIP16};
    if ![Uncompressed, RLE, ZIP1, ZIP16].contains(&header.compression) {
        return Err(unsupported("compression other than RLE or ZIP"));
    }
    let channels = &header.channels.list;
    if channels.iter().any(|c| c.sample_type != SampleType::F32 || c.sampling != Vec2(1, 1)) {
        return Err(unsupported("channels other than full 32-bit floats"));
    }
    let side = |pixels: usize| u32::try_from(pixels).map_err(|_| invalid("image size"));
    let size =
        ImageSize { width: side(header.layer_size.width())?, height: side(header.layer_size.height())? };
    let bytes = u64::from(size.width)
        .checked_mul(u64::from(size.height))
        .and_then(|pixels| pixels.checked_mul(4 * channels.len() as u64));
    match bytes {
        Some(bytes) if bytes > 0 && bytes <= length.saturating_mul(DEFLATE_LIMIT) => Ok(size),
        _ => Err(invalid(format!(
            "{}x{} pixels in {} channels cannot be in {length} bytes",
            size.width,
            size.height,
            channels.len()
        ))),
    }
}

/// Where the lines belong in the display window, unless they are all of it. Both windows may begin anywhere; nothing of
/// the size of the display window is allocated.
fn check_windows(header: &Header, size: ImageSize) -> exr::error::Result<Option<Window>> {
    let outside = || unsupported("data window that is not whole lines of the display window");
    let display = header.shared_attributes.display_window;
    let Vec2(left, top) = header.own_attributes.layer_position;
    let side = |pixels: usize| u32::try_from(pixels).map_err(|_| invalid("display window"));
    let of = ImageSize { width: side(display.size.width())?, height: side(display.size.height())? };
    let first_row = u32::try_from(i64::from(top) - i64::from(display.position.y())).map_err(|_| outside())?;
    let fits = u64::from(first_row) + u64::from(size.height) <= u64::from(of.height);
    if left != display.position.x() || of.width != size.width || !fits {
        return Err(outside());
    }
    Ok((of != size).then_some(Window { of, first_row }))
}

/// The samples of every channel. Lines must come from top to bottom, each once; planes grow as they come, so
/// that a size which is only declared costs nothing.
fn decode_planes<R: Read + Seek>(
    reader: Reader<R>,
    size: ImageSize,
    channels: usize,
) -> exr::error::Result<Vec<Vec<f32>>> {
    let width = size.width as usize;
    let mut planes = vec![Vec::new(); channels];
    let mut next_line = 0;
    let mut chunks = reader.all_chunks(true)?;
    while let Some(chunk) = chunks.read_next_chunk() {
        let block = UncompressedBlock::decompress_chunk(chunk?, chunks.meta_data(), true)?;
        let Vec2(block_width, lines) = block.index.pixel_size;
        if block.index.pixel_position != Vec2(0, next_line) {
            return Err(invalid("lines twice or out of order"));
        }
        if block_width != width || block.data.len() != lines * width * 4 * channels {
            return Err(invalid("block of another size"));
        }
        for (row, bytes) in block.data.chunks_exact(width * 4).enumerate() {
            let samples = bytes.chunks_exact(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]]));
            planes[row % channels].extend(samples);
        }
        next_line += lines;
    }
    if next_line != size.height as usize {
        return Err(invalid("lines are missing"));
    }
    Ok(planes)
}

/// Our string attributes without their prefix, sorted by name.
fn own_attributes(header: &Header) -> Vec<(String, String)> {
    let all = header.own_attributes.other.iter().chain(&header.shared_attributes.other);
    let mut own: Vec<(String, String)> = all
        .filter_map(|(name, value)| {
            let name = std::str::from_utf8(name.as_slice()).ok()?.strip_prefix(ATTRIBUTE_PREFIX)?;
            let AttributeValue::Text(text) = value else { return None };
            Some((name.to_string(), String::from_utf8_lossy(text.as_slice()).into_owned()))
        })
        .collect();
    own.sort();
    own
}
