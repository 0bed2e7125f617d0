//! Why a caller gets no answer.

use crate::error::Error;

/// Why there is no result, in one line.
#[derive(Debug)]
pub enum Refusal {
    /// An argument is wrong.
    Argument(String),
    /// The arguments are right, and nothing comes of them.
    Refused(String),
}

impl Refusal {
    /// What the library says.
    pub fn of(error: &Error) -> Refusal {
        // The limit is an option of the program, and a setting here.
        Refusal::Refused(error.to_string().replace("--memory-limit", "the memory limit"))
    }
}
