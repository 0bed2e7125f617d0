//! The floating-point environment that exact signs are computed in: round to nearest, denormal numbers kept,
//! no traps.
//!
//! Embree advises its callers to set flush-to-zero and denormals-are-zero in their threads, and threads inherit
//! both from the one that makes them. Coordinates may be denormal, and the error terms of an exact sum often are,
//! so that nothing exact could be computed there; to Rust, such a thread is outside of its rules altogether. So
//! everything public that computes a sign does so in the [standard] environment and puts back what it found.
//!
//! With `src/embree/`, the SIMD kernels and `c_interface.rs` this is the only place of `unsafe` code: the control word is a
//! register.

use rayon::iter::{MapInit, ParallelIterator};
use std::marker::PhantomData;

/// While it lives, the thread that made it computes in the standard environment; after that, as it did before.
#[must_use = "the environment is put back when this is dropped"]
pub struct StandardFloats {
    /// The control word to put back, if it was another one.
    before: Option<control_word::Word>,
    /// It belongs to its thread.
    thread: PhantomData<*const ()>,
}

impl StandardFloats {
    /// Sets the environment.
    #[inline(never)]
    pub fn new() -> StandardFloats {
        let found = control_word::read();
        let before = (!control_word::is_standard(found)).then(|| {
            control_word::write(control_word::STANDARD);
            found
        });
        StandardFloats { before, thread: PhantomData }
    }
}

impl Default for StandardFloats {
    fn default() -> StandardFloats {
        StandardFloats::new()
    }
}

impl Drop for StandardFloats {
    #[inline(never)]
    fn drop(&mut self) {
        if let Some(before) = self.before {
            control_word::write(before);
        }
    }
}

/// Computes something in the standard environment.
pub fn standard<T>(work: impl FnOnce() -> T) -> T {
    let _floats = StandardFloats::new();
    apart(work)
}

/// Parallel iterators whose jobs compute in the standard environment: workers have that of whoever made their pool.
pub trait InStandardFloats: ParallelIterator {
    /// The same items; whatever is done with them in the same job, before or after this, is done in the standard
    /// environment.
    fn in_standard_floats(self) -> InFloats<Self> {
        self.map_init(StandardFloats::new, |_, item| item)
    }
}

impl<I: ParallelIterator> InStandardFloats for I {}

/// What [`InStandardFloats::in_standard_floats`] returns.
pub type InFloats<I> = MapInit<
    I,
    fn() -> StandardFloats,
    fn(&mut StandardFloats, <I as ParallelIterator>::Item) -> <I as ParallelIterator>::Item,
>;

/// A call of its own, so that no operation moves out of the environment that it is meant for.
#[inline(never)]
fn apart<T>(work: impl FnOnce() -> T) -> T {
    work()
}

/// MXCSR.
#[cfg(target_arch = "x86_64")]
mod control_word {
    use std::arch::asm;

    pub type Word = u32;

    /// All exceptions masked, round to nearest, neither FTZ nor DAZ: what a process begins with.
    pub const STANDARD: Word = 0x1f80;

    /// Flags of exceptions that have occurred; they change no result.
    const FLAGS: Word = 0x3f;

    pub fn is_standard(word: Word) -> bool {
        word & !FLAGS == STANDARD
    }

    pub fn read() -> Word {
        let mut word: Word = 0;
        // SAFETY: stores the register in a variable that is as wide as it; every x86-64 processor can.
        unsafe { asm!("stmxcsr [{}]", in(reg) &mut word, options(nostack, preserves_flags)) };
        word
    }

    pub fn write(word: Word) {
        // SAFETY: `word` was read from the register or is the one that a process begins with, so no reserved bit
        // is set; whoever had another one than Rust's gets it back before anything else of theirs runs.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &word, options(nostack, preserves_flags)) };
    }
}

/// FPCR.
#[cfg(target_arch = "aarch64")]
mod control_word {
    use std::arch::asm;

    pub type Word = u64;

    /// Round to nearest, FZ and DN not set, no traps: what a process begins with.
    pub const STANDARD: Word = 0;

    pub fn is_standard(word: Word) -> bool {
        word == STANDARD
    }

    pub fn read() -> Word {
        let word: Word;
        // SAFETY: copies a register that every program may read.
        unsafe { asm!("mrs {}, fpcr", out(reg) word, options(nomem, nostack, preserves_flags)) };
        word
    }

    pub fn write(word: Word) {
        // SAFETY: `word` was read from the register or is the one that a process begins with; whoever had another
        // one than Rust's gets it back before anything else of theirs runs.
        unsafe { asm!("msr fpcr, {}", in(reg) word, options(nostack, preserves_flags)) };
    }
}

/// Other processors have no such mode, or none that other programs set.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod control_word {
    pub type Word = ();

    pub const STANDARD: Word = ();

    pub fn is_standard((): Word) -> bool {
        true
    }

    pub fn read() -> Word {}

    pub fn write((): Word) {}
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::control_word::{self, STANDARD};
    use super::*;
    use std::hint::black_box;

    const FLUSH_TO_ZERO: u32 = 1 << 15;
    const DENORMALS_ARE_ZERO: u32 = 1 << 6;
    const ROUND_UP: u32 = 2 << 13;

    /// A sum and a product that each mode changes. A call of its own: numbers that are in registers already may be added
    /// before a mode is set or after.
    #[inline(never)]
    fn results() -> [f32; 3] {
        let tiny = black_box(f32::from_bits(1));
        [tiny + tiny, black_box(f32::MIN_POSITIVE) * black_box(0.5), black_box(1.0) + tiny]
    }

    #[test]
    fn whatever_is_set_the_standard_is_computed_in_and_what_was_set_comes_back() {
        let expected = results();
        for set in
            [FLUSH_TO_ZERO, DENORMALS_ARE_ZERO, ROUND_UP, FLUSH_TO_ZERO | DENORMALS_ARE_ZERO | ROUND_UP]
        {
            let (outside, inside, nested, word) = std::thread::spawn(move || {
                control_word::write(STANDARD | set);
                let outside = results();
                let (inside, nested) = standard(|| (results(), standard(results)));
                let word = control_word::read();
                control_word::write(STANDARD);
                (outside, inside, nested, word)
            })
            .join()
            .unwrap();
            assert_ne!(outside, expected, "the mode {set:x} does nothing here");
            assert_eq!((inside, nested), (expected, expected));
            assert_eq!(word & !0x3f, STANDARD | set);
        }
    }

    #[test]
    fn a_panic_puts_the_word_back_too() {
        let word = std::thread::spawn(|| {
            control_word::write(STANDARD | FLUSH_TO_ZERO);
            let result = std::panic::catch_unwind(|| standard(|| std::panic::panic_any("on purpose")));
            let word = control_word::read();
            control_word::write(STANDARD);
            assert!(result.is_err());
            word
        })
        .join()
        .unwrap();
        assert_eq!(word & !0x3f, STANDARD | FLUSH_TO_ZERO);
    }

    #[test]
    fn threads_inherit_the_word_and_rayon_jobs_do_without() {
        use rayon::prelude::*;
        let sums = std::thread::spawn(|| {
            control_word::write(STANDARD | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
            control_word::write(STANDARD);
            let sums = |guarded: bool| -> Vec<[f32; 3]> {
                pool.install(|| match guarded {
                    true => (0..9).into_par_iter().map(|_| results()).in_standard_floats().collect(),
                    false => (0..9).into_par_iter().map(|_| results()).collect(),
                })
            };
            (sums(false), sums(true))
        });
        let (unguarded, guarded) = sums.join().unwrap();
        assert!(unguarded.iter().all(|r| *r != results()));
        assert!(guarded.iter().all(|r| *r == results()));
    }
}
