//! What `bench` found, in every form that it has.

pub mod csv;
pub mod document;
pub mod pareto;
pub mod plots;
pub mod table;
