//! Every primitive for every query: the classical tracer of the 2004 paper, with the native predicates.

use super::precise::{self, crossed_by_points, is_there};
use super::{Basis, BuildInput, Casters, Counters, Crossings, Lights, SceneIndex, ShadowTester, TesterEntry};
use crate::error::Result;
use crate::float_environment::StandardFloats;
use crate::geometry::LightPoint;
use crate::geometry::batch::{InstructionSet, LANES, PointBatch};
use crate::geometry::occlusion::PreciseQuery;
use crate::scene::{PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;
use std::ops::Range;

/// `brute-force` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "brute-force",
    basis: Basis::Exact,
    lights: Lights::All,
    of_scene: None,
    build: &|input| {
        let _floats = StandardFloats::new();
        Ok(Box::new(BruteForce::new(input, input.instruction_set)))
    },
    expected_tests: |casters, queries| casters * queries,
};

/// All casters of a scene as one light sees them.
pub struct BruteForce<'a> {
    scene: &'a Scene,
    index: &'a SceneIndex,
    pub(super) casters: Casters,
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

    /// At most sixteen points, to be asked about again and again.
    pub(super) fn batch<'p>(&self, points: &'p [SurfacePoint]) -> Batch<'p> {
        let relative: Vec<LightPoint> =
            points.iter().map(|p| LightPoint::new(&self.casters.space, p.position)).collect();
        Batch { points, lanes: PointBatch::new(&relative), all: (u32::MAX >> (32 - points.len())) as u16 }
    }

    /// Those of the `live` points that some of the casters in a range block, a bit each.
    pub(super) fn blocked(
        &self,
        batch: &Batch,
        casters: Range<usize>,
        mut live: u16,
        counters: &mut Counters,
    ) -> u16 {
        let asked = live;
        let mut start = casters.start;
        let planes = &self.casters.planes[..casters.end];
        while let Some(stop) = batch.lanes.scan(self.instruction_set, planes, start, live) {
            counters.tests += (stop.index + 1 - start) as u64 * u64::from(live.count_ones());
            start = stop.index + 1;
            let primitive = self.casters.primitives[stop.index];
            let mut blocked = self.there(stop.blocked, primitive, batch.points);
            for (i, point) in batch.points.iter().enumerate().filter(|(i, _)| stop.undecided >> i & 1 == 1) {
                // A triangle cannot block its own points (row 15 of the notes on the 1986 paper).
                let is_curved = self.scene.is_curved(primitive);
                if point.primitive() == Some(primitive) && !is_curved {
                    continue;
                }
                counters.undecided += u64::from(!is_curved);
                let query =
                    PreciseQuery::new(&self.casters.space, point.position, || point.exact(self.scene));
                let base = point.primitive();
                blocked |= u16::from(precise::blocks(self.scene, primitive, base, &query, counters)) << i;
            }
            live &= !blocked;
            if live == 0 {
                return asked;
            }
        }
        counters.tests += (casters.end - start) as u64 * u64::from(live.count_ones());
        asked & !live
    }
}

/// Points that are asked about together.
pub(super) struct Batch<'p> {
    points: &'p [SurfacePoint],
    lanes: PointBatch,
    /// A bit for each point.
    pub all: u16,
}

impl ShadowTester for BruteForce<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let _floats = StandardFloats::new();
        let mut counters = Counters::default();
        for (points, answers) in points.chunks(LANES).zip(answers.chunks_mut(LANES)) {
            let batch = self.batch(points);
            let blocked = self.blocked(&batch, 0..self.casters.planes.len(), batch.all, &mut counters);
            for (i, answer) in answers.iter_mut().enumerate() {
                *answer = blocked >> i & 1 == 1;
            }
        }
        Ok(counters)
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        let _floats = StandardFloats::new();
        Ok(crossed_by_points(self.scene, self.index, &self.casters.space, points, crossings))
    }

    fn bytes(&self) -> usize {
        self.casters.bytes()
    }
}
