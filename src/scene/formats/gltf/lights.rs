//! Point lights of `KHR_lights_punctual`.

use super::nodes::Placed;
use super::schema::{Document, LightEntry};
use crate::scene::formats::text::printable;
use crate::scene::{Falloff, Light, PointLight};

/// What a node shines with.
pub(super) enum Shining {
    /// A point light.
    Point(Light),
    /// A light of a kind that is not drawn: the kind and the light's name.
    Other(&'static str, String),
}

/// The light of a node.
///
/// # Errors
/// A line if there is no such light or its numbers make none.
pub(super) fn read(document: &Document, placed: &Placed, index: u64) -> Result<Shining, String> {
    let lights: &[LightEntry] = document.extensions.lights.as_ref().map_or(&[], |all| &all.lights);
    let entry = usize::try_from(index).ok().and_then(|i| lights.get(i));
    let entry = entry.ok_or_else(|| format!("light {index} of {}", lights.len()))?;
    let at = |why: String| format!("light {index}: {why}");
    let given = placed.node.name.as_deref().or(entry.name.as_deref());
    let name = given.map_or_else(|| format!("light-{index}"), printable);
    match entry.kind.as_str() {
        "point" => {}
        "directional" => return Ok(Shining::Other("directional", name)),
        "spot" => return Ok(Shining::Other("spot", name)),
        other => {
            return Err(at(format!("expected point, spot or directional, found `{}`", printable(other))));
        }
    }
    let strength = entry.intensity.unwrap_or(1.0);
    let intensity = entry.color.unwrap_or([1.0; 3]).map(|channel| (channel * strength) as f32);
    if !intensity.iter().all(|channel| *channel >= 0.0 && channel.is_finite()) {
        return Err(at("expected a colour and an intensity from 0 up".into()));
    }
    let falloff = match entry.range.map(|range| range as f32) {
        None => Falloff::InverseSquare,
        Some(range) if range > 0.0 && range.is_finite() => Falloff::Range(range),
        Some(_) => return Err(at("expected a range above 0".into())),
    };
    let position = placed.world.translation.as_vec3();
    if !position.is_finite() {
        return Err(at("its position is out of range".into()));
    }
    Ok(Shining::Point(Light::point(name, PointLight { position, intensity, falloff })))
}
