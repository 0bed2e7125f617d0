//! Which boxes of a grid a projection touches, and how near and far it is there.

use super::cases;
use super::inputs::situation;
use super::rational::{self as exact, Rational, rational, sign};
use crate::geometry::footprint::{Footprint, Frame, Grid};
use crate::geometry::planes::{OrientedPlanes, oriented};
use crate::geometry::{LightPosition, Sign};
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
}
