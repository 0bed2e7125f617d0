//! Morph targets, as far as their weights go at rest.

use super::accessors::{Accessors, Wanted};
use super::primitives::{self, Geometry, Shape};
use super::schema::{Mesh, Node, Primitive};
use super::textures::Placement;

/// The weights of a primitive's targets: the node's, else the mesh's, else none at all.
///
/// # Errors
/// A line if there are weights, and not one for each target.
pub(super) fn weights<'a>(
    node: &'a Node,
    mesh: &'a Mesh,
    primitive: &Primitive,
) -> Result<&'a [f64], String> {
    let Some(weights) = node.weights.as_ref().or(mesh.weights.as_ref()) else { return Ok(&[]) };
    match weights.len() == primitive.targets.len() {
        true => Ok(weights),
        false => Err(format!("{} weights, and it has {} targets", weights.len(), primitive.targets.len())),
    }
}

/// The shape of a primitive with its weighted targets added, in the order of the file; targets of no weight
/// are not read.
///
/// # Errors
/// A line if a target's type or count does not fit.
pub(super) fn displaced(
    geometry: &Geometry,
    accessors: &Accessors,
    primitive: &Primitive,
    placement: Option<&Placement>,
    weights: &[f64],
) -> Result<Shape, String> {
    let Geometry { shape, used, vertices, .. } = geometry;
    let mut shape = shape.clone();
    for (number, (target, &weight)) in primitive.targets.iter().zip(weights).enumerate() {
        if weight == 0.0 {
            continue;
        }
        let attribute = |name: &str, wanted: Wanted| {
            let elements = primitives::attribute(accessors, target, name, wanted, *vertices);
            elements.map_err(|why| format!("target {number}: {why}"))
        };
        if let Some(deltas) = attribute("POSITION", Wanted::Displacements)? {
            for (position, &vertex) in shape.positions.iter_mut().zip(used) {
                *position += weight * deltas.vec3(vertex as usize);
            }
        }
        if let (Some(normals), Some(deltas)) = (&mut shape.normals, attribute("NORMAL", Wanted::Normals)?) {
            for (normal, &vertex) in normals.iter_mut().zip(used) {
                *normal += weight * deltas.vec3(vertex as usize);
            }
        }
        let (Some(coordinates), Some(placement)) = (&mut shape.coordinates, placement) else { continue };
        if let Some(deltas) = attribute(&placement.attribute(), Wanted::TextureCoordinates)? {
            for (coordinate, &vertex) in coordinates.iter_mut().zip(used) {
                let [u, v] = deltas.numbers(vertex as usize);
                *coordinate += weight * glam::DVec2::new(u, v);
            }
        }
    }
    Ok(shape)
}
