//! The corners of sixteen triangles.

use super::facing::Facing;
use super::projection::{Projected, Projector, ROUNDOFF, larger, smaller};

/// Triangles that are looked at together.
pub(super) const LANES: usize = 16;

/// Corners of sixteen triangles, axis by axis.
#[derive(Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Corners {
    pub u: [[f32; LANES]; 3],
    pub v: [[f32; LANES]; 3],
    pub w: [[f32; LANES]; 3],
    /// The side that all three are on, or [`Projected::NOWHERE`].
    pub side: [u32; LANES],
}

impl Corners {
    /// Takes in the triangle of three vertices.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, projected: &[Projected], vertices: [u32; 3]) {
        let side = projected[vertices[0] as usize].side;
        let mut is_on_one = true;
        for i in 0..3 {
            let corner = &projected[vertices[i] as usize];
            (self.u[i][lane], self.v[i][lane], self.w[i][lane]) = (corner.u, corner.v, corner.w);
            is_on_one &= corner.side == side;
        }
        self.side[lane] = if is_on_one { side } else { Projected::NOWHERE };
    }

    /// Limits of one coordinate in one lane.
    #[inline(always)]
    fn range(of: &[[f32; LANES]; 3], lane: usize) -> [f32; 2] {
        let [a, b, c] = [of[0][lane], of[1][lane], of[2][lane]];
        [smaller(smaller(a, b), c), larger(larger(a, b), c)]
    }

    /// Limits of w. A quotient of depths between f32 numbers is wrong by 2.1 r.
    #[inline(always)]
    pub fn w_limits(&self, lane: usize) -> [f32; 2] {
        let [low, high] = Corners::range(&self.w, lane);
        [low * (1.0 - 8.0 * ROUNDOFF), high * (1.0 + 8.0 * ROUNDOFF)]
    }

    /// Limits of u and v.
    #[inline(always)]
    pub fn limits(&self, lane: usize, delta: f32) -> [[f32; 2]; 2] {
        let ([u_low, u_high], [v_low, v_high]) =
            (Corners::range(&self.u, lane), Corners::range(&self.v, lane));
        [[u_low - delta, u_high + delta], [v_low - delta, v_high + delta]]
    }

    /// How they face the light as f32 tells it, or `None` where it does not; for those on one side.
    ///
    /// On a side the orientation is that of the projection, mirrored where the side looks against its axis. Differences
    /// of coordinates are wrong by 2 delta and their own rounding, 2.2 delta in all, each product by 2.4 delta of the
    /// sum of its factors and 5 delta^2, the area by 2.6 delta of the sum of all four and 10 delta^2.
    #[inline(always)]
    pub fn facing(&self, projector: &Projector) -> [Option<Facing>; LANES] {
        let (mut above, mut below) = ([0u32; LANES], [0u32; LANES]);
        for i in 0..LANES {
            let (u, v) = (self.u.map(|u| u[i]), self.v.map(|v| v[i]));
            let (bu, bv, cu, cv) = (u[1] - u[0], v[1] - v[0], u[2] - u[0], v[2] - v[0]);
            let area = bu * cv - bv * cu;
            let size = (bu.abs() + bv.abs()) + (cu.abs() + cv.abs());
            let slack = 6.0 * projector.delta * (size + 2.0 * projector.delta);
            above[i] = u32::from(area > slack);
            below[i] = u32::from(area < -slack);
        }
        std::array::from_fn(|i| match (above[i], below[i], self.side[i] & 1) {
            (1, _, 0) | (_, 1, 1) => Some(Facing::Positive),
            (1, _, _) | (_, 1, _) => Some(Facing::Negative),
            _ => None,
        })
    }
}
