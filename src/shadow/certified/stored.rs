//! What is stored of a cell: two depths, and where its list is among the records of others.

use super::verdict::Listed;
use crate::geometry::batch::LANES;

/// Two depths that decide most queries of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(super) struct Header {
    /// A receiver whose w is above this is lit, if it lies on a triangle that is cast.
    pub lit: f32,
    /// Whatever has a w below this is dark.
    pub dark: f32,
}

impl Header {
    /// Of a cell in which nothing is in front of a receiver.
    pub const EMPTY: Header = Header { lit: 0.0, dark: 0.0 };
}

/// A record of a cell's list.
#[derive(Debug, Clone, Copy)]
pub(super) struct Record {
    /// At least the largest w of the triangle in the cell.
    pub near: f32,
    pub listed: Listed,
}

/// Where a list is among others. It is in the order of depth, the nearest first, only if it is longer than [`UNSORTED`].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Run {
    pub start: u32,
    pub length: u32,
}

/// Lists of so many are looked through at once, in any order.
pub(super) const UNSORTED: usize = LANES;
