//! Cells in tiles of 8 x 8, stored only where somebody asks.
//!
//! The sixteen cells of a block of 4 x 4 follow each other, so that what a block holds of one kind is one cache line
//! of four-byte numbers.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

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

    /// The side of a tile, and column and row of its first cell.
    pub fn corner(&self, tile: u32) -> (u32, [u32; 2]) {
        let (row, column) = (tile / self.per_edge, tile % self.per_edge);
        (row / self.per_edge, [column * EDGE, row % self.per_edge * EDGE])
    }

    /// Tiles along an edge of a side.
    pub fn per_edge(&self) -> u32 {
        self.per_edge
    }

    /// The place of a cell in its tile: by blocks, and by rows in these.
    #[inline(always)]
    pub fn place(x: u32, y: u32) -> u32 {
        (y & 4) << 3 | (x & 4) << 2 | (y & 3) << 2 | (x & 3)
    }

    /// Column and row of a place in its tile.
    #[inline(always)]
    pub fn cell(place: u32) -> [u32; 2] {
        [place & 3 | place >> 2 & 4, place >> 2 & 3 | place >> 3 & 4]
    }
}

/// Where the cells of each tile are: tiles get their place when somebody first asks for it.
pub(super) struct Tiles {
    /// One more than the number of each tile that is stored, 0 for others. Pages that nobody writes to cost nothing.
    numbers: Vec<AtomicU32>,
    /// In the order of their cells.
    stored: Mutex<Vec<u32>>,
}

impl Tiles {
    /// None is stored yet.
    pub fn new(grid: TileGrid) -> Tiles {
        Tiles { numbers: bytemuck::zeroed_vec(grid.count()), stored: Mutex::default() }
    }

    /// The first cell of a tile, which is stored from now on.
    #[inline(always)]
    pub fn claim(&self, tile: u32) -> u32 {
        match self.numbers[tile as usize].load(Relaxed) {
            0 => self.claim_new(tile),
            number => (number - 1) * AREA,
        }
    }

    #[cold]
    fn claim_new(&self, tile: u32) -> u32 {
        let mut stored = self.stored.lock().expect("no panic while it is held");
        let number = &self.numbers[tile as usize];
        if number.load(Relaxed) == 0 {
            stored.push(tile);
            number.store(stored.len() as u32, Relaxed);
        }
        (number.load(Relaxed) - 1) * AREA
    }

    /// The tiles that are stored, in the order of their cells.
    pub fn stored(self) -> Vec<u32> {
        self.stored.into_inner().expect("no panic while it was held")
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
        for place in 0..AREA {
            let [x, y] = TileGrid::cell(place);
            assert_eq!(TileGrid::place(x, y), place);
        }
    }

    #[test]
    fn only_tiles_that_were_asked_for_have_cells() {
        let grid = TileGrid::new(20);
        let tiles = Tiles::new(grid);
        let (one, other) = (grid.tile(5, 19, 19), grid.tile(0, 8, 0));
        assert_eq!([tiles.claim(one), tiles.claim(other), tiles.claim(one)], [0, 64, 0]);
        assert_eq!(tiles.stored(), [one, other]);
        assert_eq!(grid.count(), 54);
    }

    #[test]
    fn the_corner_of_a_tile_is_found_again() {
        let grid = TileGrid::new(20);
        assert_eq!(grid.corner(grid.tile(5, 19, 9)), (5, [16, 8]));
        assert_eq!(grid.corner(grid.tile(0, 0, 0)), (0, [0, 0]));
    }
}
