//! The hard cases of shadow testing: 47 numbered ones, each a few small scenes whose answers are known.
//!
//! What makes a case hard is said in its name. A case is one or several [`Situation`]s: a scene, a light, points,
//! and what is known of the answers without asking any tester. Where a case says so itself ("all outside is
//! dark"), that is [`Expected`]; otherwise the arbiter says what is true. All are made by the same few lines on
//! every machine, without a random number. Rays that are [aimed] at what is hard are many more, and random.

pub mod aimed;
mod cells;
mod curved;
pub mod differential;
mod edges;
mod ends;
mod invariance;
mod light;
mod parts;
mod run;
mod scale;
mod topology;

pub use run::{Inputs, Refusal, SituationVerdict, judge_situations};

use crate::geometry::LightPosition;
use crate::scene::Scene;
use crate::shadow::Receivers;
use crate::shadow::facing::{Facing, Sides};
use crate::visibility::SurfacePoint;

/// One of the numbered cases.
#[derive(Debug, Clone, Copy)]
pub struct HardCase {
    /// From 1 to [`COUNT`].
    pub number: u32,
    /// What is hard about it.
    pub name: &'static str,
    make: fn() -> Vec<Situation>,
}

/// How many there are.
pub const COUNT: u32 = 47;

/// A scene, a light, and points that are asked about.
#[derive(Debug, Clone)]
pub struct Situation {
    /// What is special about it, among those of its case.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// The light.
    pub light: LightPosition,
    /// The points; none of them faces away from the light.
    pub points: Vec<SurfacePoint>,
    /// What is known of the answers.
    pub expected: Expected,
    /// How many transparent primitives each segment crosses, if that is known.
    pub crossings: Option<Vec<usize>>,
    /// Cells along an edge of the light buffer, if the situation is about them.
    pub resolution: Option<u32>,
}

/// What is known of the answers by the way a situation is made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Expected {
    /// Every point is occluded.
    AllDark,
    /// No point is occluded.
    AllLit,
    /// Whether each point is occluded.
    Known(Vec<bool>),
    /// Bit for bit the answers to another situation of this case, by its place from 0; one before this.
    SameAs(usize),
    /// Nothing: only the arbiter can say.
    AsTruth,
}

/// All cases in the order of their numbers.
pub fn all() -> impl Iterator<Item = &'static HardCase> {
    [
        cells::CASES,
        light::CASES,
        ends::CASES,
        edges::CASES,
        scale::CASES,
        topology::CASES,
        curved::CASES,
        invariance::CASES,
    ]
    .into_iter()
    .flatten()
}

/// The case of a number.
pub fn find(number: u32) -> Option<&'static HardCase> {
    all().find(|case| case.number == number)
}

impl HardCase {
    const fn new(number: u32, name: &'static str, make: fn() -> Vec<Situation>) -> HardCase {
        HardCase { number, name, make }
    }

    /// Makes its scenes.
    pub fn situations(&self) -> Vec<Situation> {
        (self.make)()
    }
}

impl Situation {
    /// Points and what is known of them. Those on surfaces that face away are left out, for they are no shadow
    /// queries; answers that are [known](Expected::Known) one by one must be of bare points.
    fn new(
        name: impl Into<String>,
        scene: Scene,
        light: impl Into<LightPosition>,
        points: Vec<SurfacePoint>,
        expected: Expected,
    ) -> Situation {
        let light = light.into();
        let sides = Sides::of(&scene, light);
        let asked = |point: &SurfacePoint| sides.facing(&scene, point) == Facing::Towards;
        let points = points.into_iter().filter(asked).collect();
        Situation { name: name.into(), scene, light, points, expected, crossings: None, resolution: None }
    }

    /// The same for a light buffer of so many cells.
    fn at_resolution(self, cells: u32) -> Situation {
        Situation { resolution: Some(cells), ..self }
    }

    /// The same with the number of crossings known, point by point.
    fn crossing(self, times: Vec<usize>) -> Situation {
        Situation { crossings: Some(times), ..self }
    }

    /// Where its points may be: on surfaces only if all of them are.
    pub fn receivers(&self) -> Receivers {
        match self.points.iter().all(|point| point.primitive().is_some()) {
            true => Receivers::Surfaces,
            false => Receivers::Anywhere,
        }
    }

    /// The answers that are known, given those to the situations before it; `None` if only the arbiter can say.
    pub fn known(&self, before: &[Vec<bool>]) -> Option<Vec<bool>> {
        match &self.expected {
            Expected::AllDark => Some(vec![true; self.points.len()]),
            Expected::AllLit => Some(vec![false; self.points.len()]),
            Expected::Known(answers) => Some(answers.clone()),
            Expected::SameAs(other) => Some(before[*other].clone()),
            Expected::AsTruth => None,
        }
    }
}
