//! One scene, one view, one light: first hits by both tracers, and shadows by every contender, interleaved.

use super::{Contender, Plan};
use crate::error::{Error, Result};
use crate::measure::sample::{AnswersTo, Errors, Sample};
use crate::measure::{Answers, Question, Repeated, answer, timed};
use crate::scene::{Camera, Light, Scene};
use crate::shading::{RayForest, Textures, TreeRules, shade_picture};
use crate::shadow::exact::Arbiter;
use crate::shadow::{BuildInput, EmbreeSettings, Queries, SceneIndex};
use crate::visibility::{FirstHitMethod, FirstHits, VisibleSurfaces};

/// Queries of a frame that the arbiter decides, to see that brute force is right.
const TRUTH_SAMPLES: usize = 300;

/// What was measured of one scene.
#[derive(Debug, Clone)]
pub struct MeasuredFrame {
    /// Objects of the scene.
    pub objects: u32,
    /// Pixels of the image.
    pub pixels: u64,
    /// Pixels that see something.
    pub covered: u64,
    /// Points that face away from the light: dark without a shadow ray.
    pub facing_away: u64,
    /// Shadow rays.
    pub queries: u64,
    /// Those of them that reach the light.
    pub lit: u64,
    /// Every object for every ray from the eye.
    pub classical: MeasuredHits,
    /// Object by object.
    pub t_buffer: MeasuredHits,
    /// Pixels at which the two differ: none, or one of them is wrong.
    pub unlike_hits: u64,
    /// Seconds of what both tracers do alike: points, who faces the light, shading.
    pub shared_seconds: f64,
    /// Brute force first.
    pub testers: Vec<MeasuredTester>,
    /// Sampled answers of brute force that are not the arbiter's.
    pub wrong: u64,
}

/// What finding first hits took.
#[derive(Debug, Clone, Copy)]
pub struct MeasuredHits {
    /// The median of some repetitions.
    pub seconds: f64,
    /// Ray/object tests.
    pub tests: u64,
}

/// What a tester did.
#[derive(Debug, Clone)]
pub struct MeasuredTester {
    /// Which.
    pub contender: Contender,
    /// Seconds to build or fill it: the median of some repetitions.
    pub build_seconds: f64,
    /// Seconds to answer all queries, likewise.
    pub query_seconds: f64,
    /// Ray/object tests of the answers, not of building.
    pub tests: u64,
    /// Memory that it keeps.
    pub bytes: u64,
    /// Its answers against those of brute force.
    pub errors: Errors,
}

impl MeasuredTester {
    /// Building and asking.
    pub fn seconds(&self) -> f64 {
        self.build_seconds + self.query_seconds
    }
}

/// Measures the first camera and the only light of a scene. Brute force need not be named.
///
/// # Errors
/// If there is no camera or not one light, or whatever a tester reports.
pub fn measure(scene: &Scene, contenders: &[Contender], plan: &Plan) -> Result<MeasuredFrame> {
    let ([camera, ..], [light]) = (&scene.cameras[..], &scene.lights[..]) else {
        return Err(Error::Usage(format!("{}: expected a camera and one light", scene.name)));
    };
    let ([classical, t_buffer], hits, unlike_hits) = first_hits(scene, camera, plan);
    let seen = timed(|| VisibleSurfaces::new(scene, camera, &hits));
    let pixels = plan.size.pixels() as u64;
    let forest = RayForest::grow(scene, seen.value, pixels, TreeRules::of_depth(1));
    let chosen = timed(|| Queries::new(scene, &forest.nodes, light));
    let queries = chosen.value;
    let index = SceneIndex::new(scene);
    let embree = EmbreeSettings { threads: rayon::current_num_threads(), ..EmbreeSettings::default() };
    let input =
        BuildInput { memory: plan.memory, embree, ..BuildInput::new(scene, &index, light.position()) };
    let others = contenders.iter().copied().filter(|&contender| contender != Contender::BruteForce);
    let all: Vec<Contender> = [Contender::BruteForce].into_iter().chain(others).collect();
    let (testers, answers) = testers(&all, &queries, &input, plan)?;
    let sample = Sample::new(&Arbiter::new(&input), &queries, TRUTH_SAMPLES, Question::Occlusion);
    let shaded = timed(|| shade(scene, camera, light, &forest, &queries, &answers));
    Ok(MeasuredFrame {
        objects: scene.objects.len() as u32,
        pixels,
        covered: forest.nodes.seen as u64,
        facing_away: queries.facing_away.len() as u64,
        queries: queries.points.len() as u64,
        lit: answers.occluded.iter().filter(|&&occluded| !occluded).count() as u64,
        classical,
        t_buffer,
        unlike_hits,
        shared_seconds: seen.seconds + chosen.seconds + shaded.seconds,
        testers,
        wrong: sample.wrong(&answers, AnswersTo::AllQueries),
    })
}

/// Times of the classical tracer and of the t-buffer, what is seen, and at how many pixels the two differ.
fn first_hits(scene: &Scene, camera: &Camera, plan: &Plan) -> ([MeasuredHits; 2], FirstHits, u64) {
    let run = |method: FirstHitMethod, times: &mut Repeated| {
        let found = timed(|| method.first_hits(scene, camera, plan.size));
        times.push(found.seconds);
        found.value
    };
    let mut times = [Repeated::default(), Repeated::default()];
    let classical = run(FirstHitMethod::Classical, &mut times[0]);
    let filled = run(FirstHitMethod::TBuffer, &mut times[1]);
    for _ in 1..plan.repetitions {
        for (method, times) in [FirstHitMethod::Classical, FirstHitMethod::TBuffer].iter().zip(&mut times) {
            if times.is_worth_another(plan.repetitions) {
                run(*method, times);
            }
        }
    }
    let unlike = classical.primitives.iter().zip(&filled.primitives).filter(|(one, other)| one != other);
    let unlike = unlike.count() as u64;
    let measured = |i: usize, tests: u64| MeasuredHits { seconds: times[i].median(), tests };
    ([measured(0, classical.tests), measured(1, filled.tests)], filled, unlike)
}

/// What every tester did, and the answers of the first.
fn testers(
    contenders: &[Contender],
    queries: &Queries,
    input: &BuildInput,
    plan: &Plan,
) -> Result<(Vec<MeasuredTester>, Answers)> {
    let mut times = vec![[Repeated::default(), Repeated::default()]; contenders.len()];
    let mut of_first: Option<Answers> = None;
    let mut measured = Vec::new();
    for repetition in 0..plan.repetitions {
        for (&contender, [builds, asks]) in contenders.iter().zip(&mut times) {
            if !builds.is_worth_another(plan.repetitions) || !asks.is_worth_another(plan.repetitions) {
                continue;
            }
            let built = timed(|| contender.build(input));
            builds.push(built.seconds);
            let tester = built.value?;
            let answers = answer(tester.as_ref(), &queries.points, Question::Occlusion, &|_| {})?;
            asks.push(answers.seconds);
            if repetition > 0 {
                continue;
            }
            let first = of_first.get_or_insert_with(|| answers.clone());
            measured.push(MeasuredTester {
                contender,
                build_seconds: 0.0,
                query_seconds: 0.0,
                tests: answers.counters.tests,
                bytes: tester.bytes() as u64,
                errors: Errors::of(&answers.occluded, &first.occluded),
            });
        }
    }
    for (tester, [builds, asks]) in measured.iter_mut().zip(&times) {
        (tester.build_seconds, tester.query_seconds) = (builds.median(), asks.median());
    }
    Ok((measured, of_first.expect("brute force is asked at least once")))
}

fn shade(
    scene: &Scene,
    camera: &Camera,
    light: &Light,
    forest: &RayForest,
    queries: &Queries,
    answers: &Answers,
) {
    let arriving = queries.arriving(scene, forest.nodes.points.len(), &answers.occluded, None);
    let lights = std::slice::from_ref(light);
    shade_picture(scene, camera, lights, forest, &[arriving], Textures::Off);
}

impl MeasuredFrame {
    /// A tester, if it took part.
    pub fn tester(&self, contender: Contender) -> Option<&MeasuredTester> {
        self.testers.iter().find(|tester| tester.contender == contender)
    }

    /// Brute force.
    pub fn brute_force(&self) -> &MeasuredTester {
        &self.testers[0]
    }

    /// Seconds of the classical tracer for its rays: from the eye and to the light.
    pub fn classical_seconds(&self) -> f64 {
        self.classical.seconds + self.brute_force().seconds()
    }

    /// Seconds of the t-buffer with a tester, for the same.
    pub fn t_buffer_seconds(&self, tester: &MeasuredTester) -> f64 {
        self.t_buffer.seconds + tester.seconds()
    }

    /// How many times longer the classical tracer takes for its rays.
    pub fn gain(&self, tester: &MeasuredTester) -> f64 {
        self.classical_seconds() / self.t_buffer_seconds(tester)
    }

    /// The same for all that a picture takes, what both do alike included.
    pub fn frame_gain(&self, tester: &MeasuredTester) -> f64 {
        let shared = self.shared_seconds;
        (self.classical_seconds() + shared) / (self.t_buffer_seconds(tester) + shared)
    }

    /// The gain of the t-buffer with brute force that counted tests predict, if each of them takes equally long.
    pub fn predicted_gain(&self) -> f64 {
        let shadow = self.brute_force().tests;
        ratio(self.classical.tests + shadow, self.t_buffer.tests + shadow)
    }

    /// The most that the gain can be when first hits cost nothing: what shadow rays leave.
    pub fn gain_limit(&self) -> f64 {
        let shadow = self.brute_force().tests;
        ratio(self.classical.tests + shadow, shadow)
    }

    /// Share of the classical tracer's tests that shadow rays make.
    pub fn shadow_test_share(&self) -> f64 {
        let shadow = self.brute_force().tests;
        ratio(shadow, self.classical.tests + shadow)
    }

    /// Wrong answers of what must be exact: first hits that differ, brute force, and the light buffer.
    pub fn native_wrong(&self) -> u64 {
        let light_buffer = self.tester(Contender::LightBuffer).map_or(0, |tester| tester.errors.wrong());
        self.unlike_hits + self.wrong + light_buffer
    }
}

fn ratio(one: u64, other: u64) -> f64 {
    one as f64 / other.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::super::ObjectKind;
    use super::*;
    use crate::memory::MemoryLimit;
    use crate::scene::ImageSize;

    #[test]
    fn tests_are_counted_and_answers_agree() {
        let size = ImageSize { width: 40, height: 30 };
        let plan = Plan { size, repetitions: 1, memory: MemoryLimit::NONE };
        for kind in ObjectKind::ALL {
            let scene = kind.stacked(30).unwrap();
            let contenders = [Contender::ShadowBuffer(100), Contender::LightBuffer];
            let frame = measure(&scene, &contenders, &plan).unwrap();
            assert_eq!((frame.objects, frame.pixels, frame.native_wrong()), (30, 1200, 0));
            assert_eq!(frame.classical.tests, 1200 * 30);
            assert!(
                frame.t_buffer.tests >= frame.covered && frame.t_buffer.tests < frame.classical.tests / 4
            );
            // Who is lit was tested against everything, who is not against less.
            let shadow = frame.brute_force().tests;
            assert!(shadow >= frame.lit * 30 && shadow < frame.queries * 30);
            assert!(frame.predicted_gain() > 1.0 && frame.predicted_gain() < frame.gain_limit());
            let share = frame.shadow_test_share();
            assert!((frame.gain_limit() * share - 1.0).abs() < 1e-12);
            let buffer = frame.tester(Contender::ShadowBuffer(100)).unwrap();
            assert!(buffer.errors.wrong() > 0 && buffer.errors.wrong() < frame.queries / 4);
        }
    }
}
