//! One tester over many queries, on all threads of the pool it is called in.

use crate::error::Result;
use crate::shadow::{Counters, ShadowTester};
use crate::visibility::SurfacePoint;
use rayon::prelude::*;
use std::time::Instant;

/// Queries that one task answers.
const CHUNK: usize = 4096;

/// A value and the wall-clock seconds it took.
#[derive(Debug, Clone, Copy)]
pub struct Timed<T> {
    /// The value.
    pub value: T,
    /// Seconds.
    pub seconds: f64,
}

/// Runs something and takes the time.
pub fn timed<T>(work: impl FnOnce() -> T) -> Timed<T> {
    let start = Instant::now();
    let value = work();
    Timed { value, seconds: start.elapsed().as_secs_f64() }
}

/// A tester's answers to a list of queries.
#[derive(Debug, Clone)]
pub struct Answers {
    /// Whether each point is occluded.
    pub occluded: Vec<bool>,
    /// The work it took.
    pub counters: Counters,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// Answers all queries in chunks; `advance` is told the number of each finished chunk.
///
/// # Errors
/// The first error of the tester.
pub fn answer(
    tester: &dyn ShadowTester,
    points: &[SurfacePoint],
    advance: &(dyn Fn(u64) + Sync),
) -> Result<Answers> {
    let mut occluded = vec![false; points.len()];
    let run = timed(|| {
        points
            .par_chunks(CHUNK)
            .zip(occluded.par_chunks_mut(CHUNK))
            .map(|(points, answers)| {
                let counters = tester.occluded(points, answers)?;
                advance(points.len() as u64);
                Ok(counters)
            })
            .try_reduce(Counters::default, |mut sum, counters| {
                sum += counters;
                Ok(sum)
            })
    });
    Ok(Answers { occluded, counters: run.value?, seconds: run.seconds })
}
