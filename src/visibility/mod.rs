//! What a camera sees: for every pixel the first primitive on its ray, and the exact point on it.

pub mod classical;
pub mod hierarchy;
mod hit;
mod method;
mod points;
mod surface_point;
pub mod t_buffer;

pub use hit::FirstHits;
pub(crate) use hit::{Hit, is_there, keep_nearer};
pub use method::FirstHitMethod;
pub use points::{Points, RoundedPoint};
pub use surface_point::{PointSource, SurfacePoint, VisibleSurfaces};
