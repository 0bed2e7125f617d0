//! Polygons to triangles.

use glam::{DVec3, Vec3};
use robust::Coord;

/// The triangles of a polygon, as indices of its corners.
#[derive(Debug, Default, PartialEq)]
pub(in crate::scene) struct Cut {
    /// Three indices into the polygon's corners each, wound as the polygon is.
    pub(in crate::scene) triangles: Vec<[usize; 3]>,
    /// Whether the outline crosses itself, so that no cut is right.
    pub(in crate::scene) crossed: bool,
}

/// Cuts a polygon of at least three corners into triangles, or says why it cannot.
///
/// A strictly convex polygon becomes a fan around its first corner. Any other loses its ears one by one, on
/// its projection along the largest component of its normal, with exact signs. Every corner stays a corner
/// of the triangles, also one in the middle of a straight edge, so a neighbour across that edge still meets
/// it vertex to vertex and closed meshes stay closed.
///
/// # Errors
/// A line for a polygon that is not convex and has more than `max_concave` corners.
pub(in crate::scene) fn triangulate(corners: &[Vec3], max_concave: usize) -> Result<Cut, String> {
    let count = corners.len();
    if count == 3 {
        return Ok(Cut { triangles: vec![[0, 1, 2]], crossed: false });
    }
    if let Some(apex) = corners.iter().position(|p| !p.is_finite()) {
        // All of it must go, so that corner is made part of every triangle.
        return Ok(Cut { triangles: fan(count, apex), crossed: false });
    }
    let normal = newell_normal(corners);
    if normal == DVec3::ZERO {
        return Ok(Cut { triangles: fan(count, 0), crossed: true });
    }
    let outline = project(corners, normal);
    if is_strictly_convex(&outline) {
        return Ok(Cut { triangles: fan(count, 0), crossed: false });
    }
    if count > max_concave {
        return Err(format!("expected at most {max_concave} corners of a polygon that is not convex"));
    }
    Ok(clip_ears(&outline))
}

fn fan(count: usize, apex: usize) -> Vec<[usize; 3]> {
    (1..count - 1).map(|i| [apex, (apex + i) % count, (apex + i + 1) % count]).collect()
}

/// Twice the vector area of the polygon: for a flat one, normal to its plane.
fn newell_normal(corners: &[Vec3]) -> DVec3 {
    // Relative to one corner: far from the origin the products would swallow the area.
    let origin = corners[0].as_dvec3();
    let mut previous = corners[corners.len() - 1].as_dvec3() - origin;
    let mut normal = DVec3::ZERO;
    for corner in corners {
        let current = corner.as_dvec3() - origin;
        normal += previous.cross(current);
        previous = current;
    }
    normal
}

/// Drops the axis along which the polygon is seen largest; counter-clockwise afterwards.
fn project(corners: &[Vec3], normal: DVec3) -> Vec<Coord<f64>> {
    let size = normal.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mirror = normal[axis].signum();
    corners.iter().map(|p| Coord { x: f64::from(p[u]) * mirror, y: f64::from(p[v]) }).collect()
}

fn turn(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> f64 {
    robust::orient2d(a, b, c)
}

/// Whether every turn is to the left and every triangle of the fan around corner 0 is too.
fn is_strictly_convex(outline: &[Coord<f64>]) -> bool {
    let count = outline.len();
    let at = |i: usize| outline[i % count];
    (0..count).all(|i| turn(at(i), at(i + 1), at(i + 2)) > 0.0)
        && (1..count - 1).all(|i| turn(outline[0], outline[i], outline[i + 1]) > 0.0)
}

fn clip_ears(outline: &[Coord<f64>]) -> Cut {
    let count = outline.len();
    let mut next: Vec<usize> = (1..count).chain([0]).collect();
    let mut previous: Vec<usize> = [count - 1].into_iter().chain(0..count - 1).collect();
    let mut cut = Cut::default();
    let mut candidate = 0;
    for left in (4..=count).rev() {
        let mut ear = None;
        let mut fallback = None;
        for _ in 0..left {
            let (before, after) = (previous[candidate], next[candidate]);
            if turn(outline[before], outline[candidate], outline[after]) > 0.0 {
                fallback.get_or_insert(candidate);
                if is_ear(outline, &next, before, candidate, after) {
                    ear = Some(candidate);
                    break;
                }
            }
            candidate = after;
        }
        // A simple polygon always has an ear. Where the outline crosses itself, something must give.
        cut.crossed |= ear.is_none();
        let corner = ear.or(fallback).unwrap_or(candidate);
        let (before, after) = (previous[corner], next[corner]);
        cut.triangles.push([before, corner, after]);
        next[before] = after;
        previous[after] = before;
        // To step over a corner spreads the cuts around the outline, which makes fewer slivers.
        candidate = next[after];
    }
    let (before, after) = (previous[candidate], next[candidate]);
    cut.crossed |= turn(outline[before], outline[candidate], outline[after]) < 0.0;
    cut.triangles.push([before, candidate, after]);
    cut
}

/// Whether no other corner lies in the closed triangle. Corners at the same place as one of its own are
/// those of a bridge to a hole and do not count.
fn is_ear(outline: &[Coord<f64>], next: &[usize], before: usize, corner: usize, after: usize) -> bool {
    let [a, b, c] = [before, corner, after].map(|i| outline[i]);
    let low = (a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y));
    let high = (a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y));
    let mut other = next[after];
    while other != before {
        let p = outline[other];
        let near = p.x >= low.0 && p.x <= high.0 && p.y >= low.1 && p.y <= high.1;
        let shared = [a, b, c].iter().any(|q| q.x == p.x && q.y == p.y);
        if near && !shared && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0 {
            return false;
        }
        other = next[other];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lift(outline: &[[f32; 2]]) -> Vec<Vec3> {
        outline.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect()
    }

    fn doubled_area(corners: &[Vec3], triangle: [usize; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| corners[i].as_dvec3());
        (b - a).cross(c - a).z
    }

    /// Checks that the triangles are wound as the outline, use each of its edges once, and fill its area.
    fn assert_fills(corners: &[Vec3]) {
        let cut = triangulate(corners, 1 << 12).unwrap();
        assert!(!cut.crossed);
        assert_eq!(cut.triangles.len(), corners.len() - 2);
        let total: f64 = cut.triangles.iter().map(|&t| doubled_area(corners, t)).sum();
        let expected = newell_normal(corners).z;
        assert!((total - expected).abs() <= 1e-9 * expected.abs(), "{total} of {expected}");
        for &triangle in &cut.triangles {
            assert!(doubled_area(corners, triangle) * expected > 0.0, "{triangle:?}");
        }
        for i in 0..corners.len() {
            let edge = (i, (i + 1) % corners.len());
            let users = cut.triangles.iter().filter(|t| (0..3).any(|k| (t[k], t[(k + 1) % 3]) == edge));
            assert_eq!(users.count(), 1, "edge {edge:?}");
        }
    }

    #[test]
    fn concave_straight_and_clockwise_outlines_are_filled() {
        let arrow = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [3.0, 1.0]];
        let corner_on_edge = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let comb =
            [[0.0, 0.0], [5.0, 0.0], [5.0, 3.0], [4.0, 1.0], [3.0, 3.0], [2.0, 1.0], [1.0, 3.0], [0.0, 1.0]];
        for outline in [&arrow[..], &corner_on_edge, &comb] {
            assert_fills(&lift(outline));
            let reversed: Vec<_> = outline.iter().rev().copied().collect();
            assert_fills(&lift(&reversed));
        }
    }

    #[test]
    fn a_hole_reached_over_a_bridge_stays_open() {
        let bridged = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ];
        let corners = lift(&bridged);
        let cut = triangulate(&corners, 100).unwrap();
        let total: f64 = cut.triangles.iter().map(|&t| doubled_area(&corners, t).max(0.0)).sum();
        assert_eq!(total, 24.0);
    }

    #[test]
    fn an_outline_that_crosses_itself_is_told() {
        let cut = triangulate(&lift(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 3.0]]), 100).unwrap();
        assert!(cut.crossed);
        assert_eq!(cut.triangles.len(), 2);
    }

    #[test]
    fn a_corner_that_is_not_finite_is_in_every_triangle() {
        let mut corners = lift(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        corners[2].z = f32::NAN;
        assert!(triangulate(&corners, 100).unwrap().triangles.iter().all(|t| t.contains(&2)));
    }

    #[test]
    fn a_large_polygon_must_be_convex() {
        let mut corners: Vec<Vec3> = (0..64)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / 64.0;
                Vec3::new(0.0, libm::cos(angle) as f32, libm::sin(angle) as f32)
            })
            .collect();
        assert_eq!(triangulate(&corners, 32).unwrap().triangles.len(), 62);
        corners[5] = Vec3::ZERO;
        assert!(triangulate(&corners, 32).is_err());
    }

    proptest! {
        /// Outlines that are stars around the origin are simple, whatever their radii.
        #[test]
        fn any_star_is_filled(radii in prop::collection::vec(0.05f32..4.0, 4..40)) {
            let count = radii.len();
            let corners: Vec<Vec3> = radii
                .iter()
                .enumerate()
                .map(|(i, r)| {
                    let angle = i as f64 * std::f64::consts::TAU / count as f64;
                    Vec3::new(r * libm::cos(angle) as f32, r * libm::sin(angle) as f32, 0.0)
                })
                .collect();
            assert_fills(&corners);
        }
    }
}
