//! What a tester that traces float rays asks in place of the exact segment.

use crate::scene::PrimitiveIndex;
use glam::Vec3;

/// A ray `origin + t * direction`, `t_near <= t <= t_far`, in world space: the rounded question that a
/// tester answers instead of ours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracedRay {
    /// The surface point, rounded.
    pub origin: Vec3,
    /// Towards the light, not normalised.
    pub direction: Vec3,
    /// Where the ray begins: its epsilon.
    pub t_near: f32,
    /// Where it ends.
    pub t_far: f32,
    /// Where the light is; infinite for one infinitely far away.
    pub t_light: f32,
    /// The primitive that it starts on, if that is excluded: a flat one never blocks it. A curved one, taken as passing
    /// through the origin, blocks it where the line meets it for the other time: with a t^2 + b t + c on the line,
    /// at t = -b / a.
    pub excluded: Option<PrimitiveIndex>,
}
