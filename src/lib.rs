//! Exact shadow testing.

pub mod cli;
#[cfg(feature = "embree")]
pub mod embree;
pub mod error;
pub mod film;
pub mod geometry;
pub mod measure;
pub mod report;
pub mod scene;
pub mod shading;
pub mod shadow;
pub mod verdict;
pub mod visibility;

pub use error::{Error, Result};
