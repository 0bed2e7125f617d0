//! PLY, the Stanford format: as text, and in binary of either byte order.
//!
//! `vertex` elements with `x y z` and perhaps `nx ny nz`, `face` elements with lists of vertices, and
//! `tristrips` become one object, named after the file. Polygons are cut into triangles, see
//! [`polygon`](super::polygon). In text an element is a line; blank lines mean nothing.
//!
//! The parser is our own: of the crates that were looked at, the best kept (`ply-rs-bw` 4.0) takes two
//! properties of one name for one and so reads a binary body at wrong places, refuses NaN in text, and keeps
//! a vector for each face.

mod header;
mod values;

use self::header::{Element, Encoding, Header, Kind, Property, Scalar};
use self::values::{Binary, Text, Values, length};
use super::limits::{MAX_CONCAVE_CORNERS, MAX_TRIANGLES, MAX_VERTICES};
use super::shading_normals;
use super::text::{counted, printable};
use super::{confined, file_stem, polygon, scene_name};
use crate::error::{Error, Place, Result};
use crate::scene::{ObjectInput, Scene, SceneBuilder, SmoothNormals};
use glam::Vec3;
use std::path::Path;

/// Reads a PLY file.
///
/// # Errors
/// One line with file and place (a line, or an element with a byte of the file) for whatever cannot be read
/// as geometry, and for a file without faces.
pub(super) fn load(path: &Path) -> Result<Scene> {
    let file = confined::read_scene(path)?;
    let at_line = |(line, why): (usize, String)| Error::input(path, Place::Line(line), why);
    let header = header::parse(&file).map_err(at_line)?;
    let plan = Plan::of(&header).map_err(at_line)?;
    let Some(plan) = plan else {
        let vertices = header.elements.iter().find(|e| e.name == "vertex").map_or(0, |e| e.count);
        let why = format!("expected faces, found a point cloud of {vertices} vertices");
        return Err(Error::input(path, Place::File, why));
    };
    let body = match header.encoding {
        Encoding::Ascii => {
            read_body(Text::new(&file[header.body..], header.line_end, header.body_line), &header, &plan)
        }
        encoding => read_body(Binary::new(&file, header.body, encoding), &header, &plan),
    };
    let mut mesh = body.map_err(|(place, why)| Error::input(path, place, why))?;

    let mut builder = SceneBuilder::new(scene_name(path));
    let mut normals_replaced = 0;
    let normals = plan.has_normals.then(|| {
        let unit = |n: &Vec3| shading_normals::unit(n.as_dvec3()).unwrap_or(Vec3::ZERO);
        let directions = mesh.normals.iter().map(unit).collect();
        let mut normals = SmoothNormals { normals: directions, corners: mesh.triangles.clone() };
        normals_replaced = shading_normals::repair(&mut normals, &mesh.positions, &mesh.triangles);
        normals
    });
    let (positions, triangles) = (std::mem::take(&mut mesh.positions), std::mem::take(&mut mesh.triangles));
    let polygons = Some(mesh.polygons);
    let input = ObjectInput { normals, polygons, ..ObjectInput::new(file_stem(path), positions, triangles) };
    builder.add_object(input).map_err(|error| Error::input(path, Place::File, error.to_string()))?;
    warn(&mut builder, &header, &mesh, normals_replaced);
    Ok(builder.finish())
}

/// The names of a vertex's coordinates and of its normal's.
const COORDINATES: [&str; 3] = ["x", "y", "z"];
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];

/// The names that files give to the corners of a face or a strip.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// What is to be read of the elements, by their places in the header.
struct Plan {
    vertex: usize,
    has_normals: bool,
    /// For each property of a vertex where it goes: a coordinate, then those of the normal from 3 on.
    slots: Vec<Option<usize>>,
    faces: Option<Corners>,
    strips: Option<Corners>,
}

/// The list of corners in an element.
struct Corners {
    element: usize,
    property: usize,
}

impl Plan {
    /// `None` if there are no faces at all.
    fn of(header: &Header) -> std::result::Result<Option<Plan>, (usize, String)> {
        let faces = corners(header, "face")?;
        let strips = corners(header, "tristrips")?;
        if faces.is_none() && strips.is_none() {
            return Ok(None);
        }
        let vertex = header.elements.iter().position(|element| element.name == "vertex");
        let Some(vertex) = vertex else {
            return Err((header.body_line - 1, "expected an element `vertex` before `end_header`".into()));
        };
        let element = &header.elements[vertex];
        if element.count > MAX_VERTICES {
            return Err((element.line, format!("expected at most {MAX_VERTICES} vertices")));
        }
        let named = |name: &&str| element.properties.iter().any(|property| property.name == *name);
        if let Some(missing) = COORDINATES.iter().find(|name| !named(name)) {
            return Err((element.line, format!("expected a property `{missing}` of its vertices")));
        }
        let has_normals = NORMAL.iter().all(named);
        let slot = |property: &Property| {
            let normal = NORMAL.iter().filter(|_| has_normals);
            let slot = COORDINATES.iter().chain(normal).position(|name| *name == property.name);
            match (slot, property.kind) {
                (Some(_), Kind::List { .. }) => {
                    Err((property.line, format!("expected `{}` to be a number, found a list", property.name)))
                }
                _ => Ok(slot),
            }
        };
        let slots = element.properties.iter().map(slot).collect::<std::result::Result<_, _>>()?;
        Ok(Some(Plan { vertex, has_normals, slots, faces, strips }))
    }
}

/// The corners of the elements of one name; `None` if there is no such element.
fn corners(header: &Header, name: &str) -> std::result::Result<Option<Corners>, (usize, String)> {
    let found = header.elements.iter().position(|element| element.name == name && element.count > 0);
    let Some(position) = found else { return Ok(None) };
    let element = &header.elements[position];
    let is_corners = |property: &Property| CORNERS.contains(&property.name.as_str());
    let mut lists = (0..element.properties.len()).filter(|&i| is_corners(&element.properties[i]));
    let (Some(property), None) = (lists.next(), lists.next()) else {
        return Err((
            element.line,
            format!("expected a list `vertex_indices` or `vertex_index` in each {name}"),
        ));
    };
    let declared = &element.properties[property];
    match declared.kind {
        Kind::List { item, .. } if item.is_whole() => Ok(Some(Corners { element: position, property })),
        _ => Err((declared.line, format!("expected `{}` to be a list of whole numbers", declared.name))),
    }
}

/// What the body holds.
#[derive(Default)]
struct Mesh {
    positions: Vec<Vec3>,
    /// One for each position, or none.
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Faces of fewer than three corners.
    flat: usize,
    /// Polygons that cross themselves.
    crossed: usize,
    /// Faces of at least three corners, and triangles of strips.
    polygons: u32,
    /// What comes after the last element.
    left_over: Option<String>,
}

type Complaint = (Place, String);

fn read_body<V: Values>(mut values: V, header: &Header, plan: &Plan) -> std::result::Result<Mesh, Complaint> {
    let mut mesh = Mesh::default();
    // Faces may come before the vertices whose polygons they are.
    let mut early: Vec<(usize, V)> = Vec::new();
    for (position, element) in header.elements.iter().enumerate() {
        let has_corners = plan.corners_of(position).is_some();
        if position == plan.vertex {
            mesh.read_vertices(&mut values, element, plan)?;
        } else if has_corners && position > plan.vertex {
            mesh.read_corners(&mut values, element, plan, position)?;
        } else {
            if has_corners {
                early.push((position, values.clone()));
            }
            each(&mut values, element, |values| skip(values, &element.properties))?;
        }
    }
    mesh.left_over = values.left_over();
    for (position, mut values) in early {
        mesh.read_corners(&mut values, &header.elements[position], plan, position)?;
    }
    Ok(mesh)
}

/// Reads every element of a run. Those without properties take no room, however many are declared.
fn each<V: Values>(
    values: &mut V,
    element: &Element,
    mut read: impl FnMut(&mut V) -> std::result::Result<(), String>,
) -> std::result::Result<(), Complaint> {
    let count = if element.properties.is_empty() { 0 } else { element.count };
    for index in 0..count {
        let mut one = || {
            values.begin()?;
            read(values)?;
            values.end()
        };
        one().map_err(|why| (values.place(&element.name, index), why))?;
    }
    Ok(())
}

fn skip(values: &mut impl Values, properties: &[Property]) -> std::result::Result<(), String> {
    properties.iter().try_for_each(|property| match property.kind {
        Kind::Number(scalar) => values.skip(scalar, 1),
        Kind::List { length: of_length, item } => {
            let count = length(values, of_length, item)?;
            values.skip(item, count)
        }
    })
}

impl Plan {
    /// How the corners of an element, by its place in the header, are to be read.
    fn corners_of(&self, element: usize) -> Option<&Corners> {
        self.faces.iter().chain(&self.strips).find(|corners| corners.element == element)
    }
}

impl Mesh {
    fn read_vertices<V: Values>(
        &mut self,
        values: &mut V,
        element: &Element,
        plan: &Plan,
    ) -> std::result::Result<(), Complaint> {
        // The header was refused if the file could not hold as many.
        self.positions.reserve_exact(element.count as usize);
        self.normals.reserve_exact(if plan.has_normals { element.count as usize } else { 0 });
        each(values, element, |values| {
            let mut numbers = [0.0; 6];
            for (property, slot) in element.properties.iter().zip(&plan.slots) {
                match (property.kind, *slot) {
                    (Kind::Number(scalar), Some(slot)) => numbers[slot] = values.number(scalar)?,
                    _ => skip(values, std::slice::from_ref(property))?,
                }
            }
            let [x, y, z, nx, ny, nz] = numbers;
            self.positions.push(Vec3::new(x, y, z));
            if plan.has_normals {
                self.normals.push(Vec3::new(nx, ny, nz));
            }
            Ok(())
        })
    }

    fn read_corners<V: Values>(
        &mut self,
        values: &mut V,
        element: &Element,
        plan: &Plan,
        position: usize,
    ) -> std::result::Result<(), Complaint> {
        let is_face = plan.faces.as_ref().is_some_and(|faces| faces.element == position);
        let Some(&Corners { property, .. }) = plan.corners_of(position) else { return Ok(()) };
        let (before, after) = (&element.properties[..property], &element.properties[property + 1..]);
        let Kind::List { length: of_length, item } = element.properties[property].kind else { return Ok(()) };
        let mut polygon = Polygon::default();
        each(values, element, |values| {
            skip(values, before)?;
            let count = length(values, of_length, item)?;
            self.expect_room(count.saturating_sub(2))?;
            if is_face {
                self.read_face(values, item, count, &mut polygon)?;
            } else {
                self.read_strip(values, item, count)?;
            }
            skip(values, after)
        })
    }

    /// Whether so many triangles more are within the limit; asked before their corners are read.
    fn expect_room(&self, more: usize) -> std::result::Result<(), String> {
        match (self.triangles.len() + more) as u64 <= MAX_TRIANGLES {
            true => Ok(()),
            false => Err(format!("expected at most {MAX_TRIANGLES} triangles")),
        }
    }

    fn vertex(&self, number: i64) -> std::result::Result<u32, String> {
        let inside = usize::try_from(number).is_ok_and(|number| number < self.positions.len());
        if inside { Ok(number as u32) } else { Err(format!("vertex {number} of {}", self.positions.len())) }
    }

    fn read_face<V: Values>(
        &mut self,
        values: &mut V,
        item: Scalar,
        count: usize,
        polygon: &mut Polygon,
    ) -> std::result::Result<(), String> {
        polygon.corners.clear();
        polygon.outline.clear();
        for _ in 0..count {
            let number = values.whole(item)?;
            let vertex = self.vertex(number)?;
            polygon.corners.push(vertex);
            polygon.outline.push(self.positions[vertex as usize]);
        }
        if count < 3 {
            self.flat += 1;
            return Ok(());
        }
        let cut = polygon::triangulate(&polygon.outline, MAX_CONCAVE_CORNERS)?;
        self.polygons += 1;
        self.crossed += usize::from(cut.crossed);
        self.triangles.extend(cut.triangles.iter().map(|triangle| triangle.map(|i| polygon.corners[i])));
        Ok(())
    }

    /// Every other triangle of a strip is wound the other way round; -1 begins a new strip.
    fn read_strip<V: Values>(
        &mut self,
        values: &mut V,
        item: Scalar,
        count: usize,
    ) -> std::result::Result<(), String> {
        let mut last = [0; 2];
        let mut seen = 0;
        for _ in 0..count {
            let number = values.whole(item)?;
            if number == -1 {
                seen = 0;
                continue;
            }
            let vertex = self.vertex(number)?;
            if seen >= 2 {
                let [a, b] = last;
                self.polygons += 1;
                self.triangles.push(if seen % 2 == 0 { [a, b, vertex] } else { [b, a, vertex] });
            }
            last = [last[1], vertex];
            seen += 1;
        }
        Ok(())
    }
}

/// The corners of one face; kept for the next, so that memory is asked for once.
#[derive(Default)]
struct Polygon {
    corners: Vec<u32>,
    outline: Vec<Vec3>,
}

/// Names under which files keep colours.
const COLOURS: [&str; 12] = [
    "red",
    "green",
    "blue",
    "alpha",
    "r",
    "g",
    "b",
    "diffuse_red",
    "diffuse_green",
    "diffuse_blue",
    "color",
    "colour",
];

fn warn(builder: &mut SceneBuilder, header: &Header, mesh: &Mesh, normals_replaced: usize) {
    let mut note = |count: usize, what: &str, noun: &str| {
        if count > 0 {
            builder.warn(format!("{what} ({})", counted(count, noun)));
        }
    };
    for element in header.elements.iter().filter(|element| element.count > 0) {
        let coloured = element.properties.iter().any(|p| COLOURS.contains(&p.name.as_str()));
        match element.name.as_str() {
            "vertex" => note(usize::from(coloured), "vertex colours are not drawn", "file"),
            "face" | "tristrips" => note(usize::from(coloured), "face colours are not drawn", "file"),
            other => {
                let what = format!("elements `{}` are not drawn", printable(other));
                note(element.count as usize, &what, "element");
            }
        }
    }
    note(usize::from(header.textured), "textures are not drawn", "file");
    note(mesh.flat, "faces of fewer than three corners are not drawn", "face");
    note(mesh.crossed, "outlines that cross themselves are cut into triangles as far as possible", "polygon");
    note(normals_replaced, "normals of zero or infinite length are replaced by the face's", "corner");
    if let Some(left_over) = &mesh.left_over {
        builder.warn(format!("what follows the last element is not read ({left_over})"));
    }
}
