//! Which boxes of a grid the projection of a convex mesh can touch: a superset, one run of boxes a row.
//!
//! The projection of a convex mesh in front of the apex is the convex hull of its projected corners, and its
//! outline consists of projected edges. So in a strip of the grid it reaches from the leftmost to the rightmost
//! point of all edges in that strip. Quicker than a [`Footprint`](super::footprint::Footprint) for each triangle,
//! where nothing is asked of their depths.

use super::footprint::{Frame, Grid};
use glam::DVec3;

/// What the projection of a convex mesh can touch.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Projected {
    /// No box.
    Nowhere,
    /// These boxes at most.
    Within(Outline),
    /// A corner is too near to the plane through the apex to be projected, or behind it.
    TooNear,
}

/// First and last column of each row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Outline {
    first_row: u32,
    spans: Vec<Option<[u32; 2]>>,
}

impl Outline {
    /// Projects a closed convex mesh, its triangles' corners relative to the apex.
    pub fn project(grid: &Grid, frame: &Frame, mesh: impl Iterator<Item = [DVec3; 3]>) -> Projected {
        let mut edges: Vec<[[f64; 2]; 2]> = Vec::with_capacity(64);
        let mut error: f64 = 0.0;
        for corners in mesh {
            let mut projected = [[0.0; 2]; 3];
            for (corner, on_grid) in corners.iter().zip(&mut projected) {
                let Some(point) = frame.project(*corner) else { return Projected::TooNear };
                *on_grid = point.on_grid;
                error = error.max(point.error);
            }
            let [a, b, c] = projected;
            edges.extend([[a, b], [b, c], [c, a]]);
        }
        if !error.is_finite() {
            return Projected::TooNear;
        }
        let range = |axis: usize| {
            let ends = edges.iter().flatten().map(|point| point[axis]);
            let [low, high] = bounds(ends);
            [low - error, high + error]
        };
        let (Some(_), Some([top, bottom])) = (grid.touched(0, range(0)), grid.touched(1, range(1))) else {
            return Projected::Nowhere;
        };
        let spans = (top..=bottom).map(|row| span(grid, &edges, error, row)).collect();
        Projected::Within(Outline { first_row: top, spans })
    }

    /// Rows and their first and last columns, of those from `rows[0]` to before `rows[1]`.
    pub fn spans(&self, rows: [u32; 2]) -> impl Iterator<Item = (u32, [u32; 2])> {
        let end = self.first_row + self.spans.len() as u32;
        let (first, last) = (rows[0].max(self.first_row), rows[1].min(end));
        (first..last).filter_map(move |row| Some((row, self.spans[(row - self.first_row) as usize]?)))
    }
}

/// What the edges can touch in one row.
fn span(grid: &Grid, edges: &[[[f64; 2]; 2]], error: f64, row: u32) -> Option<[u32; 2]> {
    let y = grid.origin[1] + grid.step[1] * f64::from(row);
    // Ends are cut off a little outside, by more than the rounding of where.
    let margin = grid.half[1] + error + 1e-12 * (1.0 + y.abs() + error);
    let (low, high) = (y - margin, y + margin);
    let in_strip = |[[x0, y0], [x1, y1]]: &[[f64; 2]; 2]| {
        if (*y0 < low && *y1 < low) || (*y0 > high && *y1 > high) {
            return None;
        }
        let at = |y: f64| x0 + (x1 - x0) * ((y - y0) / (y1 - y0)).clamp(0.0, 1.0);
        let end = |x: f64, y: f64| {
            if y < low {
                at(low)
            } else if y > high {
                at(high)
            } else {
                x
            }
        };
        Some([end(*x0, *y0), end(*x1, *y1)])
    };
    let [left, right] = bounds(edges.iter().filter_map(in_strip).flatten());
    if left > right {
        return None;
    }
    let rounding = error + 1e-12 * (left.abs() + right.abs());
    grid.touched(0, [left - rounding, right + rounding])
}

fn bounds(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ROUNDOFF;
    use proptest::prelude::*;

    const GRID: Grid = Grid { origin: [-0.95, 0.95], step: [0.1, -0.1], half: [0.05, 0.05], count: [20, 20] };

    fn frame() -> Frame {
        Frame::perspective(DVec3::X, DVec3::Y, DVec3::Z)
    }

    /// A tetrahedron, which is convex whatever its corners are.
    fn tetrahedron([a, b, c, d]: [DVec3; 4]) -> [[DVec3; 3]; 4] {
        [[a, b, c], [a, c, d], [a, d, b], [b, d, c]]
    }

    #[test]
    fn a_corner_beside_the_apex_is_too_near() {
        let corners = [DVec3::Z, DVec3::X + DVec3::Z, DVec3::Y + DVec3::Z, DVec3::new(0.3, 0.3, 0.0)];
        let projected = Outline::project(&GRID, &frame(), tetrahedron(corners).into_iter());
        assert_eq!(projected, Projected::TooNear);
    }

    #[test]
    fn what_lies_beside_the_grid_touches_nothing() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + DVec3::new(9.0, 0.0, 2.0));
        let projected = Outline::project(&GRID, &frame(), tetrahedron(corners).into_iter());
        assert_eq!(projected, Projected::Nowhere);
    }

    #[test]
    fn what_a_corner_beside_the_apex_is_off_by_is_left_room() {
        // 4 * 64 roundoffs of (1 + 1 / z) / z, which is 0.22, for the corner at (1, 0, z).
        let z = (256.0 * ROUNDOFF / 0.22).sqrt();
        let corners = [DVec3::Z, DVec3::Z, DVec3::Z, DVec3::new(1.0, 0.0, z)];
        let Projected::Within(outline) = Outline::project(&GRID, &frame(), tetrahedron(corners).into_iter())
        else {
            panic!("its corners can be projected")
        };
        // From 0 to the right border, with 0.22 and half a box to all sides: centres from -0.25 to 0.25.
        let expected: Vec<_> = (7..=12).map(|row| (row, [7, 19])).collect();
        assert_eq!(outline.spans([0, 20]).collect::<Vec<_>>(), expected);
        assert_eq!(outline.spans([8, 10]).collect::<Vec<_>>(), expected[1..3]);
    }

    proptest! {
        /// No box is marked that the mesh is clear of by a billionth.
        #[test]
        fn rows_reach_as_far_as_the_mesh_in_them(
            corners in prop::array::uniform4((-1.5f64..1.5, -1.5f64..1.5, 0.5f64..2.0)),
        ) {
            let corners = corners.map(|(x, y, z)| DVec3::new(x, y, z));
            let projected = Outline::project(&GRID, &frame(), tetrahedron(corners).into_iter());
            let found: Vec<_> = match &projected {
                Projected::Within(outline) => outline.spans([0, 20]).collect(),
                _ => Vec::new(),
            };
            let ends = corners.map(|c| (c.x / c.z, c.y / c.z));
            for row in 0..20 {
                let y = 0.95 - 0.1 * f64::from(row);
                // All places of the mesh in the row, widened or narrowed: corners, and where edges pass its borders.
                let reach = |half: f64| {
                    let (low, high) = (y - half, y + half);
                    let inside = ends.iter().filter(|(_, y)| (low..=high).contains(y)).map(|&(x, _)| x);
                    let pairs = (0..4).flat_map(|i| (0..i).map(move |j| (ends[i], ends[j])));
                    let crossed = pairs.flat_map(|((x0, y0), (x1, y1))| {
                        [low, high].into_iter().filter_map(move |border| {
                            let t = (border - y0) / (y1 - y0);
                            (0.0..=1.0).contains(&t).then_some(x0 + (x1 - x0) * t)
                        })
                    });
                    bounds(inside.chain(crossed))
                };
                let columns = |[left, right]: [f64; 2], half: f64| {
                    let met = (0..20_u32).filter(|&column| {
                        let x = -0.95 + 0.1 * f64::from(column);
                        x + half >= left && x - half <= right
                    });
                    met.clone().min().zip(met.max())
                };
                let [least, most] = [-1e-7, 1e-7].map(|more| columns(reach(0.05 + more), 0.05 + more));
                let found = found.iter().find(|(at, _)| *at == row).map(|(_, [left, right])| (*left, *right));
                prop_assert!(found == most || found == least, "row {row}: {found:?}, {least:?} to {most:?}");
            }
        }

        #[test]
        fn every_point_of_the_mesh_is_in_a_box_of_the_outline(
            corners in prop::array::uniform4((-3.0f64..3.0, -3.0f64..3.0, 0.25f64..4.0)),
            weights in prop::array::uniform4(0.0f64..1.0),
        ) {
            let corners = corners.map(|(x, y, z)| DVec3::new(x, y, z));
            let total: f64 = weights.iter().sum();
            prop_assume!(total > 1e-3);
            let inside: DVec3 = corners.iter().zip(weights).map(|(&c, w)| c * (w / total)).sum();
            let (x, y) = (inside.x / inside.z, inside.y / inside.z);
            let cell = |value: f64, axis: usize| ((value - GRID.origin[axis]) / GRID.step[axis]).round();
            let (column, row) = (cell(x, 0), cell(y, 1));
            prop_assume!((0.0..20.0).contains(&column) && (0.0..20.0).contains(&row));
            let projected = Outline::project(&GRID, &frame(), tetrahedron(corners).into_iter());
            let Projected::Within(outline) = projected else { panic!("{projected:?}") };
            let (column, row) = (column as u32, row as u32);
            let found = outline.spans([row, row + 1]).next();
            prop_assert!(
                found.is_some_and(|(at, [left, right])| at == row && (left..=right).contains(&column)),
                "{column}, {row}: {outline:?}"
            );
            prop_assert!(outline.spans([0, 20]).all(|(row, [left, right])| row < 20 && left <= right && right < 20));
        }
    }

    #[test]
    fn a_row_is_widened_by_the_error_and_by_rounding() {
        let grid = Grid { origin: [0.0; 2], step: [1.0; 2], half: [0.5; 2], count: [40; 2] };
        // In row 19 with an error of 1: half a box, the error, and 1e-12 of 1 + 19 + 1.
        let met = |from: f64, to: f64| span(&grid, &[[[3.0, from], [3.0, to]]], 1.0, 19);
        let margin = 0.5 + 1.0 + 1e-12 * (1.0 + 19.0 + 1.0);
        let (low, high) = (19.0 - margin, 19.0 + margin);
        let columns = Some([2, 4]);
        for border in [19.0 + 1.5 + 20.5e-12, 19.0 - 1.5 - 20.5e-12, low, high] {
            assert_eq!(met(border, border), columns, "{border}");
        }
        for beside in [19.0 + 1.5 + 21.5e-12, 19.0 - 1.5 - 21.5e-12] {
            assert_eq!(met(beside, beside), None, "{beside}");
        }
        // One end on the border is enough.
        assert_eq!([met(low, 0.0), met(0.0, low), met(high, 39.0), met(39.0, high)], [columns; 4]);
        assert_eq!(met(0.0, 39.0), columns);
    }

    #[test]
    fn columns_far_from_the_origin_are_widened_by_rounding() {
        let far = 1e6;
        let grid = Grid { origin: [far, 0.0], step: [1.0; 2], half: [0.5; 2], count: [8; 2] };
        let met = |left: f64, right: f64| span(&grid, &[[[far + left, 0.0], [far + right, 0.0]]], 0.0, 0);
        // 1e-12 of both ends, 2e-6.
        assert_eq!(met(1.5 + 1.9e-6, 2.5 - 1.9e-6), Some([1, 3]));
        assert_eq!(met(1.5 + 2.1e-6, 2.5 - 2.1e-6), Some([2, 2]));
    }
}
