//! Writes OpenEXR files: one part, full channel names, 32-bit floats, compressed without loss.

use super::attribute_order::sort_attributes;
use super::{FileSet, ImagePlanes, Plane};
use crate::error::Result;
use crate::scene::Window;
use exr::block::writer::ChunksWriter;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{
    AttributeValue, ChannelDescription, ChannelList, Chromaticities, IntegerBounds, LineOrder, SampleType,
    Text,
};
use exr::meta::header::{Header, LayerAttributes};
use exr::prelude::Compression;
use rayon::prelude::*;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

/// What our attributes are called in a file, before their own name. No standard attribute has a colon, so
/// none can ever be meant by two.
pub(super) const ATTRIBUTE_PREFIX: &str = "lightbuffer:";

/// Rows that are compressed together: files of parts that begin at multiples of it hold the same blocks as that of the whole.
pub const BLOCK_ROWS: u32 = 16;

/// Blocks of 16 lines that each thread compresses before they are written out; bounds the memory for what
/// is compressed and not yet written.
const BLOCKS_PER_THREAD: usize = 4;

/// Primaries and white point of Rec. 709, with D65.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.3, 0.6),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.329),
};

/// Writes an image as OpenEXR: one part of scan lines, ZIP over 16 lines, every channel 32-bit float, every
/// bit as given.
///
/// Attributes are strings named `lightbuffer:NAME`; `software` names this version, and the chromaticities
/// are those of Rec. 709. Rows of a larger image are the data window, and that image is the display window. Channels and attributes are sorted by name, as the format wants. The bytes of the
/// file depend on the image alone. Compression uses the rayon pool of the caller.
///
/// # Errors
/// [`crate::Error::Io`] if the file cannot be written, or the image has no channel; nothing is left then.
pub fn write_exr(path: &Path, image: &ImagePlanes) -> Result<()> {
    let mut files = FileSet::new();
    add_exr(&mut files, path, image)?;
    files.publish()
}

/// The same as one file of several that appear together.
///
/// # Errors
/// As [`write_exr`].
pub fn add_exr(files: &mut FileSet, path: &Path, image: &ImagePlanes) -> Result<()> {
    files.write(path, |file| {
        let mut planes: Vec<&Plane> = image.channels().iter().collect();
        planes.sort_by(|a, b| a.name.cmp(&b.name));
        write_blocks(file, header(image, &planes), &planes).map_err(|error| match error {
            exr::error::Error::Io(source) => source,
            other => io::Error::other(other),
        })?;
        sort_attributes(file)
    })
}

fn header(image: &ImagePlanes, planes: &[&Plane]) -> Header {
    let size = Vec2(image.size().width as usize, image.size().height as usize);
    let channels = planes.iter().map(|plane| ChannelDescription {
        name: text(&plane.name),
        sample_type: SampleType::F32,
        quantize_linearly: false,
        sampling: Vec2(1, 1),
    });
    let mut header = Header::new(Text::default(), size, channels.collect()).with_encoding(
        Compression::ZIP16,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    );
    if let Some(Window { of, first_row }) = image.window() {
        // `set_window` takes no more rows than fit.
        header.own_attributes.layer_position = Vec2(0, first_row as i32);
        header.shared_attributes.display_window =
            IntegerBounds::from_dimensions(Vec2(of.width as usize, of.height as usize));
    }
    header.shared_attributes.chromaticities = Some(REC_709);
    header.own_attributes = LayerAttributes {
        software_name: Some(text(concat!("lightbuffer ", env!("CARGO_PKG_VERSION")))),
        other: image
            .attributes()
            .iter()
            .map(|(name, value)| {
                (text(&format!("{ATTRIBUTE_PREFIX}{name}")), AttributeValue::Text(text(value)))
            })
            .collect(),
        frames_per_second: image.frame_rate().map(|rate| {
            let (numerator, denominator) = rate.fraction();
            // A rate's terms have 31 bits.
            (numerator as i32, denominator)
        }),
        layer_position: header.own_attributes.layer_position,
        ..LayerAttributes::default()
    };
    header
}

/// The bytes of the string, as UTF-8; the `exr` crate's own conversion would refuse what is not Latin-1.
fn text(string: &str) -> Text {
    Text::from_bytes_unchecked(string.as_bytes().into())
}

fn write_blocks(file: &mut File, header: Header, planes: &[&Plane]) -> exr::error::UnitResult {
    let width = header.layer_size.width();
    exr::block::write(BufWriter::new(file), [header].into_iter().collect(), true, |meta, chunks| {
        let channels = &meta.headers[0].channels;
        let blocks: Vec<(usize, BlockIndex)> = meta.enumerate_ordered_header_block_indices().collect();
        for batch in blocks.chunks(rayon::current_num_threads() * BLOCKS_PER_THREAD) {
            let compress = |&(position, index): &(usize, BlockIndex)| {
                let chunk = block(index, channels, planes, width).compress_to_chunk(&meta.headers)?;
                Ok((position, chunk))
            };
            // Compressed in any order, written in theirs: this is what makes the bytes deterministic.
            let compressed: Vec<_> = batch.par_iter().map(compress).collect::<exr::error::Result<_>>()?;
            for (position, chunk) in compressed {
                chunks.write_chunk(position, chunk)?;
            }
        }
        Ok(())
    })
}

/// The samples of one block: line by line, channel by channel.
fn block(index: BlockIndex, channels: &ChannelList, planes: &[&Plane], width: usize) -> UncompressedBlock {
    UncompressedBlock::from_lines(channels, index, |line| {
        let (Vec2(x, y), count) = (line.location.position, line.location.sample_count);
        let first = y * width + x;
        let samples = &planes[line.location.channel].samples[first..first + count];
        for (bytes, sample) in line.value.chunks_exact_mut(4).zip(samples) {
            bytes.copy_from_slice(&sample.to_ne_bytes());
        }
    })
}
