//! Lights.

use super::document::name_of;
use super::schema::{FalloffName, LightEntry, LightKind};
use super::transforms::sin_cos_degrees;
use super::values::{Number, Strength};
use crate::scene::light::direction_of;
use crate::scene::{Cone, DirectionalLight, Emitter, Falloff, Light, PointLight, SpotLight};
use glam::Vec3;

/// The light of a table; `index` counts from 0 and names it if it has no name.
///
/// # Errors
/// A line for keys that are missing, contradict each other or belong to another kind, and for angles that
/// make no cone.
pub(super) fn read(entry: &LightEntry, index: usize) -> Result<Light, String> {
    let emitter = match entry.kind {
        LightKind::Point => {
            refuse(entry, &["direction", "target", "inner_degrees", "outer_degrees"], "spot")?;
            Emitter::Point(point(entry)?)
        }
        LightKind::Spot => {
            let point = point(entry)?;
            let axis = axis(entry, point.position)?;
            Emitter::Spot(SpotLight { cone: cone(entry, axis)?, point })
        }
        LightKind::Directional => directional(entry)?,
    };
    Ok(Light { name: name_of("light", index, entry.name.as_deref()), emitter })
}

/// Whether a key is there, of those that not every kind has.
fn has(entry: &LightEntry, key: &str) -> bool {
    match key {
        "position" => entry.position.is_some(),
        "intensity" => entry.intensity.is_some(),
        "falloff" => entry.falloff.is_some(),
        "range" => entry.range.is_some(),
        "direction" => entry.direction.is_some(),
        "target" => entry.target.is_some(),
        "inner_degrees" => entry.inner_degrees.is_some(),
        "outer_degrees" => entry.outer_degrees.is_some(),
        "towards" => entry.towards.is_some(),
        "irradiance" => entry.irradiance.is_some(),
        _ => unreachable!("no key of a light"),
    }
}

/// Refuses keys of other kinds: what they ask for would not be done.
fn refuse(entry: &LightEntry, keys: &[&str], kinds: &str) -> Result<(), String> {
    match keys.iter().find(|key| has(entry, key)) {
        Some(key) => Err(format!("`{key}` is for {kinds} lights")),
        None => Ok(()),
    }
}

fn strength(given: Option<Strength>) -> [f32; 3] {
    given.map_or([1.0; 3], |strength| strength.0)
}

fn point(entry: &LightEntry) -> Result<PointLight, String> {
    refuse(entry, &["towards", "irradiance"], "directional")?;
    let position = entry.position.ok_or("expected a `position`, found none")?.0;
    let range = entry.range.map(|Number(range)| range as f32);
    let falloff = match (entry.falloff, range) {
        (None | Some(FalloffName::InverseSquare), None) => Falloff::InverseSquare,
        (None | Some(FalloffName::InverseSquare), Some(range)) if range > 0.0 && range.is_finite() => {
            Falloff::Range(range)
        }
        (None | Some(FalloffName::InverseSquare), Some(_)) => {
            return Err("expected a range above 0 and in the range of 32-bit floats".into());
        }
        (Some(FalloffName::None), None) => Falloff::Constant,
        (Some(FalloffName::None), Some(_)) => {
            return Err("expected either `range` or `falloff = \"none\"`, found both".into());
        }
    };
    Ok(PointLight { position, intensity: strength(entry.intensity), falloff })
}

fn axis(entry: &LightEntry, position: Vec3) -> Result<Vec3, String> {
    match (entry.direction, entry.target) {
        (Some(direction), None) => Ok(direction.0),
        (None, Some(target)) => direction_of(target.0.as_dvec3() - position.as_dvec3())
            .ok_or_else(|| "`position` and `target` leave no direction to shine in".into()),
        (None, None) => Err("expected a `direction` or a `target`, found neither".into()),
        (Some(_), Some(_)) => Err("expected either `direction` or `target`, found both".into()),
    }
}

fn cone(entry: &LightEntry, axis: Vec3) -> Result<Cone, String> {
    let inner = entry.inner_degrees.map_or(0.0, |Number(degrees)| degrees);
    let outer = entry.outer_degrees.map_or(45.0, |Number(degrees)| degrees);
    if !(0.0 <= inner && inner <= outer && 0.0 < outer && outer <= 90.0) {
        return Err(format!(
            "expected 0 <= inner_degrees <= outer_degrees <= 90 and a cone, found {inner} and {outer}"
        ));
    }
    Ok(Cone::new(axis, sin_cos_degrees(inner).1, sin_cos_degrees(outer).1))
}

fn directional(entry: &LightEntry) -> Result<Emitter, String> {
    refuse(entry, &["position", "intensity", "falloff", "range"], "point and spot")?;
    refuse(entry, &["target", "inner_degrees", "outer_degrees"], "spot")?;
    let towards = match (entry.direction, entry.towards) {
        (Some(direction), None) => -direction.0,
        (None, Some(towards)) => towards.0,
        (None, None) => return Err("expected a `direction` or `towards`, found neither".into()),
        (Some(_), Some(_)) => return Err("expected either `direction` or `towards`, found both".into()),
    };
    Ok(Emitter::Directional(DirectionalLight { towards, irradiance: strength(entry.irradiance) }))
}
