//! Some of up to [`CHUNK`] points.

use crate::visibility::{Points, RoundedPoint, SurfacePoint};

/// Points of a task.
pub(super) const CHUNK: usize = 4096;

/// Points that are asked about, side by side in the form that most need, and where they are among all.
#[derive(Clone, Copy)]
pub(super) struct Selected<'a> {
    rounded: &'a [RoundedPoint],
    numbers: &'a [u32],
    all: &'a [SurfacePoint],
}

/// The numbers of all.
static ALL: [u32; CHUNK] = {
    let mut numbers = [0; CHUNK];
    let mut i = 0;
    while i < CHUNK {
        numbers[i] = i as u32;
        i += 1;
    }
    numbers
};

impl<'a> Selected<'a> {
    /// Those with these numbers among all, which are rounded here.
    pub fn new(rounded: &'a [RoundedPoint], numbers: &'a [u32], all: &'a [SurfacePoint]) -> Selected<'a> {
        debug_assert_eq!(rounded.len(), numbers.len(), "the same points");
        Selected { rounded, numbers, all }
    }

    /// All of them, up to [`CHUNK`].
    pub fn all(points: Points<'a>) -> Selected<'a> {
        Selected { rounded: points.rounded(), numbers: &ALL[..points.len()], all: points.exact() }
    }

    /// How many there are.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.rounded.len()
    }

    /// Rounded to f32.
    #[inline(always)]
    pub fn rounded(&self) -> &'a [RoundedPoint] {
        self.rounded
    }

    /// Where each is among all.
    #[inline(always)]
    pub fn numbers(&self) -> &'a [u32] {
        self.numbers
    }

    /// One of them, with what makes it exact.
    #[inline(always)]
    pub fn exact(&self, i: usize) -> &'a SurfacePoint {
        &self.all[self.numbers[i] as usize]
    }
}
