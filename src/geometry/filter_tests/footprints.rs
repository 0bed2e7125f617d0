//! Which boxes of a grid a projection touches, and how near and far it is there.

use super::cases;
use super::inputs::situation;
use super::rational::{self as exact, Rational, rational, sign};
use crate::geometry::footprint::{Footprint, Frame, Grid};
use crate::geometry::planes::{OrientedPlanes, oriented};
use crate::geometry::{LightPosition, LightSpace, ROUNDOFF, Sign};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// Square boxes over [-1, 1] squared, as the light buffer has them on a side of its cube.
fn grid(count: u32) -> Grid {
    let cell = 2.0 / f64::from(count);
    Grid {
        origin: [0.5 * cell - 1.0; 2],
        step: [cell; 2],
        half: [0.5 * cell * (1.0 + 1e-12) + 1e-14; 2],
        count: [count; 2],
    }
}

fn frame(side: usize) -> [Vec3; 3] {
    match side {
        // The sides of a cube,
        0..6 => {
            let axes = [Vec3::X, Vec3::Y, Vec3::Z];
            let sign = if side < 3 { 1.0 } else { -1.0 };
            [axes[(side + 1) % 3], axes[(side + 2) % 3], axes[side % 3] * sign]
        }
        // and axes as a camera may have them.
        6 => [Vec3::new(0.75, 0.0, 0.25), Vec3::new(-0.125, 0.5, 0.375), Vec3::new(-0.25, -0.5, 1.0)],
        _ => [Vec3::new(1.5, 0.25, -0.5), Vec3::new(0.0, -0.375, 0.125), Vec3::new(0.5, 1.0, 2.0)],
    }
}

proptest! {
    #![proptest_config(cases(20000))]

    /// A point of the triangle is chosen, the box that it is projected into asked, and every place of that box that
    /// is hit must be between its bounds.
    #[test]
    fn every_box_that_is_hit_is_touched_and_its_depth_bounded(
        s in situation(),
        side in 0..8_usize,
        count in prop::sample::select(vec![1_u32, 2, 3, 16, 100, 1024]),
        weights in prop::array::uniform3(0..=3_u8),
        place in prop::array::uniform2(prop::sample::select(vec![-1.0, -1.0, -0.5, 0.0, 0.75, 1.0])),
    ) {
        let LightPosition::At(apex) = s.space.light() else { return Ok(()) };
        prop_assume!(s.is_finite());
        let Some(corners) = oriented(apex, s.corners) else { return Ok(()) };
        let [x, y, z] = frame(side);
        let frame = Frame::perspective(x.as_dvec3(), y.as_dvec3(), z.as_dvec3());
        let grid = grid(count);
        let planes = OrientedPlanes::from_apex(apex.as_dvec3(), corners.map(Vec3::as_dvec3));
        let total = weights.iter().map(|&w| f64::from(w)).sum::<f64>().max(1.0);
        let target = (0..3).fold(DVec3::ZERO, |sum, i| sum + planes.corners[i] * (f64::from(weights[i]) / total));
        // Boxes around where it is projected, or any if it is nowhere.
        let near = frame.project(target).map_or([0.0; 2], |p| p.on_grid);
        let index = |value: f64| (((value + 1.0) * 0.5 * f64::from(count)).floor().max(0.0) as u32).min(count - 1);
        let (column, row) = (index(near[0]), index(near[1]));
        let cell = rational(2.0 / f64::from(count));
        let on_grid = |box_: u32, place: f64| {
            let middle = rational(grid.origin[0]) + rational(grid.step[0]) * rational(f64::from(box_));
            middle + &cell * rational(0.5 * place)
        };
        let (u, v) = (on_grid(column, place[0]), on_grid(row, place[1]));
        let [x, y, z] = [x, y, z].map(exact::vector);
        let direction: exact::Vector = [0, 1, 2].map(|i| &x[i] * &u + &y[i] * &v + &z[i]);
        let from = exact::vector(apex);
        let Some(t) = exact::plane_parameter(&from, &direction, &corners) else { return Ok(()) };
        let p = exact::along(&from, &direction, &t);
        let [a, b, c] = corners;
        let hit = sign(&t) == Sign::Positive
            && [(a, b), (b, c), (c, a)].iter().all(|&(a, b)| sign(&exact::edge(apex.into(), a, b, &p)) != Sign::Negative);
        let footprint = Footprint::new(&grid, &frame, &planes);
        if let Some(footprint) = &footprint && footprint.covers(&grid, column, row) {
            prop_assert!(hit, "a box that is said to be covered is not");
        }
        if hit {
            let footprint = footprint.expect("it is hit");
            prop_assert!((footprint.rows()[0]..=footprint.rows()[1]).contains(&row));
            let span = footprint.span(&grid, row);
            prop_assert!(span.is_some_and(|[first, last]| (first..=last).contains(&column)), "{:?}", span);
            let [near, far] = footprint.z_bounds(&grid, column, row);
            prop_assert!(rational(near) <= t, "{:e}", near);
            prop_assert!(far == f64::INFINITY || t <= rational(far), "{:e}", far);
            prop_assert!(t > Rational::ZERO);
        }
    }

    /// The same across parallel lines.
    #[test]
    fn every_box_that_a_parallel_line_hits_in_is_touched_and_its_depth_bounded(
        s in situation(),
        count in prop::sample::select(vec![1_u32, 2, 3, 16, 100, 1024]),
        weights in prop::array::uniform3(0..=3_u8),
        place in prop::array::uniform2(prop::sample::select(vec![-1.0, -1.0, -0.5, 0.0, 0.75, 1.0])),
    ) {
        let LightPosition::Towards(towards) = s.space.light() else { return Ok(()) };
        prop_assume!(s.is_finite());
        let Some(corners) = oriented(s.space.light(), s.corners) else { return Ok(()) };
        let planes = OrientedPlanes::new(&s.space, corners.map(Vec3::as_dvec3));
        let depth = towards.abs().max_position();
        let (own, away) = ([(depth + 1) % 3, (depth + 2) % 3], -f64::from(towards[depth].signum()));
        let slope = own.map(|axis| f64::from(towards[axis]) / f64::from(towards[depth]));
        let across = |p: DVec3, i: usize| p[own[i]] - p[depth] * slope[i];
        // The grid holds the triangle, or about half of it.
        let extent = [0, 1].map(|i| {
            let far = planes.corners.iter().map(|&p| across(p, i).abs()).fold(1e-60, f64::max);
            2.0_f64.powi(far.log2().floor() as i32)
        });
        let unit = |axis: usize| DVec3::from_array([0, 1, 2].map(|i| f64::from(u8::from(i == axis))));
        let z = -towards.as_dvec3() / f64::from(towards[depth].abs());
        let dual = [0, 1].map(|i| (unit(own[i]) - unit(depth) * slope[i]) / extent[i]);
        let frame = Frame::parallel(
            [unit(own[0]) * extent[0], unit(own[1]) * extent[1], z],
            [dual[0], dual[1], unit(depth) * away],
        );
        let grid = grid(count);
        let total = weights.iter().map(|&w| f64::from(w)).sum::<f64>().max(1.0);
        let target = (0..3).fold(DVec3::ZERO, |sum, i| sum + planes.corners[i] * (f64::from(weights[i]) / total));
        let near = [0, 1].map(|i| across(target, i) / extent[i]);
        let index = |value: f64| (((value + 1.0) * 0.5 * f64::from(count)).floor().max(0.0) as u32).min(count - 1);
        let (column, row) = (index(near[0]), index(near[1]));
        let cell = rational(2.0 / f64::from(count));
        let on_grid = |box_: u32, place: f64| {
            let middle = rational(grid.origin[0]) + rational(grid.step[0]) * rational(f64::from(box_));
            middle + &cell * rational(0.5 * place)
        };
        // Where the line through a place of the grid hits the triangle, and how deep.
        let hit = |at: [Rational; 2]| {
            let mut from = exact::vector(s.space.origin());
            for (i, at) in at.iter().enumerate() {
                from[own[i]] = &from[own[i]] + rational(extent[i]) * at;
            }
            let direction = exact::vector(-towards);
            let t = exact::plane_parameter(&from, &direction, &corners).expect("a light off the plane");
            let p = exact::along(&from, &direction, &t);
            let [a, b, c] = corners;
            let signs = [(a, b), (b, c), (c, a)].map(|(a, b)| sign(&exact::edge(LightPosition::Towards(towards), a, b, &p)));
            (!signs.contains(&Sign::Negative)).then(|| t * rational(f64::from(towards[depth].abs())))
        };
        let found = hit([on_grid(column, place[0]), on_grid(row, place[1])]);
        let footprint = Footprint::new(&grid, &frame, &planes);
        if let Some(footprint) = &footprint {
            prop_assert!(found.is_some() || !footprint.covers(&grid, column, row), "said to be covered");
            prop_assert!(!footprint.contains(near[0], near[1]) || hit(near.map(rational)).is_some());
        }
        if let Some(z) = found {
            let footprint = footprint.expect("it is hit");
            prop_assert!((footprint.rows()[0]..=footprint.rows()[1]).contains(&row));
            let span = footprint.span(&grid, row);
            prop_assert!(span.is_some_and(|[first, last]| (first..=last).contains(&column)), "{:?}", span);
            let [near, far] = footprint.z_bounds(&grid, column, row);
            prop_assert!(near == f64::NEG_INFINITY || rational(near) <= z, "{:e}", near);
            prop_assert!(far == f64::INFINITY || z <= rational(far), "{:e}", far);
        }
    }
}

/// A triangle before a camera at the origin, or across parallel lines: the axes, its planes, and its corners on the
/// grid with their depths.
fn seen(corners: [Vec3; 3], is_far: bool) -> Option<(Frame, OrientedPlanes, [DVec3; 3])> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let light = if is_far { LightPosition::Towards(Vec3::NEG_Z) } else { LightPosition::At(Vec3::ZERO) };
    let corners = oriented(light, corners)?.map(Vec3::as_dvec3);
    let space = LightSpace::new(light, (Vec3::NEG_ONE, Vec3::ONE));
    let planes = OrientedPlanes::new(&space, corners);
    let frame =
        if is_far { Frame::parallel(axes, axes) } else { Frame::perspective(axes[0], axes[1], axes[2]) };
    let on_grid = |p: DVec3| if is_far { p } else { DVec3::new(p.x / p.z, p.y / p.z, p.z) };
    Some((frame, planes, corners.map(on_grid)))
}

/// At least how far a triangle and a box overlap: by the axis that separates them best.
fn overlap([a, b, c]: [DVec3; 3], [x, y]: [f64; 2], half: f64) -> f64 {
    let corners = [a, b, c];
    let along = |nx: f64, ny: f64| {
        let size = nx.hypot(ny);
        let values = corners.map(|p| ((p.x - x) * nx + (p.y - y) * ny) / size);
        let reach = half * (nx.abs() + ny.abs()) / size;
        let (low, high) = (
            values.iter().copied().fold(f64::INFINITY, f64::min),
            values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        );
        (high + reach).min(reach - low)
    };
    let edges = [(a, b), (b, c), (c, a)].map(|(p, q)| along(p.y - q.y, q.x - p.x));
    edges.into_iter().fold(along(1.0, 0.0).min(along(0.0, 1.0)), f64::min)
}

proptest! {
    #![proptest_config(cases(400))]

    /// Nothing is marked that the triangle is clear of, and what it clearly covers or holds is known to be.
    #[test]
    fn footprints_are_no_larger_than_they_must_be(
        corners in prop::array::uniform3((-1.5f32..1.5, -1.5f32..1.5, 0.5f32..2.0)),
        is_far in any::<bool>(),
    ) {
        const CLEAR: f64 = 1e-6;
        let grid = grid(8);
        let corners = corners.map(|(x, y, z)| Vec3::new(x, y, z));
        let Some((frame, planes, projected)) = seen(corners, is_far) else { return Ok(()) };
        let [a, b, c] = projected;
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        prop_assume!(area.abs() > 0.05);
        let footprint = Footprint::new(&grid, &frame, &planes);
        // How far inside of the triangle a place is.
        let depth_inside = |x: f64, y: f64| {
            let side = |p: DVec3, q: DVec3| {
                ((q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x)) * area.signum() / (q.x - p.x).hypot(q.y - p.y)
            };
            side(a, b).min(side(b, c)).min(side(c, a))
        };
        // z on its plane.
        let normal = (corners[1] - corners[0]).as_dvec3().cross((corners[2] - corners[0]).as_dvec3());
        let height = normal.dot(corners[0].as_dvec3());
        let z_at = |x: f64, y: f64| {
            if is_far { (height - normal.x * x - normal.y * y) / normal.z } else { height / normal.dot(DVec3::new(x, y, 1.0)) }
        };
        for row in 0..8 {
            let span = footprint.as_ref().and_then(|footprint| {
                let [first, last] = footprint.rows();
                (first..=last).contains(&row).then(|| footprint.span(&grid, row)).flatten()
            });
            for column in 0..8 {
                let centre = [column, row].map(|i| -0.875 + 0.25 * f64::from(i));
                let overlap = overlap(projected, centre, 0.125);
                let is_marked = span.is_some_and(|[first, last]| (first..=last).contains(&column));
                prop_assert!(overlap.abs() < CLEAR || is_marked == (overlap > 0.0), "{column} {row}: {overlap:e}");
                let Some(footprint) = &footprint else { continue };
                let box_ = grid.corners(column, row);
                let inside = box_.map(|[x, y]| depth_inside(x, y)).into_iter().fold(f64::INFINITY, f64::min);
                prop_assert!(inside.abs() < CLEAR || footprint.covers(&grid, column, row) == (inside > 0.0));
                let inside = depth_inside(centre[0], centre[1]);
                prop_assert!(inside.abs() < CLEAR || footprint.contains(centre[0], centre[1]) == (inside > 0.0));
                // Where it covers the box, the depths at its corners are the bounds.
                if footprint.covers(&grid, column, row) {
                    let depths = box_.map(|[x, y]| z_at(x, y));
                    let nearest = depths.into_iter().fold(f64::INFINITY, f64::min);
                    let farthest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
                    let [near, far] = footprint.z_bounds(&grid, column, row);
                    prop_assert!((near - nearest).abs() < CLEAR && (far - farthest).abs() < CLEAR);
                } else if is_marked {
                    let [near, far] = footprint.z_bounds(&grid, column, row);
                    let z = corners.map(|p| f64::from(p.z));
                    prop_assert!(near > z[0].min(z[1]).min(z[2]) - CLEAR && far < z[0].max(z[1]).max(z[2]) + CLEAR);
                }
            }
        }
    }
}

#[test]
fn what_projects_beside_the_apex_is_as_uncertain_as_is_derived() {
    let frame = Frame::perspective(DVec3::X, DVec3::Y, DVec3::Z);
    let found = frame.project(DVec3::new(-1.0, 0.5, 0.5)).expect("in front");
    assert_eq!(found.on_grid, [-2.0, 1.0]);
    // 4 * 64 roundoffs of 1 + 2, divided by z.
    assert_eq!(found.error, 4.0 * 64.0 * ROUNDOFF * 3.0 / 0.5);
    let nearest = 1024.0 * 64.0 * ROUNDOFF;
    assert!(frame.project(DVec3::new(0.0, 1.0, nearest)).is_none());
    assert!(frame.project(DVec3::new(0.0, 1.0, nearest.next_up())).is_some());
    assert!(frame.project(DVec3::NAN).is_none());
}
