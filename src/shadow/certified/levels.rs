//! Cells of several sizes: tiles in which many triangles lie are divided into sixteen, whose cells are a quarter as wide, and these again.

use super::projection::{Projected, Projector, cell_and_border, larger};
use super::receivers::{MOST_ERROR, OPEN, locate_exactly, places_of};
use super::selected::{CHUNK, Selected};
use super::tiles::{EDGE, TileGrid};
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::scene::Scene;
use crate::visibility::RoundedPoint;

/// Cells of one level along the edge of one of the level before, and tiles.
pub(super) const FINER: u32 = 4;
/// Tiles that one is divided into.
const PARTS: u32 = FINER * FINER;
/// Where a tile is divided: this and the number of its parts.
const DIVIDED: u32 = 1 << 31;
/// In place of a cell that f32 does not know.
const UNKNOWN: u32 = OPEN - 1;

/// Which cells there are.
pub(super) struct Levels {
    /// That of the finest cells, in which places are measured.
    pub projector: Projector,
    /// The coarsest first.
    pub grids: Vec<TileGrid>,
    /// For each tile of the coarsest: its first cell, [`OPEN`] where nothing lies, or what it is divided into.
    tiles: Vec<u32>,
    /// The same for the parts of divided tiles, row by row.
    parts: Vec<u32>,
}

impl Levels {
    /// So many levels, the finest that of the projector, each with [`FINER`] times as many cells along an edge as the one before. Nothing lies
    /// anywhere.
    ///
    /// # Panics
    /// If there are several, and those along an edge are no multiple of [`unit`](Levels::unit): parts of tiles would be beyond the edge.
    pub fn new(projector: Projector, count: usize) -> Levels {
        assert!(projector.resolution.is_multiple_of(Levels::unit(count)), "whole tiles at every level");
        let resolution = |level: usize| projector.resolution / FINER.pow((count - 1 - level) as u32);
        let grids: Vec<_> = (0..count).map(|level| TileGrid::new(resolution(level))).collect();
        let tiles = vec![OPEN; grids[0].count()];
        Levels { projector, grids, tiles, parts: Vec::new() }
    }

    /// Cells of so many levels along an edge are a multiple of this.
    pub fn unit(count: usize) -> u32 {
        match count {
            1 => 1,
            _ => EDGE * FINER.pow(count as u32 - 1),
        }
    }

    /// Column and row of a tile's part that holds a cell of the next level, as one number.
    #[inline(always)]
    fn part(column: u32, row: u32) -> u32 {
        (row / EDGE) % FINER * FINER + (column / EDGE) % FINER
    }

    /// Where is said what a tile is.
    fn slot(&mut self, level: usize, tile: u32) -> &mut u32 {
        let (side, [column, row]) = self.grids[level].corner(tile);
        let at = |of: usize| {
            let coarser = FINER.pow((level - of) as u32);
            [column / coarser, row / coarser]
        };
        let [x, y] = at(0);
        let mut slot = self.grids[0].tile(side, x, y) as usize;
        for of in 1..=level {
            let parts = if of == 1 { self.tiles[slot] } else { self.parts[slot] } & !DIVIDED;
            let [x, y] = at(of);
            slot = (parts * PARTS + Levels::part(x, y)) as usize;
        }
        if level == 0 { &mut self.tiles[slot] } else { &mut self.parts[slot] }
    }

    /// Gives a tile its cells, of which this is the first.
    pub fn place(&mut self, level: usize, tile: u32, first: u32) {
        *self.slot(level, tile) = first;
    }

    /// Divides a tile, and returns its parts.
    pub fn divide(&mut self, level: usize, tile: u32) -> impl Iterator<Item = u32> + use<> {
        let number = self.parts.len() as u32 / PARTS;
        *self.slot(level, tile) = DIVIDED | number;
        self.parts.extend([OPEN; PARTS as usize]);
        let (side, [column, row]) = self.grids[level].corner(tile);
        let finer = self.grids[level + 1];
        let part = move |x, y| finer.tile(side, column * FINER + x * EDGE, row * FINER + y * EDGE);
        (0..FINER).flat_map(move |y| (0..FINER).map(move |x| part(x, y)))
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.tiles[..]) + size_of_val(&self.parts[..])
    }

    /// The cell of a place in finest cells.
    fn cell(&self, side: u32, column: u32, row: u32) -> u32 {
        let mut found = OPEN;
        for (level, grid) in self.grids.iter().enumerate() {
            let coarser = FINER.pow((self.grids.len() - 1 - level) as u32);
            let (x, y) = (column / coarser, row / coarser);
            found = match level {
                0 => self.tiles[grid.tile(side, x, y) as usize],
                _ => self.parts[((found & !DIVIDED) * PARTS + Levels::part(x, y)) as usize],
            };
            if found == OPEN {
                return OPEN;
            }
            if found < DIVIDED {
                return found + TileGrid::place(x, y);
            }
        }
        unreachable!("the finest tiles are not divided")
    }

    /// Finds the cell that each of up to [`CHUNK`] exact points lies in, [`OPEN`] where nothing lies and for one in the light, and its w; see
    /// [`Whereabouts::depths`](super::receivers::Whereabouts::depths).
    pub fn find(
        &self,
        set: InstructionSet,
        scene: &Scene,
        points: Selected<'_>,
        cells: &mut [u32],
        depths: &mut [f32],
    ) {
        find(set, self, points.rounded(), cells, depths);
        let mut unknown = [0; CHUNK];
        for &i in places_of(UNKNOWN, cells, points, &mut unknown) {
            let i = usize::from(i);
            let found = locate_exactly(&self.projector, scene, points.exact(i));
            (cells[i], depths[i]) = match found {
                Some((at, depth)) => (self.cell(at.side as u32, at.column, at.row), depth),
                None => (OPEN, f32::NAN),
            };
        }
    }
}

/// Points that are taken apart at a time.
const PORTION: usize = 64;
/// How far ahead points are fetched.
const AHEAD: usize = 4 * PORTION;

/// Some points on their sides, in finest cells.
struct Portion {
    u: [f32; PORTION],
    v: [f32; PORTION],
    /// What these are wrong by.
    error: [f32; PORTION],
    /// What was found at the last level.
    found: [u32; PORTION],
}

impl Portion {
    /// Looks at the next level, whose cells are so many times as wide as the finest, and returns whether any place is in a divided tile there.
    /// `slot` says where in `slots` its tile is.
    #[inline(always)]
    fn step(
        &mut self,
        coarser: u32,
        resolution: u32,
        slots: &[u32],
        slot: impl Fn(usize, u32, u32) -> u32,
    ) -> bool {
        let Some(last) = slots.len().checked_sub(1) else { return false };
        let (scale, end) = (1.0 / coarser as f32, resolution / coarser);
        let mut any = 0;
        for i in 0..PORTION {
            let ((column, du), (row, dv)) =
                (cell_and_border(self.u[i] * scale), cell_and_border(self.v[i] * scale));
            let error = self.error[i] * scale;
            let is_certain = (du.abs() > error) & (dv.abs() > error) & (column < end) & (row < end);
            let at = slot(i, column, row) as usize;
            // SAFETY: no more than the last.
            let there = unsafe { *slots.get_unchecked(if at < last { at } else { last }) };
            let there = if there < DIVIDED { there + TileGrid::place(column, row) } else { there };
            let is_asked = (self.found[i] >= DIVIDED) & (self.found[i] < UNKNOWN);
            let found = if is_certain { there } else { UNKNOWN };
            self.found[i] = if is_asked { found } else { self.found[i] };
            any |= u32::from((self.found[i] >= DIVIDED) & (self.found[i] < UNKNOWN));
        }
        any != 0
    }
}

for_instruction_sets! {
    fn find = find_body, (levels: &Levels, points: &[RoundedPoint], cells: &mut [u32], depths: &mut [f32])
}

/// Cell and w of points whose cell and depth are certain; the cell of others is [`UNKNOWN`].
#[inline(always)]
fn find_body(
    _: InstructionSet,
    levels: &Levels,
    points: &[RoundedPoint],
    cells: &mut [u32],
    depths: &mut [f32],
) {
    // All lanes are gone through, whether or not there are so many points: a loop without an end of its own.
    let (mut x, mut y, mut z) = ([0.0; PORTION], [0.0; PORTION], [0.0; PORTION]);
    let (mut bare, mut side, mut depth) = ([0u32; PORTION], [0u32; PORTION], [0.0; PORTION]);
    let mut portion =
        Portion { u: [0.0; PORTION], v: [0.0; PORTION], error: [0.0; PORTION], found: [0; PORTION] };
    let projector = &levels.projector;
    for first in (0..cells.len()).step_by(PORTION) {
        let there = first..cells.len().min(first + PORTION);
        // A line of the cache holds four points.
        for line in 0..PORTION / 4 {
            if let Some(point) = points.get(first + AHEAD + 4 * line) {
                fetch(point);
            }
        }
        for (i, point) in points[there.clone()].iter().enumerate() {
            [x[i], y[i], z[i]] = point.position;
            bare[i] = u32::from(point.is_bare());
        }
        for i in 0..PORTION {
            let p = projector.project([x[i], y[i], z[i]]);
            let size = larger(larger(x[i].abs(), y[i].abs()), z[i].abs());
            let is_known = (p.side != Projected::NOWHERE) & (projector.error_of(size, p.w) < MOST_ERROR);
            (portion.u[i], portion.v[i], portion.error[i]) = (p.u, p.v, projector.delta_of(size, p.w));
            portion.found[i] = if is_known { DIVIDED } else { UNKNOWN };
            depth[i] = if bare[i] == 1 { f32::NAN } else { p.w };
            side[i] = p.side;
        }
        let mut coarser = FINER.pow(levels.grids.len() as u32 - 1);
        let per_edge = levels.grids[0].per_edge();
        // Of places without a certain cell this may be anything.
        let of_tile = |i: usize, column: u32, row: u32| {
            let row_of_tiles = side[i].wrapping_mul(per_edge).wrapping_add(row / EDGE);
            row_of_tiles.wrapping_mul(per_edge).wrapping_add(column / EDGE)
        };
        let mut any = portion.step(coarser, projector.resolution, &levels.tiles, of_tile);
        while any {
            coarser /= FINER;
            let divided = portion.found;
            let of_part = |i: usize, column: u32, row: u32| {
                (divided[i] & !DIVIDED).wrapping_mul(PARTS) + Levels::part(column, row)
            };
            any = portion.step(coarser, projector.resolution, &levels.parts, of_part);
        }
        let count = there.len();
        cells[there.clone()].copy_from_slice(&portion.found[..count]);
        depths[there].copy_from_slice(&depth[..count]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneBuilder;
    use crate::visibility::{Points, SurfacePoint};
    use glam::Vec3;
    use std::collections::BTreeMap;

    /// Three levels of 2, 8 and 32 tiles along an edge, of which some are divided, some hold nothing, and the others have cells one after the other;
    /// and the level and tile of those.
    fn levels() -> (Levels, BTreeMap<u32, (usize, u32)>) {
        let mut levels = Levels::new(Projector::new(Vec3::ZERO, 256), 3);
        let (mut stored, mut next) = (BTreeMap::new(), 0);
        let mut tiles: Vec<_> = (0..levels.grids[0].count() as u32).map(|tile| (0, tile)).collect();
        while let Some((level, tile)) = tiles.pop() {
            match tile.wrapping_mul(0x9e37_79b9) >> 29 {
                0 => {}
                1..=4 if level < 2 => tiles.extend(levels.divide(level, tile).map(|part| (level + 1, part))),
                _ => {
                    levels.place(level, tile, next);
                    stored.insert(next, (level, tile));
                    next += 64;
                }
            }
        }
        (levels, stored)
    }

    #[test]
    fn every_place_is_in_the_cell_of_its_tile() {
        let (levels, stored) = levels();
        let count = |level| stored.values().filter(|(of, _)| *of == level).count();
        assert!((0..3).all(|level| count(level) > 5), "{:?}", [0, 1, 2].map(count));
        for side in 0..6 {
            for (column, row) in (0..256).flat_map(|x| (0..256).map(move |y| (x, y))) {
                let cell = levels.cell(side, column, row);
                if cell == OPEN {
                    continue;
                }
                let (level, tile) = stored[&(cell / 64 * 64)];
                let coarser = FINER.pow(2 - level as u32);
                let (x, y) = (column / coarser, row / coarser);
                assert_eq!(tile, levels.grids[level].tile(side, x, y));
                assert_eq!(cell % 64, TileGrid::place(x, y));
            }
        }
    }

    #[test]
    fn places_in_f32_are_those_of_exact_points() {
        let (levels, _) = levels();
        let scene = SceneBuilder::new("none").finish();
        // Many of them on borders of cells, or near.
        let at = |i: i32| [(i % 64 - 32) as f32 / 32.0, (i as f32 * 0.618).fract() * 2.0 - 1.0, 1.0 - 1e-7];
        let positions = (0..CHUNK as i32).map(|i| {
            let [a, b, c] =
                [at(i)[(i % 3) as usize], at(i)[((i + 1) % 3) as usize], at(i)[((i + 2) % 3) as usize]];
            Vec3::new(a, b, if i % 2 == 0 { c } else { -c }) * (1.0 + i as f32 * 1e-3)
        });
        let points: Vec<_> = positions.map(|p| SurfacePoint::bare(p).expect("finite")).collect();
        let rounded = RoundedPoint::all(&points);
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let (mut cells, mut depths) = (vec![0; points.len()], vec![0.0; points.len()]);
            levels.find(set, &scene, Selected::all(Points::new(&rounded, &points)), &mut cells, &mut depths);
            for (point, &cell) in points.iter().zip(&cells) {
                let (at, _) = locate_exactly(&levels.projector, &scene, point).expect("not in the light");
                assert_eq!(cell, levels.cell(at.side as u32, at.column, at.row), "{point:?}");
            }
        }
        let mut found = vec![7];
        let light = [SurfacePoint::bare(Vec3::ZERO).expect("finite")];
        let rounded = RoundedPoint::all(&light);
        let light = Selected::all(Points::new(&rounded, &light));
        levels.find(InstructionSet::Portable, &scene, light, &mut found, &mut [0.0]);
        assert_eq!(found, [OPEN]);
    }
}
