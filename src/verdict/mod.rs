//! Masks against truth: counts, and a verdict for every query.

mod cause;
mod check;
mod counts;
mod edges;
mod judge;
mod maps;
mod sweep;
#[cfg(test)]
mod tests;

pub use cause::{Cause, CauseCounts, WrongAnswer};
pub use check::{ArbiterCheck, check_arbiter};
pub(crate) use counts::is_zero;
pub use counts::{TesterCounts, VerdictCounts};
pub use edges::{EdgeCounts, ShadowEdges};
pub use judge::{
    LightVerdict, Progress, TesterResult, TesterRun, judge, judge_from, judge_known, run_tester,
    run_tester_from,
};
pub use maps::PixelVerdict;
pub use sweep::{EPSILONS, EpsilonCounts, sweep_epsilon};
