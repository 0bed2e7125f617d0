//! Shapes that several scenes are made of.

mod body;
mod box_frame;
mod lathe;
mod loft;
mod mesh;
mod normals;
mod outline;
mod place;
mod prism;
#[cfg(test)]
mod tests;

pub(super) use body::Body;
pub(super) use box_frame::{cuboid, mitred_frame};
pub(super) use lathe::{Caps, lathe, turned_ring};
pub(super) use loft::{Closing, loft, tube};
pub(super) use mesh::Mesh;
pub(super) use outline::{circle, rounded_rectangle};
pub(super) use place::{along, moved, turned_x, turned_y, turned_z};
pub(super) use prism::{bevelled_prism, prism};
