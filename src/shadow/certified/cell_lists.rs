//! What the cells of one tile hold: a linked list for each.

use super::block::Sixteen;
use super::tiles::AREA;
use crate::geometry::masks::Bits;

/// A triangle in a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    /// The triangle, by its number in the tile, and what it is in this cell.
    pub item: Item,
    /// Where the next entry of the cell is; 0 ends the list.
    next: u32,
    /// At least the largest w that the triangle has in the cell.
    pub near: f32,
    /// At most the smallest.
    pub far: f32,
}

/// A triangle by its number in the tile or the scene, and four flags.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Item(pub(super) u32);

impl Item {
    /// It certainly covers the centre of the cell, edges excluded.
    pub const COVERS: u32 = 1;
    /// It may cover the centre of the cell.
    pub const MAY_COVER: u32 = 2;
    /// An edge of it that is not regular may meet the cell.
    pub const IRREGULAR: u32 = 4;
    /// It does not lie on one side as a whole, so that it is tested in space.
    pub const IN_SPACE: u32 = 8;
    /// What leaves open how often its surface covers the cell.
    pub const DOUBTS: u32 = Item::MAY_COVER | Item::IRREGULAR;
    const FLAGS: u32 = 4;

    /// Triangles whose numbers an item can hold.
    pub const MOST: usize = 1 << (32 - Item::FLAGS);

    #[inline(always)]
    pub fn new(triangle: u32, flags: u32) -> Item {
        Item(triangle << Item::FLAGS | flags)
    }

    #[inline(always)]
    pub fn triangle(self) -> u32 {
        self.0 >> Item::FLAGS
    }

    /// All flags.
    #[inline(always)]
    pub fn flags(self) -> u32 {
        self.0 & ((1 << Item::FLAGS) - 1)
    }

    #[inline(always)]
    pub fn has(self, flags: u32) -> bool {
        self.0 & flags != 0
    }
}

const CELLS: usize = AREA as usize;

/// Lists of the cells of a tile.
#[derive(Debug)]
pub(super) struct CellLists {
    heads: [u32; CELLS],
    entries: Vec<Entry>,
}

impl CellLists {
    pub fn new() -> CellLists {
        let ends = Entry { item: Item(0), next: 0, near: 0.0, far: 0.0 };
        CellLists { heads: [0; CELLS], entries: vec![ends] }
    }

    /// Empties all lists.
    pub fn clear(&mut self) {
        self.heads = [0; CELLS];
        self.entries.truncate(1);
    }

    /// Enters a triangle in a cell, which has it from the w `near` to the w `far`.
    #[inline(always)]
    pub fn enter(&mut self, cell: usize, item: Item, near: f32, far: f32) {
        let place = self.entries.len() as u32;
        let next = std::mem::replace(&mut self.heads[cell], place);
        self.entries.push(Entry { item, next, near, far });
    }

    /// Enters a triangle in the cells of a block that have a bit in `live`; `first` is the first of them.
    #[inline(always)]
    pub fn enter_block(
        &mut self,
        first: usize,
        triangle: u32,
        more_flags: u32,
        sixteen: &Sixteen,
        live: u32,
    ) {
        for i in Bits(live) {
            let item = Item::new(triangle, sixteen.flags[i] | more_flags);
            self.enter(first + i, item, sixteen.near[i], sixteen.far[i]);
        }
    }

    /// Whether a cell holds nothing.
    #[inline(always)]
    pub fn is_empty(&self, cell: usize) -> bool {
        self.heads[cell] == 0
    }

    /// What a cell holds if that is one entry.
    #[inline(always)]
    pub fn only(&self, cell: usize) -> Option<Entry> {
        let entry = self.entries[self.heads[cell] as usize];
        (self.heads[cell] != 0 && entry.next == 0).then_some(entry)
    }

    /// What a cell holds, the last that was entered first.
    #[inline(always)]
    pub fn of(&self, cell: usize) -> impl Iterator<Item = Entry> {
        let mut place = self.heads[cell];
        std::iter::from_fn(move || {
            let entry = self.entries[place as usize];
            let found = (place != 0).then_some(entry);
            place = entry.next;
            found
        })
    }

    /// Entries in all lists.
    pub fn count(&self) -> usize {
        self.entries.len() - 1
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.entries.capacity() * size_of::<Entry>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tiles::BLOCK;
    use super::*;

    #[test]
    fn lists_are_by_cell() {
        let mut lists = CellLists::new();
        let sixteen = Sixteen { flags: [Item::COVERS; BLOCK], near: [4.0; BLOCK], far: [2.0; BLOCK] };
        lists.enter_block(16, 7, 0, &sixteen, 0b101);
        lists.enter(18, Item::new(8, Item::IN_SPACE), 3.0, 1.0);
        let triangles =
            |lists: &CellLists, cell| lists.of(cell).map(|entry| entry.item.triangle()).collect::<Vec<_>>();
        assert_eq!([16, 17, 18].map(|cell| triangles(&lists, cell)), [vec![7], vec![], vec![8, 7]]);
        let nearest = lists.of(18).next().expect("two entries");
        assert!(nearest.item.has(Item::IN_SPACE) && !nearest.item.has(Item::COVERS));
        assert_eq!((nearest.near, nearest.far, lists.count()), (3.0, 1.0, 3));
        lists.clear();
        assert_eq!((triangles(&lists, 18), lists.count()), (vec![], 0));
    }
}
