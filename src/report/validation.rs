//! `validate.json`: the verdicts of a run. Its keys are a contract; new ones may be added.

use super::hard_cases::CaseReport;
use crate::film::ImageMetrics;
use crate::measure::bench::Machine;
use crate::shadow::{Basis, Queries, shadow_buffer};
use crate::verdict::{ArbiterCheck, CauseCounts, EpsilonCounts, LightVerdict, TesterCounts};
use crate::verdict::{TesterResult, VerdictCounts};
use crate::visibility::VisibleSurfaces;
use serde::Serialize;
use std::collections::BTreeMap;

/// The whole document.
#[derive(Debug, Clone, Serialize)]
pub struct Validation {
    /// The scene's name.
    pub scene: String,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// Version of this program.
    pub version: &'static str,
    /// Threads that the times were taken with.
    pub threads: usize,
    /// What the times were taken on.
    pub machine: Machine,
    /// Words of a command that asks about a pixel of the same view, but for `--pixel` and `--light`. Empty where there is
    /// no image.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub replay: Vec<String>,
    /// Embree's version and instruction set; absent without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub embree: Option<EmbreeFacts>,
    /// Testers that were not asked, by name.
    pub skipped: Vec<Skipped>,
    /// One entry a light.
    pub lights: Vec<LightReport>,
    /// One entry a hard case, for `builtin:hard-cases`, which has neither lights nor an image; else left out.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cases: Vec<CaseReport>,
    /// Embree with other epsilons, summed over the lights, if that was asked for; else left out.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub epsilon_sweep: Vec<EpsilonCounts>,
    /// The picture by each tester's shadows against that by the truth's. Empty where there is no image.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub image_metrics: BTreeMap<&'static str, ImageMetrics>,
    /// Sums over the lights, or over the situations of all cases.
    pub totals: Totals,
}

/// A tester that was not asked, at some light at least; written as its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Skipped {
    /// The tester.
    pub name: &'static str,
    /// Why.
    pub why: WhySkipped,
}

/// Why a tester was not asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhySkipped {
    /// It would have needed more than 2e11 tests.
    TooManyTests,
    /// It cannot be built for a light infinitely far away.
    DirectionalLight,
}

impl Serialize for Skipped {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name)
    }
}

/// What Embree says of itself.
#[derive(Debug, Clone, Serialize)]
pub struct EmbreeFacts {
    /// Such as `3.13.5`.
    pub version: String,
    /// The instruction set that its traversal uses.
    pub isa: String,
    /// Share of the segment left out at both ends.
    pub epsilon: f32,
    /// Whether it takes streams of rays; modes with `stream` exist only then.
    pub streams: bool,
    /// Whether modes with `ftz` differ from those without.
    pub flushes_denormals: bool,
}

/// One light's verdicts.
#[derive(Debug, Clone, Serialize)]
pub struct LightReport {
    /// The light's name.
    pub name: String,
    /// Shadow queries: visible points that face the light.
    pub queries: u64,
    /// Those of them that it reaches from behind, through their own transparent surface. Left out where there is
    /// none.
    #[serde(skip_serializing_if = "crate::verdict::is_zero")]
    pub from_behind: u64,
    /// Visible points that face away from it.
    pub facing_away: u64,
    /// Visible points that face it and are outside its cone.
    pub outside_cone: u64,
    /// Visible points that would be queries, were they on objects that receive shadows.
    pub not_receiving: u64,
    /// Testers by name.
    pub testers: BTreeMap<&'static str, TesterReport>,
    /// Who is right where.
    pub verdicts: VerdictCounts,
    /// The first pixels, row by row, where some tester is wrong, at most [`LightReport::MOST_WRONG_PIXELS`]; behind
    /// all others those where only the shadow-buffer is, which would leave no room for them.
    pub wrong_pixels: Vec<WrongPixel>,
    /// The arbiter against the plain definition, if that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arbiter_check: Option<ArbiterCheck>,
}

/// One tester at one light.
#[derive(Debug, Clone, Serialize)]
pub struct TesterReport {
    /// Right and wrong.
    #[serde(flatten)]
    pub counts: TesterCounts,
    /// What wrong answers are put down to; absent for testers that trace no float rays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub causes: Option<CauseCounts>,
    /// Seconds to build it.
    pub build_seconds: f64,
    /// Wall-clock nanoseconds a query on all threads.
    pub ns_per_query: f64,
    /// Memory it keeps.
    pub bytes: usize,
}

/// Sums over the lights.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Totals {
    /// Queries of all lights.
    pub queries: u64,
    /// Testers by name: counts and build times add up, times a query are averages weighted by queries,
    /// memory is that of all lights together.
    pub testers: BTreeMap<&'static str, TesterReport>,
    /// Who is right where.
    pub verdicts: VerdictCounts,
    /// Queries that each tester answered: all but those of lights where it was skipped.
    #[serde(skip)]
    asked: BTreeMap<&'static str, u64>,
}

/// A pixel for `replay`.
#[derive(Debug, Clone, Serialize)]
pub struct WrongPixel {
    /// Column and row from the top left.
    pub pixel: [u32; 2],
    /// Whether it is occluded.
    pub truth: bool,
    /// Testers that say otherwise.
    pub testers: Vec<&'static str>,
}

impl LightReport {
    /// The most pixels that are listed.
    pub const MOST_WRONG_PIXELS: usize = 100;

    /// The report on one light of an image of a width.
    pub fn new(
        name: &str,
        width: u32,
        visible: &VisibleSurfaces,
        queries: &Queries,
        verdict: &LightVerdict,
    ) -> LightReport {
        LightReport {
            from_behind: queries.from_behind.len() as u64,
            facing_away: queries.facing_away.len() as u64,
            outside_cone: queries.outside_cone.len() as u64,
            not_receiving: queries.not_receiving.len() as u64,
            wrong_pixels: wrong_pixels(width, visible, queries, verdict),
            ..LightReport::without_image(name, verdict)
        }
    }

    /// The report on queries that belong to no image.
    pub fn without_image(name: &str, verdict: &LightVerdict) -> LightReport {
        let report = |t: &TesterResult| TesterReport {
            counts: t.counts,
            causes: t.causes(),
            build_seconds: t.run.build_seconds,
            ns_per_query: t.run.ns_per_query,
            bytes: t.run.bytes,
        };
        LightReport {
            name: name.into(),
            queries: verdict.truth.len() as u64,
            from_behind: 0,
            facing_away: 0,
            outside_cone: 0,
            not_receiving: 0,
            testers: verdict.testers.iter().map(|t| (t.run.name, report(t))).collect(),
            verdicts: verdict.counts,
            wrong_pixels: Vec::new(),
            arbiter_check: None,
        }
    }
}

impl WrongPixel {
    /// Whether nobody is wrong but the shadow-buffer, which only approximates.
    pub fn is_expected(&self) -> bool {
        self.testers == [shadow_buffer::ENTRY.name]
    }
}

fn wrong_pixels(
    width: u32,
    visible: &VisibleSurfaces,
    queries: &Queries,
    verdict: &LightVerdict,
) -> Vec<WrongPixel> {
    let wrong = |i: usize| -> Option<WrongPixel> {
        let truth = verdict.truth[i];
        let testers: Vec<_> =
            verdict.testers.iter().filter(|t| t.run.occluded[i] != truth).map(|t| t.run.name).collect();
        let pixel = visible.pixel_seen(queries.nodes[i])?;
        let pixel = [pixel % width, pixel / width];
        (!testers.is_empty()).then_some(WrongPixel { pixel, truth, testers })
    };
    let wrong = || (0..queries.points.len()).filter_map(wrong);
    let others = wrong().filter(|pixel| !pixel.is_expected());
    others.chain(wrong().filter(WrongPixel::is_expected)).take(LightReport::MOST_WRONG_PIXELS).collect()
}

impl Totals {
    /// Adds up all lights.
    pub fn of(lights: &[LightReport]) -> Totals {
        let mut totals = Totals::default();
        for light in lights {
            for (&name, tester) in &light.testers {
                let sum = totals.testers.entry(name).or_insert(TesterReport {
                    counts: TesterCounts::default(),
                    causes: None,
                    build_seconds: 0.0,
                    ns_per_query: 0.0,
                    bytes: 0,
                });
                let asked = totals.asked.entry(name).or_default();
                let (before, now) = (*asked as f64, light.queries as f64);
                if before + now > 0.0 {
                    sum.ns_per_query =
                        (sum.ns_per_query * before + tester.ns_per_query * now) / (before + now);
                }
                *asked += light.queries;
                sum.counts += tester.counts;
                if let Some(causes) = tester.causes {
                    *sum.causes.get_or_insert_default() += causes;
                }
                sum.build_seconds += tester.build_seconds;
                sum.bytes += tester.bytes;
            }
            totals.queries += light.queries;
            totals.verdicts += light.verdicts;
        }
        totals
    }

    /// Wrong answers of the testers that claim to be exact.
    pub fn native_wrong(&self) -> u64 {
        self.testers.iter().filter(|(name, _)| is_native(name)).map(|(_, t)| t.counts.wrong).sum()
    }

    /// Answers of these testers, right or wrong.
    pub fn native_answers(&self) -> u64 {
        self.asked.iter().filter(|(name, _)| is_native(name)).map(|(_, asked)| asked).sum()
    }
}

/// Whether a tester claims to be exact and is not the truth itself.
fn is_native(name: &str) -> bool {
    crate::shadow::find(name).is_ok_and(|entry| entry.basis == Basis::Exact)
}
