//! The figures of the t-buffer paper, ours beside what its text says: as a document, as text, as CSV and as plots.

pub mod csv;
pub mod document;
pub mod figures;
pub mod paper;
pub mod plots;
pub mod table;

pub use document::{Document, Figure, Picture};
