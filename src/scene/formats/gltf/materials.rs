//! Metallic-roughness materials as Lambert and Phong terms.

use super::schema::MaterialEntry;
use crate::scene::formats::text::printable;
use crate::scene::{Coverage, Material};

/// `material 3`, with its name if it has one.
pub(super) fn describe(entry: &MaterialEntry, index: usize) -> String {
    match &entry.name {
        Some(name) => format!("material {index} `{}`", printable(name)),
        None => format!("material {index}"),
    }
}

/// Reflectance of a dielectric seen head-on, the specification's constant.
const DIELECTRIC: f64 = 0.04;

/// The nearest Phong material.
///
/// Diffuse is the base colour, also of a metal: there are no surroundings for it to mirror, and it would be
/// black. The exponent is `2 / roughness^4 - 2`, the one whose lobe is as wide as that of the specification's
/// microfacets. The weight is the reflectance seen head-on times `(exponent + 8) / 8`, which keeps the energy
/// of the lobe while it narrows, and at most 1.
pub(super) fn convert(entry: &MaterialEntry, index: usize, coverage: Coverage) -> Material {
    let surface = &entry.pbr_metallic_roughness;
    let [r, g, b, _] = surface.base_color_factor.unwrap_or([1.0; 4]);
    let base = [r, g, b].map(|channel| channel.clamp(0.0, 1.0));
    let metallic = surface.metallic_factor.unwrap_or(1.0).clamp(0.0, 1.0);
    let roughness = surface.roughness_factor.unwrap_or(1.0).clamp(0.0, 1.0);
    let shininess = (2.0 / (roughness * roughness * roughness * roughness) - 2.0).clamp(1.0, 1000.0);
    let weight = |channel: f64| {
        let head_on = DIELECTRIC + (channel - DIELECTRIC) * metallic;
        (head_on * (shininess + 8.0) / 8.0).min(1.0) as f32
    };
    Material {
        name: entry.name.as_deref().map_or_else(|| format!("material {index}"), printable),
        diffuse: base.map(|channel| channel as f32),
        specular: base.map(weight),
        shininess: shininess as f32,
        coverage,
        ..Material::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(json: &str) -> Material {
        convert(&serde_json::from_str(json).unwrap(), 3, Coverage::Solid)
    }

    #[test]
    fn factors_become_phong_terms() {
        let plain = material("{}");
        assert_eq!((plain.name.as_str(), plain.diffuse, plain.shininess), ("material 3", [1.0; 3], 1.0));
        let json = r#"{"pbrMetallicRoughness":
            {"baseColorFactor": [0.5, 7.0, -1.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.5}}"#;
        let glossy = material(json);
        assert_eq!((glossy.diffuse, glossy.shininess), ([0.5, 1.0, 0.0], 30.0));
        assert_eq!(glossy.specular, [0.19; 3]);
        let mirror = material(r#"{"pbrMetallicRoughness": {"roughnessFactor": 0.0}}"#);
        assert_eq!((mirror.specular, mirror.shininess), ([1.0; 3], 1000.0));
    }
}
