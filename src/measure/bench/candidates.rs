//! Who takes part.

use super::{Contender, Order, Stage};
use crate::error::{Error, Result};
use crate::shadow::{Basis, Resolution, TesterEntry, find, testers};

/// Testers that would need more tests than this are never asked.
const MOST_TESTS: f64 = 2e11;

/// Nor, unless they are named, those that would need more than this: they would take longer than some seconds.
const MOST_TESTS_UNNAMED: f64 = 4e8;

/// Who is wanted, and with what.
#[derive(Debug, Clone)]
pub struct Choice {
    /// Names of testers; none are all.
    pub testers: Vec<String>,
    /// Resolutions of the light buffer.
    pub resolutions: Vec<Resolution>,
    /// The first one is every mode's; the fastest one is asked with the others too.
    pub epsilons: Vec<f32>,
    /// Orders of queries.
    pub orders: Vec<Order>,
    /// Whether robust modes of Embree are measured too, unless testers are named.
    pub robust: bool,
}

/// One that does not take part.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Skipped {
    /// Its name.
    pub tester: String,
    /// Why.
    pub why: String,
}

impl Choice {
    /// Fails if a name is nobody's, or all are of such that do not take part.
    ///
    /// # Errors
    /// As said.
    pub fn check(&self) -> Result<()> {
        for name in &self.testers {
            if find(name)?.basis == Basis::Truth {
                let why = "it is the arbiter, and what the others are held against";
                return Err(Error::Usage(format!("--testers {name}: {why}")));
            }
        }
        Ok(())
    }

    fn wants(&self, entry: &TesterEntry) -> bool {
        if !self.testers.is_empty() {
            return self.testers.iter().any(|name| name == entry.name);
        }
        match entry.basis {
            Basis::Truth => false,
            Basis::Exact => true,
            Basis::Measured => is_usual(entry.name, self.robust),
        }
    }
}

/// Whether one whose error is measured takes part unless testers are named: of Embree those modes that are for speed.
#[cfg(feature = "embree")]
fn is_usual(name: &str, robust: bool) -> bool {
    use crate::embree::{EmbreeMode, Robustness};
    match (name, name.parse::<EmbreeMode>()) {
        ("embree" | "embree-fast", _) => false,
        (_, Ok(mode)) => mode.is_for_speed() && (robust || mode.scene.robustness == Robustness::Fast),
        (_, Err(_)) => true,
    }
}

#[cfg(not(feature = "embree"))]
fn is_usual(_: &str, _: bool) -> bool {
    true
}

/// Why Embree cannot be asked so.
#[cfg(feature = "embree")]
fn unavailable(name: &str) -> Result<Option<String>> {
    let Some(mode) = super::contender::mode_of(name) else { return Ok(None) };
    let device = crate::embree::Device::new(1)?;
    Ok(mode.expect_in(&device).err().map(|error| error.to_string()))
}

#[cfg(not(feature = "embree"))]
fn unavailable(_: &str) -> Result<Option<String>> {
    Ok(None)
}

/// Whether a tester is Embree.
pub(super) fn is_embree(entry: &TesterEntry) -> bool {
    #[cfg(feature = "embree")]
    return super::contender::mode_of(entry.name).is_some();
    #[cfg(not(feature = "embree"))]
    {
        let _ = entry;
        false
    }
}

/// Those who take part, and those who do not.
///
/// # Errors
/// If there is no Embree to be asked what it can.
pub fn candidates(choice: &Choice, stage: &Stage) -> Result<(Vec<Contender>, Vec<Skipped>)> {
    let (mut contenders, mut skipped) = (Vec::new(), Vec::new());
    for entry in testers().filter(|entry| choice.wants(entry)) {
        if let Some(why) = why_not(entry, choice, stage)? {
            skipped.push(Skipped { tester: entry.name.into(), why });
            continue;
        }
        let is_buffer = entry.name == crate::shadow::kept_light_buffer::ENTRY.name;
        let resolutions: Vec<_> = match is_buffer {
            true => choice.resolutions.iter().copied().map(Some).collect(),
            false => vec![None],
        };
        let epsilon = is_embree(entry).then(|| choice.epsilons[0]);
        for resolution in resolutions {
            for &order in &choice.orders {
                contenders.push(Contender { entry, order, resolution, epsilon });
            }
        }
    }
    Ok((contenders, skipped))
}

fn why_not(entry: &TesterEntry, choice: &Choice, stage: &Stage) -> Result<Option<String>> {
    if stage.lights.iter().any(|light| !entry.lights.has(light.light)) {
        return Ok(Some("a light is infinitely far away, and it has no answer for such".into()));
    }
    let casters = stage.scene.primitive_count();
    let tests = (entry.expected_tests)(f64::from(casters), stage.queries() as f64);
    let most = if choice.testers.is_empty() { MOST_TESTS_UNNAMED } else { MOST_TESTS };
    // What does not grow with both is fast.
    let grows = (entry.expected_tests)(1e6, 1.0) > (entry.expected_tests)(1.0, 1.0);
    if tests > MOST_TESTS || (grows && tests > most) {
        return Ok(Some(format!("it would need about {tests:.1e} tests")));
    }
    unavailable(entry.name)
}
