//! The command line: one file a command.
//!
//! Results go to standard output, progress and messages to standard error. Exit code 0 means done and
//! right, 1 done and a native answer is wrong, 2 usage or input error. Signals: `signals.rs`.

mod bench;
mod counts;
mod fuzz;
mod generate;
mod hard_cases;
mod info;
mod options;
mod output;
mod picture;
mod progress;
mod render;
mod replay;
mod report;
mod reproduce;
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
                          2 usage or input error, or a result cannot be written: nothing is. A signal that ends a \
                          run is what the process dies of, and leaves no file half written.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a scene to OpenEXR, shadows by any tester
    Render(render::Args),
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
    /// Put the maps, tables and plots of a folder of results on one page for a browser
    Report(report::Args),
    /// Try random small scenes until testers that should agree do not, or ask a finding again
    Fuzz(fuzz::Args),
}

/// How a command that ran to its end came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Right,
    NativeWrong,
}

/// Parses the arguments, runs the command and returns the exit code.
pub fn run() -> ExitCode {
    // Usage errors exit with 2 here, help and version with 0.
    let cli = Cli::parse();
    #[cfg(unix)]
    signals::watch();
    let outcome = match cli.command {
        Command::Render(args) => render::run(&args),
        Command::Validate(args) => validate::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Generate(args) => generate::run(&args),
        Command::Reproduce(args) => reproduce::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Fuzz(args) => fuzz::run(&args),
    };
    match outcome {
        Ok(Outcome::Right) => ExitCode::SUCCESS,
        Ok(Outcome::NativeWrong) => ExitCode::from(1),
        Err(error) => {
            progress::print_error(&format!("lightbuffer: {error}\n"));
            ExitCode::from(2)
        }
    }
}
