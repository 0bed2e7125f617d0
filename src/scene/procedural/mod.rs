//! Scenes that are made and not read: the seven environments of the 1986 paper, by our own design after its
//! counts, the Standard Procedural Databases, the scenes of the t-buffer paper, and large ones for `bench`.
//!
//! Each is a function of nothing but its size factor: random numbers come from a generator of ours and
//! trigonometry from `libm`, so that a scene has the same bits everywhere.

mod registry;
mod shapes;
mod studio;

mod chessboard;
mod gazebo;
mod glass_leaved_tree;
mod highchair;
mod house_of_cards;
mod kitchen;
mod large;
mod spd;
mod stack;
mod three_spheres;

#[cfg(test)]
mod tests;

pub use registry::{BUILTIN, Builtin, HARD_CASES, SizeFactor, find};
