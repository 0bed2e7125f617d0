//! How much a document asks for with all its instances, counted before any of it is made.

use super::instancing;
use super::nodes::{self, Placed};
use super::primitives::{self, Mode};
use super::schema::{Document, Mesh};
use crate::memory::MemoryLimit;
use crate::scene::formats::estimate::Estimate;
use crate::scene::formats::limits::{MAX_OBJECTS, MAX_TRIANGLES};

/// What is wrong: an element and a line.
pub(super) type ElementError = (String, String);

/// Finds a mesh.
pub(super) fn mesh_at(document: &Document, index: u64) -> Result<(usize, &Mesh), String> {
    let position = usize::try_from(index).ok().filter(|&i| i < document.meshes.len());
    let position = position.ok_or_else(|| format!("mesh {index} of {}", document.meshes.len()))?;
    Ok((position, &document.meshes[position]))
}

pub(super) fn describe_primitive(mesh: usize, primitive: usize) -> String {
    format!("mesh {mesh}, primitive {primitive}")
}

/// Counts objects and triangles, and returns which materials they need.
///
/// # Errors
/// An element and a line if a mesh or material does not exist, or a limit is exceeded.
pub(super) fn check(
    document: &Document,
    placed: &[Placed],
    limit: MemoryLimit,
) -> Result<Vec<bool>, ElementError> {
    let mut needed = vec![false; document.materials.len()];
    let mut of_mesh: Vec<Option<u64>> = vec![None; document.meshes.len()];
    let (mut objects, mut triangles, mut at_once) = (0u64, 0u64, 0u64);
    for place in placed {
        let Some(index) = place.node.mesh else { continue };
        let node = |why: String| (nodes::describe(document, place.index), why);
        let (position, mesh) = mesh_at(document, index).map_err(node)?;
        let instances = instancing::declared(document, place.node).map_err(node)?;
        let own = match of_mesh[position] {
            Some(own) => own,
            None => *of_mesh[position].insert(one(document, position, mesh, &mut needed)?),
        };
        // A mesh of nothing is still shown that often.
        let shown = (mesh.primitives.len() as u64).max(1);
        objects = objects.saturating_add(instances.saturating_mul(shown));
        triangles = triangles.saturating_add(instances.saturating_mul(own));
        at_once = at_once.max(own);
    }
    if objects > MAX_OBJECTS {
        return Err(("nodes".into(), format!("{objects} objects, expected at most {MAX_OBJECTS}")));
    }
    if triangles > MAX_TRIANGLES {
        return Err(("nodes".into(), format!("{triangles} triangles, expected at most {MAX_TRIANGLES}")));
    }
    let estimate = Estimate { objects, triangles, at_once, ..Estimate::default() };
    estimate.check(limit).map_err(|why| ("nodes".into(), why))?;
    Ok(needed)
}

/// The triangles that a mesh declares.
fn one(document: &Document, position: usize, mesh: &Mesh, needed: &mut [bool]) -> Result<u64, ElementError> {
    let mut own = 0u64;
    for (number, primitive) in mesh.primitives.iter().enumerate() {
        let at = |why: String| (describe_primitive(position, number), why);
        own = own.saturating_add(primitives::declared_triangles(document, primitive).map_err(at)?);
        let Some(index) = primitive.material else { continue };
        let count = needed.len();
        let material = usize::try_from(index).ok().and_then(|i| needed.get_mut(i));
        let material = material.ok_or_else(|| at(format!("material {index} of {count}")))?;
        *material |= primitives::mode(primitive).map_err(at)? != Mode::Thin;
    }
    Ok(own)
}
