//! Which of the two points where a line meets a curved surface is meant.

/// How a line passes through a surface, in the sense of its direction.
///
/// A line meets a quadric at most twice: its polynomial falls through zero at one of the points and rises at
/// the other. Where it only touches, both are one point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Crossing {
    /// The polynomial falls: to the inside, where there is one.
    Entering,
    /// The polynomial rises.
    Leaving,
}
