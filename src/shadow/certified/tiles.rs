//! Cells in tiles of 8 x 8, stored only where somebody asks.
//!
//! The sixteen cells of a block of 4 x 4 follow each other, so that what a block holds of one kind is one cache line
//! of four-byte numbers.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Cells along the edge of a tile.
pub(super) const EDGE: u32 = 8;
/// Cells of a tile.
pub(super) const AREA: u32 = EDGE * EDGE;
/// Cells along the edge of a block.
pub(super) const BLOCK_EDGE: u32 = 4;
/// Cells of a block.
pub(super) const BLOCK: usize = 16;

/// The tiles that six sides are cut into.
#[derive(Debug, Clone, Copy)]
pub(super) struct TileGrid {
    per_edge: u32,
}

impl TileGrid {
    /// Tiles for a resolution.
    pub fn new(resolution: u32) -> TileGrid {
        TileGrid { per_edge: resolution.div_ceil(EDGE) }
    }

    /// All of them.
    pub fn count(&self) -> usize {
        6 * (self.per_edge * self.per_edge) as usize
    }

    /// The tile of a cell of a side.
    #[inline(always)]
    pub fn tile(&self, side: u32, x: u32, y: u32) -> u32 {
        (side * self.per_edge + y / EDGE) * self.per_edge + x / EDGE
    }

    /// The place of a cell in its tile: by blocks, and by rows in these.
    #[inline(always)]
    pub fn place(x: u32, y: u32) -> u32 {
        (y & 4) << 3 | (x & 4) << 2 | (y & 3) << 2 | (x & 3)
    }
}

/// Which tiles are asked for.
pub(super) struct Marks(Vec<AtomicBool>);

impl Marks {
    /// None yet.
    pub fn new(grid: &TileGrid) -> Marks {
        Marks((0..grid.count()).map(|_| AtomicBool::new(false)).collect())
    }

    /// Marks one.
    #[inline(always)]
    pub fn mark(&self, tile: u32) {
        let mark = &self.0[tile as usize];
        // Written once: the line stays with all threads that read it.
        if !mark.load(Relaxed) {
            mark.store(true, Relaxed);
        }
    }
}

/// Where the cells of each tile are.
pub(super) struct Tiles {
    pub grid: TileGrid,
    first: Vec<u32>,
    cells: u32,
}

impl Tiles {
    const NONE: u32 = u32::MAX;

    /// Room for marked tiles.
    pub fn new(grid: TileGrid, marks: &Marks) -> Tiles {
        let mut cells = 0;
        let room = |mark: &AtomicBool| match mark.load(Relaxed) {
            true => {
                cells += AREA;
                cells - AREA
            }
            false => Tiles::NONE,
        };
        let first = marks.0.iter().map(room).collect();
        Tiles { grid, first, cells }
    }

    /// Cells that are stored.
    pub fn cells(&self) -> usize {
        self.cells as usize
    }

    /// The first cell of a tile, if it is stored.
    #[inline(always)]
    pub fn first_of(&self, tile: u32) -> Option<u32> {
        let first = self.first[tile as usize];
        (first != Tiles::NONE).then_some(first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_cell_has_a_place_of_its_own_and_blocks_are_rows_of_sixteen() {
        let places: BTreeSet<_> =
            (0..EDGE).flat_map(|y| (0..EDGE).map(move |x| TileGrid::place(x, y))).collect();
        assert_eq!(places, (0..AREA).collect());
        assert_eq!(TileGrid::place(4, 0), 16);
        assert_eq!(TileGrid::place(3, 3), 15);
    }

    #[test]
    fn only_marked_tiles_have_cells() {
        let grid = TileGrid::new(20);
        let marks = Marks::new(&grid);
        marks.mark(grid.tile(5, 19, 19));
        marks.mark(grid.tile(0, 8, 0));
        let tiles = Tiles::new(grid, &marks);
        assert_eq!(tiles.cells(), 128);
        assert_eq!(tiles.first_of(grid.tile(0, 8, 0)), Some(0));
        assert_eq!(tiles.first_of(grid.tile(5, 16, 16)), Some(64));
        assert_eq!(tiles.first_of(grid.tile(0, 0, 0)), None);
        assert_eq!(grid.count(), 54);
    }
}
