//! Exact signs of points, triangles and rays, each behind floating-point filters with proven bounds.
//!
//! The inputs of every predicate are f32 coordinates and the exact point where a ray meets a triangle; the
//! answers are exact. A filter answers when its error bound allows, otherwise the next, more precise stage
//! is asked, and the last one is exact expansion arithmetic.

pub mod batch;
mod bounded;
mod bounded_double;
pub mod cone;
pub mod convexity;
pub mod curved;
mod double_double;
mod dyadic;
pub mod exact_number;
pub mod expansion;
pub mod footprint;
mod light_position;
pub mod light_triangle;
mod number;
pub mod occlusion;
pub(crate) mod outline;
pub mod planes;
pub mod position;
pub mod ray_triangle;
mod rounding;
mod sign;
pub mod solid;
pub mod surd;
pub mod texel;
pub mod volume;

pub use light_position::{LightPosition, LightSpace};
pub use light_triangle::{Filtered, LightPoint, LightTriangle};
pub use position::ExactPosition;
pub use sign::Sign;

/// Unit roundoff of f64: half an ulp of 1.
pub(crate) const ROUNDOFF: f64 = f64::EPSILON * 0.5;
