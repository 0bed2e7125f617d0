//! One Embree scene for all lights.

use super::Embree;
use super::casters::{self, Casters};
use crate::embree::{Device, EmbreeMode, EmbreeScene, QueryOptions, Receiver, SceneBuffers};
use crate::error::Result;
use crate::float_environment::StandardFloats;
use crate::geometry::LightPosition;
use crate::scene::Scene;
use glam::Vec3;
use std::sync::Arc;

/// What casts in a scene, as Embree reads it: what a renderer that uses Embree would have in memory anyway.
pub struct Prepared {
    buffers: Arc<SceneBuffers>,
    casters: Arc<Casters>,
    diameter: f32,
}

impl Prepared {
    /// Copies what casts.
    ///
    /// # Errors
    /// Coordinates beyond Embree's range.
    pub fn new(scene: &Scene) -> Result<Prepared> {
        let _floats = StandardFloats::new();
        let casts = |&p: &u32| scene.object(p).shadowing.casts;
        let join = |(low, high): (Vec3, Vec3), (l, h): (Vec3, Vec3)| (low.min(l), high.max(h));
        let bounds = (0..scene.primitive_count()).filter(casts).filter_map(|p| scene.primitive_bounds(p));
        let (low, high) = bounds.reduce(join).unwrap_or_default();
        Ok(Prepared {
            buffers: Arc::new(casters::buffers(scene)?),
            casters: Arc::new(Casters::new(scene)),
            diameter: (high * 0.5 - low * 0.5).length() * 2.0,
        })
    }
}

/// Embree's hierarchy over everything that casts, which knows of no light.
pub struct Hierarchy {
    scene: Arc<EmbreeScene>,
    casters: Arc<Casters>,
    receiver: Receiver,
    diameter: f32,
}

impl Hierarchy {
    /// Builds it with a device's threads.
    ///
    /// # Errors
    /// A mode that this Embree lacks, or whatever it reports.
    pub fn new(device: &Device, prepared: &Prepared, mode: EmbreeMode) -> Result<Hierarchy> {
        let _floats = StandardFloats::new();
        mode.expect_in(device)?;
        Ok(Hierarchy {
            scene: Arc::new(EmbreeScene::of_buffers(device, &prepared.buffers, mode.scene)?),
            casters: prepared.casters.clone(),
            receiver: mode.scene.receiver,
            diameter: prepared.diameter,
        })
    }

    /// The tester of one light.
    pub fn at(&self, light: LightPosition, epsilon: f32, query: QueryOptions) -> Embree {
        Embree {
            scene: self.scene.clone(),
            query,
            light,
            epsilon,
            casters: self.casters.clone(),
            receiver: self.receiver,
            diameter: self.diameter,
        }
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.scene.bytes()
    }
}
