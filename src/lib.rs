//! Exact shadow testing.

pub mod error;
pub mod film;
pub mod scene;
pub mod shading;

pub use error::{Error, Result};
