//! Exact shadow testing.

pub mod error;
pub mod scene;

pub use error::{Error, Result};
