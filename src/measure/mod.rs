//! Running testers over many queries and timing what they do.

mod run;

pub use run::{Answers, Question, Timed, answer, timed};
