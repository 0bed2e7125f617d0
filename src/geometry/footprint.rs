//! Which boxes of a grid a triangle's projection can touch: a superset, row by row.
//!
//! The grid lies on the plane z = 1 in front of an apex, or across parallel lines. Light buffers ask for
//! cells (boxes that tile the face of the cube), t-buffers for pixel centres (boxes as wide as the rounding of the ray). A box is
//! marked unless one of the lines of its edges or of the triangle's certainly separates the two, which is
//! the exact overlap of convex polygons, widened by rounding: the modified scan line of the 1986 paper
//! without its cases.

use super::ROUNDOFF;
use super::planes::{OrientedPlanes, Plane};
use glam::DVec3;

/// A grid of boxes on the plane of projection. Steps may be negative.
#[derive(Debug, Clone, Copy)]
pub struct Grid {
    /// Centre of box (0, 0).
    pub origin: [f64; 2],
    /// From one centre to the next.
    pub step: [f64; 2],
    /// Half the extent of a box, widened by whatever the caller's samples may be off.
    pub half: [f64; 2],
    /// Columns and rows.
    pub count: [u32; 2],
}

impl Grid {
    /// The four corners of a box.
    pub fn corners(&self, column: u32, row: u32) -> [[f64; 2]; 4] {
        let [x, y] = self.centre(column, row);
        [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)]
            .map(|(sx, sy)| [x + sx * self.half[0], y + sy * self.half[1]])
    }

    /// The largest coordinates that a box has, as absolute values.
    pub(crate) fn reach(&self) -> [f64; 2] {
        [0, 1].map(|i| {
            let last = self.origin[i] + self.step[i] * f64::from(self.count[i] - 1);
            self.origin[i].abs().max(last.abs()) + self.half[i]
        })
    }

    /// First and last box along one axis that a range of coordinates can touch.
    pub(crate) fn touched(&self, axis: usize, range: [f64; 2]) -> Option<[u32; 2]> {
        let index = |value: f64| (value - self.origin[axis]) / self.step[axis];
        let half = self.half[axis] / self.step[axis].abs();
        let (a, b) = (index(range[0]), index(range[1]));
        let margin = 1e-9 * (1.0 + f64::from(self.count[axis]));
        let first = (a.min(b) - half - margin).ceil().max(0.0);
        let last = (a.max(b) + half + margin).floor().min(f64::from(self.count[axis] - 1));
        (first <= last).then_some([first as u32, last as u32])
    }

    fn centre(&self, column: u32, row: u32) -> [f64; 2] {
        [self.origin[0] + self.step[0] * f64::from(column), self.origin[1] + self.step[1] * f64::from(row)]
    }
}

/// Where x, y and z of the grid point in world space, and how points are projected on it. The axes need not
/// be orthogonal.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    axes: [DVec3; 3],
    /// Rows of the inverse matrix: coordinates of a vector in the frame.
    dual: [DVec3; 3],
    projection: Projection,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Projection {
    /// From the origin on the plane z = 1.
    Perspective,
    /// Along z.
    Parallel,
}

impl Frame {
    /// Linearly independent axes, for a projection from the origin.
    pub fn perspective(x: DVec3, y: DVec3, z: DVec3) -> Frame {
        let volume = x.dot(y.cross(z));
        let dual = [y.cross(z) / volume, z.cross(x) / volume, x.cross(y) / volume];
        Frame { axes: [x, y, z], dual, projection: Projection::Perspective }
    }

    /// Axes for a projection along the third, with their inverse: each of its coefficients may be wrong by
    /// four roundoffs.
    pub fn parallel(axes: [DVec3; 3], dual: [DVec3; 3]) -> Frame {
        Frame { axes, dual, projection: Projection::Parallel }
    }

    #[inline(always)]
    fn coordinates(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.dual[0].dot(v), self.dual[1].dot(v), self.dual[2].dot(v))
    }

    /// Where a point in front of the apex is on the plane z = 1; `None` if it is too near to the plane through the
    /// apex, or behind it. For projections from the origin.
    pub(crate) fn project(&self, v: DVec3) -> Option<OnGrid> {
        let point = self.look_at(v);
        point.is_before.then_some(point)
    }

    /// The same of any point, without a branch.
    #[inline(always)]
    pub(crate) fn look_at(&self, v: DVec3) -> OnGrid {
        let c = self.coordinates(v);
        let slack = RELATIVE_SLACK * c.abs().max_element();
        let on_grid = [c.x / c.z, c.y / c.z];
        let error = 4.0 * slack * (1.0 + on_grid[0].abs().max(on_grid[1].abs())) / c.z;
        // With NaN, neither.
        let (is_before, is_behind) = (c.z > 1024.0 * slack, c.z < -slack);
        OnGrid { on_grid, error, least_depth: c.z - slack, is_before, is_behind }
    }

    /// How far the coordinates of a vector may be off whose own are wrong by one roundoff.
    fn coordinate_error(&self, v: DVec3) -> DVec3 {
        DVec3::from_array(self.dual.map(|row| row.abs().dot(v.abs()))) * (16.0 * ROUNDOFF)
    }
}

/// A projected point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnGrid {
    /// Means something if the point is before the apex, as all that follows but the last.
    pub on_grid: [f64; 2],
    /// The most that either coordinate is wrong by.
    pub error: f64,
    /// Its z is no less than this, which is positive.
    pub least_depth: f64,
    /// Whether it is before the plane through the apex, and not too near to that to be projected.
    pub is_before: bool,
    /// Whether it is certainly behind the plane through the apex.
    pub is_behind: bool,
}

/// A linear function a x + b y + c on the grid plane whose values are wrong by at most `slack`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Linear {
    pub a: f64,
    pub b: f64,
    pub c: f64,
    pub slack: f64,
}

impl Linear {
    /// The plane through an edge. Roundoffs relative to the terms: 5 of the plane's normal, 3 of the scalar
    /// product with an axis, 1 of the place on the grid, 1 of each product and 2 of the sums, 1 of the spread, and the
    /// rounding of an axis itself, which cameras have; below 16, and 32 are taken.
    fn edge(plane: &Plane, (offset, offset_error): (f64, f64), frame: &Frame, reach: [f64; 2]) -> Linear {
        match frame.projection {
            Projection::Perspective => Linear::through_apex(plane, frame, reach),
            // The plane holds the direction of z.
            Projection::Parallel => {
                let [a, b, _] = frame.axes.map(|axis| axis.dot(plane.normal));
                let size = frame.axes.map(|axis| axis.abs().dot(plane.size));
                let slack = 32.0 * ROUNDOFF * (size[0] * reach[0] + size[1] * reach[1] + offset.abs());
                Linear { a, b, c: -offset, slack: slack + 2.0 * offset_error + f64::MIN_POSITIVE }
            }
        }
    }

    /// The same for projections from the origin.
    #[inline(always)]
    pub fn through_apex(plane: &Plane, frame: &Frame, reach: [f64; 2]) -> Linear {
        let [x, y, z] = &frame.axes;
        let size = |axis: &DVec3| axis.abs().dot(plane.size);
        let slack = 32.0 * ROUNDOFF * (size(x) * reach[0] + size(y) * reach[1] + size(z));
        let [a, b, c] = [x.dot(plane.normal), y.dot(plane.normal), z.dot(plane.normal)];
        Linear { a, b, c, slack: slack + f64::MIN_POSITIVE }
    }

    /// Value at a box's centre, and how far it can change inside the box, slack included.
    fn over_box(&self, grid: &Grid, x: f64, y: f64) -> (f64, f64) {
        (self.a * x + self.b * y + self.c, self.spread(grid))
    }

    /// How far the value can be from the one that is computed for a box's centre, anywhere in the box.
    #[inline(always)]
    pub fn spread(&self, grid: &Grid) -> f64 {
        self.a.abs() * grid.half[0] + self.b.abs() * grid.half[1] + self.slack
    }
}

/// The projection of a triangle on a grid.
#[derive(Debug, Clone, Copy)]
pub struct Footprint {
    edges: [Linear; 3],
    depth: Depth,
    /// First and last column and row that the projection can touch.
    columns: [u32; 2],
    rows: [u32; 2],
    /// Bounds of z over the part of the triangle that projects on the grid.
    z_range: [f64; 2],
}

/// z on a triangle's own plane, over the grid.
#[derive(Debug, Clone, Copy)]
enum Depth {
    /// The height (with the bound of its error) divided by a linear function.
    Perspective { slope: Linear, height: (f64, f64) },
    /// The linear function divided by a positive number, which is wrong by at most its error.
    Parallel { rise: Linear, steepness: (f64, f64) },
}

impl Depth {
    fn new(planes: &OrientedPlanes, frame: &Frame, reach: [f64; 2]) -> Depth {
        match frame.projection {
            Projection::Perspective => Depth::Perspective {
                slope: Linear::edge(&planes.own, (0.0, 0.0), frame, reach),
                height: planes.height,
            },
            Projection::Parallel => {
                let down = Linear::edge(&planes.own, planes.height, frame, reach);
                let rise = Linear { a: -down.a, b: -down.b, c: -down.c, slack: down.slack };
                let [.., z] = frame.axes;
                let error = 32.0 * ROUNDOFF * z.abs().dot(planes.own.size);
                Depth::Parallel { rise, steepness: (z.dot(planes.own.normal), error) }
            }
        }
    }

    /// At most the least and at least the greatest z inside a box; infinite where rounding leaves it open.
    fn over_box(&self, grid: &Grid, x: f64, y: f64) -> [f64; 2] {
        match self {
            Depth::Perspective { slope, height: (height, height_error) } => {
                let (centre, spread) = slope.over_box(grid, x, y);
                let steepest = (centre + spread) * (1.0 + 1e-14);
                let near =
                    if steepest > 0.0 { (height - height_error) * (1.0 - 1e-14) / steepest } else { 0.0 };
                let flattest = (centre - spread) * (1.0 - 1e-14);
                let far = (height + height_error) * (1.0 + 1e-14) / flattest;
                [near, if flattest > 0.0 { far } else { f64::INFINITY }]
            }
            Depth::Parallel { rise, steepness: (steepness, error) } => {
                let (centre, spread) = rise.over_box(grid, x, y);
                if *steepness <= 2.0 * error {
                    return [f64::NEG_INFINITY, f64::INFINITY];
                }
                let quotients = [centre - spread, centre + spread]
                    .map(|value| [value / (steepness - error), value / (steepness + error)]);
                let outwards = |value: f64, sign: f64| value + sign * value.abs() * 1e-14;
                let [low, high] = quotients;
                [outwards(low[0].min(low[1]), -1.0), outwards(high[0].max(high[1]), 1.0)]
            }
        }
    }
}

impl Footprint {
    /// The projection of a triangle, or `None` if it certainly touches no box.
    pub(crate) fn new(grid: &Grid, frame: &Frame, planes: &OrientedPlanes) -> Option<Footprint> {
        let reach = grid.reach();
        let corners = planes.corners.map(|u| frame.coordinates(u));
        let clipped = match frame.projection {
            Projection::Perspective => Clipped::new(corners, reach)?,
            Projection::Parallel => {
                Clipped::around(corners, planes.corners.map(|u| frame.coordinate_error(u)))
            }
        };
        let columns = grid.touched(0, clipped.x)?;
        let rows = grid.touched(1, clipped.y)?;
        Some(Footprint {
            edges: [0, 1, 2].map(|i| Linear::edge(&planes.edges[i], planes.offsets[i], frame, reach)),
            depth: Depth::new(planes, frame, reach),
            columns,
            rows,
            z_range: clipped.z,
        })
    }

    /// First and last row.
    pub fn rows(&self) -> [u32; 2] {
        self.rows
    }

    /// First and last column.
    pub fn columns(&self) -> [u32; 2] {
        self.columns
    }

    /// First and last column in one row, if any.
    pub fn span(&self, grid: &Grid, row: u32) -> Option<[u32; 2]> {
        let y = grid.origin[1] + grid.step[1] * f64::from(row);
        let [mut first, mut last] = self.columns;
        for edge in &self.edges {
            // The corner of the box row that is farthest inside, with the half width in x folded in too.
            let (centre, spread) = edge.over_box(grid, grid.origin[0], y);
            let slope = edge.a * grid.step[0];
            let at_zero = centre + spread;
            // Boxes i with at_zero + slope * i >= 0, a little wider than the division's rounding.
            if slope == 0.0 {
                if at_zero < 0.0 {
                    return None;
                }
                continue;
            }
            let crossing = -at_zero / slope;
            let margin = 1e-9 + crossing.abs() * 1e-13;
            if slope.is_sign_positive() {
                let bound = (crossing - margin).ceil();
                if bound > f64::from(last) {
                    return None;
                }
                first = first.max(bound.max(0.0) as u32);
            } else {
                let bound = (crossing + margin).floor();
                if bound < f64::from(first) {
                    return None;
                }
                last = last.min(bound as u32);
            }
        }
        (first <= last).then_some([first, last])
    }

    /// Bounds of z over the triangle inside one box: at most the nearest, at least the farthest.
    ///
    /// Taken on the triangle's plane and clamped to the triangle itself, because a plane seen almost edge-on
    /// runs away (row 6 of the notes on the 1986 paper).
    pub fn z_bounds(&self, grid: &Grid, column: u32, row: u32) -> [f64; 2] {
        let [x, y] = grid.centre(column, row);
        let [near, far] = self.depth.over_box(grid, x, y);
        [near.max(self.z_range[0]), far.min(self.z_range[1])]
    }

    /// Whether the triangle's projection certainly covers the whole closed box.
    pub fn covers(&self, grid: &Grid, column: u32, row: u32) -> bool {
        let [x, y] = grid.centre(column, row);
        self.edges.iter().all(|edge| {
            let (centre, spread) = edge.over_box(grid, x, y);
            centre > spread
        })
    }

    /// Whether the line of projection through a point of the grid plane certainly meets the triangle's interior.
    pub fn contains(&self, x: f64, y: f64) -> bool {
        self.edges.iter().all(|edge| edge.a * x + edge.b * y + edge.c > edge.slack)
    }
}

/// The part of a triangle that projects on the grid, reduced to bounds: of its projection, and of z.
struct Clipped {
    x: [f64; 2],
    y: [f64; 2],
    z: [f64; 2],
}

impl Clipped {
    /// The whole triangle, projected along z; coordinates are wrong by at most `errors`.
    fn around(corners: [DVec3; 3], errors: [DVec3; 3]) -> Clipped {
        let range = |axis: usize| {
            let ends =
                [0, 1, 2].map(|i| (corners[i][axis] - errors[i][axis], corners[i][axis] + errors[i][axis]));
            ends.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], end| {
                [low.min(end.0), high.max(end.1)]
            })
        };
        Clipped { x: range(0), y: range(1), z: range(2) }
    }

    /// Clips against the four sides of the frustum |x| <= reach z, |y| <= reach z, each moved outwards by
    /// more than the rounding; `None` if nothing is left.
    fn new(corners: [DVec3; 3], reach: [f64; 2]) -> Option<Clipped> {
        let size = corners.iter().map(|c| c.abs().max_element()).fold(0.0, f64::max);
        let slack = size * RELATIVE_SLACK * (1.0 + reach[0] + reach[1]);
        let mut polygon: Vec<DVec3> = Vec::with_capacity(7);
        polygon.extend(corners);
        for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            polygon = clip(&polygon, |p| reach[axis] * p.z + sign * p[axis] + slack);
            if polygon.is_empty() {
                return None;
            }
        }
        let mut bounds = Clipped {
            x: [f64::INFINITY, f64::NEG_INFINITY],
            y: [f64::INFINITY, f64::NEG_INFINITY],
            z: [f64::INFINITY, 0.0],
        };
        for p in &polygon {
            bounds.z[0] = bounds.z[0].min(p.z - 2.0 * slack);
            bounds.z[1] = bounds.z[1].max(p.z + 2.0 * slack);
            // Too near to the apex to be projected: it can be anywhere.
            let near_apex = p.z <= 1024.0 * slack;
            for (range, axis) in [(&mut bounds.x, 0), (&mut bounds.y, 1)] {
                if near_apex {
                    *range = [f64::NEG_INFINITY, f64::INFINITY];
                } else {
                    let value = p[axis] / p.z;
                    let error = 4.0 * slack * (1.0 + value.abs()) / p.z;
                    *range = [range[0].min(value - error), range[1].max(value + error)];
                }
            }
        }
        bounds.z[0] = bounds.z[0].max(0.0);
        (bounds.z[1] > 0.0).then_some(bounds)
    }
}

/// Relative to the largest coordinate: above the rounding of corners, frame and clipping together.
///
/// A corner carries 1 roundoff, a row of the inverse 9 (2 of a cross product, 4 of the volume, 1 of the quotient, as
/// much again where axes are not orthogonal), the scalar product 3, each clip 5 of its line's terms: four clips and
/// the rest are below 40. That is for axes of about one length, as the sides of a cube have them. For a narrow camera
/// the coordinates across grow by the factor that its picture is narrow by; but so do its boxes, which are as wide as
/// the rounding of f32 directions, 2^29 times this.
const RELATIVE_SLACK: f64 = 64.0 * ROUNDOFF;

/// The part of a convex polygon where a linear function is not negative (Sutherland and Hodgman).
fn clip(polygon: &[DVec3], distance: impl Fn(DVec3) -> f64) -> Vec<DVec3> {
    let mut inside = Vec::with_capacity(polygon.len() + 1);
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (dp, dq) = (distance(p), distance(q));
        if dp >= 0.0 {
            inside.push(p);
        }
        if (dp >= 0.0) != (dq >= 0.0) {
            inside.push(p + (q - p) * (dp / (dp - dq)));
        }
    }
    inside
}

#[cfg(test)]
mod tests;
