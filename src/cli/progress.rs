//! Messages and progress on standard error.

use crate::error::{Error, OneLine};
use crate::verdict::Progress;
use anstyle::{AnsiColor, Style};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;

/// Lines for the person at the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Messages {
    /// They are printed.
    Shown,
    /// Only errors are.
    Quiet,
}

impl Messages {
    /// `-q` or not.
    pub fn new(quiet: bool) -> Messages {
        if quiet { Messages::Quiet } else { Messages::Shown }
    }

    /// Says something.
    pub fn say(self, text: &str) {
        if self == Messages::Shown {
            print_error(&format!("lightbuffer: {}\n", OneLine(text)));
        }
    }

    /// Warns of something.
    pub fn warn(self, text: &str) {
        if self == Messages::Shown {
            let warning = AnsiColor::Yellow.on_default().bold();
            print_styled(&format!("lightbuffer: {warning}warning:{warning:#} {}\n", OneLine(text)));
        }
    }
}

/// Writes to standard error. That nobody reads it is no reason to stop, and there is nowhere to say so.
pub fn print_error(text: &str) {
    let _ = io::stderr().write_all(text.as_bytes());
}

/// Writes why a run came to nothing.
pub fn print_failure(error: &Error) {
    const FAILURE: Style = AnsiColor::Red.on_default().bold();
    print_styled(&format!("{FAILURE}lightbuffer:{FAILURE:#} {error}\n"));
}

/// Writes to standard error: in colours on a terminal, plainly elsewhere and where `NO_COLOR` is set.
fn print_styled(text: &str) {
    let _ = anstream::stderr().write_all(text.as_bytes());
}

/// A bar a tester on a terminal; nothing elsewhere.
pub struct Bars {
    queries: u64,
    light: String,
    target: Messages,
    bar: Mutex<Option<ProgressBar>>,
}

impl Bars {
    /// Bars for the testers of one light.
    pub fn new(messages: Messages, light: &str, queries: u64) -> Bars {
        let shown = messages == Messages::Shown && std::io::stderr().is_terminal();
        let target = if shown { Messages::Shown } else { Messages::Quiet };
        Bars { queries, light: light.into(), target, bar: Mutex::new(None) }
    }

    /// Removes the last bar.
    pub fn finish(&self) {
        if let Some(bar) = self.bar.lock().expect("no panic in a bar").take() {
            bar.finish_and_clear();
        }
    }
}

impl Progress for Bars {
    fn stage(&self, name: &str) {
        self.finish();
        if self.target == Messages::Quiet {
            return;
        }
        let style = ProgressStyle::with_template("{msg:32} [{bar:36}] {percent:>3} % {eta}")
            .expect("a template")
            .progress_chars("=> ");
        let bar = ProgressBar::with_draw_target(Some(self.queries), ProgressDrawTarget::stderr_with_hz(8));
        bar.set_style(style);
        bar.set_message(format!("{}: {name}", self.light));
        *self.bar.lock().expect("no panic in a bar") = Some(bar);
    }

    fn advance(&self, queries: u64) {
        // Taking the lock for single queries would cost more than answering them.
        if let Ok(guard) = self.bar.try_lock()
            && let Some(bar) = guard.as_ref()
        {
            bar.inc(queries);
        }
    }
}
