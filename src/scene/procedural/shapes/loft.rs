//! Sections joined to a skin: rings of equally many points, one behind the other.

use super::mesh::Mesh;
use super::outline::circle;
use glam::DVec3;

/// What becomes of the first and the last section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::scene::procedural) enum Closing {
    /// Each is closed by a polygon.
    Capped,
    /// The last is joined to the first.
    Loop,
}

/// A skin over sections, each counter-clockwise as seen from the sections behind it (towards the last).
pub(in crate::scene::procedural) fn loft(sections: &[Vec<DVec3>], closing: Closing) -> Mesh {
    let around = sections[0].len();
    let points: Vec<DVec3> = sections.iter().flatten().copied().collect();
    let bands = sections.len() - usize::from(closing == Closing::Capped);
    let mut faces = Vec::new();
    for band in 0..bands {
        let (near, far) = (band * around, (band + 1) % sections.len() * around);
        for step in 0..around {
            let next = (step + 1) % around;
            faces.push(vec![near + step, near + next, far + next, far + step]);
        }
    }
    if closing == Closing::Capped {
        faces.push((0..around).rev().collect());
        let last = (sections.len() - 1) * around;
        faces.push((last..last + around).collect());
    }
    Mesh::new(points, faces)
}

/// A tube along a path, with a radius at each of its points.
///
/// Sections stand across the path; each is turned no further from the one before than the path bends. Round
/// about a loop that adds up to nothing only for flat paths, which is what loops may be.
pub(in crate::scene::procedural) fn tube(path: &[(DVec3, f64)], sides: usize, closing: Closing) -> Mesh {
    let count = path.len();
    let ahead = |i: usize| match closing {
        Closing::Loop => path[(i + 1) % count].0 - path[(i + count - 1) % count].0,
        Closing::Capped => path[(i + 1).min(count - 1)].0 - path[i.saturating_sub(1)].0,
    };
    let mut side = ahead(0).normalize().any_orthonormal_vector();
    let mut sections = Vec::with_capacity(count);
    for (i, &(centre, radius)) in path.iter().enumerate() {
        let direction = ahead(i).normalize();
        side = (side - direction * side.dot(direction)).normalize();
        let other = direction.cross(side);
        let ring = circle(radius, sides, 0.0);
        sections.push(ring.iter().map(|&[x, y]| centre + side * x + other * y).collect());
    }
    loft(&sections, closing)
}
