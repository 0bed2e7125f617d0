//! A triangle against the sixteen cells of a block at once.

use super::entries::Item;
use super::tiles::{BLOCK, BLOCK_EDGE};

/// What an edge says of the centre of a cell: a x + b y + at, positive inside, x and y counted from a first cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub a: f32,
    pub b: f32,
    pub at: f32,
    /// Below this nothing of the cell is inside: minus what the value can change within a cell, and the slack.
    pub out: f32,
    /// The most that the value is wrong by.
    pub slack: f32,
    /// The edge may meet a cell whose value is no larger than this; below zero for an edge that is regular.
    pub meets: f32,
}

/// Columns and rows of cells, first and last.
#[derive(Debug, Clone, Copy)]
pub(super) struct CellBox {
    pub x: [u32; 2],
    pub y: [u32; 2],
}

impl CellBox {
    /// The first cells of the blocks of some columns or rows.
    #[inline(always)]
    pub fn blocks([first, last]: [u32; 2]) -> impl Iterator<Item = u32> {
        (first & !(BLOCK_EDGE - 1)..=last).step_by(BLOCK_EDGE as usize)
    }
}

/// A triangle as the cells of some blocks see it, relative to the centre of the cell `origin`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    pub edges: [Edge; 3],
    pub origin: [u32; 2],
    /// Cells outside of it are left alone.
    pub cells: CellBox,
    /// w of its plane at the origin, and from one cell to the next.
    pub w: f32,
    pub dw: [f32; 2],
    /// The most that w in a cell differs from what is computed for its centre.
    pub spread: f32,
    /// Limits of w over the whole triangle.
    pub w_limits: [f32; 2],
}

/// What a triangle is in each cell of a block.
#[derive(Debug, Default)]
pub(super) struct Sixteen {
    pub flags: [u32; BLOCK],
    pub near: [f32; BLOCK],
    pub far: [f32; BLOCK],
}

impl Sixteen {
    /// The cells that the triangle may meet and that somebody looks into beyond `key`, a bit each.
    #[inline(always)]
    pub fn fill(&mut self, patch: &Patch, [bx, by]: [u32; 2], keys: &[u32; BLOCK], key: u32) -> u32 {
        let mut live = [0u32; BLOCK];
        let [x_first, x_last] = patch.cells.x;
        let [y_first, y_last] = patch.cells.y;
        for i in 0..BLOCK {
            let (column, row) = (bx + (i as u32 & 3), by + (i as u32 >> 2));
            let is_asked = (column >= x_first)
                & (column <= x_last)
                & (row >= y_first)
                & (row <= y_last)
                & (keys[i] > key);
            let x = (column as i32 - patch.origin[0] as i32) as f32;
            let y = (row as i32 - patch.origin[1] as i32) as f32;
            let (mut out, mut misses, mut covers, mut irregular) = (false, false, true, false);
            for edge in &patch.edges {
                let value = (edge.at + edge.a * x) + edge.b * y;
                out |= value < edge.out;
                misses |= value < -edge.slack;
                covers &= value > edge.slack;
                irregular |= value.abs() <= edge.meets;
            }
            // A value that is not a number, or too large for one, is no reason for anything.
            let w = (patch.w + patch.dw[0] * x) + patch.dw[1] * y;
            let (near, far) = (w + patch.spread, w - patch.spread);
            let [least, most] = patch.w_limits;
            self.near[i] = if (near < most) & (near > f32::NEG_INFINITY) { near } else { most };
            self.far[i] = if (far > least) & (far < f32::INFINITY) { far } else { least };
            let cover = match (covers, misses) {
                (true, _) => Item::COVERS,
                (false, true) => 0,
                (false, false) => Item::MAY_COVER,
            };
            self.flags[i] = cover | if irregular { Item::IRREGULAR } else { 0 };
            // An interval without a number: the triangle is not there.
            live[i] = u32::from(is_asked & !out & (self.near[i] >= self.far[i]));
        }
        bits(&live)
    }
}

/// Zeros and ones as bits.
#[inline(always)]
pub(super) fn bits(lanes: &[u32; BLOCK]) -> u32 {
    let mut bits = 0;
    for (i, lane) in lanes.iter().enumerate() {
        bits |= lane << i;
    }
    bits
}

/// Whether one of the keys is above another.
#[inline(always)]
pub(super) fn any_above(keys: &[u32; BLOCK], key: u32) -> bool {
    let mut any = false;
    for other in keys {
        any |= *other > key;
    }
    any
}

/// Calls for the place of each bit that is set.
#[inline(always)]
pub(super) fn each_bit(mut bits: u32, mut call: impl FnMut(usize)) {
    while bits != 0 {
        call(bits.trailing_zeros() as usize);
        bits &= bits - 1;
    }
}
