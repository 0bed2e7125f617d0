//! What rays from one point meet first.

use super::{EmbreeScene, QueryOptions, ShadowRay, call, ffi};
use crate::{Error, Result};

/// In place of a primitive where a ray meets none.
pub const NO_HIT: u32 = ffi::LB_NO_PRIMITIVE;

/// Rays that have been found to be fit for Embree, which can be done before a clock starts.
#[derive(Debug, Clone, Copy)]
pub struct CheckedDirections<'a> {
    origin: [f32; 3],
    directions: &'a [[f32; 3]],
}

impl<'a> CheckedDirections<'a> {
    /// Rays from `origin` without end, in directions that need not have length 1.
    ///
    /// # Errors
    ///
    /// The first that is not finite, is beyond Embree's range, or has no direction.
    pub fn new(origin: [f32; 3], directions: &'a [[f32; 3]]) -> Result<CheckedDirections<'a>> {
        let is_valid = |d: &[f32; 3]| ShadowRay::is_in_range(*d) && *d != [0.0; 3];
        if !ShadowRay::is_in_range(origin) {
            return Err(Error::Embree(format!("rays begin beyond its range: {origin:?}")));
        }
        match directions.iter().position(|direction| !is_valid(direction)) {
            Some(ray) => Err(Error::Embree(format!("ray {ray} has no direction: {:?}", directions[ray]))),
            None => Ok(CheckedDirections { origin, directions }),
        }
    }

    /// The directions.
    pub fn directions(&self) -> &'a [[f32; 3]] {
        self.directions
    }

    /// Some of them.
    pub fn part(&self, range: std::ops::Range<usize>) -> CheckedDirections<'a> {
        CheckedDirections { directions: &self.directions[range], ..*self }
    }
}

impl EmbreeScene {
    /// `primitives[i]` becomes the triangle that ray i meets first, or [`NO_HIT`]. Runs on this thread; the scene may be
    /// asked by others at the same time.
    ///
    /// # Errors
    ///
    /// Slices of different lengths, a scene with curved surfaces or holes, streams where there are none, or whatever Embree
    /// reports. What is in `primitives` then means nothing.
    pub fn first_hits(
        &self,
        rays: CheckedDirections<'_>,
        options: QueryOptions,
        primitives: &mut [u32],
    ) -> Result<()> {
        let count = rays.directions.len();
        if count != primitives.len() {
            return Err(Error::Embree(format!("{count} rays have {} answers", primitives.len())));
        }
        if !self.is_of_whole_triangles() {
            return Err(Error::Embree("first hits are asked of triangles alone, without holes".into()));
        }
        // SAFETY: the scene lives as long as `self`; the origin has three floats, the directions three each, and there
        // are as many answers as rays.
        call(|error| unsafe {
            ffi::lb_scene_first_hits(
                self.as_ptr(),
                rays.origin.as_ptr(),
                rays.directions.as_flattened().as_ptr(),
                count,
                options.grouping_code(),
                options.flags(),
                primitives.as_mut_ptr(),
                error,
            )
        })
    }
}
