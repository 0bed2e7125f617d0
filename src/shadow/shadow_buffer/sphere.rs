//! Rows and columns of cells on the sphere of directions around a light.
//!
//! With unit vectors x, y, z of the world, a direction d has the polar angle theta = pi/2 + latitude, from 0 at
//! -z to pi at +z, and the azimuth phi in [0, 2 pi) from x towards y. Equations 4 and 7 of the 2004 paper cannot
//! be taken as they stand. In 4 theta runs from 0 to pi and its direction uses it as a latitude, so that half of
//! the sphere is missed and the other half is covered twice. In 7 arcsin gives negative rows, arccos folds the
//! azimuth to [0, pi] and is 0/0 at the poles, and nothing keeps an index below its maximum. What holds here:
//!
//! ```text
//! theta = atan2(sqrt(dx^2 + dy^2), -dz)      row    = floor(theta / pi * rows)
//! phi   = atan2(dy, dx), + 2 pi if below 0   column = floor(phi / (2 pi) * columns)
//! d     = (sin theta cos phi, sin theta sin phi, -cos theta) at theta = (row + 1/2) / rows * pi,
//!                                                            phi = (column + 1/2) / columns * 2 pi
//! ```
//!
//! Cells are half-open: on a border the next row or column has the direction, and no index reaches its maximum.
//! The poles have the azimuth 0 by rule. All functions are those of `libm`, which are the same on every platform.

use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// The most rows or columns: beyond this the centre of a cell, rounded to f32, may lie in another one.
pub const MOST_CELLS: u32 = 1 << 16;

/// How the sphere of directions is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sphere {
    rows: u32,
    columns: u32,
}

/// A cell of a [`Sphere`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cell {
    /// By polar angle, from 0 at -z.
    pub row: u32,
    /// By azimuth, from 0 at +x.
    pub column: u32,
}

impl Sphere {
    /// So many rows and columns; `None` unless both are from 1 to [`MOST_CELLS`].
    pub fn new(rows: u32, columns: u32) -> Option<Sphere> {
        let is_allowed = |cells: u32| (1..=MOST_CELLS).contains(&cells);
        (is_allowed(rows) && is_allowed(columns)).then_some(Sphere { rows, columns })
    }

    /// Cells from pole to pole.
    pub fn rows(&self) -> u32 {
        self.rows
    }

    /// Cells around the axis.
    pub fn columns(&self) -> u32 {
        self.columns
    }

    /// Number of cells.
    pub fn cells(&self) -> u64 {
        u64::from(self.rows) * u64::from(self.columns)
    }

    /// The longer side of a cell in radians, where cells are widest.
    pub fn cell_width(&self) -> f64 {
        (PI / f64::from(self.rows)).max(TAU / f64::from(self.columns))
    }

    /// The cell of a direction of any length; that of no direction is some cell, too.
    pub fn cell(&self, direction: DVec3) -> Cell {
        // Adding zero makes both zeros one.
        let DVec3 { x, y, z } = direction + DVec3::ZERO;
        let theta = libm::atan2(libm::hypot(x, y), -z);
        let azimuth = if x == 0.0 && y == 0.0 { 0.0 } else { libm::atan2(y, x) };
        // A number just below 0 may become all of the turn.
        let phi = if azimuth < 0.0 { azimuth + TAU } else { azimuth };
        Cell { row: index(theta / PI, self.rows), column: index(phi / TAU, self.columns) }
    }

    /// The polar angle of the centres of a row.
    pub(super) fn theta(&self, row: u32) -> f64 {
        (f64::from(row) + 0.5) / f64::from(self.rows) * PI
    }

    /// The ray through the centre of a cell: of unit length but for the rounding to f32, and exact as it stands.
    pub fn centre(&self, cell: Cell) -> Vec3 {
        let phi = (f64::from(cell.column) + 0.5) / f64::from(self.columns) * TAU;
        self.row_centres(cell.row).at(libm::cos(phi), libm::sin(phi))
    }

    /// The circle of the centres of one row.
    pub(super) fn row_centres(&self, row: u32) -> Circle {
        let theta = self.theta(row);
        Circle { radius: libm::sin(theta), z: -libm::cos(theta) }
    }

    /// Cosine and sine of the azimuth of each column's centre.
    pub(super) fn azimuths(&self) -> Vec<(f64, f64)> {
        let phi = |column: u32| (f64::from(column) + 0.5) / f64::from(self.columns) * TAU;
        (0..self.columns).map(|column| (libm::cos(phi(column)), libm::sin(phi(column)))).collect()
    }

    /// The cell so many rows and columns away: columns go round, and beyond a pole rows go down on its other side.
    pub fn neighbour(&self, cell: Cell, rows: i64, columns: i64) -> Cell {
        let (height, width) = (i64::from(self.rows), i64::from(self.columns));
        // Once over both poles is twice the rows.
        let row = (i64::from(cell.row) + rows).rem_euclid(2 * height);
        let (row, turn) = if row < height { (row, 0) } else { (2 * height - 1 - row, width / 2) };
        let column = (i64::from(cell.column) + columns + turn).rem_euclid(width);
        Cell { row: row as u32, column: column as u32 }
    }

    /// Place of a cell in an array of rows.
    pub fn index(&self, cell: Cell) -> usize {
        cell.row as usize * self.columns as usize + cell.column as usize
    }
}

/// The circle of directions at one polar angle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circle {
    pub radius: f64,
    pub z: f64,
}

impl Circle {
    /// The direction at an azimuth, rounded to f32.
    pub fn at(&self, cosine: f64, sine: f64) -> Vec3 {
        DVec3::new(self.radius * cosine, self.radius * sine, self.z).as_vec3()
    }
}

/// The half-open interval that a share of the whole, from 0 to 1, falls into.
fn index(share: f64, count: u32) -> u32 {
    ((share * f64::from(count)) as u32).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sphere(rows: u32, columns: u32) -> Sphere {
        Sphere::new(rows, columns).unwrap()
    }

    fn cell(row: u32, column: u32) -> Cell {
        Cell { row, column }
    }

    #[test]
    fn sizes_are_bounded() {
        assert!(Sphere::new(0, 1).is_none() && Sphere::new(1, 0).is_none());
        assert!(Sphere::new(MOST_CELLS + 1, 1).is_none() && Sphere::new(1, u32::MAX).is_none());
        assert_eq!(sphere(MOST_CELLS, MOST_CELLS).cells(), 1 << 32);
    }

    #[test]
    fn poles_have_the_first_azimuth() {
        let s = sphere(8, 16);
        for zero in [0.0, -0.0] {
            for other in [0.0, -0.0] {
                for size in [1.0, f64::MAX, f64::MIN_POSITIVE, 5e-324] {
                    assert_eq!(s.cell(DVec3::new(zero, other, -size)), cell(0, 0));
                    assert_eq!(s.cell(DVec3::new(zero, other, size)), cell(7, 0));
                }
            }
        }
        // No direction at all is no panic.
        assert!(s.cell(DVec3::ZERO).row < 8 && s.cell(DVec3::NAN).row < 8);
    }

    #[test]
    fn both_sides_of_the_seam_and_of_its_opposite_are_told_apart() {
        let s = sphere(2, 8);
        for tiny in [1e-6, 1e-300, 5e-324] {
            assert_eq!(s.cell(DVec3::new(1.0, -tiny, 0.0)).column, 7, "{tiny}");
            assert_eq!(s.cell(DVec3::new(1.0, tiny, 0.0)).column, 0, "{tiny}");
        }
        assert_eq!(s.cell(DVec3::new(-1.0, 1e-6, 0.0)).column, 3);
        assert_eq!(s.cell(DVec3::new(-1.0, -1e-6, 0.0)).column, 4);
        // Azimuth pi is where columns 3 and 4 meet, and atan2 has its cut there.
        for zero in [0.0, -0.0] {
            assert_eq!(s.cell(DVec3::new(-1.0, zero, 0.0)).column, 4);
            assert_eq!(s.cell(DVec3::new(1.0, zero, 0.0)).column, 0);
        }
    }

    #[test]
    fn borders_belong_to_the_cell_behind_them() {
        let s = sphere(4, 8);
        // Polar angles of 1/4, 1/2 and 3/4 of pi, azimuths of 0, 1/4, 1/2 and 3/4 of a turn.
        assert_eq!(s.cell(DVec3::new(1.0, 0.0, -1.0)), cell(1, 0));
        assert_eq!(s.cell(DVec3::new(0.0, 1.0, 0.0)), cell(2, 2));
        assert_eq!(s.cell(DVec3::new(0.0, 1.0, -0.0)), cell(2, 2));
        assert_eq!(s.cell(DVec3::new(-1.0, 0.0, 1.0)), cell(3, 4));
        assert_eq!(s.cell(DVec3::new(0.0, -1.0, 1.0)), cell(3, 6));
        assert_eq!(s.cell(DVec3::new(1.0, 1.0, 0.0)), cell(2, 1));
    }

    #[test]
    fn the_length_of_a_direction_means_nothing() {
        let s = sphere(400, 800);
        let direction = DVec3::new(0.3, -0.4, 0.5);
        for scale in [1e-300, 1e-30, 1.0, 1e30, 1e300] {
            assert_eq!(s.cell(direction * scale), s.cell(direction), "{scale}");
        }
    }

    #[test]
    fn centres_are_in_their_cells() {
        for (rows, columns) in [(1, 1), (1, 2), (2, 1), (3, 5), (7, 13), (100, 200), (401, 799), (2000, 11)] {
            let s = sphere(rows, columns);
            let azimuths = s.azimuths();
            for row in 0..rows {
                for column in 0..columns {
                    let centre = s.centre(cell(row, column));
                    assert_eq!(s.cell(centre.as_dvec3()), cell(row, column), "{rows} x {columns}");
                    let (cosine, sine) = azimuths[column as usize];
                    assert_eq!(s.row_centres(row).at(cosine, sine), centre);
                }
            }
        }
        let finest = sphere(MOST_CELLS, MOST_CELLS);
        for row in [0, 1, 2, 1000, MOST_CELLS / 2 - 1, MOST_CELLS / 2, MOST_CELLS - 2, MOST_CELLS - 1] {
            for column in (0..MOST_CELLS).step_by(37).chain([MOST_CELLS - 1]) {
                assert_eq!(finest.cell(finest.centre(cell(row, column)).as_dvec3()), cell(row, column));
            }
        }
    }

    #[test]
    fn neighbours_go_round_the_axis_and_over_the_poles() {
        let s = sphere(4, 6);
        assert_eq!(s.neighbour(cell(1, 0), 0, -1), cell(1, 5));
        assert_eq!(s.neighbour(cell(1, 5), 1, 1), cell(2, 0));
        assert_eq!(s.neighbour(cell(0, 1), -1, 0), cell(0, 4));
        assert_eq!(s.neighbour(cell(3, 5), 2, 0), cell(2, 2));
        assert_eq!(s.neighbour(cell(0, 1), -1, 1), cell(0, 5));
        // All the way round, once and often.
        assert_eq!(s.neighbour(cell(2, 3), 8, 6), cell(2, 3));
        assert_eq!(s.neighbour(cell(2, 3), -80, -60), cell(2, 3));
        assert_eq!(sphere(1, 1).neighbour(cell(0, 0), -7, 9), cell(0, 0));
        // Beside each other on the sphere, too.
        for (one, other) in
            [(cell(0, 1), s.neighbour(cell(0, 1), -1, 0)), (cell(2, 5), s.neighbour(cell(2, 5), 0, 1))]
        {
            assert!(s.centre(one).dot(s.centre(other)) > 0.4, "{one:?} {other:?}");
        }
    }

    proptest! {
        #[test]
        fn every_direction_has_a_cell(
            x in any::<f64>(), y in any::<f64>(), z in any::<f64>(),
            rows in 1u32..5000, columns in 1u32..5000,
        ) {
            let s = sphere(rows, columns);
            let cell = s.cell(DVec3::new(x, y, z));
            prop_assert!(cell.row < rows && cell.column < columns);
            prop_assert!((s.index(cell) as u64) < s.cells());
        }

        #[test]
        fn no_direction_is_far_from_the_centre_of_its_cell(
            direction in prop::array::uniform3(-1.0f64..1.0),
        ) {
            let direction = DVec3::from(direction);
            prop_assume!(direction.length() > 1e-3);
            let s = sphere(60, 120);
            let centre = s.centre(s.cell(direction)).as_dvec3();
            prop_assert!(centre.angle_between(direction) < s.cell_width());
        }
    }
}
