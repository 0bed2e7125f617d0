//! Where points lie among the cells around a light, in f32 with bounds.
//!
//! A side of the cube has the axes x', y', z' of [`Face`](crate::shadow::light_buffer::cube::Face), with |x'|, |y'| <= z'
//! on it. In units of cells a point lies at u = H x' / z' + H and v = H y' / z' + H, H half the resolution, and as
//! deep as w = 1 / z': what is nearer has a larger w. On the plane of a triangle w is an affine function of u and v,
//! so that all that follows is flat.
//!
//! Bounds, with r = 2^-24, to first order; each constant is at least a quarter above its count. Coordinates of a
//! vertex are f32 numbers, so that its difference with the light is wrong by r of itself. 1 / z' is then wrong by 2 r,
//! x' / z' by 4 r, which is at most 4 r since |x'| <= z', its product with H by 5 r H, and the sum, which is at most
//! 2 H, by 7 r H in all: [`Projector::delta`] is 10 r H. Depths outside 2^-60 to 2^60 are not projected, so that
//! neither a quotient nor a product overflows, and what underflows is far below r H.

use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use glam::Vec3;

/// Unit roundoff of f32.
pub(super) const ROUNDOFF: f32 = 1.0 / 16_777_216.0;

/// A point on a side of the cube.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(16))]
pub(super) struct Projected {
    /// Along x', in cells.
    pub u: f32,
    /// Along y', in cells.
    pub v: f32,
    /// 1 / z'.
    pub w: f32,
    /// Index of the side of its largest coordinate, or [`Projected::NOWHERE`].
    pub side: u32,
}

impl Projected {
    /// The `side` of a point too near to the light or too far from it for f32.
    pub const NOWHERE: u32 = 7;
}

/// A light and the cells around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projector {
    /// Where the light is.
    pub light: Vec3,
    /// Cells along the edge of a side, R.
    pub resolution: u32,
    /// R / 2.
    pub half: f32,
    /// The most that u and v of a vertex are wrong by; w is wrong by 2.1 r of itself.
    pub delta: f32,
}

impl Projector {
    /// Cells around a light at a point.
    pub fn new(light: Vec3, resolution: u32) -> Projector {
        let half = resolution as f32 * 0.5;
        Projector { light, resolution, half, delta: 10.0 * ROUNDOFF * half }
    }

    /// Where a point is.
    #[inline(always)]
    pub fn project(&self, p: [f32; 3]) -> Projected {
        let (dx, dy, dz) = (p[0] - self.light.x, p[1] - self.light.y, p[2] - self.light.z);
        let (ax, ay, az) = (dx.abs(), dy.abs(), dz.abs());
        let is_x = (ax >= ay) & (ax >= az);
        let is_y = !is_x & (ay >= az);
        let pick = |x: f32, y: f32, z: f32| {
            if is_x {
                x
            } else if is_y {
                y
            } else {
                z
            }
        };
        let (a, b, c) = (pick(dy, dz, dx), pick(dz, dx, dy), pick(dx, dy, dz));
        let along = if is_x {
            0
        } else if is_y {
            2
        } else {
            4
        };
        let depth = c.abs();
        let w = 1.0 / depth;
        let (u, v) = ((a * w) * self.half + self.half, (b * w) * self.half + self.half);
        let in_range = (depth > 8.673_617_4e-19) & (depth < 1.152_921_5e18);
        let side = along + u32::from(c < 0.0);
        Projected { u, v, w, side: if in_range { side } else { Projected::NOWHERE } }
    }

    /// The most that u and v of a rounded point are wrong by, whose coordinates are at most `size`.
    ///
    /// They are wrong by e = r `size` w of the depth each, so that x' / z' is by 2 e / (1 - e). That is below 4 e if
    /// e < 1/2; and where it is not, a half cell or more is allowed for, within which no cell is certain.
    #[inline(always)]
    pub fn delta_of(&self, size: f32, w: f32) -> f32 {
        self.delta + (4.0 * ROUNDOFF) * self.half * (size * w)
    }

    /// The most that w of a rounded point is wrong by, as a share of itself: e and 2 r. It bounds w from below always,
    /// and from above where it is less than 1/2.
    #[inline(always)]
    pub fn error_of(&self, size: f32, w: f32) -> f32 {
        8.0 * ROUNDOFF + (2.0 * ROUNDOFF) * (size * w)
    }
}

for_instruction_sets! {
    /// Projects points.
    pub(super) fn project = project_body, (projector: &Projector, points: &[Vec3], projected: &mut [Projected])
}

#[inline(always)]
fn project_body(_: InstructionSet, projector: &Projector, points: &[Vec3], projected: &mut [Projected]) {
    for (projected, point) in projected.iter_mut().zip(points) {
        *projected = projector.project(point.to_array());
    }
}

/// The cell that holds a coordinate, and how far it is from the nearest border, negative below one. Coordinates outside
/// of 0 to R have a cell of R or above, and what is not a number a distance that is not one either.
#[inline(always)]
pub(super) fn cell_and_border(u: f32) -> (u32, f32) {
    // Adding 2^23 rounds to a whole number, whose bits then follow each other. Whole numbers differ from u by at most
    // a half, exactly.
    const BIG: f32 = 8_388_608.0;
    let shifted = u + BIG;
    let from_border = u - (shifted - BIG);
    let nearest = shifted.to_bits().wrapping_sub(BIG.to_bits());
    (nearest.wrapping_sub(u32::from(from_border < 0.0)), from_border)
}

/// The larger of two numbers; the second if either is not one. One instruction, unlike [`f32::max`].
#[inline(always)]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two numbers; the second if either is not one.
#[inline(always)]
pub(super) fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_half_open_and_borders_are_near() {
        assert_eq!(cell_and_border(0.25), (0, 0.25));
        assert_eq!(cell_and_border(0.75), (0, -0.25));
        assert_eq!(cell_and_border(7.0), (7, 0.0));
        assert_eq!(cell_and_border(4095.5f32.next_up()).0, 4095);
        assert!(cell_and_border(-0.3).0 > 4096);
        assert!(cell_and_border(-1e-5).1.abs() <= 1e-5);
        assert!(cell_and_border(f32::NAN).1.is_nan());
    }

    #[test]
    fn the_axes_of_a_side_are_those_of_the_light_buffer() {
        use crate::shadow::light_buffer::cube::Face;
        let projector = Projector::new(Vec3::ZERO, 2);
        for (index, face) in Face::ALL.into_iter().enumerate() {
            for p in [[3.0f32, 0.5, -0.25], [-3.0, 0.5, -0.25], [0.5, 3.0, 0.25], [0.5, -3.0, 0.25]] {
                for turn in 0..3 {
                    let p = [0, 1, 2].map(|i| p[(i + turn) % 3]);
                    let found = projector.project(p);
                    if found.side as usize != index {
                        continue;
                    }
                    let [x, y, z] = face.coordinates(Vec3::from(p).as_dvec3());
                    assert!((f64::from(found.u) - (x / z + 1.0)).abs() < 1e-5);
                    assert!((f64::from(found.v) - (y / z + 1.0)).abs() < 1e-5);
                    assert!((f64::from(found.w) * z - 1.0).abs() < 1e-6);
                }
            }
        }
    }
}
