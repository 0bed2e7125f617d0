//! Slacks and margins, on numbers for which they can be counted by hand. Whatever is below is too small to cover the
//! roundings that are derived beside it, and whatever is above marks boxes that nothing touches.

use super::*;

/// Boxes of 1 by 2 around the origin of the plane, with rows from the top.
fn grid(count: u32) -> Grid {
    Grid { origin: [0.5, -1.0], step: [1.0, -2.0], half: [0.5, 1.0], count: [count; 2] }
}

fn linear(a: f64, b: f64, c: f64, slack: f64) -> Linear {
    Linear { a, b, c, slack }
}

/// Whether a number is beyond a quotient by 2e-14 of it: more than five roundings, and not much more.
fn is_beyond(found: f64, quotient: f64, parts: f64) -> bool {
    ((found / quotient - 1.0) * 1e14 - parts).abs() < 0.1
}

#[test]
fn the_corners_of_a_box_are_half_its_extent_from_its_centre() {
    let corners = grid(4).corners(2, 1);
    assert_eq!(corners, [[2.0, -4.0], [2.0, -2.0], [3.0, -4.0], [3.0, -2.0]]);
}

#[test]
fn boxes_are_touched_from_a_billionth_of_all_of_them_on() {
    let grid = grid(8);
    // The columns cover 0 to 8 and the rows 0 to -16; the margin is nine billionths of a box.
    let column = |at: f64| grid.touched(0, [at, at]);
    assert_eq!([column(3.0 - 8.5e-9), column(3.0 + 8.5e-9)], [Some([2, 3]); 2]);
    assert_eq!([column(3.0 - 9.5e-9), column(3.0 + 9.5e-9)], [Some([2, 2]), Some([3, 3])]);
    assert_eq!([column(-8.5e-9), column(-9.5e-9)], [Some([0, 0]), None]);
    assert_eq!([column(8.0 + 8.5e-9), column(8.0 + 9.5e-9)], [Some([7, 7]), None]);
    assert_eq!(grid.touched(1, [-1.0, -3.0]), Some([0, 1]));
    assert_eq!(grid.touched(0, [-100.0, 100.0]), Some([0, 7]));
}

#[test]
fn points_are_projected_from_1024_times_the_slack_on() {
    let frame = Frame::perspective(DVec3::X, DVec3::Y, DVec3::Z);
    let nearest = 1024.0 * 64.0 * ROUNDOFF * 2.0;
    assert!(frame.project(DVec3::new(2.0, 0.0, nearest)).is_none());
    assert!(frame.project(DVec3::new(2.0, 0.0, nearest.next_up())).is_some());
}

#[test]
fn coordinates_of_a_frame_are_as_uncertain_as_is_derived() {
    let dual = [DVec3::new(1.0, -2.0, 0.0), DVec3::Y * -3.0, DVec3::Z];
    let frame = Frame::parallel([DVec3::X, DVec3::Y, DVec3::Z], dual);
    let error = frame.coordinate_error(DVec3::new(5.0, -7.0, 0.5));
    assert_eq!(error, DVec3::new(5.0 + 14.0, 21.0, 0.5) * (16.0 * ROUNDOFF));
}

#[test]
fn lines_are_as_uncertain_as_is_derived() {
    let axes = [DVec3::X, DVec3::Y * -3.0, DVec3::Z];
    let plane = Plane { normal: DVec3::new(1.0, 2.0, 3.0), size: DVec3::new(7.0, 11.0, 13.0) };
    let reach = [2.0, 5.0];
    let frame = Frame::perspective(axes[0], axes[1], axes[2]);
    let line = Linear::edge(&plane, (0.0, 0.0), &frame, reach);
    assert_eq!([line.a, line.b, line.c], [1.0, -6.0, 3.0]);
    assert_eq!(line.slack, 32.0 * ROUNDOFF * (7.0 * 2.0 + 33.0 * 5.0 + 13.0));
    let frame = Frame::parallel(axes, axes);
    let line = Linear::edge(&plane, (-17.0, 19.0 * ROUNDOFF), &frame, reach);
    assert_eq!([line.a, line.b, line.c], [1.0, -6.0, 17.0]);
    assert_eq!(line.slack, 32.0 * ROUNDOFF * (7.0 * 2.0 + 33.0 * 5.0 + 17.0) + 2.0 * 19.0 * ROUNDOFF);
    // What underflows is not exact.
    let nothing = Plane { normal: DVec3::ZERO, size: DVec3::ZERO };
    assert_eq!(Linear::edge(&nothing, (0.0, 0.0), &frame, reach).slack, f64::MIN_POSITIVE);
    let frame = Frame::perspective(axes[0], axes[1], axes[2]);
    assert_eq!(Linear::edge(&nothing, (0.0, 0.0), &frame, reach).slack, f64::MIN_POSITIVE);
}

#[test]
fn depths_over_a_box_are_rounded_outwards() {
    let grid = Grid { half: [0.5, 0.25], ..grid(8) };
    let depth = |slope, height| Depth::Perspective { slope, height }.over_box(&grid, 3.0, -2.0);
    // At (3, -2) the slope is 3 + 8 + 1, and changes by half of 1 and a quarter of 4 beside its slack.
    let [near, far] = depth(linear(1.0, -4.0, 1.0, 0.25), (10.0, 0.5));
    assert!(is_beyond(near, 9.5 / 13.75, -2.0) && is_beyond(far, 10.5 / 10.25, 2.0), "{near} {far}");
    // Where the plane may hold the apex, nothing is known.
    assert_eq!(depth(linear(0.0, 0.0, 1.0, 1.0), (0.0, 0.0))[1], f64::INFINITY);
    assert_eq!(depth(linear(0.0, 0.0, -1.0, 1.0), (5.0, 0.0)), [0.0, f64::INFINITY]);
    let depth = |rise, steepness| Depth::Parallel { rise, steepness }.over_box(&grid, 3.0, -2.0);
    let [near, far] = depth(linear(1.0, -4.0, 1.0, 0.25), (2.0, 0.5));
    assert!(is_beyond(near, 10.25 / 2.5, -1.0) && is_beyond(far, 13.75 / 1.5, 1.0), "{near} {far}");
    let [near, far] = depth(linear(-1.0, 4.0, -1.0, 0.25), (2.0, 0.5));
    assert!(is_beyond(near, -13.75 / 1.5, 1.0) && is_beyond(far, -10.25 / 2.5, -1.0), "{near} {far}");
    let unknown = [f64::NEG_INFINITY, f64::INFINITY];
    assert_eq!(depth(linear(1.0, 0.0, 0.0, 0.0), (1.0, 0.5)), unknown);
    assert!(depth(linear(1.0, 0.0, 0.0, 0.0), (1.0, 0.25)) != unknown);
}

/// A footprint over all columns whose edges are given.
fn footprint(edges: [Linear; 3], count: u32) -> Footprint {
    let slope = linear(0.0, 0.0, 1.0, 0.0);
    Footprint {
        edges,
        depth: Depth::Perspective { slope, height: (1.0, 0.0) },
        columns: [0, count - 1],
        rows: [0, count - 1],
        z_range: [0.0, 1.0],
    }
}

#[test]
fn a_row_begins_and_ends_a_little_beside_where_lines_cross_it() {
    // Boxes without extent at 0, 1, 2, ...
    let grid = Grid { origin: [0.0; 2], step: [1.0; 2], half: [0.0; 2], count: [5000; 2] };
    let always = linear(0.0, 0.0, 1.0, 0.0);
    let span = |line: Linear| footprint([always, line, always], 5000).span(&grid, 0);
    // A billionth, and 1e-13 of 4000.
    assert_eq!(span(linear(1.0, 0.0, -4000.0 - 1.38e-9, 0.0)), Some([4000, 4999]));
    assert_eq!(span(linear(1.0, 0.0, -4000.0 - 1.42e-9, 0.0)), Some([4001, 4999]));
    assert_eq!(span(linear(-1.0, 0.0, 4000.0 - 1.38e-9, 0.0)), Some([0, 4000]));
    assert_eq!(span(linear(-1.0, 0.0, 4000.0 - 1.42e-9, 0.0)), Some([0, 3999]));
    // Lines that cross no row hold it or do not.
    let level = |value: f64| span(linear(0.0, 0.0, value, 0.0));
    assert_eq!([level(0.0), level(1e-300), level(-1e-300)], [Some([0, 4999]), Some([0, 4999]), None]);
    // The first and the last box, and none.
    assert_eq!(span(linear(1.0, 0.0, -4999.0, 0.0)), Some([4999, 4999]));
    assert_eq!(span(linear(1.0, 0.0, -4999.5, 0.0)), None);
    assert_eq!(span(linear(-1.0, 0.0, 0.0, 0.0)), Some([0, 0]));
    assert_eq!(span(linear(-1.0, 0.0, -0.5, 0.0)), None);
    assert_eq!(span(linear(1.0, 0.0, 70.0, 0.0)), Some([0, 4999]));
}

#[test]
fn what_only_touches_a_line_is_neither_covered_nor_held() {
    let grid = Grid { half: [0.5, 0.0], ..grid(8) };
    let at = |c: f64| footprint([linear(1.0, 0.0, c, 0.25); 3], 8);
    // The box from 3 to 4.
    assert!(!at(-2.75).covers(&grid, 3, 0) && at(f64::next_up(-2.75)).covers(&grid, 3, 0));
    assert!(!at(-2.75).contains(3.0, 0.0) && at(f64::next_up(-2.75)).contains(3.0, 0.0));
}

#[test]
fn the_part_before_an_apex_is_as_uncertain_as_is_derived() {
    let corners = [DVec3::new(-2.0, 3.0, 2.0), DVec3::new(2.0, 0.0, 2.0), DVec3::new(0.0, -4.0, 4.0)];
    let clipped = Clipped::new(corners, [2.0, 5.0]).unwrap();
    // 64 roundoffs of the largest coordinate, for 1 + 2 + 5.
    let slack = 64.0 * ROUNDOFF * 4.0 * 8.0;
    let error = |value: f64, z: f64| 4.0 * slack * (1.0 + value) / z;
    assert_eq!(clipped.z, [2.0 - 2.0 * slack, 4.0 + 2.0 * slack]);
    assert_eq!(clipped.x, [-1.0 - error(1.0, 2.0), 1.0 + error(1.0, 2.0)]);
    assert_eq!(clipped.y, [-1.0 - error(1.0, 4.0), 1.5 + error(1.5, 2.0)]);
    // As near as that to the apex it may be anywhere.
    let with = |z: f64| Clipped::new([corners[0], corners[1], DVec3::new(0.0, 0.0, z)], [2.0, 5.0]).unwrap();
    let slack = 64.0 * ROUNDOFF * 3.0 * 8.0;
    let (near, far) = (with(1024.0 * slack), with(1025.0 * slack));
    assert_eq!([near.x, near.y], [[f64::NEG_INFINITY, f64::INFINITY]; 2]);
    assert!(far.x.iter().chain(&far.y).all(|end| end.is_finite()));
    // Depths are not negative, and what lies behind the apex has none.
    assert_eq!(with(slack).z[0], 0.0);
    assert!(Clipped::new(corners.map(|p| DVec3::new(p.x, p.y, -p.z)), [2.0, 5.0]).is_none());
    assert!(Clipped::new(corners.map(|p| DVec3::new(p.x + 9.0, p.y, p.z)), [2.0, 5.0]).is_none());
}

#[test]
fn a_triangle_across_parallel_lines_is_as_uncertain_as_its_corners() {
    let corners = [DVec3::new(1.0, 5.0, 7.0), DVec3::new(4.0, -2.0, 3.0), DVec3::new(-3.0, 0.0, 8.0)];
    let errors = [DVec3::splat(0.5), DVec3::splat(0.25), DVec3::splat(2.0)];
    let Clipped { x, y, z } = Clipped::around(corners, errors);
    assert_eq!([x, y, z], [[-5.0, 4.25], [-2.25, 5.5], [2.75, 10.0]]);
}

#[test]
fn polygons_are_cut_where_a_line_crosses_them() {
    let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 1.0));
    let at = |x: f64| clip(&square, |p| p.x - x);
    let expected = [(1.0, 0.0), (4.0, 0.0), (4.0, 4.0), (1.0, 4.0)];
    assert_eq!(at(1.0), expected.map(|(x, y)| DVec3::new(x, y, 1.0)));
    assert_eq!(at(0.0), square);
    // A corner on the line stays, and is also where the side that leaves from it is cut.
    assert_eq!(at(4.0), [square[1], square[1], square[2], square[2]]);
    assert!(at(4.5).is_empty());
}

#[test]
fn rows_and_columns_are_those_around_the_projection() {
    let corners = [DVec3::new(1.25, -0.5, 1.0), DVec3::new(3.75, -0.5, 1.0), DVec3::new(1.25, -8.5, 1.0)];
    let frame = Frame::perspective(DVec3::X, DVec3::Y, DVec3::Z);
    let planes = OrientedPlanes::of_hull(DVec3::ZERO, corners).unwrap();
    let footprint = Footprint::new(&grid(8), &frame, &planes).unwrap();
    assert_eq!((footprint.columns(), footprint.rows()), ([1, 3], [0, 4]));
    assert_eq!(
        [0, 2, 4].map(|row| footprint.span(&grid(8), row)),
        [Some([1, 3]), Some([1, 2]), Some([1, 1])]
    );
}
