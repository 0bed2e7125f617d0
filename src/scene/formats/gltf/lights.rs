//! Lights of `KHR_lights_punctual`.

use super::nodes::Placed;
use super::schema::{Document, LightEntry, SpotCone};
use crate::scene::formats::text::printable;
use crate::scene::light::direction_of;
use crate::scene::{Cone, DirectionalLight, Emitter, Falloff, Light, PointLight, SpotLight};
use glam::{DVec3, Vec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// The light of a node. Lights look along -z of their node; its matrix turns and scales that direction.
///
/// # Errors
/// A line if there is no such light or its numbers make none.
pub(super) fn read(document: &Document, placed: &Placed, index: u64) -> Result<Light, String> {
    let lights: &[LightEntry] = document.extensions.lights.as_ref().map_or(&[], |all| &all.lights);
    let entry = usize::try_from(index).ok().and_then(|i| lights.get(i));
    let entry = entry.ok_or_else(|| format!("light {index} of {}", lights.len()))?;
    let given = placed.node.name.as_deref().or(entry.name.as_deref());
    let name = given.map_or_else(|| format!("light-{index}"), printable);
    let emitter = emitter(entry, placed).map_err(|why| format!("light {index}: {why}"))?;
    Ok(Light { name, emitter })
}

fn emitter(entry: &LightEntry, placed: &Placed) -> Result<Emitter, String> {
    let z_axis = placed.world.matrix3.z_axis;
    match entry.kind.as_str() {
        "point" => Ok(Emitter::Point(point(entry, placed)?)),
        "spot" => {
            let point = point(entry, placed)?;
            Ok(Emitter::Spot(SpotLight { point, cone: cone(&entry.spot, direction(-z_axis)?)? }))
        }
        "directional" => {
            let irradiance = strength(entry)?;
            Ok(Emitter::Directional(DirectionalLight { towards: direction(z_axis)?, irradiance }))
        }
        other => Err(format!("expected point, spot or directional, found `{}`", printable(other))),
    }
}

fn strength(entry: &LightEntry) -> Result<[f32; 3], String> {
    let factor = entry.intensity.unwrap_or(1.0);
    let strength = entry.color.unwrap_or([1.0; 3]).map(|channel| (channel * factor) as f32);
    match strength.iter().all(|channel| *channel >= 0.0 && channel.is_finite()) {
        true => Ok(strength),
        false => Err("expected a colour and an intensity from 0 up".into()),
    }
}

fn point(entry: &LightEntry, placed: &Placed) -> Result<PointLight, String> {
    let falloff = match entry.range.map(|range| range as f32) {
        None => Falloff::InverseSquare,
        Some(range) if range > 0.0 && range.is_finite() => Falloff::Range(range),
        Some(_) => return Err("expected a range above 0".into()),
    };
    let position = placed.world.translation.as_vec3();
    match position.is_finite() {
        true => Ok(PointLight { position, intensity: strength(entry)?, falloff }),
        false => Err("its position is out of range".into()),
    }
}

/// A direction of the world, rounded once.
fn direction(exact: DVec3) -> Result<Vec3, String> {
    direction_of(exact).ok_or_else(|| "its node's transform leaves no direction to shine in".into())
}

/// The cone of an inner and an outer angle.
fn cone(cone: &SpotCone, axis: Vec3) -> Result<Cone, String> {
    /// A right angle as exporters write it that compute in f32, a little above the one in f64.
    const WIDEST: f64 = std::f32::consts::FRAC_PI_2 as f64;
    let inner = cone.inner_cone_angle.unwrap_or(0.0);
    let outer = cone.outer_cone_angle.unwrap_or(FRAC_PI_4);
    if !(0.0 <= inner && inner <= outer && outer > 0.0 && outer <= FRAC_PI_2.max(WIDEST)) {
        return Err(format!(
            "expected 0 <= innerConeAngle <= outerConeAngle <= pi/2, found {inner} and {outer}"
        ));
    }
    Ok(Cone::new(axis, libm::cos(inner), libm::cos(outer)))
}
