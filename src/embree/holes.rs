//! Triangles with holes: what the filter of a scene looks at.

use super::ffi;
use crate::{Error, Result};

/// An image of bits that says where triangles are there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HoleMask {
    /// Texels in a row and rows, both at least 1.
    pub size: [u32; 2],
    /// How it goes on beyond its sides, along u and along v.
    pub wrap: [HoleWrap; 2],
    /// A bit a texel, row by row, the lowest bit of each word first; 1 is there.
    pub there: Vec<u64>,
}

/// How a mask goes on beyond its sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HoleWrap {
    /// Over and over.
    Repeat,
    /// Over and over, every other time mirrored.
    MirroredRepeat,
    /// The texels at its border go on.
    ClampToEdge,
}

/// The masks of a scene's triangles.
#[derive(Debug)]
pub struct Holes {
    /// The mask of each triangle, or [`Holes::NONE`].
    mask_of: Vec<u32>,
    /// `[u, v]` of its three corners; anything for those without a mask.
    coordinates: Vec<[[f32; 2]; 3]>,
    /// What the entries of `views` point at.
    _masks: Vec<HoleMask>,
    views: Vec<ffi::LbMask>,
}

// SAFETY: the pointers of `views` lead to `_masks`, which never changes.
unsafe impl Send for Holes {}
// SAFETY: as above.
unsafe impl Sync for Holes {}

impl Holes {
    /// A triangle without holes.
    pub const NONE: u32 = ffi::LB_NO_MASK;

    /// The mask of every triangle and where its corners lie in it, and the masks.
    ///
    /// # Errors
    ///
    /// A mask that is not there or has too few texels, or coordinates for other triangles.
    pub fn new(mask_of: Vec<u32>, coordinates: Vec<[[f32; 2]; 3]>, masks: Vec<HoleMask>) -> Result<Holes> {
        let wrong = |what: &str| Err(Error::Embree(format!("holes: {what}")));
        if mask_of.len() != coordinates.len() {
            return wrong("texture coordinates for other triangles");
        }
        if !mask_of.iter().all(|&mask| mask == Holes::NONE || (mask as usize) < masks.len()) {
            return wrong("a mask that is not there");
        }
        let has_texels = |mask: &HoleMask| {
            let [width, height] = mask.size.map(u64::from);
            width > 0 && height > 0 && mask.there.len() as u64 >= (width * height).div_ceil(64)
        };
        if !masks.iter().all(has_texels) {
            return wrong("a mask with too few texels");
        }
        let views = masks.iter().map(HoleMask::view).collect();
        Ok(Holes { mask_of, coordinates, _masks: masks, views })
    }

    /// How many triangles it is for.
    pub(super) fn triangles(&self) -> usize {
        self.mask_of.len()
    }

    pub(super) fn as_ffi(&self) -> ffi::LbHoles {
        ffi::LbHoles {
            mask_of: self.mask_of.as_ptr(),
            coordinates: self.coordinates.as_ptr().cast(),
            masks: self.views.as_ptr(),
        }
    }
}

impl HoleMask {
    fn view(&self) -> ffi::LbMask {
        let wrap = self.wrap.map(|wrap| match wrap {
            HoleWrap::Repeat => ffi::LB_WRAP_REPEAT,
            HoleWrap::MirroredRepeat => ffi::LB_WRAP_MIRRORED,
            HoleWrap::ClampToEdge => ffi::LB_WRAP_CLAMP,
        });
        ffi::LbMask { size: self.size, wrap, there: self.there.as_ptr() }
    }
}
