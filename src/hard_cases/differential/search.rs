//! Scene after scene, on several threads.

use super::finding::Finding;
use super::generate::recipe;
use super::judge::{Counts, Depth, Judge, Kind};
use super::shrink::shrink;
use crate::error::Result;
use crate::shadow::TesterEntry;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The arbiter is held against the definition in integers in one scene of so many.
const CHECKED: u64 = 4;

/// Findings of one kind that are made small and kept; a bug makes thousands.
const KEPT: usize = 2;

/// Which scenes are tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// All are made of this and their numbers.
    pub seed: u64,
    /// Their numbers; some of the last are left out if the time is up before.
    pub numbers: Range<u64>,
    /// For how long, if not until all are tried.
    pub time: Option<Duration>,
    /// Threads that take turns.
    pub threads: usize,
}

/// What came of it.
#[derive(Debug)]
pub struct Found {
    /// Sums over all scenes.
    pub counts: Counts,
    /// The first of each kind of disagreement, made small.
    pub findings: Vec<Finding>,
}

/// Tries scenes until they are all tried or the time is up. What comes out does not depend on the number of threads
/// where the time does not end it. `progress` is told the sums now and then.
///
/// # Errors
/// If the system refuses threads.
pub fn search(
    plan: &Plan,
    entries: &[&'static TesterEntry],
    progress: &(dyn Fn(&Counts) + Sync),
) -> Result<Found> {
    let judges = (0..plan.threads).map(|_| Judge::new(entries)).collect::<Result<Vec<_>>>()?;
    let start = Instant::now();
    let (next, is_over) = (AtomicU64::new(plan.numbers.start), AtomicBool::new(false));
    let sums = Mutex::new((Counts::default(), BTreeMap::<Kind, Vec<u64>>::new()));
    let work = |judge: &Judge| {
        while !is_over.load(Ordering::Relaxed) {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= plan.numbers.end {
                break;
            }
            let depth = if number % CHECKED == 0 { Depth::All } else { Depth::Native };
            let judged = judge.judge(&recipe(plan.seed, number), depth);
            let mut sums = sums.lock().expect("no panic under the lock");
            sums.0 += &judged.counts;
            for disagreement in judged.disagreements {
                let numbers = sums.1.entry(disagreement.kind).or_default();
                if numbers.last() != Some(&number) {
                    numbers.push(number);
                }
            }
            progress(&sums.0);
            if plan.time.is_some_and(|time| start.elapsed() >= time) {
                is_over.store(true, Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        for judge in &judges {
            scope.spawn(|| work(judge));
        }
    });
    let (counts, kinds) = sums.into_inner().expect("no panic under the lock");
    let mut findings = Vec::new();
    for (kind, mut numbers) in kinds {
        numbers.sort_unstable();
        for &number in numbers.iter().take(KEPT) {
            findings.extend(finding(&judges[0], plan.seed, number, &kind));
        }
    }
    Ok(Found { counts, findings })
}

/// A disagreement of a kind in a scene, made small; none if there is none.
fn finding(judge: &Judge, seed: u64, number: u64, kind: &Kind) -> Option<Finding> {
    let recipe = recipe(seed, number);
    let disagreements = judge.judge(&recipe, Depth::All).disagreements;
    let first = disagreements.into_iter().find(|disagreement| disagreement.kind == *kind)?;
    Some(Finding { kind: kind.clone(), seed, number, recipe: shrink(judge, &recipe, &first) })
}
