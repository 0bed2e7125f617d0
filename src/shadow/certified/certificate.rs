//! What a cell decides by itself (TRUTH, "Certified cells").

use super::entries::{Entry, Item};
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

/// Makes header and list of a cell. What is withheld from it has at most the w of the horizon.
///
/// Entries whose intervals of w overlap, directly or through others, are one surface. If no irregular edge of it meets
/// the cell, as many of its triangles cover each direction as cover the centre: at a regular edge one takes over
/// from another, and both are here, since they share a depth of the edge, which is before the horizon. So with one or
/// more all that is farther than the surface is dark. If it is the nearest surface and there is exactly one, it
/// is a graph with nothing before it, and receivers on it are lit; and those on any triangle that is cast, nearer than what follows it, are on it.
/// All is formed before anything is pruned.
pub(super) fn certify(
    entries: &mut [Entry],
    horizon: f32,
    records: &mut Vec<Record>,
    kinds: &mut Kinds,
) -> (Header, Run) {
    if entries.is_empty() {
        return (Header::EMPTY, Run::default());
    }
    kinds.touched += 1;
    sort_by_depth(entries);
    let mut header = Header { lit: entries[0].near, dark: 0.0 };
    let (mut first, mut end) = (0, entries.len());
    while first < entries.len() {
        let mut far = entries[first].far;
        let (mut covers, mut is_certain) = (0, true);
        let mut next = first;
        while let Some(entry) = entries.get(next).filter(|entry| entry.near >= far) {
            is_certain &= !entry.item.has(Item::IRREGULAR | Item::MAY_COVER);
            covers += u32::from(entry.item.has(Item::COVERS));
            far = far.min(entry.far);
            next += 1;
        }
        if is_certain && covers > 0 && far > horizon {
            header.dark = far;
            if first == 0 && covers == 1 {
                kinds.once += 1;
                header.lit = entries.get(next).map_or(horizon, |entry| entry.near.max(horizon));
            } else {
                kinds.covered += 1;
            }
            // Whatever lies behind it is behind a dark place.
            end = next;
            break;
        }
        first = next;
    }
    let run = Run { start: records.len() as u32, length: end as u32 };
    records.extend(entries[..end].iter().map(|entry| Record { near: entry.near, item: entry.item }));
    (header, run)
}

/// Nearest first. Most cells have a handful.
fn sort_by_depth(entries: &mut [Entry]) {
    if entries.len() > 20 {
        return entries.sort_unstable_by(|a, b| b.near.total_cmp(&a.near));
    }
    for i in 1..entries.len() {
        let entry = entries[i];
        let mut j = i;
        while j > 0 && entries[j - 1].near < entry.near {
            entries[j] = entries[j - 1];
            j -= 1;
        }
        entries[j] = entry;
    }
}

#[cfg(test)]
mod tests {
    use super::super::entries::{Bins, Budget};
    use super::*;

    /// Header of a cell with entries of w from `far` to `near`, and the length of its list.
    fn header(entries: &[(f32, f32, u32)], horizon: f32) -> (Header, u32) {
        let budget = Budget::new(1 << 20);
        let mut bins = Bins::new(1, &budget);
        for (number, &(near, far, flags)) in (0..).zip(entries) {
            bins.push(0, Item::new(number, flags), near, far);
        }
        let mut gathered = Vec::new();
        bins.gather(0, &mut gathered);
        let (header, run) = certify(&mut gathered, horizon, &mut Vec::new(), &mut Kinds::default());
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
