//! What each cell holds while triangles are cast: a linked list for each cell, in one array for each worker.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// A triangle in a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    /// The triangle and what it is in this cell.
    pub item: Item,
    /// Where the next entry of the cell is; 0 ends the list.
    next: u32,
    /// At least the largest w that the triangle has in the cell.
    pub near: f32,
    /// At most the smallest.
    pub far: f32,
}

/// A triangle by its number in the scene, and four flags.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Item(u32);

impl Item {
    /// It certainly covers the centre of the cell, edges excluded.
    pub const COVERS: u32 = 1;
    /// It may cover the centre of the cell.
    pub const MAY_COVER: u32 = 2;
    /// An edge of it that is not regular may meet the cell.
    pub const IRREGULAR: u32 = 4;
    /// It does not lie on one side as a whole, so that it is tested in space.
    pub const LARGE: u32 = 8;
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

    #[inline(always)]
    pub fn has(self, flags: u32) -> bool {
        self.0 & flags != 0
    }
}

/// How many entries all workers may make together; 16 bytes each.
pub(super) struct Budget {
    left: AtomicUsize,
}

impl Budget {
    pub fn new(entries: usize) -> Budget {
        Budget { left: AtomicUsize::new(entries) }
    }

    fn take(&self, entries: usize) -> bool {
        self.left.fetch_update(Relaxed, Relaxed, |left| left.checked_sub(entries)).is_ok()
    }
}

/// The entries of one worker.
pub(super) struct Bins<'b> {
    heads: Vec<u32>,
    entries: Vec<Entry>,
    budget: &'b Budget,
    /// How many entries there may be before more are asked for.
    granted: usize,
    /// Whether more were asked for in vain: what follows is missing.
    pub overflowed: bool,
}

impl<'b> Bins<'b> {
    const PORTION: usize = 1 << 16;

    /// Empty lists.
    pub fn new(cells: usize, budget: &'b Budget) -> Bins<'b> {
        let ends = Entry { item: Item(0), next: 0, near: 0.0, far: 0.0 };
        Bins { heads: vec![0; cells], entries: vec![ends], budget, granted: 1, overflowed: false }
    }

    /// Enters a triangle in a cell.
    #[inline(always)]
    pub fn push(&mut self, cell: usize, item: Item, near: f32, far: f32) {
        if self.entries.len() == self.granted {
            if self.overflowed || !self.budget.take(Bins::PORTION) {
                self.overflowed = true;
                return;
            }
            self.granted += Bins::PORTION;
        }
        let place = self.entries.len() as u32;
        let next = std::mem::replace(&mut self.heads[cell], place);
        self.entries.push(Entry { item, next, near, far });
    }

    /// Adds what a cell holds to `found`.
    #[inline(always)]
    pub fn gather(&self, cell: usize, found: &mut Vec<Entry>) {
        let mut place = self.heads[cell];
        while place != 0 {
            let entry = self.entries[place as usize];
            found.push(entry);
            place = entry.next;
        }
    }

    /// Entries in all lists.
    pub fn count(&self) -> usize {
        self.entries.len() - 1
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.entries.capacity() * size_of::<Entry>() + size_of_val(&self.heads[..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_by_cell() {
        let budget = Budget::new(1 << 20);
        let mut bins = Bins::new(2, &budget);
        for i in 0..5 {
            bins.push(i as usize % 2, Item::new(i, Item::COVERS), 2.0, 1.0);
        }
        let mut found = Vec::new();
        bins.gather(0, &mut found);
        let triangles: Vec<_> = found.iter().map(|entry| entry.item.triangle()).collect();
        assert_eq!(triangles, [4, 2, 0]);
        assert!(found.iter().all(|e| e.item.has(Item::COVERS) && !e.item.has(Item::LARGE)));
        assert_eq!(bins.count(), 5);
    }

    #[test]
    fn nothing_is_entered_beyond_the_budget_and_it_says_so() {
        let budget = Budget::new(Bins::PORTION);
        let mut bins = Bins::new(1, &budget);
        for _ in 0..Bins::PORTION {
            bins.push(0, Item::new(7, 0), 2.0, 1.0);
        }
        assert!(!bins.overflowed);
        bins.push(0, Item::new(7, 0), 2.0, 1.0);
        assert!(bins.overflowed);
        assert_eq!(bins.count(), Bins::PORTION);
    }
}
