//! Does a point see a light? One trait, one registry, one room a tester.
//!
//! A *shadow query* is a surface point and a light; the answer is whether any triangle blocks the open
//! segment between them. Surfaces that face away from the light are dark before any tester is asked
//! ([`facing`]).

pub mod auto;
pub mod bounding_volumes;
pub mod brute_force;
pub mod certified;
mod counters;
mod crossings;
mod duplicates;
#[cfg(feature = "embree")]
pub mod embree;
pub mod exact;
pub mod facing;
pub mod irregular_z_buffer;
mod keeper;
pub mod kept_light_buffer;
pub mod light_buffer;
mod precise;
mod queries;
mod registry;
mod rest;
mod scene_index;
pub mod shadow_buffer;
mod solids;
mod traced_ray;

pub use counters::Counters;
pub use crossings::Crossings;
pub use keeper::{Fresh, Keeper, Origin, Supplied, TesterSource};
pub use precise::{blocks, crossings_of, is_there};
pub use queries::Queries;
pub use registry::{
    BESIDE, Basis, Build, BuildInput, BuildOfScene, EmbreeSettings, Lights, REGISTRY, SceneTester,
    TesterEntry, find, testers,
};
pub use scene_index::{Casters, SceneIndex};
pub use solids::{FarSides, Solids};
pub use traced_ray::TracedRay;

use crate::error::{Error, Result};
use crate::visibility::{Points, SurfacePoint};

/// Answers shadow queries of one light.
///
/// Points must not face away from the light (see [`facing`]); answers for those that do are unspecified.
pub trait ShadowTester: Send + Sync {
    /// Sets `answers[i]` to whether `points[i]` is occluded, which transparent primitives have no part in. Both slices have the same length.
    ///
    /// # Errors
    /// If the tester cannot serve such points, or the library behind it fails.
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters>;

    /// The same for points that are rounded already, which is what testers for speed read of most of them.
    ///
    /// # Errors
    /// As [`occluded`](ShadowTester::occluded).
    fn occluded_at(&self, points: Points<'_>, answers: &mut [bool]) -> Result<Counters> {
        self.occluded(points.exact(), answers)
    }

    /// Appends to `crossings`, for each point in order, the transparent primitives that its open segment
    /// crosses (row 19 of the notes on the 1986 paper, TRUTH "Transparent"). Asked only in scenes where
    /// something transparent casts shadows, and only of points that are not occluded.
    ///
    /// # Errors
    /// If the tester has no answer for transparent surfaces, or as [`occluded`](ShadowTester::occluded).
    fn crossed(&self, _points: &[SurfacePoint], _crossings: &mut Crossings) -> Result<Counters> {
        Err(Error::Usage("this shadow tester has no answer for transparent surfaces".into()))
    }

    /// Sets `shares[i]` to the share of the light, from 0 to 1, that reaches `points[i]` past what is opaque, for
    /// testers whose shadows have soft edges: below one half is occluded. `None`, and nothing is set, from all
    /// others.
    ///
    /// # Errors
    /// As [`occluded`](ShadowTester::occluded).
    fn lit_share(&self, _points: &[SurfacePoint], _shares: &mut [f32]) -> Result<Option<Counters>> {
        Ok(None)
    }

    /// How [`occluded`](ShadowTester::occluded) likes to be called.
    fn batching(&self) -> Batching {
        Batching::Chunks
    }

    /// Memory that the tester keeps, in bytes.
    fn bytes(&self) -> usize;

    /// The float ray that it traces for a point, if it traces such rays and can for this point.
    fn traced_ray(&self, _point: &SurfacePoint) -> Option<TracedRay> {
        None
    }

    /// What was built, a line each, for `--stats`.
    fn statistics(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// How a tester likes to be given many points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Batching {
    /// In portions, from several threads at once.
    Chunks,
    /// All points of a view at once: it goes to several threads itself.
    Whole,
}

/// Where queries may come from; testers that know leave out what nobody can ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Receivers {
    /// Points on triangles of the scene that face the light.
    Surfaces,
    /// Any point of space.
    Anywhere,
}

/// What testers that cast triangles may leave out (row 4 of the notes on the 1986 paper). No answer depends on
/// it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Culling {
    /// Both sides of everything are cast.
    #[default]
    Off,
    /// The far sides of closed solids that the light is outside of are left out.
    ClosedSolids,
}

/// When the light buffer puts the polygons of one object in a cell's list behind a bounding-volume record
/// (row 8 of the notes on the 1986 paper). No answer depends on it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum VolumeThreshold {
    /// Never.
    #[default]
    Off,
    /// When the list holds more of them than this; the paper says 6.
    MoreThan(u32),
}

/// Whether the light buffer tries the triangle that occluded the last point first (row 20 of the notes on the
/// 1986 paper). No answer depends on it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ObjectCoherence {
    /// Every point for itself.
    #[default]
    Off,
    /// The points of one call of [`ShadowTester::occluded`] one after the other: neighbours should be together.
    LastOccluder,
}

/// Cells along the edge of a cube face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resolution {
    /// Chosen from the number of triangles.
    Auto,
    /// This many, from 1 to 4096.
    Cells(u32),
}
