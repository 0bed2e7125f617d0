//! Curved surfaces in the cells (row 18 of the notes on the 1986 paper): the hull of each is cast to find the
//! cells that may see it, and a polygon inside of it to find those that it covers.

use super::build::{Part, StandsFor};
use super::cell::{Candidate, Cover, Role};
use super::convex_cover::covered_depth;
use crate::geometry::curved::{Shape, hull, inner};
use crate::geometry::footprint::{Footprint, Grid};
use crate::geometry::{LightPosition, Sign};
use glam::DVec3;

/// The triangles that are cast for a curved surface; none for a plane without end.
pub(super) fn parts(shape: &Shape, light: LightPosition, role: Role) -> Vec<Part> {
    let Some(hull) = hull::outer(shape) else { return Vec::new() };
    let stands_for = if is_around(&hull, light) { StandsFor::HullAroundLight } else { StandsFor::Hull };
    let part = |corners| Part { corners, role, most: Cover::Part, stands_for };
    hull.into_iter().map(part).collect()
}

/// The triangles of the polygon inside of an opaque caster, if there is one.
pub(super) fn inner_parts(shape: &Shape, light: LightPosition, caster: u32) -> Vec<Part> {
    let Some(polygon) = inner::polygon(shape, light) else { return Vec::new() };
    let stands_for = StandsFor::Inner { margin: inner::margin(shape) };
    let (role, most) = (Role::Covers(caster), Cover::Whole);
    let part = |pair: &[DVec3]| Part { corners: [polygon[0], pair[0], pair[1]], role, most, stands_for };
    polygon[1..].windows(2).map(part).collect()
}

/// Whether a light may be inside of a hull, or so near to it that floats cannot tell.
fn is_around(hull: &hull::Hull, light: LightPosition) -> bool {
    let LightPosition::At(light) = light else { return false };
    let corners = || hull.iter().flatten();
    let middle = corners().copied().sum::<DVec3>() / (3 * hull.len()) as f64;
    let size = corners().map(|corner| (*corner - middle).abs().max_element()).fold(0.0, f64::max);
    let side = |[a, b, c]: &[DVec3; 3], p: DVec3| {
        let (u, v, w) = (*b - *a, *c - *a, p - *a);
        let bound = 1e-9 * u.length() * v.length() * (w.length() + size);
        Sign::certain(u.cross(v).dot(w), bound)
    };
    let is_outside = |triangle: &[DVec3; 3]| {
        let (light, middle) = (side(triangle, light.as_dvec3()), side(triangle, middle));
        light.is_some_and(|light| middle == Some(-light))
    };
    !hull.iter().any(is_outside)
}

/// The least depth behind which a polygon inside of a curved surface darkens the whole cell, or infinity: a
/// polygon is convex, and so is its projection, which holds the cell if it holds its corners.
pub(super) fn cover_depth<'a>(
    candidates: &[Candidate],
    footprint: impl Fn(usize) -> &'a Footprint,
    grid: &Grid,
    column: u32,
    row: u32,
) -> f32 {
    let members: Vec<(u32, usize)> = candidates
        .iter()
        .enumerate()
        .filter_map(|(k, candidate)| match candidate.role {
            Role::Covers(caster) => Some((caster, k)),
            Role::Blocks(_) | Role::ReceivesOnly => None,
        })
        .collect();
    covered_depth(candidates, members, footprint, grid, column, row)
}

/// Makes one candidate of all triangles of a hull, and leaves out the polygons that have done their part.
pub(super) fn join(candidates: &mut Vec<Candidate>) {
    candidates.retain(|candidate| !matches!(candidate.role, Role::Covers(_)));
    candidates.sort_unstable_by_key(|candidate| candidate.role);
    candidates.dedup_by(|next, kept| {
        let same = next.role == kept.role && next.role != Role::ReceivesOnly;
        if same {
            kept.near = kept.near.min(next.near);
            kept.far = kept.far.max(next.far);
        }
        same
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// The faces of a box.
    fn box_between(low: DVec3, high: DVec3) -> hull::Hull {
        let ends = [low, high];
        let corner = |i: usize| DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z);
        let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        let halves = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        halves.map(|triangle: [usize; 3]| triangle.map(corner)).collect()
    }

    #[test]
    fn a_light_is_inside_of_a_hull_or_beside_it() {
        let middle = DVec3::new(4.0, 8.0, -2.0);
        let hull = box_between(middle - 1.0, middle + 1.0);
        let is_around = |p: DVec3| is_around(&hull, LightPosition::At(p.as_vec3()));
        for i in 0..27 {
            let side = DVec3::from_array([i % 3, i / 3 % 3, i / 9].map(|k| f64::from(k) - 1.0));
            assert!(is_around(middle + 0.99 * side), "{side}");
            assert!(side == DVec3::ZERO || !is_around(middle + 1.01 * side), "{side}");
            // On the hull floats cannot tell.
            assert!(is_around(middle + side), "{side}");
        }
        assert!(!is_around(DVec3::ZERO) && !is_around(middle * 3.0) && !is_around(-middle));
        assert!(!super::is_around(&hull, LightPosition::Towards(Vec3::X)));
    }

    #[test]
    fn a_light_is_beside_a_hull_from_a_billionth_on() {
        // A face of edges 2 and sqrt 8, seen from its middle: the volume is 4 times the distance, and a billionth of
        // 2 sqrt 8 (sqrt 2 + 1), for the way from a corner and half the size, is 1.366e-8.
        let middle = DVec3::new(4.0, 8.0, -2.0);
        let is_around = |distance: f64| {
            let hull = box_between(middle - 1.0, middle + 1.0 - DVec3::X * distance);
            is_around(&hull, LightPosition::At((middle + DVec3::X).as_vec3()))
        };
        assert_eq!([3.35e-9, 3.48e-9].map(is_around), [true, false]);
    }
}
