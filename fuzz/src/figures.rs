//! The worst inputs so far, for the table.

use std::cell::Cell;

thread_local! {
    /// The most seconds, and the largest share of the memory that is allowed.
    static WORST: Cell<(f64, f64)> = const { Cell::new((0.0, 0.0)) };
}

/// Processor time of this process.
pub fn processor_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is to a timespec that lives here, and the call writes nothing else.
    let code = unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    assert_eq!(code, 0, "the clock of the process");
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Takes the figures of one input. Whenever they are worse than all before, the file that `FUZZ_FIGURES` names is
/// written again: seconds, and the share of the memory that is allowed.
pub fn note(seconds: f64, share: f64) {
    WORST.with(|worst| {
        let (slowest, largest) = worst.get();
        if seconds <= slowest && share <= largest {
            return;
        }
        let now = (seconds.max(slowest), share.max(largest));
        worst.set(now);
        if let Some(path) = std::env::var_os("FUZZ_FIGURES") {
            std::fs::write(path, format!("{:.6} {:.6}\n", now.0, now.1)).expect("room for the figures");
        }
    });
}
