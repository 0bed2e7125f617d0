//! Rings around what is too rare to be seen.
//!
//! One wrong pixel among a million is the very thing that a difference map is for, and on a screen it is
//! lost. Around the pixels of a rare category runs a ring in its colour between two dark lines. Pixels closer
//! together than the ring is wide share one outline. The ring keeps its distance: the pixels themselves and
//! those around them stay as they are, and no ring runs over a rare pixel, or its surroundings, of any category.

use super::canvas::Canvas;
use super::palette;
use crate::scene::ImageSize;
use std::collections::BTreeMap;

/// The most pixels of a whole image that count as rare.
pub const RARE_PIXELS: u64 = 200;

/// Whether rings are drawn around the pixels of a category.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marking {
    /// Never: nobody is looking for them.
    Never,
    /// When the image has 1 to [`RARE_PIXELS`] of them.
    WhenRare,
}

/// Distances from the nearest rare pixel at which the ring changes, in pixels: the inner dark line begins,
/// the colour begins, the outer dark line begins, the ring ends.
struct Ring([u32; 4]);

impl Ring {
    /// Grows with the size of the legend's font, so that rings and text are seen from as far.
    fn at_scale(scale: u32) -> Ring {
        let clear = 3 + 2 * scale;
        Ring([clear, clear + 1, clear + 2 + scale, clear + 3 + scale])
    }

    fn colour_at(&self, squared_distance: u32, colour: [u8; 3]) -> Option<[u8; 3]> {
        let [inner, from, to, outer] = self.0.map(|radius| radius * radius);
        match squared_distance {
            d if d < inner || d >= outer => None,
            d if d >= from && d < to => Some(colour),
            _ => Some(palette::BLACK),
        }
    }
}

/// Draws the rings around all pixels that `ring_colour` gives a colour; `at` is the index of a pixel, row by
/// row. Where rings of different colours meet, each goes as far as its own pixels are the nearer ones.
pub(super) fn draw_rings(
    canvas: &mut Canvas,
    size: ImageSize,
    scale: u32,
    ring_colour: impl Fn(usize) -> Option<[u8; 3]>,
) {
    let ring = Ring::at_scale(scale);
    let reach = i64::from(ring.0[3]);
    let (width, height) = (i64::from(size.width), i64::from(size.height));
    // Squared distance to the nearest rare pixel and its colour, wherever that is within reach.
    let mut nearest: BTreeMap<(i64, i64), (u32, [u8; 3])> = BTreeMap::new();
    let rare = (0..size.pixels()).filter_map(|at| Some((at as i64, ring_colour(at)?)));
    for (at, colour) in rare {
        let (x, y) = (at % width, at / width);
        for py in (y - reach).max(0)..=(y + reach).min(height - 1) {
            for px in (x - reach).max(0)..=(x + reach).min(width - 1) {
                let here = (((px - x) * (px - x) + (py - y) * (py - y)) as u32, colour);
                nearest.entry((py, px)).and_modify(|best| *best = here.min(*best)).or_insert(here);
            }
        }
    }
    for ((y, x), (squared, colour)) in nearest {
        if let Some(colour) = ring.colour_at(squared, colour) {
            canvas.set(x as u32, y as u32, colour);
        }
    }
}
