//! Boxes, and rectangular frames with mitred corners.

use super::loft::{Closing, loft};
use super::mesh::Mesh;
use glam::DVec3;

/// A box between two corners: six polygons.
pub(in crate::scene::procedural) fn cuboid(low: [f64; 3], high: [f64; 3]) -> Mesh {
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { low[axis] } else { high[axis] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh::new((0..8).map(corner).collect(), faces.iter().map(|face| face.to_vec()).collect())
}

/// A moulding around a rectangle in the plane of x and z, mitred at its corners: four polygons for each point
/// of the section, whose points are (outwards from the rectangle, height), counter-clockwise.
pub(in crate::scene::procedural) fn mitred_frame(half: [f64; 2], section: &[[f64; 2]]) -> Mesh {
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let ring = |[sx, sz]: [f64; 2]| -> Vec<DVec3> {
        let point = |&[out, y]: &[f64; 2]| DVec3::new(sx * (half[0] + out), y, sz * (half[1] + out));
        section.iter().map(point).collect()
    };
    loft(&corners.map(ring), Closing::Loop)
}
