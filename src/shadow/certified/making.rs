//! Headers and lists of all cells: triangles by tile, and the tiles one after the other, on all threads.

use super::bins::{Bins, Budget};
use super::by_triangle::States;
use super::certificate::Kinds;
use super::lists::{self, Lister, Part, Scratch, Stored};
use super::stored::{Header, Record, Run};
use super::survey::{self, Survey};
use super::tiles::AREA;
use super::{Certified, Work, is_plain};
use crate::float_environment::StandardFloats;
use crate::geometry::fetch::fetch;
use crate::shadow::duplicates::duplicates;
use rayon::iter::repeat_n;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Tiles of a task.
const TILES: usize = 64;
/// Cells of a task.
const CELLS: usize = TILES * AREA as usize;
/// Triangles that a worker takes at a time.
const TRIANGLES: usize = 2048;
/// Workers that keep lists of their own: each has a number for every tile.
const MOST_WORKERS: usize = 16;
/// Tiles that a triangle is entered in, at the mean, before duplicates are looked for: a look-up each costs less.
const FEW_TILES: usize = 16;
/// At least what a triangle takes among those that were seen: a key, in a table of which a half may be empty, and whether it is one.
const BYTES_OF_A_KEY: usize = 2 * size_of::<[[u32; 3]; 3]>() + 8;

/// Headers and lists of all cells.
pub(super) struct Lists {
    pub headers: Vec<Header>,
    /// The side of each tile of cells.
    sides: Vec<u8>,
    runs: Vec<Run>,
    /// Of [`CELLS`] cells each.
    records: Vec<Vec<Record>>,
    kinds: Kinds,
    /// Triangles in cells.
    entries: u64,
}

impl Lists {
    /// The list of a cell, nearest first if it is longer than [`UNSORTED`](super::stored::UNSORTED).
    pub fn of(&self, cell: usize) -> &[Record] {
        let run = self.runs[cell];
        &self.records[cell / CELLS][run.start as usize..][..run.length as usize]
    }

    /// Has it fetched where the list of a cell is.
    #[inline(always)]
    pub fn fetch(&self, cell: usize) {
        fetch(&self.runs[cell]);
    }

    /// Has the list of a cell fetched, up to a few lines of the cache.
    #[inline(always)]
    pub fn fetch_records(&self, cell: usize) {
        self.of(cell).iter().step_by(64 / size_of::<Record>()).take(4).for_each(fetch);
    }

    /// The side of a cell.
    #[inline(always)]
    pub fn side_of(&self, cell: u32) -> u32 {
        u32::from(self.sides[(cell / AREA) as usize])
    }

    /// What making them took.
    pub fn work(&self, resolution: u32) -> Work {
        Work {
            resolution,
            cells: self.headers.len() as u64,
            touched: self.kinds.touched,
            once: self.kinds.once,
            covered: self.kinds.covered,
            entries: self.entries,
            ..Work::default()
        }
    }

    /// Gives back what was allotted and is not needed.
    pub fn shrink(&mut self) {
        self.records.par_iter_mut().for_each(Vec::shrink_to_fit);
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        let records: usize = self.records.iter().map(Vec::capacity).sum();
        size_of_val(&self.headers[..]) + size_of_val(&self.runs[..]) + records * size_of::<Record>()
    }
}

impl Certified<'_> {
    /// Triangles by tile, or `None` if there are too many. Duplicates are looked for, and left out, where triangles are entered so
    /// often that it costs little beside.
    pub(super) fn bins<'b>(&self, survey: &mut Survey<'_>, budget: &'b Budget) -> Option<Vec<Bins<'b>>> {
        let most_callers = FEW_TILES * self.scene.triangles.len();
        if let Some(bins) = self.bins_of_all(survey, budget, most_callers) {
            return Some(bins);
        }
        let mut granted = 0;
        if budget.grant(&mut granted, self.scene.triangles.len() * BYTES_OF_A_KEY) {
            survey.duplicates = duplicates(self.scene, |triangle| is_plain(self.scene, triangle));
        }
        budget.give_back(granted);
        self.bins_of_all(survey, budget, usize::MAX)
    }

    /// What all triangles but those that are left out are entered in, or `None` if there is too much of it.
    fn bins_of_all<'b>(
        &self,
        survey: &Survey<'_>,
        budget: &'b Budget,
        most_callers: usize,
    ) -> Option<Vec<Bins<'b>>> {
        let count = self.scene.triangles.len();
        let next = AtomicUsize::new(0);
        let worker = |_| {
            let _floats = StandardFloats::new();
            let mut bins = Bins::new(&survey.windows, budget, most_callers);
            loop {
                let first = next.fetch_add(TRIANGLES, Relaxed);
                if first >= count || bins.overflowed {
                    return bins;
                }
                let end = count.min(first + TRIANGLES);
                survey::survey(self.set, survey, first as u32..end as u32, &mut bins);
            }
        };
        let workers = rayon::current_num_threads().min(MOST_WORKERS);
        let bins: Vec<_> = (0..workers).into_par_iter().with_max_len(1).map(worker).collect();
        bins.iter().all(|bins| !bins.overflowed).then_some(bins)
    }

    /// Lists of all cells of some tiles, or `None` if they are too long.
    pub(super) fn lists(
        &self,
        listers: &[Lister<'_>],
        states: Option<&States>,
        tiles: &[Stored],
    ) -> Option<Lists> {
        let cells = tiles.len() * AREA as usize;
        // On all threads, since the pages are new.
        let mut headers: Vec<Header> = repeat_n(Header::EMPTY, cells).collect();
        let mut runs: Vec<Run> = repeat_n(Run::default(), cells).collect();
        let parts: Vec<Part> = headers
            .par_chunks_mut(CELLS)
            .zip(runs.par_chunks_mut(CELLS))
            .zip(tiles.par_chunks(TILES))
            .enumerate()
            .map_init(Scratch::new, |scratch, (part, ((headers, runs), tiles))| {
                let _floats = StandardFloats::new();
                let mut of_part = Part::new(headers, runs);
                lists::list(self.set, listers, states, tiles, part * CELLS, scratch, &mut of_part);
                of_part
            })
            .collect();
        if parts.iter().any(|part| part.overflowed) {
            return None;
        }
        let (mut kinds, mut entries, mut records) = (Kinds::default(), 0, Vec::new());
        for part in parts {
            kinds += part.kinds;
            entries += part.entries;
            records.push(part.records);
        }
        let side = |stored: &Stored| listers[stored.level as usize].windows.corner(stored.tile).0 as u8;
        let sides = tiles.iter().map(side).collect();
        Some(Lists { headers, sides, runs, records, kinds, entries })
    }
}
