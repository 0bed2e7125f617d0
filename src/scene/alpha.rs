//! Alpha masks: where a surface is there, and where it is a hole.

use crate::geometry::texel::{Place, TexelAxis};
use dashu_int::IBig;
use dashu_int::ops::RemEuclid;
use std::sync::Arc;

/// Where a surface is there, texel by texel. Holes are decided when a scene is loaded; nothing is there by half.
///
/// Texture coordinates `(u, v)` are glTF's: `(0, 0)` is the upper left corner of the image and `(1, 1)` the
/// lower right one. There is no filter: texel `(i, j)`, column and row, is all of
/// `[i / width, (i + 1) / width) x [j / height, (j + 1) / height)`, and outside of `[0, 1)` the image goes on
/// as [`AlphaMask::wrap`] says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AlphaMask {
    /// Texels in a row; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// How the image goes on beyond its sides, along u and along v.
    pub wrap: [Wrap; 2],
    /// A bit a texel, row by row from the top (v = 0), the lowest bit of each word first; 1 is opaque.
    /// Shared by the scenes of all frames.
    opaque: Arc<[u64]>,
}

/// How an image goes on beyond its sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Wrap {
    /// Over and over.
    Repeat,
    /// Over and over, every other time mirrored.
    MirroredRepeat,
    /// The texels at its border go on.
    ClampToEdge,
}

impl Wrap {
    /// The texel of a row or column of `size` (at least 1) that shows at a place counted in texels, from 0 at
    /// the image's left or upper border, over all its repetitions.
    pub fn texel(self, place: i64, size: u32) -> u32 {
        let size = i64::from(size);
        let texel = match self {
            Wrap::Repeat => place.rem_euclid(size),
            Wrap::MirroredRepeat => {
                let there_and_back = place.rem_euclid(2 * size);
                there_and_back.min(2 * size - 1 - there_and_back)
            }
            Wrap::ClampToEdge => place.clamp(0, size - 1),
        };
        // From 0 to size - 1.
        texel as u32
    }
}

impl Wrap {
    /// The same for a place of any size.
    pub(crate) fn repeated(self, place: &IBig, size: u32) -> u32 {
        let period = 2 * i64::from(size);
        match i64::try_from(place) {
            Ok(place) => self.texel(place, size),
            Err(_) if self == Wrap::ClampToEdge => {
                if *place < IBig::ZERO {
                    0
                } else {
                    size - 1
                }
            }
            Err(_) => {
                let rest = IBig::from(place.rem_euclid(IBig::from(period)));
                self.texel(i64::try_from(&rest).expect("below the period"), size)
            }
        }
    }
}

impl AlphaMask {
    /// A mask by a function of column and row, which is asked row by row.
    ///
    /// # Panics
    /// If width or height is 0.
    pub fn new(
        width: u32,
        height: u32,
        wrap: [Wrap; 2],
        mut is_opaque: impl FnMut(u32, u32) -> bool,
    ) -> AlphaMask {
        assert!(width > 0 && height > 0, "a mask without texels");
        let texels = width as usize * height as usize;
        let mut opaque = vec![0u64; texels.div_ceil(64)];
        let mut texel = 0;
        for row in 0..height {
            for column in 0..width {
                opaque[texel / 64] |= u64::from(is_opaque(column, row)) << (texel % 64);
                texel += 1;
            }
        }
        AlphaMask { width, height, wrap, opaque: opaque.into() }
    }

    /// Whether the surface is there, by column and row of a texel inside the image.
    ///
    /// # Panics
    /// If there is no such texel.
    pub fn is_opaque(&self, column: u32, row: u32) -> bool {
        assert!(column < self.width && row < self.height, "texel {column} {row} outside of the image");
        let texel = row as usize * self.width as usize + column as usize;
        self.opaque[texel / 64] >> (texel % 64) & 1 == 1
    }

    /// The same at a place counted in texels from the image's upper left corner, over all its repetitions.
    pub fn is_opaque_at(&self, column: i64, row: i64) -> bool {
        self.is_opaque(self.wrap[0].texel(column, self.width), self.wrap[1].texel(row, self.height))
    }

    /// A bit a texel, row by row from the top, the lowest bit of each word first; 1 is opaque.
    pub fn words(&self) -> &[u64] {
        &self.opaque
    }

    /// A hash of texels, size and wrapping.
    pub(super) fn hash(&self) -> u64 {
        let wrap = self.wrap.map(|wrap| wrap as u64);
        let words = [u64::from(self.width), u64::from(self.height), wrap[0], wrap[1]].into_iter();
        words.chain(self.opaque.iter().copied()).fold(0xcbf2_9ce4_8422_2325, |hash, word| {
            (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(29)
        })
    }

    /// How many texels are opaque.
    pub fn opaque_texels(&self) -> u64 {
        self.opaque.iter().map(|word| u64::from(word.count_ones())).sum()
    }
}

/// A triangle with holes: its mask, and where its corners lie in it.
#[derive(Debug, Clone, Copy)]
pub struct MaskedTriangle<'a> {
    /// Where it is there.
    pub mask: &'a AlphaMask,
    /// `[u, v]` of the three corners.
    pub coordinates: [[f32; 2]; 3],
}

impl MaskedTriangle<'_> {
    /// The mask's axes over the triangle, u and v.
    pub fn axes(&self) -> [TexelAxis; 2] {
        let axis = |i: usize, size: u32| TexelAxis { coordinates: self.coordinates.map(|c| c[i]), size };
        [axis(0, self.mask.width), axis(1, self.mask.height)]
    }

    /// Whether it is there at a place along each axis.
    pub fn is_there(&self, [u, v]: [Place; 2]) -> bool {
        let texel = |wrap: Wrap, place: Place, size: u32| match place {
            Place::Near(place) => wrap.texel(place, size),
            Place::Far { beyond: true, .. } if wrap == Wrap::ClampToEdge => size - 1,
            Place::Far { beyond: false, .. } if wrap == Wrap::ClampToEdge => 0,
            Place::Far { repeated, .. } => wrap.texel(repeated, size),
        };
        let (mask, [across, down]) = (self.mask, self.mask.wrap);
        mask.is_opaque(texel(across, u, mask.width), texel(down, v, mask.height))
    }
}

/// Texture coordinates of one object, for its alpha mask.
#[derive(Debug, Clone)]
pub struct TextureCoordinates {
    /// `[u, v]`, with every transform of the file applied; finite, of any size.
    pub coordinates: Vec<[f32; 2]>,
    /// Three indices into `coordinates` for each triangle of the object.
    pub corners: Vec<[u32; 3]>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_go_on_beyond_their_sides() {
        let row = |wrap: Wrap| (-4..7).map(|place| wrap.texel(place, 3)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]);
        assert_eq!(row(Wrap::MirroredRepeat), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
        assert_eq!(row(Wrap::ClampToEdge), [0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]);
        for wrap in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
            for place in [i64::MIN, i64::MAX] {
                assert!(wrap.texel(place, u32::MAX) < u32::MAX);
                assert_eq!(wrap.texel(place, 1), 0);
            }
        }
    }

    #[test]
    fn texels_are_kept_row_by_row() {
        let wrap = [Wrap::Repeat, Wrap::ClampToEdge];
        let mask = AlphaMask::new(13, 11, wrap, |column, row| (column * row) % 3 == 1);
        let mut opaque = 0;
        for row in 0..11 {
            for column in 0..13 {
                assert_eq!(mask.is_opaque(column, row), (column * row) % 3 == 1);
                opaque += u64::from(mask.is_opaque(column, row));
            }
        }
        assert_eq!(mask.opaque_texels(), opaque);
        assert_eq!(mask.is_opaque_at(-12, 1), mask.is_opaque(1, 1));
        assert_eq!(mask.is_opaque_at(7, 99), mask.is_opaque(7, 10));
    }
}
