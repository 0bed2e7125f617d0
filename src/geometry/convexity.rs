//! Whether an object is convex, verified rather than declared (rows 9 and 16 of the notes on the 1986
//! paper).

use super::Sign;
use super::planes::orientation;
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
    /// Whether the triangles are a solid's whole surface.
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
    let surface = surface(triangles, &corners);
    Some(Convexity { inner_side, surface })
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

/// What the triangles of a verified convex object amount to.
///
/// They lie on the boundary of the corners' hull. If every edge has two triangles, one on either side, then
/// crossing an edge leaves the number of triangles over a point of the boundary as it is, so that it is the
/// same everywhere and nothing is left out. Two triangles folded onto each other (a sheet modelled from both
/// sides) would let the boundary end there.
fn surface(triangles: &[[Vec3; 3]], corners: &[Vec3]) -> Surface {
    let mut edges: HashMap<_, Vec<[Vec3; 3]>> = HashMap::new();
    for &[a, b, c] in triangles {
        for (p, q, apex) in [(a, b, c), (b, c, a), (c, a, b)] {
            let (p, q) = if key(p) <= key(q) { (p, q) } else { (q, p) };
            edges.entry((key(p), key(q))).or_default().push([p, q, apex]);
        }
    }
    let closes = |owners: &Vec<[Vec3; 3]>| match owners[..] {
        [first, second] => lie_on_either_side(first, second, corners),
        _ => false,
    };
    if edges.values().all(closes) { Surface::Closed } else { Surface::Open }
}

/// Whether two triangles with the same first two corners, both with all `corners` on one side of their
/// planes, continue each other there. Never in an object that is flat.
fn lie_on_either_side(first: [Vec3; 3], second: [Vec3; 3], corners: &[Vec3]) -> bool {
    if orientation(second[2], first) != Sign::Zero {
        return true;
    }
    let off_plane = corners.iter().find(|&&q| orientation(q, first) != Sign::Zero);
    off_plane.is_some_and(|&q| orientation(q, first) * orientation(q, second) == Sign::Negative)
}

/// Equal for equal positions, both zeros alike.
pub(super) fn key(p: Vec3) -> [u32; 3] {
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

    #[test]
    fn sheets_modelled_from_both_sides_are_no_solid() {
        let turned = |[a, b, c]: [Vec3; 3]| [a, c, b];
        let sheets = |faces: &[[Vec3; 3]]| -> Vec<_> { faces.iter().flat_map(|&f| [f, turned(f)]).collect() };
        let faces = tetrahedron();
        for some in [&faces[..1], &faces[..2], &faces[..]] {
            assert_eq!(verify(&sheets(some)).unwrap().surface, Surface::Open);
        }
        // A flat square, cut along one diagonal above and along the other below.
        let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
        let square = [[a, b, c], [a, c, d], [a, b, d], [b, c, d]];
        assert_eq!(verify(&square).unwrap().surface, Surface::Open);
    }

    #[test]
    fn a_box_with_two_coplanar_triangles_a_face_is_closed() {
        let corner = |i: usize| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
        let quads = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        let cut = |[a, b, c, d]: [usize; 4]| [[a, b, c].map(corner), [a, c, d].map(corner)];
        let triangles: Vec<_> = quads.into_iter().flat_map(cut).collect();
        assert_eq!(verify(&triangles).unwrap().surface, Surface::Closed);
    }

    #[test]
    fn objects_of_more_triangles_than_that_are_not_examined() {
        let triangles = vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; MOST_TRIANGLES + 2];
        let is_examined = |count: usize| verify(&triangles[..count]).is_some();
        assert_eq!([0, 1, 2].map(|more| is_examined(MOST_TRIANGLES + more)), [true, false, false]);
    }
}
