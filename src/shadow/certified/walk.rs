//! Queries that headers leave open against the list of their cell, sixteen triangles at a time.

use super::blockers::{Blockers, Extent, Verdict};
use super::making::Lists;
use super::open::Open;
use super::pairs::Pairs;
use super::projection::Projected;
use super::stored::{Record, UNSORTED};
use crate::geometry::LightSpace;
use crate::geometry::batch::{InstructionSet, LANES};
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::geometry::masks::Bits;
use crate::scene::Scene;
use crate::shadow::Counters;
use crate::visibility::SurfacePoint;
use glam::Vec3;

/// What all queries of a light share.
pub(super) struct Walk<'a> {
    pub scene: &'a Scene,
    pub light: Vec3,
    pub space: &'a LightSpace,
    pub points: &'a [SurfacePoint],
    /// The scene's vertices.
    pub projected: &'a [Projected],
    pub lists: &'a Lists,
    /// Of the projector.
    pub delta: f32,
}

/// Queries of one cell, and its list.
#[derive(Clone, Copy)]
struct Portion<'a> {
    /// Keys of open queries.
    keys: &'a [u64],
    records: &'a [Record],
}

/// Lists are read from memory so many portions ahead, triangles half as many.
const AHEAD: usize = 8;

/// Records in a line of the cache.
const RECORDS_OF_A_LINE: usize = 64 / size_of::<Record>();

/// Records of a list that are fetched ahead.
const FETCHED: usize = 16;

impl<'a> Walk<'a> {
    /// The open queries of each cell, in the order of their keys.
    fn portions(&self, keys: &'a [u64]) -> Vec<Portion<'a>> {
        let mut portions = Vec::with_capacity(keys.len());
        for keys in keys.chunk_by(|a, b| a >> 32 == b >> 32) {
            portions.push(Portion { keys, records: self.lists.of((keys[0] >> 32) as usize) });
        }
        portions
    }

    /// Has what some portions later on need fetched.
    #[inline(always)]
    fn fetch_ahead(&self, portions: &[Portion]) {
        if let Some(portion) = portions.get(2 * AHEAD) {
            portion.records.iter().take(FETCHED).step_by(RECORDS_OF_A_LINE).for_each(fetch);
        }
        if let Some(portion) = portions.get(AHEAD) {
            for record in portion.records.iter().take(FETCHED) {
                fetch(&self.scene.triangles[record.listed.triangle() as usize]);
            }
        }
        if let Some(portion) = portions.get(AHEAD / 2) {
            for record in portion.records.iter().take(FETCHED) {
                let vertices = self.scene.triangles[record.listed.triangle() as usize].vertices;
                vertices.into_iter().for_each(|vertex| fetch(&self.projected[vertex as usize]));
            }
        }
    }
}

/// The places of one cell after the other.
#[derive(Default)]
struct Places {
    blockers: Blockers,
    /// What is left open, of all cells.
    pairs: Pairs,
    /// Queries that are not dark yet.
    live: Vec<Open>,
}

/// All queries of one cell against its list, sixteen triangles at a time.
#[inline(always)]
fn walk_one(
    set: InstructionSet,
    walk: &Walk<'_>,
    list: &[Record],
    Places { blockers, pairs, live }: &mut Places,
    occluded: &mut [bool],
    counters: &mut Counters,
) {
    for records in list.chunks(LANES) {
        let extent = Extent::of(live);
        // Nothing further on can be before any of them, where there is an order.
        if live.is_empty() || (list.len() > UNSORTED && records[0].near < extent.lowest) {
            return;
        }
        counters.tests += (records.len() * live.len()) as u64;
        blockers.fill(walk.scene, walk.projected, records, &extent, walk.delta);
        // Without a branch on what nobody can foresee.
        let mut left = 0;
        for i in 0..live.len() {
            let Verdict { blocked, open } = blockers.against(set, &live[i]);
            let query = live[i];
            let is_dark = blocked != 0;
            if open != 0 && !is_dark {
                for lane in Bits(open) {
                    pairs.push(walk, query.query, blockers.triangle(lane));
                }
            }
            occluded[query.query as usize] |= is_dark;
            live[left] = query;
            left += usize::from(!is_dark);
        }
        live.truncate(left);
    }
}

#[inline(always)]
fn walk_body(
    set: InstructionSet,
    walk: &Walk<'_>,
    open: &[Open],
    keys: &[u64],
    occluded: &mut [bool],
    counters: &mut Counters,
) {
    let mut places = Places::default();
    let mut first = 0;
    let portions = walk.portions(keys);
    for (number, portion) in portions.iter().enumerate() {
        walk.fetch_ahead(&portions[number..]);
        places.live.clear();
        places.live.extend_from_slice(&open[first..first + portion.keys.len()]);
        first += portion.keys.len();
        walk_one(set, walk, portion.records, &mut places, occluded, counters);
        if places.pairs.are_many() {
            places.pairs.decide(set, walk, occluded, counters);
        }
    }
    places.pairs.decide(set, walk, occluded, counters);
}

for_instruction_sets! {
    /// Sets those of `occluded` that something in the list of their cell blocks. The cell of each open query is in the upper half of its key; those of a cell should
    /// follow each other.
    pub(super) fn walk = walk_body, (
        walk: &Walk<'_>,
        open: &[Open],
        keys: &[u64],
        occluded: &mut [bool],
        counters: &mut Counters,
    )
}
