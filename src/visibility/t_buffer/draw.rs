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
    let certainty = !view.has_holes || view.scene.masked(touched.primitive).is_none();
    let drawing = Drawing { set, view, cast, touched, certainty };
    // Narrow ones fill their sixteen lanes with several rows.
    match touched.columns[1] - touched.columns[0] {
        0..4 => drawing.narrow::<4>(band),
        4..8 => drawing.narrow::<8>(band),
        _ => drawing.wide(band),
    }
}

/// Whether everything in the pixels around a small triangle is nearer than it; of a large one nothing is said.
#[inline(always)]
pub(super) fn hides(set: InstructionSet, band: &Band, touched: &Touched) -> bool {
    let columns = touched.columns[1] - touched.columns[0] + 1;
    let rows = u32::from(touched.rows[1] - touched.rows[0]) + 1;
    match (columns, rows) {
        (0..=4, 0..=4) => hides_all::<4>(set, band, touched, [columns, rows]),
        (0..=8, 0..=2) => hides_all::<8>(set, band, touched, [columns, rows]),
        _ => false,
    }
}

#[inline(always)]
fn hides_all<const COLUMNS: usize>(
    set: InstructionSet,
    band: &Band,
    touched: &Touched,
    [columns, rows]: [u32; 2],
) -> bool {
    let first_row = touched.rows_from(band.first_row)[0];
    let places = places::<COLUMNS>(band, [touched.columns[0], first_row], rows);
    let least = load::<COLUMNS, _>(&band.least, &places);
    let mut shows = [0; LANES];
    for i in 0..LANES {
        shows[i] = u32::from((least[i] <= touched.nearness) & ((i % COLUMNS) < columns as usize));
    }
    bits(set, &shows) == 0
}

/// A triangle that is being drawn.
struct Drawing<'a> {
    set: InstructionSet,
    view: &'a View<'a>,
    cast: &'a Cast,
    touched: &'a Touched,
    /// As in [`Run`].
    certainty: bool,
}

impl Drawing<'_> {
    /// Draws it in runs that are as wide as the whole.
    #[inline(always)]
    fn narrow<const COLUMNS: usize>(&self, band: &mut Band) {
        let [first, last] = self.touched.columns;
        let [mut row, last_row] = self.touched.rows_from(band.first_row);
        // As many rows as fill the lanes.
        let rows = (LANES / COLUMNS) as u32;
        while row <= last_row {
            self.run::<COLUMNS>(band, [first, row], [last - first + 1, rows.min(last_row - row + 1)]);
            row += rows;
        }
    }

    /// Draws it row by row, or several rows at once where they are narrow.
    #[inline(always)]
    fn wide(&self, band: &mut Band) {
        let [first_row, last_row] = self.touched.rows_from(band.first_row);
        for from in (first_row..=last_row).step_by(LANES) {
            let count = (LANES as u32).min(last_row - from + 1);
            let spans = self.cast.spans(self.touched.columns, from - first_row, count);
            let mut row = 0;
            while row < count as usize {
                row += self.rows(band, &spans, [from, row as u32], count) as usize;
            }
        }
    }

    /// Draws one row or several, and returns how many that were. Rows are said by the first of the spans and how many come
    /// before.
    #[inline(always)]
    fn rows(&self, band: &mut Band, spans: &Spans, [from, row]: [u32; 2], count: u32) -> u32 {
        let place = row as usize;
        let [first, last] = spans.of::<4>(place);
        if last - first < 4 {
            if first <= last {
                let size = [(last - first + 1) as u32, 4.min(count - row)];
                self.run::<4>(band, [first as u32, from + row], size);
            }
            return 4;
        }
        let [first, last] = spans.of::<2>(place);
        if last - first < 8 {
            if first <= last {
                let size = [(last - first + 1) as u32, 2.min(count - row)];
                self.run::<8>(band, [first as u32, from + row], size);
            }
            return 2;
        }
        let [mut first, last] = spans.of::<1>(place);
        while first <= last {
            let columns = (last - first + 1).min(LANES as i32);
            self.run::<16>(band, [first as u32, from + row], [columns as u32, 1]);
            first += LANES as i32;
        }
        1
    }

    /// Draws what is in so many columns and rows from a pixel on.
    #[inline(always)]
    fn run<const COLUMNS: usize>(&self, band: &mut Band, [first, row]: [u32; 2], count: [u32; 2]) {
        let run = Run {
            cast: self.cast,
            item: Band::item(self.touched.primitive),
            starts: self.cast.at(self.view, [first, row]),
            count,
            certainty: self.certainty,
        };
        let drawn = sixteen::<COLUMNS>(self.set, &run, band, [first, row]);
        band.tests += u64::from(drawn.touched.count_ones());
        for lane in Bits(drawn.undecided) {
            let (column, down) = ((lane % COLUMNS) as u32, (lane / COLUMNS) as u32);
            band.ask(self.view, self.touched.primitive, [first + column, row + down]);
        }
        if drawn.changed != 0 {
            band.mark([first, row], count, drawn.changed.count_ones());
        }
    }
}

/// Sixteen pixels, so many to a row.
#[inline(always)]
fn sixteen<const COLUMNS: usize>(set: InstructionSet, run: &Run, band: &mut Band, pixel: [u32; 2]) -> Drawn {
    let Run { cast, item, starts, count, certainty } = *run;
    let places = places::<COLUMNS>(band, pixel, count[1]);
    let least = load::<COLUMNS, _>(&band.least, &places);
    let Cast { across, down, slack, .. } = cast;
    let columns_and_rows = [count[0] as f32, count[1] as f32];
    let (mut low, mut high) = ([0.0; LANES], [0.0; LANES]);
    let (mut touched, mut may_show, mut inside) = ([0; LANES], [0; LANES], [0; LANES]);
    for i in 0..LANES {
        let (x, y) = ((i % COLUMNS) as f32, (i / COLUMNS) as f32);
        let a = starts[0] + (across[0] * x + down[0] * y);
        let b = starts[1] + (across[1] * x + down[1] * y);
        let c = starts[2] + (across[2] * x + down[2] * y);
        // With NaN, nothing is certain.
        let is_outside = (a < -slack[0]) | (b < -slack[1]) | (c < -slack[2]);
        let is_inside = (a > slack[0]) & (b > slack[1]) & (c > slack[2]);
        let here = starts[3] + (across[3] * x + down[3] * y);
        let around = here.abs() * ALLOWANCE + slack[3];
        (low[i], high[i]) = (here - around, here + around);
        let is_touched = !is_outside & (x < columns_and_rows[0]) & (y < columns_and_rows[1]);
        let is_behind = high[i] < least[i];
        touched[i] = u32::from(is_touched);
        may_show[i] = u32::from(is_touched & !is_behind);
        inside[i] = u32::from(is_inside & certainty);
    }
    let touched = bits(set, &touched);
    // Most runs end here, and have not looked at anything but the nearness.
    if bits(set, &may_show) == 0 {
        return Drawn { touched, undecided: 0, changed: 0 };
    }
    let most = load::<COLUMNS, _>(&band.most, &places);
    let items = load::<COLUMNS, _>(&band.items, &places);
    let (mut new_least, mut new_most, mut new_items) = ([0.0; LANES], [0.0; LANES], [0; LANES]);
    let (mut undecided, mut changed) = ([0; LANES], [0; LANES]);
    for i in 0..LANES {
        let shows = (may_show[i] & inside[i] != 0) & (low[i] > most[i]);
        undecided[i] = may_show[i] & u32::from(!shows);
        changed[i] = u32::from(shows);
        new_least[i] = if shows { low[i] } else { least[i] };
        new_most[i] = if shows { high[i] } else { most[i] };
        new_items[i] = if shows { item } else { items[i] };
    }
    let changed = bits(set, &changed);
    if changed != 0 {
        let rows = count[1] as usize;
        store::<COLUMNS, _>(&mut band.least, &places[..rows], &new_least);
        store::<COLUMNS, _>(&mut band.most, &places[..rows], &new_most);
        store::<COLUMNS, _>(&mut band.items, &places[..rows], &new_items);
    }
    Drawn { touched, undecided: bits(set, &undecided), changed }
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
