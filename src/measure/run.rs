//! One tester over many queries, on all threads of the pool it is called in.

use crate::error::Result;
use crate::scene::Scene;
use crate::shadow::{Batching, Counters, Crossings, ShadowTester};
use crate::visibility::SurfacePoint;
use rayon::prelude::*;
use std::time::Instant;

/// Queries that one task answers.
pub(super) const CHUNK: usize = 4096;

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
    /// What transparent surfaces the segment of each point crosses, nothing for those that are occluded; `None`
    /// if that was not asked for.
    pub crossings: Option<Crossings>,
    /// The work it took.
    pub counters: Counters,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// What is asked of a tester.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Question {
    /// Who is occluded.
    Occlusion,
    /// Who is occluded, and what lies in the way of the others.
    OcclusionAndCrossings,
}

impl Question {
    /// What answers a scene calls for.
    pub fn of(scene: &Scene) -> Question {
        match scene.has_transparent_casters() {
            true => Question::OcclusionAndCrossings,
            false => Question::Occlusion,
        }
    }
}

/// Answers all queries in chunks; `advance` is told the number of each finished chunk.
///
/// # Errors
/// The first error of the tester.
pub fn answer(
    tester: &dyn ShadowTester,
    points: &[SurfacePoint],
    question: Question,
    advance: &(dyn Fn(u64) + Sync),
) -> Result<Answers> {
    answer_in_runs(tester, points, &[], question, advance)
}

/// The same, where no chunk goes past the places at which runs begin, in ascending order.
///
/// # Errors
/// The first error of the tester.
pub fn answer_in_runs(
    tester: &dyn ShadowTester,
    points: &[SurfacePoint],
    runs: &[usize],
    question: Question,
    advance: &(dyn Fn(u64) + Sync),
) -> Result<Answers> {
    let mut occluded = vec![false; points.len()];
    let run = timed(|| {
        let at_once = match tester.batching() {
            Batching::Whole => Some(tester.occluded(points, &mut occluded)?),
            Batching::Chunks => None,
        };
        chunks(points, &mut occluded, runs)
            .into_par_iter()
            .enumerate()
            .map(|(chunk, (points, answers))| {
                let mut counters = match at_once {
                    None => tester.occluded(points, answers)?,
                    // Counted once.
                    Some(counters) if chunk == 0 => counters,
                    Some(_) => Counters::default(),
                };
                let crossings = match question {
                    Question::Occlusion => None,
                    Question::OcclusionAndCrossings => Some(crossed(tester, points, answers, &mut counters)?),
                };
                advance(points.len() as u64);
                Ok((counters, crossings))
            })
            .collect::<Result<Vec<_>>>()
    });
    let mut counters = Counters::default();
    let mut crossings = (question == Question::OcclusionAndCrossings).then(Crossings::default);
    for (chunk, crossed) in run.value? {
        counters += chunk;
        if let (Some(all), Some(crossed)) = (&mut crossings, crossed) {
            all.append(&crossed);
        }
    }
    Ok(Answers { occluded, crossings, counters, seconds: run.seconds })
}

/// Points with room for their answers, run by run in chunks.
fn chunks<'a>(
    points: &'a [SurfacePoint],
    answers: &'a mut [bool],
    runs: &[usize],
) -> Vec<(&'a [SurfacePoint], &'a mut [bool])> {
    let ends = runs.iter().copied().chain([points.len()]);
    let (mut points, mut answers, mut begin) = (points, answers, 0);
    let mut all = Vec::new();
    for end in ends {
        let (run, rest) = points.split_at(end - begin);
        let (run_answers, rest_answers) = answers.split_at_mut(end - begin);
        all.extend(run.chunks(CHUNK).zip(run_answers.chunks_mut(CHUNK)));
        (points, answers, begin) = (rest, rest_answers, end);
    }
    all
}

/// The share of the light that arrives at each point past opaque and through transparent surfaces, by a tester
/// whose shadows have soft edges; `None` for all others. No time is taken.
///
/// # Errors
/// The first error of the tester.
pub fn soft_light(
    tester: &dyn ShadowTester,
    scene: &Scene,
    points: &[SurfacePoint],
    answers: &Answers,
) -> Result<Option<Vec<[f32; 3]>>> {
    if tester.lit_share(&[], &mut [])?.is_none() {
        return Ok(None);
    }
    let chunk = |(chunk, points): (usize, &[SurfacePoint])| {
        let first = chunk * CHUNK;
        let mut shares = vec![0.0; points.len()];
        tester.lit_share(points, &mut shares)?;
        let Some(crossings) = &answers.crossings else {
            return Ok(shares.into_iter().map(|share| [share; 3]).collect());
        };
        // Nobody has asked yet what lies in the way of what little reaches those that count as occluded.
        let half_dark: Vec<bool> =
            (0..points.len()).map(|i| answers.occluded[first + i] && shares[i] > 0.0).collect();
        let asked: Vec<bool> = half_dark.iter().map(|half_dark| !half_dark).collect();
        let rest = crossed(tester, points, &asked, &mut Counters::default())?;
        let transmittance = |i: usize| match half_dark[i] {
            true => rest.transmittance(scene, i),
            false => crossings.transmittance(scene, first + i),
        };
        Ok((0..points.len()).map(|i| transmittance(i).map(|share| share * shares[i])).collect::<Vec<_>>())
    };
    let chunks = points.par_chunks(CHUNK).enumerate().map(chunk).collect::<Result<Vec<_>>>()?;
    Ok(Some(chunks.concat()))
}

/// What the segments of those that are not occluded cross.
fn crossed(
    tester: &dyn ShadowTester,
    points: &[SurfacePoint],
    occluded: &[bool],
    counters: &mut Counters,
) -> Result<Crossings> {
    let lit = points.iter().zip(occluded).filter(|(_, occluded)| !**occluded);
    let lit: Vec<SurfacePoint> = lit.map(|(point, _)| *point).collect();
    let mut found = Crossings::default();
    *counters += tester.crossed(&lit, &mut found)?;
    let mut crossings = Crossings::default();
    let mut next = 0;
    for &occluded in occluded {
        if occluded {
            crossings.push([]);
        } else {
            crossings.push(found.of(next).iter().copied());
            next += 1;
        }
    }
    Ok(crossings)
}
