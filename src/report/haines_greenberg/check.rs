//! What the paper claims of shadow tests per ray, checked: they fall as the resolution rises, and as far below the
//! control's as in its tables.

use super::document::ColumnReport;
use super::paper::{RESOLUTIONS, Table};
use serde::Serialize;

/// The check of one environment.
#[derive(Debug, Clone, Serialize)]
pub struct Check {
    /// Whether tests per ray fall from each resolution that was measured to the next.
    pub falls: bool,
    /// Tests per ray of the control over those of the paper's finest light buffer, here.
    pub control_over_finest: f64,
    /// The same in the paper; null where it does not print the control's.
    pub paper_control_over_finest: Option<f64>,
    /// Tests per ray of the paper's coarsest light buffer over those of its finest, here.
    pub coarsest_over_finest: f64,
    /// The same in the paper.
    pub paper_coarsest_over_finest: f64,
    /// Whether they have fallen as far as in the paper at its finest resolution: relative to the control, or where
    /// that is not printed relative to the coarsest buffer.
    pub as_far_at_finest: bool,
    /// The finest resolution that was measured.
    pub last: u32,
    /// Tests per ray of the control over those at that resolution.
    pub control_over_last: f64,
    /// Whether they end as far down as they do in the paper, whose last resolution is its finest.
    pub ends_as_far: bool,
}

impl Check {
    /// Compares the columns of an environment with its table.
    pub fn new(table: &Table, columns: &[ColumnReport]) -> Check {
        let tests = |resolution: Option<u32>| {
            let column = columns.iter().find(|column| column.resolution == resolution);
            column.map_or(f64::NAN, |column| column.tests_per_ray)
        };
        let finest = tests(Some(RESOLUTIONS[3]));
        let (control, coarsest) = (over(tests(None), finest), over(tests(Some(RESOLUTIONS[0])), finest));
        let last = columns.iter().filter_map(|column| column.resolution).max().unwrap_or(RESOLUTIONS[3]);
        let ends = tests(Some(last));
        let (control_over_last, coarsest_over_last) =
            (over(tests(None), ends), over(tests(Some(RESOLUTIONS[0])), ends));
        let (paper_control, paper_coarsest) = (table.fall_from_control(), table.fall_from_coarsest());
        let buffers: Vec<f64> =
            columns.iter().filter(|c| c.resolution.is_some()).map(|c| c.tests_per_ray).collect();
        Check {
            falls: buffers.is_sorted_by(|coarser, finer| coarser > finer || *finer == 0.0),
            control_over_finest: control,
            paper_control_over_finest: paper_control,
            coarsest_over_finest: coarsest,
            paper_coarsest_over_finest: paper_coarsest,
            as_far_at_finest: paper_control.map_or(coarsest >= paper_coarsest, |paper| control >= paper),
            last,
            control_over_last,
            ends_as_far: paper_control
                .map_or(coarsest_over_last >= paper_coarsest, |paper| control_over_last >= paper),
        }
    }

    /// Whether tests per ray fall all the way, and end as far down as in the paper.
    pub fn holds(&self) -> bool {
        self.falls && self.ends_as_far
    }
}

/// A ratio; of nothing to nothing it is 1.
fn over(one: f64, other: f64) -> f64 {
    if one == other { 1.0 } else { one / other }
}
