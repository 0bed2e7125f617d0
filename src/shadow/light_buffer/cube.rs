//! The cube of cells around a light at a point (row 1 of the notes on the 1986 paper).
//!
//! Face m, sign s looks along the axis m towards s; the other two axes follow cyclically. Cell (i, j) of
//! R x R is the closed set of directions with (2i - R) / R <= x' / z' <= (2i + 2 - R) / R, and so for y'.

use super::cells::{Located, certain_index, coordinate_error, exact_index, index_tolerance};
use crate::geometry::exact_number::ExactNumber;
use crate::geometry::footprint::Frame;
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::position::HomogeneousPoint;
use crate::geometry::{ExactPosition, Sign};
use glam::{DVec3, Vec3};
use std::ops::Neg;

/// A face of the cube: axis 0 to 2, and whether it looks along it or against it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Face {
    axis: usize,
    direction: Direction,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Direction {
    Along,
    Against,
}

impl Face {
    /// All six, in the order of their indices: +x, -x, +y, -y, +z, -z.
    pub const ALL: [Face; 6] = {
        const fn face(axis: usize, direction: Direction) -> Face {
            Face { axis, direction }
        }
        use Direction::{Against, Along};
        [face(0, Along), face(0, Against), face(1, Along), face(1, Against), face(2, Along), face(2, Against)]
    };

    /// 0 to 5.
    pub fn index(self) -> usize {
        2 * self.axis + usize::from(self.direction == Direction::Against)
    }

    /// What is along its axis, seen along the face.
    fn turned<T: Neg<Output = T>>(self, along: T) -> T {
        match self.direction {
            Direction::Along => along,
            Direction::Against => -along,
        }
    }

    /// The axes x', y' and z' of the face.
    pub fn frame(self) -> Frame {
        let unit = |axis: usize| DVec3::from_array([0, 1, 2].map(|i| f64::from(u8::from(i == axis % 3))));
        Frame::perspective(unit(self.axis + 1), unit(self.axis + 2), self.turned(unit(self.axis)))
    }

    /// x', y' and z' of a vector.
    pub fn coordinates(self, v: DVec3) -> [f64; 3] {
        [v[(self.axis + 1) % 3], v[(self.axis + 2) % 3], self.turned(v[self.axis])]
    }

    fn exact_coordinates(self, p: &HomogeneousPoint) -> [ExactNumber; 3] {
        let z = &p.xyz[self.axis];
        let z = if self.direction == Direction::Along { z.clone() } else { -z };
        [p.xyz[(self.axis + 1) % 3].clone(), p.xyz[(self.axis + 2) % 3].clone(), z]
    }

    /// The face that a vector's largest component looks through.
    fn of(v: DVec3) -> Face {
        let a = v.abs();
        let axis = if a.x >= a.y && a.x >= a.z {
            0
        } else if a.y >= a.z {
            1
        } else {
            2
        };
        Face { axis, direction: if v[axis] >= 0.0 { Direction::Along } else { Direction::Against } }
    }
}

/// The cell of a point. `exact` is called only if rounding leaves the cell open; the flag says whether it
/// was. A point in the light itself is in no cell.
pub fn locate<F: Fn() -> ExactPosition>(
    light: Vec3,
    position: DVec3,
    resolution: u32,
    query: &PreciseQuery<F>,
) -> Option<(Located, bool)> {
    let p = position - light.as_dvec3();
    let face = Face::of(p);
    let [x, y, z] = face.coordinates(p);
    let [ex, ey, ez] = face.coordinates(position).map(f64::abs);
    let error = coordinate_error(ex, x).max(coordinate_error(ey, y));
    let z_error = coordinate_error(ez, z);
    // The quotient is wrong by at most (error + |x' / z'| z_error) / z', and |x'| <= z'; taken twice over once more.
    let tolerance = index_tolerance(2.0 * (error + z_error) / z, resolution);
    let index = |value: f64| certain_index(value / z, tolerance, resolution);
    if let (Some(column), Some(row)) = (index(x), index(y)) {
        return Some((
            Located { side: face.index(), column, row, z_low: z - z_error, z_high: z + z_error },
            false,
        ));
    }
    locate_exactly(query.exact(), position, light, resolution).map(|located| (located, true))
}

/// The cell by exact signs of degree 4: R x' against (2k - R) z'.
fn locate_exactly(p: &HomogeneousPoint, position: DVec3, light: Vec3, resolution: u32) -> Option<Located> {
    let larger = |a: usize, b: usize| {
        if (&p.xyz[a].magnitude() - &p.xyz[b].magnitude()).sign() == Sign::Negative { b } else { a }
    };
    let axis = larger(larger(0, 1), 2);
    let direction = match p.xyz[axis].sign() {
        Sign::Zero => return None,
        Sign::Positive => Direction::Along,
        Sign::Negative => Direction::Against,
    };
    let face = Face { axis, direction };
    let [x, y, z] = face.exact_coordinates(p);
    let (column, row) = (exact_index(&x, &z, resolution), exact_index(&y, &z, resolution));
    let relative = face.coordinates(position - light.as_dvec3())[2];
    let error = coordinate_error(face.coordinates(position)[2], relative);
    Some(Located { side: face.index(), column, row, z_low: relative - error, z_high: relative + error })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(direction: [f32; 3], resolution: u32) -> (usize, u32, u32) {
        let p = Vec3::from(direction);
        let query = PreciseQuery::new(&Vec3::ZERO.into(), p.as_dvec3(), || ExactPosition::Bare(p));
        let (located, _) = locate(Vec3::ZERO, p.as_dvec3(), resolution, &query).unwrap();
        (located.side, located.column, located.row)
    }

    #[test]
    fn the_example_of_the_paper_looks_through_the_minus_y_face() {
        assert_eq!(cell([3.11, -5.04, -1.66], 10).0, 3);
    }

    #[test]
    fn directions_one_ulp_beside_a_border_land_on_their_side() {
        let border = 2.0f32 / 512.0;
        assert_eq!(cell([1.0, border.next_down(), 0.5], 512).1, 256);
        assert_eq!(cell([1.0, border, 0.5], 512).1, 257);
        assert_eq!(cell([1.0, border.next_up(), 0.5], 512).1, 257);
        for k in [0, 1, 255, 256, 511] {
            let (_, column, row) = cell([1.0, (2 * k - 512) as f32 / 512.0, 0.0], 512);
            assert_eq!((column, row), (k as u32, 256));
        }
    }

    #[test]
    fn seams_and_corners_have_a_cell() {
        for direction in [[1.0, 1.0, 0.0], [-1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [0.0, 1.0, -1.0]] {
            for resolution in [1, 3, 4096] {
                let (_, column, row) = cell(direction, resolution);
                assert!(column < resolution && row < resolution);
            }
        }
    }

    #[test]
    fn a_point_in_the_light_has_no_cell() {
        let query = PreciseQuery::new(&Vec3::ONE.into(), DVec3::ONE, || ExactPosition::Bare(Vec3::ONE));
        assert_eq!(locate(Vec3::ONE, DVec3::ONE, 8, &query), None);
    }

    /// Where a point is seen from a light, and whether that took exact arithmetic.
    fn located(light: Vec3, p: DVec3, resolution: u32) -> (Located, bool) {
        let query = PreciseQuery::new(&light.into(), p, || ExactPosition::Bare(p.as_vec3()));
        locate(light, p, resolution, &query).expect("beside the light")
    }

    #[test]
    fn directions_inside_of_cells_need_no_exact_arithmetic() {
        for axis in 0..3 {
            for sizes in [[1.0, 0.4, 0.3], [1.0, 0.3, 0.4], [1.0, 0.9, 0.3], [1.0, 0.3, 0.9]] {
                for signs in 0..8 {
                    let sign = |i: usize| if signs >> i & 1 == 1 { -1.0 } else { 1.0 };
                    let mut p = [0, 1, 2].map(|i| sign(i) * sizes[i]);
                    let side = 2 * axis + usize::from(p[0] < 0.0);
                    p.rotate_right(axis);
                    let (at, exactly) = located(Vec3::ZERO, DVec3::from_array(p), 4);
                    assert_eq!((at.side, exactly), (side, false), "{p:?}");
                }
            }
        }
    }

    #[test]
    fn a_border_is_as_wide_as_its_uncertainty() {
        // From the origin coordinates are wrong by 2 of their own, so that x' = 2 and z' = 4 are by 4 and 8 in units of
        // 2^-52. That is 2 (4 + 8) / 4 + 8 = 14 for the quotient, of cells that are half as wide: 28.
        let exactly = |parts: f64| {
            let x = 2.0 + 4.0 * parts * f64::EPSILON;
            let (at, exactly) = located(Vec3::ZERO, DVec3::new(4.0, 1.3, x), 4096);
            assert_eq!(at.side, 0);
            exactly
        };
        assert_eq!([-29.0, -27.0, 28.0, 29.0].map(exactly), [false, true, true, false]);
    }

    #[test]
    fn a_depth_is_between_its_bounds() {
        let light = Vec3::new(1.0, 2.0, 3.0);
        for (p, exactly) in [(DVec3::new(5.0, 2.3, 3.7), false), (DVec3::new(5.0, 2.0, 3.0), true)] {
            let (at, by_signs) = located(light, p, 4);
            // The position is 5 and 4 away from the light.
            let error = 9.0 * f64::EPSILON;
            assert_eq!((by_signs, at.z_low, at.z_high), (exactly, 4.0 - error, 4.0 + error));
        }
    }
}
