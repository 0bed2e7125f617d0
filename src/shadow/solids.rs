//! The closed solids of a scene, for those that leave out their far sides (row 4 of the notes on the 1986
//! paper).

use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::geometry::planes::orientation;
use crate::geometry::solid::{self, Refusal, Solid};
use crate::geometry::{LightPosition, Sign};
use crate::scene::{Coverage, PrimitiveIndex, Scene};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The closed solids among what casts.
pub struct Solids {
    solids: Vec<Solid>,
    /// For each triangle of the scene its solid.
    of: Vec<Option<u32>>,
    /// Parts of objects that are no solids, counted by the reason.
    pub refused: BTreeMap<Refusal, usize>,
}

impl Solids {
    /// Examines every object that casts and has no holes.
    pub fn new(scene: &Scene) -> Solids {
        let _floats = StandardFloats::new();
        let parts: Vec<_> = scene
            .objects
            .par_iter()
            .in_standard_floats()
            .filter(|object| {
                let coverage = scene.materials[object.material as usize].coverage;
                object.shadowing.casts && !matches!(coverage, Coverage::Masked(_))
            })
            .map(|object| {
                let triangles = object.first..object.first + object.count;
                let corners: Vec<_> = triangles.clone().map(|t| scene.corners(t)).collect();
                (triangles, solid::recognise(&corners))
            })
            .collect();
        let mut found =
            Solids { solids: Vec::new(), of: vec![None; scene.triangles.len()], refused: BTreeMap::new() };
        for (triangles, parts) in parts {
            let number = |part: Result<Solid, Refusal>| match part {
                Ok(solid) => {
                    found.solids.push(solid);
                    Some(found.solids.len() as u32 - 1)
                }
                Err(refusal) => {
                    *found.refused.entry(refusal).or_default() += 1;
                    None
                }
            };
            let numbers: Vec<_> = parts.solids.into_iter().map(number).collect();
            for (triangle, part) in triangles.zip(parts.of) {
                found.of[triangle as usize] = numbers[part as usize];
            }
        }
        found
    }

    /// Number of solids.
    pub fn count(&self) -> usize {
        self.solids.len()
    }

    /// The far sides of all solids that a light is outside of.
    pub fn far_sides(&self, light: LightPosition) -> FarSides<'_> {
        let _floats = StandardFloats::new();
        let is_outside =
            self.solids.par_iter().map(|solid| solid.is_outside(light)).in_standard_floats().collect();
        FarSides { solids: self, light, is_outside }
    }
}

/// The triangles that one light can do without.
///
/// Let a segment from the light reach a point of such a triangle. Beside it, through the inside of that
/// triangle and past all edges, run segments that begin outside and arrive inside, so each of them enters the
/// solid before, through a triangle whose outer side the light is on. As they come nearer to the first one,
/// a triangle that they enter through again and again is reached by that too: not in the light, which is on
/// no triangle, and not behind the point. If that one is left out too, because it is cast for an exact copy
/// on the far side of another solid, the segments beside entered that solid still before, and so on. So
/// whatever lies beyond the point is in the shadow of a near side that is cast.
pub struct FarSides<'a> {
    solids: &'a Solids,
    light: LightPosition,
    is_outside: Vec<bool>,
}

impl FarSides<'_> {
    /// Whether a triangle belongs to a solid that the light is outside of, with the light strictly on its
    /// inner side.
    pub fn contains(&self, scene: &Scene, triangle: PrimitiveIndex) -> bool {
        let Some(solid) = self.solids.of[triangle as usize] else { return false };
        let outer_side = self.solids.solids[solid as usize].outer_side();
        self.is_outside[solid as usize]
            && orientation(self.light, scene.corners(triangle)) * outer_side == Sign::Negative
    }
}
