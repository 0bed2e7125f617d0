//! Sixteen pixels at a time: which of them a triangle covers, and where it is the nearest so far.

use super::band::Band;
use super::bins::Touched;
use super::cast::{Cast, Spans};
use super::view::View;
use crate::geometry::batch::{InstructionSet, LANES};
use crate::geometry::masks::{Bits, bits};

/// More than a [`Ramp`](super::cast::Ramp) may be wrong by of itself.
const ALLOWANCE: f32 = 1.0 / 2_097_152.0;

/// Where a triangle's functions start, and who takes part.
#[derive(Clone, Copy)]
struct Run<'a> {
    cast: &'a Cast,
    /// What items hold of it.
    item: u32,
    /// The sides, and the nearness.
    starts: [f32; 4],
    /// How many columns and rows take part, at least one.
    count: [u32; 2],
    /// Whether what is inside is there: triangles with holes leave that to the rest.
    certainty: bool,
}

/// A bit for each of sixteen pixels.
struct Drawn {
    /// Not certainly outside.
    touched: u32,
    /// It has to be asked whether and what it changes.
    undecided: u32,
    /// Changed.
    changed: u32,
}

/// Draws a triangle in the pixels around it.
#[inline(always)]
pub(super) fn draw(set: InstructionSet, view: &View, band: &mut Band, cast: &Cast, touched: &Touched) {
    // Narrow ones fill their sixteen lanes with several rows.
    match touched.columns[1] - touched.columns[0] {
        0..4 => rows::<4>(set, view, band, cast, touched),
        4..8 => rows::<8>(set, view, band, cast, touched),
        _ => rows::<16>(set, view, band, cast, touched),
    }
}

/// Draws it in runs of so many columns.
#[inline(always)]
fn rows<const COLUMNS: usize>(
    set: InstructionSet,
    view: &View,
    band: &mut Band,
    cast: &Cast,
    touched: &Touched,
) {
    let rows_of_run = (LANES / COLUMNS) as u32;
    let [s, t, u] = &cast.sides;
    let spans = Spans::of(cast);
    let certainty = !view.has_holes || view.scene.masked(touched.primitive).is_none();
    let [mut row, last_row] = touched.rows_from(band.first_row);
    while row <= last_row {
        let y = view.grid.origin[1] + view.grid.step[1] * f64::from(row);
        let of_row = [s.ramp.of_row(y), t.ramp.of_row(y), u.ramp.of_row(y)];
        let nearness = cast.nearness.of_row(y);
        // A run of several rows is as wide as the whole.
        let span =
            if COLUMNS < 16 { Some(touched.columns) } else { spans.of_row(view, &of_row, touched.columns) };
        if let Some([mut first, last]) = span {
            while first <= last {
                let x = view.grid.origin[0] + view.grid.step[0] * f64::from(first);
                let run = Run {
                    cast,
                    item: Band::item(touched.primitive),
                    starts: [
                        s.ramp.at(of_row[0], x) as f32,
                        t.ramp.at(of_row[1], x) as f32,
                        u.ramp.at(of_row[2], x) as f32,
                        cast.nearness.at(nearness, x) as f32,
                    ],
                    count: [(COLUMNS as u32).min(last - first + 1), rows_of_run.min(last_row - row + 1)],
                    certainty,
                };
                let drawn = sixteen::<COLUMNS>(set, &run, band, [first, row]);
                band.tests += u64::from(drawn.touched.count_ones());
                for lane in Bits(drawn.undecided) {
                    let (column, down) = ((lane % COLUMNS) as u32, (lane / COLUMNS) as u32);
                    band.ask(view, touched.primitive, [first + column, row + down]);
                }
                if drawn.changed != 0 {
                    band.mark([first, row], run.count, drawn.changed.count_ones());
                }
                first += COLUMNS as u32;
            }
        }
        row += rows_of_run;
    }
}

/// Sixteen pixels, so many to a row.
#[inline(always)]
fn sixteen<const COLUMNS: usize>(set: InstructionSet, run: &Run, band: &mut Band, pixel: [u32; 2]) -> Drawn {
    let Run { cast, item, starts, count, certainty } = *run;
    let places = places::<COLUMNS>(band, pixel, count[1]);
    let (least, most) = (load::<COLUMNS, _>(&band.least, &places), load::<COLUMNS, _>(&band.most, &places));
    let items = load::<COLUMNS, _>(&band.items, &places);
    let (mut new_least, mut new_most, mut new_items) = ([0.0; LANES], [0.0; LANES], [0; LANES]);
    let [s, t, u] = [&cast.sides[0].ramp, &cast.sides[1].ramp, &cast.sides[2].ramp];
    let w = &cast.nearness;
    let count = [count[0] as f32, count[1] as f32];
    let (mut touched, mut undecided, mut changed) = ([0; LANES], [0; LANES], [0; LANES]);
    for i in 0..LANES {
        let (x, y) = ((i % COLUMNS) as f32, (i / COLUMNS) as f32);
        let a = starts[0] + (s.step[0] * x + s.step[1] * y);
        let b = starts[1] + (t.step[0] * x + t.step[1] * y);
        let c = starts[2] + (u.step[0] * x + u.step[1] * y);
        // With NaN, nothing is certain.
        let is_outside = (a < -s.slack) | (b < -t.slack) | (c < -u.slack);
        let is_inside = (a > s.slack) & (b > t.slack) & (c > u.slack);
        let here = starts[3] + (w.step[0] * x + w.step[1] * y);
        let around = here.abs() * ALLOWANCE + w.slack;
        let (low, high) = (here - around, here + around);
        let is_touched = !is_outside & (x < count[0]) & (y < count[1]);
        let is_behind = high < least[i];
        let may_show = is_touched & !is_behind;
        let shows = may_show & is_inside & (low > most[i]) & certainty;
        touched[i] = u32::from(is_touched);
        undecided[i] = u32::from(may_show & !shows);
        changed[i] = u32::from(shows);
        new_least[i] = if shows { low } else { least[i] };
        new_most[i] = if shows { high } else { most[i] };
        new_items[i] = if shows { item } else { items[i] };
    }
    let changed = bits(set, &changed);
    if changed != 0 {
        let rows = run.count[1] as usize;
        store::<COLUMNS, _>(&mut band.least, &places[..rows], &new_least);
        store::<COLUMNS, _>(&mut band.most, &places[..rows], &new_most);
        store::<COLUMNS, _>(&mut band.items, &places[..rows], &new_items);
    }
    Drawn { touched: bits(set, &touched), undecided: bits(set, &undecided), changed }
}

/// Where the rows of sixteen pixels begin. Those that take no part are where the last one is that does.
#[inline(always)]
fn places<const COLUMNS: usize>(band: &Band, pixel: [u32; 2], rows: u32) -> [usize; LANES] {
    let mut places = [0; LANES];
    for (down, place) in places.iter_mut().take(LANES / COLUMNS).enumerate() {
        *place = band.place([pixel[0], pixel[1] + (down as u32).min(rows - 1)]);
    }
    places
}

#[inline(always)]
fn load<const COLUMNS: usize, T: Copy + Default>(items: &[T], places: &[usize; LANES]) -> [T; LANES] {
    let mut lanes = [T::default(); LANES];
    for down in 0..LANES / COLUMNS {
        let row: &[T; COLUMNS] = items[places[down]..][..COLUMNS].try_into().expect("so many");
        for i in 0..COLUMNS {
            lanes[down * COLUMNS + i] = row[i];
        }
    }
    lanes
}

#[inline(always)]
fn store<const COLUMNS: usize, T: Copy>(items: &mut [T], places: &[usize], lanes: &[T; LANES]) {
    for (down, &place) in places.iter().enumerate() {
        items[place..place + COLUMNS].copy_from_slice(&lanes[down * COLUMNS..(down + 1) * COLUMNS]);
    }
}
