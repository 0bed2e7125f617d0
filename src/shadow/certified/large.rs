//! Triangles in general: on several sides, partly behind the plane of one, over many cells. Planes in f64, and from
//! block to block in f32.
//!
//! With corners a, b, c relative to the light, in the order of positive orientation, the cone of a triangle is where
//! all three of (a x b) . d, (b x c) . d and (c x a) . d are not negative, whatever lies behind the plane of a side, so
//! that nothing is clipped. On a side d = (x', y', 1), and these are linear functions of the cell. So is
//! w = N . d / (N . a), N = (b - a) x (c - a).

use super::bins::Bins;
use super::block::{CellBox, Edge, Patch};
use super::facing::{Facing, exactly};
use super::projection::{ROUNDOFF, smaller};
use super::receivers::Horizon;
use super::survey::Survey;
use super::tiles::{BLOCK_EDGE, EDGE};
use crate::geometry::planes::Plane;
use crate::shadow::light_buffer::cube::Face;

/// A linear function of a place in cells, and the most that its values are wrong by.
#[derive(Debug, Clone, Copy)]
struct Line {
    a: f64,
    b: f64,
    c: f64,
    slack: f64,
}

impl Line {
    /// What a vector n says of the direction of a place on a side: n . (x', y', 1), with x' = x / h - 1.
    ///
    /// The components of n are wrong by 5 roundoffs of their size, and come in three times; six operations follow. 64
    /// roundoffs of the sum of sizes are far above that.
    fn new(face: Face, half: f64, plane: &Plane) -> Line {
        let [x, y, z] = face.coordinates(plane.normal);
        let slack = 32.0 * f64::EPSILON * plane.size.element_sum();
        Line { a: x / half, b: y / half, c: z - x - y, slack }
    }

    fn scaled(self, scale: f64) -> Line {
        Line { a: self.a * scale, b: self.b * scale, c: self.c * scale, slack: self.slack * scale }
    }

    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.a * x + self.b * y + self.c
    }

    /// How much it changes over one cell in each direction.
    fn change(&self) -> f64 {
        self.a.abs() + self.b.abs()
    }
}

/// A triangle on one side.
#[derive(Debug)]
pub(super) struct Large {
    pub triangle: u32,
    pub facing: Facing,
    /// Whether it lies on this side as a whole.
    pub is_on_one_side: bool,
    face: Face,
    /// Of the corners in the order of positive orientation.
    edges: [Line; 3],
    depth: Line,
    /// What w is wrong by as a share of itself.
    depth_error: f64,
    cells: CellBox,
    w_limits: [f32; 2],
}

impl Survey<'_> {
    /// Enters a triangle in all tiles in which it may be in front of a receiver, of one side if it lies on that as a whole.
    pub(super) fn survey_large(&self, triangle: u32, side: Option<u32>, bins: &mut Bins) {
        let light = self.projector.light.as_dvec3();
        let facing = exactly(self.projector.light, self.scene.corners(triangle));
        let mut corners = self.scene.corners(triangle).map(|p| p.as_dvec3() - light);
        match facing {
            Facing::Nothing => return,
            Facing::Positive => {}
            Facing::Negative => corners.swap(1, 2),
        }
        let [a, b, c] = corners;
        let edges = [Plane::through(a, b - a), Plane::through(b, c - b), Plane::through(c, a - c)];
        let own = Plane::through(b - a, c - a);
        let height = own.normal.dot(a);
        // The corner is wrong by one roundoff, the normal by 5 of its size, the product by 3: 9 of this, and it is 64.
        let height_error = 32.0 * f64::EPSILON * own.size.dot(a.abs()) / height;
        let half = f64::from(self.projector.half);
        let faces = Face::ALL.into_iter().filter(|face| side.is_none_or(|side| face.index() as u32 == side));
        for face in faces {
            let on_side = corners.map(|p| face.coordinates(p));
            let Some((cells, w_limits)) = self.on_side(on_side) else { continue };
            let edges = edges.each_ref().map(|plane| {
                let line = Line::new(face, half, plane);
                // Within f32, whatever the size of the triangle.
                let scale = 1.0 / line.a.abs().max(line.b.abs());
                line.scaled(if scale.is_finite() { scale } else { 1.0 })
            });
            let known = height > 0.0 && height_error < 1e-3;
            let depth = Line::new(face, half, &own).scaled(1.0 / height);
            let depth_error = if known { 2.0 * height_error } else { f64::INFINITY };
            let is_on_one_side = side.is_some();
            self.enter(
                Large { triangle, facing, is_on_one_side, face, edges, depth, depth_error, cells, w_limits },
                bins,
            );
        }
    }

    fn enter(&self, large: Large, bins: &mut Bins) {
        let tiles = |cells: [u32; 2]| cells.map(|cell| cell / EDGE);
        let (side, columns, rows) = (large.face.index() as u32, tiles(large.cells.x), tiles(large.cells.y));
        let number = bins.next_large();
        let keys = self.horizon.of_tiles();
        let mut is_entered = false;
        for (row, columns, first) in self.windows.rows(side, columns, rows) {
            for (tile, column) in (first..).zip(columns) {
                let key = keys[tile as usize];
                let corner = [column * EDGE, row * EDGE];
                if key != 0 && large.nearest(corner, EDGE).is_some_and(|w| key > Horizon::key(w)) {
                    bins.push(tile, number);
                    is_entered = true;
                }
            }
            if bins.overflowed {
                return;
            }
        }
        if is_entered {
            bins.push_large(large);
        }
    }

    /// The cells of a side that a triangle may touch, and limits of its w there; `None` if it is certainly beside
    /// them. Corners are in the axes of the side.
    fn on_side(&self, corners: [[f64; 3]; 3]) -> Option<(CellBox, [f32; 2])> {
        const WIDER: f64 = 1.000_000_1;
        let all = |beside: &dyn Fn([f64; 3]) -> bool| corners.iter().all(|&p| beside(p));
        if all(&|[_, _, z]| z <= 0.0)
            || all(&|[x, _, z]| x > 0.0 && x > z * WIDER)
            || all(&|[x, _, z]| x < 0.0 && -x > z * WIDER)
            || all(&|[_, y, z]| y > 0.0 && y > z * WIDER)
            || all(&|[_, y, z]| y < 0.0 && -y > z * WIDER)
        {
            return None;
        }
        let last = self.projector.resolution - 1;
        let half = f64::from(self.projector.half);
        if !all(&|[x, y, z]| z > 1e-3 * (x.abs() + y.abs())) {
            return Some((CellBox { x: [0, last], y: [0, last] }, [0.0, f32::INFINITY]));
        }
        let least = |of: &dyn Fn([f64; 3]) -> f64| corners.map(of).into_iter().fold(f64::INFINITY, f64::min);
        let most = |of: &dyn Fn([f64; 3]) -> f64| -least(&|p| -of(p));
        // Quotients below 1000 are wrong by a millionth of a cell at most.
        let range = |axis: usize| {
            let place = |p: [f64; 3]| p[axis] / p[2] * half + half;
            let (low, high) = (least(&place) - 1e-6, most(&place) + 1e-6);
            let cell = |x: f64| (x as u32).min(last);
            (high >= 0.0 && low <= 2.0 * half).then(|| [cell(low), cell(high)])
        };
        let cells = CellBox { x: range(0)?, y: range(1)? };
        let w = |[_, _, z]: [f64; 3]| 1.0 / z;
        let w_limits = [least(&w) as f32 * (1.0 - 4.0 * ROUNDOFF), most(&w) as f32 * (1.0 + 4.0 * ROUNDOFF)];
        // Subnormal numbers are not rounded by a share of themselves.
        let is_normal = w_limits.iter().all(|w| w.is_normal());
        Some((cells, if is_normal { w_limits } else { [0.0, f32::INFINITY] }))
    }
}

impl Large {
    /// At least the w of the triangle in a square of so many cells, or `None` if it is certainly beside that.
    fn nearest(&self, corner: [u32; 2], edge: u32) -> Option<f32> {
        let half = f64::from(edge) * 0.5;
        let middle = corner.map(|cell| f64::from(cell) + half);
        if self.edges.iter().any(|edge| edge.at(middle) + half * edge.change() < -edge.slack) {
            return None;
        }
        let depth = &self.depth;
        let highest = (depth.at(middle) + half * depth.change() + depth.slack) * (1.0 + self.depth_error);
        let nearest = smaller(highest as f32 * (1.0 + 4.0 * ROUNDOFF), self.w_limits[1]);
        // What is not a number, or negative, says nothing.
        Some(if nearest > 0.0 { nearest } else { self.w_limits[1] })
    }

    /// The triangle as the cells of a block see it, and the key of its nearest depth there; `None` if it is certainly beside them.
    /// `irregular` are the edges 01, 12 and 20 that are not regular, a bit each.
    pub(super) fn on_block(&self, irregular: u8, block: [u32; 2]) -> Option<(Patch, u32)> {
        let key = Horizon::key(self.nearest(block, BLOCK_EDGE)?);
        let irregular = [0, 1, 2].map(|i| irregular >> i & 1 == 1);
        let irregular = match self.facing {
            Facing::Negative => [irregular[2], irregular[1], irregular[0]],
            _ => irregular,
        };
        // The centre of the block's first cell.
        let at = block.map(|cell| f64::from(cell) + 0.5);
        let up = 1.0 + 4.0 * ROUNDOFF;
        // Rounding to f32 and three operations, on what is at most this.
        let rounding = |line: &Line| 8.0 * f64::from(ROUNDOFF) * (line.at(at).abs() + 4.0 * line.change());
        let edges = std::array::from_fn(|i| {
            let edge = &self.edges[i];
            let slack = (edge.slack + rounding(edge)) as f32 * up;
            let within = (0.5 * edge.change()) as f32 * up + slack;
            let meets = if irregular[i] { within } else { -1.0 };
            Edge { a: edge.a as f32, b: edge.b as f32, at: edge.at(at) as f32, within, slack, meets }
        });
        let depth = &self.depth;
        let reached = depth.at(at).abs() + 4.0 * depth.change();
        let wrong = depth.slack + self.depth_error * reached + 2.0 * rounding(depth);
        let patch = Patch {
            edges,
            origin: block,
            cells: self.cells,
            w: depth.at(at) as f32,
            dw: [depth.a as f32, depth.b as f32],
            spread: (0.5 * depth.change() + wrong) as f32 * up,
            w_limits: self.w_limits,
        };
        Some((patch, key))
    }
}
