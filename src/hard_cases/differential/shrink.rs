//! A failing recipe made small: what can go goes, and what stays becomes rounder, as long as the same is wrong.

use super::judge::{Depth, Disagreement, Judge, Kind};
use super::recipe::{Aim, Batch, Recipe, Settings, Threads};
use crate::geometry::LightPosition;
use crate::shadow::{Culling, ObjectCoherence, Resolution, VolumeThreshold};
use glam::Vec3;

/// Recipes that are tried at most.
const MOST_TRIALS: usize = 5_000;

/// Significant bits that coordinates are rounded to, one after the other.
const BITS: [u32; 5] = [1, 2, 4, 8, 16];

/// The smallest recipe that was found with the disagreement: of one settings, and where it can be of one point.
pub fn shrink(judge: &Judge, recipe: &Recipe, first: &Disagreement) -> Recipe {
    let mut shrinking = Shrinking { judge, kind: &first.kind, smallest: recipe.clone(), trials: 0 };
    shrinking.replace(Recipe { settings: vec![recipe.settings[first.settings]], ..recipe.clone() });
    let alone = first.aim.map_or(Vec::new(), |aim| vec![recipe.aims[aim]]);
    shrinking.replace(Recipe { aims: alone, ..shrinking.smallest.clone() });
    loop {
        let before = shrinking.smallest.clone();
        shrinking.drop_some(|recipe| recipe.settings.len(), |recipe, i| _ = recipe.settings.remove(i));
        shrinking.drop_some(|recipe| recipe.aims.len(), |recipe, i| _ = recipe.aims.remove(i));
        shrinking.drop_some(|recipe| recipe.parts.len(), |recipe, i| _ = recipe.parts.remove(i));
        shrinking.drop_some(Recipe::primitives, drop_primitive);
        shrinking.simplify_settings();
        shrinking.round();
        if shrinking.smallest == before || shrinking.trials >= MOST_TRIALS {
            return shrinking.smallest;
        }
    }
}

struct Shrinking<'j> {
    judge: &'j Judge<'j>,
    kind: &'j Kind,
    smallest: Recipe,
    trials: usize,
}

impl Shrinking<'_> {
    /// Keeps a smaller recipe if the same is wrong in it.
    fn replace(&mut self, smaller: Recipe) -> bool {
        if smaller == self.smallest
            || smaller.primitives() == 0
            || smaller.settings.is_empty()
            || self.trials >= MOST_TRIALS
        {
            return false;
        }
        self.trials += 1;
        let depth = if self.kind.who == "exact" { Depth::All } else { Depth::Native };
        let judged = self.judge.judge(&smaller, depth);
        let still = judged.disagreements.iter().any(|disagreement| disagreement.kind == *self.kind);
        if still {
            self.smallest = smaller;
        }
        still
    }

    /// Drops elements in runs that become shorter and shorter, down to one.
    fn drop_some(&mut self, count: impl Fn(&Recipe) -> usize, drop_one: impl Fn(&mut Recipe, usize)) {
        let mut run = count(&self.smallest).div_ceil(2);
        while run > 0 {
            let mut first = 0;
            while first < count(&self.smallest) {
                let mut smaller = self.smallest.clone();
                for i in (first..count(&smaller).min(first + run)).rev() {
                    drop_one(&mut smaller, i);
                }
                if !self.replace(smaller) {
                    first += run;
                }
            }
            run /= 2;
        }
    }

    fn simplify_settings(&mut self) {
        let simpler: [fn(&Settings) -> Settings; 5] = [
            |s| Settings { culling: Culling::Off, ..*s },
            |s| Settings { bounding_volumes: VolumeThreshold::Off, ..*s },
            |s| Settings { object_coherence: ObjectCoherence::Off, ..*s },
            |s| Settings { batch: Batch::All, ..*s },
            |s| Settings { threads: Threads::One, ..*s },
        ];
        for simpler in simpler {
            let settings = self.smallest.settings.iter().map(simpler).collect();
            self.replace(Recipe { settings, ..self.smallest.clone() });
        }
        for resolution in [1, 2, 3, 5, 16, 64, 256] {
            let settings = self.smallest.settings[0];
            let is_fewer = match settings.resolution {
                Resolution::Auto => true,
                Resolution::Cells(cells) => resolution < cells,
            };
            let resolution = Resolution::Cells(resolution);
            if is_fewer
                && self.replace(Recipe {
                    settings: vec![Settings { resolution, ..settings }],
                    ..self.smallest.clone()
                })
            {
                break;
            }
        }
    }

    /// Rounds coordinates, corner by corner wherever the corner is, so that what is shared stays so.
    fn round(&mut self) {
        for bits in BITS {
            let corners = self.smallest.parts.iter().flat_map(|part| part.triangles.as_flattened());
            let mut places: Vec<[u32; 3]> =
                corners.map(|corner| corner.to_array().map(f32::to_bits)).collect();
            places.sort_unstable();
            places.dedup();
            for place in places {
                let place = Vec3::from_array(place.map(f32::from_bits));
                for axis in 0..3 {
                    let mut smaller = self.smallest.clone();
                    let corners = smaller.parts.iter_mut().flat_map(|part| part.triangles.as_flattened_mut());
                    corners.filter(|corner| **corner == place).for_each(|corner| {
                        corner[axis] = rounded(corner[axis], bits);
                    });
                    if self.replace(smaller) {
                        // The corner is elsewhere now; the next round sees it there.
                        break;
                    }
                }
            }
            let light = match self.smallest.light {
                LightPosition::At(point) => LightPosition::At(all_rounded(point, bits)),
                LightPosition::Towards(way) => LightPosition::Towards(all_rounded(way, bits)),
            };
            self.replace(Recipe { light, ..self.smallest.clone() });
            for i in 0..self.smallest.aims.len() {
                let mut smaller = self.smallest.clone();
                smaller.aims[i] = match smaller.aims[i] {
                    Aim::At(point) => Aim::At(all_rounded(point, bits)),
                    Aim::Seen { eye, direction } => {
                        Aim::Seen { eye: all_rounded(eye, bits), direction: all_rounded(direction, bits) }
                    }
                };
                self.replace(smaller);
            }
        }
    }
}

/// Takes one triangle or curved surface away, counted through all parts.
fn drop_primitive(recipe: &mut Recipe, mut primitive: usize) {
    for part in &mut recipe.parts {
        let (flat, all) = (part.triangles.len(), part.triangles.len() + part.shapes.len());
        if primitive < flat {
            part.triangles.remove(primitive);
            return;
        } else if primitive < all {
            part.shapes.remove(primitive - flat);
            return;
        }
        primitive -= all;
    }
}

/// A number with so many significant bits. Rounding towards zero makes no direction from none, and none of one.
fn rounded(number: f32, bits: u32) -> f32 {
    f32::from_bits(number.to_bits() & (u32::MAX << (24 - bits)))
}

fn all_rounded(vector: Vec3, bits: u32) -> Vec3 {
    Vec3::from_array(vector.to_array().map(|number| rounded(number, bits)))
}
