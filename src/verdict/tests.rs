//! Verdicts on answers that are made up, about a scene whose truth is plain to see.

use super::*;
use crate::error::{Error, Result};
use crate::scene::{Material, ObjectInput, Scene, SceneBuilder, Transmission};
use crate::shadow::exact::{Arbiter, Span};
use crate::shadow::{
    Basis, Build, BuildInput, Counters, Crossings, EmbreeSettings, Lights, Queries, SceneIndex, ShadowTester,
    TesterEntry, TracedRay, exact,
};
use crate::visibility::SurfacePoint;
use glam::Vec3;
use std::ops::AddAssign;
use std::sync::Mutex;

const LIGHT: Vec3 = Vec3::new(0.0, 4.0, 0.0);

/// Points on the ground: beside everything, behind what is opaque, behind what is not, and behind an edge.
const X: [f32; 8] = [0.0, 4.0, -4.0, 2.0, 1.0, 6.0, -6.0, 8.0];
const TRUTH: [bool; 8] = [false, true, false, true, false, true, false, true];

/// Two triangles at half the height of the light: an opaque one from x = 1 on, and a transparent one from -1.
fn scene() -> Scene {
    let mut builder = SceneBuilder::new("test");
    let transmission = Some(Transmission { transmittance: [0.5; 3], refractive_index: 1.0 });
    let glass = builder.add_material(Material { transmission, ..Material::default() });
    for (side, material) in [(1.0, 0), (-1.0, glass)] {
        let corner = |x: f32, z: f32| Vec3::new(side * x, 2.0, z);
        let positions = vec![corner(1.0, -9.0), corner(1.0, 9.0), corner(20.0, 0.0)];
        builder
            .add_object(ObjectInput { material, ..ObjectInput::new("o", positions, vec![[0, 1, 2]]) })
            .unwrap();
    }
    builder.finish()
}

fn queries() -> Queries {
    let points = X.map(|x| SurfacePoint::bare(Vec3::new(x, 0.0, 0.0)).unwrap()).to_vec();
    Queries { points, nodes: (0..8).collect(), ..Queries::default() }
}

/// The place of a point among those above.
fn place(point: &SurfacePoint) -> usize {
    X.iter().position(|&x| f64::from(x) == point.position.x).expect("one of them")
}

/// Says what it was told to say.
#[derive(Clone)]
struct Parrot {
    occluded: [bool; 8],
    crossings: [&'static [u32]; 8],
    rays: Option<fn(usize) -> TracedRay>,
}

/// What is true.
const RIGHT: Parrot =
    Parrot { occluded: TRUTH, crossings: [&[], &[], &[1], &[], &[], &[], &[1], &[]], rays: None };

impl ShadowTester for Parrot {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        points.iter().zip(answers).for_each(|(point, answer)| *answer = self.occluded[place(point)]);
        Ok(Counters { tests: 3, undecided: 2, ..Counters::default() })
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        points.iter().for_each(|point| crossings.push(self.crossings[place(point)].to_vec()));
        Ok(Counters::default())
    }

    fn bytes(&self) -> usize {
        17
    }

    fn traced_ray(&self, point: &SurfacePoint) -> Option<TracedRay> {
        self.rays.map(|ray| ray(place(point)))
    }
}

fn entry(name: &'static str, basis: Basis, build: Box<Build>) -> TesterEntry {
    TesterEntry {
        name,
        basis,
        lights: Lights::All,
        build: Box::leak(build),
        of_scene: None,
        expected_tests: |_, queries| queries,
    }
}

fn parrot(name: &'static str, basis: Basis, parrot: Parrot) -> TesterEntry {
    entry(name, basis, Box::new(move |_| Ok(Box::new(parrot.clone()))))
}

/// What a run tells of itself.
#[derive(Default)]
struct Told(Mutex<(Vec<String>, u64)>);

impl Progress for Told {
    fn stage(&self, name: &str) {
        self.0.lock().unwrap().0.push(name.to_string());
    }

    fn advance(&self, queries: u64) {
        self.0.lock().unwrap().1 += queries;
    }
}

#[test]
fn every_query_is_counted_once_and_a_wrong_crossing_is_a_wrong_answer() {
    let (scene, queries) = (scene(), queries());
    let index = SceneIndex::new(&scene);
    let input = BuildInput::new(&scene, &index, LIGHT);
    // Wrong about the first point, and about the glass before the third.
    let mut shadow = RIGHT;
    shadow.occluded[0] = true;
    shadow.crossings[2] = &[];
    // Wrong about the glass and one of those behind it; what it says of an occluded point's glass is not asked.
    let mut light = RIGHT;
    light.occluded[1] = false;
    light.crossings[2] = &[1, 1];
    light.crossings[5] = &[1];
    let mut nothing_right = RIGHT;
    nothing_right.occluded = TRUTH.map(|occluded| !occluded);
    let entries = [
        exact::ENTRY,
        parrot("first", Basis::Exact, RIGHT),
        parrot("second", Basis::Exact, shadow),
        parrot("measured", Basis::Measured, nothing_right),
        parrot("embree", Basis::Measured, light),
    ];
    let told = Told::default();
    let verdict = judge(&input, &queries, &entries.each_ref(), &told).unwrap();
    assert_eq!(verdict.truth, TRUTH);
    assert_eq!(verdict.touching, [false, false, false, true, false, false, false, false]);
    let counts = VerdictCounts { agree: 5, native_wrong: 1, embree_wrong: 1, both_wrong: 1, touching: 1 };
    assert_eq!(verdict.counts, counts);
    assert!(verdict.tester("third").is_none());
    let of = |name: &str| verdict.tester(name).unwrap();
    let right = TesterCounts { shadowed: 4, ..TesterCounts::default() };
    let asked = TesterCounts { undecided: 2, ..right };
    assert_eq!((of("exact").counts, of("first").counts), (right, asked));
    let second = TesterCounts { shadowed: 5, false_shadow: 1, false_transmittance: 1, wrong: 2, ..asked };
    let embree = TesterCounts { shadowed: 3, false_light: 1, false_transmittance: 1, wrong: 2, ..asked };
    assert_eq!((of("second").counts, of("embree").counts), (second, embree));
    let measured = TesterCounts { shadowed: 4, false_shadow: 4, false_light: 4, wrong: 8, ..asked };
    assert_eq!(of("measured").counts, measured);
    assert!(verdict.testers.iter().all(|tester| tester.explained.is_none() && tester.causes().is_none()));
    let Parrot { crossings, .. } = RIGHT;
    let crossed = verdict.crossed.as_ref().unwrap();
    assert!((0..8).all(|i| crossed.of(i) == crossings[i]));
    let run = &of("second").run;
    assert_eq!((run.name, run.basis, run.bytes, run.counters.tests), ("second", Basis::Exact, 17, 3));
    assert!(run.occluded[0] && run.crossings.as_ref().unwrap().of(2).is_empty());
    let (stages, advanced) = told.0.into_inner().unwrap();
    assert_eq!(stages, ["exact", "first", "second", "measured", "embree"]);
    assert_eq!(advanced, 5 * 8);
}

#[test]
fn wrong_answers_of_float_rays_are_put_down_to_what_made_them_wrong() {
    let (scene, queries) = (scene(), queries());
    let index = SceneIndex::new(&scene);
    let input = BuildInput::new(&scene, &index, LIGHT);
    let ray = |place: usize| {
        let origin = Vec3::new(X[place], 0.0, 0.0);
        let ray = TracedRay {
            origin,
            direction: LIGHT - origin,
            t_near: 0.0,
            t_far: 1.0,
            t_light: 1.0,
            excluded: None,
        };
        match place {
            // What is in the way lies before the ray begins,
            5 => TracedRay { t_near: 0.75, ..ray },
            // the ray goes past it,
            7 => TracedRay { direction: Vec3::new(0.0, 4.0, 90.0), ..ray },
            // or the ray meets it.
            _ => ray,
        }
    };
    let mut wrong = RIGHT;
    wrong.rays = Some(ray);
    for place in [1, 5, 7] {
        wrong.occluded[place] = false;
    }
    let entries = [parrot("embree", Basis::Measured, wrong)];
    let verdict = judge(&input, &queries, &entries.each_ref(), &Told::default()).unwrap();
    let [tester] = &verdict.testers[..] else { panic!("one tester") };
    let expected = [(1, Cause::Traversal), (5, Cause::Epsilon), (7, Cause::InputRounding)];
    assert_eq!(
        tester.explained.as_deref(),
        Some(&expected.map(|(query, cause)| WrongAnswer { query, cause })[..])
    );
    assert_eq!(tester.causes(), Some(CauseCounts { epsilon: 1, input_rounding: 1, traversal: 1 }));
    // And of an answer that is wrongly dark.
    let arbiter = Arbiter::new(&input);
    assert!(!arbiter.is_blocked(&ray(0), Span::Whole));
    assert_eq!(Cause::of(&arbiter, &ray(0), true), Cause::Traversal);
    assert_eq!(Cause::ALL.map(Cause::code), [100, 200, 300]);
    assert_eq!(Cause::ALL.map(Cause::name), ["epsilon", "input rounding", "traversal"]);
}

#[test]
fn what_is_known_before_stands_above_the_arbiter() {
    let (scene, queries) = (scene(), queries());
    let index = SceneIndex::new(&scene);
    let input = BuildInput::new(&scene, &index, LIGHT);
    let mut known = TRUTH;
    known[4] = true;
    let fails = |_: &BuildInput<'_>| -> Result<Box<dyn ShadowTester>> { Err(Error::Usage("no".into())) };
    let entries = [
        exact::ENTRY,
        entry("fails", Basis::Exact, Box::new(move |input| fails(input))),
        parrot("native", Basis::Exact, RIGHT),
    ];
    let mut refused = Vec::new();
    let mut note = |name, _| {
        refused.push(name);
        Ok(())
    };
    let told = Told::default();
    let verdict = judge_known(&input, &queries, &entries.each_ref(), Some(&known), &mut note, &told).unwrap();
    assert_eq!((refused, verdict.testers.len()), (vec!["fails"], 2));
    assert_eq!((verdict.truth, verdict.counts.native_wrong, verdict.counts.agree), (known.to_vec(), 1, 7));
    assert!(verdict.testers.iter().all(|tester| tester.counts.wrong == 1 && tester.counts.false_light == 1));
    assert!(judge(&input, &queries, &entries.each_ref(), &told).is_err(), "an error is not passed over");
}

#[test]
fn one_tester_alone_answers_as_it_is() {
    let (scene, queries) = (scene(), queries());
    let index = SceneIndex::new(&scene);
    let input = BuildInput::new(&scene, &index, LIGHT);
    let run = run_tester(&parrot("one", Basis::Exact, RIGHT), &input, &queries, &Told::default()).unwrap();
    assert_eq!((run.name, run.occluded), ("one", TRUTH.to_vec()));
    assert!(run.ns_per_query > 0.0 && run.soft_light.is_none());
    assert_eq!([judge::per_query(2.0, 4), judge::per_query(2.0, 0)], [5e8, 0.0]);
}

#[test]
fn every_epsilon_is_tried_and_nothing_else_is_changed() {
    let (scene, queries) = (scene(), queries());
    let index = SceneIndex::new(&scene);
    let embree = EmbreeSettings { threads: 3, ..EmbreeSettings::default() };
    let input = BuildInput { embree, ..BuildInput::new(&scene, &index, LIGHT) };
    // Dark everywhere with a small epsilon, light everywhere with a large one.
    let build = |input: &BuildInput<'_>| -> Result<Box<dyn ShadowTester>> {
        assert_eq!(input.embree.threads, 3);
        Ok(Box::new(Parrot { occluded: [input.embree.epsilon < 1e-5; 8], ..RIGHT }))
    };
    let tester = entry("e", Basis::Measured, Box::new(move |input| build(input)));
    let found =
        sweep_epsilon(&tester, &input, &queries, &[true, true, true, false, false, false, false, false]);
    let expected = EPSILONS.map(|epsilon| {
        let (false_shadow, false_light) = if epsilon < 1e-5 { (5, 0) } else { (0, 3) };
        EpsilonCounts { tester: "e", epsilon, false_shadow, false_light }
    });
    assert_eq!(found.unwrap(), expected);
}

#[test]
fn the_arbiter_is_checked_at_places_that_are_evenly_spread() {
    let (scene, queries) = (scene(), queries());
    let mut truth = TRUTH;
    // Of four places out of eight the first and every second one after it are looked at.
    for place in [0, 1, 6] {
        truth[place] = !truth[place];
    }
    for (most, expected) in [(4, (4, 2)), (100, (8, 3)), (0, (0, 0))] {
        let told = Told::default();
        let check = check_arbiter(&scene, LIGHT.into(), &queries, &truth, most, &|n| told.advance(n));
        assert_eq!((check.queries, check.wrong), expected);
        assert_eq!(told.0.into_inner().unwrap().1, expected.0);
    }
}

#[test]
fn a_pixel_shows_who_is_wrong() {
    use PixelVerdict::*;
    let verdicts = |truth: bool| {
        let embree = [None, Some(truth), Some(!truth)];
        [truth, !truth].map(|native| embree.map(|embree| PixelVerdict::new(native, embree, truth)))
    };
    assert_eq!(verdicts(false), [[Lit, Lit, EmbreeWrong], [NativeWrong, NativeWrong, BothWrong]]);
    assert_eq!(verdicts(true), [[Occluded, Occluded, EmbreeWrong], [NativeWrong, NativeWrong, BothWrong]]);
    let all = [
        Background,
        FacingAway,
        Lit,
        Occluded,
        NativeWrong,
        EmbreeWrong,
        BothWrong,
        OutsideCone,
        NotReceiving,
    ];
    assert!(all.iter().zip(0..).all(|(verdict, code)| verdict.code() == code));
}

/// A sum of two.
fn sum<T: AddAssign>(mut a: T, b: T) -> T {
    a += b;
    a
}

#[test]
fn counts_of_several_lights_are_added_each_to_its_own() {
    let tester = |n: u64| TesterCounts {
        shadowed: n,
        false_shadow: 2 * n,
        false_light: 3 * n,
        false_transmittance: 4 * n,
        wrong: 5 * n,
        undecided: 6 * n,
    };
    assert_eq!(sum(tester(5), tester(7)), tester(12));
    let verdict = |n: u64| VerdictCounts {
        agree: n,
        native_wrong: 2 * n,
        embree_wrong: 3 * n,
        both_wrong: 4 * n,
        touching: 5 * n,
    };
    assert_eq!(sum(verdict(5), verdict(7)), verdict(12));
    let causes = |n: u64| CauseCounts { epsilon: n, input_rounding: 2 * n, traversal: 3 * n };
    assert_eq!(sum(causes(5), causes(7)), causes(12));
    let epsilon = |n: u64| EpsilonCounts { tester: "t", epsilon: 0.5, false_shadow: n, false_light: 2 * n };
    assert_eq!(sum(epsilon(5), epsilon(7)), epsilon(12));
    assert!(is_zero(&0) && !is_zero(&1));
}
