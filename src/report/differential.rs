//! What is said of a search for disagreements: JSON, and one table.

use crate::film::grouped;
use crate::hard_cases::differential::{Counts, Found, Plan};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// `fuzz` as JSON.
#[derive(Debug, Serialize)]
pub struct FuzzReport {
    /// Of this program.
    pub version: &'static str,
    /// What all scenes are made of beside their numbers.
    pub seed: u64,
    /// The number of the first scene.
    pub first: u64,
    /// Threads that took turns.
    pub threads: usize,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// What was asked, and how it came out.
    #[serde(flatten)]
    pub counts: Counts,
    /// All that should agree and does not.
    pub disagreements: u64,
    /// Files of findings.
    pub findings: Vec<PathBuf>,
}

impl FuzzReport {
    /// Of a search that took so long, its findings in these files.
    pub fn new(plan: &Plan, found: &Found, seconds: f64, findings: Vec<PathBuf>) -> FuzzReport {
        FuzzReport {
            version: env!("CARGO_PKG_VERSION"),
            seed: plan.seed,
            first: plan.numbers.start,
            threads: plan.threads,
            seconds,
            counts: found.counts.clone(),
            disagreements: found.counts.disagreements(),
            findings,
        }
    }

    /// For people.
    pub fn table(&self) -> String {
        let counts = &self.counts;
        let share = |part: u64, of: u64| 100.0 * part as f64 / of.max(1) as f64;
        let mut text = String::new();
        let mut line = |name: &str, number: u64, rest: String| {
            let _ = writeln!(text, "{name:<34} {:>15}  {rest}", grouped(number));
        };
        let rate = counts.scenes as f64 / self.seconds.max(1e-9);
        let took = format!(
            "seed {}, in {:.0} s on {} threads: {rate:.0} a second",
            self.seed, self.seconds, self.threads
        );
        line("scenes", counts.scenes, took);
        line("primitives", counts.primitives, String::new());
        let mix = format!(
            "{:.1} % occluded, {:.1} % touching, {:.1} % through glass",
            share(counts.occluded, counts.queries),
            share(counts.touching, counts.queries),
            share(counts.crossing, counts.queries)
        );
        line("queries", counts.queries, mix);
        line("camera rays", counts.rays, "t-buffer and hierarchy against classical".into());
        line("first hits that differ", counts.first_hits_differ, String::new());
        line(
            "arbiter against the definition",
            counts.arbiter_checked,
            "queries, all primitives in integers".into(),
        );
        line("arbiter wrong", counts.arbiter_wrong, String::new());
        line("errors and panics", counts.failures, String::new());
        line("native answers wrong", counts.native_wrong, String::new());
        text.push_str(&tester_table(counts));
        text
    }
}

fn tester_table(counts: &Counts) -> String {
    let mut text = format!(
        "  {:<18} {:>14} {:>12} {:>11} {:>9} {:>9} {:>10}  refused\n",
        "tester", "answers", "false shadow", "false light", "crossings", "wrong", "undecided"
    );
    for (name, asked) in &counts.testers {
        let undecided = 100.0 * asked.counts.undecided as f64 / asked.tests.max(1) as f64;
        let _ = writeln!(
            text,
            "  {name:<18} {:>14} {:>12} {:>11} {:>9} {:>9} {undecided:>8.1} %  {}",
            grouped(asked.answers),
            grouped(asked.counts.false_shadow),
            grouped(asked.counts.false_light),
            grouped(asked.counts.false_transmittance),
            grouped(asked.counts.wrong),
            grouped(asked.refused)
        );
    }
    text
}
