//! A sample of the queries of a light, what the arbiter says about them, and how often others say otherwise.

use crate::measure::{Answers, Question};
use crate::scene::PrimitiveIndex;
use crate::shadow::Queries;
use crate::shadow::exact::{Arbiter, Contact, Occlusion};
use crate::visibility::SurfacePoint;
use rayon::prelude::*;

/// Answers that are not true, each way round.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct Errors {
    /// Lit, and called occluded.
    pub false_shadow: u64,
    /// Occluded, and called lit.
    pub false_light: u64,
}

impl Errors {
    /// Of answers to the same queries, in the same order.
    pub fn of(answers: &[bool], truth: &[bool]) -> Errors {
        let mut errors = Errors::default();
        for (answer, truth) in answers.iter().zip(truth) {
            errors.false_shadow += u64::from(*answer && !truth);
            errors.false_light += u64::from(!answer && *truth);
        }
        errors
    }

    /// Both.
    pub fn wrong(self) -> u64 {
        self.false_shadow + self.false_light
    }
}

/// Queries and the truth about them.
pub(super) struct Sample {
    /// The queries, by their places in the list of all.
    places: Vec<usize>,
    /// Their points.
    pub points: Vec<SurfacePoint>,
    truths: Vec<Truth>,
}

struct Truth {
    occluded: bool,
    touching: bool,
    /// What transparent surfaces the segment crosses; nothing if it is occluded.
    crossed: Vec<PrimitiveIndex>,
}

/// Which of a list of answers a sample is held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AnswersTo {
    /// All queries of the light.
    AllQueries,
    /// Those of the sample alone.
    TheSample,
}

impl Sample {
    /// At most so many queries, one as far from the next as any other; all of them for 0.
    pub fn new(arbiter: &Arbiter, queries: &Queries, most: usize, question: Question) -> Sample {
        let all = queries.points.len();
        let count = if most == 0 { all } else { most.min(all) };
        let places: Vec<usize> = (0..count).map(|i| i * all / count).collect();
        let points: Vec<SurfacePoint> = places.iter().map(|&place| queries.points[place]).collect();
        let decide = |point: &SurfacePoint| {
            let truth = arbiter.decide(point);
            let occluded = truth.occlusion == Occlusion::Occluded;
            let crossed = match question {
                Question::OcclusionAndCrossings if !occluded => arbiter.crossed(point),
                _ => Vec::new(),
            };
            Truth { occluded, touching: truth.contact == Contact::Touching, crossed }
        };
        let truths = points.par_iter().map(decide).collect();
        Sample { places, points, truths }
    }

    /// Those on the very edge between light and shadow.
    pub fn touching(&self) -> u64 {
        self.truths.iter().filter(|truth| truth.touching).count() as u64
    }

    /// Those that are occluded.
    pub fn occluded(&self) -> u64 {
        self.truths.iter().filter(|truth| truth.occluded).count() as u64
    }

    /// Whether each of them is occluded.
    pub fn truth(&self) -> Vec<bool> {
        self.truths.iter().map(|truth| truth.occluded).collect()
    }

    /// How many answers are not true.
    pub fn wrong(&self, answers: &Answers, to: AnswersTo) -> u64 {
        let is_wrong = |(i, truth): (usize, &Truth)| {
            let place = if to == AnswersTo::AllQueries { self.places[i] } else { i };
            let crosses_otherwise =
                || answers.crossings.as_ref().is_some_and(|c| c.of(place) != &truth.crossed[..]);
            answers.occluded[place] != truth.occluded || (!truth.occluded && crosses_otherwise())
        };
        self.truths.iter().enumerate().filter(|&pair| is_wrong(pair)).count() as u64
    }
}

/// How many of two testers' answers to the same queries differ.
pub(super) fn unlike(one: &Answers, other: &Answers) -> u64 {
    let crosses_otherwise = |i: usize| match (&one.crossings, &other.crossings) {
        (Some(one), Some(other)) => one.of(i) != other.of(i),
        _ => false,
    };
    let differs = |&i: &usize| one.occluded[i] != other.occluded[i] || crosses_otherwise(i);
    (0..one.occluded.len()).filter(differs).count() as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::procedural::find;
    use crate::shadow::{BuildInput, Counters, SceneIndex};
    use crate::visibility::{VisibleSurfaces, t_buffer};

    #[test]
    fn samples_are_spread_and_wrong_answers_are_found() {
        let scene = find("chessboard").unwrap().build(None).unwrap();
        let index = SceneIndex::new(&scene);
        let camera = &scene.cameras[0];
        let size = crate::scene::ImageSize { width: 24, height: 22 };
        let hits = t_buffer::first_hits(&scene, camera, size);
        let visible = VisibleSurfaces::new(&scene, camera, &hits);
        let light = &scene.lights[0];
        let queries = Queries::new(&scene, &visible, light);
        let arbiter = Arbiter::new(&BuildInput::new(&scene, &index, light.position()));
        let of = |most| Sample::new(&arbiter, &queries, most, Question::Occlusion);
        let (all, some) = (of(0), of(10));
        assert_eq!((all.points.len(), some.places.len()), (queries.points.len(), 10));
        assert!(some.places.windows(2).all(|pair| pair[0] < pair[1]));
        let answers = |occluded: Vec<bool>| Answers {
            occluded,
            crossings: None,
            counters: Counters::default(),
            seconds: 0.0,
        };
        let right = answers(all.truths.iter().map(|truth| truth.occluded).collect());
        let opposite = answers(right.occluded.iter().map(|occluded| !occluded).collect());
        assert_eq!(
            (all.wrong(&right, AnswersTo::AllQueries), some.wrong(&right, AnswersTo::AllQueries)),
            (0, 0)
        );
        assert_eq!(some.wrong(&opposite, AnswersTo::AllQueries), 10);
        let sampled = answers(some.truths.iter().map(|truth| truth.occluded).collect());
        assert_eq!(some.wrong(&sampled, AnswersTo::TheSample), 0);
        assert_eq!((unlike(&right, &right), unlike(&right, &opposite)), (0, queries.points.len() as u64));
    }
}
