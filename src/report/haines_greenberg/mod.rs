//! The tables of the 1986 paper, ours beside its own: as a document, as text, as CSV and as plots.

pub mod check;
pub mod csv;
pub mod document;
pub mod paper;
pub mod plots;
pub mod quantity;
pub mod table;

pub use document::{Environment, Reproduction};
pub use quantity::Quantity;
