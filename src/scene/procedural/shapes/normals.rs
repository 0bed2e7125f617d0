//! Shading normals for meshes: smooth where faces meet at a small angle.

use super::Mesh;
use crate::scene::SmoothNormals;
use crate::scene::formats::shading_normals::unit;
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// Normals at the corners of triangles that were cut from a mesh, each known by its face and by where in it
/// its corners stand. `None` if all of the mesh is flat.
///
/// A corner has the mean of the faces around its point that lean at most by the crease from its own,
/// weighted by area.
pub(super) fn of(mesh: &Mesh, triangles: &[(usize, [usize; 3])]) -> Option<SmoothNormals> {
    let areas: Vec<DVec3> = mesh.faces.iter().map(|face| area(mesh, face)).collect();
    let units: Vec<DVec3> = areas.iter().map(|area| area.normalize_or_zero()).collect();
    let mut around = vec![Vec::new(); mesh.points.len()];
    for (number, face) in mesh.faces.iter().enumerate() {
        face.iter().for_each(|&corner| around[corner].push(number));
    }
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    let mut normals: Vec<Vec3> = Vec::new();
    let mut is_smooth = false;
    let mut corners = Vec::with_capacity(triangles.len());
    for &(face, triangle) in triangles {
        corners.push(triangle.map(|place| {
            let near = around[mesh.faces[face][place]].iter();
            let near = near.filter(|&&other| units[other].dot(units[face]) >= mesh.cos_crease);
            let sum: DVec3 = near.map(|&other| areas[other]).sum();
            let own = unit(areas[face]).unwrap_or(Vec3::Y);
            let normal = unit(sum).unwrap_or(own);
            is_smooth |= (normal - own).length_squared() > 1e-8;
            *numbers.entry(normal.to_array().map(f32::to_bits)).or_insert_with(|| {
                normals.push(normal);
                normals.len() as u32 - 1
            })
        }));
    }
    is_smooth.then_some(SmoothNormals { normals, corners })
}

/// Twice the vector area of a face.
fn area(mesh: &Mesh, face: &[usize]) -> DVec3 {
    let origin = mesh.points[face[0]];
    let at = |place: usize| mesh.points[face[place]] - origin;
    (1..face.len() - 1).map(|place| at(place).cross(at(place + 1))).sum()
}
