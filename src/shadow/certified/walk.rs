//! Queries that headers leave open against the list of their cell, sixteen at a time.

use super::cell_lists::Item;
use super::certificate::Record;
use super::making::Lists;
use super::open::Open;
use super::projection::{Projected, ROUNDOFF, larger, smaller};
use super::tiles::BLOCK;
use crate::geometry::LightSpace;
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::geometry::masks::{bits, each_bit};
use crate::geometry::occlusion::PreciseQuery;
use crate::scene::Scene;
use crate::shadow::{Counters, precise};
use crate::visibility::SurfacePoint;

/// Queries that walk together.
const LANES: usize = BLOCK;

/// What all queries of a light share.
pub(super) struct Walk<'a> {
    pub scene: &'a Scene,
    pub space: &'a LightSpace,
    pub points: &'a [SurfacePoint],
    /// The scene's vertices.
    pub projected: &'a [Projected],
    pub lists: &'a Lists,
    /// Of the projector.
    pub delta: f32,
}

/// Queries of one cell, at most [`LANES`], and its list.
#[derive(Clone, Copy)]
struct Portion<'a> {
    /// Keys of open queries.
    keys: &'a [u64],
    records: &'a [Record],
}

/// Lists are read from memory so many portions ahead, triangles half as many.
const AHEAD: usize = 8;

/// Records of a list that are fetched ahead.
const FETCHED: usize = 12;

impl<'a> Walk<'a> {
    /// The open queries of each cell in portions, in the order of their keys.
    fn portions(&self, keys: &'a [u64]) -> Vec<Portion<'a>> {
        let mut portions = Vec::with_capacity(keys.len());
        for of_cell in keys.chunk_by(|a, b| a >> 32 == b >> 32) {
            let records = self.lists.of((of_cell[0] >> 32) as usize);
            portions.extend(of_cell.chunks(LANES).map(|keys| Portion { keys, records }));
        }
        portions
    }

    /// Has what some portions later on need fetched.
    #[inline(always)]
    fn fetch_ahead(&self, portions: &[Portion], open: &[Open]) {
        if let Some(portion) = portions.get(2 * AHEAD) {
            portion.records.iter().take(1).for_each(fetch);
        }
        if let Some(portion) = portions.get(AHEAD) {
            portion.keys.iter().for_each(|&key| fetch(&open[key as u32 as usize]));
            for record in portion.records.iter().take(FETCHED) {
                fetch(&self.scene.triangles[record.item.triangle() as usize]);
            }
        }
        if let Some(portion) = portions.get(AHEAD / 2) {
            for record in portion.records.iter().take(FETCHED) {
                let vertices = self.scene.triangles[record.item.triangle() as usize].vertices;
                vertices.into_iter().for_each(|vertex| fetch(&self.projected[vertex as usize]));
            }
        }
    }
}

/// Sixteen receivers of one cell; those that are not there repeat the first.
#[derive(Debug)]
struct Lanes {
    u: [f32; LANES],
    v: [f32; LANES],
    /// At most w, and at least.
    w_low: [f32; LANES],
    w_high: [f32; LANES],
    base: [u32; LANES],
    query: [u32; LANES],
    /// Lanes about whose place f32 knows nothing.
    lost: u32,
    /// Limits of u and of v of the others.
    u_limits: [f32; 2],
    v_limits: [f32; 2],
}

impl Lanes {
    const NONE: Lanes = Lanes {
        u: [0.0; LANES],
        v: [0.0; LANES],
        w_low: [0.0; LANES],
        w_high: [0.0; LANES],
        base: [0; LANES],
        query: [0; LANES],
        lost: 0,
        u_limits: [0.0; 2],
        v_limits: [0.0; 2],
    };

    #[inline(always)]
    fn fill<'o>(&mut self, queries: impl Iterator<Item = &'o Open>) {
        self.lost = 0;
        (self.u_limits, self.v_limits) =
            ([f32::INFINITY, f32::NEG_INFINITY], [f32::INFINITY, f32::NEG_INFINITY]);
        for (i, open) in queries.enumerate() {
            (self.u[i], self.v[i]) = (open.u, open.v);
            (self.w_low[i], self.w_high[i]) = (open.w_low, open.w_high);
            (self.base[i], self.query[i]) = (open.base, open.query);
            if open.is_lost {
                self.lost |= 1 << i;
                continue;
            }
            self.u_limits = [smaller(open.u, self.u_limits[0]), larger(open.u, self.u_limits[1])];
            self.v_limits = [smaller(open.v, self.v_limits[0]), larger(open.v, self.v_limits[1])];
        }
    }

    /// At most the w of any of some lanes.
    #[inline(always)]
    fn lowest(&self, lanes: u32) -> f32 {
        let mut lowest = f32::INFINITY;
        for i in 0..LANES {
            let w = if lanes >> i & 1 == 1 { self.w_low[i] } else { f32::INFINITY };
            lowest = smaller(w, lowest);
        }
        lowest
    }

    /// Lanes that lie on a triangle.
    #[inline(always)]
    fn on(&self, set: InstructionSet, triangle: u32) -> u32 {
        let mut on = [0u32; LANES];
        for (on, &base) in on.iter_mut().zip(&self.base) {
            *on = u32::from(base == triangle);
        }
        bits(set, &on)
    }

    /// Of some lanes those that a triangle on their side certainly blocks, and those that it may.
    ///
    /// E of an edge from p to q at a receiver (x, y): x - p.u and y - p.v are wrong by d, a quarter above delta
    /// ([`Open::new`]), du and dv by 2 delta, which is 1.6 d; E by 1.6 d (|x - p.u| + |y - p.v|) + d (|du| + |dv|) + 3.2 d^2.
    /// Roundings are 4 r of each product, where r R is 0.16 d: 0.64 d of the first sum. So 2.5 d of that,
    /// 1.25 d of the second and 4 d^2 are enough, for the largest differences of all lanes. With all three of one sign the
    /// weights E / A are from 0 to 1 and wrong by twice the sum of the three bounds over A together, or A is so small that
    /// this is more than 1; w of the triangle is wrong by that times the range of w at its corners, and by less than 32 r
    /// of itself.
    #[inline(always)]
    fn against(
        &self,
        set: InstructionSet,
        asked: u32,
        triangle: u32,
        corners: [&Projected; 3],
        near: f32,
        delta: f32,
    ) -> (u32, u32) {
        let d = 1.25 * delta;
        let [a, b, c] = corners;
        let mut edges = [[0f32; 5]; 3];
        for j in 0..3 {
            let (p, q) = (corners[j], corners[if j == 2 { 0 } else { j + 1 }]);
            let (du, dv) = (q.u - p.u, q.v - p.v);
            let x = larger(p.u - self.u_limits[0], self.u_limits[1] - p.u);
            let y = larger(p.v - self.v_limits[0], self.v_limits[1] - p.v);
            let slack = d * (1.25 * (du.abs() + dv.abs()) + 2.5 * (x + y) + 4.0 * d);
            edges[j] = [p.u, p.v, du, dv, slack];
        }
        let mut e = [[0f32; LANES]; 3];
        let (mut outside, mut inside) = ([0u32; LANES], [0u32; LANES]);
        for i in 0..LANES {
            let (mut is_above, mut is_below) = ([false; 3], [false; 3]);
            for (j, &[pu, pv, du, dv, slack]) in edges.iter().enumerate() {
                let value = du * (self.v[i] - pv) - dv * (self.u[i] - pu);
                e[j][i] = value;
                is_above[j] = value > slack;
                is_below[j] = value < -slack;
            }
            let any = |of: [bool; 3]| of[0] | of[1] | of[2];
            let all = |of: [bool; 3]| of[0] & of[1] & of[2];
            outside[i] = u32::from(any(is_above) & any(is_below));
            inside[i] = u32::from(all(is_above) | all(is_below));
        }
        let met = asked & !bits(set, &outside);
        if met == 0 {
            return (0, 0);
        }
        // Nothing blocks what lies in its plane.
        let met = met & !self.on(set, triangle);
        if met == 0 {
            return (0, 0);
        }
        let range = larger(larger(a.w, b.w), c.w) - smaller(smaller(a.w, b.w), c.w);
        let twice = 2.0 * range * ((edges[0][4] + edges[1][4]) + edges[2][4]);
        let (mut blocked, mut behind) = ([0u32; LANES], [0u32; LANES]);
        for i in 0..LANES {
            let per_area = 1.0 / ((e[0][i] + e[1][i]) + e[2][i]);
            let w = ((e[1][i] * a.w + e[2][i] * b.w) + e[0][i] * c.w) * per_area;
            let wrong = twice * per_area.abs() + w * (32.0 * ROUNDOFF);
            let is_inside = inside[i] == 1;
            blocked[i] = u32::from(is_inside & (w - wrong > self.w_high[i]));
            behind[i] = u32::from((is_inside & (w + wrong < self.w_low[i])) | (near < self.w_low[i]));
        }
        let blocked = met & bits(set, &blocked);
        (blocked, met & !blocked & !bits(set, &behind))
    }
}

/// One portion of a cell's queries.
#[inline(always)]
fn walk_one(
    set: InstructionSet,
    walk: &Walk<'_>,
    records: &[Record],
    lanes: &Lanes,
    count: usize,
    occluded: &mut [bool],
    counters: &mut Counters,
) {
    let mut live = u32::MAX >> (32 - count);
    let mut lowest = lanes.lowest(live);
    for record in records {
        // Nothing further on can be before any of them.
        if record.near < lowest {
            return;
        }
        counters.tests += u64::from(live.count_ones());
        let triangle = record.item.triangle();
        let (mut blocked, open) = match record.item.has(Item::IN_SPACE) {
            true => (0, live & !lanes.on(set, triangle)),
            false => {
                let [a, b, c] = walk.scene.triangles[triangle as usize].vertices;
                let corners = [a, b, c].map(|vertex| &walk.projected[vertex as usize]);
                let placed = live & !lanes.lost;
                let (blocked, open) = lanes.against(set, placed, triangle, corners, record.near, walk.delta);
                let lost = live & lanes.lost;
                (blocked, if lost == 0 { open } else { open | lost & !lanes.on(set, triangle) })
            }
        };
        each_bit(open, |lane| {
            if record.near >= lanes.w_low[lane] {
                counters.undecided += 1;
                blocked |= u32::from(blocks(walk, lanes.query[lane], triangle, counters)) << lane;
            }
        });
        if blocked != 0 {
            each_bit(blocked, |lane| occluded[lanes.query[lane] as usize] = true);
            live &= !blocked;
            if live == 0 {
                return;
            }
            lowest = lanes.lowest(live);
        }
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
    let mut lanes = Lanes::NONE;
    let portions = walk.portions(keys);
    for (number, portion) in portions.iter().enumerate() {
        walk.fetch_ahead(&portions[number..], open);
        lanes.fill(portion.keys.iter().map(|&key| &open[key as u32 as usize]));
        walk_one(set, walk, portion.records, &lanes, portion.keys.len(), occluded, counters);
    }
}

for_instruction_sets! {
    /// Sets those of `occluded` that something in the list of their cell blocks. In the lower half of a key is the place of an
    /// open query, in the upper half its cell; those of a cell should follow each other.
    pub(super) fn walk = walk_body, (
        walk: &Walk<'_>,
        open: &[Open],
        keys: &[u64],
        occluded: &mut [bool],
        counters: &mut Counters,
    )
}

/// Behind the float filter.
#[cold]
fn blocks(walk: &Walk<'_>, query: u32, triangle: u32, counters: &mut Counters) -> bool {
    let point = &walk.points[query as usize];
    let query = PreciseQuery::new(walk.space, point.position, || point.exact(walk.scene));
    precise::blocks(walk.scene, triangle, point.primitive(), &query, counters)
}
