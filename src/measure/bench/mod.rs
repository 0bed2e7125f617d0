//! `bench`: who answers the shadow queries of a view fastest, and who is right.
//!
//! Two times are taken of everyone. *Query* is the time that a tester takes for all queries of all lights when it is
//! there already. *Frame* is the time from indexed triangles and surface points to the answers, for all lights:
//! what belongs to the scene is made once a frame and counts, on each side by the same clock. Natives make a
//! [`SceneIndex`](crate::shadow::SceneIndex) and then one tester after the other, Embree one hierarchy that serves all
//! lights. Embree is handed its buffers in the form that it reads, and its device is there; neither is timed.
//!
//! A first quick round asks everyone once ([`candidates`]). The best of each side then take part in rounds in which
//! everyone has one turn, beginning with another one each round, so that what the machine does meanwhile falls on all
//! alike; what counts are medians over rounds ([`measure`]).
//!
//! Answers are held against the arbiter on a sample, and wherever two of them differ ([`truths`]).

mod candidates;
mod contender;
mod machine;
mod order;
mod rounds;
mod run;
mod stage;
mod truths;

pub use candidates::{Choice, Skipped, candidates};
pub use contender::{Contender, Side};
pub use machine::Machine;
pub use order::Order;
pub use rounds::{Measured, Ratio, Row, measure};
pub use stage::Stage;
pub use truths::Truths;

/// How things are measured.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Rounds in which the best have a turn each.
    pub rounds: u32,
    /// Queries of a view that the arbiter is asked about anyway.
    pub sample: usize,
    /// The most others that it is asked about, where answers differ.
    pub most_suspicious: usize,
    /// Of each side so many that are best for queries, and as many that are best for frames, take part in the rounds.
    pub finalists: usize,
}

impl Default for Plan {
    fn default() -> Plan {
        Plan { rounds: 5, sample: 20_000, most_suspicious: 200_000, finalists: 3 }
    }
}
