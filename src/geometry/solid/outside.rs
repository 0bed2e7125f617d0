//! Whether a light is outside a closed solid.

use crate::geometry::planes::orientation;
use crate::geometry::ray_triangle::{RayParameter, RayTriangle};
use crate::geometry::{LightPosition, Sign};
use glam::Vec3;
use std::cmp::Ordering;

/// Rays that are tried before a light counts as not outside.
const RAYS: usize = 24;

/// Whether a light at a point is certainly outside closed triangles with the given outer side.
///
/// Of the triangles that a ray from the light hits, those that are hit first tell. Let them be in A, and let
/// all of them have the same side towards the light. Rays beside this one, through the inside of one of them,
/// arrive near A on that side. Were the light in the other region, each would have to cross some triangle
/// before, from its other side; as they come nearer to the first ray, such a triangle is hit by that too, and
/// not behind A, so in A. There is none. Triangles whose plane holds the light take no part in this, but the
/// light may not be on one: whoever has the light in its box is in doubt.
pub(super) fn is_outside(
    light: Vec3,
    triangles: &[[Vec3; 3]],
    (low, high): (Vec3, Vec3),
    outer_side: Sign,
) -> bool {
    if light.cmplt(low).any() || light.cmpgt(high).any() {
        return true;
    }
    let mut prepared = Vec::with_capacity(triangles.len());
    for &corners in triangles {
        match RayTriangle::new(light, corners) {
            Some(triangle) => prepared.push((triangle, orientation(LightPosition::At(light), corners))),
            None if may_hold(corners, light) => return false,
            None => {}
        }
    }
    let stride = triangles.len().div_ceil(RAYS).max(1);
    let first_side = triangles.iter().step_by(stride).find_map(|&[a, b, c]| {
        // Anywhere near the middle; not the middle itself, where the edges of other triangles may stand.
        let target = a * 0.37 + b * 0.33 + c * 0.3;
        side_of_first_hits(target - light, &prepared)
    });
    first_side == Some(outer_side)
}

/// Whether a point in the triangle's plane is in its box, and so perhaps in the triangle.
fn may_hold([a, b, c]: [Vec3; 3], point: Vec3) -> bool {
    point.cmpge(a.min(b).min(c)).all() && point.cmple(a.max(b).max(c)).all()
}

/// The side that all triangles have towards the origin of a ray that it hits before any other, if it is the
/// same for all.
fn side_of_first_hits(direction: Vec3, triangles: &[(RayTriangle, Sign)]) -> Option<Sign> {
    if !direction.is_finite() {
        return None;
    }
    let mut nearest: Option<(RayParameter, &RayTriangle)> = None;
    let mut common_side = None;
    for (triangle, side) in triangles {
        let Some(hit) = triangle.hit(direction) else { continue };
        let order = nearest.map_or(Ordering::Less, |(before, known)| {
            hit.certain_order(before).unwrap_or_else(|| RayTriangle::exact_order(direction, triangle, known))
        });
        match order {
            Ordering::Less => {
                nearest = Some((hit, triangle));
                common_side = Some(*side);
            }
            Ordering::Equal if common_side != Some(*side) => common_side = None,
            Ordering::Equal | Ordering::Greater => {}
        }
    }
    common_side
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_may_hold_a_point_has_it_in_its_box() {
        let corners = [Vec3::ZERO, Vec3::new(2.0, 4.0, 0.0), Vec3::new(0.0, 4.0, 6.0)];
        let holds = |x: f32, y: f32, z: f32| may_hold(corners, Vec3::new(x, y, z));
        assert!(holds(0.0, 0.0, 0.0) && holds(2.0, 4.0, 6.0) && holds(1.0, 1.0, 1.0));
        assert!(
            !holds(-0.1, 1.0, 1.0)
                && !holds(2.1, 1.0, 1.0)
                && !holds(1.0, 4.1, 1.0)
                && !holds(1.0, 1.0, -0.1)
        );
    }

    #[test]
    fn the_plane_of_a_side_beside_it_leaves_no_doubt() {
        // A prism over the letter L: the inner corner is (1, 1), and the light stands in the planes of both inner sides
        // in turn, and in its bounds.
        let rim = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let corner = |i: usize, z: f32| Vec3::new(rim[i % 6][0], rim[i % 6][1], z);
        let walls = (0..6).flat_map(|i| {
            let [a, b] = [corner(i, 0.0), corner(i + 1, 0.0)];
            let [c, d] = [corner(i + 1, 1.0), corner(i, 1.0)];
            [[a, b, c], [a, c, d]]
        });
        let lids = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
        let lids = lids.iter().flat_map(|&[a, b, c]| {
            [
                [corner(a, 1.0), corner(b, 1.0), corner(c, 1.0)],
                [corner(a, 0.0), corner(c, 0.0), corner(b, 0.0)],
            ]
        });
        let triangles: Vec<_> = walls.chain(lids).collect();
        let bounds = (Vec3::ZERO, Vec3::new(2.0, 2.0, 1.0));
        let outside = |x: f32, y: f32| is_outside(Vec3::new(x, y, 0.4), &triangles, bounds, Sign::Negative);
        assert!(outside(1.5, 1.7) && outside(1.6, 1.5));
        // In the plane of the upper end, beside that.
        assert!(outside(3.0, 0.5) && outside(1.5, 2.0));
        assert!(!outside(0.5, 0.6) && !outside(1.7, 0.45));
        // In a plane beyond its side, and on a side.
        assert!(outside(1.0, 3.0) && outside(1.95, 1.9) && !outside(1.0, 1.5) && !outside(1.5, 1.0));
    }

    #[test]
    fn what_is_hit_first_tells_unless_two_sides_are() {
        let at = |z: f32| [Vec3::new(-1.0, -1.0, z), Vec3::new(1.0, -1.0, z), Vec3::new(0.0, 1.0, z)];
        let side = |hits: &[(f32, Sign)]| {
            let prepared =
                hits.iter().map(|&(z, side)| (RayTriangle::new(Vec3::ZERO, at(z)).expect("seen"), side));
            side_of_first_hits(Vec3::Z, &prepared.collect::<Vec<_>>())
        };
        use Sign::{Negative, Positive};
        assert_eq!(side(&[]), None);
        assert_eq!(side(&[(3.0, Negative), (2.0, Positive), (4.0, Negative)]), Some(Positive));
        assert_eq!(side(&[(2.0, Positive), (2.0, Positive), (3.0, Negative)]), Some(Positive));
        assert_eq!(side(&[(2.0, Positive), (2.0, Negative), (2.0, Positive)]), None);
    }
}
