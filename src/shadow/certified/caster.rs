//! Triangles into cells.

use super::adjacency::Adjacency;
use super::dispatch::for_instruction_sets;
use super::entries::Bins;
use super::facing::Facing;
use super::projection::{Projected, Projector};
use super::receivers::Horizon;
use super::tiles::Tiles;
use crate::scene::Scene;
use std::ops::Range;

/// All that casting needs.
pub(super) struct Caster<'a> {
    pub scene: &'a Scene,
    pub adjacency: &'a Adjacency,
    pub projector: Projector,
    pub tiles: &'a Tiles,
    pub horizon: &'a Horizon,
    /// The scene's vertices.
    pub projected: &'a [Projected],
    /// How its triangles face the light.
    pub facing: &'a [Facing],
}

impl Caster<'_> {
    /// Edges 01, 12, 20 that are not regular (TRUTH, "Certified cells").
    ///
    /// Two triangles that run along their common edge in opposite directions have their third corners on different
    /// sides of the plane through the edge and the light exactly if both have the same orientation.
    #[inline(always)]
    pub(super) fn irregular(&self, triangle: u32, facing: Facing) -> [bool; 3] {
        self.adjacency.of(triangle).map(|across| {
            across.triangle().is_none_or(|(other, same_direction)| {
                let other = self.facing[other as usize];
                other == Facing::Nothing || (other == facing) == same_direction
            })
        })
    }

    #[inline(always)]
    fn cast_one(&self, triangle: u32, bins: &mut Bins) {
        let facing = self.facing[triangle as usize];
        if facing == Facing::Nothing {
            return;
        }
        let vertices = self.scene.triangles[triangle as usize].vertices;
        let corners = vertices.map(|vertex| self.projected[vertex as usize]);
        let [a, b, c] = corners.map(|corner| corner.side);
        if a == b
            && a == c
            && a != Projected::NOWHERE
            && let Some(cells) = self.small_box(corners)
        {
            self.cast_small(triangle, facing, corners, cells, bins);
        } else {
            self.cast_large(triangle, facing, bins);
        }
    }
}

#[inline(always)]
fn cast_body(caster: &Caster<'_>, triangles: Range<u32>, bins: &mut Bins<'_>) {
    for triangle in triangles {
        caster.cast_one(triangle, bins);
    }
}

for_instruction_sets! {
    /// Enters some triangles in all cells in which they may be in front of a receiver.
    pub(super) fn cast = cast_body, (caster: &Caster<'_>, triangles: Range<u32>, bins: &mut Bins<'_>)
}
