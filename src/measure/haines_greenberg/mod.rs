//! The measurements behind the tables of the 1986 paper: one scene, some views of it, and at every light the
//! control and light buffers of several resolutions, interleaved.
//!
//! Light by light, so that only one tester is in memory at a time. Views of one scene share its buffers (row 21
//! of the notes on the paper): they are built once, and asked for each view.

mod column;
mod looks;

pub use column::{Column, Lists, MeasuredColumn};
pub use looks::ViewOfScene;

use super::sample::{AnswersTo, Sample, unlike};
use super::{Answers, Question, Repeated, answer, timed};
use crate::error::Result;
use crate::memory::MemoryLimit;
use crate::scene::{ImageSize, Light, Scene};
use crate::shading::TreeStatistics;
use crate::shadow::exact::Arbiter;
use crate::shadow::{
    Basis, BuildInput, Counters, Queries, SceneIndex, TesterEntry, kept_light_buffer, testers,
};
use looks::Look;

/// What is measured, and how thoroughly.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Squares along an edge of each light buffer.
    pub resolutions: Vec<u32>,
    /// The most times that anything is done to time it.
    pub repetitions: u32,
    /// Queries of a view that the arbiter decides; 0 for all.
    pub truth_samples: usize,
    /// The most rays of a ray tree one behind the other.
    pub depth: u32,
    /// Buffers that need more are skipped.
    pub memory: MemoryLimit,
}

/// What was measured for one view.
#[derive(Debug, Clone)]
pub struct MeasuredView {
    /// The size of the image.
    pub size: ImageSize,
    /// Its ray trees.
    pub trees: TreeStatistics,
    /// Shadow rays: queries of all lights and all levels of the ray trees.
    pub queries: u64,
    /// Seconds to find first hits and to grow the ray trees.
    pub tree_seconds: f64,
    /// Seconds to shade the picture.
    pub colour_seconds: f64,
    /// Seconds for what belongs to none of these: making the scene, what its lights share, and choosing who is
    /// asked.
    pub miscellaneous_seconds: f64,
    /// The control and the light buffers.
    pub columns: Vec<MeasuredColumn>,
    /// Light buffers that did not fit into memory.
    pub skipped: Vec<Column>,
    /// Answers against the arbiter.
    pub truth: TruthCounts,
}

/// Sampled queries of a view and who was wrong about them.
#[derive(Debug, Clone, Default)]
pub struct TruthCounts {
    /// Sampled queries.
    pub queries: u64,
    /// Of them occluded.
    pub occluded: u64,
    /// Of them on the very edge between light and shadow.
    pub touching: u64,
    /// Exact native testers as they are set up unless something else is asked for, by name, and the number of
    /// their wrong answers.
    pub testers: Vec<(&'static str, u64)>,
}

/// A column at one light, while it is repeated.
struct ColumnAtLight {
    column: Column,
    builds: Repeated,
    /// One entry a view.
    asks: Vec<Repeated>,
}

/// Measures all views of a scene. `say` is told what is going on.
///
/// # Errors
/// Whatever a tester reports while it is built or asked.
pub fn measure(
    scene: &Scene,
    views: &[ViewOfScene],
    plan: &Plan,
    say: &dyn Fn(&str),
) -> Result<Vec<MeasuredView>> {
    let indexed = timed(|| {
        let index = SceneIndex::new(scene);
        index.solids(scene);
        index
    });
    let mut looks: Vec<Look> = views.iter().map(|view| Look::new(scene, view, plan)).collect();
    looks[0].measured.miscellaneous_seconds += indexed.seconds;
    for light in &scene.lights {
        say(&format!("light {}", light.name));
        at_light(scene, &indexed.value, light, plan, &mut looks)?;
    }
    Ok(looks.into_iter().map(|look| look.finish(scene, plan)).collect())
}

fn at_light(scene: &Scene, index: &SceneIndex, light: &Light, plan: &Plan, looks: &mut [Look]) -> Result<()> {
    let input = BuildInput { memory: plan.memory, ..BuildInput::new(scene, index, light.position()) };
    let question = Question::of(scene);
    let asked: Vec<Queries> = looks.iter_mut().map(|look| look.queries(scene, light)).collect();
    let arbiter = Arbiter::new(&input);
    let a_light = plan.truth_samples.div_ceil(scene.lights.len().max(1));
    let samples: Vec<Sample> =
        asked.iter().map(|queries| Sample::new(&arbiter, queries, a_light, question)).collect();
    for (look, sample) in looks.iter_mut().zip(&samples) {
        check_usual_testers(look, &input, sample, question)?;
    }
    let columns = [Column::Control].into_iter().chain(plan.resolutions.iter().map(|&r| Column::Buffer(r)));
    let fresh = |column| ColumnAtLight {
        column,
        builds: Repeated::default(),
        asks: vec![Repeated::default(); asked.len()],
    };
    let mut timings: Vec<ColumnAtLight> =
        columns.filter(|column| column.fits(plan.memory)).map(fresh).collect();
    let mut of_control: Vec<Answers> = Vec::new();
    for repetition in 0..plan.repetitions {
        for timing in &mut timings {
            if !timing.is_worth_another(plan.repetitions) {
                continue;
            }
            let built = timed(|| timing.column.build(&input));
            timing.builds.push(built.seconds);
            let built = built.value?;
            for (view, queries) in asked.iter().enumerate() {
                let answers = answer(built.tester(), &queries.points, question, &|_| {})?;
                timing.asks[view].push(answers.seconds);
                if repetition > 0 {
                    continue;
                }
                let entry = looks[view].column(timing.column);
                entry.counters += answers.counters;
                entry.wrong += samples[view].wrong(&answers, AnswersTo::AllQueries);
                entry.bytes += built.tester().bytes() as u64;
                if let Some(occupancy) = built.occupancy() {
                    entry.lists.get_or_insert_default().add(occupancy);
                }
                match timing.column {
                    Column::Control => of_control.push(answers),
                    Column::Buffer(_) => entry.unlike_control += unlike(&answers, &of_control[view]),
                }
            }
        }
    }
    for timing in &timings {
        for (view, look) in looks.iter_mut().enumerate() {
            let entry = look.column(timing.column);
            entry.query_seconds += timing.asks[view].median();
            if view == 0 {
                entry.build_seconds += timing.builds.median();
            }
        }
    }
    for ((look, queries), answers) in looks.iter_mut().zip(&asked).zip(&of_control) {
        look.light_arrives(scene, queries, answers);
    }
    Ok(())
}

impl ColumnAtLight {
    /// Both building and asking count.
    fn is_worth_another(&self, most: u32) -> bool {
        self.builds.is_worth_another(most) && self.asks.iter().all(|asks| asks.is_worth_another(most))
    }
}

/// Holds every exact native tester, as it is set up unless something else is asked for, against a sample; but for the one that is built for many views.
fn check_usual_testers(
    look: &mut Look,
    input: &BuildInput,
    sample: &Sample,
    question: Question,
) -> Result<()> {
    let truth = &mut look.measured.truth;
    truth.queries += sample.points.len() as u64;
    truth.occluded += sample.occluded();
    truth.touching += sample.touching();
    let is_asked =
        |entry: &&TesterEntry| entry.basis == Basis::Exact && entry.name != kept_light_buffer::HIGH.name;
    let exact = testers().filter(is_asked);
    for entry in exact {
        let tester = (entry.build)(input)?;
        let answers = answer(tester.as_ref(), &sample.points, question, &|_| {})?;
        let wrong = sample.wrong(&answers, AnswersTo::TheSample);
        match truth.testers.iter_mut().find(|(name, _)| *name == entry.name) {
            Some((_, sum)) => *sum += wrong,
            None => truth.testers.push((entry.name, wrong)),
        }
    }
    Ok(())
}

impl MeasuredView {
    /// A column, if it was measured.
    pub fn column(&self, column: Column) -> Option<&MeasuredColumn> {
        self.columns.iter().find(|measured| measured.column == column)
    }

    /// Answers of exact native testers that are wrong, or that differ where one of two must be.
    pub fn native_wrong(&self) -> u64 {
        let usual: u64 = self.truth.testers.iter().map(|(_, wrong)| wrong).sum();
        let of_columns: u64 = self.columns.iter().map(|column| column.wrong + column.unlike_control).sum();
        usual + of_columns
    }

    /// The paper's shadow tests per light ray: surfaces tested, volumes are not.
    pub fn tests_per_ray(&self, counters: &Counters) -> f64 {
        counters.tests as f64 / self.queries.max(1) as f64
    }
}
