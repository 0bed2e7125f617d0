//! Cameras by where they stand and what they look at, with directions that are checked.

use super::shading_normals::unit;
use crate::scene::Camera;
use glam::Vec3;

/// The square of the sine between two directions up to which they are one: below, [`Camera::look_at`] takes
/// another axis.
const PARALLEL: f64 = 1e-11;

/// How far products of a camera's axes may be from 1 and 0.
const TOLERANCE: f32 = 1e-3;

/// Why a camera has no picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Blind {
    /// It stands where it looks.
    NoDirection,
    /// Up is no direction.
    NoUp,
    /// Up is the direction that it looks in.
    UpAhead,
}

impl Blind {
    /// A line; `places` are the format's words for where it stands and what it looks at.
    pub(super) fn message(self, places: &str) -> String {
        match self {
            Blind::NoDirection => format!("{places} leave no direction to look in"),
            Blind::NoUp => "expected `up` to be a direction".into(),
            Blind::UpAhead => "`up` is the direction to look in".into(),
        }
    }
}

/// A camera that stands at the first place, looks at the second, and has the third, a direction, above.
/// `vertical_degrees` is its full field of view, between 0 and 180.
///
/// # Errors
/// If those leave no direction to look in or no way up.
pub(super) fn camera(name: &str, [from, at, up]: [Vec3; 3], vertical_degrees: f64) -> Result<Camera, Blind> {
    let forward = unit((at - from).as_dvec3()).ok_or(Blind::NoDirection)?;
    let up = unit(up.as_dvec3()).ok_or(Blind::NoUp)?;
    if forward.as_dvec3().cross(up.as_dvec3()).length_squared() <= PARALLEL {
        return Err(Blind::UpAhead);
    }
    Ok(Camera::look_at(name, from, at, up, vertical_degrees))
}

/// Whether these are unit vectors at right angles, and right-handed if one looks against the last.
pub(super) fn are_upright(right: Vec3, up: Vec3, forward: Vec3) -> bool {
    let products = [right.dot(up), up.dot(forward), forward.dot(right)];
    let lengths = [right, up, forward].map(|axis| axis.length_squared() - 1.0);
    let near = |error: f32| error.abs() <= TOLERANCE;
    products.into_iter().chain(lengths).all(near) && right.cross(up).dot(forward) < 0.0
}
