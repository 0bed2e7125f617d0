//! What a tester did to answer.

use std::ops::AddAssign;

/// Counts of work; they explain a time and never influence an answer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Primitives tested against a segment.
    pub tests: u64,
    /// Bounding volumes tested against a segment.
    pub volume_tests: u64,
    /// Cells looked up.
    pub cells: u64,
    /// Lists of which at least one record was read.
    pub lists: u64,
    /// Queries answered by a cell's full-occlusion depth alone.
    pub full_occlusions: u64,
    /// Queries answered by the triangle that occluded the point before.
    pub coherence_hits: u64,
    /// Tests that the float filter left undecided.
    pub undecided: u64,
    /// Tests and cell look-ups that only exact arithmetic decided.
    pub exact: u64,
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Counters) {
        self.tests += other.tests;
        self.volume_tests += other.volume_tests;
        self.cells += other.cells;
        self.lists += other.lists;
        self.full_occlusions += other.full_occlusions;
        self.coherence_hits += other.coherence_hits;
        self.undecided += other.undecided;
        self.exact += other.exact;
    }
}
