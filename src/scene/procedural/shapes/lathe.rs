//! Profiles turned about the y axis.

use super::loft::{Closing, loft};
use super::mesh::Mesh;
use super::outline::circle;
use glam::DVec3;

/// How a turned profile ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::scene::procedural) enum Caps {
    /// Both ends are flat polygons.
    Flat,
    /// The lower end is a flat polygon, the upper one a point on the axis, which the profile does not name.
    Pointed {
        /// Height of the point.
        tip: f64,
    },
}

/// A profile of (radius, height), from the lowest upwards, turned in so many steps: as many polygons as
/// steps times bands, and the ends.
pub(in crate::scene::procedural) fn lathe(profile: &[[f64; 2]], steps: usize, caps: Caps) -> Mesh {
    let mut mesh = loft(&rings(profile, steps), Closing::Capped);
    if let Caps::Pointed { tip } = caps {
        let top = mesh.faces.pop().unwrap_or_default();
        let apex = mesh.points.len();
        mesh.points.push(DVec3::new(0.0, tip, 0.0));
        for (place, &corner) in top.iter().enumerate() {
            mesh.faces.push(vec![corner, top[(place + 1) % top.len()], apex]);
        }
    }
    mesh
}

/// A closed profile of (radius, height) away from the axis, turned to a ring: up along the outside, down
/// along the inside.
pub(in crate::scene::procedural) fn turned_ring(profile: &[[f64; 2]], steps: usize) -> Mesh {
    loft(&rings(profile, steps), Closing::Loop)
}

/// Circles that run from z to x, so that they are counter-clockwise as seen from above.
fn rings(profile: &[[f64; 2]], steps: usize) -> Vec<Vec<DVec3>> {
    let ring = |&[radius, height]: &[f64; 2]| {
        circle(radius, steps, 0.0).iter().map(|&[a, b]| DVec3::new(b, height, a)).collect()
    };
    profile.iter().map(ring).collect()
}
