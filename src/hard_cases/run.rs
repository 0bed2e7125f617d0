//! Every tester over the situations of a case.

use super::Situation;
use crate::error::{Error, Result};
use crate::geometry::LightPosition;
use crate::scene::Scene;
use crate::shadow::{BuildInput, Queries, Resolution, SceneIndex, TesterEntry};
use crate::verdict::{LightVerdict, Progress, judge_known};

/// A tester that has no answers, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// Its name in the registry.
    pub name: &'static str,
    /// In one line.
    pub why: String,
}

/// Who is right in a situation.
#[derive(Debug, Clone)]
pub struct SituationVerdict {
    /// What is true, and the testers that gave answers.
    pub verdict: LightVerdict,
    /// Those that gave none.
    pub refused: Vec<Refusal>,
}

/// How testers of a scene and a light are built.
pub type Inputs<'i> = dyn for<'a> Fn(&'a Scene, &'a SceneIndex, LightPosition) -> BuildInput<'a> + 'i;

/// Holds testers, the arbiter among them, against what is known of the situations of a case, and against the
/// arbiter where nothing is. Resolutions that a situation is about go before those of `inputs`.
///
/// # Errors
/// Only what the arbiter reports: others that report an error are [refused](SituationVerdict::refused).
pub fn judge_situations(
    situations: &[Situation],
    entries: &[&'static TesterEntry],
    inputs: &Inputs,
    progress: &dyn Progress,
) -> Result<Vec<SituationVerdict>> {
    let mut truths: Vec<Vec<bool>> = Vec::new();
    let mut verdicts = Vec::new();
    for situation in situations {
        let index = SceneIndex::new(&situation.scene);
        let usual = inputs(&situation.scene, &index, situation.light);
        let resolution = situation.resolution.map_or(usual.resolution, Resolution::Cells);
        let input = BuildInput { resolution, receivers: situation.receivers(), ..usual };
        let queries = Queries {
            points: situation.points.clone(),
            nodes: (0..situation.points.len() as u32).collect(),
            ..Queries::default()
        };
        let (asked, others): (Vec<&TesterEntry>, Vec<&TesterEntry>) =
            entries.iter().copied().partition(|entry| entry.lights.has(situation.light));
        let why = "it has no answer for lights that are infinitely far away";
        let mut refused: Vec<_> =
            others.iter().map(|entry| Refusal { name: entry.name, why: why.into() }).collect();
        let mut refuse = |name: &'static str, error: Error| {
            refused.push(Refusal { name, why: error.to_string() });
            Ok(())
        };
        let known = situation.known(&truths);
        let verdict = judge_known(&input, &queries, &asked, known.as_deref(), &mut refuse, progress)?;
        truths.push(verdict.truth.clone());
        verdicts.push(SituationVerdict { verdict, refused });
    }
    Ok(verdicts)
}
