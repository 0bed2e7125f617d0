//! Running testers over many queries and timing what they do.

mod repeated;
pub mod reproduction;
mod run;

pub use repeated::Repeated;
pub use run::{Answers, Question, Timed, answer, soft_light, timed};
