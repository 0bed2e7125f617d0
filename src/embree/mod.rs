//! Embree as oracle and as rival: scenes of triangles and curved surfaces, asked for occlusion in batches.
//!
//! A [`Device`] is Embree itself with its threads; an [`EmbreeScene`] is made of [`SceneParts`], built; and
//! [`EmbreeScene::occluded`] answers many [`ShadowRay`]s. [`EmbreeScene::crossed`] tells which transparent primitives
//! they pass through, and [`EmbreeScene::first_hits`] what rays from one point meet first. Beneath lies the C shim in `ffi/`, which hides whether it is Embree 3 or 4.
//!
//! Everything that can be chosen, for scenes and for queries, makes up an [`EmbreeMode`], which has a name.
//!
//! An **oracle** run wants [`Robustness::Robust`] and [`Receiver::Excluded`], so that a ray leaves the primitive
//! it starts on whatever its rounding. A **speed** run wants [`Receiver::Included`] and an epsilon as
//! [`ShadowRay::t_near`], since a registered filter costs time even where it changes nothing,
//! and perhaps [`Denormals::Flushed`], as Embree advises.
//!
//! The floating-point control word is, after every call, what it was before.

mod crossings;
mod curved;
mod device;
mod ffi;
mod first_hits;
mod holes;
mod mode;
mod query;
mod scene;

#[cfg(test)]
mod tests;

pub use crossings::RayCrossing;
pub use device::Device;
pub use first_hits::{CheckedDirections, NO_HIT};
pub use holes::{HoleMask, HoleWrap, Holes};
pub use mode::EmbreeMode;
pub use query::{CheckedRays, Coherence, Denormals, Grouping, PacketWidth, QueryOptions, ShadowRay};
pub use scene::{BuildQuality, EmbreeScene, Receiver, Robustness, SceneBuffers, SceneOptions, SceneParts};

use std::ffi::c_char;

use crate::{Error, Result};

/// Makes one call of the shim; what it fills in as its error becomes ours.
fn call(function: impl FnOnce(*mut ffi::LbError) -> u32) -> Result<()> {
    let mut error = ffi::LbError { text: [0; 256] };
    match function(&mut error) {
        ffi::LB_OK => Ok(()),
        status => {
            debug_assert_eq!(status, ffi::LB_FAILED);
            Err(Error::Embree(text_of(&error.text)))
        }
    }
}

fn text_of(text: &[c_char]) -> String {
    let bytes: Vec<u8> = text.iter().take_while(|&&c| c != 0).map(|&c| c as u8).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
