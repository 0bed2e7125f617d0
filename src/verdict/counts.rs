//! What a tester got right and wrong, and how two of them share the blame.

use crate::shadow::Crossings;
use std::ops::AddAssign;

/// Whether a count is left out of JSON.
pub(crate) fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// A tester's answers against the truth.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct TesterCounts {
    /// Points that it calls occluded.
    pub shadowed: u64,
    /// Points that it calls occluded and that are lit.
    pub false_shadow: u64,
    /// Points that it calls lit and that are occluded.
    pub false_light: u64,
    /// Points that it rightly calls lit, and is wrong about what transparent surfaces lie in the way. Left out
    /// where there is none.
    #[serde(skip_serializing_if = "is_zero")]
    pub false_transmittance: u64,
    /// All of these.
    pub wrong: u64,
    /// Tests that its float filter left undecided.
    pub undecided: u64,
}

impl TesterCounts {
    /// Counts one list of answers against the truth, query by query.
    pub fn new(answers: &[bool], truth: &[bool], undecided: u64) -> TesterCounts {
        let mut counts = TesterCounts { undecided, ..TesterCounts::default() };
        for (&answer, &truth) in answers.iter().zip(truth) {
            counts.shadowed += u64::from(answer);
            counts.false_shadow += u64::from(answer && !truth);
            counts.false_light += u64::from(!answer && truth);
        }
        counts.wrong = counts.false_shadow + counts.false_light;
        counts
    }

    /// Adds queries that are rightly called lit where the transparent surfaces in the way are others.
    pub fn count_transmittances(
        &mut self,
        answers: &[bool],
        found: &Crossings,
        truth: &[bool],
        crossed: &Crossings,
    ) {
        let lit = (0..answers.len()).filter(|&i| !answers[i] && !truth[i]);
        let wrong = lit.filter(|&i| found.of(i) != crossed.of(i)).count() as u64;
        self.false_transmittance += wrong;
        self.wrong += wrong;
    }
}

impl AddAssign for TesterCounts {
    fn add_assign(&mut self, other: TesterCounts) {
        self.shadowed += other.shadowed;
        self.false_shadow += other.false_shadow;
        self.false_light += other.false_light;
        self.false_transmittance += other.false_transmittance;
        self.wrong += other.wrong;
        self.undecided += other.undecided;
    }
}

/// Who is right where: every query is counted once among the first four.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct VerdictCounts {
    /// All exact native testers and Embree say what is true.
    pub agree: u64,
    /// An exact native tester is wrong, Embree is right.
    pub native_wrong: u64,
    /// Embree is wrong, all exact native testers are right.
    pub embree_wrong: u64,
    /// Both are wrong.
    pub both_wrong: u64,
    /// Queries on the edge between light and shadow; they are counted above too.
    pub touching: u64,
}

impl AddAssign for VerdictCounts {
    fn add_assign(&mut self, other: VerdictCounts) {
        self.agree += other.agree;
        self.native_wrong += other.native_wrong;
        self.embree_wrong += other.embree_wrong;
        self.both_wrong += other.both_wrong;
        self.touching += other.touching;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_both_kinds_do_not_cancel() {
        let counts = TesterCounts::new(&[true, false, true, false], &[false, true, true, false], 5);
        assert_eq!(
            counts,
            TesterCounts {
                shadowed: 2,
                false_shadow: 1,
                false_light: 1,
                wrong: 2,
                undecided: 5,
                ..TesterCounts::default()
            }
        );
    }
}
