//! Which triangles may be seen in which band of rows, by the boxes around their projections.

use super::places::{BEHIND, Place};
use super::view::{BAND_ROWS, View};
use crate::float_environment::InStandardFloats;
use crate::geometry::batch::{InstructionSet, LANES};
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::geometry::footprint::Footprint;
use crate::geometry::planes::{self, OrientedPlanes};
use crate::scene::PrimitiveIndex;
use glam::Vec3;
use rayon::prelude::*;
use std::ops::Range;

/// Triangles that are looked at before any is drawn: so many bound the memory that it takes.
const CHUNK: u32 = 1 << 20;

/// Triangles that one task looks at.
const TASK: usize = 1 << 13;

/// A triangle and the pixels around it in a band.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touched {
    pub primitive: PrimitiveIndex,
    /// At least 1 / depth of all its points.
    pub nearness: f32,
    /// First and last.
    pub columns: [u32; 2],
    /// First and last, from the first of the band.
    pub rows: [u8; 2],
}

impl Touched {
    /// In place of one.
    pub const NOTHING: Touched = Touched { primitive: 0, nearness: 0.0, columns: [0; 2], rows: [0; 2] };

    /// First and last row of the picture, with the first of the band.
    #[inline(always)]
    pub fn rows_from(&self, first_row: u32) -> [u32; 2] {
        [first_row + u32::from(self.rows[0]), first_row + u32::from(self.rows[1])]
    }
}

/// A triangle and all pixels around it.
struct Surrounded {
    primitive: PrimitiveIndex,
    nearness: f32,
    columns: [u32; 2],
    rows: [u32; 2],
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
    set: InstructionSet,
    view: &'a View<'a>,
    places: &'a [Place],
) -> impl Iterator<Item = Vec<Bins>> + use<'a> {
    let end = view.scene.triangles.len() as u32;
    (0..end).step_by(CHUNK as usize).map(move |start| {
        let portion: Vec<u32> = (start..end.min(start + CHUNK)).step_by(TASK).collect();
        let tasks = portion.into_par_iter().in_standard_floats();
        let of_task = |found: &mut Vec<Surrounded>, first| {
            bins(set, view, places, first..end.min(first + TASK as u32), found)
        };
        tasks.map_init(Vec::new, of_task).collect()
    })
}

/// Sorts some triangles; `found` is room to work in.
fn bins(
    set: InstructionSet,
    view: &View,
    places: &[Place],
    triangles: Range<PrimitiveIndex>,
    found: &mut Vec<Surrounded>,
) -> Bins {
    found.clear();
    surround(set, view, places, triangles, found);
    let band_of = |row: u32| row as usize / BAND_ROWS;
    let bands = (view.grid.count[1] as usize).div_ceil(BAND_ROWS);
    let mut starts = vec![0; bands + 1];
    for triangle in found.iter() {
        for band in band_of(triangle.rows[0])..=band_of(triangle.rows[1]) {
            starts[band + 1] += 1;
        }
    }
    for band in 0..bands {
        starts[band + 1] += starts[band];
    }
    let mut touched = vec![Touched::NOTHING; starts[bands] as usize];
    let mut ends = starts.clone();
    for &Surrounded { primitive, nearness, columns, rows } in found.iter() {
        let [first, last] = [band_of(rows[0]), band_of(rows[1])];
        for band in first..=last {
            let rows = [
                if band == first { rows[0] as usize % BAND_ROWS } else { 0 },
                if band == last { rows[1] as usize % BAND_ROWS } else { BAND_ROWS - 1 },
            ];
            let rows = [rows[0] as u8, rows[1] as u8];
            touched[ends[band] as usize] = Touched { primitive, nearness, columns, rows };
            ends[band] += 1;
        }
    }
    Bins { starts, touched }
}

/// Sets `sorted` to everything that may be seen in a band, the nearest about first: what is drawn early hides much of the
/// rest.
///
/// On the way all that will be drawn is fetched, as long as it is asked for in the order in which it lies in memory.
pub(super) fn front_to_back(view: &View, portion: &[Bins], band: usize, sorted: &mut Vec<Touched>) {
    // The bits of a positive float have its order.
    let key = |touched: &Touched| touched.nearness.to_bits();
    sorted.clear();
    let (mut least, mut most, mut count) = (u32::MAX, 0, 0);
    for bins in portion {
        count += bins.of(band).len();
        for touched in bins.of(band) {
            fetch(&view.scene.triangles[touched.primitive as usize]);
            (least, most) = (least.min(key(touched)), most.max(key(touched)));
        }
    }
    if count == 0 {
        return;
    }
    // The narrowest steps with which there are no more than 2048: in each the order is that of the scene, in which
    // neighbours in space are near each other in memory.
    let shift = 32 - ((most - least) >> 11).leading_zeros();
    let step = |touched: &Touched| ((most - key(touched)) >> shift) as usize;
    let mut ends = vec![0u32; ((most - least) >> shift) as usize + 2];
    for bins in portion {
        for touched in bins.of(band) {
            for vertex in view.scene.triangles[touched.primitive as usize].vertices {
                fetch(&view.scene.vertices[vertex as usize]);
            }
            ends[step(touched) + 1] += 1;
        }
    }
    for i in 1..ends.len() {
        ends[i] += ends[i - 1];
    }
    sorted.resize(count, Touched::NOTHING);
    for bins in portion {
        for touched in bins.of(band) {
            let end = &mut ends[step(touched)];
            sorted[*end as usize] = *touched;
            *end += 1;
        }
    }
}

for_instruction_sets! {
    /// Adds the triangles that rays can hit to `found`.
    fn surround = surround_body,
        (view: &View, places: &[Place], triangles: Range<PrimitiveIndex>, found: &mut Vec<Surrounded>)
}

/// Sixteen triangles at a time.
#[inline(always)]
fn surround_body(
    _: InstructionSet,
    view: &View,
    places: &[Place],
    triangles: Range<PrimitiveIndex>,
    found: &mut Vec<Surrounded>,
) {
    let margins = view.margins;
    let ends = [view.grid.count[0] - 1, view.grid.count[1] - 1];
    for first in triangles.clone().step_by(LANES) {
        let lanes = LANES.min((triangles.end - first) as usize);
        let (mut column, mut row, mut nearness) =
            ([[0.0; LANES]; 3], [[0.0; LANES]; 3], [[f32::NAN; LANES]; 3]);
        for i in 0..lanes {
            let vertices = &view.scene.triangles[first as usize + i].vertices;
            for k in 0..3 {
                let place = &places[vertices[k] as usize];
                (column[k][i], row[k][i], nearness[k][i]) = (place.column, place.row, place.nearness);
            }
        }
        let (mut columns, mut rows) = ([[0; LANES]; 2], [[0; LANES]; 2]);
        let (mut nearest, mut kind) = ([0.0; LANES], [0; LANES]);
        for i in 0..LANES {
            let [a, b, c] = [nearness[0][i], nearness[1][i], nearness[2][i]];
            // With NaN, neither.
            let is_before = (a > 0.0) & (b > 0.0) & (c > 0.0);
            let is_behind = (a == BEHIND) & (b == BEHIND) & (c == BEHIND);
            let (left, right) = pixels(ends[0], margins[0], column[0][i], column[1][i], column[2][i]);
            let (top, bottom) = pixels(ends[1], margins[1], row[0][i], row[1][i], row[2][i]);
            (columns[0][i], columns[1][i]) = (left, right);
            (rows[0][i], rows[1][i]) = (top, bottom);
            nearest[i] = larger(larger(a, b), c);
            let is_seen = (left <= right) & (top <= bottom);
            kind[i] = if is_before { u32::from(is_seen) * SEEN } else { u32::from(!is_behind) * UNKNOWN };
        }
        for i in 0..lanes {
            let primitive = first + i as u32;
            if kind[i] == SEEN {
                let [columns, rows] = [[columns[0][i], columns[1][i]], [rows[0][i], rows[1][i]]];
                found.push(Surrounded { primitive, nearness: nearest[i], columns, rows });
            } else if kind[i] == UNKNOWN {
                found.extend(Surrounded::clipped(view, primitive));
            }
        }
    }
}

/// What is known of a triangle: that no ray hits it (0), the box around it, or nothing.
const SEEN: u32 = 1;
const UNKNOWN: u32 = 2;

impl Surrounded {
    /// One that is not all before the camera; `None` if no ray can hit it.
    #[inline(never)]
    fn clipped(view: &View, primitive: PrimitiveIndex) -> Option<Surrounded> {
        let origin = view.camera.origin;
        let corners = planes::oriented(origin, view.scene.corners(primitive))?;
        let planes = OrientedPlanes::from_apex(origin.as_dvec3(), corners.map(Vec3::as_dvec3));
        let footprint = Footprint::new(&view.grid, &view.frame, &planes)?;
        let (columns, rows) = (footprint.columns(), footprint.rows());
        Some(Surrounded { primitive, columns, rows, nearness: f32::INFINITY })
    }
}

/// The first and the last pixel, of those to `end`, of a column or row whose ray can pass between three places; a first one
/// after the last if there is none.
#[inline(always)]
fn pixels(end: u32, margin: f32, a: f32, b: f32, c: f32) -> (u32, u32) {
    let (low, high) = (smaller(smaller(a, b), c), larger(larger(a, b), c));
    // Of the places' roundings each is 2^-24, and those of the sums are as large.
    let around = margin + larger(-low, high).abs() * (1.0 / 4_194_304.0);
    let (low, high) = (low - around, high + around);
    let from = larger(low, 0.0);
    // Places are below 2^30.
    let first = from as i32;
    let first = first.wrapping_add(i32::from((first as f32) < from));
    let last = (high as i32).min(end as i32);
    let last = if high < 0.0 { -1 } else { last };
    // Neither is negative where it counts.
    if first <= last { (first as u32, last as u32) } else { (1, 0) }
}

/// Without the rules for NaN, which cost time.
#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
