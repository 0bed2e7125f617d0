//! Wavefront OBJ with its material libraries.
//!
//! `o` and `g` begin objects, a change of material within one begins another of the same name. Positions
//! stay shared between the triangles of an object as the file shares them, whatever normals they carry.
//! Polygons are cut into triangles, see [`polygon`](super::polygon).

mod lines;
mod materials;
mod tally;

use self::lines::Lines;
use self::materials::{Library, NotDrawn};
use self::tally::{Kind, Outline, Tally};
use super::confined::{self, Denial, Room};
use super::limits::{MAX_CONCAVE_CORNERS, MAX_MATERIAL_BYTES};
use super::shading_normals::{self, NO_NORMAL};
use super::text::{counted, printable};
use super::{file_stem, polygon, scene_name};
use crate::error::{Error, Place, Result};
use crate::scene::{ObjectInput, Scene, SceneBuilder, SmoothNormals};
use glam::Vec3;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;

/// What `tobj` calls an object without a name.
const UNNAMED: &str = "unnamed_object";

/// Reads an OBJ file.
///
/// # Errors
/// One line with file and line for whatever cannot be read as geometry, and for material libraries that lie
/// outside the file's folder. A missing library is a warning.
pub(super) fn load(path: &Path) -> Result<Scene> {
    let bytes = confined::read_scene(path)?;
    let room = Room::beside(path)?.with_budget(MAX_MATERIAL_BYTES);
    let libraries = RefCell::new(Libraries::default());
    let mut usage = MaterialUsage::default();
    let mut tally = Tally::default();
    let mut lines = Lines::new(&bytes, |line: &str, number: usize| {
        usage.note(line, number, &libraries.borrow().names);
        tally.inspect(line, number)
    });
    let parsed = tobj::load_obj_buf(&mut lines, &tobj::LoadOptions::default(), |name| {
        libraries.borrow_mut().load(path, &room, &name.to_string_lossy())
    });
    let (line, text, refusal) = (lines.number(), lines.text().into_owned(), lines.refusal());
    let libraries = libraries.into_inner();
    let at_line = |line: usize, why: String| Error::input(path, Place::Line(line), why);
    if let Some(error) = libraries.error {
        return Err(error);
    }
    if let Some(why) = refusal {
        return Err(at_line(line, why));
    }
    let (models, found) = parsed.map_err(|error| {
        let furthest = match error {
            tobj::LoadError::FaceVertexOutOfBounds => tally.furthest(Kind::Vertex),
            tobj::LoadError::FaceNormalOutOfBounds => tally.furthest(Kind::Normal),
            _ => None,
        };
        let (line, why) = furthest.unwrap_or_else(|| (line, explain(error, &text)));
        at_line(line, why)
    })?;
    if let Some((line, why)) = tally.out_of_range() {
        return Err(at_line(line, why));
    }

    let mut builder = SceneBuilder::new(scene_name(path));
    if let Some(missing) = &libraries.missing {
        builder.warn(format!("{missing}; its materials are drawn grey"));
    }
    for material in found.unwrap_or_default() {
        builder.add_material(materials::convert(&material));
    }
    let mut leftovers = Leftovers::default();
    let mut outlines = tally.outlines.iter().copied();
    for model in models.into_iter().filter(|model| !model.mesh.indices.is_empty()) {
        let name = if model.name == UNNAMED { file_stem(path) } else { printable(&model.name) };
        let place = || Place::Element(format!("object `{name}`"));
        let input = object(name.clone(), &model.mesh, &mut outlines, &mut leftovers)
            .map_err(|(line, why)| at_line(line, why))?;
        builder.add_object(input).map_err(|error| Error::input(path, place(), error.to_string()))?;
    }
    warn(&mut builder, &tally, &leftovers, &libraries.not_drawn, &usage);
    Ok(builder.finish())
}

/// What was wrong with a line, in words that help to mend it.
fn explain(error: tobj::LoadError, line: &str) -> String {
    let mut words = line.split_whitespace();
    let keyword = words.next().unwrap_or("");
    let numbers: Vec<&str> = words.collect();
    let not_a_number = numbers.iter().find(|word| word.parse::<f32>().is_err());
    match (error, not_a_number) {
        (tobj::LoadError::ScalingByZeroError, _) => "expected a weight other than 0".into(),
        (tobj::LoadError::MaterialParseError, _) => "expected a material's name after `usemtl `".into(),
        (_, Some(word)) if matches!(keyword, "v" | "vn") => {
            format!("expected a number, found `{}`", printable(word))
        }
        (_, None) if keyword == "v" => {
            format!(
                "expected 3 coordinates, and after them a weight or a colour, found {} numbers",
                numbers.len()
            )
        }
        (_, None) if keyword == "vn" => format!("expected 3 numbers, found {}", numbers.len()),
        (other, _) => other.to_string(),
    }
}

/// Material libraries as they are met.
#[derive(Default)]
struct Libraries {
    names: BTreeSet<String>,
    /// What was said about the first library that is not there.
    missing: Option<String>,
    not_drawn: NotDrawn,
    /// The first error; `tobj` has no room for it.
    error: Option<Error>,
}

impl Libraries {
    /// Loads what one `mtllib` line names: one file whose name may hold spaces, or several files.
    fn load(&mut self, scene: &Path, room: &Room, line: &str) -> tobj::MTLLoadResult {
        let names = match room.locate(line) {
            Err(Denial::Missing(_)) if line.contains(' ') => line.split_whitespace().collect(),
            _ => vec![line],
        };
        let mut all = Vec::new();
        let mut indices = std::collections::HashMap::new();
        for name in names {
            match self.load_one(scene, room, name) {
                Ok((materials, own)) => {
                    indices.extend(own.into_iter().map(|(name, index)| (name, index + all.len())));
                    all.extend(materials);
                }
                Err(error) => {
                    self.error.get_or_insert(error);
                }
            }
        }
        self.names.extend(indices.keys().cloned());
        Ok((all, indices))
    }

    fn load_one(&mut self, scene: &Path, room: &Room, name: &str) -> Result<Library> {
        let located = match room.locate(name) {
            Err(denial @ Denial::Missing(_)) => {
                self.missing.get_or_insert_with(|| denial.message(name));
                return Ok(Library::default());
            }
            located => located,
        };
        let refuse = |denial: Denial| {
            Error::input(scene, Place::Element(format!("mtllib {}", printable(name))), denial.message(name))
        };
        let located = located.map_err(refuse)?;
        // Named again, it would only add the same materials again.
        if !room.first_visit(&located) {
            return Ok(Library::default());
        }
        let bytes = room.read(&located).map_err(refuse)?;
        let shown = scene.with_file_name("").join(name);
        materials::parse(&shown, &bytes, &mut self.not_drawn)
    }
}

/// `usemtl` lines that name no known material.
#[derive(Default)]
struct MaterialUsage {
    unknown: usize,
    first: Option<(usize, String)>,
}

impl MaterialUsage {
    fn note(&mut self, line: &str, number: usize, known: &BTreeSet<String>) {
        let Some(name) = line.trim_start().strip_prefix("usemtl ") else { return };
        if !known.contains(name.trim()) {
            self.unknown += 1;
            self.first.get_or_insert_with(|| (number, printable(name.trim())));
        }
    }
}

/// What geometry had to be mended.
#[derive(Default)]
struct Leftovers {
    crossed: usize,
    normals: usize,
}

fn object(
    name: String,
    mesh: &tobj::Mesh,
    outlines: &mut impl Iterator<Item = Outline>,
    leftovers: &mut Leftovers,
) -> std::result::Result<ObjectInput, (usize, String)> {
    let triples = |flat: &[f32]| -> Vec<Vec3> { flat.chunks_exact(3).map(Vec3::from_slice).collect() };
    let positions = triples(&mesh.positions);
    let mut triangles = Vec::new();
    let mut corners = Vec::new();
    let mut any_normals = false;
    let (mut first, mut polygons) = (0, 0);
    let all_threes = std::iter::repeat_n(3, mesh.indices.len() / 3);
    let arities: Box<dyn Iterator<Item = u32>> = match mesh.face_arities.is_empty() {
        true => Box::new(all_threes),
        false => Box::new(mesh.face_arities.iter().copied()),
    };
    for arity in arities {
        let range = first..first + arity as usize;
        first = range.end;
        polygons += 1;
        let indices = &mesh.indices[range.clone()];
        let Outline { line, has_normals } =
            outlines.next().unwrap_or(Outline { line: 0, has_normals: false });
        let normal_indices = mesh.normal_indices.get(range).filter(|_| has_normals);
        any_normals |= normal_indices.is_some();
        let outline: Vec<Vec3> = indices.iter().map(|&v| positions[v as usize]).collect();
        let cut = polygon::triangulate(&outline, MAX_CONCAVE_CORNERS).map_err(|why| (line as usize, why))?;
        leftovers.crossed += usize::from(cut.crossed);
        for triangle in cut.triangles {
            triangles.push(triangle.map(|corner| indices[corner]));
            corners.push(triangle.map(|corner| normal_indices.map_or(NO_NORMAL, |n| n[corner])));
        }
    }
    let normals = any_normals.then(|| {
        let directions = triples(&mesh.normals);
        let unit = |n: Vec3| shading_normals::unit(n.as_dvec3()).unwrap_or(Vec3::ZERO);
        let mut normals = SmoothNormals { normals: directions.into_iter().map(unit).collect(), corners };
        leftovers.normals += shading_normals::repair(&mut normals, &positions, &triangles);
        normals
    });
    // `tobj`'s index 0 is the library's first material; 0 of the scene is the default.
    let material = mesh.material_id.map_or(0, |index| index as u32 + 1);
    let polygons = Some(polygons);
    Ok(ObjectInput { material, normals, polygons, ..ObjectInput::new(name, positions, triangles) })
}

fn warn(
    builder: &mut SceneBuilder,
    tally: &Tally,
    leftovers: &Leftovers,
    not_drawn: &NotDrawn,
    usage: &MaterialUsage,
) {
    if let Some((line, name)) = &usage.first {
        let lines = counted(usage.unknown, "usemtl line");
        builder
            .warn(format!("{lines} without a known material, drawn grey, the first `{name}` in line {line}"));
    }
    if let Some((count, line, word)) = &tally.unknown {
        let lines = counted(*count, "line");
        builder.warn(format!("passed over {lines} with unknown keywords, the first `{word}` in line {line}"));
    }
    let mut note = |count: usize, what: &str, noun: &str| {
        if count > 0 {
            builder.warn(format!("{what} ({})", counted(count, noun)));
        }
    };
    note(tally.flat, "points, lines and faces of fewer than three corners are not drawn", "line");
    note(tally.free_form, "free-form curves and surfaces are not drawn", "line");
    note(usize::from(tally.coloured), "vertex colours are not drawn", "file");
    note(
        leftovers.crossed,
        "outlines that cross themselves are cut into triangles as far as possible",
        "polygon",
    );
    note(leftovers.normals, "normals of zero or infinite length are replaced by the face's", "corner");
    note(not_drawn.textures, "textures are not drawn", "material");
    note(not_drawn.halos, "materials that thin out towards the rim are drawn opaque", "material");
    note(not_drawn.other_colours, "spectral and CIE XYZ colours are not drawn", "line");
}
