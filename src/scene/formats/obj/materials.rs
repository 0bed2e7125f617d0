//! Material libraries (.mtl): the diffuse and specular terms.

use super::lines::{Lines, Verdict};
use crate::error::{Error, Place, Result};
use crate::scene::formats::text::printable;
use crate::scene::{Coverage, Material};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

/// What a library asks for and is not drawn, counted in materials or lines.
#[derive(Default)]
pub(super) struct NotDrawn {
    pub(super) textures: usize,
    pub(super) transparent: usize,
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
    let mut lines = Lines::new(bytes, |line: &str, _| {
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or("");
        let values: Vec<&str> = words.by_ref().take(4).collect();
        match keyword {
            "newmtl" => {
                material += 1;
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
            "Ns" | "d" => number(keyword, &values),
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
    not_drawn.transparent += parsed.0.iter().filter(|m| m.dissolve.is_some_and(|d| d < 1.0)).count();
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
        // `d -halo 0.5`: thinner towards the rim.
        ["-halo", ..] => Verdict::Replace(format!("{keyword} 0")),
        [value, ..] if is_finite_number(value) => Verdict::Pass,
        _ => Verdict::Refuse(format!("expected a finite number after `{keyword}`")),
    }
}

fn is_finite_number(text: &str) -> bool {
    text.parse::<f32>().is_ok_and(f32::is_finite)
}

/// The Lambert and Phong terms of a material. Models 0 and 1 of `illum` have no highlight.
pub(super) fn convert(material: &tobj::Material) -> Material {
    let plain = Material::default();
    let unit = |colour: [f32; 3]| colour.map(|c| c.clamp(0.0, 1.0));
    let matt = matches!(material.illumination_model, Some(0 | 1));
    Material {
        name: printable(&material.name),
        diffuse: material.diffuse.map_or(plain.diffuse, unit),
        specular: material.specular.filter(|_| !matt).map_or(plain.specular, unit),
        shininess: material.shininess.map_or(plain.shininess, |n| n.clamp(1.0, 1000.0)),
        coverage: Coverage::Solid,
        ..plain
    }
}
