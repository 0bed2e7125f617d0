//! All testers over a case, against each other.

use super::recipe::{Batch, Case, Recipe, Settings, Threads};
use crate::error::{Error, Result};
use crate::scene::{ImageSize, PrimitiveIndex};
use crate::shadow::exact::plain::PlainTest;
use crate::shadow::exact::{Arbiter, Contact, Occlusion};
use crate::shadow::{Basis, BuildInput, Counters, Crossings, SceneIndex, TesterEntry};
use crate::verdict::TesterCounts;
use crate::visibility::{FirstHitMethod, SurfacePoint};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::AddAssign;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The image in which ways to find first hits are compared.
const IMAGE: ImageSize = ImageSize { width: 16, height: 16 };

/// Asks testers about cases.
pub struct Judge<'e> {
    entries: &'e [&'static TesterEntry],
    one: rayon::ThreadPool,
    two: rayon::ThreadPool,
}

/// How far a case is looked into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// Native testers against the arbiter, and first hits against each other.
    Native,
    /// That, the arbiter against the definition in integers, and testers whose errors are only counted.
    All,
}

/// Two that should say the same and do not.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kind {
    /// Who differs: a native tester from the arbiter, `exact` from the definition in integers, a way to find first hits
    /// from the classical one.
    pub who: String,
    /// In what.
    pub what: What,
}

/// What two differ in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum What {
    /// A lit point is called occluded.
    FalseShadow,
    /// An occluded point is called lit.
    FalseLight,
    /// Light passes through other transparent primitives.
    Crossings,
    /// A ray from the camera hits another primitive first.
    FirstHits,
    /// There is no answer but an error.
    Error,
    /// There is no answer but a panic.
    Panic,
}

/// One disagreement in a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Disagreement {
    /// What it is.
    pub kind: Kind,
    /// Which of the recipe's aims shows it, if it is about one.
    pub aim: Option<usize>,
    /// Which of the recipe's settings.
    pub settings: usize,
}

/// What was asked, and how it came out.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Scenes.
    pub scenes: u64,
    /// Triangles and curved surfaces in them.
    pub primitives: u64,
    /// Pairs of a point and a light.
    pub queries: u64,
    /// Those that are occluded.
    pub occluded: u64,
    /// Those on the edge between light and shadow.
    pub touching: u64,
    /// Those that pass through something transparent.
    pub crossing: u64,
    /// Testers by name.
    pub testers: BTreeMap<&'static str, Asked>,
    /// Wrong answers of native testers.
    pub native_wrong: u64,
    /// Queries in which the arbiter was held against the definition in integers.
    pub arbiter_checked: u64,
    /// Those in which it differs.
    pub arbiter_wrong: u64,
    /// Camera rays that were traced in all ways.
    pub rays: u64,
    /// Those whose first hits differ.
    pub first_hits_differ: u64,
    /// Errors and panics in place of answers, of what is native.
    pub failures: u64,
}

/// One tester, each query once for each of the settings that it was asked in.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Asked {
    /// Answers.
    pub answers: u64,
    /// Primitives tested against segments.
    pub tests: u64,
    /// Right and wrong.
    #[serde(flatten)]
    pub counts: TesterCounts,
    /// Scenes that it has no answer for, if its errors are only counted.
    pub refused: u64,
}

/// A case judged.
#[derive(Debug, Default)]
pub struct Judged {
    /// What was asked.
    pub counts: Counts,
    /// Each disagreement of what is native.
    pub disagreements: Vec<Disagreement>,
}

/// What somebody says of a query.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// Something opaque is in the way.
    Occluded,
    /// Nothing is but these transparent primitives.
    Lit(Vec<PrimitiveIndex>),
}

impl<'e> Judge<'e> {
    /// A judge of these testers; the arbiter is asked in any case.
    ///
    /// # Errors
    /// If the system refuses the threads.
    pub fn new(entries: &'e [&'static TesterEntry]) -> Result<Judge<'e>> {
        let pool = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.map_err(|error| Error::Usage(format!("threads: {error}")))
        };
        Ok(Judge { entries, one: pool(1)?, two: pool(2)? })
    }

    /// Judges the case of a recipe. A panic is a disagreement like any other.
    pub fn judge(&self, recipe: &Recipe, depth: Depth) -> Judged {
        let work = || self.one.install(|| self.judge_case(recipe, depth));
        catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
            let kind = Kind { who: "any".into(), what: What::Panic };
            let counts = Counts { scenes: 1, failures: 1, ..Counts::default() };
            Judged { counts, disagreements: vec![Disagreement { kind, aim: None, settings: 0 }] }
        })
    }

    fn judge_case(&self, recipe: &Recipe, depth: Depth) -> Judged {
        let case = recipe.case();
        let index = SceneIndex::new(&case.scene);
        let mut judged = Judged::default();
        judged.counts.scenes = 1;
        judged.counts.primitives = u64::from(case.scene.primitive_count());
        compare_first_hits(&case, &mut judged);
        let arbiter = Arbiter::new(&BuildInput::new(&case.scene, &index, case.light().position()));
        let truth = truth(&arbiter, &case, &mut judged.counts);
        if depth == Depth::All {
            check_arbiter(&case, &truth, &mut judged);
        }
        for (number, settings) in recipe.settings.iter().enumerate() {
            let input = settings.input(&case, &index);
            let fitting = |entry: &&&TesterEntry| match entry.basis {
                Basis::Truth => false,
                Basis::Exact => entry.lights.has(input.light),
                Basis::Measured => depth == Depth::All && number == 0 && entry.lights.has(input.light),
            };
            for entry in self.entries.iter().filter(fitting) {
                let answers = self.answers(entry, &input, &case, settings);
                compare(entry, number, answers, &truth, &case, &mut judged);
            }
        }
        judged
    }

    fn answers(
        &self,
        entry: &TesterEntry,
        input: &BuildInput,
        case: &Case,
        settings: &Settings,
    ) -> Result<(Vec<Answer>, Counters)> {
        let ask = || {
            let tester = (entry.build)(input)?;
            let batch = if settings.batch == Batch::One { 1 } else { case.points.len().max(1) };
            let mut answers = Vec::with_capacity(case.points.len());
            let mut counters = Counters::default();
            for points in case.points.chunks(batch) {
                let mut occluded = vec![false; points.len()];
                counters += tester.occluded(points, &mut occluded)?;
                let lit: Vec<_> =
                    points.iter().zip(&occluded).filter(|(_, o)| !**o).map(|(p, _)| *p).collect();
                let mut crossings = Crossings::default();
                if case.scene.has_transparent_casters() {
                    counters += tester.crossed(&lit, &mut crossings)?;
                } else {
                    lit.iter().for_each(|_| crossings.push([]));
                }
                let mut crossed = (0..lit.len()).map(|lit| crossings.of(lit).to_vec());
                let answer = |occluded| match occluded {
                    true => Answer::Occluded,
                    false => Answer::Lit(crossed.next().expect("a list for each point that is lit")),
                };
                answers.extend(occluded.into_iter().map(answer));
            }
            Ok((answers, counters))
        };
        match settings.threads {
            Threads::One => ask(),
            Threads::Two => self.two.install(ask),
        }
    }

    /// What everyone says of a recipe's only query in its first settings: the definition, the arbiter, then the
    /// testers; the rest of the line if there is no answer.
    pub fn everyone(&self, recipe: &Recipe) -> Vec<(&'static str, std::result::Result<Answer, String>)> {
        let case = recipe.case();
        let (Some(point), Some(settings)) = (case.points.first(), recipe.settings.first()) else {
            return Vec::new();
        };
        let index = SceneIndex::new(&case.scene);
        let input = settings.input(&case, &index);
        let plain = PlainTest::new(&case.scene, input.light, &case.points);
        let defined = definition(&plain, point);
        let arbiter = truth(&Arbiter::new(&input), &case, &mut Counts::default()).swap_remove(0);
        let mut said = vec![("definition", Ok(defined)), ("exact", Ok(arbiter))];
        for entry in self.entries.iter().filter(|entry| entry.basis != Basis::Truth) {
            let answer = match entry.lights.has(input.light) {
                false => Err("it has no answer for lights that are infinitely far away".into()),
                true => self.answers(entry, &input, &case, settings).map_err(|error| error.to_string()),
            };
            said.push((entry.name, answer.map(|(mut answers, _)| answers.swap_remove(0))));
        }
        said
    }
}

/// The arbiter's answers.
fn truth(arbiter: &Arbiter, case: &Case, counts: &mut Counts) -> Vec<Answer> {
    let decide = |point| {
        let truth = arbiter.decide(point);
        counts.queries += 1;
        counts.touching += u64::from(truth.contact == Contact::Touching);
        match truth.occlusion {
            Occlusion::Occluded => {
                counts.occluded += 1;
                Answer::Occluded
            }
            Occlusion::Lit => {
                let crossed = Arbiter::crossed(arbiter, point);
                counts.crossing += u64::from(!crossed.is_empty());
                Answer::Lit(crossed)
            }
        }
    };
    case.points.iter().map(decide).collect()
}

/// The definition's answer.
fn definition(plain: &PlainTest, point: &SurfacePoint) -> Answer {
    match plain.decide(point) {
        Occlusion::Occluded => Answer::Occluded,
        Occlusion::Lit => Answer::Lit(plain.crossed(point)),
    }
}

/// What an answer that should be another gets wrong, if anything.
fn difference(answer: &Answer, truth: &Answer) -> Option<What> {
    match (answer, truth) {
        (Answer::Occluded, Answer::Lit(_)) => Some(What::FalseShadow),
        (Answer::Lit(_), Answer::Occluded) => Some(What::FalseLight),
        (Answer::Lit(found), Answer::Lit(crossed)) if found != crossed => Some(What::Crossings),
        _ => None,
    }
}

fn compare(
    entry: &TesterEntry,
    settings: usize,
    answers: Result<(Vec<Answer>, Counters)>,
    truth: &[Answer],
    case: &Case,
    judged: &mut Judged,
) {
    let is_native = entry.basis == Basis::Exact;
    let mut disagree = |what: What, aim: Option<usize>| {
        if is_native {
            let kind = Kind { who: entry.name.into(), what };
            judged.disagreements.push(Disagreement { kind, aim, settings });
        }
    };
    let asked = judged.counts.testers.entry(entry.name).or_default();
    let Ok((answers, counters)) = answers else {
        asked.refused += 1;
        judged.counts.failures += u64::from(is_native);
        disagree(What::Error, None);
        return;
    };
    asked.answers += answers.len() as u64;
    asked.tests += counters.tests;
    asked.counts.undecided += counters.undecided;
    for ((answer, truth), &aim) in answers.iter().zip(truth).zip(&case.aims) {
        asked.counts.shadowed += u64::from(*answer == Answer::Occluded);
        let Some(what) = difference(answer, truth) else { continue };
        let count = match what {
            What::FalseShadow => &mut asked.counts.false_shadow,
            What::FalseLight => &mut asked.counts.false_light,
            _ => &mut asked.counts.false_transmittance,
        };
        *count += 1;
        asked.counts.wrong += 1;
        judged.counts.native_wrong += u64::from(is_native);
        disagree(what, Some(aim));
    }
}

fn check_arbiter(case: &Case, truth: &[Answer], judged: &mut Judged) {
    let plain = PlainTest::new(&case.scene, case.light().position(), &case.points);
    for ((point, truth), &aim) in case.points.iter().zip(truth).zip(&case.aims) {
        let defined = definition(&plain, point);
        judged.counts.arbiter_checked += 1;
        if let Some(what) = difference(truth, &defined) {
            judged.counts.arbiter_wrong += 1;
            let kind = Kind { who: "exact".into(), what };
            judged.disagreements.push(Disagreement { kind, aim: Some(aim), settings: 0 });
        }
    }
}

fn compare_first_hits(case: &Case, judged: &mut Judged) {
    let camera = &case.scene.cameras[0];
    let classical = FirstHitMethod::Classical.first_hits(&case.scene, camera, IMAGE);
    judged.counts.rays += classical.primitives.len() as u64;
    for method in [FirstHitMethod::TBuffer, FirstHitMethod::Hierarchy] {
        let hits = method.first_hits(&case.scene, camera, IMAGE);
        let differ = hits.primitives.iter().zip(&classical.primitives).filter(|(a, b)| a != b).count();
        judged.counts.first_hits_differ += differ as u64;
        if differ > 0 {
            let kind = Kind { who: method.name().into(), what: What::FirstHits };
            judged.disagreements.push(Disagreement { kind, aim: None, settings: 0 });
        }
    }
}

impl Counts {
    /// All that should agree and does not.
    pub fn disagreements(&self) -> u64 {
        self.native_wrong + self.arbiter_wrong + self.first_hits_differ + self.failures
    }
}

impl AddAssign<&Counts> for Counts {
    fn add_assign(&mut self, other: &Counts) {
        self.scenes += other.scenes;
        self.primitives += other.primitives;
        self.queries += other.queries;
        self.occluded += other.occluded;
        self.touching += other.touching;
        self.crossing += other.crossing;
        for (name, asked) in &other.testers {
            let sum = self.testers.entry(name).or_default();
            sum.answers += asked.answers;
            sum.tests += asked.tests;
            sum.counts += asked.counts;
            sum.refused += asked.refused;
        }
        self.native_wrong += other.native_wrong;
        self.arbiter_checked += other.arbiter_checked;
        self.arbiter_wrong += other.arbiter_wrong;
        self.rays += other.rays;
        self.first_hits_differ += other.first_hits_differ;
        self.failures += other.failures;
    }
}
