//! Exact shadow testing.

#[cfg(feature = "embree")]
pub mod embree;
pub mod error;
pub mod scene;

pub use error::{Error, Result};
