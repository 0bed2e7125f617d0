//! Alpha: where the surfaces of a material are there.
//!
//! With `alphaMode` MASK a texel is there if its alpha times that of `baseColorFactor` is at least
//! `alphaCutoff`. With BLEND it is there from one half on, where it is more there than not, if the material has
//! a texture. Both are decided here, in f64, texel by texel and without any filter. A material that is blended
//! and has none lets the same share of light pass everywhere, see [`materials`].

use super::accessors::Accessors;
use super::buffers::Buffers;
use super::images::{self, Spent};
use super::materials;
use super::schema::{Document, MaterialEntry};
use super::textures::{self, Placement};
use crate::memory::MemoryLimit;
use crate::scene::formats::text::printable;
use crate::scene::{AlphaMask, Coverage, SceneBuilder, Wrap};
use std::collections::BTreeMap;

/// From this alpha on a transparent surface counts as there.
const BLEND_CUTOFF: f64 = 0.5;

/// Where the surfaces of a material are there.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Presence {
    /// Everywhere.
    Solid,
    /// Nowhere.
    Absent,
    /// Where a mask says so.
    Masked(Masking),
    /// Unknown, since the texture is in a format that only an extension knows; drawn everywhere.
    Unreadable,
}

impl Presence {
    /// What the scene says of it; what is nowhere there is no part of the scene.
    pub(super) fn coverage(&self) -> Coverage {
        match self {
            Presence::Masked(masking) => Coverage::Masked(masking.mask),
            Presence::Solid | Presence::Absent | Presence::Unreadable => Coverage::Solid,
        }
    }
}

/// A mask and where a surface lies on it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Masking {
    /// What [`SceneBuilder::add_alpha_mask`] returned.
    pub(super) mask: u32,
    pub(super) placement: Placement,
}

/// What decides a mask: the image, how it goes on, and the bits of the factor and of the cutoff.
type Key = (u64, [Wrap; 2], u64, u64);

/// What an image comes to.
#[derive(Clone, Copy)]
enum Outcome {
    Solid,
    Absent,
    Mask(u32),
}

/// The masks of a document; materials that ask for the same share one.
pub(super) struct Masks<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    accessors: &'a Accessors<'a>,
    known: BTreeMap<Key, Outcome>,
    spent: Spent,
}

impl<'a> Masks<'a> {
    pub(super) fn new(
        document: &'a Document,
        buffers: &'a Buffers<'a>,
        accessors: &'a Accessors<'a>,
        limit: MemoryLimit,
    ) -> Masks<'a> {
        Masks { document, buffers, accessors, known: BTreeMap::new(), spent: Spent::within(limit) }
    }

    /// Where the surfaces of a material are there.
    ///
    /// # Errors
    /// A line if `alphaMode` is none, or the texture that decides it does not exist or cannot be read.
    pub(super) fn presence(
        &mut self,
        entry: &MaterialEntry,
        builder: &mut SceneBuilder,
    ) -> Result<Presence, String> {
        let cutoff = match entry.alpha_mode.as_deref().unwrap_or("OPAQUE") {
            "OPAQUE" => return Ok(Presence::Solid),
            "MASK" => entry.alpha_cutoff.unwrap_or(0.5),
            "BLEND" => BLEND_CUTOFF,
            other => {
                return Err(format!(
                    "alphaMode: expected OPAQUE, MASK or BLEND, found `{}`",
                    printable(other)
                ));
            }
        };
        let surface = &entry.pbr_metallic_roughness;
        let factor = surface.base_color_factor.map_or(1.0, |[.., alpha]| alpha.clamp(0.0, 1.0));
        if materials::is_evenly_blended(entry) {
            return Ok(if factor > 0.0 { Presence::Solid } else { Presence::Absent });
        }
        // No texel has more than the factor and none less than nothing: then no image is needed.
        if factor < cutoff {
            return Ok(Presence::Absent);
        }
        let Some(reference) = surface.base_color_texture.as_ref().filter(|_| cutoff > 0.0) else {
            return Ok(Presence::Solid);
        };
        let texture = textures::find(self.document, reference.index)?;
        let at = |why: String| format!("texture {}: {why}", reference.index);
        let wrap = textures::wrap(self.document, texture).map_err(at)?;
        let Some(image) = texture.source else { return Ok(Presence::Unreadable) };
        let key = (image, wrap, factor.to_bits(), cutoff.to_bits());
        let outcome = match self.known.get(&key) {
            Some(&outcome) => outcome,
            None => {
                let outcome = self.decide(image, wrap, |alpha| alpha * factor >= cutoff, builder);
                *self.known.entry(key).or_insert(outcome.map_err(at)?)
            }
        };
        Ok(match outcome {
            Outcome::Solid => Presence::Solid,
            Outcome::Absent => Presence::Absent,
            Outcome::Mask(mask) => Presence::Masked(Masking { mask, placement: Placement::of(reference) }),
        })
    }

    fn decide(
        &mut self,
        image: u64,
        wrap: [Wrap; 2],
        is_there: impl Fn(f64) -> bool,
        builder: &mut SceneBuilder,
    ) -> Result<Outcome, String> {
        let alpha = images::alpha(self.document, self.buffers, self.accessors, image, &mut self.spent)?;
        let Some(alpha) = alpha else { return Ok(Outcome::Solid) };
        let texels = u64::from(alpha.width) * u64::from(alpha.height);
        let mask =
            AlphaMask::new(alpha.width, alpha.height, wrap, |column, row| is_there(alpha.at(column, row)));
        Ok(match mask.opaque_texels() {
            0 => Outcome::Absent,
            opaque if opaque == texels => Outcome::Solid,
            _ => Outcome::Mask(builder.add_alpha_mask(mask)),
        })
    }
}
