//! The tiles that are looked at: a rectangle of them on each side, so that tables of tiles are as small as the part of the directions
//! in which anybody asks. Around a light far away that is a thousandth of all.

use super::tiles::{EDGE, TileGrid};
use std::ops::Range;

/// Sides, and more that have nothing, so that [`Projected::NOWHERE`](super::projection::Projected::NOWHERE) is one.
const SIDES: usize = 8;

/// A rectangle of tiles on each side, whose tiles are numbered row by row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Windows {
    /// The first column and row of tiles.
    columns: [u32; SIDES],
    rows: [u32; SIDES],
    /// How many there are.
    width: [u32; SIDES],
    height: [u32; SIDES],
    /// The number of the first tile.
    first: [u32; SIDES],
    count: u32,
}

impl Windows {
    /// All tiles, by their numbers in the grid.
    pub fn whole(grid: &TileGrid) -> Windows {
        let per_edge = grid.per_edge();
        Windows::new(|_| [0..per_edge, 0..per_edge])
    }

    /// Around some tiles of a grid.
    pub fn around(grid: &TileGrid, tiles: &[u32]) -> Windows {
        let mut ranges: [[Range<u32>; 2]; 6] = Default::default();
        for &tile in tiles {
            let (side, corner) = grid.corner(tile);
            for (range, cell) in ranges[side as usize].iter_mut().zip(corner) {
                let at = cell / EDGE;
                let is_first = range.start == range.end;
                *range = if is_first { at..at + 1 } else { range.start.min(at)..range.end.max(at + 1) };
            }
        }
        Windows::new(|side| ranges[side].clone())
    }

    fn new(of_side: impl Fn(usize) -> [Range<u32>; 2]) -> Windows {
        let mut windows = Windows::default();
        for side in 0..6 {
            let [columns, rows] = of_side(side);
            windows.first[side] = windows.count;
            windows.count += columns.len() as u32 * rows.len() as u32;
            (windows.columns[side], windows.width[side]) = (columns.start, columns.len() as u32);
            (windows.rows[side], windows.height[side]) = (rows.start, rows.len() as u32);
        }
        windows
    }

    /// How many tiles there are.
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// The number of a tile, of which column and row among the tiles of its side are given, or [`Windows::OUTSIDE`].
    #[inline(always)]
    pub fn tile(&self, side: u32, column: u32, row: u32) -> u32 {
        let side = (side as usize) & (SIDES - 1);
        let (x, y) = (column.wrapping_sub(self.columns[side]), row.wrapping_sub(self.rows[side]));
        let tile = self.first[side].wrapping_add(y.wrapping_mul(self.width[side])).wrapping_add(x);
        if (x < self.width[side]) & (y < self.height[side]) { tile } else { Windows::OUTSIDE }
    }

    /// In place of a number, for tiles that are not there.
    pub const OUTSIDE: u32 = u32::MAX;

    /// What is there of some columns and rows of a side, both ends included: for each row its number, the columns, and the number of the first tile.
    #[inline(always)]
    pub fn rows(
        &self,
        side: u32,
        columns: [u32; 2],
        rows: [u32; 2],
    ) -> impl Iterator<Item = (u32, Range<u32>, u32)> {
        let side = (side as usize) & (SIDES - 1);
        let within = |[low, high]: [u32; 2], start: u32, count: u32| {
            let first = low.max(start);
            first..high.wrapping_add(1).min(start + count).max(first)
        };
        let (left, top, width) = (self.columns[side], self.rows[side], self.width[side]);
        let columns = within(columns, left, width);
        let first = self.first[side] + (columns.start - left);
        within(rows, top, self.height[side])
            .map(move |row| (row, columns.clone(), first + (row - top) * width))
    }

    /// The side of a tile, and column and row of its first cell.
    pub fn corner(&self, tile: u32) -> (u32, [u32; 2]) {
        let side = (1..6).rev().find(|&side| self.first[side] <= tile && self.width[side] != 0).unwrap_or(0);
        let (row, column) =
            ((tile - self.first[side]) / self.width[side], (tile - self.first[side]) % self.width[side]);
        (side as u32, [(self.columns[side] + column) * EDGE, (self.rows[side] + row) * EDGE])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_tile_has_a_number_and_rows_find_those_within(
            tiles in prop::collection::vec(0u32..6 * 49, 0..12),
            side in 0u32..6,
            columns in (0u32..7, 0u32..7),
            rows in (0u32..7, 0u32..7),
        ) {
            let grid = TileGrid::new(50);
            let windows = Windows::around(&grid, &tiles);
            for &tile in &tiles {
                let (side, corner) = grid.corner(tile);
                let number = windows.tile(side, corner[0] / EDGE, corner[1] / EDGE);
                prop_assert!((number as usize) < windows.count());
            }
            let mut numbered = 0;
            for tile in 0..6 * 49 {
                let (side, corner) = grid.corner(tile);
                let number = windows.tile(side, corner[0] / EDGE, corner[1] / EDGE);
                if number != Windows::OUTSIDE {
                    prop_assert_eq!((number, windows.corner(number)), (numbered, (side, corner)));
                    numbered += 1;
                }
            }
            prop_assert_eq!(numbered as usize, windows.count());
            let ends = |(a, b): (u32, u32)| [a.min(b), a.max(b)];
            let (columns, rows) = (ends(columns), ends(rows));
            let found: Vec<_> = windows
                .rows(side, columns, rows)
                .flat_map(|(row, columns, first)| (first..).zip(columns).map(move |(tile, column)| (tile, column, row)))
                .collect();
            let mut expected = Vec::new();
            for row in rows[0]..=rows[1] {
                for column in columns[0]..=columns[1] {
                    let tile = windows.tile(side, column, row);
                    if tile != Windows::OUTSIDE {
                        expected.push((tile, column, row));
                    }
                }
            }
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn all_tiles_have_their_numbers_in_the_grid() {
        let grid = TileGrid::new(50);
        let windows = Windows::whole(&grid);
        assert_eq!(windows.count(), grid.count());
        for tile in 0..grid.count() as u32 {
            let (side, [x, y]) = grid.corner(tile);
            assert_eq!(
                (windows.tile(side, x / EDGE, y / EDGE), windows.corner(tile)),
                (tile, (side, [x, y]))
            );
        }
    }

    #[test]
    fn there_is_nothing_beside_the_six_sides() {
        let windows = Windows::whole(&TileGrid::new(8));
        assert_eq!(windows.tile(super::super::projection::Projected::NOWHERE, 0, 0), Windows::OUTSIDE);
    }
}
