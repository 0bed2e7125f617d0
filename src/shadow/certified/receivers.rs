//! Receivers filed in cells: where anybody asks, and how far away the farthest in each cell is.

use super::projection::{Projected, Projector, cell_and_border, larger};
use super::selected::{CHUNK, Selected};
use super::tiles::{AREA, EDGE, TileGrid, Tiles};
use super::windows::Windows;
use crate::float_environment::StandardFloats;
use crate::geometry::LightSpace;
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::geometry::occlusion::PreciseQuery;
use crate::scene::Scene;
use crate::shadow::light_buffer::cells::{Cells, Located};
use crate::visibility::{Points, RoundedPoint, SurfacePoint};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// In place of a cell, for a receiver that f32 leaves open, and in the end for one in the light itself.
pub(super) const OPEN: u32 = u32::MAX;

/// How much farther than its farthest receiver a cell is looked into, as a share of w: certificates hold only if
/// nothing is withheld before their surface ends, and depths may be wrong.
const MARGIN: f32 = 63.0 / 64.0;

/// The most that w may be wrong by, as a share of itself. Far below what the margin leaves.
pub(super) const MOST_ERROR: f32 = 1.0 / 512.0;

/// For each cell the w beyond which nobody asks, as a key that is 0 where nobody does and grows with the distance.
pub(super) struct Horizon {
    /// Nothing if all may ask from wherever they are.
    cells: Option<Vec<u32>>,
    /// The largest of each tile, and 0 for those outside of all windows.
    tiles: Vec<u32>,
}

/// The keys of a tile about which anybody may ask.
static ENDLESS: [u32; AREA as usize] = [u32::MAX; AREA as usize];

impl Horizon {
    /// Of stored tiles, which are within the windows.
    fn new(tiles: &[u32], windows: &Windows, keys: &[AtomicU32]) -> Horizon {
        let cells: Vec<u32> =
            keys[..tiles.len() * AREA as usize].par_iter().map(|key| key.load(Relaxed)).collect();
        let largest = |keys: &[u32]| keys.iter().copied().max().expect("a tile has cells");
        let of_stored: Vec<u32> = cells.par_chunks(AREA as usize).map(largest).collect();
        let mut of_tiles = vec![0; windows.count() + 1];
        for (&tile, key) in tiles.iter().zip(of_stored) {
            of_tiles[tile as usize] = key;
        }
        Horizon { cells: Some(cells), tiles: of_tiles }
    }

    /// Nothing is beyond it.
    pub fn endless(grid: &TileGrid) -> Horizon {
        let mut of_tiles = vec![u32::MAX; grid.count() + 1];
        of_tiles[grid.count()] = 0;
        Horizon { cells: None, tiles: of_tiles }
    }

    /// Nothing is beyond it in these tiles, and nobody asks in any other.
    pub fn endless_in(grid: &TileGrid, tiles: &[u32]) -> Horizon {
        let mut of_tiles = vec![0; grid.count() + 1];
        tiles.iter().for_each(|&tile| of_tiles[tile as usize] = u32::MAX);
        Horizon { cells: None, tiles: of_tiles }
    }

    /// The key of a w, not negative.
    #[inline(always)]
    pub fn key(w: f32) -> u32 {
        !w.to_bits()
    }

    /// The keys of the cells of a tile.
    #[inline(always)]
    pub fn tile(&self, first: usize) -> &[u32; AREA as usize] {
        match &self.cells {
            Some(cells) => cells[first..first + AREA as usize].try_into().expect("a tile"),
            None => &ENDLESS,
        }
    }

    /// The largest key of each tile, and 0 for those outside of all windows.
    #[inline(always)]
    pub fn of_tiles(&self) -> &[u32] {
        &self.tiles
    }

    /// What is withheld from a cell has at most this w.
    pub fn of(&self, cell: usize) -> f32 {
        match self.cells.as_ref().map_or(u32::MAX, |cells| cells[cell]) {
            0 => f32::INFINITY,
            key => f32::from_bits(!key),
        }
    }
}

/// Receivers by cell.
pub(super) struct Filed {
    /// Around all tiles that receivers lie in.
    pub windows: Windows,
    /// These tiles, in the order of their cells.
    pub tiles: Vec<u32>,
    /// The cell that each one's exact point lies in, or [`OPEN`] for one in the light.
    pub cells: Vec<u32>,
    /// As [`Whereabouts::depths`].
    pub depths: Vec<f32>,
    pub horizon: Horizon,
}

impl Filed {
    /// Files all receivers.
    pub fn new(set: InstructionSet, projector: &Projector, scene: &Scene, points: Points<'_>) -> Filed {
        let grid = TileGrid::new(projector.resolution);
        let tiles = Tiles::new(grid);
        // No more tiles than receivers. Pages that nobody writes to cost nothing.
        let most = grid.count().min(points.len()) * AREA as usize;
        let horizon: Vec<AtomicU32> = bytemuck::zeroed_vec(most);
        let mut cells = vec![0; points.len()];
        let mut depths = vec![0.0; points.len()];
        (points.par_chunks(CHUNK), cells.par_chunks_mut(CHUNK), depths.par_chunks_mut(CHUNK))
            .into_par_iter()
            .for_each(|(points, cells, depths)| {
                let _floats = StandardFloats::new();
                let mut places = [0; CHUNK];
                let places = &mut places[..points.len()];
                let whereabouts = Whereabouts { tiles: cells, places, depths };
                whereabouts.find(set, projector, &grid, scene, points);
                file(&tiles, &horizon, cells, places, depths);
            });
        let mut tiles = tiles.stored();
        let windows = Windows::around(&grid, &tiles);
        for tile in &mut tiles {
            let (side, [x, y]) = grid.corner(*tile);
            *tile = windows.tile(side, x / EDGE, y / EDGE);
        }
        let horizon = Horizon::new(&tiles, &windows, &horizon);
        Filed { windows, tiles, cells, depths, horizon }
    }
}

/// Where up to [`CHUNK`] receivers are.
pub(super) struct Whereabouts<'a> {
    /// The tile of the grid that each one's exact point lies in, or [`OPEN`] for one in the light.
    pub tiles: &'a mut [u32],
    /// The place of its cell in the tile.
    pub places: &'a mut [u8],
    /// w of each, wrong by [`Projector::error_of`]; NaN where f32 cannot hold it, and for those that lie on no primitive,
    /// which no header lights.
    pub depths: &'a mut [f32],
}

impl Whereabouts<'_> {
    /// Finds them all.
    pub fn find(
        self,
        set: InstructionSet,
        projector: &Projector,
        grid: &TileGrid,
        scene: &Scene,
        points: Points<'_>,
    ) {
        let Whereabouts { tiles, places, depths } = self;
        locate(set, projector, grid, points.rounded(), tiles, places, depths);
        let mut open = [0; CHUNK];
        for &i in places_of(OPEN, tiles, Selected::all(points), &mut open) {
            let i = usize::from(i);
            (tiles[i], places[i], depths[i]) = match locate_exactly(projector, scene, &points.exact()[i]) {
                Some((at, w)) => {
                    let place = TileGrid::place(at.column, at.row) as u8;
                    (grid.tile(at.side as u32, at.column, at.row), place, w)
                }
                None => (OPEN, 0, f32::NAN),
            };
        }
    }
}

/// Numbers that are looked through at a time.
const FEW: usize = 16;

/// Which of up to [`CHUNK`] points are marked by a number, which few are. All of them are on their way from memory then.
pub(super) fn places_of<'a>(
    mark: u32,
    marks: &[u32],
    points: Selected<'_>,
    found: &'a mut [u16; CHUNK],
) -> &'a [u16] {
    let mut count = 0;
    for (first, some) in (0u16..).step_by(FEW).zip(marks.chunks(FEW)) {
        if !some.contains(&mark) {
            continue;
        }
        for (i, _) in (first..).zip(some).filter(|(_, of_point)| **of_point == mark) {
            let point = points.exact(usize::from(i));
            fetch(&point.position);
            fetch(&point.source);
            found[count] = i;
            count += 1;
        }
    }
    &found[..count]
}

/// Makes cells of tiles and places, and raises the horizon. Neighbours mostly share a cell.
fn file(tiles: &Tiles, horizon: &[AtomicU32], cells: &mut [u32], places: &[u8], depths: &[f32]) {
    let raise = |cell: u32, w: f32| {
        let key = Horizon::key(w * MARGIN);
        let horizon = &horizon[cell as usize];
        if horizon.load(Relaxed) < key {
            horizon.fetch_max(key, Relaxed);
        }
    };
    let (mut tile, mut first) = (OPEN, 0);
    let (mut cell, mut farthest) = (OPEN, f32::INFINITY);
    for ((at, place), &w) in cells.iter_mut().zip(places).zip(depths) {
        if *at == OPEN {
            continue;
        }
        if *at != tile {
            tile = *at;
            first = tiles.claim(tile);
        }
        *at = first + u32::from(*place);
        // What is not known is as far as can be.
        let w = if w > 0.0 { w } else { 0.0 };
        if *at != cell {
            if cell != OPEN {
                raise(cell, farthest);
            }
            (cell, farthest) = (*at, w);
        } else if w < farthest {
            farthest = w;
        }
    }
    if cell != OPEN {
        raise(cell, farthest);
    }
}

for_instruction_sets! {
    fn locate = locate_body, (
        projector: &Projector,
        grid: &TileGrid,
        points: &[RoundedPoint],
        tiles: &mut [u32],
        places: &mut [u8],
        depths: &mut [f32],
    )
}

/// Tile, place and w of points whose cell and depth are certain; the tile of others is [`OPEN`].
#[inline(always)]
fn locate_body(
    _: InstructionSet,
    projector: &Projector,
    grid: &TileGrid,
    points: &[RoundedPoint],
    tiles: &mut [u32],
    places: &mut [u8],
    depths: &mut [f32],
) {
    // All lanes are gone through, whether or not there are so many points: a loop without an end of its own.
    let (mut x, mut y, mut z) = ([0.0; PORTION], [0.0; PORTION], [0.0; PORTION]);
    let mut bare = [0u32; PORTION];
    let (mut tile, mut place, mut depth) = ([0; PORTION], [0u32; PORTION], [0.0; PORTION]);
    for first in (0..tiles.len()).step_by(PORTION) {
        let portion = first..tiles.len().min(first + PORTION);
        // A line of the cache holds four points.
        for line in 0..PORTION / 4 {
            if let Some(point) = points.get(first + AHEAD + 4 * line) {
                fetch(point);
            }
        }
        for (i, point) in points[portion.clone()].iter().enumerate() {
            [x[i], y[i], z[i]] = point.position;
            bare[i] = u32::from(point.is_bare());
        }
        for i in 0..PORTION {
            let p = projector.project([x[i], y[i], z[i]]);
            let size = larger(larger(x[i].abs(), y[i].abs()), z[i].abs());
            let delta = projector.delta_of(size, p.w);
            let ((column, du), (row, dv)) = (cell_and_border(p.u), cell_and_border(p.v));
            let certain = (p.side != Projected::NOWHERE)
                & (projector.error_of(size, p.w) < MOST_ERROR)
                & (du.abs() > delta)
                & (dv.abs() > delta)
                & (column < projector.resolution)
                & (row < projector.resolution);
            tile[i] = if certain { grid.tile(p.side, column, row) } else { OPEN };
            place[i] = TileGrid::place(column, row);
            depth[i] = if bare[i] == 1 { f32::NAN } else { p.w };
        }
        let count = portion.len();
        tiles[portion.clone()].copy_from_slice(&tile[..count]);
        places[portion.clone()].iter_mut().zip(&place).for_each(|(to, &place)| *to = place as u8);
        depths[portion].copy_from_slice(&depth[..count]);
    }
}

/// Points that are taken apart at a time.
const PORTION: usize = 64;
/// How far ahead points are fetched.
const AHEAD: usize = 4 * PORTION;

/// Where a point is by its exact position, and its w; `None` if that is the light.
#[cold]
pub(super) fn locate_exactly(
    projector: &Projector,
    scene: &Scene,
    point: &SurfacePoint,
) -> Option<(Located, f32)> {
    let space = LightSpace::from(projector.light);
    let query = PreciseQuery::new(&space, point.position, || point.exact(scene));
    let (at, _) = Cells::Cube.locate(&space, point.position, projector.resolution, &query)?;
    let w = (1.0 / at.z_low) as f32;
    // Together with its rounding that is within 3 roundoffs.
    let is_exact = at.z_high <= at.z_low * (1.0 + 1e-7) && w > 8.7e-19 && w < 1.1e18;
    let is_known = is_exact && point.primitive().is_some();
    Some((at, if is_known { w } else { f32::NAN }))
}
