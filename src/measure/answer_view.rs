//! All queries of a view and one light at once: the one place where `bench` asks a tester.

use super::run::CHUNK;
use super::{Answers, timed};
use crate::error::Result;
use crate::shadow::{Batching, Counters, ShadowTester};
use crate::visibility::Points;
use rayon::prelude::*;

/// Who is occluded, on all threads of the pool that this is called in.
///
/// # Errors
/// The first error of the tester.
pub fn answer_view(tester: &dyn ShadowTester, points: Points<'_>) -> Result<Answers> {
    let mut occluded = vec![false; points.len()];
    let run = timed(|| match tester.batching() {
        Batching::Whole => tester.occluded_at(points, &mut occluded),
        Batching::Chunks => points
            .par_chunks(CHUNK)
            .zip(occluded.par_chunks_mut(CHUNK))
            .map(|(points, answers)| tester.occluded_at(points, answers))
            .try_reduce(Counters::default, |mut all, counters| {
                all += counters;
                Ok(all)
            }),
    });
    Ok(Answers { occluded, crossings: None, counters: run.value?, seconds: run.seconds })
}
