//! The cells of a light infinitely far away: a grid across its rays (TRUTH: its position is (d, 0) in
//! homogeneous coordinates).
//!
//! With the light in the direction L, whose largest component is that of axis k, points are moved along L
//! onto the plane where coordinate k is that of the origin: x' = x - (L_x / L_k) k and y' likewise, for the
//! two other axes in cyclic order. Depth is coordinate k itself, turned so that it grows away from the light.
//! The sheet [-E, E] x [-E, E], with an E for each axis, holds everything that is cast; cell (i, j) of R x R
//! is the closed set with (2i - R) / R <= x' / E <= (2i + 2 - R) / R, and so for y'.

use super::cells::{Located, certain_index, coordinate_error, exact_index, index_tolerance};
use crate::geometry::exact_number::ExactNumber;
use crate::geometry::footprint::Frame;
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::position::HomogeneousPoint;
use crate::geometry::{ExactPosition, Sign};
use glam::{DVec3, Vec3};
use std::ops::Neg;

/// The grid of one light.
#[derive(Debug, Clone, Copy)]
pub struct Sheet {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// The axes of x', y' and depth.
    pub(super) axes: [usize; 3],
    /// An eighth of E for x' and y': E itself may be beyond the largest f32.
    eighth: [f32; 2],
}

impl Sheet {
    /// Encloses every corner of every caster; coordinates are relative to the origin.
    pub fn new(origin: Vec3, direction: Vec3, corners: impl Iterator<Item = Vec3>) -> Sheet {
        let depth = direction.abs().max_position();
        let axes = [(depth + 1) % 3, (depth + 2) % 3, depth];
        let sheet = Sheet { origin, direction, axes, eighth: [0.0; 2] };
        let far = corners.fold([0.0f64; 2], |far, corner| {
            let p = corner.as_dvec3() - origin.as_dvec3();
            [0, 1].map(|i| far[i].max(sheet.across(i, p).abs() + sheet.across_error(i, corner.as_dvec3(), p)))
        });
        // Widened by far more than rounding, so that nothing that is cast reaches the outermost border.
        let eighth = far.map(|far| ((far * 0.125 * 1.000_01) as f32).max(f32::MIN_POSITIVE));
        Sheet { eighth, ..sheet }
    }

    /// L_i / L_k.
    fn slope(&self, i: usize) -> f64 {
        f64::from(self.direction[self.axes[i]]) / f64::from(self.direction[self.axes[2]])
    }

    /// x' or y' of a vector relative to the origin.
    fn across(&self, i: usize, p: DVec3) -> f64 {
        p[self.axes[i]] - p[self.axes[2]] * self.slope(i)
    }

    /// How far that may be off for a rounded position.
    fn across_error(&self, i: usize, position: DVec3, p: DVec3) -> f64 {
        let (own, along) = (self.axes[i], self.axes[2]);
        let slope = self.slope(i).abs();
        // The slope loses 1 roundoff, the product 1 and the difference 1; this is 8.
        let rounding = 4.0 * f64::EPSILON * (p[own].abs() + p[along].abs() * slope);
        coordinate_error(position[own], p[own])
            + coordinate_error(position[along], p[along]) * slope
            + rounding
    }

    /// What is along the axis of depth, so that it grows away from the light.
    fn turned<T: Neg<Output = T>>(&self, along: T) -> T {
        if self.direction[self.axes[2]] > 0.0 { -along } else { along }
    }

    /// E of x' or y'.
    pub(super) fn extent(&self, i: usize) -> f64 {
        8.0 * f64::from(self.eighth[i])
    }

    /// The axes x', y' and z' in units of the sheet, and their inverse.
    pub fn frame(&self) -> Frame {
        let unit = |axis: usize| {
            DVec3::from_array(std::array::from_fn(|i| f64::from(u8::from(i == self.axes[axis]))))
        };
        let direction = self.direction.as_dvec3();
        let z = -direction / direction[self.axes[2]].abs();
        let across = [0, 1].map(|i| (unit(i) - unit(2) * self.slope(i)) / self.extent(i));
        Frame::parallel(
            [unit(0) * self.extent(0), unit(1) * self.extent(1), z],
            [across[0], across[1], self.turned(unit(2))],
        )
    }

    /// The cell of a point; `None` if it is certainly beside the sheet, where nothing is cast.
    pub fn locate<F: Fn() -> ExactPosition>(
        &self,
        position: DVec3,
        resolution: u32,
        query: &PreciseQuery<F>,
    ) -> Option<(Located, bool)> {
        let p = position - self.origin.as_dvec3();
        let depth = self.turned(p[self.axes[2]]);
        let depth_error = coordinate_error(position[self.axes[2]], depth);
        let located = |[column, row]: [u32; 2]| Located {
            side: 0,
            column,
            row,
            z_low: depth - depth_error,
            z_high: depth + depth_error,
        };
        let mut cells = [None; 2];
        for (i, cell) in cells.iter_mut().enumerate() {
            let (value, error, extent) =
                (self.across(i, p), self.across_error(i, position, p), self.extent(i));
            if is_beside(value, error, extent) {
                return None;
            }
            *cell = certain_index(value / extent, index_tolerance(error / extent, resolution), resolution);
        }
        match cells {
            [Some(column), Some(row)] => Some((located([column, row]), false)),
            _ => Some((located(self.exact_cell(query.exact(), resolution)?), true)),
        }
    }

    /// The cell by exact signs of degree 5.
    fn exact_cell(&self, p: &HomogeneousPoint, resolution: u32) -> Option<[u32; 2]> {
        let along = ExactNumber::from(self.direction[self.axes[2]]);
        let steepness = along.magnitude();
        let index = |i: usize| {
            let slope = ExactNumber::from(self.direction[self.axes[i]]);
            // L_k x' and |L_k| E, in units of the denominator w.
            let turned = &(&along * &p.xyz[self.axes[i]]) - &(&slope * &p.xyz[self.axes[2]]);
            let x = if along.sign() == Sign::Negative { -&turned } else { turned };
            let extent = &ExactNumber::from(8.0f32) * &ExactNumber::from(self.eighth[i]);
            let reach = &(&extent * &steepness) * &p.w;
            let is_inside = (&reach - &x.magnitude()).sign() != Sign::Negative;
            is_inside.then(|| exact_index(&x, &reach, resolution))
        };
        Some([index(0)?, index(1)?])
    }
}

/// Whether a number that is known within an error is certainly beside the sheet.
fn is_beside(value: f64, error: f64, extent: f64) -> bool {
    value.abs() > extent * (1.0 + 1e-12) + 2.0 * error
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{LightPosition, LightSpace};

    /// A sheet over [-8, 8] in x and y, a little wider, for a light straight above.
    fn sheet() -> Sheet {
        Sheet::new(Vec3::ZERO, Vec3::new(0.0, 0.0, 2.0), [Vec3::splat(8.0), Vec3::splat(-8.0)].into_iter())
    }

    fn cell(sheet: &Sheet, p: Vec3, resolution: u32) -> Option<[u32; 2]> {
        let bounds = (Vec3::splat(-8.0), Vec3::splat(8.0));
        let space = LightSpace::new(LightPosition::Towards(sheet.direction), bounds);
        let query = PreciseQuery::new(&space, p.as_dvec3(), || ExactPosition::Bare(p));
        let (at, exactly) = sheet.locate(p.as_dvec3(), resolution, &query)?;
        let by_signs = sheet.exact_cell(query.exact(), resolution).unwrap();
        assert!(exactly || by_signs == [at.column, at.row]);
        assert!(at.z_low <= f64::from(-p.z) && f64::from(-p.z) <= at.z_high);
        Some([at.column, at.row])
    }

    #[test]
    fn cells_count_along_the_axes_and_depth_grows_away_from_the_light() {
        let sheet = sheet();
        assert_eq!(cell(&sheet, Vec3::new(-7.9, 7.9, 3.0), 4), Some([0, 3]));
        assert_eq!(cell(&sheet, Vec3::new(0.1, -0.1, -100.0), 4), Some([2, 1]));
        assert_eq!(cell(&sheet, Vec3::new(8.1, 0.0, 0.0), 4), None);
    }

    #[test]
    fn points_are_moved_along_the_rays() {
        let sheet = Sheet::new(
            Vec3::ZERO,
            Vec3::new(1.0, 0.0, 2.0),
            [Vec3::splat(8.0), Vec3::splat(-8.0)].into_iter(),
        );
        let low = Vec3::new(1.0, 1.0, -6.0);
        assert_eq!(cell(&sheet, low, 1000), cell(&sheet, low + 5.0 * Vec3::new(1.0, 0.0, 2.0), 1000));
    }

    #[test]
    fn borders_are_found_exactly() {
        // E is a float: the middle border is at 0, and one ulp decides.
        let sheet = sheet();
        let tiny = f32::from_bits(1);
        assert_eq!(cell(&sheet, Vec3::new(0.0, 1.0, 0.0), 2), Some([1, 1]));
        assert_eq!(cell(&sheet, Vec3::new(-tiny, 1.0, 0.0), 2), Some([0, 1]));
        assert_eq!(cell(&sheet, Vec3::new(tiny, -tiny, 0.0), 2), Some([1, 0]));
    }

    #[test]
    fn places_across_the_rays_are_as_uncertain_as_is_derived() {
        let sheet = Sheet::new(Vec3::ZERO, Vec3::new(1.0, 0.0, 2.0), std::iter::once(Vec3::ONE));
        assert_eq!((sheet.axes, sheet.slope(0), sheet.slope(1)), ([0, 1, 2], 0.5, 0.0));
        let (position, p) = (DVec3::new(3.0, -4.0, 5.0), DVec3::new(2.0, 6.0, -7.0));
        // Of x', of depth times the slope, and four of both.
        let expected = (3.0 + 2.0) + 0.5 * (5.0 + 7.0) + 4.0 * (2.0 + 0.5 * 7.0);
        assert_eq!(sheet.across_error(0, position, p), expected * f64::EPSILON);
        assert_eq!(sheet.across_error(1, position, p), (10.0 + 4.0 * 6.0) * f64::EPSILON);
    }

    #[test]
    fn what_is_beside_the_sheet_is_so_by_more_than_its_error() {
        let border = 8.0 * (1.0 + 1e-12) + 2.0 * 0.25;
        for side in [1.0, -1.0] {
            assert!(!is_beside(side * border, 0.25, 8.0) && is_beside(side * border.next_up(), 0.25, 8.0));
        }
    }

    #[test]
    fn places_inside_of_cells_and_far_from_all_of_them_need_no_exact_arithmetic() {
        for direction in [Vec3::new(1.0, 0.0, 2.0), Vec3::new(-3.0, 1.0, 1.0), Vec3::new(0.5, -4.0, 1.0)] {
            let sheet = Sheet::new(Vec3::ZERO, direction, [Vec3::splat(8.0), Vec3::splat(-8.0)].into_iter());
            let space =
                LightSpace::new(LightPosition::Towards(direction), (Vec3::splat(-8.0), Vec3::splat(8.0)));
            let located = |p: DVec3| {
                let query = PreciseQuery::new(&space, p, || -> ExactPosition { panic!("not needed") });
                sheet.locate(p, 5, &query)
            };
            let (at, exactly) = located(DVec3::new(0.125, 0.25, -0.375)).expect("in the middle");
            assert_eq!((at.column, at.row, exactly), (2, 2, false));
            let depth = -f64::from(direction.abs().max_element());
            let along = direction.as_dvec3() / depth;
            // Depth grows along the rays by one for every one along their axis.
            let (further, _) = located(DVec3::new(0.125, 0.25, -0.375) + along).expect("in the middle");
            assert!((further.z_low - at.z_low - 1.0).abs() < 1e-12 && at.z_low < at.z_high);
            assert!(located(along.any_orthogonal_vector() * 1e3).is_none());
        }
    }

    #[test]
    fn exact_signs_tell_what_is_beside_the_sheet() {
        let sheet = sheet();
        let space =
            LightSpace::new(LightPosition::Towards(sheet.direction), (Vec3::splat(-8.0), Vec3::splat(8.0)));
        let cell = |p: Vec3| {
            let query = PreciseQuery::new(&space, p.as_dvec3(), || ExactPosition::Bare(p));
            sheet.exact_cell(query.exact(), 4)
        };
        assert_eq!(cell(Vec3::new(8.0, -8.0, 1.0)), Some([3, 0]));
        assert_eq!([Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y].map(|side| cell(side * 8.1)), [None; 4]);
    }

    #[test]
    fn a_border_is_as_wide_as_its_uncertainty_in_units_of_the_sheet() {
        let direction = Vec3::new(1.0, 0.0, 2.0);
        let sheet = Sheet::new(Vec3::ZERO, direction, [Vec3::splat(8.0), Vec3::splat(-8.0)].into_iter());
        let space = LightSpace::new(LightPosition::Towards(direction), (Vec3::splat(-8.0), Vec3::splat(8.0)));
        // At (4, 1, 8) x' is 0, wrong by 8 + 8 + 32 in units of 2^-52. E is 4: in cells of half of it that is 12, and 8
        // for rounding, so that the border is as wide as 160 of them.
        let exactly = |parts: f64| {
            let p = DVec3::new(4.0, 1.0, 8.0 - 2.0 * parts * f64::EPSILON);
            let query = PreciseQuery::new(&space, p, || ExactPosition::Bare(p.as_vec3()));
            sheet.locate(p, 4, &query).expect("in the middle").1
        };
        assert_eq!([-170.0, -150.0, 150.0, 170.0].map(exactly), [false, true, true, false]);
    }
}
