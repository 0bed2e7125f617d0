//! What a cell decides by itself (TRUTH, "Certified cells").

use super::cell_lists::{CellLists, Item};
use super::projection::{larger, smaller};
use std::ops::AddAssign;

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

/// A record of a cell's list, nearest first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Record {
    pub near: f32,
    pub item: Item,
}

/// Where a list is among others.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Run {
    pub start: u32,
    pub length: u32,
}

/// What cells turned out to be.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Kinds {
    /// In which something may be in front of a receiver.
    pub touched: u64,
    /// Whose nearest surface covers them exactly once.
    pub once: u64,
    /// In which some other surface covers all.
    pub covered: u64,
}

impl AddAssign for Kinds {
    fn add_assign(&mut self, other: Kinds) {
        self.touched += other.touched;
        self.once += other.once;
        self.covered += other.covered;
    }
}

/// The entries of a cell side by side.
#[derive(Debug, Default)]
pub(super) struct Entries {
    near: Vec<f32>,
    far: Vec<f32>,
    items: Vec<Item>,
    sorted: Vec<Record>,
}

/// The entries of one surface of a cell together.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Surface {
    /// At most its smallest w.
    far: f32,
    /// Entries that cover the centre.
    covers: u32,
    /// Whether it is certain which do, and no irregular edge of it meets the cell.
    is_certain: bool,
    /// How many entries it has.
    count: usize,
    /// At least the largest w behind it, 0 if nothing is there.
    next: f32,
}

impl Entries {
    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.near.capacity() * (2 * size_of::<f32>() + size_of::<Item>()) + self.sorted.capacity() * size_of::<Record>()
    }

    fn gather(&mut self, lists: &CellLists, cell: usize) {
        let Entries { near, far, items, .. } = self;
        near.clear();
        far.clear();
        items.clear();
        for entry in lists.of(cell) {
            debug_assert!(entry.near >= entry.far, "an interval");
            near.push(entry.near);
            far.push(entry.far);
            items.push(entry.item);
        }
    }

    /// The nearest surface of what is no nearer than `from`.
    #[inline(always)]
    fn surface(&self, from: f32) -> Surface {
        let (near, far, items) = (&self.near[..], &self.far[..self.near.len()], &self.items[..self.near.len()]);
        let mut nearest = 0.0;
        for near in near {
            nearest = larger(if *near <= from { *near } else { 0.0 }, nearest);
        }
        // Of all that overlaps what is known of the surface, until that is all.
        let mut end = nearest;
        loop {
            let mut farther = end;
            for (near, far) in near.iter().zip(far) {
                let overlaps = (*near >= end) & (*near <= from);
                farther = smaller(if overlaps { *far } else { end }, farther);
            }
            if farther == end {
                break;
            }
            end = farther;
        }
        let (mut covers, mut flags, mut count, mut next) = (0, 0, 0, 0.0);
        for (near, item) in near.iter().zip(items) {
            let is_of_it = (*near >= end) & (*near <= from);
            let of_it = if is_of_it { item.flags() } else { 0 };
            covers += of_it & Item::COVERS;
            flags |= of_it;
            count += u32::from(is_of_it);
            next = larger(if *near < end { *near } else { 0.0 }, next);
        }
        let is_certain = flags & (Item::IRREGULAR | Item::MAY_COVER) == 0;
        Surface { far: end, covers, is_certain, count: count as usize, next }
    }
}

/// Makes header and list of a cell. What is withheld from it has at most the w of the horizon.
///
/// Entries whose intervals of w overlap, directly or through others, are one surface. If no irregular edge of it meets
/// the cell, as many of its triangles cover each direction as cover the centre: at a regular edge one takes over
/// from another, and both are here, since they share a depth of the edge, which is before the horizon. So with one or
/// more all that is farther than the surface is dark. If it is the nearest surface and there is exactly one, it
/// is a graph with nothing before it, and receivers on it are lit; and those on any triangle that is cast, nearer than what follows it, are on it.
/// All is formed before anything is pruned.
#[inline(always)]
pub(super) fn certify(
    lists: &CellLists,
    cell: usize,
    horizon: f32,
    entries: &mut Entries,
    records: &mut Vec<Record>,
    kinds: &mut Kinds,
) -> (Header, Run) {
    if lists.is_empty(cell) {
        return (Header::EMPTY, Run::default());
    }
    kinds.touched += 1;
    entries.gather(lists, cell);
    let first = entries.surface(f32::INFINITY);
    let start = records.len() as u32;
    if first.is_certain && first.covers == 1 && first.far > horizon {
        kinds.once += 1;
        // Nobody asks for an order here who is not answered by the header, or hardly anybody.
        let nearest = entries.near.iter().fold(0.0, |nearest, &near| larger(near, nearest));
        let of_it = entries.near.iter().zip(&entries.items).filter(|(near, _)| **near >= first.far);
        records.extend(of_it.map(|(_, &item)| Record { near: nearest, item }));
        let header = Header { lit: larger(first.next, horizon), dark: first.far };
        return (header, Run { start, length: first.count as u32 });
    }
    let Entries { near, items, sorted, .. } = entries;
    sorted.clear();
    sorted.extend(near.iter().zip(&*items).map(|(&near, &item)| Record { near, item }));
    sort_by_depth(sorted);
    let mut header = Header { lit: sorted[0].near, dark: 0.0 };
    let (mut surface, mut end) = (first, first.count);
    loop {
        if surface.is_certain && surface.covers > 0 && surface.far > horizon {
            // Whatever lies behind it is behind a dark place.
            header.dark = surface.far;
            kinds.covered += 1;
            break;
        }
        if surface.next == 0.0 || surface.far <= horizon {
            end = entries.sorted.len();
            break;
        }
        surface = entries.surface(surface.next);
        end += surface.count;
    }
    records.extend_from_slice(&entries.sorted[..end]);
    (header, Run { start, length: end as u32 })
}

/// Nearest first. Most cells have a handful.
fn sort_by_depth(records: &mut [Record]) {
    if records.len() > 20 {
        return records.sort_unstable_by(|a, b| b.near.total_cmp(&a.near));
    }
    for i in 1..records.len() {
        let record = records[i];
        let mut j = i;
        while j > 0 && records[j - 1].near < record.near {
            records[j] = records[j - 1];
            j -= 1;
        }
        records[j] = record;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Header of a cell with entries of w from `far` to `near`, and the length of its list.
    fn header(entries: &[(f32, f32, u32)], horizon: f32) -> (Header, u32) {
        let mut lists = CellLists::new();
        for (number, &(near, far, flags)) in (0..).zip(entries) {
            lists.enter(0, Item::new(number, flags), near, far);
        }
        let (mut scratch, mut records) = (Entries::default(), Vec::new());
        let (header, run) =
            certify(&lists, 0, horizon, &mut scratch, &mut records, &mut Kinds::default());
        assert_eq!(run.length as usize, records.len());
        assert!(records.is_sorted_by(|a, b| a.near >= b.near));
        (header, run.length)
    }

    const COVERS: u32 = Item::COVERS;

    #[test]
    fn one_sheet_lights_what_lies_on_it_and_darkens_what_lies_behind() {
        let expected = (Header { lit: 1.0, dark: 2.0 }, 2);
        assert_eq!(header(&[(4.0, 3.0, COVERS), (3.0, 2.0, 0), (1.0, 0.5, COVERS)], 0.1), expected);
        // The order in which they came is no matter, nor what is on the other side of a gap.
        let found = header(&[(1.0, 0.5, Item::IRREGULAR), (3.0, 2.0, 0), (4.0, 3.0, COVERS)], 0.1);
        assert_eq!(found, expected);
    }

    #[test]
    fn intervals_that_touch_are_one_surface() {
        let (found, _) = header(&[(4.0, 3.0, COVERS), (3.0, 2.0, COVERS)], 0.1);
        assert_eq!(found, Header { lit: 4.0, dark: 2.0 });
        let (found, _) = header(&[(4.0, 3.0, COVERS), (3.0f32.next_down(), 2.0, COVERS)], 0.1);
        assert_eq!(found, Header { lit: 3.0f32.next_down(), dark: 3.0 });
    }

    #[test]
    fn irregular_edges_uncertain_centres_and_what_is_withheld_void_a_certificate() {
        for flags in [COVERS | Item::IRREGULAR, Item::MAY_COVER, 0] {
            assert_eq!(header(&[(4.0, 3.0, flags)], 0.1), (Header { lit: 4.0, dark: 0.0 }, 1));
        }
        let (found, _) = header(&[(4.0, 3.0, COVERS), (3.5, 3.2, Item::IRREGULAR)], 0.1);
        assert_eq!(found.dark, 0.0);
        assert_eq!(header(&[(4.0, 3.0, COVERS)], 3.0).0, Header { lit: 4.0, dark: 0.0 });
        assert_eq!(header(&[(4.0, 3.0, COVERS)], 2.0).0, Header { lit: 2.0, dark: 3.0 });
    }

    #[test]
    fn a_cover_behind_others_only_darkens() {
        let found = header(&[(9.0, 8.0, Item::IRREGULAR), (4.0, 3.0, COVERS), (1.0, 0.5, 0)], 0.1);
        assert_eq!(found, (Header { lit: 9.0, dark: 3.0 }, 2));
    }
}
