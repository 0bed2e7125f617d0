//! What the programs in `fuzz_targets/` share: one input is loaded within its limits of time and memory.

pub mod allocator;
#[allow(dead_code, unused_imports, reason = "the test that replays the corpus uses more of it")]
pub mod checks;
mod figures;

pub use checks::Target;
pub use libfuzzer_sys::fuzz_target;

use checks::Desk;
use std::cell::RefCell;

#[global_allocator]
static ALLOCATOR: allocator::Counting = allocator::Counting;

/// Bytes that an input may take for each of its own, and beside that.
const BYTES_A_BYTE: usize = 64;
const BYTES_BESIDE: usize = 64 << 20;

/// The most processor time that an input may take: others at work on the machine must not make a finding.
const MOST_SECONDS: f64 = 1.0;

thread_local! {
    static DESK: RefCell<Desk> = RefCell::new(Desk::new());
}

/// Checks one input and notes what it took.
///
/// # Panics
/// If it is a finding.
pub fn run(target: Target, input: &[u8]) {
    DESK.with_borrow_mut(|desk| {
        let allowance = BYTES_BESIDE + BYTES_A_BYTE * input.len();
        let (start, before) = (figures::processor_seconds(), allocator::start(allowance));
        target.check(input, desk);
        let peak = allocator::stop(before);
        let seconds = figures::processor_seconds() - start;
        assert!(seconds <= MOST_SECONDS, "hang: {seconds:.2} s for {} bytes", input.len());
        figures::note(seconds, peak as f64 / allowance as f64);
    });
}

/// The whole of a program that fuzzes a target.
#[macro_export]
macro_rules! program {
    ($target:ident) => {
        $crate::fuzz_target!(|input: &[u8]| $crate::run($crate::Target::$target, input));
    };
}
