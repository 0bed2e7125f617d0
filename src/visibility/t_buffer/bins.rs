//! Which triangles may be seen in which band of rows, by the boxes around their projections.

use super::band::BAND_ROWS;
use super::places::{BEHIND, Place};
use super::view::View;
use crate::float_environment::InStandardFloats;
use crate::geometry::footprint::Footprint;
use crate::geometry::planes::{self, OrientedPlanes};
use crate::scene::PrimitiveIndex;
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;

/// Triangles that are looked at before any is drawn: so many bound the memory that it takes.
const CHUNK: u32 = 1 << 18;

/// Triangles that one task looks at.
const TASK: usize = 1 << 13;

/// A triangle and the pixels around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touched {
    pub primitive: PrimitiveIndex,
    /// First and last.
    pub columns: [u32; 2],
    /// First and last.
    pub rows: [u32; 2],
    /// At least 1 / depth of all its points.
    pub nearness: f32,
}

/// What a task found, band by band.
pub(super) struct Bins {
    /// For each band where it begins, and the end.
    starts: Vec<u32>,
    touched: Vec<Touched>,
}

impl Bins {
    /// What may be seen in a band.
    pub fn of(&self, band: usize) -> &[Touched] {
        &self.touched[self.starts[band] as usize..self.starts[band + 1] as usize]
    }
}

/// The triangles of all objects, in portions. The order is of no consequence: a tie is decided by what is
/// hit, and not by when.
pub(super) fn portions<'a>(
    view: &'a View<'a>,
    places: &'a [Place],
) -> impl Iterator<Item = Vec<Bins>> + use<'a> {
    let end = view.scene.triangles.len() as u32;
    (0..end).step_by(CHUNK as usize).map(move |start| {
        let portion: Vec<u32> = (start..end.min(start + CHUNK)).step_by(TASK).collect();
        let tasks = portion.into_par_iter().in_standard_floats();
        tasks.map(|first| bins(view, places, first..end.min(first + TASK as u32))).collect()
    })
}

fn bins(view: &View, places: &[Place], triangles: Range<PrimitiveIndex>) -> Bins {
    let mut found: Vec<Touched> = Vec::with_capacity(triangles.len());
    found.extend(triangles.filter_map(|primitive| Touched::new(view, places, primitive)));
    let bands_of = |touched: &Touched| {
        let [first, last] = touched.rows.map(|row| row as usize / BAND_ROWS);
        first..last + 1
    };
    let bands = (view.grid.count[1] as usize).div_ceil(BAND_ROWS);
    let mut starts = vec![0; bands + 1];
    for band in found.iter().flat_map(bands_of) {
        starts[band + 1] += 1;
    }
    for band in 0..bands {
        starts[band + 1] += starts[band];
    }
    let nothing = Touched { primitive: 0, columns: [0; 2], rows: [0; 2], nearness: 0.0 };
    let mut sorted = vec![nothing; starts[bands] as usize];
    let mut ends = starts.clone();
    for touched in &found {
        for band in bands_of(touched) {
            sorted[ends[band] as usize] = *touched;
            ends[band] += 1;
        }
    }
    Bins { starts, touched: sorted }
}

impl Touched {
    /// `None` if no ray can hit the triangle.
    fn new(view: &View, places: &[Place], primitive: PrimitiveIndex) -> Option<Touched> {
        let [a, b, c] = view.scene.triangles[primitive as usize].vertices.map(|v| places[v as usize]);
        let least = a.nearness.min(b.nearness).min(c.nearness);
        let is_known = !(a.nearness.is_nan() | b.nearness.is_nan() | c.nearness.is_nan());
        if is_known & (least > 0.0) {
            let range = |axis, [a, b, c]: [f32; 3]| pixels(view, axis, [a.min(b).min(c), a.max(b).max(c)]);
            return Some(Touched {
                primitive,
                columns: range(0, [a.column, b.column, c.column])?,
                rows: range(1, [a.row, b.row, c.row])?,
                nearness: a.nearness.max(b.nearness).max(c.nearness),
            });
        }
        if [a, b, c].iter().all(|place| place.nearness == BEHIND) {
            return None;
        }
        let origin = view.camera.origin;
        let corners = planes::oriented(origin, view.scene.corners(primitive))?;
        let planes = OrientedPlanes::from_apex(origin.as_dvec3(), corners.map(Vec3::as_dvec3));
        let footprint = Footprint::new(&view.grid, &view.frame, &planes)?;
        let (columns, rows) = (footprint.columns(), footprint.rows());
        Some(Touched { primitive, columns, rows, nearness: f32::INFINITY })
    }
}

/// The first and the last pixel of a column or row whose ray can pass between two places.
#[inline]
fn pixels(view: &View, axis: usize, [low, high]: [f32; 2]) -> Option<[u32; 2]> {
    // Of the places' roundings each is 2^-24, and those of the sums are as large.
    let around = view.margins[axis] + low.abs().max(high.abs()) * (1.0 / 4_194_304.0);
    let (low, high) = (low - around, high + around);
    let end = view.grid.count[axis] - 1;
    if high < 0.0 || low > end as f32 {
        return None;
    }
    let low = low.max(0.0);
    let first = low as u32;
    let first = first + u32::from((first as f32) < low);
    let last = end.min(high as u32);
    (first <= last).then_some([first, last])
}
