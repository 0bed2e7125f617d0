//! Every triangle for every query: the classical tracer of the 2004 paper, with the native predicates.

use super::precise::{self, crossings_of, is_there};
use super::{Basis, BuildInput, Casters, Counters, Crossings, SceneIndex, ShadowTester, TesterEntry};
use crate::error::Result;
use crate::geometry::LightPoint;
use crate::geometry::batch::{InstructionSet, LANES, PointBatch};
use crate::geometry::occlusion::PreciseQuery;
use crate::scene::{PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;

/// `brute-force` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "brute-force",
    basis: Basis::Exact,
    build: &|input| Ok(Box::new(BruteForce::new(input, InstructionSet::best()))),
    expected_tests: |casters, queries| casters * queries,
};

/// All casters of a scene as one light sees them.
pub struct BruteForce<'a> {
    scene: &'a Scene,
    index: &'a SceneIndex,
    casters: Casters,
    instruction_set: InstructionSet,
}

impl<'a> BruteForce<'a> {
    /// Prepares the planes of every caster; `instruction_set` must be available.
    pub fn new(input: &BuildInput<'a>, instruction_set: InstructionSet) -> BruteForce<'a> {
        let casters = Casters::new(input.scene, input.index, input.light);
        BruteForce { scene: input.scene, index: input.index, casters, instruction_set }
    }

    /// Those of the lanes that a triangle blocks where it is not a hole of its mask.
    fn there(&self, blocked: u16, primitive: PrimitiveIndex, points: &[SurfacePoint]) -> u16 {
        if self.scene.masked(primitive).is_none() {
            return blocked;
        }
        let is_blocked = |point: &SurfacePoint| {
            let query = PreciseQuery::new(&self.casters.space, point.position, || point.exact(self.scene));
            point.primitive() != Some(primitive) && is_there(self.scene, primitive, &query)
        };
        let lanes =
            points.iter().enumerate().filter(|&(i, point)| blocked >> i & 1 == 1 && is_blocked(point));
        lanes.fold(0, |lanes, (i, _)| lanes | 1 << i)
    }

    /// Those of the lanes that no curved surface blocks.
    fn not_behind_curved(&self, points: &[SurfacePoint], mut live: u16, counters: &mut Counters) -> u16 {
        if self.index.curved.is_empty() {
            return live;
        }
        for (i, point) in points.iter().enumerate() {
            if live >> i & 1 == 0 {
                continue;
            }
            let query = PreciseQuery::new(&self.casters.space, point.position, || point.exact(self.scene));
            let blocks = |&p: &PrimitiveIndex| {
                counters.tests += 1;
                precise::blocks(self.scene, p, point, &query, counters)
            };
            if self.index.curved.iter().any(blocks) {
                live &= !(1 << i);
            }
        }
        live
    }

    fn answer_batch(&self, points: &[SurfacePoint], answers: &mut [bool], counters: &mut Counters) {
        let relative: Vec<LightPoint> =
            points.iter().map(|p| LightPoint::new(&self.casters.space, p.position)).collect();
        let batch = PointBatch::new(&relative);
        let mut live = (u32::MAX >> (32 - points.len())) as u16;
        let mut start = 0;
        while let Some(stop) = batch.scan(self.instruction_set, &self.casters.planes, start, live) {
            counters.tests += (stop.index + 1 - start) as u64 * u64::from(live.count_ones());
            start = stop.index + 1;
            let primitive = self.casters.primitives[stop.index];
            let mut blocked = self.there(stop.blocked, primitive, points);
            for (i, point) in points.iter().enumerate().filter(|(i, _)| stop.undecided >> i & 1 == 1) {
                // The base surface cannot block its own point (row 15 of the notes on the 1986 paper).
                if point.primitive() == Some(primitive) {
                    continue;
                }
                counters.undecided += 1;
                let query =
                    PreciseQuery::new(&self.casters.space, point.position, || point.exact(self.scene));
                blocked |= u16::from(precise::blocks(self.scene, primitive, point, &query, counters)) << i;
            }
            live &= !blocked;
            if live == 0 {
                break;
            }
        }
        counters.tests += (self.casters.planes.len() - start) as u64 * u64::from(live.count_ones());
        live = self.not_behind_curved(points, live, counters);
        for (i, answer) in answers.iter_mut().enumerate() {
            *answer = live >> i & 1 == 0;
        }
    }
}

impl ShadowTester for BruteForce<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let mut counters = Counters::default();
        for (points, answers) in points.chunks(LANES).zip(answers.chunks_mut(LANES)) {
            self.answer_batch(points, answers, &mut counters);
        }
        Ok(counters)
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        let mut counters = Counters::default();
        for point in points {
            let query = PreciseQuery::new(&self.casters.space, point.position, || point.exact(self.scene));
            let mut crossed = Vec::new();
            for &primitive in &self.index.transparent {
                let times = crossings_of(self.scene, primitive, point, &query, &mut counters);
                crossed.extend((0..times).map(|_| primitive));
            }
            crossings.push(crossed);
        }
        Ok(counters)
    }

    fn bytes(&self) -> usize {
        self.casters.bytes()
    }
}
