//! What a run says: JSON documents, tables for people, image planes and previews.

pub mod hard_cases;
pub mod images;
pub mod replay;
pub mod reproduction;
pub mod table;
pub mod validation;
