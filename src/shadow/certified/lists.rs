//! The lists of one tile after the other: its triangles, their common edges, what each is in each cell, and certificates.

use super::bins::{Bins, Budget, Caller};
use super::block::{Patch, Seen, Sixteen, any_above};
use super::by_triangle::States;
use super::cell_lists::{CellLists, Item};
use super::certificate::{Judging, Kinds, certify};
use super::corners::{Corners, LANES};
use super::edges::Edges;
use super::entries::{Cell, Entries};
use super::facing::{Facing, exactly};
use super::judge::Judge;
use super::projection::{Projected, Projector};
use super::receivers::Horizon;
use super::second_look::TileTriangles;
use super::small::Patches;
use super::stored::{Header, Record, Run};
use super::tiles::{AREA, BLOCK, BLOCK_EDGE, EDGE, TileGrid};
use super::windows::Windows;
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::masks::Bits;
use crate::scene::Scene;
use crate::shadow::light_buffer::cube::Face;

/// All that the lists of tiles are made of.
pub(super) struct Lister<'a> {
    pub scene: &'a Scene,
    pub projector: Projector,
    pub windows: Windows,
    pub horizon: &'a Horizon,
    /// The scene's vertices.
    pub projected: &'a [Projected],
    pub bins: &'a [Bins<'a>],
    pub budget: &'a Budget,
}

/// A tile that has cells: its number in the windows of its level, for each of which there is a [`Lister`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Stored {
    pub level: u32,
    pub tile: u32,
}

/// Triangles of at most so many cells across are entered cell by cell.
const MOST_TINY: u32 = 3;

/// Up to sixteen triangles of a tile: the number of the first, their edges that are irregular, and how they face the light.
struct Triangles<'a> {
    first: u32,
    count: usize,
    irregular: &'a [u8],
    of_lanes: [Facing; LANES],
}

/// Headers and lists of some tiles.
pub(super) struct Part<'a> {
    pub headers: &'a mut [Header],
    pub runs: &'a mut [Run],
    pub records: Vec<Record>,
    pub kinds: Kinds,
    /// Triangles in cells.
    pub entries: u64,
    /// Bytes that were asked for.
    pub granted: usize,
    /// Whether memory was asked for in vain: what follows is missing.
    pub overflowed: bool,
}

impl Part<'_> {
    /// Empty ones.
    pub fn new<'a>(headers: &'a mut [Header], runs: &'a mut [Run]) -> Part<'a> {
        let (records, kinds) = (Vec::new(), Kinds::default());
        Part { headers, runs, records, kinds, entries: 0, granted: 0, overflowed: false }
    }
}

/// The places of one tile after the other.
pub(super) struct Scratch {
    triangles: Vec<[u32; 3]>,
    numbers: Vec<u32>,
    facing: Vec<Facing>,
    irregular: Vec<u8>,
    corners: Vec<Corners>,
    patches: Patches,
    edges: Edges,
    cells: CellLists,
    entries: Entries,
    judge: Judge,
    granted: usize,
}

impl Scratch {
    pub fn new() -> Scratch {
        Scratch {
            triangles: Vec::new(),
            numbers: Vec::new(),
            facing: Vec::new(),
            irregular: Vec::new(),
            corners: Vec::new(),
            patches: Patches::default(),
            edges: Edges::default(),
            cells: CellLists::new(),
            entries: Entries::default(),
            judge: Judge::new(),
            granted: 0,
        }
    }

    fn bytes(&self) -> usize {
        let triangle = size_of::<[u32; 3]>() + size_of::<u32>() + size_of::<Facing>() + 1;
        self.triangles.capacity() * triangle
            + self.corners.capacity() * size_of::<Corners>()
            + self.entries.bytes()
            + self.judge.bytes()
            + self.edges.bytes()
            + self.cells.bytes()
    }
}

impl Lister<'_> {
    /// The small triangles of a tile, their corners and how they face the light.
    #[inline(always)]
    fn gather_small(&self, tile: u32, scratch: &mut Scratch) {
        let Scratch { triangles, numbers, facing, corners, .. } = scratch;
        triangles.clear();
        numbers.clear();
        facing.clear();
        corners.clear();
        for bins in self.bins {
            bins.each_of(tile, |caller| {
                if let Caller::Small(number) = caller {
                    numbers.push(number);
                }
            });
        }
        triangles.extend(numbers.iter().map(|&number| self.scene.triangles[number as usize].vertices));
        for (sixteen, numbers) in triangles.chunks(LANES).zip(numbers.chunks(LANES)) {
            let mut of_sixteen = Corners::default();
            for (lane, vertices) in sixteen.iter().enumerate() {
                of_sixteen.set(lane, self.projected, *vertices);
            }
            let found = of_sixteen.facing(&self.projector);
            facing.extend(numbers.iter().zip(found).map(|(&number, found)| {
                found.unwrap_or_else(|| exactly(self.projector.light, self.scene.corners(number)))
            }));
            corners.push(of_sixteen);
        }
    }

    /// Enters all triangles of a tile in its cells.
    #[inline(always)]
    fn enter(&self, set: InstructionSet, tile: u32, first_cell: usize, scratch: &mut Scratch) {
        self.gather_small(tile, scratch);
        let small = scratch.triangles.len();
        let mut large = Vec::new();
        for bins in self.bins {
            bins.each_of(tile, |caller| {
                if let Caller::Large(place) = caller {
                    large.push(bins.large(place));
                }
            });
        }
        for large in &large {
            scratch.triangles.push(self.scene.triangles[large.triangle as usize].vertices);
            scratch.numbers.push(large.triangle);
            scratch.facing.push(large.facing);
        }
        let Scratch { triangles, facing, irregular, corners, patches, edges, cells, .. } = scratch;
        edges.find(triangles, facing, irregular);
        cells.clear();
        let (_, corner) = self.windows.corner(tile);
        let keys = self.horizon.tile(first_cell);
        let seen = Seen { corner, keys };
        for (sixteen, of_sixteen) in corners.iter().enumerate() {
            let first = sixteen * LANES;
            let count = (small - first).min(LANES);
            let mut of_lanes = [Facing::Nothing; LANES];
            of_lanes[..count].copy_from_slice(&facing[first..first + count]);
            patches.fill(&self.projector, of_sixteen, &of_lanes);
            let triangles =
                Triangles { first: first as u32, count, irregular: &irregular[first..], of_lanes };
            let there = self.enter_tiny(set, &triangles, &seen, patches, cells);
            for lane in Bits(there) {
                let patch = patches.patch(lane, irregular[first + lane]);
                self.enter_small(set, (first + lane) as u32, &patch, &seen, cells);
            }
        }
        for (number, (large, &irregular)) in (small..).zip(large.into_iter().zip(&irregular[small..])) {
            let flags = if large.is_on_one_side { 0 } else { Item::IN_SPACE };
            for place in (0..AREA as usize).step_by(BLOCK) {
                let (x, y) = (place as u32 / 16 % 2, place as u32 / 32);
                let block = [corner[0] + x * BLOCK_EDGE, corner[1] + y * BLOCK_EDGE];
                let Some((patch, key)) = large.on_block(irregular, block) else { continue };
                let keys = seen.block(place);
                if any_above(keys, key) {
                    let mut sixteen = Sixteen::default();
                    let live = sixteen.fill(set, &patch, block, keys, key);
                    cells.enter_block(place, number as u32, flags, &sixteen, live);
                }
            }
        }
    }
}

impl Lister<'_> {
    /// Enters those of sixteen triangles that touch a handful of cells, cell by cell, and returns a bit for each of the others.
    #[inline(always)]
    fn enter_tiny(
        &self,
        set: InstructionSet,
        triangles: &Triangles,
        seen: &Seen,
        patches: &Patches,
        cells: &mut CellLists,
    ) -> u32 {
        let Triangles { first, count, irregular, of_lanes: facing } = triangles;
        let (mut tiny, mut others, mut most) = (0u32, 0u32, [0, 0]);
        let mut of_lanes = [0; LANES];
        for lane in 0..*count {
            of_lanes[lane] = u32::from(irregular[lane]);
            let [width, height] = patches.size(lane);
            if facing[lane] == Facing::Nothing {
                continue;
            }
            if width <= MOST_TINY && height <= MOST_TINY {
                tiny |= 1 << lane;
                most = [width.max(most[0]), height.max(most[1])];
            } else {
                others |= 1 << lane;
            }
        }
        let (mut sixteen, mut places) = (Sixteen::default(), [0; LANES]);
        for y in 0..most[1] {
            for x in 0..most[0] {
                let live = patches.in_cell(set, [x, y], seen, &of_lanes, &mut sixteen, &mut places);
                for lane in Bits(live & tiny) {
                    let item = Item::new(first + lane as u32, sixteen.flags[lane]);
                    cells.enter(places[lane] as usize, item, sixteen.near[lane], sixteen.far[lane]);
                }
            }
        }
        others
    }

    #[inline(always)]
    fn enter_small(
        &self,
        set: InstructionSet,
        triangle: u32,
        patch: &Patch,
        seen: &Seen,
        cells: &mut CellLists,
    ) {
        let key = Horizon::key(patch.w_limits[1]);
        let block_of = |cell: u32, corner: u32| (cell & !(BLOCK_EDGE - 1)).max(corner);
        let last = |cell: u32, corner: u32| cell.min(corner + EDGE - 1);
        let [cx, cy] = seen.corner;
        for y in (block_of(patch.cells.y[0], cy)..=last(patch.cells.y[1], cy)).step_by(BLOCK_EDGE as usize) {
            for x in
                (block_of(patch.cells.x[0], cx)..=last(patch.cells.x[1], cx)).step_by(BLOCK_EDGE as usize)
            {
                let place = TileGrid::place(x, y) as usize;
                let keys = seen.block(place);
                if any_above(keys, key) {
                    let mut sixteen = Sixteen::default();
                    let live = sixteen.fill(set, patch, [x, y], keys, key);
                    cells.enter_block(place, triangle, 0, &sixteen, live);
                }
            }
        }
    }
}

#[inline(always)]
fn list_body(
    set: InstructionSet,
    listers: &[Lister<'_>],
    states: Option<&States>,
    tiles: &[Stored],
    first_cell: usize,
    scratch: &mut Scratch,
    part: &mut Part<'_>,
) {
    for (i, &Stored { level, tile }) in tiles.iter().enumerate() {
        let lister = &listers[level as usize];
        if lister.bins.iter().all(|bins| bins.is_empty(tile)) {
            continue;
        }
        let first = i * AREA as usize;
        lister.enter(set, tile, first_cell + first, scratch);
        part.entries += scratch.cells.count() as u64;
        let (side, corner) = lister.windows.corner(tile);
        let Scratch { triangles, numbers, irregular, edges, cells, entries, judge, .. } = scratch;
        if states.is_some() {
            judge.begin(numbers.len());
        }
        let of_tile = TileTriangles {
            scene: lister.scene,
            projector: &lister.projector,
            projected: lister.projected,
            face: Face::ALL[side as usize],
            numbers,
            vertices: triangles,
            irregular,
        };
        for place in 0..AREA as usize {
            let [column, row] = TileGrid::cell(place as u32);
            let cell = Cell {
                tile: &of_tile,
                lists: cells,
                place,
                at: [corner[0] + column, corner[1] + row],
                horizon: lister.horizon.of(first_cell + first + place),
            };
            let judging = states.map(|_| Judging { set, judge, edges });
            (part.headers[first + place], part.runs[first + place]) =
                certify(&cell, entries, &mut part.records, &mut part.kinds, judging);
        }
        if let Some(states) = states {
            judge.end(numbers, states);
        }
        let records = part.records.capacity() * size_of::<Record>();
        let scratch_bytes = scratch.bytes();
        part.overflowed = !lister.budget.grant(&mut scratch.granted, scratch_bytes)
            || !lister.budget.grant(&mut part.granted, records);
        if part.overflowed {
            return;
        }
    }
}

for_instruction_sets! {
    /// Makes headers and lists of tiles whose cells follow each other, the first of which is `first_cell`.
    pub(super) fn list = list_body, (
        listers: &[Lister<'_>],
        states: Option<&States>,
        tiles: &[Stored],
        first_cell: usize,
        scratch: &mut Scratch,
        part: &mut Part<'_>,
    )
}
