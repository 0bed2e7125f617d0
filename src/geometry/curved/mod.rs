//! Curved surfaces: what they are, and exact signs of points and segments against them.

mod crossing;
mod defect;
mod shape;

pub use crossing::Crossing;
pub use defect::Defect;
pub use shape::{Cone, Disc, Ellipsoid, InfinitePlane, Quadric, Shape, Sphere};
