//! Bounding-volume records (row 8 of the notes on the 1986 paper): where many polygons of one object stand
//! in a cell's list, they are put behind one volume and skipped together if a segment misses that.
//!
//! Such a record stands where the nearest of its polygons stood, and all of these follow it at once, nearest
//! first among themselves but not sorted against the rest of the list. What is counted are the records that
//! are left when the list has been simplified.

use super::{BuildInput, Casters, Record};
use crate::geometry::volume::Volume;
use crate::shadow::VolumeThreshold;
use crate::shadow::bounding_volumes::{cast_objects, is_endless};

/// A bounding-volume record and the run of records in its cell's list that it stands before. Its depth is
/// that of the first of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub(super) struct Group {
    /// The object that all of them belong to.
    pub object: u32,
    /// First of its records in the cell's list.
    pub first: u32,
    /// One behind the last.
    pub end: u32,
}

impl Group {
    /// Its records.
    pub fn members<'l>(&self, list: &'l [Record]) -> &'l [Record] {
        &list[self.first as usize..self.end as usize]
    }
}

/// The bounding-volume records of all cells of a side; nothing at all if there can be none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct CellGroups {
    /// Start of each cell's groups, and the end of the last.
    starts: Vec<u32>,
    groups: Vec<Group>,
}

impl CellGroups {
    /// Those of a cell, in the order of its list.
    pub fn of(&self, cell: usize) -> &[Group] {
        if self.starts.is_empty() {
            return &[];
        }
        &self.groups[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Appends the groups of the next cell.
    pub fn push_cell(&mut self, groups: impl IntoIterator<Item = Group>) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.groups.extend(groups);
        self.starts.push(self.groups.len() as u32);
    }

    /// Appends the cells of another.
    pub fn append(&mut self, other: CellGroups) {
        let base = self.groups.len() as u32;
        // The first start of all but the first is the end of those before.
        let starts = other.starts.iter().skip(usize::from(!self.starts.is_empty()));
        self.starts.extend(starts.map(|start| base + start));
        self.groups.extend(other.groups);
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.starts.len() * size_of::<u32>() + self.groups.len() * size_of::<Group>()
    }
}

/// Stands for the object of planes without end, which are never grouped.
const NO_VOLUME: u32 = u32::MAX;

/// What is needed to group the records of one light's buffer.
pub(super) struct Grouping {
    /// More records of one object than this are put behind its volume.
    most_single: usize,
    /// Object of each caster; [`NO_VOLUME`] if its volume does not hold the caster.
    object_of: Vec<u32>,
}

impl Grouping {
    /// `None` if nothing is grouped.
    pub fn new(input: &BuildInput, casters: &Casters) -> Option<Grouping> {
        let VolumeThreshold::MoreThan(most_single) = input.bounding_volumes else { return None };
        let object = |&primitive: &u32| match is_endless(input.scene, primitive) {
            true => NO_VOLUME,
            false => input.scene.object_index(primitive),
        };
        let object_of = casters.primitives.iter().map(object).collect();
        Some(Grouping { most_single: most_single as usize, object_of })
    }

    /// Brings the records of a cell, which are sorted by depth, into the order of groups, and returns these.
    pub fn group(&self, list: &mut [Record]) -> Vec<Group> {
        if list.len() <= self.most_single {
            return Vec::new();
        }
        let mut by_object: Vec<(u32, u32)> =
            (0..).zip(&*list).map(|(i, record)| (self.object_of[record.caster as usize], i)).collect();
        by_object.sort_unstable();
        // Each record goes where its group begins, those of no group stay where they are.
        let mut order: Vec<(u32, u32)> = Vec::with_capacity(list.len());
        let mut groups = Vec::new();
        for of_one in by_object.chunk_by(|a, b| a.0 == b.0) {
            let (object, first) = of_one[0];
            if of_one.len() > self.most_single && object != NO_VOLUME {
                groups.push(Group { object, first, end: of_one.len() as u32 });
                order.extend(of_one.iter().map(|&(_, i)| (first, i)));
            } else {
                order.extend(of_one.iter().map(|&(_, i)| (i, i)));
            }
        }
        if groups.is_empty() {
            return groups;
        }
        order.sort_unstable();
        let sorted = list.to_vec();
        list.iter_mut().zip(&order).for_each(|(record, &(_, i))| *record = sorted[i as usize]);
        groups.sort_unstable_by_key(|group| group.first);
        for group in &mut groups {
            let first = order.partition_point(|&(place, _)| place < group.first) as u32;
            (group.first, group.end) = (first, first + group.end);
        }
        groups
    }
}

/// The volume of each object, by its index; empty if nothing is grouped.
pub(super) fn object_volumes(input: &BuildInput, casters: &Casters) -> Vec<Option<Volume>> {
    if input.bounding_volumes == VolumeThreshold::Off {
        return Vec::new();
    }
    let mut volumes = vec![None; input.scene.objects.len()];
    for object in cast_objects(input.scene, &casters.primitives) {
        let volume: &mut Option<Volume> = &mut volumes[object.object as usize];
        *volume = Volume::around_volumes(volume.iter().copied().chain([object.volume]));
    }
    volumes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Records of increasing depth; the caster is the place, and its object is given.
    fn grouped(objects: &[u32], most_single: usize) -> (Vec<u32>, Vec<Group>) {
        let grouping = Grouping { most_single, object_of: objects.to_vec() };
        let mut list: Vec<Record> =
            (0..objects.len() as u32).map(|caster| Record { near: caster as f32, caster }).collect();
        let groups = grouping.group(&mut list);
        (list.iter().map(|record| record.caster).collect(), groups)
    }

    #[test]
    fn records_of_one_object_gather_behind_the_nearest() {
        let (order, groups) = grouped(&[3, 7, 7, 3, 9, 7, 9, 7], 2);
        assert_eq!(order, [0, 1, 2, 5, 7, 3, 4, 6]);
        assert_eq!(groups, [Group { object: 7, first: 1, end: 5 }]);
        let (order, groups) = grouped(&[3, 7, 7, 3, 9, 7, 9, 7], 1);
        assert_eq!(order, [0, 3, 1, 2, 5, 7, 4, 6]);
        let group = |object, first, end| Group { object, first, end };
        assert_eq!(groups, [group(3, 0, 2), group(7, 2, 6), group(9, 6, 8)]);
    }

    #[test]
    fn as_many_as_the_threshold_are_left_alone() {
        let (order, groups) = grouped(&[1, 2, 1, 2], 2);
        assert_eq!((order, groups), (vec![0, 1, 2, 3], vec![]));
        assert_eq!(grouped(&[5], 0).1, [Group { object: 5, first: 0, end: 1 }]);
        assert_eq!(grouped(&[], 0).1, []);
    }

    #[test]
    fn cells_of_bands_are_put_end_to_end() {
        let group = |object| Group { object, first: 0, end: 7 };
        let mut all = CellGroups::default();
        for objects in [[vec![], vec![1]], [vec![2, 3], vec![]], [vec![], vec![4]]] {
            let mut band = CellGroups::default();
            objects.iter().for_each(|cell| band.push_cell(cell.iter().map(|&o| group(o))));
            all.append(band);
        }
        let found: Vec<Vec<u32>> = (0..6).map(|c| all.of(c).iter().map(|g| g.object).collect()).collect();
        assert_eq!(found, [vec![], vec![1], vec![2, 3], vec![], vec![], vec![4]]);
        assert!(CellGroups::default().of(3).is_empty());
    }

    #[test]
    fn groups_of_cells_are_counted_in_bytes() {
        let mut all = CellGroups::default();
        assert_eq!(all.bytes(), 0);
        let group = Group { object: 0, first: 0, end: 7 };
        all.push_cell([group; 2]);
        all.push_cell([group; 3]);
        // Three starts, and five groups of three numbers.
        assert_eq!(all.bytes(), 3 * 4 + 5 * 12);
    }
}
