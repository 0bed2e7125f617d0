//! What a run leaves to look at: image planes, OpenEXR files, PNG pictures and false-colour maps.
//!
//! Numbers go to OpenEXR in 32-bit floats, exactly as they were computed ([`write_exr`]); PNG files are for
//! people ([`write_png_rgb`], [`write_false_colour`]). The bytes of every file depend on what it shows and
//! on nothing else: not on threads, time or place. Files appear whole or not at all ([`write_atomically`]), and
//! several of them together ([`FileSet`]). How far one image is from another is asked in numbers ([`ImageDifference`],
//! [`ImageMetrics`]).

mod attribute_order;
mod canvas;
mod difference;
mod digits;
mod exr_reader;
mod false_colour;
mod legend;
mod markers;
mod metrics;
mod names;
mod open_exr;
pub mod palette;
mod planes;
mod png;
mod subdivision;
mod tone;

pub use crate::atomic::{FileSet, write_atomically};
pub use difference::{Allowance, ChannelDifference, ImageDifference, Likeness};
pub use digits::grouped;
pub use exr_reader::read_exr;
pub use false_colour::{Category, CategoryMap, add_false_colour, write_false_colour};
pub use markers::{Marking, RARE_PIXELS};
pub use metrics::ImageMetrics;
pub use names::{safe_light_name, unique_safe_names};
pub use open_exr::{BLOCK_ROWS, add_exr, write_exr};
pub use planes::{ImagePlanes, Plane};
pub use png::{add_png_rgb, write_png_rgb};
pub use subdivision::subdivided;
pub use tone::{ToneMap, linear_to_srgb8};
