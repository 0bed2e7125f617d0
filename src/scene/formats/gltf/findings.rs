//! What a document asks for and is not drawn, or not as it says: one warning a feature.

use super::SUPPORTED;
use super::alpha::Presence;
use super::materials;
use super::schema::{Document, MaterialEntry};
use crate::scene::SceneBuilder;
use crate::scene::formats::text::{counted, printable};

/// Counts of what was found.
#[derive(Default)]
pub(super) struct Findings {
    pub(super) lights: usize,
    pub(super) thin: usize,
    pub(super) coloured: usize,
    pub(super) left_over: usize,
    pub(super) normals_replaced: usize,
    /// Triangles of materials that are nowhere opaque.
    pub(super) absent: usize,
    /// Animations of what another one moves already.
    pub(super) other_takes: usize,
    textures: usize,
    unreadable: usize,
    blended: usize,
    emissive: usize,
    /// Features by name, how many there are, and which is the first.
    others: Vec<(&'static str, usize, String)>,
}

impl Findings {
    /// Notes what a material asks for.
    pub(super) fn note(&mut self, entry: &MaterialEntry, presence: &Presence) {
        let surface = &entry.pbr_metallic_roughness;
        self.textures += usize::from(
            surface.base_color_texture.is_some()
                || surface.metallic_roughness_texture.is_some()
                || entry.normal_texture.is_some()
                || entry.occlusion_texture.is_some()
                || entry.emissive_texture.is_some()
                || entry.extensions.transmission.as_ref().is_some_and(|t| t.transmission_texture.is_some()),
        );
        self.unreadable += usize::from(*presence == Presence::Unreadable);
        let is_blended = entry.alpha_mode.as_deref() == Some("BLEND");
        self.blended += usize::from(is_blended && !materials::is_evenly_blended(entry));
        self.emissive += usize::from(entry.emissive_factor.is_some_and(|factor| factor != [0.0; 3]));
    }

    /// Notes a feature that is not supported, and which element asks for it.
    pub(super) fn not_drawn(&mut self, feature: &'static str, which: String) {
        match self.others.iter_mut().find(|(name, ..)| *name == feature) {
            Some((_, count, _)) => *count += 1,
            None => self.others.push((feature, 1, which)),
        }
    }

    /// Adds the warnings.
    pub(super) fn warn(&self, document: &Document, builder: &mut SceneBuilder) {
        for (feature, count, first) in &self.others {
            let which = if *count == 1 { first.clone() } else { format!("{first} and {} more", count - 1) };
            builder.warn(format!("{feature} are not supported yet ({which})"));
        }
        let ignored: Vec<String> = (document.extensions_used.iter())
            .filter(|name| !SUPPORTED.contains(&name.as_str()))
            .map(|name| printable(name))
            .collect();
        if let Some(first) = ignored.first() {
            let more =
                if ignored.len() == 1 { String::new() } else { format!(" and {} more", ignored.len() - 1) };
            builder.warn(format!("extensions that are not supported are passed over ({first}{more})"));
        }
        for (count, what, noun) in [
            (document.scenes.len().saturating_sub(1), "scenes other than the default are not drawn", "scene"),
            (self.other_takes, "animations of what an earlier one moves are not played", "animation"),
            (self.thin, "points and lines are not drawn", "primitive"),
            (self.left_over, "corners after the last whole triangle are not drawn", "corner"),
            (self.coloured, "vertex colours are not drawn, and their alpha is not looked at", "primitive"),
            (
                self.normals_replaced,
                "normals of zero or infinite length are replaced by the face's",
                "corner",
            ),
            (self.textures, "textures are not drawn", "material"),
            (self.unreadable, "alpha of textures that an extension brings is drawn opaque", "material"),
            (
                self.blended,
                "transparent textures count as there where their alpha is at least one half",
                "material",
            ),
            (self.absent, "surfaces that are nowhere opaque are left out", "triangle"),
            (self.emissive, "surfaces that glow give no light", "material"),
        ] {
            if count > 0 {
                builder.warn(format!("{what} ({})", counted(count, noun)));
            }
        }
    }
}
