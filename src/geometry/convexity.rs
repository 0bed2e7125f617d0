//! Whether an object is convex, verified rather than declared (rows 9 and 16 of the notes on the 1986
//! paper).

use super::Sign;
use super::light_triangle::orientation;
use glam::Vec3;
use std::collections::HashMap;

/// Objects with more triangles than this are not examined: the test looks at every corner from every face.
const MOST_TRIANGLES: usize = 2000;

/// A verified convex object.
#[derive(Debug, Clone, PartialEq)]
pub struct Convexity {
    /// For each triangle the side of its plane that the whole object lies on: the sign of
    /// det(a - q, b - q, c - q) for every corner q off the plane, zero if there is none.
    pub inner_side: Vec<Sign>,
    /// Whether every edge belongs to exactly two triangles, so that the object is a solid's whole surface.
    pub surface: Surface,
}

/// What the triangles of a convex object amount to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Surface {
    /// The whole boundary of a convex solid.
    Closed,
    /// A part of it.
    Open,
}

/// Verifies that every triangle's plane has the whole object on one side, exactly; `None` if not, or if the
/// object is too large to be examined.
pub fn verify(triangles: &[[Vec3; 3]]) -> Option<Convexity> {
    if triangles.len() > MOST_TRIANGLES {
        return None;
    }
    let mut corners: Vec<Vec3> = triangles.iter().flatten().copied().collect();
    corners.sort_by_key(|p| key(*p));
    corners.dedup();
    let inner_side =
        triangles.iter().map(|&t| supporting_side(t, &corners)).collect::<Option<Vec<Sign>>>()?;
    Some(Convexity { inner_side, surface: surface(triangles) })
}

fn supporting_side(triangle: [Vec3; 3], corners: &[Vec3]) -> Option<Sign> {
    let mut side = Sign::Zero;
    for &q in corners {
        match (side, orientation(q, triangle)) {
            (_, Sign::Zero) => {}
            (Sign::Zero, found) => side = found,
            (known, found) if known == found => {}
            _ => return None,
        }
    }
    Some(side)
}

fn surface(triangles: &[[Vec3; 3]]) -> Surface {
    let mut edges: HashMap<_, u32> = HashMap::new();
    for [a, b, c] in triangles {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let (p, q) = (key(*p), key(*q));
            *edges.entry((p.min(q), p.max(q))).or_default() += 1;
        }
    }
    if edges.values().all(|&count| count == 2) { Surface::Closed } else { Surface::Open }
}

/// Equal for equal positions, both zeros alike.
fn key(p: Vec3) -> [u32; 3] {
    p.to_array().map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Vec<[Vec3; 3]> {
        let (o, x, y, z) = (Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z);
        vec![[o, x, y], [o, x, z], [o, y, z], [x, y, z]]
    }

    #[test]
    fn a_tetrahedron_is_a_closed_convex_solid() {
        let convexity = verify(&tetrahedron()).unwrap();
        assert_eq!(convexity.surface, Surface::Closed);
        assert!(convexity.inner_side.iter().all(|&s| s != Sign::Zero));
    }

    #[test]
    fn a_dent_of_one_ulp_is_found() {
        // A square whose fourth corner sinks below or rises above the plane of the other three.
        let square =
            |z: f32| vec![[Vec3::ZERO, Vec3::X, Vec3::Y], [Vec3::X, Vec3::new(1.0, 1.0, z), Vec3::Y]];
        let flat = verify(&square(0.0)).unwrap();
        assert_eq!(flat.surface, Surface::Open);
        assert_eq!(flat.inner_side, [Sign::Zero; 2]);
        assert!(verify(&square(f32::from_bits(1))).is_some());
        let mut dented = tetrahedron();
        dented.push([Vec3::splat(0.1), Vec3::X, Vec3::Y]);
        assert!(verify(&dented).is_none());
    }
}
