//! How a shadow-buffer is divided and looked up.

use super::sphere::Sphere;
use std::fmt::{Display, Formatter};
use std::path::Path;

/// Settings of a shadow-buffer. Other than those of the exact testers they decide answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadowBufferSettings {
    /// Cells from pole to pole.
    pub rows: u32,
    /// Cells around the axis.
    pub columns: u32,
    /// What is compared.
    pub lookup: Lookup,
    /// Over how many cells the answer is a mean.
    pub filter: FilterWidth,
    /// What distances may differ by.
    pub bias: DepthBias,
}

impl Default for ShadowBufferSettings {
    /// As in the paper: 400 x 800, by identity, without a filter.
    fn default() -> ShadowBufferSettings {
        ShadowBufferSettings {
            rows: 400,
            columns: 800,
            lookup: Lookup::Identity,
            filter: FilterWidth::OFF,
            bias: DepthBias::CellWidth,
        }
    }
}

impl Display for ShadowBufferSettings {
    /// In words that tell what an answer depends on: `400x800 identity`, `400x800 depth filter 5 bias 0.01`.
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let lookup = match self.lookup {
            Lookup::Identity => "identity",
            Lookup::Depth => "depth",
        };
        write!(f, "{}x{} {lookup}", self.rows, self.columns)?;
        if self.filter != FilterWidth::OFF {
            write!(f, " filter {}", self.filter.cells())?;
        }
        match self.bias {
            DepthBias::CellWidth => Ok(()),
            DepthBias::Share(share) => write!(f, " bias {share}"),
        }
    }
}

/// When a point is lit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Lookup {
    /// If the cell of its direction holds its own object, as published. Objects shadow no part of themselves, and
    /// a cell whose centre just misses an object is a false shadow on its silhouette.
    #[default]
    Identity,
    /// Unless what the cell holds is nearer to the light by more than the [`DepthBias`].
    Depth,
}

/// How much nearer than a point something must be to shadow it, as a share of the point's distance: a surface
/// that light grazes is nearer at one end of a cell than at the other, and would shadow itself. What is larger
/// than it must be lets light in where things touch.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum DepthBias {
    /// A quarter of the root of a cell's width in radians, times that of the filter. In proportion to the width
    /// it would be too little for the same surfaces however fine the cells are, as they grow finer with it; so
    /// both they and the gaps where things touch become fewer. 400 x 800 cells: 2.2 %, enough where light comes
    /// at 10 degrees or more to the surface.
    #[default]
    CellWidth,
    /// This share, from 0 to below 1.
    Share(f32),
}

impl DepthBias {
    /// As a share of a distance.
    pub(super) fn share(self, sphere: &Sphere, filter: FilterWidth) -> f64 {
        match self {
            DepthBias::CellWidth => {
                let width = sphere.cell_width() * f64::from(filter.cells());
                (0.25 * libm::sqrt(width)).min(0.5)
            }
            DepthBias::Share(share) => f64::from(share),
        }
    }
}

/// Percentage-closer filtering: the mean over so many by so many cells around that of a point, an odd number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FilterWidth(u32);

impl FilterWidth {
    /// One cell: no filter.
    pub const OFF: FilterWidth = FilterWidth(1);

    /// The widest filter.
    pub const MOST: u32 = 63;

    /// A filter of so many by so many cells; `None` unless that is odd and at most [`FilterWidth::MOST`].
    pub fn new(cells: u32) -> Option<FilterWidth> {
        (cells % 2 == 1 && cells <= FilterWidth::MOST).then_some(FilterWidth(cells))
    }

    /// Cells along a side.
    pub fn cells(self) -> u32 {
        self.0
    }
}

impl Default for FilterWidth {
    fn default() -> FilterWidth {
        FilterWidth::OFF
    }
}

/// Whether building a shadow-buffer writes or reads a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum BufferFile<'a> {
    /// Neither.
    #[default]
    Unused,
    /// It is filled and saved here.
    Save(&'a Path),
    /// It is loaded from here and not filled.
    Load(&'a Path),
}
