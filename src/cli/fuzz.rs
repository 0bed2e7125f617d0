//! `lightbuffer fuzz`: random small scenes, everyone against everyone; or a finding again.

use super::options::thread_pool;
use super::progress::Messages;
use super::{Outcome, output};
use crate::error::Result;
use crate::film::{FileSet, grouped};
use crate::hard_cases::differential::{Answer, Counts, Finding, Judge, Plan, search};
use crate::report::differential::FuzzReport;
use crate::shadow::{BESIDE, REGISTRY, TesterEntry, shadow_buffer};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Seconds between two lines of progress.
const EVERY: u64 = 10;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// How many scenes are tried [default: as many as the time allows, or 1000]
    #[arg(long, value_name = "N")]
    scenes: Option<u64>,
    /// For how many seconds scenes are tried
    #[arg(long, value_name = "N")]
    seconds: Option<u64>,
    /// What scenes are made of, beside their numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// The number of the first scene: with --scenes 1, that scene alone
    #[arg(long, value_name = "I", default_value_t = 0)]
    first: u64,
    /// Folder for findings, made small; created if need be. Two of each kind are kept
    #[arg(short, long, value_name = "DIR", default_value = "findings")]
    output: PathBuf,
    /// Ask a finding again, and print everyone's answer
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scenes", "seconds", "seed", "first", "output", "json"])]
    replay: Option<PathBuf>,
    /// The counts as JSON; - is standard output instead of the table
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Threads [default: all]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// No progress and no messages but errors
    #[arg(short, long)]
    quiet: bool,
}

pub fn run(args: &Args) -> Result<Outcome> {
    // Of the shadow-buffer nobody expects an answer that is right.
    let entries: Vec<&'static TesterEntry> =
        REGISTRY.iter().chain(BESIDE).filter(|entry| entry.name != shadow_buffer::ENTRY.name).collect();
    match &args.replay {
        Some(path) => replay(path, &entries),
        None => fuzz(args, &entries),
    }
}

fn fuzz(args: &Args, entries: &[&'static TesterEntry]) -> Result<Outcome> {
    output::expect_folder(&args.output)?;
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let most = match (args.scenes, args.seconds) {
        (Some(scenes), _) => scenes,
        (None, Some(_)) => u64::MAX,
        (None, None) => 1000,
    };
    let plan = Plan {
        seed: args.seed,
        numbers: args.first..args.first.saturating_add(most),
        time: args.seconds.map(Duration::from_secs),
        threads: thread_pool(args.threads)?.current_num_threads(),
    };
    let messages = Messages::new(args.quiet);
    let start = Instant::now();
    let said = Mutex::new(start);
    let progress = |counts: &Counts| {
        let Ok(mut said) = said.try_lock() else { return };
        if said.elapsed() >= Duration::from_secs(EVERY) {
            *said = Instant::now();
            let [scenes, queries, wrong] =
                [counts.scenes, counts.queries, counts.disagreements()].map(grouped);
            let seconds = start.elapsed().as_secs();
            messages.say(&format!("{seconds} s: {scenes} scenes, {queries} queries, {wrong} disagreements"));
        }
    };
    let found = search(&plan, entries, &progress)?;
    let seconds = start.elapsed().as_secs_f64();
    if !found.findings.is_empty() {
        let mut folder = FileSet::new();
        folder.folder(&args.output)?;
        folder.publish()?;
    }
    let saved = found.findings.iter().map(|finding| finding.save(&args.output));
    let report = FuzzReport::new(&plan, &found, seconds, saved.collect::<Result<_>>()?);
    let mut files = FileSet::new();
    let shown = output::add_copy(&mut files, args.json.as_deref(), &report, || report.table())?;
    output::finish(files, &shown)?;
    for (path, finding) in report.findings.iter().zip(&found.findings) {
        let primitives = finding.recipe.primitives();
        messages.say(&format!("{}: {primitives} primitives", path.display()));
    }
    Ok(if report.disagreements > 0 { Outcome::NativeWrong } else { Outcome::Right })
}

fn replay(path: &Path, entries: &[&'static TesterEntry]) -> Result<Outcome> {
    let finding = Finding::load(path)?;
    let judge = Judge::new(entries)?;
    let mut text = String::new();
    for (name, answer) in judge.everyone(&finding.recipe) {
        let words = match answer {
            Ok(Answer::Occluded) => "occluded".into(),
            Ok(Answer::Lit(crossed)) if crossed.is_empty() => "lit".into(),
            Ok(Answer::Lit(crossed)) => format!("lit through {crossed:?}"),
            Err(why) => format!("no answer: {why}"),
        };
        let _ = writeln!(text, "{name:<18} {words}");
    }
    let is_still_there = finding.is_still_there(&judge);
    let state = if is_still_there { "still there" } else { "no longer there" };
    let _ =
        writeln!(text, "{} of scene {} of seed {}: {state}", finding.name(), finding.number, finding.seed);
    output::print(&text)?;
    Ok(if is_still_there { Outcome::NativeWrong } else { Outcome::Right })
}
