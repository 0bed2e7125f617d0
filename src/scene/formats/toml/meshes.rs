//! Meshes.

use super::document::{Complaint, Materials, describe, find, name_of};
use super::schema::MeshEntry;
use crate::scene::formats::limits::MAX_CONCAVE_CORNERS;
use crate::scene::formats::text::counted;
use crate::scene::formats::{polygon, shading_normals};
use crate::scene::{ObjectInput, SceneBuilder, Shadowing, SmoothNormals};
use glam::Vec3;
use toml::Spanned;

/// A mesh before it is moved.
pub(super) struct Read {
    pub(super) input: ObjectInput,
    /// Polygons whose outline crosses itself.
    pub(super) crossed: usize,
}

/// The object of a mesh; `index` counts from 0 and names it if it has no name.
///
/// # Errors
/// A place and a line for indices that are out of range, faces that are none, and a number of normals that
/// is not that of the vertices.
pub(super) fn read(
    entry: &Spanned<MeshEntry>,
    index: usize,
    materials: &Materials,
) -> Result<Read, Complaint> {
    let (at, mesh) = (entry.span().start, entry.get_ref());
    let describe = || describe("mesh", index, mesh.name.as_deref());
    let positions: Vec<Vec3> = mesh.vertices.iter().map(|point| point.0).collect();
    let (mut triangles, mut crossed) = (Vec::new(), 0);
    for (number, face) in mesh.faces.iter().enumerate() {
        let complaint =
            |why: String| (face.span().start, format!("{}, face {}: {why}", describe(), number + 1));
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
    let normals = match &mesh.normals {
        None => None,
        Some(given) if given.len() == positions.len() => {
            let unit = |normal: Vec3| shading_normals::unit(normal.as_dvec3());
            let normals: Option<Vec<Vec3>> = given.iter().map(|normal| unit(normal.0)).collect();
            let normals = normals.ok_or_else(|| (at, format!("{}: a normal of zero", describe())))?;
            Some(SmoothNormals { normals, corners: triangles.clone() })
        }
        Some(given) => {
            let why = format!("{} normals for {} vertices", given.len(), positions.len());
            return Err((at, format!("{}: {why}", describe())));
        }
    };
    let usual = Shadowing::default();
    let shadowing = Shadowing {
        casts: mesh.cast_shadows.unwrap_or(usual.casts),
        receives: mesh.receive_shadows.unwrap_or(usual.receives),
    };
    let material = mesh.material.as_ref().map_or(Ok(0), |name| find(materials, name))?;
    let name = name_of("mesh", index, mesh.name.as_deref());
    let polygons = Some(mesh.faces.len() as u32);
    let input = ObjectInput {
        material,
        normals,
        shadowing,
        polygons,
        ..ObjectInput::new(name, positions, triangles)
    };
    Ok(Read { input, crossed })
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
