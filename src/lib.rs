//! Exact shadow testing with the light buffer of Haines and Greenberg (1986) and the t-buffer of
//! Raghuvanshi and Dhande (2004), held against Embree and against exact arithmetic.
//!
//! # The road of the data
//!
//! ```text
//! scene file -> Scene -> (camera) surface points -> (per light) shadow testers -> occlusion masks
//!     -> shading -> image planes -> OpenEXR
//!     -> verdicts (masks against exact truth) -> difference maps and the verdict table
//! ```
//!
//! Each arrow is a module, and imports run backwards along the road or down to [`geometry`]:
//!
//! | module | what it holds |
//! |---|---|
//! | [`geometry`] | exact signs behind proven float filters, curved surfaces, footprints, convexity |
//! | `embree` | the safe wrapper of `ffi/`, with the feature `embree` |
//! | [`scene`] | [`Scene`], objects, lights, cameras, and the file formats |
//! | [`visibility`] | [`visibility::t_buffer`], [`visibility::classical`], [`visibility::hierarchy`], [`SurfacePoint`] |
//! | [`shadow`] | [`ShadowTester`], the registry, one room a tester |
//! | [`shading`] | ambient, Lambert and Phong, textures, ray trees |
//! | [`film`] | image planes, OpenEXR, PNG, false colour, differences and metrics of images |
//! | [`float_environment`] | exact signs in threads that flush denormals |
//! | [`memory`] | the limit that is checked before memory is asked for |
//! | [`measure`] | running and timing testers |
//! | [`verdict`] | masks against the truth |
//! | [`hard_cases`] | 47 small cases whose answers are known, for all testers |
//! | [`report`] | JSON, tables, image channels, the page |
//! | [`cli`] | one file a command |
//! | [`c_interface`] | what `include/lightbuffer.h` declares |
//!
//! # Words
//!
//! - **surface point**: the exact intersection of a camera ray (a float origin and a float direction) with
//!   the primitive that the pixel sees. What is stored is that point, correctly rounded, and what makes it
//!   exact.
//! - **shadow query**: a surface point and a light. It is **occluded** if some opaque primitive meets the open
//!   segment between them, else lit. Primitives are closed, those seen edge-on from the light never block,
//!   and nothing in the receiver's own plane blocks. There is no epsilon. Transparent primitives never occlude:
//!   each one that is crossed attenuates.
//! - **facing away**: dark without a query, because the camera and the light are not strictly on the same
//!   side of the surface.
//! - **touching**: a query on the very edge between light and shadow. A flag, not an answer.
//! - **undecided**: a test that the float filter leaves to f64 and then to exact arithmetic.
//! - **the arbiter**: the tester `exact`, which decides what is true and shares no predicate or culling
//!   with those that it judges.
//!
//! # Asking
//!
//! ```
//! use glam::Vec3;
//! use lightbuffer::geometry::LightPosition;
//! use lightbuffer::scene::{ObjectInput, SceneBuilder};
//! use lightbuffer::shadow::{BuildInput, Receivers, SceneIndex, find};
//! use lightbuffer::SurfacePoint;
//!
//! # fn main() -> lightbuffer::Result<()> {
//! let mut builder = SceneBuilder::new("one triangle");
//! builder.add_object(ObjectInput::new(
//!     "triangle",
//!     vec![Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.0, -1.0), Vec3::new(0.0, 1.0, 1.0)],
//!     vec![[0, 1, 2]],
//! ))?;
//! let scene = builder.finish();
//! let index = SceneIndex::new(&scene);
//! let light = LightPosition::At(Vec3::new(0.0, 2.0, 0.0));
//! let tester = (find("light-buffer")?.build)(&BuildInput {
//!     receivers: Receivers::Anywhere,
//!     ..BuildInput::new(&scene, &index, light)
//! })?;
//! let points = [Vec3::ZERO, Vec3::new(5.0, 0.0, 0.0)].map(|p| SurfacePoint::bare(p).expect("finite"));
//! let mut occluded = [false; 2];
//! tester.occluded(&points, &mut occluded)?;
//! assert_eq!(occluded, [true, false]);
//! # Ok(())
//! # }
//! ```

#![warn(missing_docs)]

mod atomic;
pub mod c_interface;
pub mod cli;
#[cfg(feature = "embree")]
pub mod embree;
pub mod error;
pub mod film;
pub mod float_environment;
pub mod geometry;
pub mod hard_cases;
pub mod measure;
pub mod memory;
mod random;
pub mod report;
pub mod scene;
pub mod shading;
pub mod shadow;
mod slurm;
pub mod verdict;
pub mod visibility;

pub use error::{Error, Result};
pub use scene::Scene;
pub use shadow::ShadowTester;
pub use visibility::SurfacePoint;
