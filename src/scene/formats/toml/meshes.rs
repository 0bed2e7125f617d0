//! Meshes.

use super::document::Complaint;
use super::schema::MeshEntry;
use super::values::{Exactly, Number};
use crate::scene::formats::limits::MAX_CONCAVE_CORNERS;
use crate::scene::formats::text::counted;
use crate::scene::formats::{polygon, shading_normals};
use crate::scene::{ObjectInput, SceneBuilder, SmoothNormals, TextureCoordinates};
use glam::Vec3;
use toml::Spanned;

/// A mesh before it is moved.
pub(super) struct Read {
    pub(super) input: ObjectInput,
    /// Polygons whose outline crosses itself.
    pub(super) crossed: usize,
}

/// The square of a normal's length, less 1, up to which it counts as one of unit length and keeps its bits.
const UNIT: f32 = 1e-6;

/// The triangles of a mesh that messages call `about`.
///
/// # Errors
/// A place and a line for indices that are out of range, faces that are none, and a number of normals or
/// texture coordinates that is not that of the vertices.
pub(super) fn read(entry: &Spanned<MeshEntry>, about: &str) -> Result<Read, Complaint> {
    let (at, mesh) = (entry.span().start, entry.get_ref());
    let positions: Vec<Vec3> = mesh.vertices.iter().map(|point| point.0).collect();
    let (mut triangles, mut crossed) = (Vec::new(), 0);
    for (number, face) in mesh.faces.iter().enumerate() {
        let complaint = |why: String| (face.span().start, format!("{about}, face {}: {why}", number + 1));
        let corners = face.get_ref();
        if corners.len() < 3 {
            return Err(complaint(format!("expected at least 3 corners, found {}", corners.len())));
        }
        if let Some(vertex) = corners.iter().find(|&&vertex| vertex as usize >= positions.len()) {
            return Err(complaint(format!("vertex {vertex} of {}", positions.len())));
        }
        let outline: Vec<Vec3> = corners.iter().map(|&vertex| positions[vertex as usize]).collect();
        let cut = polygon::triangulate(&outline, MAX_CONCAVE_CORNERS).map_err(complaint)?;
        crossed += usize::from(cut.crossed);
        triangles.extend(cut.triangles.into_iter().map(|triangle| triangle.map(|corner| corners[corner])));
    }
    let count_of = |what: &str, found: usize| match found == positions.len() {
        true => Ok(()),
        false => Err((at, format!("{about}: {found} {what} for {} vertices", positions.len()))),
    };
    let normals = match &mesh.normals {
        None => None,
        Some(given) => {
            count_of("normals", given.len())?;
            let normals: Option<Vec<Vec3>> = given.iter().map(|normal| unit(normal.0)).collect();
            let normals = normals.ok_or_else(|| (at, format!("{about}: a normal of zero")))?;
            Some(SmoothNormals { normals, corners: triangles.clone() })
        }
    };
    let texture_coordinates = match &mesh.texture_coordinates {
        None => None,
        Some(given) => {
            count_of("texture coordinates", given.len())?;
            let rounded = |&Exactly(pair): &Exactly<Number, 2>| pair.map(|Number(number)| number as f32);
            let coordinates: Vec<[f32; 2]> = given.iter().map(rounded).collect();
            if !coordinates.iter().flatten().all(|coordinate| coordinate.is_finite()) {
                let why = "expected texture coordinates in the range of 32-bit floats";
                return Err((at, format!("{about}: {why}")));
            }
            Some(TextureCoordinates { coordinates, corners: triangles.clone() })
        }
    };
    let polygons = Some(mesh.polygons.unwrap_or(mesh.faces.len() as u32));
    let object = ObjectInput::new("", positions, triangles);
    Ok(Read { input: ObjectInput { normals, texture_coordinates, polygons, ..object }, crossed })
}

/// A normal of unit length, if it has a direction.
fn unit(normal: Vec3) -> Option<Vec3> {
    let is_unit = (normal.length_squared() - 1.0).abs() <= UNIT;
    if is_unit { Some(normal) } else { shading_normals::unit(normal.as_dvec3()) }
}

/// Says how many outlines cross themselves.
pub(super) fn warn(crossed: usize, builder: &mut SceneBuilder) {
    if crossed > 0 {
        let count = counted(crossed, "polygon");
        builder.warn(format!(
            "outlines that cross themselves are cut into triangles as far as possible ({count})"
        ));
    }
}
