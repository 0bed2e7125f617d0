//! Queries against the headers of their cells.

use super::projection::Projector;
use super::receivers::OPEN;
use super::stored::Header;
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;

/// Headers of all cells, and how well depths are known that are held against them.
pub(super) struct Headers<'a> {
    pub projector: &'a Projector,
    /// No coordinate of a receiver is larger.
    pub size: f32,
    pub headers: &'a [Header],
}

for_instruction_sets! {
    /// Sets `occluded` and `undecided` for receivers by their cells and depths. A receiver in the light, without a cell, is
    /// lit: nothing is between the two.
    pub(super) fn decide = decide_body, (
        headers: &Headers<'_>,
        cells: &[u32],
        depths: &[f32],
        occluded: &mut [bool],
        undecided: &mut [bool],
    )
}

#[inline(always)]
fn decide_body(
    _: InstructionSet,
    all: &Headers<'_>,
    cells: &[u32],
    depths: &[f32],
    occluded: &mut [bool],
    undecided: &mut [bool],
) {
    let Some(last) = all.headers.len().checked_sub(1) else { return occluded.fill(false) };
    let count = cells.len();
    let (depths, occluded, undecided) = (&depths[..count], &mut occluded[..count], &mut undecided[..count]);
    for i in 0..count {
        let cell = cells[i] as usize;
        // SAFETY: no more than the last.
        let header = unsafe { all.headers.get_unchecked(if cell < last { cell } else { last }) };
        let error = all.projector.error_of(all.size, depths[i]);
        // Comparisons with NaN are false.
        let is_lit = (depths[i] * (1.0 - error) > header.lit) | (cells[i] == OPEN);
        let is_dark = (depths[i] * (1.0 + error) < header.dark) & (error < 0.5) & (cells[i] != OPEN);
        occluded[i] = is_dark;
        undecided[i] = !(is_lit | is_dark);
    }
}
