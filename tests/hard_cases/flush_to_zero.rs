//! Case 36: whoever flushes denormals around us, no answer is another one. A thread that does so itself is refused:
//! nothing exact could be said there.

use crate::case;
#[cfg(feature = "embree")]
use crate::ways::{Way, ask_here};
#[cfg(feature = "embree")]
use lightbuffer::shadow::find;
use lightbuffer::shadow::{Basis, BuildInput, REGISTRY, Resolution, SceneIndex};
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

#[test]
fn case_36_in_a_thread_that_flushes_denormals_is_refused() {
    let situation = case(36).situations().remove(1);
    let index = SceneIndex::new(&situation.scene);
    let input = BuildInput {
        resolution: Resolution::Cells(16),
        receivers: situation.receivers(),
        ..BuildInput::new(&situation.scene, &index, situation.light)
    };
    for entry in REGISTRY.iter().filter(|entry| entry.basis != Basis::Measured) {
        let tester = (entry.build)(&input).unwrap();
        let mut answers = vec![false; situation.points.len()];
        tester.occluded(&situation.points, &mut answers).unwrap();
        let (built, asked) = flushed(|| {
            let built = (entry.build)(&input).err().map(|error| error.to_string());
            let asked = tester.occluded(&situation.points, &mut vec![false; situation.points.len()]);
            (built, asked.err().map(|error| error.to_string()))
        });
        for why in [built, asked] {
            let why = why.unwrap_or_else(|| panic!("{} answers all the same", entry.name));
            assert!(why.contains("denormal") && !why.contains('\n'), "{why}");
        }
        let mut again = vec![false; situation.points.len()];
        tester.occluded(&situation.points, &mut again).unwrap();
        assert_eq!(answers, again, "{}", entry.name);
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
