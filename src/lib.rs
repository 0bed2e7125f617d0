//! Exact shadow testing.

pub mod error;
pub mod geometry;
pub mod scene;
pub mod shadow;
pub mod visibility;

pub use error::{Error, Result};
