//! Which triangles may be in front of a receiver, tile by tile: sixteen triangles at a time.

use super::bins::{Bins, Caller};
use super::corners::{Corners, LANES};
use super::is_plain;
use super::projection::{Projected, Projector, cell_and_border};
use super::receivers::Horizon;
use super::tiles::EDGE;
use super::windows::Windows;
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::masks::{Bits, bits};
use crate::scene::Scene;
use std::ops::Range;

/// The widest that a small triangle may be, in cells. The bounds for small ones hold for up to R of them.
const MOST: f32 = 24.0;

/// Which triangles of a scene are cast.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cast {
    All,
    /// Those that are [plain](is_plain).
    Plain,
}

/// A light's view of a scene.
pub(super) struct Survey<'a> {
    pub scene: &'a Scene,
    pub cast: Cast,
    /// For each triangle whether it is left out as a duplicate; of none if there is nothing here.
    pub duplicates: Vec<bool>,
    pub projector: Projector,
    /// Where anybody asks.
    pub windows: Windows,
    pub horizon: &'a Horizon,
    /// The scene's vertices.
    pub projected: &'a [Projected],
}

/// The tiles that sixteen triangles touch on their sides.
#[derive(Debug, Default)]
#[repr(C, align(64))]
struct Spans {
    /// First and last column of tiles, first and last row.
    columns: [[u32; LANES]; 2],
    rows: [[u32; LANES]; 2],
    /// Receivers with a smaller key are in front of all of it.
    key: [u32; LANES],
    /// Whether it lies on one side, and is small.
    on_one_side: [u32; LANES],
    small: [u32; LANES],
    /// The key of the tile, where it is one.
    tile_key: [u32; LANES],
}

impl Survey<'_> {
    #[inline(always)]
    fn spans(&self, corners: &Corners) -> Spans {
        let mut spans = Spans::default();
        let (delta, end) = (self.projector.delta, self.projector.resolution as f32);
        let keys = self.horizon.of_tiles();
        let last = keys.len() - 1;
        for i in 0..LANES {
            let [u, v] = corners.limits(i, delta);
            // At a seam it may touch the next side too, and its corners may even lie there.
            let is_inside = (u[0] > 0.0) & (u[1] < end) & (v[0] > 0.0) & (v[1] < end);
            let is_on_one_side = is_inside & (corners.side[i] != Projected::NOWHERE);
            let is_small = (u[1] - u[0] < MOST) & (v[1] - v[0] < MOST) & is_on_one_side;
            let tile = |x: f32| cell_and_border(x).0 / EDGE;
            let (columns, rows) = ([tile(u[0]), tile(u[1])], [tile(v[0]), tile(v[1])]);
            for end in 0..2 {
                spans.columns[end][i] = columns[end];
                spans.rows[end][i] = rows[end];
            }
            let key = Horizon::key(corners.w_limits(i)[1]);
            spans.key[i] = if is_on_one_side { key } else { 0 };
            spans.on_one_side[i] = u32::from(is_on_one_side);
            spans.small[i] = u32::from(is_small);
            let tile = self.windows.tile(corners.side[i], columns[0], rows[0]) as usize;
            let is_one = (columns[0] == columns[1]) & (rows[0] == rows[1]) & is_small;
            // SAFETY: no more than the last.
            let key = unsafe { *keys.get_unchecked(if tile < last { tile } else { last }) };
            spans.tile_key[i] = if is_one { key } else { u32::MAX };
        }
        spans
    }

    /// Calls for the tiles of a span with a receiver that the triangle may be in front of, until the call says that it is enough.
    #[inline(always)]
    fn each_tile(&self, spans: &Spans, lane: usize, side: u32, mut call: impl FnMut(u32) -> bool) {
        let ends = |of: &[[u32; LANES]; 2]| [of[0][lane], of[1][lane]];
        for (_, columns, first) in self.windows.rows(side, ends(&spans.columns), ends(&spans.rows)) {
            for tile in first..first + columns.len() as u32 {
                if self.horizon.of_tiles()[tile as usize] > spans.key[lane] && call(tile) {
                    return;
                }
            }
        }
    }

    #[inline(always)]
    fn sixteen(&self, set: InstructionSet, first: u32, count: usize, bins: &mut Bins) {
        let mut corners = Corners::default();
        for lane in 0..count {
            corners.set(lane, self.projected, self.scene.triangles[first as usize + lane].vertices);
        }
        let spans = self.spans(&corners);
        let mut asked = [0u32; LANES];
        for (i, asked) in asked.iter_mut().enumerate() {
            *asked = u32::from(spans.tile_key[i] > spans.key[i]);
        }
        let present = u32::MAX >> (32 - count);
        for lane in Bits(bits(set, &asked) & present) {
            let triangle = first + lane as u32;
            let is_duplicate = self.duplicates.get(triangle as usize) == Some(&true);
            if is_duplicate || (self.cast == Cast::Plain && !is_plain(self.scene, triangle)) {
                continue;
            }
            let side = corners.side[lane];
            if spans.small[lane] == 1 {
                self.each_tile(&spans, lane, side, |tile| {
                    bins.push(tile, Caller::Small(triangle));
                    false
                });
            } else if spans.on_one_side[lane] == 0 {
                self.survey_large(triangle, None, bins);
            } else {
                let mut is_asked = false;
                self.each_tile(&spans, lane, side, |_| {
                    is_asked = true;
                    true
                });
                if is_asked {
                    self.survey_large(triangle, Some(side), bins);
                }
            }
        }
    }
}

#[inline(always)]
fn survey_body(set: InstructionSet, survey: &Survey<'_>, triangles: Range<u32>, bins: &mut Bins<'_>) {
    let mut first = triangles.start;
    while first < triangles.end && !bins.overflowed {
        let count = (triangles.end - first).min(LANES as u32);
        survey.sixteen(set, first, count as usize, bins);
        first += count;
    }
}

for_instruction_sets! {
    /// Enters some triangles in all tiles in which they may be in front of a receiver.
    pub(super) fn survey = survey_body, (survey: &Survey<'_>, triangles: Range<u32>, bins: &mut Bins<'_>)
}
