//! Material libraries (.mtl): the diffuse and specular terms, and transparency.

use super::lines::{Lines, Verdict};
use crate::error::{Error, Place, Result};
use crate::scene::formats::text::printable;
use crate::scene::{Coverage, Material, Transmission};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

/// What a library asks for and is not drawn, counted in materials or lines.
#[derive(Default)]
pub(super) struct NotDrawn {
    pub(super) textures: usize,
    /// Materials that are thinner towards the rim.
    pub(super) halos: usize,
    /// Colours given as spectral curves or in CIE XYZ.
    pub(super) other_colours: usize,
}

/// The materials of a library and their indices by name.
pub(super) type Library = (Vec<tobj::Material>, HashMap<String, usize>);

/// Parses a library. Only lines that are read here reach `tobj`, which panics on a colour of one number.
///
/// # Errors
/// One line with file and line for numbers that are not numbers and names that are missing.
pub(super) fn parse(path: &Path, bytes: &[u8], not_drawn: &mut NotDrawn) -> Result<Library> {
    let mut textured = BTreeSet::new();
    let mut material = 0;
    let mut has_dissolve = false;
    let mut lines = Lines::new(bytes, |line: &str, _| {
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or("");
        let values: Vec<&str> = words.by_ref().take(4).collect();
        match keyword {
            "newmtl" => {
                material += 1;
                has_dissolve = false;
                match values.is_empty() {
                    true => Verdict::Refuse("expected a name after `newmtl`".into()),
                    false => Verdict::Pass,
                }
            }
            "Kd" | "Ks" if matches!(values.first(), Some(&("spectral" | "xyz"))) => {
                not_drawn.other_colours += 1;
                Verdict::Skip
            }
            "Kd" | "Ks" => colour(keyword, &values),
            "d" if values.first() == Some(&"-halo") => {
                not_drawn.halos += 1;
                Verdict::Skip
            }
            "d" => {
                has_dissolve = true;
                number(keyword, &values)
            }
            // Some programs write an opacity there: what `d` says counts.
            "Tr" if has_dissolve => Verdict::Skip,
            "Tr" => match number(keyword, &values) {
                Verdict::Pass => {
                    let transparency: f32 = values[0].parse().unwrap_or_default();
                    Verdict::Replace(format!("d {}", 1.0 - transparency))
                }
                verdict => verdict,
            },
            "Ns" | "Ni" => number(keyword, &values),
            "illum" => match values.first().map(|v| v.parse::<u8>()) {
                Some(Ok(_)) => Verdict::Pass,
                _ => Verdict::Refuse("expected a model from 0 to 10 after `illum`".into()),
            },
            _ if keyword.starts_with("map_") || matches!(keyword, "bump" | "norm" | "disp" | "decal") => {
                textured.insert(material);
                Verdict::Skip
            }
            // Everything else is about light that is not modelled.
            _ => Verdict::Skip,
        }
    });
    let parsed = tobj::load_mtl_buf(&mut lines);
    let line = lines.number();
    if let Some(why) = lines.refusal() {
        return Err(Error::input(path, Place::Line(line), why));
    }
    let parsed = parsed.map_err(|e| Error::input(path, Place::Line(line), e.to_string()))?;
    not_drawn.textures += textured.len();
    Ok(parsed)
}

fn colour(keyword: &str, values: &[&str]) -> Verdict {
    let channels = match values {
        // One number stands for three.
        [one] => [*one; 3],
        [r, g, b] => [*r, *g, *b],
        _ => {
            return Verdict::Refuse(format!(
                "expected three numbers after `{keyword}`, found {}",
                values.len()
            ));
        }
    };
    match channels.iter().find(|v| !is_finite_number(v)) {
        Some(bad) => Verdict::Refuse(format!("expected a finite number, found `{}`", printable(bad))),
        None => Verdict::Replace(format!("{keyword} {}", channels.join(" "))),
    }
}

fn number(keyword: &str, values: &[&str]) -> Verdict {
    match values {
        [value, ..] if is_finite_number(value) => Verdict::Pass,
        _ => Verdict::Refuse(format!("expected a finite number after `{keyword}`")),
    }
}

fn is_finite_number(text: &str) -> bool {
    text.parse::<f32>().is_ok_and(f32::is_finite)
}

/// The Lambert and Phong terms of a material, and what passes through it. Models 0 and 1 of `illum` have no
/// highlight; through 6 and 7 light is bent, and through all others it goes straight on. What is dissolved to d
/// lets 1 - d of all colours pass.
pub(super) fn convert(material: &tobj::Material) -> Material {
    let plain = Material::default();
    let unit = |colour: [f32; 3]| colour.map(|c| c.clamp(0.0, 1.0));
    let matt = matches!(material.illumination_model, Some(0 | 1));
    let dissolve = material.dissolve.unwrap_or(1.0).clamp(0.0, 1.0);
    let bends = matches!(material.illumination_model, Some(6 | 7));
    let index = material.optical_density.filter(|&index| bends && index > 0.0);
    let transmission = (dissolve < 1.0)
        .then(|| Transmission { transmittance: [1.0 - dissolve; 3], refractive_index: index.unwrap_or(1.0) });
    Material {
        name: printable(&material.name),
        diffuse: material.diffuse.map_or(plain.diffuse, unit).map(|channel| channel * dissolve),
        transmission,
        specular: material.specular.filter(|_| !matt).map_or(plain.specular, unit),
        shininess: material.shininess.map_or(plain.shininess, |n| n.clamp(1.0, 1000.0)),
        coverage: Coverage::Solid,
        ..plain
    }
}
