//! Sixteen triangles of a cell's list against one query at a time.
//!
//! What belongs to the triangles is set up once for all queries of the cell, of which there may be one or hundreds.

use super::open::Open;
use super::projection::{Projected, ROUNDOFF, larger, smaller};
use super::stored::Record;
use crate::geometry::batch::{InstructionSet, LANES};
use crate::geometry::masks::bits;
use crate::scene::Scene;

/// Limits of where some queries are on their side, those left out that f32 cannot place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    /// At most u and v of each, and at most their opposites.
    least: [f32; 4],
    /// At most w of each.
    pub lowest: f32,
}

impl Extent {
    /// Of all these.
    #[inline(always)]
    pub fn of(queries: &[Open]) -> Extent {
        let (mut least, mut lowest) = ([f32::INFINITY; 4], f32::INFINITY);
        for query in queries {
            // What is not a number is left out.
            let of_query = [query.u, query.v, -query.u, -query.v];
            for i in 0..4 {
                least[i] = smaller(of_query[i], least[i]);
            }
            lowest = smaller(query.w_low, lowest);
        }
        Extent { least, lowest }
    }
}

/// Up to sixteen triangles of a list; where fewer are there, others are left over.
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Blockers {
    /// Corners, in the order of the scene.
    u: [[f32; LANES]; 3],
    v: [[f32; LANES]; 3],
    w: [[f32; LANES]; 3],
    /// From each corner to the next.
    du: [[f32; LANES]; 3],
    dv: [[f32; LANES]; 3],
    /// The most that E of each edge is wrong by.
    slack: [[f32; LANES]; 3],
    /// The most that the sum of E times w is wrong by because of it.
    wrong: [f32; LANES],
    /// At least the w of each in the cell.
    near: [f32; LANES],
    triangles: [u32; LANES],
    /// A bit for each that is there.
    present: u32,
}

/// What sixteen triangles do to a query, a bit for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Verdict {
    /// They block it for certain.
    pub blocked: u32,
    /// They may, and are not behind it.
    pub open: u32,
}

impl Blockers {
    /// Takes in some records, at most [`LANES`]. `extent` holds all queries that will be asked about; `delta` is that of the
    /// projector.
    ///
    /// E of an edge from p to q at a receiver (x, y) is du (y - p.v) - dv (x - p.u). x - p.u and y - p.v are wrong by d, a
    /// quarter above delta (`open.rs`), du and dv by 2 delta, which is 1.6 d; E by 1.6 d (|x - p.u| + |y - p.v|) +
    /// d (|du| + |dv|) + 3.2 d^2. Roundings are 4 r of each product, where r R is 0.16 d: 0.64 d of the first sum. So 2.5 d of
    /// that, 1.25 d of the second and 4 d^2 are enough, for the largest differences of all receivers.
    #[inline(always)]
    pub fn fill(
        &mut self,
        scene: &Scene,
        projected: &[Projected],
        records: &[Record],
        extent: &Extent,
        delta: f32,
    ) {
        for (lane, record) in records.iter().enumerate() {
            let triangle = record.listed.triangle();
            let vertices = scene.triangles[triangle as usize].vertices;
            for (corner, vertex) in vertices.into_iter().enumerate() {
                let at = &projected[vertex as usize];
                // No comparison says anything of what does not lie on one side.
                let u = if record.listed.is_in_space() { f32::NAN } else { at.u };
                (self.u[corner][lane], self.v[corner][lane], self.w[corner][lane]) = (u, at.v, at.w);
            }
            (self.near[lane], self.triangles[lane]) = (record.near, triangle);
        }
        self.present = u32::MAX >> (32 - records.len());
        let d = 1.25 * delta;
        for i in 0..LANES {
            let mut sum = 0.0;
            for j in 0..3 {
                let next = if j == 2 { 0 } else { j + 1 };
                let (u, v) = (self.u[j][i], self.v[j][i]);
                let (du, dv) = (self.u[next][i] - u, self.v[next][i] - v);
                let x = larger(u - extent.least[0], -extent.least[2] - u);
                let y = larger(v - extent.least[1], -extent.least[3] - v);
                let slack = d * (1.25 * (du.abs() + dv.abs()) + 2.5 * (x + y) + 4.0 * d);
                (self.du[j][i], self.dv[j][i], self.slack[j][i]) = (du, dv, slack);
                sum += slack;
            }
            let [a, b, c] = [self.w[0][i], self.w[1][i], self.w[2][i]];
            let range = larger(larger(a, b), c) - smaller(smaller(a, b), c);
            self.wrong[i] = 2.0 * range * sum;
        }
    }

    /// What they do to a query.
    ///
    /// With all three E of one sign the weights E / A, where A is their sum, are from 0 to 1 and wrong by twice the sum of the three
    /// bounds over A together, or A is so small that this is more than 1. So the sum of E times w, which is A times the w of
    /// the triangle, is wrong by that sum twice, times the range of w at the corners, and, as all its terms have one sign, by
    /// less than 16 r of itself, roundings of the comparison included.
    #[inline(always)]
    pub fn against(&self, set: InstructionSet, query: &Open) -> Verdict {
        let (mut blocked, mut open) = ([0u32; LANES], [0u32; LANES]);
        for i in 0..LANES {
            let mut e = [0f32; 3];
            // Of E less what it is wrong by, and of E and that: the largest and the smallest.
            let (mut above, mut below) = ([0f32; 3], [0f32; 3]);
            for j in 0..3 {
                e[j] = self.du[j][i] * (query.v - self.v[j][i]) - self.dv[j][i] * (query.u - self.u[j][i]);
                above[j] = e[j] - self.slack[j][i];
                below[j] = e[j] + self.slack[j][i];
            }
            let most = |of: [f32; 3]| larger(larger(of[0], of[1]), of[2]);
            let least = |of: [f32; 3]| smaller(smaller(of[0], of[1]), of[2]);
            let is_outside = (most(above) > 0.0) & (least(below) < 0.0);
            let is_inside = (least(above) > 0.0) | (most(below) < 0.0);
            let area = ((e[0] + e[1]) + e[2]).abs();
            let depth = ((e[1] * self.w[0][i] + e[2] * self.w[1][i]) + e[0] * self.w[2][i]).abs();
            let wrong = self.wrong[i] + depth * (32.0 * ROUNDOFF);
            let is_before = depth - wrong > query.w_high * area;
            let is_behind = (is_inside & (depth + wrong < query.w_low * area)) | (self.near[i] < query.w_low);
            let is_other = self.triangles[i] != query.base;
            blocked[i] = u32::from(is_inside & is_before & is_other);
            open[i] = u32::from(!is_outside & !(is_inside & is_before) & !is_behind & is_other);
        }
        Verdict { blocked: bits(set, &blocked) & self.present, open: bits(set, &open) & self.present }
    }

    /// The triangle of a bit.
    #[inline(always)]
    pub fn triangle(&self, lane: usize) -> u32 {
        self.triangles[lane]
    }
}

#[cfg(test)]
mod tests {
    use super::super::cell_lists::Item;
    use super::super::open::OpenQueries;
    use super::super::projection::Projector;
    use super::super::verdict::{self, Listed};
    use super::*;
    use crate::geometry::occlusion::PreciseQuery;
    use crate::geometry::{ExactPosition, LightSpace};
    use crate::scene::{ObjectInput, SceneBuilder};
    use crate::visibility::{Points, RoundedPoint, SurfacePoint};
    use glam::Vec3;
    use proptest::prelude::*;

    fn in_front() -> impl Strategy<Value = Vec3> {
        (-1.0f32..1.0, -1.0f32..1.0, 1.0f32..3.0).prop_map(Vec3::from)
    }

    fn scene(corners: &[[Vec3; 3]]) -> Scene {
        let mut builder = SceneBuilder::new("blockers");
        let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let vertices = corners.iter().flatten().copied().collect();
        builder.add_object(ObjectInput::new("all", vertices, triangles)).expect("indices in range");
        builder.finish()
    }

    /// Of points in the same cell, on the side that looks along z.
    fn open(set: InstructionSet, projector: &Projector, points: &[Vec3]) -> Vec<Open> {
        let exact: Vec<_> = points.iter().map(|&p| SurfacePoint::bare(p).expect("finite")).collect();
        let rounded = RoundedPoint::all(&exact);
        let mut open = OpenQueries::default();
        (0..exact.len() as u32).for_each(|query| open.push(0, query));
        open.placed(set, projector, Points::new(&rounded, &exact), |_| 4)
    }

    /// Triangles, some of them slivers, and places on the edges of the first, before, on and behind it.
    fn situation() -> impl Strategy<Value = (Vec<[Vec3; 3]>, Vec<Vec3>)> {
        let triangle =
            (in_front(), in_front(), in_front(), prop::sample::select(vec![1.0f32, 0.01, 1e-5, 1e-7]));
        let triangles = prop::collection::vec(
            triangle.prop_map(|(a, b, c, width)| [a, b, a + 0.5 * (b - a) + width * (c - a)]),
            1..=LANES,
        );
        let place = (0.0f32..1.0, prop::sample::select(vec![0.0f32, 1e-6, 1e-3, 0.3]), 0.5f32..1.5);
        (triangles, prop::collection::vec(place, 1..8)).prop_map(|(triangles, places)| {
            let [a, b, c] = triangles[0];
            let near = |(along, aside, depth): (f32, f32, f32)| {
                let on_edge = a + along * (b - a);
                (on_edge + aside * (c - on_edge)) * if depth < 0.9 { 1.0 } else { depth }
            };
            let points = places.into_iter().map(near).collect();
            (triangles, points)
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]
        #[test]
        fn what_is_certain_is_true((triangles, points) in situation(), resolution in prop::sample::select(vec![1u32, 64, 4096])) {
            let scene = scene(&triangles);
            // Defective triangles are dropped.
            prop_assume!(scene.triangles.len() == triangles.len());
            let projector = Projector::new(Vec3::ZERO, resolution);
            let projected: Vec<_> = scene.vertices.iter().map(|p| projector.project(p.to_array())).collect();
            let is_on_the_side = |corners: &[Vec3; 3]| corners.iter().all(|&p| projector.project(p.to_array()).side == 4);
            let records: Vec<_> = (0..).zip(&triangles).filter(|(_, corners)| is_on_the_side(corners)).map(|(number, corners)| {
                let near = corners.iter().fold(0.0, |near, p| f32::max(near, 1.0 / p.z));
                Record { near: near * (1.0 + 8.0 * ROUNDOFF), listed: Listed::new(number, 0, verdict::Verdict::Open) }
            }).collect();
            prop_assume!(!records.is_empty());
            let verdicts = |set: InstructionSet| {
                let queries = open(set, &projector, &points);
                let (mut blockers, extent) = (Blockers::default(), Extent::of(&queries));
                // What is left over from a longer list says nothing.
                let longer: Vec<_> = records.iter().copied().cycle().take(LANES).collect();
                blockers.fill(&scene, &projected, &longer, &extent, projector.delta);
                blockers.fill(&scene, &projected, &records, &extent, projector.delta);
                queries.iter().map(|query| blockers.against(set, query)).collect::<Vec<_>>()
            };
            let found = verdicts(InstructionSet::Portable);
            for set in [InstructionSet::Avx2, InstructionSet::Avx512].into_iter().filter(|set| set.is_available()) {
                prop_assert_eq!(&verdicts(set), &found);
            }
            let space = LightSpace::from(Vec3::ZERO);
            for (verdict, &point) in found.iter().zip(&points) {
                let query = PreciseQuery::new(&space, point.as_dvec3(), || ExactPosition::Bare(point));
                for (lane, record) in records.iter().enumerate() {
                    let (blocks, _) = query.blocks(scene.corners(record.listed.triangle()));
                    let bit = |of: u32| of >> lane & 1 == 1;
                    prop_assert!(!bit(verdict.blocked) || blocks, "{} is blocked by none", point);
                    prop_assert!(!blocks || bit(verdict.blocked) || bit(verdict.open), "{} is blocked", point);
                }
                prop_assert_eq!((verdict.blocked | verdict.open) >> records.len(), 0);
            }
        }
    }

    #[test]
    fn triangles_in_space_and_queries_without_a_place_are_left_open_but_for_their_own() {
        let corners = [[Vec3::new(-1.0, -1.0, 2.0), Vec3::new(1.0, -1.0, 2.0), Vec3::new(0.0, 1.0, 2.0)]; 2];
        let scene = scene(&corners);
        let projector = Projector::new(Vec3::ZERO, 8);
        let projected: Vec<_> = scene.vertices.iter().map(|p| projector.project(p.to_array())).collect();
        let listed = |triangle, flags| Listed::new(triangle, flags, verdict::Verdict::Open);
        let records = [listed(0, Item::IN_SPACE), listed(1, 0)].map(|listed| Record { near: 0.6, listed });
        let [mut query] = open(InstructionSet::Portable, &projector, &[Vec3::new(0.0, 0.0, 4.0)])[..] else {
            panic!("one query")
        };
        let mut blockers = Blockers::default();
        blockers.fill(&scene, &projected, &records, &Extent::of(&[query]), projector.delta);
        let verdict = |query: &Open| blockers.against(InstructionSet::Portable, query);
        assert_eq!(verdict(&query), Verdict { blocked: 0b10, open: 0b01 });
        query.base = 0;
        assert_eq!(verdict(&query), Verdict { blocked: 0b10, open: 0 });
        let lost = Open { u: f32::NAN, v: f32::NAN, w_low: 0.0, w_high: f32::INFINITY, ..query };
        assert_eq!(verdict(&lost), Verdict { blocked: 0, open: 0b10 });
        query.w_low = 0.7;
        assert_eq!(verdict(&query).open, 0, "nearer than both");
    }
}
