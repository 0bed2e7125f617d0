//! Queries that headers leave open against the list of their cell, sixteen at a time.

use super::block::{bits, each_bit};
use super::cell_lists::Item;
use super::certificate::Record;
use super::dispatch::for_instruction_sets;
use super::projection::{Projected, Projector, ROUNDOFF, larger, smaller};
use super::tiles::BLOCK;
use crate::geometry::LightSpace;
use crate::geometry::occlusion::PreciseQuery;
use crate::scene::{PrimitiveIndex, Scene};
use crate::shadow::{Counters, precise};
use crate::visibility::SurfacePoint;

/// Queries that walk together.
pub(super) const LANES: usize = BLOCK;

/// Records whose triangles are looked up together.
const GROUP: usize = 8;

/// What all queries of a light share.
pub(super) struct Walk<'a> {
    pub scene: &'a Scene,
    pub projector: &'a Projector,
    pub space: &'a LightSpace,
    pub points: &'a [SurfacePoint],
    /// The scene's vertices.
    pub projected: &'a [Projected],
}

impl Walk<'_> {
    /// Corners of the first triangles of a list.
    #[inline(always)]
    fn corners(&self, records: &[Record]) -> [[Projected; 3]; GROUP] {
        std::array::from_fn(|i| match records.get(i) {
            Some(record) => {
                let triangle = &self.scene.triangles[record.item.triangle() as usize];
                triangle.vertices.map(|vertex| self.projected[vertex as usize])
            }
            None => Default::default(),
        })
    }
}

/// Queries of one cell, at most [`LANES`] of them, and its list. The number of a query is in the lower half.
#[derive(Debug, Clone, Copy)]
pub(super) struct Portion<'a> {
    pub queries: &'a [u64],
    pub records: &'a [Record],
}

/// Portions that are walked together.
pub(super) const PORTIONS: usize = 16;

/// Sixteen receivers on one side; those that are not there repeat the last.
#[derive(Debug, Default)]
struct Lanes {
    u: [f32; LANES],
    v: [f32; LANES],
    /// At most w, and at least.
    w_low: [f32; LANES],
    w_high: [f32; LANES],
    /// What a difference of u or v with a vertex's is wrong by, but for its rounding.
    delta: [f32; LANES],
    base: [u32; LANES],
    /// Their side, if all are on one and within the range of f32.
    side: Option<u32>,
}

impl Lanes {
    #[inline(always)]
    fn new(walk: &Walk<'_>, queries: &[u64]) -> Lanes {
        let mut lanes = Lanes::default();
        let mut sides = [Projected::NOWHERE; LANES];
        for i in 0..LANES {
            let query = queries[i.min(queries.len() - 1)] as u32 as usize;
            let point = &walk.points[query];
            let at = point.position.as_vec3().to_array();
            let p = walk.projector.project(at);
            let size = at[0].abs().max(at[1].abs()).max(at[2].abs());
            let error = walk.projector.error_of(size, p.w);
            // Beyond, the point may lie anywhere.
            let is_near = (p.side != Projected::NOWHERE) & (error < 0.5);
            sides[i] = if is_near { p.side } else { Projected::NOWHERE };
            (lanes.u[i], lanes.v[i]) = (p.u, p.v);
            lanes.delta[i] = walk.projector.delta_of(size, p.w) + walk.projector.delta;
            (lanes.w_low[i], lanes.w_high[i]) = match is_near {
                true => (p.w * (1.0 - error), p.w * (1.0 + error)),
                false => (0.0, f32::INFINITY),
            };
            lanes.base[i] = point.primitive().unwrap_or(PrimitiveIndex::MAX);
        }
        let is_one = sides.iter().all(|&side| side == sides[0]) && sides[0] != Projected::NOWHERE;
        lanes.side = is_one.then_some(sides[0]);
        lanes
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
    fn on(&self, triangle: u32) -> u32 {
        bits(&std::array::from_fn(|i| u32::from(self.base[i] == triangle)))
    }

    /// Lanes that a triangle on their side certainly blocks, and those that it may.
    ///
    /// E of an edge from p to q at a receiver (x, y): du and dv are wrong by 2.2 delta, x - p.u and y - p.v by
    /// 1.1 of the sum of both deltas, d; E by 2.2 d (|x - p.u| + |y - p.v|) + 1.1 d (|du| + |dv|) + 2.5 d^2 and
    /// roundings of 3 r of each product, which r R = delta / 5 bounds: 3 d of all and 6 d^2. With all three of one sign the
    /// weights E / A are from 0 to 1 and wrong by twice the sum of the three bounds over A together, or A is so
    /// small that this is more than 1; w of the triangle is wrong by that times the range of w at its corners, and by less
    /// than 32 r of itself.
    #[inline(always)]
    fn against(&self, [a, b, c]: [Projected; 3], near: f32) -> (u32, u32) {
        let corners = [a, b, c];
        let edges: [[f32; 3]; 3] = std::array::from_fn(|j| {
            let (p, q) = (corners[j], corners[(j + 1) % 3]);
            let (du, dv) = (q.u - p.u, q.v - p.v);
            [du, dv, du.abs() + dv.abs()]
        });
        let range = larger(larger(a.w, b.w), c.w) - smaller(smaller(a.w, b.w), c.w);
        let (mut blocked, mut open) = ([0u32; LANES], [0u32; LANES]);
        for i in 0..LANES {
            let d = self.delta[i];
            let (mut e, mut slack) = ([0f32; 3], [0f32; 3]);
            for j in 0..3 {
                let (x, y) = (self.u[i] - corners[j].u, self.v[i] - corners[j].v);
                let [du, dv, length] = edges[j];
                e[j] = du * y - dv * x;
                slack[j] = (3.0 * d) * ((length + x.abs()) + (y.abs() + 2.0 * d));
            }
            let above = [e[0] > slack[0], e[1] > slack[1], e[2] > slack[2]];
            let below = [e[0] < -slack[0], e[1] < -slack[1], e[2] < -slack[2]];
            let is_outside = (above[0] | above[1] | above[2]) & (below[0] | below[1] | below[2]);
            let is_inside = (above[0] & above[1] & above[2]) | (below[0] & below[1] & below[2]);
            let area = e[0] + e[1] + e[2];
            let w = (e[1] * a.w + e[2] * b.w + e[0] * c.w) / area;
            let wrong = range * (2.0 * (slack[0] + slack[1] + slack[2]) / area.abs()) + w * (32.0 * ROUNDOFF);
            let is_before = w - wrong > self.w_high[i];
            let is_behind = (is_inside & (w + wrong < self.w_low[i])) | (near < self.w_low[i]);
            blocked[i] = u32::from(is_inside & is_before);
            open[i] = u32::from(!(is_outside | is_behind | (is_inside & is_before)));
        }
        (bits(&blocked), bits(&open))
    }
}

#[inline(always)]
fn walk_body(walk: &Walk<'_>, portions: &[Portion<'_>], occluded: &mut Vec<u32>, counters: &mut Counters) {
    // All queries first and then all first triangles, so that what has to be fetched is not waited for one by one.
    let mut lanes: [Lanes; PORTIONS] = Default::default();
    let mut corners = [[Default::default(); GROUP]; PORTIONS];
    for (lanes, portion) in lanes.iter_mut().zip(portions) {
        *lanes = Lanes::new(walk, portion.queries);
    }
    for (corners, portion) in corners.iter_mut().zip(portions) {
        *corners = walk.corners(portion.records);
    }
    for ((portion, lanes), &corners) in portions.iter().zip(&lanes).zip(&corners) {
        walk_one(walk, portion, lanes, corners, occluded, counters);
    }
}

#[inline(always)]
fn walk_one(
    walk: &Walk<'_>,
    portion: &Portion<'_>,
    lanes: &Lanes,
    first_corners: [[Projected; 3]; GROUP],
    occluded: &mut Vec<u32>,
    counters: &mut Counters,
) {
    let Portion { queries, records } = *portion;
    let mut live = u32::MAX >> (32 - queries.len());
    let mut lowest = lanes.lowest(live);
    for (number, group) in records.chunks(GROUP).enumerate() {
        let corners = if number == 0 { first_corners } else { walk.corners(group) };
        for (record, corners) in group.iter().zip(corners) {
            // Nothing further on can be before any of them.
            if record.near < lowest || live == 0 {
                return;
            }
            let triangle = record.item.triangle();
            // Nothing blocks what lies in its plane.
            let asked = live & !lanes.on(triangle);
            counters.tests += u64::from(asked.count_ones());
            let is_flat = !record.item.has(Item::IN_SPACE) && lanes.side == Some(corners[0].side);
            let (blocked, open) = match is_flat {
                true => lanes.against(corners, record.near),
                false => (0, u32::MAX),
            };
            let (mut blocked, open) = (blocked & asked, open & asked);
            each_bit(open, |lane| {
                if record.near >= lanes.w_low[lane] {
                    counters.undecided += 1;
                    blocked |= u32::from(blocks(walk, queries[lane] as u32, triangle, counters)) << lane;
                }
            });
            if blocked != 0 {
                each_bit(blocked, |lane| occluded.push(queries[lane] as u32));
                live &= !blocked;
                lowest = lanes.lowest(live);
            }
        }
    }
}

for_instruction_sets! {
    /// Adds those queries of at most [`PORTIONS`] portions to `occluded` that something in their lists blocks.
    pub(super) fn walk = walk_body, (
        walk: &Walk<'_>,
        portions: &[Portion<'_>],
        occluded: &mut Vec<u32>,
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
