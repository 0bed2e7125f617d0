//! A triangle against the sixteen cells of a block at once.

use super::cell_lists::Item;
use super::tiles::{AREA, BLOCK};
use crate::geometry::batch::InstructionSet;
use crate::geometry::masks::bits;

/// What an edge says of the centre of a cell: a x + b y + at, positive inside, x and y counted from a first cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub a: f32,
    pub b: f32,
    pub at: f32,
    /// Below minus this nothing of the cell is inside: what the value can change within half a cell, and the slack.
    pub within: f32,
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

/// A tile: its first column and row, and the keys of its cells.
pub(super) struct Seen<'a> {
    pub corner: [u32; 2],
    pub keys: &'a [u32; AREA as usize],
}

impl Seen<'_> {
    /// The keys of a block, by the place of its first cell.
    #[inline(always)]
    pub fn block(&self, place: usize) -> &[u32; BLOCK] {
        self.keys[place..place + BLOCK].try_into().expect("a block")
    }
}

/// What a triangle is in each cell of a block.
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Sixteen {
    pub flags: [u32; BLOCK],
    pub near: [f32; BLOCK],
    pub far: [f32; BLOCK],
}

impl Sixteen {
    /// The cells that the triangle may meet and that somebody looks into beyond `key`, a bit each.
    #[inline(always)]
    pub fn fill(
        &mut self,
        set: InstructionSet,
        patch: &Patch,
        [bx, by]: [u32; 2],
        keys: &[u32; BLOCK],
        key: u32,
    ) -> u32 {
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
            let w = (patch.w + patch.dw[0] * x) + patch.dw[1] * y;
            let mut cover = Cover::WHOLE;
            for edge in &patch.edges {
                cover.edge((edge.at + edge.a * x) + edge.b * y, edge.within, edge.slack, edge.meets);
            }
            let [near, far] = depths(w, patch.spread, patch.w_limits);
            (self.near[i], self.far[i], self.flags[i]) = (near, far, cover.flags());
            // An interval without a number: the triangle is not there.
            live[i] = u32::from(is_asked & !cover.is_out & (near >= far));
        }
        bits(set, &live)
    }
}

/// What the edges of a triangle say of a cell, one after the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cover {
    pub is_out: bool,
    misses: bool,
    covers: bool,
    irregular: bool,
}

impl Cover {
    /// Before any edge was asked.
    pub const WHOLE: Cover = Cover { is_out: false, misses: false, covers: true, irregular: false };

    /// The value of an edge at the centre; the others as in [`Edge`]. A value that is not a number, or too large for
    /// one, is no reason for anything.
    #[inline(always)]
    pub fn edge(&mut self, value: f32, within: f32, slack: f32, meets: f32) {
        self.is_out |= value < -within;
        self.misses |= value < -slack;
        self.covers &= value > slack;
        self.irregular |= value.abs() <= meets;
    }

    /// The flags of the triangle in this cell.
    #[inline(always)]
    pub fn flags(self) -> u32 {
        let cover = if self.covers { Item::COVERS } else { 0 };
        let may_cover = if self.covers | self.misses { 0 } else { Item::MAY_COVER };
        cover | may_cover | if self.irregular { Item::IRREGULAR } else { 0 }
    }
}

/// Nearest and farthest depth in a cell with w at its centre. Limits of the whole triangle stand for what is not a number.
#[inline(always)]
pub(super) fn depths(w: f32, spread: f32, [least, most]: [f32; 2]) -> [f32; 2] {
    let (near, far) = (w + spread, w - spread);
    let near = if (near < most) & (near > f32::NEG_INFINITY) { near } else { most };
    let far = if (far > least) & (far < f32::INFINITY) { far } else { least };
    [near, far]
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
