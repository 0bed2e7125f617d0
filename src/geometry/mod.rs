//! Exact signs of points, triangles and rays, each behind floating-point filters with proven bounds.
//!
//! The inputs of every predicate are f32 coordinates and the exact point where a ray meets a triangle; the
//! answers are exact. A filter answers when its error bound allows, otherwise the next, more precise stage
//! is asked, and the last one is exact expansion arithmetic.
//!
//! Bounds are derived where they are computed, by forward error analysis: every operation on f64 gives its exact
//! result times 1 + d with |d| <= u = 2^-53, first order in u, and what is taken is at least a quarter above the
//! count, which covers higher orders and the rounding of the bound itself. Underflow is told apart: f32 coordinates
//! are multiples of 2^-149, their differences too, so that products of three of them are zero or at least 2^-447,
//! far above where f64 underflows (2^-1022); rounded positions are quotients of degree 4 by degree 3 and can be
//! smaller, and where these come in an absolute term is added. `filter_tests` holds every bound against rationals.

pub mod batch;
mod bounded;
mod bounded_double;
pub mod cone;
pub mod convexity;
pub mod curved;
pub(crate) mod dispatch;
mod double_double;
mod dyadic;
pub mod exact_number;
pub mod expansion;
pub(crate) mod fetch;
#[cfg(test)]
mod filter_tests;
pub mod footprint;
mod light_position;
pub mod light_triangle;
pub(crate) mod masks;
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
