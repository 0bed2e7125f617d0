//! Differential fuzzing: random small scenes in which all that should agree is compared.
//!
//! Native testers are held against the arbiter in several settings, answer by answer and with what is crossed; the
//! arbiter against the definition over all primitives in integers, in one scene of four; the ways to find first hits
//! against each other. Scenes have little that is generic: corners lie on a coarse lattice, so that edges are shared,
//! faces coplanar and solids nested, lights lie in planes and on corners, points behind edges and on borders of cells;
//! or they lie an ulp beside all that ([`recipe()`]). A scene is made of a seed and its number alone. What disagrees is
//! made small ([`Finding`]) and written as files that are asked again.

mod aims;
mod curved;
mod finding;
mod flat;
mod generate;
mod judge;
mod lights;
mod place;
mod recipe;
mod search;
mod shrink;

pub use finding::Finding;
pub use generate::recipe;
pub use judge::{Answer, Asked, Counts, Depth, Disagreement, Judge, Judged, Kind, What};
pub use recipe::{Aim, Batch, Case, Matter, Part, Recipe, Settings, Threads};
pub use search::{Found, Plan, search};
pub use shrink::shrink;
