//! Every tester over the queries of one light, against the arbiter.

use super::{Cause, CauseCounts, TesterCounts, VerdictCounts, WrongAnswer};
use crate::error::{Error, Result};
use crate::measure::{Question, Timed, answer_in_runs, soft_light, timed};
use crate::shadow::exact::{Arbiter, Contact, Occlusion};
use crate::shadow::{
    Basis, BuildInput, Counters, Crossings, Fresh, Origin, Queries, ShadowTester, TesterEntry, TesterSource,
};
use crate::visibility::SurfacePoint;
use rayon::prelude::*;
use std::sync::Arc;

/// One tester's answers to the queries of a light, and what they cost.
#[derive(Debug, Clone)]
pub struct TesterRun {
    /// Its name in the registry.
    pub name: &'static str,
    /// What its answers rest on.
    pub basis: Basis,
    /// Whether each query is occluded.
    pub occluded: Vec<bool>,
    /// What transparent surfaces the segment of each query crosses, if the scene has such that cast shadows.
    pub crossings: Option<Crossings>,
    /// The share of the light that arrives at each query, if its shadows have soft edges.
    pub soft_light: Option<Vec<[f32; 3]>>,
    /// The work it took.
    pub counters: Counters,
    /// Whether it was built for this.
    pub origin: Origin,
    /// Seconds to build it; of one that was kept, to find it again.
    pub build_seconds: f64,
    /// Wall-clock nanoseconds a query on all threads.
    pub ns_per_query: f64,
    /// Memory it keeps.
    pub bytes: usize,
    /// What was built, for `--stats`.
    pub statistics: Vec<(&'static str, String)>,
}

impl TesterRun {
    /// Whether the segment of a query that is not occluded crosses other transparent surfaces than it says.
    fn crosses_otherwise(&self, crossed: Option<&Crossings>, query: usize) -> bool {
        match (&self.crossings, crossed) {
            (Some(found), Some(crossed)) => found.of(query) != crossed.of(query) && !self.occluded[query],
            _ => false,
        }
    }
}

/// A run and how it compares with the truth.
#[derive(Debug, Clone)]
pub struct TesterResult {
    /// Answers and costs.
    pub run: TesterRun,
    /// Right and wrong.
    pub counts: TesterCounts,
    /// Its wrong answers and what they are put down to, in the order of the queries, if it traces float rays.
    pub explained: Option<Vec<WrongAnswer>>,
}

impl TesterResult {
    /// How many wrong answers are put down to what, if it traces float rays.
    pub fn causes(&self) -> Option<CauseCounts> {
        self.explained.as_deref().map(CauseCounts::of)
    }
}

/// The verdict on one light.
#[derive(Debug, Clone)]
pub struct LightVerdict {
    /// Whether each query is occluded, exactly.
    pub truth: Vec<bool>,
    /// What transparent surfaces the segment of each query crosses, if the scene has such that cast shadows.
    pub crossed: Option<Crossings>,
    /// Whether each query is touching.
    pub touching: Vec<bool>,
    /// Testers in the order of the registry.
    pub testers: Vec<TesterResult>,
    /// Who is right where.
    pub counts: VerdictCounts,
}

impl LightVerdict {
    /// A tester's result by name.
    pub fn tester(&self, name: &str) -> Option<&TesterResult> {
        self.testers.iter().find(|t| t.run.name == name)
    }
}

/// Decides all queries of a light and holds the testers against that. `progress` is told of each stage and
/// of every chunk of answers.
///
/// # Errors
/// Whatever a tester reports while it is built or asked.
pub fn judge(
    input: &BuildInput,
    queries: &Queries,
    entries: &[&TesterEntry],
    progress: &dyn Progress,
) -> Result<LightVerdict> {
    judge_from(&mut Fresh, input, queries, entries, progress)
}

/// The same with testers, the arbiter among them, that may have been kept.
///
/// # Errors
/// As [`judge`].
pub fn judge_from<'a>(
    source: &mut dyn TesterSource<'a>,
    input: &BuildInput<'a>,
    queries: &Queries,
    entries: &[&TesterEntry],
    progress: &dyn Progress,
) -> Result<LightVerdict> {
    decide(source, input, queries, entries, None, &mut |_, error| Err(error), progress)
}

/// The same, and the arbiter too is held against answers that are known before, if there are such. A tester that
/// reports an error is left out if `refused` takes that.
///
/// # Errors
/// What `refused` returns.
pub fn judge_known(
    input: &BuildInput,
    queries: &Queries,
    entries: &[&TesterEntry],
    known: Option<&[bool]>,
    refused: &mut dyn FnMut(&'static str, Error) -> Result<()>,
    progress: &dyn Progress,
) -> Result<LightVerdict> {
    decide(&mut Fresh, input, queries, entries, known, refused, progress)
}

fn decide<'a>(
    source: &mut dyn TesterSource<'a>,
    input: &BuildInput<'a>,
    queries: &Queries,
    entries: &[&TesterEntry],
    known: Option<&[bool]>,
    refused: &mut dyn FnMut(&'static str, Error) -> Result<()>,
    progress: &dyn Progress,
) -> Result<LightVerdict> {
    let points = &queries.points;
    let mut testers = Vec::new();
    progress.stage("exact");
    let built = timed(|| source.arbiter(input));
    let supplied = built.value?;
    let origin = supplied.origin;
    let arbiter = Timed { value: supplied.tester.as_ref(), seconds: built.seconds };
    let decided = timed(|| {
        points
            .par_iter()
            .map(|point| {
                let truth = arbiter.value.decide(point);
                progress.advance(1);
                truth
            })
            .collect::<Vec<_>>()
    });
    let answers: Vec<bool> = decided.value.iter().map(|t| t.occlusion == Occlusion::Occluded).collect();
    let truth = known.map_or_else(|| answers.clone(), <[bool]>::to_vec);
    let crossed = match Question::of(input.scene) {
        Question::Occlusion => None,
        Question::OcclusionAndCrossings => Some(crossings_of(arbiter.value, points, &truth)?),
    };
    let touching: Vec<bool> = decided.value.iter().map(|t| t.contact == Contact::Touching).collect();
    for entry in entries {
        let (run, tester) = match entry.basis {
            Basis::Truth => {
                let run = truth_run(entry, &arbiter, &answers, crossed.as_ref(), decided.seconds);
                (TesterRun { origin, ..run }, None)
            }
            _ => match ask(source, entry, input, queries, progress) {
                Ok((run, tester)) => (run, Some(tester)),
                Err(error) => {
                    refused(entry.name, error)?;
                    continue;
                }
            },
        };
        let mut counts = TesterCounts::new(&run.occluded, &truth, run.counters.undecided);
        if let (Some(found), Some(crossed)) = (&run.crossings, &crossed) {
            counts.count_transmittances(&run.occluded, found, &truth, crossed);
        }
        let explained =
            tester.and_then(|t| explained(t.as_ref(), arbiter.value, points, &run.occluded, &truth));
        testers.push(TesterResult { run, counts, explained });
    }
    let counts = verdicts(&truth, crossed.as_ref(), &touching, &testers);
    Ok(LightVerdict { truth, crossed, touching, testers, counts })
}

/// The arbiter's own row.
fn truth_run(
    entry: &TesterEntry,
    arbiter: &Timed<&Arbiter>,
    answers: &[bool],
    crossed: Option<&Crossings>,
    seconds: f64,
) -> TesterRun {
    TesterRun {
        name: entry.name,
        basis: entry.basis,
        occluded: answers.to_vec(),
        crossings: crossed.cloned(),
        soft_light: None,
        counters: Counters::default(),
        origin: Origin::Built,
        build_seconds: arbiter.seconds,
        ns_per_query: per_query(seconds, answers.len()),
        bytes: arbiter.value.bytes(),
        statistics: Vec::new(),
    }
}

/// The truth about what segments cross.
fn crossings_of(arbiter: &Arbiter, points: &[SurfacePoint], occluded: &[bool]) -> Result<Crossings> {
    const CHUNK: usize = 1024;
    let chunks = points.par_chunks(CHUNK).zip(occluded.par_chunks(CHUNK));
    let found: Vec<Crossings> = chunks
        .map(|(points, occluded)| {
            let mut crossings = Crossings::default();
            for (point, &occluded) in points.iter().zip(occluded) {
                match occluded {
                    true => crossings.push([]),
                    false => {
                        ShadowTester::crossed(arbiter, std::slice::from_ref(point), &mut crossings)?;
                    }
                }
            }
            Ok(crossings)
        })
        .collect::<Result<_>>()?;
    let mut all = Crossings::default();
    found.iter().for_each(|crossings| all.append(crossings));
    Ok(all)
}

/// What a tester's wrong answers are put down to; `None` if it traces no float rays.
fn explained(
    tester: &dyn ShadowTester,
    arbiter: &Arbiter,
    points: &[SurfacePoint],
    answers: &[bool],
    truth: &[bool],
) -> Option<Vec<WrongAnswer>> {
    // A point in the light has no ray, others next to it have.
    points.iter().take(64).find_map(|point| tester.traced_ray(point))?;
    let wrong: Vec<usize> = (0..points.len()).filter(|&i| answers[i] != truth[i]).collect();
    let explain = |&query: &usize| {
        let cause = Cause::of(arbiter, &tester.traced_ray(&points[query])?, answers[query]);
        Some(WrongAnswer { query, cause })
    };
    Some(wrong.par_iter().filter_map(explain).collect())
}

/// Builds one tester and lets it answer all queries of a light.
///
/// # Errors
/// Whatever the tester reports while it is built or asked.
pub fn run_tester(
    entry: &TesterEntry,
    input: &BuildInput,
    queries: &Queries,
    progress: &dyn Progress,
) -> Result<TesterRun> {
    run_tester_from(&mut Fresh, entry, input, queries, progress)
}

/// The same with a tester that may have been kept.
///
/// # Errors
/// As [`run_tester`].
pub fn run_tester_from<'a>(
    source: &mut dyn TesterSource<'a>,
    entry: &TesterEntry,
    input: &BuildInput<'a>,
    queries: &Queries,
    progress: &dyn Progress,
) -> Result<TesterRun> {
    Ok(ask(source, entry, input, queries, progress)?.0)
}

fn ask<'a>(
    source: &mut dyn TesterSource<'a>,
    entry: &TesterEntry,
    input: &BuildInput<'a>,
    queries: &Queries,
    progress: &dyn Progress,
) -> Result<(TesterRun, Arc<dyn ShadowTester + 'a>)> {
    progress.stage(entry.name);
    let built = timed(|| source.tester(entry, input));
    let supplied = built.value?;
    let (tester, origin) = (supplied.tester, supplied.origin);
    let question = Question::of(input.scene);
    let advance = |n| progress.advance(n);
    let answers = answer_in_runs(tester.as_ref(), &queries.points, &queries.runs, question, &advance)?;
    let soft_light = soft_light(tester.as_ref(), input.scene, &queries.points, &answers)?;
    let run = TesterRun {
        name: entry.name,
        basis: entry.basis,
        occluded: answers.occluded,
        crossings: answers.crossings,
        soft_light,
        counters: answers.counters,
        origin,
        build_seconds: built.seconds,
        ns_per_query: per_query(answers.seconds, queries.points.len()),
        bytes: tester.bytes(),
        statistics: tester.statistics(),
    };
    Ok((run, tester))
}

/// What a long run tells about itself.
pub trait Progress: Sync {
    /// A tester begins.
    fn stage(&self, name: &str);
    /// So many more queries are answered.
    fn advance(&self, queries: u64);
}

pub(super) fn per_query(seconds: f64, queries: usize) -> f64 {
    if queries == 0 { 0.0 } else { seconds * 1e9 / queries as f64 }
}

fn verdicts(
    truth: &[bool],
    crossed: Option<&Crossings>,
    touching: &[bool],
    testers: &[TesterResult],
) -> VerdictCounts {
    let native: Vec<_> = testers.iter().filter(|t| t.run.basis == Basis::Exact).collect();
    let embree = testers.iter().find(|t| t.run.name == "embree");
    let mut counts = VerdictCounts::default();
    for (i, &truth) in truth.iter().enumerate() {
        let is_wrong = |t: &TesterResult| t.run.occluded[i] != truth || t.run.crosses_otherwise(crossed, i);
        let native_wrong = native.iter().any(|&t| is_wrong(t));
        let embree_wrong = embree.is_some_and(is_wrong);
        match (native_wrong, embree_wrong) {
            (false, false) => counts.agree += 1,
            (true, false) => counts.native_wrong += 1,
            (false, true) => counts.embree_wrong += 1,
            (true, true) => counts.both_wrong += 1,
        }
        counts.touching += u64::from(touching[i]);
    }
    counts
}
