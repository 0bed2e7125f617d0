//! Case 36: whoever flushes denormals, around us or in the very thread that asks, no answer is another one.

use crate::case;
#[cfg(feature = "embree")]
use crate::ways::{Way, ask_here};
use glam::Vec3;
use lightbuffer::hard_cases::Situation;
use lightbuffer::measure::{Question, answer};
use lightbuffer::scene::{Camera, ImageSize};
use lightbuffer::shadow::exact::plain::PlainTest;
use lightbuffer::shadow::exact::{Arbiter, Occlusion};
#[cfg(feature = "embree")]
use lightbuffer::shadow::find;
use lightbuffer::shadow::{Basis, BuildInput, REGISTRY, Resolution, SceneIndex, TesterEntry};
use lightbuffer::visibility::FirstHitMethod;
use std::arch::asm;

const FLUSH_TO_ZERO: u32 = 1 << 15;
const DENORMALS_ARE_ZERO: u32 = 1 << 6;

fn control_word() -> u32 {
    let mut value = 0_u32;
    // SAFETY: stores the register in a variable that is as wide as it.
    unsafe { asm!("stmxcsr [{}]", in(reg) &mut value, options(nostack, preserves_flags)) };
    value
}

fn set_control_word(value: u32) {
    // SAFETY: all exceptions stay masked, since only words that were read and the two bits above are set.
    unsafe { asm!("ldmxcsr [{}]", in(reg) &value, options(nostack, preserves_flags)) };
}

/// Runs something in a thread of its own that flushes denormals.
fn flushed<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let in_thread = || {
        let before = control_word();
        set_control_word(before | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
        let result = work();
        set_control_word(before);
        result
    };
    std::thread::scope(|scope| scope.spawn(in_thread).join().unwrap())
}

/// What is said of a situation.
#[derive(Debug, PartialEq)]
struct Everything {
    /// By all native testers, the arbiter and the definition.
    answers: Vec<(&'static str, Vec<bool>)>,
    /// The first hits of a camera, by each way to find them.
    seen: [Vec<Option<u32>>; 3],
}

fn everything(situation: &Situation) -> Everything {
    let (scene, light) = (&situation.scene, situation.light);
    let index = SceneIndex::new(scene);
    let input = BuildInput {
        resolution: Resolution::Cells(16),
        receivers: situation.receivers(),
        ..BuildInput::new(scene, &index, light)
    };
    let native = REGISTRY.iter().filter(|entry| entry.basis != Basis::Measured);
    let ask = |entry: &&'static TesterEntry| {
        let tester = (entry.build)(&input).unwrap();
        let answers = answer(tester.as_ref(), &situation.points, Question::of(scene), &|_| {}).unwrap();
        (entry.name, answers.occluded)
    };
    let mut answers: Vec<_> = native.map(|entry| ask(&entry)).collect();
    let plain = PlainTest::new(scene, light, &situation.points);
    let decide = |point| plain.decide(point) == Occlusion::Occluded;
    answers.push(("the definition", situation.points.iter().map(decide).collect()));
    let arbiter = Arbiter::new(&input);
    let decide = |point| arbiter.decide(point).occlusion == Occlusion::Occluded;
    answers.push(("the arbiter", situation.points.iter().map(decide).collect()));
    let camera = Camera::look_at("eye", Vec3::new(3.0, 2.0, 5.0), Vec3::ZERO, Vec3::Y, 40.0);
    let size = ImageSize { width: 9, height: 9 };
    let seen = FirstHitMethod::ALL.map(|method| method.first_hits(scene, &camera, size).primitives);
    Everything { answers, seen }
}

#[test]
fn case_36_in_a_thread_that_flushes_denormals_all_answers_are_the_same() {
    // Those about denormal numbers, and a few that are about ulps.
    for number in [13, 15, 17, 32, 33, 36, 43, 45] {
        for situation in case(number).situations().iter().filter(|s| s.points.len() <= 5000) {
            let expected = everything(situation);
            let (found, in_its_pool, word) = flushed(|| {
                // Workers inherit the mode.
                let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
                (everything(situation), pool.install(|| everything(situation)), control_word())
            });
            assert_eq!(found, expected, "case {number}, {}", situation.name);
            assert_eq!(in_its_pool, expected, "case {number}, {}", situation.name);
            assert_eq!(word & (FLUSH_TO_ZERO | DENORMALS_ARE_ZERO), FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
        }
    }
}

/// Embree may flush denormals for its queries; it leaves the thread as it was.
#[cfg(feature = "embree")]
#[test]
fn case_36_beside_a_mode_of_embree_that_flushes_denormals() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mode = find("embree-fast-packet16-medium-ftz").unwrap();
    for situation in case(36).situations() {
        let index = SceneIndex::new(&situation.scene);
        let way = Way::light_buffer(16);
        let before = pool.install(|| ask_here(&way, &situation, &index));
        let after = pool.install(|| {
            let input = BuildInput::new(&situation.scene, &index, situation.light);
            let mut answers = vec![false; situation.points.len()];
            (mode.build)(&input).unwrap().occluded(&situation.points, &mut answers).unwrap();
            ask_here(&way, &situation, &index)
        });
        assert_eq!(before, after, "{}", situation.name);
    }
}
