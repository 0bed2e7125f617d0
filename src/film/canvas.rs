//! A picture to draw on: rectangles and text in an 8 by 8 pixel font.

use crate::scene::ImageSize;
use font8x8::{BASIC_FONTS, LATIN_FONTS, UnicodeFonts};

/// Pixels of a glyph's side before it is magnified.
pub(super) const GLYPH: u32 = 8;

/// An RGB picture. Whatever is drawn outside it is cut off.
pub(super) struct Canvas {
    size: ImageSize,
    rgb: Vec<u8>,
}

impl Canvas {
    pub(super) fn new(size: ImageSize, colour: [u8; 3]) -> Canvas {
        Canvas { size, rgb: colour.repeat(size.pixels()) }
    }

    pub(super) fn set(&mut self, x: u32, y: u32, colour: [u8; 3]) {
        if x < self.size.width && y < self.size.height {
            let at = (y as usize * self.size.width as usize + x as usize) * 3;
            self.rgb[at..at + 3].copy_from_slice(&colour);
        }
    }

    /// A filled square with its top left corner at (x, y).
    pub(super) fn square(&mut self, x: u32, y: u32, side: u32, colour: [u8; 3]) {
        for dy in 0..side {
            for dx in 0..side {
                self.set(x + dx, y + dy, colour);
            }
        }
    }

    /// One line of text, each font pixel a square of `scale`; (x, y) is its top left corner. What the font
    /// lacks is drawn as a question mark.
    pub(super) fn text(&mut self, x: u32, y: u32, scale: u32, colour: [u8; 3], text: &str) {
        for (index, character) in text.chars().enumerate() {
            let left = x + index as u32 * GLYPH * scale;
            for (row, bits) in (0..).zip(glyph(character)) {
                for column in (0..GLYPH).filter(|column| bits >> column & 1 == 1) {
                    self.square(left + column * scale, y + row * scale, scale, colour);
                }
            }
        }
    }

    pub(super) fn into_rgb(self) -> (ImageSize, Vec<u8>) {
        (self.size, self.rgb)
    }
}

/// Eight rows from the top, the lowest bit leftmost.
fn glyph(character: char) -> [u8; 8] {
    let found = BASIC_FONTS.get(character).or_else(|| LATIN_FONTS.get(character));
    found.or_else(|| BASIC_FONTS.get('?')).unwrap_or_default()
}
