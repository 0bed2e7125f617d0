//! The arbiter itself, checked against the plain definition in integers.

use crate::geometry::LightPosition;
use crate::scene::Scene;
use crate::shadow::Queries;
use crate::shadow::exact::Occlusion;
use crate::shadow::exact::plain::PlainTest;
use crate::visibility::SurfacePoint;
use rayon::prelude::*;

/// Outcome of a check.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct ArbiterCheck {
    /// Queries that were decided again.
    pub queries: u64,
    /// Queries where the arbiter differs from the definition.
    pub wrong: u64,
}

/// Decides up to `most` queries, evenly spread over the list, by testing every triangle in exact integers,
/// and compares with the arbiter's `truth`.
pub fn check_arbiter(
    scene: &Scene,
    light: LightPosition,
    queries: &Queries,
    truth: &[bool],
    most: usize,
    advance: &(dyn Fn(u64) + Sync),
) -> ArbiterCheck {
    let count = most.min(queries.points.len());
    let sample: Vec<usize> = (0..count).map(|i| i * queries.points.len() / count).collect();
    let points: Vec<SurfacePoint> = sample.iter().map(|&i| queries.points[i]).collect();
    let plain = PlainTest::new(scene, light, &points);
    let wrong = points
        .par_iter()
        .zip(&sample)
        .filter(|&(point, &i)| {
            advance(1);
            (plain.decide(point) == Occlusion::Occluded) != truth[i]
        })
        .count();
    ArbiterCheck { queries: count as u64, wrong: wrong as u64 }
}
