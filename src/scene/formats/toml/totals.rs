//! How much a scene holds, counted before any of it is placed.

use crate::memory::MemoryLimit;
use crate::scene::Scene;
use crate::scene::formats::estimate::Estimate;
use crate::scene::formats::limits::{MAX_ALL_TEXELS, MAX_CAMERAS, MAX_LIGHTS, MAX_OBJECTS};
use crate::scene::formats::limits::{MAX_CURVED, MAX_PLACEMENTS, MAX_TRIANGLES, MAX_VERTICES};

/// How much a file places, with everything that it includes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Totals {
    /// Of files.
    pub(super) placements: u64,
    pub(super) objects: u64,
    pub(super) triangles: u64,
    pub(super) curved: u64,
    pub(super) lights: u64,
    pub(super) cameras: u64,
}

impl Totals {
    /// A scene, placed once.
    pub(super) fn of(scene: &Scene) -> Totals {
        Totals {
            placements: 1,
            objects: scene.objects.len() as u64,
            triangles: scene.triangles.len() as u64,
            curved: scene.curved.len() as u64,
            lights: scene.lights.len() as u64,
            cameras: scene.cameras.len() as u64,
        }
    }

    /// Both together.
    ///
    /// # Errors
    /// A line if that is more than a scene may hold, or more than fits into memory.
    pub(super) fn plus(self, other: Totals, limit: MemoryLimit) -> Result<Totals, String> {
        let sum = |most: u64, what: &str, of: fn(&Totals) -> u64| {
            let sum = of(&self).saturating_add(of(&other));
            if sum > most { Err(format!("{sum} {what}, expected at most {most}")) } else { Ok(sum) }
        };
        let totals = Totals {
            placements: sum(MAX_PLACEMENTS, "included files", |totals| totals.placements)?,
            objects: sum(MAX_OBJECTS, "objects", |totals| totals.objects)?,
            triangles: sum(MAX_TRIANGLES, "triangles", |totals| totals.triangles)?,
            curved: sum(MAX_CURVED, "curved surfaces", |totals| totals.curved)?,
            lights: sum(MAX_LIGHTS as u64, "lights", |totals| totals.lights)?,
            cameras: sum(MAX_CAMERAS, "cameras", |totals| totals.cameras)?,
        };
        let Totals { objects, triangles, curved, lights, cameras, .. } = totals;
        let estimate = Estimate { objects, triangles, curved, named: lights + cameras, at_once: triangles };
        estimate.check(limit)?;
        Ok(totals)
    }
}

/// What all files together hold in memory, each of them once.
#[derive(Debug, Default)]
pub(super) struct Held {
    triangles: u64,
    curved: u64,
    vertices: u64,
    texels: u64,
}

impl Held {
    /// Counts one more file.
    ///
    /// # Errors
    /// A line if that is too much.
    pub(super) fn add(&mut self, scene: &Scene) -> Result<(), String> {
        let texels = scene.alpha_masks.iter().map(|mask| u64::from(mask.width) * u64::from(mask.height));
        for (held, more, most, what) in [
            (&mut self.triangles, scene.triangles.len() as u64, MAX_TRIANGLES, "triangles"),
            (&mut self.curved, scene.curved.len() as u64, MAX_CURVED, "curved surfaces"),
            (&mut self.vertices, scene.vertices.len() as u64, MAX_VERTICES, "vertices"),
            (&mut self.texels, texels.sum(), MAX_ALL_TEXELS, "texels of masks"),
        ] {
            *held = held.saturating_add(more);
            if *held > most {
                return Err(format!("{held} {what} in all files, expected at most {most}"));
            }
        }
        Ok(())
    }
}
