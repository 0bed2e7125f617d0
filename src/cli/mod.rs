//! The command line: one file a command.
//!
//! Results go to standard output, progress and messages to standard error. Exit code 0 means done and
//! right, 1 done and a native answer is wrong, 2 usage or input error; those of `compare` are in its `--help`. Signals:
//! `signals.rs`.

mod again;
mod bench;
mod compare;
mod counts;
mod fuzz;
mod generate;
mod hard_cases;
mod info;
mod manual;
mod merge;
mod options;
mod output;
mod picture;
mod progress;
mod read_json;
mod render;
mod replay;
mod report;
mod reproduce;
mod settings;
#[cfg(unix)]
mod signals;
mod testers;
mod validate;
mod view;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Exact shadows from the light buffer, judged against Embree and exact arithmetic.
#[derive(Debug, Parser)]
#[command(name = "lightbuffer", version, max_term_width = 100, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 done and right; 1 done, but an answer of a native tester is wrong; \
                          2 usage or input error, or a result cannot be written: nothing is. `compare` has \
                          others, which its --help lists. A signal that ends a \
                          run is what the process dies of, and leaves no file half written.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a scene to OpenEXR, shadows by any tester
    Render(render::Args),
    /// Put together what `render --shard` wrote: the picture of its strips, one document of many
    Merge(merge::Args),
    /// Hold every shadow tester against exact truth and against Embree, pixel by pixel
    Validate(validate::Args),
    /// Measure every shadow tester, with every parameter, against Embree at its best: speed, error and memory
    Bench(bench::Args),
    /// Ask one pixel and one light of every shadow tester, in bits, and say who is wrong and why
    Replay(replay::Args),
    /// Say what a scene holds and what it calls for
    Info(info::Args),
    /// Make a built-in scene, or list what there is
    Generate(generate::Args),
    /// Measure the tables of a paper again, beside what it printed
    Reproduce(reproduce::Args),
    /// Compare two OpenEXR images channel by channel, with exit codes of its own
    Compare(compare::Args),
    /// Put the maps, tables and plots of a folder of results on one page for a browser
    Report(report::Args),
    /// Try random small scenes until testers that should agree do not, or ask a finding again
    Fuzz(fuzz::Args),
    /// Write completions of commands and options for a shell to standard output
    Completions(manual::CompletionArgs),
    /// Write the manual in the form that man reads
    Manual(manual::ManualArgs),
}

/// How a command that ran to its end came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Right,
    NativeWrong,
    /// Of `compare`, which has exit codes of its own.
    Compared(u8),
}

impl Outcome {
    fn exit_code(self) -> u8 {
        match self {
            Outcome::Right => 0,
            Outcome::NativeWrong => 1,
            Outcome::Compared(code) => code,
        }
    }
}

/// Parses the arguments, runs the command and returns the exit code.
pub fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return refused(&error),
    };
    #[cfg(unix)]
    signals::watch();
    let failed = if matches!(cli.command, Command::Compare(_)) { compare::CANNOT_COMPARE } else { 2 };
    let outcome = match cli.command {
        Command::Render(args) => render::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Validate(args) => validate::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Generate(args) => generate::run(&args),
        Command::Reproduce(args) => reproduce::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Fuzz(args) => fuzz::run(&args),
        Command::Completions(args) => manual::completions(&args),
        Command::Manual(args) => manual::manual(&args),
    };
    match outcome {
        Ok(outcome) => ExitCode::from(outcome.exit_code()),
        Err(error) => {
            progress::print_failure(&error);
            ExitCode::from(failed)
        }
    }
}

/// Prints help, the version, or why the arguments cannot be used; only the last is an error.
fn refused(error: &clap::Error) -> ExitCode {
    // Nobody is there to be told that it cannot be printed.
    let _ = error.print();
    let is_comparison = std::env::args_os().nth(1).is_some_and(|command| command == "compare");
    match (error.use_stderr(), is_comparison) {
        (false, _) => ExitCode::SUCCESS,
        (true, true) => ExitCode::from(compare::CANNOT_COMPARE),
        (true, false) => ExitCode::from(2),
    }
}
