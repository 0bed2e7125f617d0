//! Shadow rays and their answers.

use std::mem::offset_of;

use super::scene::LARGEST_COORDINATE;
use super::{EmbreeScene, call, ffi};
use crate::{Error, Result};

/// The segment `origin + t * direction`, `t_near <= t <= t_far`, in the space of the vertices. With `t_near > t_far` it
/// is empty and nothing blocks it. The direction need not have length 1: with the light minus the origin as direction,
/// `t_far` is 1 at the light.
///
/// A triangle met at exactly `t_far` blocks. One met at exactly `t_near` blocks in a robust scene and does not in a
/// fast one (Embree 3.13.5 and 4.3.3). Curved surfaces block at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct ShadowRay {
    /// Coordinates of magnitude below 1.844e18, as everywhere in Embree.
    pub origin: [f32; 3],
    /// At least 0, finite: the epsilon, in units of the direction's length.
    pub t_near: f32,
    /// Not zero; of the same range. Debian's Embree ends the program over a ray beyond it.
    pub direction: [f32; 3],
    /// At least 0; may be infinite.
    pub t_far: f32,
    /// Number of the primitive that it starts on, or [`ShadowRay::NO_PRIMITIVE`]. Read only if the scene was built with
    /// [`Receiver::Excluded`](super::Receiver::Excluded). A flat one never blocks. A curved one can block its own
    /// points: it is taken as passing through the origin, whatever the rounding, and blocks if the line meets it once
    /// more within the segment.
    pub excluded: u32,
}

// The shim reads these very bytes as its own type.
const _: () = {
    assert!(size_of::<ShadowRay>() == size_of::<ffi::LbRay>());
    assert!(align_of::<ShadowRay>() == align_of::<ffi::LbRay>());
    assert!(offset_of!(ShadowRay, origin) == offset_of!(ffi::LbRay, origin));
    assert!(offset_of!(ShadowRay, t_near) == offset_of!(ffi::LbRay, t_near));
    assert!(offset_of!(ShadowRay, direction) == offset_of!(ffi::LbRay, direction));
    assert!(offset_of!(ShadowRay, t_far) == offset_of!(ffi::LbRay, t_far));
    assert!(offset_of!(ShadowRay, excluded) == offset_of!(ffi::LbRay, excluded));
    assert!(ShadowRay::NO_PRIMITIVE == ffi::LB_NO_PRIMITIVE);
};

/// How many rays a packet has; those of the last packet that are not there are inactive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PacketWidth {
    /// Rays on their own.
    One,
    /// 4, the width of SSE and NEON.
    Four,
    /// 8, the width of AVX.
    Eight,
    /// 16, the width of AVX-512.
    Sixteen,
}

/// How rays go to Embree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grouping {
    /// In packets, which Embree traverses together. Widths for which the processor has no vectors that wide work too.
    Packets(PacketWidth),
    /// As arrays of up to 256 rays, which Embree groups as it likes. Embree 4 has none of it: see
    /// [`Device::has_streams`](super::Device::has_streams).
    Stream,
}

/// Whether neighbouring rays of a batch lie close together in space and direction: a hint about speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coherence {
    /// They do, as those of one light over an image.
    Coherent,
    /// They need not.
    Incoherent,
}

/// What becomes of denormal numbers while Embree answers, whatever the caller's mode is, which is back after the call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Denormals {
    /// They are numbers as any other.
    Kept,
    /// They are zero, as operands and as results (FTZ and DAZ), which is what Embree advises for speed. On
    /// processors other than x86-64 this changes nothing: see
    /// [`Device::flushes_denormals`](super::Device::flushes_denormals).
    Flushed,
}

/// How a scene is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueryOptions {
    /// How many rays go to Embree in one call.
    pub grouping: Grouping,
    /// What it is told about their neighbourhood.
    pub coherence: Coherence,
    /// What becomes of denormal numbers meanwhile.
    pub denormals: Denormals,
}

impl QueryOptions {
    pub(super) fn grouping_code(self) -> u32 {
        match self.grouping {
            Grouping::Packets(PacketWidth::One) => ffi::LB_PACKET_1,
            Grouping::Packets(PacketWidth::Four) => ffi::LB_PACKET_4,
            Grouping::Packets(PacketWidth::Eight) => ffi::LB_PACKET_8,
            Grouping::Packets(PacketWidth::Sixteen) => ffi::LB_PACKET_16,
            Grouping::Stream => ffi::LB_STREAM,
        }
    }

    pub(super) fn flags(self) -> u32 {
        let coherent = match self.coherence {
            Coherence::Coherent => ffi::LB_QUERY_COHERENT,
            Coherence::Incoherent => 0,
        };
        let flush = match self.denormals {
            Denormals::Kept => 0,
            Denormals::Flushed => ffi::LB_QUERY_FLUSH_DENORMALS,
        };
        coherent | flush
    }
}

impl ShadowRay {
    /// [`ShadowRay::excluded`] of a ray that every primitive may block.
    pub const NO_PRIMITIVE: u32 = u32::MAX;

    /// A segment that has no point, so that nothing blocks it.
    pub const EMPTY: ShadowRay = ShadowRay {
        origin: [0.0; 3],
        t_near: 1.0,
        direction: [0.0, 0.0, 1.0],
        t_far: 0.0,
        excluded: ShadowRay::NO_PRIMITIVE,
    };

    /// Whether a ray can begin at a point.
    pub fn is_in_range([x, y, z]: [f32; 3]) -> bool {
        (x.abs() < LARGEST_COORDINATE) & (y.abs() < LARGEST_COORDINATE) & (z.abs() < LARGEST_COORDINATE)
    }

    fn is_valid(&self) -> bool {
        let [x, y, z] = self.direction;
        ShadowRay::is_in_range(self.origin)
            & ShadowRay::is_in_range(self.direction)
            & ((x != 0.0) | (y != 0.0) | (z != 0.0))
            & (self.t_near >= 0.0)
            & self.t_near.is_finite()
            & (self.t_far >= 0.0)
    }

    fn excludes_one_of(&self, primitives: usize) -> bool {
        self.excluded == ShadowRay::NO_PRIMITIVE || (self.excluded as usize) < primitives
    }
}

/// Rays that have been found to be as [`ShadowRay`] says. Looking at a ray takes a good part of the time of a short
/// query, so it can be done before a clock starts.
#[derive(Debug, Clone, Copy)]
pub struct CheckedRays<'a>(&'a [ShadowRay]);

impl<'a> CheckedRays<'a> {
    /// # Errors
    ///
    /// The first ray that is not as [`ShadowRay`] says: not finite or beyond Embree's range, without direction,
    /// or with a negative end.
    pub fn new(rays: &'a [ShadowRay]) -> Result<CheckedRays<'a>> {
        // All of them without a branch, because nearly always all are valid.
        if rays.iter().fold(true, |valid, ray| valid & ray.is_valid()) {
            return Ok(CheckedRays(rays));
        }
        let ray = rays.iter().position(|ray| !ray.is_valid()).expect("one of them is not");
        Err(Error::Embree(format!("ray {ray} is no segment: {:?}", rays[ray])))
    }
}

impl EmbreeScene {
    /// `answers[i]` becomes whether a primitive that is not transparent meets the segment `rays[i]`, as Embree sees
    /// it. Runs on this thread; the scene may be asked by others at the same time.
    ///
    /// # Errors
    ///
    /// Slices of different lengths, a ray that is not as [`ShadowRay`] says, an excluded primitive that is not there,
    /// streams where there are none, or whatever Embree reports. The answers then mean nothing.
    pub fn occluded(&self, rays: &[ShadowRay], options: QueryOptions, answers: &mut [bool]) -> Result<()> {
        self.occluded_checked(CheckedRays::new(rays)?, options, answers)
    }

    /// As [`occluded`](EmbreeScene::occluded), for rays that were checked before: nothing but Embree's work and the
    /// loop around it.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn occluded_checked(
        &self,
        CheckedRays(rays): CheckedRays<'_>,
        options: QueryOptions,
        answers: &mut [bool],
    ) -> Result<()> {
        if rays.len() != answers.len() {
            return Err(Error::Embree(format!("{} rays have {} answers", rays.len(), answers.len())));
        }
        self.check_excluded(rays)?;
        // SAFETY: the scene lives as long as `self`; `ShadowRay` is laid out as `LbRay`; there are as many answers as
        // rays, and what the shim writes into them is 0 or 1, which is a `bool`.
        call(|error| unsafe {
            ffi::lb_scene_occluded(
                self.as_ptr(),
                rays.as_ptr().cast(),
                rays.len(),
                options.grouping_code(),
                options.flags(),
                answers.as_mut_ptr().cast(),
                error,
            )
        })
    }

    pub(super) fn check_excluded(&self, rays: &[ShadowRay]) -> Result<()> {
        if let Some(primitives) = self.excludable()
            && let Some(ray) = rays.iter().position(|ray| !ray.excludes_one_of(primitives))
        {
            return Err(Error::Embree(format!(
                "ray {ray} excludes primitive {} of {primitives}",
                rays[ray].excluded
            )));
        }
        Ok(())
    }
}
