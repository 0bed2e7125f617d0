//! Embree's epsilon against its errors: too small a one makes acne, too large a one lets light through.

use super::TesterCounts;
use crate::error::Result;
use crate::measure::{Question, answer_in_runs};
use crate::shadow::{BuildInput, EmbreeSettings, Queries, TesterEntry};
use std::ops::AddAssign;

/// The shares of a segment that are tried: from nothing, by steps of ten, to a hundredth.
pub const EPSILONS: [f32; 8] = [0.0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// What a tester answers with one epsilon.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct EpsilonCounts {
    /// The tester.
    pub tester: &'static str,
    /// The share of the segment that it leaves out at both ends.
    pub epsilon: f32,
    /// Lit points that it calls occluded: acne, where surfaces shadow themselves.
    pub false_shadow: u64,
    /// Occluded points that it calls lit: leaks.
    pub false_light: u64,
}

impl AddAssign for EpsilonCounts {
    /// The same tester and epsilon at another light.
    fn add_assign(&mut self, other: EpsilonCounts) {
        debug_assert_eq!((self.tester, self.epsilon), (other.tester, other.epsilon));
        self.false_shadow += other.false_shadow;
        self.false_light += other.false_light;
    }
}

/// Asks a tester that traces float rays all queries of a light with every one of [`EPSILONS`].
///
/// # Errors
/// Whatever it reports.
pub fn sweep_epsilon(
    entry: &TesterEntry,
    input: &BuildInput,
    queries: &Queries,
    truth: &[bool],
) -> Result<Vec<EpsilonCounts>> {
    let with = |&epsilon: &f32| {
        let embree = EmbreeSettings { epsilon, ..input.embree };
        let tester = (entry.build)(&BuildInput { embree, ..*input })?;
        let (points, runs) = (&queries.points, &queries.runs);
        let answers = answer_in_runs(tester.as_ref(), points, runs, Question::Occlusion, &|_| {})?;
        let counts = TesterCounts::new(&answers.occluded, truth, 0);
        let (false_shadow, false_light) = (counts.false_shadow, counts.false_light);
        Ok(EpsilonCounts { tester: entry.name, epsilon, false_shadow, false_light })
    };
    EPSILONS.iter().map(with).collect()
}
