//! Triangles that lie on one side and touch few cells, sixteen at a time: all in f32, on the side.

use super::block::{CellBox, Cover, Edge, Patch, Seen, Sixteen, depths};
use super::corners::{Corners, LANES};
use super::facing::Facing;
use super::projection::{Projector, ROUNDOFF, cell_and_border, larger};
use super::receivers::Horizon;
use super::tiles::{AREA, EDGE, TileGrid};
use crate::geometry::batch::InstructionSet;
use crate::geometry::masks::bits;

/// An edge of each triangle; see [`Edge`].
#[derive(Debug, Default)]
struct Edges {
    a: [f32; LANES],
    b: [f32; LANES],
    at: [f32; LANES],
    slack: [f32; LANES],
    within: [f32; LANES],
}

/// Edges and depths of sixteen triangles on their sides.
#[derive(Debug, Default)]
pub(super) struct Patches {
    edges: [Edges; 3],
    columns: [[u32; LANES]; 2],
    rows: [[u32; LANES]; 2],
    w: [f32; LANES],
    dw: [[f32; LANES]; 2],
    spread: [f32; LANES],
    w_limits: [[f32; LANES]; 2],
    /// Whether corners 1 and 2 changed places.
    swapped: [u32; LANES],
}

/// The cells of two coordinates.
#[inline(always)]
fn cells(ends: [f32; 2]) -> [u32; 2] {
    [cell_and_border(ends[0]).0, cell_and_border(ends[1]).0]
}

/// Two values of a lane. Not by `map`, which is not always compiled for the instructions of whoever calls it.
#[inline(always)]
fn both<T: Copy>(of: &[[T; LANES]; 2], lane: usize) -> [T; 2] {
    [of[0][lane], of[1][lane]]
}

impl Patches {
    /// Looks at triangles that are small.
    ///
    /// An edge from p to q says E = du (y - p.v) - dv (x - p.u) of a place (x, y). Differences of two projected
    /// coordinates are wrong by 2.2 delta (with their own rounding, at most r R = delta / 5), those of a place and a
    /// coordinate by 1.2 delta; with |x - p.u| + |y - p.v| at most the `reach` of the box and its cells' corners, E is
    /// wrong by 2.2 delta reach + 1.2 delta (|du| + |dv|), and by roundings of 4 r R of either, delta each. The slack
    /// is 5 delta of both, where 2 delta reach remain for the error of |du| + |dv| in `out`.
    ///
    /// Depths: with weights B = E / A, A the area, w = w0 + B1 (w1 - w0) + B2 (w2 - w0). Over the box the weights are
    /// at most N = reach (sum of all four differences) / (A - slack) together, E and A wrong by the slack, so that the
    /// weights are by (1 + N) slack / (A - slack) each; w0, w1, w2 by 2.1 r of themselves, and roundings add 7 r of the largest
    /// w and of each term: (1 + N) (2 range slack / (A - slack) + 12 r w_max). Taken twice, since the change of w over half
    /// a cell is computed with it as well. Where that is no number, or infinite, the limits of the whole triangle stand.
    #[inline(always)]
    pub fn fill(&mut self, projector: &Projector, corners: &Corners, facing: &[Facing; LANES]) {
        let delta = projector.delta;
        for i in 0..LANES {
            let is_swapped = (facing[i] == Facing::Positive) == (corners.side[i] & 1 == 1);
            let of = |of: &[[f32; LANES]; 3]| {
                let [a, b, c] = [of[0][i], of[1][i], of[2][i]];
                if is_swapped { [a, c, b] } else { [a, b, c] }
            };
            let (u, v, w) = (of(&corners.u), of(&corners.v), of(&corners.w));
            let [columns, rows] = corners.limits(i, delta);
            let (columns, rows) = (cells(columns), cells(rows));
            let centre = [columns[0] as i32 as f32 + 0.5, rows[0] as i32 as f32 + 0.5];
            let across = |ends: [u32; 2]| ends[1].wrapping_sub(ends[0]);
            let cells_across = across(columns).wrapping_add(across(rows));
            let reach = cells_across as i32 as f32 + 3.0;
            for (j, edge) in self.edges.iter_mut().enumerate() {
                let (p, q) = (j, if j == 2 { 0 } else { j + 1 });
                let (du, dv) = (u[q] - u[p], v[q] - v[p]);
                let length = du.abs() + dv.abs();
                let slack = (5.0 * delta) * (length + reach);
                edge.a[i] = -dv;
                edge.b[i] = du;
                edge.at[i] = du * (centre[1] - v[p]) - dv * (centre[0] - u[p]);
                edge.slack[i] = slack;
                edge.within[i] = 0.5 * length + slack;
            }
            let (qu, qv, ru, rv) = (u[1] - u[0], v[1] - v[0], u[2] - u[0], v[2] - v[0]);
            let size = (qu.abs() + qv.abs()) + (ru.abs() + rv.abs());
            let area = qu * rv - qv * ru;
            let (qw, rw) = (w[1] - w[0], w[2] - w[0]);
            let per_area = 1.0 / area;
            let dw = [(qw * rv - rw * qv) * per_area, (rw * qu - qw * ru) * per_area];
            let slack = (5.0 * delta) * (size + reach);
            let per_certain_area = 1.0 / larger(area - slack, 0.0);
            let limits = corners.w_limits(i);
            let weights = 1.0 + reach * size * per_certain_area;
            let range = limits[1] - limits[0];
            let wrong = weights * (4.0 * range * (slack * per_certain_area) + 24.0 * ROUNDOFF * limits[1]);
            self.w[i] = (w[0] + dw[0] * (centre[0] - u[0])) + dw[1] * (centre[1] - v[0]);
            self.spread[i] = 0.5 * (dw[0].abs() + dw[1].abs()) + wrong;
            for k in 0..2 {
                self.dw[k][i] = dw[k];
                self.columns[k][i] = columns[k];
                self.rows[k][i] = rows[k];
                self.w_limits[k][i] = limits[k];
            }
            self.swapped[i] = u32::from(is_swapped);
        }
    }

    /// Columns and rows of the cells that one touches.
    #[inline(always)]
    pub fn size(&self, lane: usize) -> [u32; 2] {
        let size = |ends: &[[u32; LANES]; 2]| ends[1][lane] - ends[0][lane] + 1;
        [size(&self.columns), size(&self.rows)]
    }

    /// What each is in one cell of its box, so many columns and rows from the first; the place of that cell in the tile; and a
    /// bit for each that may meet it and that somebody looks into there. `irregular` is as for [`Patches::patch`], of all
    /// lanes.
    #[inline(always)]
    pub fn in_cell(
        &self,
        set: InstructionSet,
        [dx, dy]: [u32; 2],
        Seen { corner, keys }: &Seen,
        irregular: &[u32; LANES],
        sixteen: &mut Sixteen,
        places: &mut [u32; LANES],
    ) -> u32 {
        let (x, y) = (dx as f32, dy as f32);
        let mut live = [0u32; LANES];
        for i in 0..LANES {
            let column = self.columns[0][i].wrapping_add(dx);
            let row = self.rows[0][i].wrapping_add(dy);
            let (in_tile_x, in_tile_y) = (column.wrapping_sub(corner[0]), row.wrapping_sub(corner[1]));
            let is_there = (column <= self.columns[1][i])
                & (row <= self.rows[1][i])
                & (in_tile_x < EDGE)
                & (in_tile_y < EDGE);
            let place = TileGrid::place(column, row);
            let limits = both(&self.w_limits, i);
            let is_asked = is_there & (keys[(place & (AREA - 1)) as usize] > Horizon::key(limits[1]));
            let w = (self.w[i] + self.dw[0][i] * x) + self.dw[1][i] * y;
            let mut cover = Cover::WHOLE;
            for (j, edge) in self.edges.iter().enumerate() {
                // Corners 1 and 2 may have changed places.
                let of_corners = if self.swapped[i] == 1 { 2 - j as u32 } else { j as u32 };
                let meets = if irregular[i] >> of_corners & 1 == 1 { edge.within[i] } else { -1.0 };
                cover.edge(
                    (edge.at[i] + edge.a[i] * x) + edge.b[i] * y,
                    edge.within[i],
                    edge.slack[i],
                    meets,
                );
            }
            let [near, far] = depths(w, self.spread[i], limits);
            (sixteen.near[i], sixteen.far[i], sixteen.flags[i]) = (near, far, cover.flags());
            places[i] = place;
            live[i] = u32::from(is_asked & !cover.is_out & (near >= far));
        }
        bits(set, &live)
    }

    /// One of them, whose edges 01, 12 and 20 are irregular that have a bit in `irregular`.
    #[inline(always)]
    pub fn patch(&self, lane: usize, irregular: u8) -> Patch {
        let edge = |i: usize| {
            let edge = &self.edges[i];
            let of_corners = if self.swapped[lane] == 1 { 2 - i } else { i };
            let is_irregular = irregular >> of_corners & 1 == 1;
            let within = edge.within[lane];
            Edge {
                a: edge.a[lane],
                b: edge.b[lane],
                at: edge.at[lane],
                within,
                slack: edge.slack[lane],
                meets: if is_irregular { within } else { -1.0 },
            }
        };
        Patch {
            edges: [edge(0), edge(1), edge(2)],
            origin: [self.columns[0][lane], self.rows[0][lane]],
            cells: CellBox { x: both(&self.columns, lane), y: both(&self.rows, lane) },
            w: self.w[lane],
            dw: both(&self.dw, lane),
            spread: self.spread[lane],
            w_limits: both(&self.w_limits, lane),
        }
    }
}
