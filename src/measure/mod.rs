//! Running testers over many queries and timing what they do. Each paper that is reproduced has a room, and so has
//! `bench`.

mod answer_view;
pub mod bench;
pub mod first_hits;
pub mod fit;
pub mod haines_greenberg;
pub mod raghuvanshi_dhande;
mod repeated;
mod run;
mod sample;

pub use answer_view::answer_view;
pub use repeated::Repeated;
pub use run::{Answers, Question, Timed, answer, answer_in_runs, soft_light, timed};
pub use sample::Errors;
