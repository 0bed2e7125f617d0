//! Metallic-roughness materials as Lambert and Phong terms.

use super::schema::MaterialEntry;
use crate::scene::formats::text::printable;
use crate::scene::{Coverage, Material, Transmission};

/// `material 3`, with its name if it has one.
pub(super) fn describe(entry: &MaterialEntry, index: usize) -> String {
    match &entry.name {
        Some(name) => format!("material {index} `{}`", printable(name)),
        None => format!("material {index}"),
    }
}

/// The index of refraction of a material that has a `KHR_materials_ior` and does not say one there.
const USUAL_INDEX: f64 = 1.5;

/// Reflectance of a dielectric seen head-on, the specification's constant.
const DIELECTRIC: f64 = 0.04;

/// The nearest Phong material.
///
/// Diffuse is the base colour, also of a metal: there are no surroundings for it to mirror, and it would be
/// black. The exponent is `2 / roughness^4 - 2`, the one whose lobe is as wide as that of the specification's
/// microfacets. The weight is the reflectance seen head-on times `(exponent + 8) / 8`, which keeps the energy
/// of the lobe while it narrows, and at most 1.
///
/// What passes through is what [`transmission`] says, and diffuse what is left.
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
    let (transmission, opaque) = transmission(entry, base);
    Material {
        name: entry.name.as_deref().map_or_else(|| format!("material {index}"), printable),
        diffuse: base.map(|channel| (channel * opaque) as f32),
        specular: base.map(weight),
        shininess: shininess as f32,
        coverage,
        transmission,
        ..Material::default()
    }
}

/// Whether a material is blended with what is behind it by one alpha for all of its surface. Where a texture
/// has another in each texel, [`alpha`](super::alpha) decides.
pub(super) fn is_evenly_blended(entry: &MaterialEntry) -> bool {
    entry.alpha_mode.as_deref() == Some("BLEND") && entry.pbr_metallic_roughness.base_color_texture.is_none()
}

/// What passes through a surface, and the share of the base colour that it reflects.
///
/// A surface of alpha A lets 1 - A of the light behind it pass, of all colours and straight on, as viewers
/// blend it. `KHR_materials_transmission` lets its factor of the rest pass, coloured by the base colour. That is
/// bent if the file has a `KHR_materials_ior` and nothing is blended; without one the surface is a thin sheet.
fn transmission(entry: &MaterialEntry, base: [f64; 3]) -> (Option<Transmission>, f64) {
    let factor = entry.pbr_metallic_roughness.base_color_factor;
    let alpha = match is_evenly_blended(entry) {
        true => factor.map_or(1.0, |[.., alpha]| alpha.clamp(0.0, 1.0)),
        false => 1.0,
    };
    let passing = entry.extensions.transmission.as_ref().and_then(|given| given.transmission_factor);
    let passing = passing.unwrap_or(0.0).clamp(0.0, 1.0);
    if alpha == 1.0 && passing == 0.0 {
        return (None, 1.0);
    }
    let ior = entry.extensions.ior.as_ref().map(|given| given.ior.unwrap_or(USUAL_INDEX));
    // 0 stands for one without end, and what is below 1 is out of range.
    let ior = ior.map_or(1.0, |ior| if (1.0..=1e6).contains(&ior) { ior } else { USUAL_INDEX });
    let transmission = Transmission {
        transmittance: base.map(|channel| (1.0 - alpha + alpha * passing * channel) as f32),
        refractive_index: if alpha < 1.0 { 1.0 } else { ior as f32 },
    };
    (Some(transmission), alpha * (1.0 - passing))
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
        let passing = |json: &str| {
            let found = material(json);
            (found.diffuse, found.transmission.map(|t| (t.transmittance, t.refractive_index)))
        };
        let blended =
            r#"{"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 0.25]}}"#;
        assert_eq!(passing(blended), ([0.25, 0.125, 0.0], Some(([0.75; 3], 1.0))));
        let masked = blended.replace("BLEND", "MASK");
        assert_eq!(passing(&masked), ([1.0, 0.5, 0.0], None));
        assert_eq!(passing(&blended.replace("0.25", "1")), ([1.0, 0.5, 0.0], None));
        let glass = |extensions: &str| {
            let factor = r#""pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1]}"#;
            passing(&format!(r#"{{{factor}, "extensions": {{{extensions}}}}}"#))
        };
        let sheet = r#""KHR_materials_transmission": {"transmissionFactor": 0.5}"#;
        assert_eq!(glass(sheet), ([0.5, 0.25, 0.0], Some(([0.5, 0.25, 0.0], 1.0))));
        for (ior, expected) in
            [(r#""ior": 1.25"#, 1.25), ("", 1.5), (r#""ior": 0"#, 1.5), (r#""ior": -1e300"#, 1.5)]
        {
            let found = glass(&format!(r#"{sheet}, "KHR_materials_ior": {{{ior}}}"#));
            assert_eq!(found.1, Some(([0.5, 0.25, 0.0], expected)), "{ior}");
        }
        for none in ["", r#""KHR_materials_transmission": {}"#, r#""KHR_materials_ior": {"ior": 2}"#] {
            assert_eq!(glass(none), ([1.0, 0.5, 0.0], None), "{none}");
        }
        let mirror = material(r#"{"pbrMetallicRoughness": {"roughnessFactor": 0.0}}"#);
        assert_eq!((mirror.specular, mirror.shininess), ([1.0; 3], 1000.0));
    }
}
