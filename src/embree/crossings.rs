//! Which transparent primitives rays pass through.

use super::{CheckedRays, EmbreeScene, QueryOptions, ShadowRay, call, ffi};
use crate::{Error, Result};

/// A transparent primitive that a ray passes through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct RayCrossing {
    /// Index of the ray.
    pub ray: u32,
    /// Number of the primitive: triangles first.
    pub primitive: u32,
    /// At how many points: once or, of a curved surface, up to twice.
    pub times: u32,
}

/// Crossings a ray that there is room for at first: nearly always enough, and still in the second cache.
const ROOM: usize = 16;

impl EmbreeScene {
    /// Puts into `found` which transparent primitives each of the segments meets, as Embree sees it, by ray and then
    /// by primitive. A ray that something opaque blocks passes through nothing.
    ///
    /// # Errors
    ///
    /// As [`occluded`](EmbreeScene::occluded).
    pub fn crossed(
        &self,
        rays: &[ShadowRay],
        options: QueryOptions,
        found: &mut Vec<RayCrossing>,
    ) -> Result<()> {
        CheckedRays::new(rays)?;
        self.check_excluded(rays)?;
        if u32::try_from(rays.len()).is_err() {
            return Err(Error::Embree(format!("{} rays are too many", rays.len())));
        }
        let mut blocked = vec![false; rays.len()];
        let mut crossings = vec![ffi::LbCrossing::default(); ROOM * rays.len()];
        loop {
            let count = self.collect(rays, options, &mut blocked, &mut crossings)?;
            if count <= crossings.len() {
                crossings.truncate(count);
                break;
            }
            // Asked once more, with enough room: every time, the same is found.
            crossings.resize(count, ffi::LbCrossing::default());
        }
        found.clear();
        let passed = crossings.iter().filter(|crossing| !blocked[crossing.ray as usize]);
        found.extend(passed.map(|c| RayCrossing { ray: c.ray, primitive: c.primitive, times: c.times }));
        found.sort_unstable();
        // Embree may come upon a primitive several times, in several leaves of its tree or in coherent packets, and
        // tells of it each time.
        found.dedup();
        Ok(())
    }

    /// Fills `crossings` as far as they go and returns how many there are; `blocked` is as long as `rays`, which are
    /// checked.
    fn collect(
        &self,
        rays: &[ShadowRay],
        options: QueryOptions,
        blocked: &mut [bool],
        crossings: &mut [ffi::LbCrossing],
    ) -> Result<usize> {
        assert_eq!(rays.len(), blocked.len());
        let mut count = 0;
        // SAFETY: the scene lives as long as `self`; `ShadowRay` is laid out as `LbRay`; there are as many answers as
        // rays, and what the shim writes into them is 0 or 1, which is a `bool`; there are as many crossings as said.
        call(|error| unsafe {
            ffi::lb_scene_crossed(
                self.as_ptr(),
                rays.as_ptr().cast(),
                rays.len(),
                options.grouping_code(),
                options.flags(),
                blocked.as_mut_ptr().cast(),
                crossings.as_mut_ptr(),
                crossings.len(),
                &mut count,
                error,
            )
        })?;
        Ok(count)
    }
}
