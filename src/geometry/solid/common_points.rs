//! Whether two triangles of a mesh have points in common that they should not, exactly.

use crate::geometry::Sign;
use crate::geometry::planes::orientation;
use glam::Vec3;

/// A triangle of a mesh, and a number for each corner, equal for equal positions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facet {
    pub corners: [Vec3; 3],
    pub numbers: [u32; 3],
}

impl Facet {
    /// Whether two closed triangles have a point in common that is on no corner or edge that they share.
    /// Triangles of no area may count as having one.
    pub fn meets_beyond_shared(&self, other: &Facet) -> bool {
        let [mine, theirs] = [self.split(other), other.split(self)];
        if mine.1 != theirs.1 {
            return true;
        }
        let (own, shared) = mine.0.split_at(mine.1);
        let (others, _) = theirs.0.split_at(theirs.1);
        match (own, others, shared) {
            // A common edge. Off each other's plane, the planes have only its line in common.
            (&[c], &[d], &[a, b]) => orientation(d, self.corners) == Sign::Zero && !is_between(a, b, c, d),
            // Beyond a common corner: from any other common point, away from that corner, the first opposite
            // edge that is reached is still in both.
            (&[b, c], &[d, e], &[_]) => {
                !self.has_on_one_side(others)
                    && !other.has_on_one_side(own)
                    && (segment_meets([b, c], other.corners) || segment_meets([d, e], self.corners))
            }
            // Where two triangles meet at all, an edge of one meets the other.
            (&[_, _, _], &[_, _, _], &[]) => {
                let any_edge_meets = |[a, b, c]: [Vec3; 3], other: [Vec3; 3]| {
                    [[a, b], [b, c], [c, a]].into_iter().any(|edge| segment_meets(edge, other))
                };
                !self.has_on_one_side(others)
                    && !other.has_on_one_side(own)
                    && (any_edge_meets(self.corners, other.corners)
                        || any_edge_meets(other.corners, self.corners))
            }
            _ => true,
        }
    }

    /// The corners that the other triangle does not have, before those that it has, and the number of the
    /// former.
    fn split(&self, other: &Facet) -> ([Vec3; 3], usize) {
        let is_shared = self.numbers.map(|number| other.numbers.contains(&number));
        let mut order = [0, 1, 2];
        order.sort_by_key(|&i| is_shared[i]);
        (order.map(|i| self.corners[i]), is_shared.iter().filter(|&&shared| !shared).count())
    }

    /// Whether all points are strictly on one side of the triangle's plane.
    fn has_on_one_side(&self, points: &[Vec3]) -> bool {
        let first = orientation(points[0], self.corners);
        first != Sign::Zero && points[1..].iter().all(|&p| orientation(p, self.corners) == first)
    }
}

/// Whether the line ab strictly separates c from d, all in one plane.
fn is_between(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> bool {
    flat_axis([a, b, c]).is_some_and(|axis| turn(axis, [a, b, c]) * turn(axis, [a, b, d]) == Sign::Negative)
}

/// Whether a closed segment and a closed triangle have a point in common.
fn segment_meets([p, q]: [Vec3; 2], corners: [Vec3; 3]) -> bool {
    let ends = [orientation(p, corners), orientation(q, corners)];
    if ends == [Sign::Zero; 2] {
        return coplanar_segment_meets([p, q], corners);
    }
    if ends[0] == ends[1] {
        return false;
    }
    // One point of the segment is in the plane: inside unless the line passes two edges on different sides.
    let [a, b, c] = corners;
    let sides = [[a, b], [b, c], [c, a]].map(|[s, t]| orientation(p, [q, s, t]));
    !(sides.contains(&Sign::Positive) && sides.contains(&Sign::Negative))
}

/// The same in a plane: two convex sets whose difference is a polygon with edges along the triangle's and
/// the segment are disjoint exactly if the line of one of these strictly separates them.
fn coplanar_segment_meets([p, q]: [Vec3; 2], corners: [Vec3; 3]) -> bool {
    let Some(axis) = flat_axis(corners) else { return true };
    let [a, b, c] = corners;
    let inner = turn(axis, corners);
    let is_separated_by =
        |s: Vec3, t: Vec3| [p, q].into_iter().all(|end| turn(axis, [s, t, end]) * inner == Sign::Negative);
    if is_separated_by(a, b) || is_separated_by(b, c) || is_separated_by(c, a) {
        return false;
    }
    let sides = corners.map(|corner| turn(axis, [p, q, corner]));
    sides[0] == Sign::Zero || sides != [sides[0]; 3]
}

/// An axis along which the triangle's plane can be looked at; none for a triangle of no area.
fn flat_axis(corners: [Vec3; 3]) -> Option<usize> {
    (0..3).find(|&axis| turn(axis, corners) != Sign::Zero)
}

/// The way that three points of a plane turn, looked at along an axis.
fn turn(axis: usize, corners: [Vec3; 3]) -> Sign {
    let flat = |p: Vec3| robust::Coord { x: f64::from(p[(axis + 1) % 3]), y: f64::from(p[(axis + 2) % 3]) };
    let [a, b, c] = corners.map(flat);
    Sign::of(robust::orient2d(a, b, c))
}
