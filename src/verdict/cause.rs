//! Why a tester that traces float rays was wrong.

use crate::shadow::TracedRay;
use crate::shadow::exact::{Arbiter, Span};
use std::ops::AddAssign;

/// What a wrong answer is put down to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// The part of the segment that it leaves out at its ends decides: without its epsilon the same ray would
    /// have been answered rightly.
    Epsilon,
    /// Its ray is not the segment: rounded to floats, the exact answer is another one.
    InputRounding,
    /// The exact answer to its very ray is another one than it gave: its traversal or its intersection test.
    Traversal,
}

impl Cause {
    /// Why a tester gave the wrong answer `occluded` when it traced a ray.
    pub fn of(arbiter: &Arbiter, ray: &TracedRay, occluded: bool) -> Cause {
        let truth = !occluded;
        if arbiter.is_blocked(ray, Span::Traced) == truth {
            Cause::Traversal
        } else if arbiter.is_blocked(ray, Span::Whole) == truth {
            Cause::Epsilon
        } else {
            Cause::InputRounding
        }
    }

    /// All of them, in the order of their codes.
    pub const ALL: [Cause; 3] = [Cause::Epsilon, Cause::InputRounding, Cause::Traversal];

    /// What is added to the code of a pixel's verdict where Embree is wrong: 100, 200 or 300.
    pub fn code(self) -> u16 {
        match self {
            Cause::Epsilon => 100,
            Cause::InputRounding => 200,
            Cause::Traversal => 300,
        }
    }

    /// In words, as in reports.
    pub fn name(self) -> &'static str {
        match self {
            Cause::Epsilon => "epsilon",
            Cause::InputRounding => "input rounding",
            Cause::Traversal => "traversal",
        }
    }
}

/// A wrong answer of a tester that traces float rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WrongAnswer {
    /// The place of the query among those of its light.
    pub query: usize,
    /// What it is put down to.
    pub cause: Cause,
}

/// Wrong answers by cause.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct CauseCounts {
    /// [`Cause::Epsilon`].
    pub epsilon: u64,
    /// [`Cause::InputRounding`].
    pub input_rounding: u64,
    /// [`Cause::Traversal`].
    pub traversal: u64,
}

impl CauseCounts {
    /// Counts a list.
    pub fn of(wrong: &[WrongAnswer]) -> CauseCounts {
        let mut counts = CauseCounts::default();
        wrong.iter().for_each(|answer| counts.add(answer.cause));
        counts
    }

    /// Counts one more.
    pub fn add(&mut self, cause: Cause) {
        match cause {
            Cause::Epsilon => self.epsilon += 1,
            Cause::InputRounding => self.input_rounding += 1,
            Cause::Traversal => self.traversal += 1,
        }
    }
}

impl AddAssign for CauseCounts {
    fn add_assign(&mut self, other: CauseCounts) {
        self.epsilon += other.epsilon;
        self.input_rounding += other.input_rounding;
        self.traversal += other.traversal;
    }
}
