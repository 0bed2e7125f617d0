//! What the contenders say about every query of a view, and how often the arbiter says otherwise (figure 18).

use super::Contender;
use crate::error::Result;
use crate::measure::sample::{Errors, Sample};
use crate::measure::{Answers, Question, answer, timed};
use crate::shadow::exact::Arbiter;
use crate::shadow::{BuildInput, Queries};

/// A light's queries, decided.
#[derive(Debug, Clone)]
pub struct Judged {
    /// How many.
    pub queries: u64,
    /// Whether each of them is occluded, exactly.
    pub truth: Vec<bool>,
    /// Of them on the very edge between light and shadow.
    pub touching: u64,
    /// In the order of the contenders.
    pub testers: Vec<JudgedTester>,
}

/// One contender's answers.
#[derive(Debug, Clone)]
pub struct JudgedTester {
    /// Which.
    pub contender: Contender,
    /// What it says.
    pub answers: Answers,
    /// Seconds to build it, once.
    pub build_seconds: f64,
    /// Against the arbiter.
    pub errors: Errors,
}

/// Asks a contender about all queries of a light.
///
/// # Errors
/// Whatever it reports.
pub fn answers_of(contender: Contender, input: &BuildInput, queries: &Queries) -> Result<Answers> {
    let tester = contender.build(input)?;
    answer(tester.as_ref(), &queries.points, Question::Occlusion, &|_| {})
}

/// Asks contenders about all queries of a light, and the arbiter.
///
/// # Errors
/// Whatever a tester reports.
pub fn judged(input: &BuildInput, queries: &Queries, contenders: &[Contender]) -> Result<Judged> {
    let sample = Sample::new(&Arbiter::new(input), queries, 0, Question::Occlusion);
    let truth = sample.truth();
    let judge = |&contender: &Contender| {
        let built = timed(|| contender.build(input));
        let answers = answer(built.value?.as_ref(), &queries.points, Question::Occlusion, &|_| {})?;
        let errors = Errors::of(&answers.occluded, &truth);
        Ok(JudgedTester { contender, answers, build_seconds: built.seconds, errors })
    };
    Ok(Judged {
        queries: queries.points.len() as u64,
        touching: sample.touching(),
        testers: contenders.iter().map(judge).collect::<Result<_>>()?,
        truth,
    })
}
