//! The entries of a cell, side by side.

use super::cell_lists::{CellLists, Item};
use super::second_look::TileTriangles;
use super::stored::Record;
use super::verdict::{Listed, Verdict};
use std::cmp::Reverse;

/// The entries of a cell side by side, at least [`FEW`]: what is not there has negative depths. Depths are the bits of
/// numbers that are not negative, which have their order; unlike numbers they have a largest that takes no branches.
#[derive(Debug, Default)]
pub(super) struct Entries {
    pub near: Vec<i32>,
    pub far: Vec<i32>,
    pub items: Vec<Item>,
    /// What is known of the points of each; open where nobody judges.
    pub verdicts: Vec<Verdict>,
    sorted: Vec<(i32, i32, Item)>,
}

/// As many entries as most cells have at most: loops over so many have no branches.
pub(super) const FEW: usize = 16;

/// A cell of a tile, in which nothing is withheld with a w above the horizon.
pub(super) struct Cell<'a> {
    pub tile: &'a TileTriangles<'a>,
    pub lists: &'a CellLists,
    /// Its place in the tile.
    pub place: usize,
    /// Its column and row.
    pub at: [u32; 2],
    pub horizon: f32,
}

impl Cell<'_> {
    /// The record of an entry.
    #[inline(always)]
    pub fn record(&self, item: Item, near: f32, verdict: Verdict) -> Record {
        let number = self.tile.numbers[item.triangle() as usize];
        Record { near, listed: Listed::new(number, item.flags(), verdict) }
    }
}

impl Entries {
    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.near.capacity() * (2 * size_of::<f32>() + size_of::<Item>() + size_of::<Verdict>())
    }

    /// Appends a record of each of the first `count` that is no farther than `end`, and returns how many that are.
    #[inline(always)]
    pub fn append(&self, cell: &Cell<'_>, count: usize, end: i32, records: &mut Vec<Record>) -> usize {
        let before = records.len();
        let all = self.near[..count].iter().zip(&self.items).zip(&self.verdicts);
        let in_reach = all.filter(|((near, _), _)| **near >= end);
        records.extend(in_reach.map(|((&near, &item), &verdict)| cell.record(item, depth(near), verdict)));
        records.len() - before
    }

    /// Takes in what a cell holds, and returns how much that is.
    #[inline(always)]
    pub fn gather(&mut self, cell: &Cell<'_>) -> usize {
        let Entries { near, far, items, verdicts, .. } = self;
        if near.is_empty() {
            (*near, *far, *items) = (vec![-1; FEW], vec![-1; FEW], vec![Item::default(); FEW]);
            *verdicts = vec![Verdict::Open; FEW];
        }
        // Over from the last cell.
        near[..FEW].fill(-1);
        far[..FEW].fill(-1);
        let mut count = 0;
        for entry in cell.lists.of(cell.place) {
            debug_assert!(entry.near >= entry.far, "an interval");
            if count == near.len() {
                near.extend([-1; FEW]);
                far.extend([-1; FEW]);
                items.extend([Item::default(); FEW]);
                verdicts.extend([Verdict::Open; FEW]);
            }
            (near[count], far[count], items[count]) = (bits(entry.near), bits(entry.far), entry.item);
            count += 1;
        }
        verdicts[..count].fill(Verdict::Open);
        count
    }

    /// Puts so many in the order of their nearest depth.
    pub fn sort(&mut self, count: usize) {
        let Entries { near, far, items, sorted, .. } = self;
        sorted.clear();
        sorted.extend((0..count).map(|entry| (near[entry], far[entry], items[entry])));
        sorted.sort_unstable_by_key(|(near, ..)| Reverse(*near));
        for (entry, &(nearest, farthest, item)) in sorted.iter().enumerate() {
            (near[entry], far[entry], items[entry]) = (nearest, farthest, item);
        }
    }
}

/// A depth as bits, which must not be negative. Both zeros are one.
#[inline(always)]
pub(super) fn bits(depth: f32) -> i32 {
    (depth + 0.0).to_bits() as i32
}

#[inline(always)]
pub(super) fn depth(bits: i32) -> f32 {
    f32::from_bits(bits as u32)
}
