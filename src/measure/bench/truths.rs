//! Who is wrong: answers are held against the arbiter on an even sample, and where two contenders differ.

use super::{Plan, Stage};
use crate::shadow::BuildInput;
use crate::shadow::exact::{Arbiter, Occlusion};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// What is known of the queries of a stage: nothing yet. The first answers are those that others are compared with.
#[derive(Default)]
pub struct Truths {
    /// Of each light, by places in rows.
    lights: Vec<BTreeMap<u32, bool>>,
    /// The answers that others are compared with, of each light.
    reference: Vec<Vec<bool>>,
}

/// Where answers are not the reference's, of each light.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Differences(Vec<Vec<u32>>);

/// How many answers are wrong of how many that were held against the truth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Wrong {
    /// Lit, and called occluded.
    pub false_shadow: u64,
    /// Occluded, and called lit.
    pub false_light: u64,
    /// Queries whose truth is known.
    pub checked: u64,
}

impl Truths {
    /// Where answers are not as the reference has them.
    pub fn differences(&mut self, answers: &[Vec<bool>]) -> Differences {
        if self.reference.is_empty() {
            self.reference = answers.to_vec();
            self.lights = vec![BTreeMap::new(); answers.len()];
        }
        let of_light = |(one, other): (&Vec<bool>, &Vec<bool>)| {
            let differs = |&(_, (one, other)): &(u32, (&bool, &bool))| one != other;
            (0..).zip(one.iter().zip(other)).filter(differs).map(|(place, _)| place).collect()
        };
        Differences(answers.iter().zip(&self.reference).map(of_light).collect())
    }

    /// Asks the arbiter about a sample of all queries, and about those at which answers differ.
    pub fn decide(&mut self, stage: &Stage, suspicious: &[&Differences], plan: &Plan) {
        let lights = stage.lights.len().max(1);
        for (number, light) in stage.lights.iter().enumerate() {
            let count = light.count();
            let sample = spread(count, plan.sample.div_ceil(lights)).map(|place| place as u32);
            let differing: BTreeSet<u32> =
                suspicious.iter().flat_map(|differences| differences.0[number].iter().copied()).collect();
            let differing: Vec<u32> = differing.into_iter().collect();
            let chosen = spread(differing.len(), plan.most_suspicious.div_ceil(lights)).map(|i| differing[i]);
            let known = &mut self.lights[number];
            let unknown: BTreeSet<u32> =
                sample.chain(chosen).filter(|place| !known.contains_key(place)).collect();
            if unknown.is_empty() {
                continue;
            }
            let points: Vec<_> = unknown.iter().map(|&place| (place, light.point(place))).collect();
            let arbiter = Arbiter::new(&BuildInput::new(stage.scene, &stage.index, light.light));
            let truth =
                |(place, point): &(u32, _)| (*place, arbiter.decide(point).occlusion == Occlusion::Occluded);
            let decided: Vec<(u32, bool)> = points.par_iter().map(truth).collect();
            known.extend(decided);
        }
    }

    /// How many of someone's answers are wrong.
    pub fn wrong(&self, differences: &Differences) -> Wrong {
        let mut wrong = Wrong::default();
        for ((known, reference), differing) in self.lights.iter().zip(&self.reference).zip(&differences.0) {
            for (&place, &truth) in known {
                let differs = differing.binary_search(&place).is_ok();
                let answer = reference[place as usize] != differs;
                wrong.false_shadow += u64::from(answer && !truth);
                wrong.false_light += u64::from(!answer && truth);
                wrong.checked += 1;
            }
        }
        wrong
    }
}

impl Wrong {
    /// Both.
    pub fn wrong(self) -> u64 {
        self.false_shadow + self.false_light
    }
}

/// At most so many numbers below an end, one as far from the next as any other.
fn spread(end: usize, most: usize) -> impl Iterator<Item = usize> {
    let count = most.min(end);
    (0..count).map(move |i| i * end / count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_from_the_reference_is_counted_where_the_truth_is_known() {
        let mut truths = Truths::default();
        let reference = truths.differences(&[vec![false, true, true, false]]);
        assert_eq!(reference, Differences(vec![vec![]]));
        let other = truths.differences(&[vec![true, true, false, false]]);
        assert_eq!(other, Differences(vec![vec![0, 2]]));
        truths.lights[0] = BTreeMap::from([(0, true), (1, true), (2, true)]);
        assert_eq!(truths.wrong(&reference), Wrong { false_shadow: 0, false_light: 1, checked: 3 });
        assert_eq!(truths.wrong(&other), Wrong { false_shadow: 0, false_light: 1, checked: 3 });
        truths.lights[0].insert(3, true);
        assert_eq!(truths.wrong(&other).wrong(), 2);
    }

    #[test]
    fn samples_are_even() {
        assert_eq!(spread(10, 5).collect::<Vec<_>>(), [0, 2, 4, 6, 8]);
        assert_eq!((spread(3, 5).count(), spread(0, 5).count()), (3, 0));
    }
}
