//! What a cell decides by itself (TRUTH, "Certified cells").

use super::cell_lists::Item;
use super::edges::Edges;
use super::entries::{Cell, Entries, FEW, bits, depth};
use super::judge::{Judge, Judged};
use super::projection::larger;
use super::stored::{Header, Record, Run, UNSORTED};
use super::verdict::Verdict;
use crate::geometry::batch::InstructionSet;
use std::cmp::Reverse;
use std::ops::AddAssign;

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

/// The entries of one surface of a cell together.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Surface {
    /// At least its largest w, as bits.
    near: i32,
    /// At most its smallest.
    far: i32,
    /// Entries that cover the centre.
    covers: u32,
    /// Whether it is certain which do, and no irregular edge of it meets the cell.
    is_certain: bool,
    /// At least the largest w behind it, 0 if nothing is there.
    next: i32,
}

impl Entries {
    /// What the header says of so many entries.
    #[inline(always)]
    fn judge_by(&mut self, header: Header, count: usize) {
        for ((&near, &far), verdict) in self.near[..count].iter().zip(&self.far).zip(&mut self.verdicts) {
            *verdict = if depth(far) > header.lit {
                Verdict::Lit
            } else if depth(near) < header.dark {
                Verdict::Dark
            } else {
                Verdict::Open
            };
        }
    }

    /// The nearest surface of what is no nearer than `from`, among so many entries. Where nothing is certain, its entries are looked at again.
    #[inline(always)]
    fn surface(&mut self, cell: &Cell<'_>, count: usize, from: i32) -> Surface {
        let found = match count {
            5..=FEW => surface::<FEW>(&self.near[..FEW], &self.far[..FEW], &self.items[..FEW], from),
            _ => surface::<0>(&self.near[..count], &self.far[..count], &self.items[..count], from),
        };
        if found.is_certain { found } else { self.look_again(cell, count, found) }
    }

    /// As long as that leaves none of them in doubt.
    fn look_again(&mut self, cell: &Cell<'_>, count: usize, found: Surface) -> Surface {
        let mut covers = 0;
        for (&near, item) in self.near[..count].iter().zip(&mut self.items) {
            if near >= found.far && near <= found.near {
                if item.has(Item::DOUBTS) {
                    *item = cell.tile.look_again(*item, cell.at);
                    if item.has(Item::DOUBTS) {
                        return found;
                    }
                }
                covers += item.flags() & Item::COVERS;
            }
        }
        Surface { covers, is_certain: true, ..found }
    }
}

/// Of as many entries as `COUNT` says, unless that is 0.
#[inline(always)]
fn surface<const COUNT: usize>(near: &[i32], far: &[i32], items: &[Item], from: i32) -> Surface {
    let count = if COUNT == 0 { near.len() } else { COUNT };
    let (near, far, items) = (&near[..count], &far[..count], &items[..count]);
    let mut nearest = 0;
    for &near in near {
        nearest = nearest.max(if near <= from { near } else { 0 });
    }
    // Of all that overlaps what is known of the surface, until that is all.
    let mut end = nearest;
    loop {
        let mut farther = end;
        for (&near, &far) in near.iter().zip(far) {
            let overlaps = (near >= end) & (near <= from);
            farther = farther.min(if overlaps { far } else { end });
        }
        if farther == end {
            break;
        }
        end = farther;
    }
    let (mut covers, mut flags, mut next) = (0, 0, 0);
    for (&near, item) in near.iter().zip(items) {
        let is_of_it = (near >= end) & (near <= from);
        let of_it = if is_of_it { item.flags() } else { 0 };
        covers += of_it & Item::COVERS;
        flags |= of_it;
        next = next.max(if near < end { near } else { 0 });
    }
    let is_certain = flags & Item::DOUBTS == 0;
    Surface { near: nearest, far: end, covers, is_certain, next }
}

/// Whoever judges the triangles of cells.
pub(super) struct Judging<'a> {
    pub set: InstructionSet,
    pub judge: &'a mut Judge,
    pub edges: &'a Edges,
}

impl Judging<'_> {
    /// Judges those of so many entries whose verdict is open.
    #[inline(always)]
    fn judge(&mut self, cell: &Cell<'_>, entries: &mut Entries, count: usize) {
        self.judge.judge(self.set, &Judged { cell, edges: self.edges, count }, entries);
    }

    /// Notes the verdicts on so many entries.
    #[inline(always)]
    fn note(&mut self, entries: &Entries, count: usize) {
        for (&item, &verdict) in entries.items[..count].iter().zip(&entries.verdicts) {
            self.judge.note(item, verdict);
        }
    }
}

/// Makes header and list of a cell.
///
/// Entries whose intervals of w overlap, directly or through others, are one surface. If no irregular edge of it meets
/// the cell, as many of its triangles cover each direction as cover the centre: at a regular edge one takes over
/// from another, and both are here, since they share a depth of the edge, which is before the horizon. So with one or
/// more all that is farther than the surface is dark. If it is the nearest surface and there is exactly one, it
/// is a graph with nothing before it, and receivers on it are lit; and those on any triangle that is cast, nearer than what follows it, are on it.
/// All is formed before anything is pruned.
#[inline(always)]
pub(super) fn certify(
    cell: &Cell<'_>,
    entries: &mut Entries,
    records: &mut Vec<Record>,
    kinds: &mut Kinds,
    mut judging: Option<Judging<'_>>,
) -> (Header, Run) {
    if cell.lists.is_empty(cell.place) {
        return (Header::EMPTY, Run::default());
    }
    kinds.touched += 1;
    let (horizon, start) = (cell.horizon, records.len() as u32);
    if let Some(only) = cell.lists.only(cell.place) {
        let in_doubt = only.item.has(Item::DOUBTS);
        let item = if in_doubt { cell.tile.look_again(only.item, cell.at) } else { only.item };
        let verdict = if judging.is_some() { Verdict::Lit } else { Verdict::Open };
        records.push(cell.record(item, only.near, verdict));
        if let Some(judging) = judging {
            judging.judge.note(item, verdict);
        }
        let is_certain = item.flags() & (Item::COVERS | Item::DOUBTS) == Item::COVERS && only.far > horizon;
        kinds.once += u64::from(is_certain);
        let header = match is_certain {
            true => Header { lit: horizon, dark: only.far },
            false => Header { lit: only.near, dark: 0.0 },
        };
        return (header, Run { start, length: 1 });
    }
    let count = entries.gather(cell);
    let first = entries.surface(cell, count, i32::MAX);
    if first.is_certain && first.covers == 1 && depth(first.far) > horizon {
        kinds.once += 1;
        let header = Header { lit: larger(depth(first.next), horizon), dark: depth(first.far) };
        if let Some(judging) = &mut judging {
            entries.judge_by(header, count);
            judging.note(entries, count);
        }
        let length = entries.append(cell, count, first.far, records);
        // Nobody asks for an order here who is not answered by the header, or hardly anybody.
        records[start as usize..].iter_mut().for_each(|record| record.near = depth(first.near));
        return (header, Run { start, length: length as u32 });
    }
    let mut header = Header { lit: depth(first.near), dark: 0.0 };
    let (mut surface, mut end) = (first, 0);
    loop {
        if surface.is_certain && surface.covers > 0 && depth(surface.far) > horizon {
            // Whatever lies behind it is behind a dark place.
            (header.dark, end) = (depth(surface.far), surface.far);
            kinds.covered += 1;
            break;
        }
        if surface.next == 0 || depth(surface.far) <= horizon {
            break;
        }
        surface = entries.surface(cell, count, surface.next);
    }
    if let Some(judging) = &mut judging {
        entries.sort(count);
        entries.judge_by(header, count);
        judging.judge(cell, entries, count);
        judging.note(entries, count);
    }
    let length = entries.append(cell, count, end, records);
    if length > UNSORTED && judging.is_none() {
        records[start as usize..].sort_unstable_by_key(|record| Reverse(bits(record.near)));
    }
    (header, Run { start, length: length as u32 })
}

#[cfg(test)]
mod tests {
    use super::super::cell_lists::CellLists;
    use super::super::projection::Projector;
    use super::super::second_look::TileTriangles;
    use super::*;
    use crate::scene::SceneBuilder;
    use crate::shadow::light_buffer::cube::Face;
    use glam::Vec3;

    /// Header of a cell with entries of w from `far` to `near`, and the length of its list.
    fn header(entries: &[(f32, f32, u32)], horizon: f32) -> (Header, u32) {
        let mut lists = CellLists::new();
        let (scene, projector) = (SceneBuilder::new("none").finish(), Projector::new(Vec3::ZERO, 8));
        let numbers: Vec<u32> = (0..entries.len() as u32).map(|number| 100 - number).collect();
        let tile = TileTriangles {
            scene: &scene,
            projector: &projector,
            projected: &[],
            face: Face::ALL[0],
            numbers: &numbers,
            vertices: &[],
            irregular: &[],
        };
        for (number, &(near, far, flags)) in (0..).zip(entries) {
            // In space, where nobody looks again.
            lists.enter(0, Item::new(number, flags | Item::IN_SPACE), near, far);
        }
        let (mut scratch, mut records) = (Entries::default(), Vec::new());
        let cell = Cell { tile: &tile, lists: &lists, place: 0, at: [0, 0], horizon };
        let (header, run) = certify(&cell, &mut scratch, &mut records, &mut Kinds::default(), None);
        assert!(records.iter().all(|record| record.listed.triangle() > 90), "numbers of the scene");
        assert_eq!(run.length as usize, records.len());
        assert!(records.len() <= UNSORTED || records.is_sorted_by(|a, b| a.near >= b.near));
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
