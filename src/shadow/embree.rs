//! Debian's Embree as oracle and as rival.
//!
//! Both trace a float ray from the rounded point towards the light, as a renderer would, so part of their
//! error is the rounding of their input. `embree` is the oracle: a robust scene, the receiving triangle
//! excluded by a filter. `embree-fast` is the rival as renderers run it: a fast scene, no filter, nothing
//! between it and its speed.

use super::{Basis, BuildInput, Counters, ShadowTester, TesterEntry};
use crate::embree::{
    BuildQuality, Coherence, Device, PacketWidth, Receiver, Robustness, SceneOptions, ShadowRay,
    TriangleScene,
};
use crate::error::Result;
use crate::visibility::SurfacePoint;
use glam::Vec3;

/// `embree` in the registry.
pub const ROBUST: TesterEntry = TesterEntry {
    name: "embree",
    basis: Basis::Measured,
    build: |input| Ok(Box::new(Embree::new(input, Robustness::Robust, Receiver::Excluded)?)),
    expected_tests: |_, queries| 10.0 * queries,
};

/// `embree-fast` in the registry.
pub const FAST: TesterEntry = TesterEntry {
    name: "embree-fast",
    basis: Basis::Measured,
    build: |input| Ok(Box::new(Embree::new(input, Robustness::Fast, Receiver::Included)?)),
    expected_tests: |_, queries| 10.0 * queries,
};

/// The epsilon that renderers usually give it, as a share of the segment (pbrt's shadow epsilon).
pub const USUAL_EPSILON: f32 = 1e-4;

/// An Embree scene and one light.
pub struct Embree {
    scene: TriangleScene,
    light: Vec3,
    epsilon: f32,
}

impl Embree {
    /// Builds Embree's hierarchy over all triangles of the scene.
    ///
    /// # Errors
    /// Whatever Embree reports.
    pub fn new(input: &BuildInput, robustness: Robustness, receiver: Receiver) -> Result<Embree> {
        let device = Device::new(input.embree.threads)?;
        let vertices: Vec<[f32; 3]> = input.scene.vertices.iter().map(|v| v.to_array()).collect();
        let triangles: Vec<[u32; 3]> = input.scene.triangles.iter().map(|t| t.vertices).collect();
        let options = SceneOptions { robustness, quality: BuildQuality::Medium, receiver };
        let scene = TriangleScene::new(&device, &vertices, &triangles, options)?;
        Ok(Embree { scene, light: input.light, epsilon: input.embree.epsilon })
    }

    /// The ray that Embree is given for a point: not normalised, so that 1 is the light. `None` for a point
    /// whose rounding is the light itself, which no ray can ask for.
    pub fn ray(&self, point: &SurfacePoint) -> Option<ShadowRay> {
        let origin = point.position.as_vec3();
        let direction = self.light - origin;
        (direction != Vec3::ZERO && direction.is_finite()).then(|| ShadowRay {
            origin: origin.to_array(),
            t_near: self.epsilon,
            direction: direction.to_array(),
            t_far: 1.0 - self.epsilon,
            excluded: point.primitive().unwrap_or(ShadowRay::NO_TRIANGLE),
        })
    }
}

impl ShadowTester for Embree {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let rays: Vec<Option<ShadowRay>> = points.iter().map(|point| self.ray(point)).collect();
        if rays.iter().all(Option::is_some) {
            let rays: Vec<ShadowRay> = rays.into_iter().flatten().collect();
            self.scene.occluded(&rays, PacketWidth::Sixteen, Coherence::Coherent, answers)?;
        } else {
            answers.fill(false);
            let asked: Vec<usize> = (0..rays.len()).filter(|&i| rays[i].is_some()).collect();
            let rays: Vec<ShadowRay> = rays.into_iter().flatten().collect();
            let mut found = vec![false; rays.len()];
            self.scene.occluded(&rays, PacketWidth::Sixteen, Coherence::Coherent, &mut found)?;
            for (i, occluded) in asked.into_iter().zip(found) {
                answers[i] = occluded;
            }
        }
        Ok(Counters::default())
    }

    fn bytes(&self) -> usize {
        self.scene.bytes()
    }
}
