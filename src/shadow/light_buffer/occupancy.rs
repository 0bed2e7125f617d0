//! What the lists of a buffer hold, counted as the 1986 paper counts it (row 23 of its notes): opaque and
//! transparent surfaces stand in one list there, and whatever else a list holds is an item of it too.

use super::cells::Cells;
use super::{LightBuffer, SideLists};

/// List items of one buffer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Occupancy {
    /// Squares of all sides, stored or not.
    pub squares: u64,
    /// Records of primitives that block.
    pub opaque: u64,
    /// Records of transparent primitives.
    pub transparent: u64,
    /// Bounding-volume records.
    pub bounding_volumes: u64,
    /// Full-occlusion records: here a depth in the cell's header.
    pub full_occlusions: u64,
    /// Squares whose list holds at least one primitive.
    pub non_empty: u64,
    /// Items of all kinds in the longest list.
    pub longest: u64,
}

impl Occupancy {
    /// Items of all kinds.
    pub fn items(&self) -> u64 {
        self.opaque + self.transparent + self.bounding_volumes + self.full_occlusions
    }

    /// Adds a square's list.
    fn add(&mut self, square: Square) {
        self.opaque += square.opaque;
        self.transparent += square.transparent;
        self.bounding_volumes += square.bounding_volumes;
        self.full_occlusions += square.full_occlusions;
        self.non_empty += u64::from(square.opaque + square.transparent > 0);
        let items = square.opaque + square.transparent + square.bounding_volumes + square.full_occlusions;
        self.longest = self.longest.max(items);
    }
}

/// Items of one square's list.
#[derive(Debug, Clone, Copy, Default)]
struct Square {
    opaque: u64,
    transparent: u64,
    bounding_volumes: u64,
    full_occlusions: u64,
}

impl LightBuffer<'_> {
    /// Counts the items of all lists.
    ///
    /// The transparent surfaces of a light infinitely far away have a sheet of their own, whose squares are
    /// counted beside those of the opaque ones.
    pub fn occupancy(&self) -> Occupancy {
        let resolution = u64::from(self.statistics.resolution);
        let squares = self.cells.sides() as u64 * resolution * resolution;
        let mut found = Occupancy { squares, ..Occupancy::default() };
        let transparent = self.transparent.as_ref().map(|lists| &lists.sides[..]);
        let is_shared = matches!(self.cells, Cells::Cube);
        for (side, opaque) in self.sides.iter().enumerate() {
            let transparent = transparent.and_then(|sides| sides.get(side)?.as_ref());
            if let Some(lists) = opaque {
                let beside = transparent.filter(|_| is_shared);
                for (column, row) in squares_of(lists) {
                    found.add(Square {
                        transparent: beside.map_or(0, |lists| records_at(lists, column, row)),
                        ..opaque_at(lists, column, row)
                    });
                }
            }
            if let Some(lists) = transparent {
                let counted = opaque.as_ref().filter(|_| is_shared);
                let is_left = |&(column, row): &(u32, u32)| {
                    counted.is_none_or(|lists| lists.cell(column, row).is_none())
                };
                for (column, row) in squares_of(lists).filter(is_left) {
                    let transparent = records_at(lists, column, row);
                    found.add(Square { transparent, ..Square::default() });
                }
            }
        }
        found
    }
}

/// The squares that are stored.
fn squares_of(lists: &SideLists) -> impl Iterator<Item = (u32, u32)> + use<> {
    let ([x, y], [columns, rows]) = (lists.first, lists.count);
    (y..y + rows).flat_map(move |row| (x..x + columns).map(move |column| (column, row)))
}

fn records_at(lists: &SideLists, column: u32, row: u32) -> u64 {
    lists.cell(column, row).map_or(0, |cell| lists.list(cell).1.len() as u64)
}

fn opaque_at(lists: &SideLists, column: u32, row: u32) -> Square {
    let Some(cell) = lists.cell(column, row) else { return Square::default() };
    let (full_occlusion, list) = lists.list(cell);
    Square {
        opaque: list.len() as u64,
        transparent: 0,
        bounding_volumes: lists.groups.of(cell).len() as u64,
        full_occlusions: u64::from(full_occlusion < f32::INFINITY),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural::find;
    use crate::shadow::{BuildInput, Culling, Resolution, SceneIndex, VolumeThreshold};

    #[test]
    fn every_kind_of_item_counts_in_its_list() {
        let mut found = Occupancy::default();
        found.add(Square { opaque: 1, transparent: 2, bounding_volumes: 4, full_occlusions: 8 });
        found.add(Square { transparent: 3, ..Square::default() });
        found.add(Square { full_occlusions: 1, ..Square::default() });
        found.add(Square { opaque: 2, ..Square::default() });
        let expected = Occupancy {
            squares: 0,
            opaque: 3,
            transparent: 5,
            bounding_volumes: 4,
            full_occlusions: 9,
            non_empty: 3,
            longest: 15,
        };
        assert_eq!((found, found.items()), (expected, 21));
    }

    #[test]
    fn the_kinds_add_up_to_what_the_build_counted() {
        let scene = find("counter-top").unwrap().build(None).unwrap();
        let index = SceneIndex::new(&scene);
        let buffer = LightBuffer::new(&BuildInput {
            resolution: Resolution::Cells(10),
            culling: Culling::ClosedSolids,
            bounding_volumes: VolumeThreshold::MoreThan(6),
            ..BuildInput::new(&scene, &index, scene.lights[0].position())
        })
        .unwrap();
        let (found, counts) = (buffer.occupancy(), buffer.counts());
        assert_eq!(found.squares, 600);
        assert!(found.transparent > 0 && found.bounding_volumes > 0);
        assert_eq!(
            (found.opaque, found.transparent, found.bounding_volumes, found.full_occlusions),
            (counts.records, counts.transparent_records, counts.bounding_volumes, counts.full_occlusions)
        );
        // Lists that hold transparent surfaces alone are lists too.
        assert!(found.non_empty >= counts.non_empty && found.longest >= counts.longest_list);
        assert!(found.non_empty <= found.squares && found.longest <= found.items());
    }
}
