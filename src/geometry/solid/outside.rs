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
