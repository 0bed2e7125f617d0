//! What lies in the tiles of each level, and which tiles are divided.

use super::Certified;
use super::bins::{Bins, Budget, touched};
use super::by_triangle::States;
use super::levels::{FINER, Levels};
use super::lists::{Lister, Stored};
use super::making::Lists;
use super::projection::{Projected, Projector};
use super::receivers::Horizon;
use super::stored::{Header, Run};
use super::survey::Cast;
use super::tiles::AREA;
use super::windows::Windows;

/// Triangles in a tile above which it is divided.
const CROWD: usize = 16;

/// What is made at one level.
struct Layer<'b> {
    projector: Projector,
    windows: Windows,
    /// The scene's vertices.
    projected: Vec<Projected>,
    horizon: Horizon,
    bins: Vec<Bins<'b>>,
}

/// All levels, and the tiles that have cells.
pub(super) struct Layers<'b> {
    pub levels: Levels,
    pub cast: Cast,
    stored: Vec<Stored>,
    layers: Vec<Layer<'b>>,
}

/// Whether more triangles than [`CROWD`] lie in a tile.
pub(super) fn is_crowded(bins: &[Bins<'_>], tile: u32) -> bool {
    bins.iter().map(|bins| bins.callers_of(tile)).sum::<usize>() > CROWD
}

impl Certified<'_> {
    /// Levels of cells up to so many along an edge, or `None` if too many triangles lie in too many tiles. Each level has what lies in the tiles that
    /// are divided in the one before.
    pub(super) fn layers<'b>(
        &self,
        resolution: u32,
        levels: usize,
        budget: &'b Budget,
    ) -> Option<Layers<'b>> {
        let mut all = Layers {
            levels: Levels::new(Projector::new(self.light, resolution), levels),
            cast: Cast::All,
            stored: Vec::new(),
            layers: Vec::new(),
        };
        let mut horizon = Horizon::endless(&all.levels.grids[0]);
        for level in 0..levels {
            let coarser = FINER.pow((levels - 1 - level) as u32);
            let projector = Projector::new(self.light, resolution / coarser);
            let windows = Windows::whole(&all.levels.grids[level]);
            let projected = self.projected(&projector);
            let mut survey = self.survey(projector, windows, &horizon, &projected);
            let bins = self.bins(&mut survey, budget)?;
            all.cast = survey.cast;
            let next = all.divide(level, &bins);
            all.layers.push(Layer { projector, windows, projected, horizon, bins });
            let Some(next) = next else { break };
            horizon = next;
        }
        Some(all)
    }

    /// Lists of all cells, or `None` if they are too long.
    pub(super) fn lists_of(
        &self,
        all: &Layers<'_>,
        states: Option<&States>,
        budget: &Budget,
    ) -> Option<Lists> {
        let mut listers = Vec::with_capacity(all.layers.len());
        for layer in &all.layers {
            let Layer { projector, windows, projected, horizon, bins } = layer;
            let (scene, projector, windows) = (self.scene, *projector, *windows);
            listers.push(Lister { scene, projector, windows, horizon, projected, bins, budget });
        }
        let mut lists = self.lists(&listers, states, &all.stored)?;
        lists.shrink();
        Some(lists)
    }
}

impl Layers<'_> {
    /// Gives the tiles of a level cells, or divides them, and returns where the next level has any. Where no tile is crowded all are divided: a small
    /// scene needs few cells, however small they are.
    fn divide(&mut self, level: usize, bins: &[Bins<'_>]) -> Option<Horizon> {
        let windows = Windows::whole(&self.levels.grids[level]);
        let finer = self.levels.grids.get(level + 1).copied();
        let mut parts = Vec::new();
        let is_any_crowded = finer.is_some() && touched(bins, &windows).any(|tile| is_crowded(bins, tile));
        for tile in touched(bins, &windows) {
            if finer.is_some() && (is_crowded(bins, tile) || !is_any_crowded) {
                parts.extend(self.levels.divide(level, tile));
            } else {
                self.levels.place(level, tile, self.stored.len() as u32 * AREA);
                self.stored.push(Stored { level: level as u32, tile });
            }
        }
        finer.map(|grid| Horizon::endless_in(&grid, &parts))
    }

    /// Bytes of all cells without their lists.
    pub fn cell_bytes(&self) -> usize {
        self.stored.len() * AREA as usize * (size_of::<Header>() + size_of::<Run>())
    }

    /// The scene's vertices on the finest cells.
    pub fn into_finest(mut self) -> (Levels, Vec<Projected>) {
        let last = self.layers.pop().expect("at least one level");
        (self.levels, last.projected)
    }

    /// Bytes of what is needed while lists are made.
    pub fn bin_bytes(&self) -> usize {
        self.layers.iter().flat_map(|layer| &layer.bins).map(Bins::bytes).sum()
    }
}
