//! Rays that pass within a few ulps of what is hard: every native answer against the arbiter, and that against the
//! definition in integers on a sample. Embree is asked the same and counted.
//!
//! `AIMED_RAYS` is the number of rays a class, 20,000 unless set; `make aimed-rays RAYS=1000000` is the long run.

use lightbuffer::hard_cases::aimed::Class;
use lightbuffer::hard_cases::{Inputs, Situation, judge_situations};
use lightbuffer::shadow::exact::Occlusion;
use lightbuffer::shadow::exact::plain::PlainTest;
use lightbuffer::shadow::{BESIDE, Basis, BuildInput, Counters, Culling, REGISTRY, TesterEntry};
use lightbuffer::verdict::Progress;
use std::collections::BTreeMap;

/// One situation in so many is held against all triangles in integers too.
const CHECKED: usize = 20;

fn rays() -> u64 {
    std::env::var("AIMED_RAYS").map_or(20_000, |rays| rays.parse().expect("AIMED_RAYS is a number"))
}

struct Silent;

impl Progress for Silent {
    fn stage(&self, _: &str) {}
    fn advance(&self, _: u64) {}
}

/// What a tester did in a class.
#[derive(Default)]
struct Sum {
    counters: Counters,
    false_shadow: u64,
    false_light: u64,
    seconds: f64,
}

fn every_answer_is_right(class: Class) {
    let entries: Vec<&'static TesterEntry> = REGISTRY
        .iter()
        .chain(BESIDE)
        .filter(|entry| entry.basis != Basis::Truth && entry.name != "shadow-buffer")
        .collect();
    let (mut queries, mut occluded, mut touching) = (0, 0, 0);
    let mut sums: BTreeMap<&str, Sum> = BTreeMap::new();
    for (number, situation) in class.situations(rays()).enumerate() {
        // Lists are simplified where solids are culled; both ways take turns, with every kind of light and point, which
        // change with the number modulo 4.
        let culling = if number / 4 % 2 == 0 { Culling::Off } else { Culling::ClosedSolids };
        let inputs: &Inputs =
            &|scene, index, light| BuildInput { culling, ..BuildInput::new(scene, index, light) };
        let judged = judge_situations(std::slice::from_ref(&situation), &entries, inputs, &Silent);
        let judged = judged.expect("the arbiter decides").remove(0);
        assert!(judged.refused.is_empty(), "{}: {:?}", situation.name, judged.refused);
        let verdict = judged.verdict;
        queries += verdict.truth.len() as u64;
        occluded += verdict.truth.iter().filter(|&&occluded| occluded).count() as u64;
        touching += verdict.touching.iter().filter(|&&touching| touching).count() as u64;
        for tester in &verdict.testers {
            let wrong = (0..verdict.truth.len()).find(|&i| tester.run.occluded[i] != verdict.truth[i]);
            if let (Basis::Exact, Some(first)) = (tester.run.basis, wrong) {
                panic!(
                    "{}: {} with {culling:?} at R = {:?}: {} wrong, first {:?}, light {:?}, truth {}",
                    situation.name,
                    tester.run.name,
                    situation.resolution,
                    tester.counts.wrong,
                    situation.points[first],
                    situation.light,
                    verdict.truth[first],
                );
            }
            let sum = sums.entry(tester.run.name).or_default();
            sum.counters += tester.run.counters;
            sum.false_shadow += tester.counts.false_shadow;
            sum.false_light += tester.counts.false_light;
            sum.seconds += tester.run.ns_per_query * 1e-9 * verdict.truth.len() as f64;
        }
        if number % CHECKED == 0 {
            assert_as_defined(&situation, &verdict.truth);
        }
    }
    // Points that face away from the light are left out, and so are rays that see nothing.
    assert!(queries * 3 > rays(), "{}: only {queries} of {} rays", class.name(), rays());
    assert!(occluded > queries / 50 && occluded < queries - queries / 50, "{}: {occluded}", class.name());
    println!("{}: {queries} queries, {occluded} occluded, {touching} touching", class.name());
    for (name, sum) in &sums {
        let wrong = sum.false_shadow + sum.false_light;
        let bound =
            if wrong == 0 { format!(", 95 % bound {:.1e}", 3.0 / queries as f64) } else { String::new() };
        println!(
            "  {name:<18} {wrong:>8} wrong ({} false shadow, {} false light){bound}; {:.4} undecided and {:.4} exact a test, {:.0} ns a query",
            sum.false_shadow,
            sum.false_light,
            sum.counters.undecided as f64 / sum.counters.tests.max(1) as f64,
            sum.counters.exact as f64 / sum.counters.tests.max(1) as f64,
            1e9 * sum.seconds / queries as f64,
        );
    }
}

fn assert_as_defined(situation: &Situation, truth: &[bool]) {
    let plain = PlainTest::new(&situation.scene, situation.light, &situation.points);
    for (point, &occluded) in situation.points.iter().zip(truth).step_by(7) {
        assert_eq!(plain.decide(point) == Occlusion::Occluded, occluded, "{}: {point:?}", situation.name);
    }
}

#[test]
fn edges() {
    every_answer_is_right(Class::Edges);
}

#[test]
fn corners() {
    every_answer_is_right(Class::Corners);
}

#[test]
fn silhouettes() {
    every_answer_is_right(Class::Silhouettes);
}

#[test]
fn cell_borders() {
    every_answer_is_right(Class::CellBorders);
}

#[test]
fn cube_seams() {
    every_answer_is_right(Class::CubeSeams);
}

#[test]
fn tangents() {
    every_answer_is_right(Class::Tangents);
}

#[test]
fn ends() {
    every_answer_is_right(Class::Ends);
}
