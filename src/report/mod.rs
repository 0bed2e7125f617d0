//! What a run says: JSON documents, tables for people, image planes and previews. Each paper that is reproduced has
//! a room, so has `bench`, and so has the page that shows all of them.

pub mod bench;
pub mod comparison;
pub mod differential;
pub mod haines_greenberg;
pub mod hard_case_picture;
pub mod hard_cases;
pub mod images;
pub mod page;
mod plot;
pub mod raghuvanshi_dhande;
pub mod replay;
pub mod table;
pub mod validation;
