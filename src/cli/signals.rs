//! Signals that end a run: nothing unfinished is left, one line says why, and the process dies of the signal, so that
//! shells and scripts see what happened.
//!
//! A thread of its own waits for them. What the others are doing then does not matter, so a run ends at once.

use crate::atomic::remove_for_good;
use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGXFSZ};
use signal_hook::flag;
use signal_hook::iterator::Signals;
use signal_hook::low_level::{emulate_default_handler, signal_name};
use std::ffi::c_int;
use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// Those that end a run.
const ENDING: [c_int; 5] = [SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU];

/// How long the last line may take. Somebody who reads standard error no more must not keep the process.
const LAST_WORDS: Duration = Duration::from_millis(500);

/// Begins to wait for signals.
///
/// If the system refuses the thread, signals do what they do to every program; files without a name go all the same.
pub fn watch() {
    // A file that is larger than the shell allows is an error like a full disk, with a line and no half file.
    let _ = flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
    let (ready, is_ready) = mpsc::channel();
    // The thread comes first: a signal with a handler and nobody who waits for it would be lost.
    let wait = move || {
        let ignored = ignored();
        let signals = Signals::new(ENDING.into_iter().filter(|signal| !ignored.contains(signal)));
        let _ = ready.send(());
        if let Ok(mut signals) = signals {
            signals.forever().for_each(end);
        }
    };
    if thread::Builder::new().name("signals".into()).spawn(wait).is_ok() {
        let _ = is_ready.recv();
    }
}

fn end(signal: c_int) {
    remove_for_good();
    let (said, is_said) = mpsc::channel();
    let say = move || {
        let name = signal_name(signal).unwrap_or("a signal");
        // What a progress bar left of its line goes first.
        let clear = if io::stderr().is_terminal() { "\r\x1b[2K" } else { "" };
        super::progress::print_error(&format!(
            "{clear}lightbuffer: stopped by {name}; no file is half written\n"
        ));
        let _ = said.send(());
    };
    if thread::Builder::new().spawn(say).is_ok() {
        let _ = is_said.recv_timeout(LAST_WORDS);
    }
    let _ = emulate_default_handler(signal);
}

/// Signals that whoever started the process wants it to ignore: `nohup`, or a job that a script put in the background.
fn ignored() -> Vec<c_int> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = mask(&status);
    ENDING.into_iter().filter(|signal| mask >> (signal - 1) & 1 == 1).collect()
}

/// `SigIgn` of the text of `/proc/self/status`.
fn mask(status: &str) -> u64 {
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    line.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ignored_signals_are_bits_from_1() {
        assert_eq!(mask("SigBlk:\t0000000000000000\nSigIgn:\t0000000000001001\n"), 0x1001);
        assert_eq!(mask("SigBlk:\t1\n"), 0);
    }
}
