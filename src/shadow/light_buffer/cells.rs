//! The cells around a light, and the proven look-up of the cell that a point lies in.
//!
//! A light at a point has a cube of six sides (row 1 of the notes), one infinitely far away a single side
//! across its rays. Cells are closed: a point on a border belongs to every cell that it touches, and any of
//! them may be looked up, since triangles are entered into every closed cell that they meet (rows 1 and 13).

use super::cube::{self, Face};
use super::cube_coherence::{SideBits, touched_sides};
use super::sheet::Sheet;
use crate::geometry::exact_number::ExactNumber;
use crate::geometry::footprint::{Frame, Grid};
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::{ExactPosition, LightPosition, LightSpace, Sign};
use glam::{DVec3, Vec3};

/// How space is divided.
#[derive(Debug, Clone, Copy)]
pub enum Cells {
    /// By direction from the light.
    Cube,
    /// By place across parallel rays.
    Sheet(Sheet),
}

/// A cell, and an interval that holds the exact z' of the point that was looked up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located {
    /// Side of the cube, or 0.
    pub side: usize,
    /// Column along x'.
    pub column: u32,
    /// Row along y'.
    pub row: u32,
    /// At most the exact z'.
    pub z_low: f64,
    /// At least the exact z'.
    pub z_high: f64,
}

impl Cells {
    /// The cells of a light, around all that is cast: every corner of every caster, or of a box around it.
    pub fn new(space: &LightSpace, corners: impl Iterator<Item = Vec3>) -> Cells {
        match space.light() {
            LightPosition::At(_) => Cells::Cube,
            LightPosition::Towards(direction) => Cells::Sheet(Sheet::new(space.origin(), direction, corners)),
        }
    }

    /// Six, or one.
    pub fn sides(&self) -> usize {
        match self {
            Cells::Cube => Face::ALL.len(),
            Cells::Sheet(_) => 1,
        }
    }

    /// The sides that a triangle may project on, a bit each: a superset.
    pub(super) fn touched_sides(&self, space: &LightSpace, corners: [DVec3; 3]) -> SideBits {
        match self {
            Cells::Cube => touched_sides(corners.map(|p| p - space.origin().as_dvec3())),
            Cells::Sheet(_) => 1,
        }
    }

    /// The axes x', y' and z' of a side.
    pub fn frame(&self, side: usize) -> Frame {
        match self {
            Cells::Cube => Face::ALL[side].frame(),
            Cells::Sheet(sheet) => sheet.frame(),
        }
    }

    /// The cell of a point, and whether exact arithmetic was needed to find it. `None` for a point in the
    /// light itself or beside all casters of a light infinitely far away: nothing blocks these.
    pub fn locate<F: Fn() -> ExactPosition>(
        &self,
        space: &LightSpace,
        position: DVec3,
        resolution: u32,
        query: &PreciseQuery<F>,
    ) -> Option<(Located, bool)> {
        match self {
            Cells::Cube => cube::locate(space.origin(), position, resolution, query),
            Cells::Sheet(sheet) => sheet.locate(position, resolution, query),
        }
    }
}

/// The cells of one side as a grid of closed boxes over [-1, 1] x [-1, 1], a little widened.
pub fn side_grid(resolution: u32) -> Grid {
    let cell = 2.0 / f64::from(resolution);
    Grid {
        origin: [-1.0 + 0.5 * cell; 2],
        step: [cell; 2],
        half: [0.5 * cell * (1.0 + 1e-12) + 1e-14; 2],
        count: [resolution; 2],
    }
}

/// Error of one coordinate relative to the origin: half an ulp of the point and of the difference.
pub(super) fn coordinate_error(position: f64, relative: f64) -> f64 {
    (position.abs() + relative.abs()) * f64::EPSILON
}

/// How many cells a number in [-1, 1] may be off that is a quotient, wrong by `error` and by a rounding.
///
/// Cells are 2 / R wide, so that the error counts half as many cells as R times itself and is taken twice over; the
/// division, adding 1 and the scaling lose 4 roundoffs of at most 2, and this is 16.
pub(super) fn index_tolerance(error: f64, resolution: u32) -> f64 {
    f64::from(resolution) * (error + 8.0 * f64::EPSILON)
}

/// The cell of a number in [-1, 1] that is known within `tolerance` cells, if that leaves no doubt.
pub(super) fn certain_index(value: f64, tolerance: f64, resolution: u32) -> Option<u32> {
    let cells = f64::from(resolution);
    let cell = (value + 1.0) * 0.5 * cells;
    let whole = cell.floor();
    let fraction = cell - whole;
    let inside = whole >= 0.0 && whole < cells && fraction > tolerance && 1.0 - fraction > tolerance;
    inside.then_some(whole as u32)
}

/// The largest k < R with R x >= (2k - R) z, for |x| <= z, by bisection with exact signs.
pub(super) fn exact_index(x: &ExactNumber, z: &ExactNumber, resolution: u32) -> u32 {
    let scaled = x * &ExactNumber::from(resolution as f32);
    let at_or_above = |k: u32| {
        let border = (2 * i64::from(k) - i64::from(resolution)) as f32;
        (&scaled - &(z * &ExactNumber::from(border))).sign() != Sign::Negative
    };
    let (mut low, mut high) = (0, resolution);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if at_or_above(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_certain_where_its_borders_are_farther_than_the_tolerance() {
        // A middle, and three quarters of a cell from its left border, in the third of four.
        assert_eq!(
            [0.0, 0.49, 0.51].map(|tolerance| certain_index(0.25, tolerance, 4)),
            [Some(2), Some(2), None]
        );
        assert_eq!([0.24, 0.26].map(|tolerance| certain_index(0.375, tolerance, 4)), [Some(2), None]);
        assert_eq!([0.24, 0.26].map(|tolerance| certain_index(0.125, tolerance, 4)), [Some(2), None]);
        assert_eq!([0.25, 0.75].map(|fraction| certain_index(0.5 * fraction, 0.25, 4)), [None; 2]);
        // On a border, even if that is all that is known, and beside all cells.
        assert_eq!([-1.0, 0.0, 1.0, -1.125, 1.125].map(|value| certain_index(value, 0.0, 4)), [None; 5]);
        assert_eq!([-0.99, 0.99].map(|value| certain_index(value, 0.0, 4)), [Some(0), Some(3)]);
    }

    #[test]
    fn a_coordinate_is_wrong_by_half_an_ulp_of_the_point_and_of_the_difference() {
        assert_eq!(coordinate_error(3.0, -5.0), 8.0 * f64::EPSILON);
        assert_eq!(coordinate_error(-3.0, 0.0), 3.0 * f64::EPSILON);
    }

    #[test]
    fn the_boxes_of_a_side_tile_it_and_are_a_little_wider() {
        let grid = side_grid(4);
        assert_eq!((grid.origin, grid.step, grid.count), ([-0.75; 2], [0.5; 2], [4; 2]));
        assert!(grid.half.iter().all(|&half| half > 0.25 && half < 0.25 + 1e-12));
        // The smallest ones too, by more than the rounding of their centres.
        let smallest = side_grid(4096).half[0] - 1.0 / 4096.0;
        assert!(smallest > 0.9e-14 && smallest < 1.1e-14, "{smallest:e}");
    }

    #[test]
    fn an_index_is_as_uncertain_as_is_derived() {
        assert_eq!(index_tolerance(3.0 * f64::EPSILON, 4), 44.0 * f64::EPSILON);
    }
}
