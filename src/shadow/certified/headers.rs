//! Queries against the headers of their cells.

use super::certificate::Header;
use super::dispatch::for_instruction_sets;
use super::projection::Projector;
use super::receivers::OPEN;

for_instruction_sets! {
    /// Sets `occluded` and `undecided` for receivers by their cells and depths. Coordinates of all are at most `size`. A
    /// receiver in the light, without a cell, is lit: nothing is between the two.
    pub(super) fn decide = decide_body, (
        projector: &Projector,
        size: f32,
        headers: &[Header],
        cells: &[u32],
        depths: &[f32],
        occluded: &mut [bool],
        undecided: &mut [bool],
    )
}

#[inline(always)]
fn decide_body(
    projector: &Projector,
    size: f32,
    headers: &[Header],
    cells: &[u32],
    depths: &[f32],
    occluded: &mut [bool],
    undecided: &mut [bool],
) {
    let Some(last) = headers.len().checked_sub(1) else { return occluded.fill(false) };
    let count = cells.len();
    let (depths, occluded, undecided) = (&depths[..count], &mut occluded[..count], &mut undecided[..count]);
    for i in 0..count {
        // SAFETY: no more than the last.
        let header = unsafe {
            headers.get_unchecked(if (cells[i] as usize) < last { cells[i] as usize } else { last })
        };
        let error = projector.error_of(size, depths[i]);
        // Comparisons with NaN are false.
        let is_lit = (depths[i] * (1.0 - error) > header.lit) | (cells[i] == OPEN);
        let is_dark = (depths[i] * (1.0 + error) < header.dark) & (error < 0.5) & (cells[i] != OPEN);
        occluded[i] = is_dark;
        undecided[i] = !(is_lit | is_dark);
    }
}
