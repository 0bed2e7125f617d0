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

/// A triangle that is being drawn.
struct Drawing<'a> {
    set: InstructionSet,
    view: &'a View<'a>,
    cast: &'a Cast,
    touched: &'a Touched,
    /// As in [`Run`].
    certainty: bool,
}

/// What a row knows of a triangle.
struct Span {
    /// As [`Drawing::of_row`] makes it.
    of_row: [f64; 4],
    /// First and last, if there are any.
    columns: Option<[u32; 2]>,
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
            let of_row = self.of_row(row);
            self.run::<COLUMNS>(
                band,
                &of_row,
                [first, row],
                [last - first + 1, rows.min(last_row - row + 1)],
            );
            row += rows;
        }
    }

    /// Draws it row by row, or two rows at once where both are narrow.
    #[inline(always)]
    fn wide(&self, band: &mut Band) {
        let spans = Spans::of(self.cast);
        let [mut row, last_row] = self.touched.rows_from(band.first_row);
        let mut here = self.span(&spans, row, last_row);
        while row <= last_row {
            let below = self.span(&spans, row + 1, last_row);
            if let (Some([left, right]), Some([left_below, right_below])) = (here.columns, below.columns) {
                let (first, last) = (left.min(left_below), right.max(right_below));
                if last - first < 8 {
                    self.run::<8>(band, &here.of_row, [first, row], [last - first + 1, 2]);
                    row += 2;
                    here = self.span(&spans, row, last_row);
                    continue;
                }
            }
            let [mut first, last] = here.columns.unwrap_or([1, 0]);
            while first <= last {
                let columns = (LANES as u32).min(last - first + 1);
                self.run::<16>(band, &here.of_row, [first, row], [columns, 1]);
                first += LANES as u32;
            }
            (row, here) = (row + 1, below);
        }
    }

    /// A row, in which nothing is if it is after the last.
    #[inline(always)]
    fn span(&self, spans: &Spans, row: u32, last_row: u32) -> Span {
        let of_row = self.of_row(row);
        let columns = match row <= last_row {
            true => spans.of_row(self.view, &of_row, self.touched.columns),
            false => None,
        };
        Span { of_row, columns }
    }

    /// What does not change along a row: of the sides, and of the nearness.
    #[inline(always)]
    fn of_row(&self, row: u32) -> [f64; 4] {
        let y = self.view.grid.origin[1] + self.view.grid.step[1] * f64::from(row);
        let [s, t, u] = &self.cast.sides;
        [s.ramp.of_row(y), t.ramp.of_row(y), u.ramp.of_row(y), self.cast.nearness.of_row(y)]
    }

    /// Draws what is in so many columns and rows from a pixel on.
    #[inline(always)]
    fn run<const COLUMNS: usize>(
        &self,
        band: &mut Band,
        of_row: &[f64; 4],
        [first, row]: [u32; 2],
        count: [u32; 2],
    ) {
        let x = self.view.grid.origin[0] + self.view.grid.step[0] * f64::from(first);
        let [s, t, u] = &self.cast.sides;
        let run = Run {
            cast: self.cast,
            item: Band::item(self.touched.primitive),
            starts: [
                s.ramp.at(of_row[0], x) as f32,
                t.ramp.at(of_row[1], x) as f32,
                u.ramp.at(of_row[2], x) as f32,
                self.cast.nearness.at(of_row[3], x) as f32,
            ],
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
    let [s, t, u] = [&cast.sides[0].ramp, &cast.sides[1].ramp, &cast.sides[2].ramp];
    let w = &cast.nearness;
    let columns_and_rows = [count[0] as f32, count[1] as f32];
    let (mut low, mut high) = ([0.0; LANES], [0.0; LANES]);
    let (mut touched, mut may_show, mut inside) = ([0; LANES], [0; LANES], [0; LANES]);
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
