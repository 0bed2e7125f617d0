//! Curved surfaces: what they are, and exact signs of rays and segments against them.
//!
//! Along a line each surface is a polynomial of degree 2 at most, with bounds ([`on_line`]). Rays ask for its
//! first root ([`first_hit`]), shadow segments for how often it passes through zero ([`meeting`]).

mod crossing;
mod defect;
mod first_hit;
mod gradient;
pub(crate) mod hull;
pub(crate) mod inner;
mod meeting;
mod on_line;
mod ray_start;
pub(crate) mod root;
pub(crate) mod segment;
mod shape;
#[cfg(test)]
mod shape_tests;
#[cfg(test)]
pub(crate) mod tests;

pub use crossing::Crossing;
pub use defect::Defect;
pub use first_hit::CurvedHit;
pub use meeting::Meetings;
pub use ray_start::RayStart;
pub use root::ExactParameter;
pub use segment::Base;
pub use shape::{Cone, Disc, Ellipsoid, InfinitePlane, Quadric, Shape, Sphere};
