//! Triangles that lie on one side and touch few cells: all in f32, on the side.

use super::block::{CellBox, Edge, Patch, Sixteen, any_above, each_bit};
use super::caster::Caster;
use super::entries::{Bins, Item};
use super::facing::Facing;
use super::projection::{Projected, ROUNDOFF, larger, smaller};
use super::receivers::Horizon;
use super::tiles::TileGrid;

/// The most columns or rows of a small triangle. The bounds below hold for up to R of them.
const MOST: u32 = 12;

impl Caster<'_> {
    /// The cells that a triangle on one side touches, if they are few.
    #[inline(always)]
    pub(super) fn small_box(&self, [a, b, c]: [Projected; 3]) -> Option<CellBox> {
        let (delta, last) = (self.projector.delta, self.projector.resolution - 1);
        // Casts take what is below zero for zero.
        let cell = |u: f32| (u as u32).min(last);
        let range = |a: f32, b: f32, c: f32| {
            [cell(smaller(smaller(a, b), c) - delta), cell(larger(larger(a, b), c) + delta)]
        };
        let (x, y) = (range(a.u, b.u, c.u), range(a.v, b.v, c.v));
        (x[1] - x[0] < MOST && y[1] - y[0] < MOST).then_some(CellBox { x, y })
    }

    #[inline(always)]
    pub(super) fn cast_small(
        &self,
        triangle: u32,
        facing: Facing,
        corners: [Projected; 3],
        cells: CellBox,
        bins: &mut Bins,
    ) {
        let [a, b, c] = corners;
        // A quotient of depths between f32 numbers is wrong by 2.1 r.
        let w_limits = [
            smaller(smaller(a.w, b.w), c.w) * (1.0 - 8.0 * ROUNDOFF),
            larger(larger(a.w, b.w), c.w) * (1.0 + 8.0 * ROUNDOFF),
        ];
        let key = Horizon::key(w_limits[1]);
        let mut patch = None;
        for by in CellBox::blocks(cells.y) {
            for bx in CellBox::blocks(cells.x) {
                let tile = self.tiles.grid.tile(a.side, bx, by);
                let Some(first) = self.tiles.first_of(tile) else { continue };
                let first = (first + TileGrid::place(bx, by)) as usize;
                let keys = self.horizon.block(first);
                if !any_above(keys, key) {
                    continue;
                }
                let patch =
                    patch.get_or_insert_with(|| self.patch(triangle, facing, corners, cells, w_limits));
                let mut sixteen = Sixteen::default();
                each_bit(sixteen.fill(patch, [bx, by], keys, key), |i| {
                    let item = Item::new(triangle, sixteen.flags[i]);
                    bins.push(first + i, item, sixteen.near[i], sixteen.far[i]);
                });
            }
        }
    }

    /// Edges and depths of a triangle on its side.
    ///
    /// An edge from p to q says E = du (y - p.v) - dv (x - p.u) of a place (x, y). Differences of two projected
    /// coordinates are wrong by 2.2 delta (with their own rounding, at most r R = delta / 5), those of a place and a
    /// coordinate by 1.2 delta; with |x - p.u| + |y - p.v| at most the `reach` of the box and its cells' corners, E is
    /// wrong by 2.2 delta reach + 1.2 delta (|du| + |dv|), and by roundings of 4 r R of either, delta each. The slack
    /// is 5 delta of both, where 2 delta reach remain for the error of |du| + |dv| in `out`.
    ///
    /// Depths: with weights B = E / A, A the area, w = w0 + B1 (w1 - w0) + B2 (w2 - w0). Over the box the weights are
    /// at most N = reach (sum of all four differences) / (A - slack) together, E and A wrong by the slack, so that the
    /// weights are by (1 + N) slack / (A - slack) each; w0, w1, w2 by 2.1 r of themselves, and roundings add 6 r of the largest
    /// w and of each term: (1 + N) (2 range slack / (A - slack) + 12 r w_max). Taken twice, since the change of w over half
    /// a cell is computed with it as well. Where that is no number, or infinite, the limits of the whole triangle stand.
    #[inline(always)]
    fn patch(
        &self,
        triangle: u32,
        facing: Facing,
        [a, b, c]: [Projected; 3],
        cells: CellBox,
        w_limits: [f32; 2],
    ) -> Patch {
        let delta = self.projector.delta;
        let [e0, e1, e2] = self.irregular(triangle, facing);
        let looks_against = a.side & 1 == 1;
        let (corners, irregular) = match (facing == Facing::Positive) != looks_against {
            true => ([a, b, c], [e0, e1, e2]),
            false => ([a, c, b], [e2, e1, e0]),
        };
        let origin = [cells.x[0], cells.y[0]];
        let centre = origin.map(|cell| cell as f32 + 0.5);
        let reach = (cells.x[1] - cells.x[0] + cells.y[1] - cells.y[0]) as f32 + 3.0;
        let edges = std::array::from_fn(|i| {
            let (p, q) = (corners[i], corners[(i + 1) % 3]);
            let (du, dv) = (q.u - p.u, q.v - p.v);
            let length = du.abs() + dv.abs();
            let slack = (5.0 * delta) * (length + reach);
            let at = du * (centre[1] - p.v) - dv * (centre[0] - p.u);
            let within = 0.5 * length + slack;
            Edge { a: -dv, b: du, at, out: -within, slack, meets: if irregular[i] { within } else { -1.0 } }
        });
        let [p, q, r] = corners;
        let (qu, qv, ru, rv) = (q.u - p.u, q.v - p.v, r.u - p.u, r.v - p.v);
        let size = (qu.abs() + qv.abs()) + (ru.abs() + rv.abs());
        let area = qu * rv - qv * ru;
        let (qw, rw) = (q.w - p.w, r.w - p.w);
        let dw = [(qw * rv - rw * qv) / area, (rw * qu - qw * ru) / area];
        let slack = (5.0 * delta) * (size + reach);
        let certain_area = larger(area - slack, 0.0);
        let weights = 1.0 + reach * size / certain_area;
        let range = w_limits[1] - w_limits[0];
        let wrong = weights * (4.0 * range * (slack / certain_area) + 24.0 * ROUNDOFF * w_limits[1]);
        Patch {
            edges,
            origin,
            cells,
            w: (p.w + dw[0] * (centre[0] - p.u)) + dw[1] * (centre[1] - p.v),
            dw,
            spread: 0.5 * (dw[0].abs() + dw[1].abs()) + wrong,
            w_limits,
        }
    }
}
