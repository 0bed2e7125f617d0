//! Differential fuzzing: a fixed part of it with no disagreement, findings of the past, and testers that are wrong on
//! purpose, so that it is known to find, to shrink and to replay.
//!
//! `lightbuffer fuzz` tries as many scenes as are wanted.

use lightbuffer::Result;
use lightbuffer::SurfacePoint;
use lightbuffer::hard_cases::differential::{Finding, Found, Judge, Kind, Plan, What, recipe, search};
use lightbuffer::scene::PrimitiveIndex;
use lightbuffer::shadow::exact::{Arbiter, Contact, Occlusion};
use lightbuffer::shadow::{Basis, Counters, Crossings, Lights, REGISTRY, ShadowTester, TesterEntry};
use std::path::Path;

/// Scenes that every run of the tests tries.
const SCENES: u64 = if cfg!(debug_assertions) { 100 } else { 1_500 };

/// Scenes among which a tester that is wrong on purpose is found.
const FEW: u64 = 40;

fn native() -> Vec<&'static TesterEntry> {
    REGISTRY.iter().filter(|entry| entry.basis == Basis::Exact).collect()
}

fn tried(scenes: u64, threads: usize, entries: &[&'static TesterEntry]) -> Found {
    let plan = Plan { seed: 2026, numbers: 0..scenes, time: None, threads };
    search(&plan, entries, &|_| {}).expect("threads")
}

#[test]
fn all_testers_agree_on_scenes_with_a_healthy_mix() {
    let found = tried(SCENES, 1, &native());
    let counts = &found.counts;
    assert_eq!((counts.scenes, counts.disagreements()), (SCENES, 0), "{:#?}", found.findings);
    let share = |part: u64| part as f64 / counts.queries as f64;
    assert!(share(SCENES) < 0.1, "{} queries", counts.queries);
    assert!((0.2..0.8).contains(&share(counts.occluded)), "{} occluded", counts.occluded);
    assert!(share(counts.touching) > 0.02, "{} touching", counts.touching);
    assert!(share(counts.crossing) > 0.005, "{} through glass", counts.crossing);
    assert!(share(counts.arbiter_checked) > 0.2, "{} checked", counts.arbiter_checked);
    assert!(counts.rays > 0);
    for (name, asked) in &counts.testers {
        assert!(asked.answers > counts.queries, "{name} was asked in one setting alone");
        assert!(asked.counts.undecided * 50 > asked.tests, "{name}: {} undecided", asked.counts.undecided);
    }
}

#[test]
fn what_comes_out_does_not_depend_on_threads() {
    let [one, two] = [1, 2].map(|threads| tried(60, threads, &native()));
    assert_eq!(one.counts, two.counts);
    let again = recipe(2026, 17);
    assert_eq!(recipe(2026, 17), again);
    assert_ne!(recipe(2027, 17), again);
    assert_ne!(recipe(2026, 18), again);
}

#[test]
fn findings_are_read_back_bit_by_bit() {
    let folder = tempfile::tempdir().unwrap();
    for number in 0..150 {
        let mut recipe = recipe(7, number);
        recipe.settings.truncate(1);
        let case = recipe.case();
        if case.scene.primitive_count() == 0 {
            continue;
        }
        let kind = Kind { who: "light-buffer".into(), what: What::FalseLight };
        let finding = Finding { kind, seed: 7, number, recipe };
        let path = finding.save(folder.path()).unwrap();
        assert!(path.ends_with(format!("light-buffer-false-light-7-{number}.toml")));
        let read = Finding::load(&path).unwrap();
        let again = read.recipe.case();
        assert_eq!((&read.kind, read.recipe.settings), (&finding.kind, finding.recipe.settings));
        assert_eq!(read.recipe.aims, finding.recipe.aims);
        assert_eq!(again.scene.hash(), case.scene.hash(), "scene {number}");
        assert_eq!(again.points, case.points, "scene {number}");
        assert_eq!(again.scene.lights, case.scene.lights);
        assert_eq!(again.scene.cameras, case.scene.cameras);
    }
}

#[test]
fn findings_of_the_past_are_no_longer_there() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regressions");
    let files = folder.read_dir().unwrap().map(|entry| entry.unwrap().path());
    let is_finding = |path: &std::path::PathBuf| !path.to_string_lossy().ends_with(".scene.toml");
    let findings: Vec<_> = files.filter(is_finding).collect();
    assert!(!findings.is_empty());
    let entries = native();
    let judge = Judge::new(&entries).unwrap();
    for path in findings {
        let finding = Finding::load(&path).unwrap();
        let asked = judge.everyone(&finding.recipe);
        let is_about_rays = finding.kind.what == What::FirstHits;
        assert!(is_about_rays || !asked.is_empty(), "{}: nobody is asked", path.display());
        assert!(!finding.is_still_there(&judge), "{}", path.display());
    }
}

/// What a tester makes of the truth about one point.
type Bent = fn(&Arbiter, &SurfacePoint) -> (bool, Vec<PrimitiveIndex>);

/// The arbiter, bent.
struct Wrong<'a>(Arbiter<'a>, Bent);

impl ShadowTester for Wrong<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        for (point, answer) in points.iter().zip(answers) {
            *answer = self.1(&self.0, point).0;
        }
        Ok(Counters::default())
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        points.iter().for_each(|point| crossings.push(self.1(&self.0, point).1));
        Ok(Counters::default())
    }

    fn bytes(&self) -> usize {
        0
    }
}

fn is_occluded(arbiter: &Arbiter, point: &SurfacePoint) -> bool {
    arbiter.decide(point).occlusion == Occlusion::Occluded
}

macro_rules! wrong {
    ($name:literal, $bent:expr) => {
        TesterEntry {
            name: $name,
            basis: Basis::Exact,
            lights: Lights::All,
            build: &|input| Ok(Box::new(Wrong(Arbiter::new(input), $bent))),
            of_scene: None,
            expected_tests: |_, queries| queries,
        }
    };
}

/// Lets light through where a segment meets nothing but edges.
static OPEN_EDGES: TesterEntry = wrong!("open-edges", |arbiter, point| {
    let grazes = arbiter.decide(point).contact == Contact::Touching;
    (is_occluded(arbiter, point) && !grazes, arbiter.crossed(point))
});

/// Says the opposite on the first triangle of each scene.
static INVERTED_ON_ONE: TesterEntry = wrong!("inverted-on-one", |arbiter, point| {
    (is_occluded(arbiter, point) != (point.primitive() == Some(0)), arbiter.crossed(point))
});

/// Counts a crossing once too often.
static CROSSES_AGAIN: TesterEntry = wrong!("crosses-again", |arbiter, point| {
    let mut crossed = arbiter.crossed(point);
    crossed.extend(crossed.first().copied());
    (is_occluded(arbiter, point), crossed)
});

/// Falls over glass.
static PANICS: TesterEntry = wrong!("panics", |arbiter, point| {
    assert!(arbiter.crossed(point).is_empty(), "on purpose");
    (is_occluded(arbiter, point), Vec::new())
});

/// Finds a wrong tester, and makes its first finding small: what shadows a point, and what that lies on.
fn found(wrong: &'static TesterEntry, what: What) {
    let found = tried(FEW, 2, &[wrong]);
    assert!(found.counts.disagreements() > 0);
    let who = if what == What::Panic { "any" } else { wrong.name };
    let kind = Kind { who: who.into(), what };
    let finding = found.findings.into_iter().find(|finding| finding.kind == kind).expect("it is found");
    assert!(finding.recipe.primitives() <= 2, "{:#?}", finding.recipe);
    assert_eq!((finding.recipe.aims.len(), finding.recipe.settings.len()), (1, 1));
    let folder = tempfile::tempdir().unwrap();
    let read = Finding::load(&finding.save(folder.path()).unwrap()).unwrap();
    assert!(read.is_still_there(&Judge::new(&[wrong]).unwrap()));
    assert!(!read.is_still_there(&Judge::new(&native()).unwrap()));
}

#[test]
fn a_tester_with_open_edges_is_found() {
    found(&OPEN_EDGES, What::FalseLight);
}

#[test]
fn a_tester_that_is_wrong_on_one_triangle_is_found_in_both_directions() {
    found(&INVERTED_ON_ONE, What::FalseShadow);
    found(&INVERTED_ON_ONE, What::FalseLight);
}

#[test]
fn a_tester_that_crosses_glass_once_too_often_is_found() {
    found(&CROSSES_AGAIN, What::Crossings);
}

#[test]
fn a_tester_that_panics_is_found() {
    found(&PANICS, What::Panic);
}
