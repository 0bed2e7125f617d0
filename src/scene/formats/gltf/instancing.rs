//! `EXT_mesh_gpu_instancing`: one node that shows its mesh many times.

use super::accessors::{self, Accessors, Wanted};
use super::nodes;
use super::schema::{Document, Instancing, Node};
use crate::scene::formats::text::printable;
use glam::DAffine3;

/// How often a node shows its mesh, before anything is read: once if it says nothing.
///
/// # Errors
/// A line if it says so by no attribute, by one that does not exist, or by several of different counts.
pub(super) fn declared(document: &Document, node: &Node) -> Result<u64, String> {
    let Some(instancing) = &node.extensions.instancing else { return Ok(1) };
    let mut first: Option<(&str, u64)> = None;
    for (name, &index) in &instancing.attributes {
        let count = accessors::find(document, index).map_err(|why| at(name, why))?.count;
        match first {
            None => first = Some((name, count)),
            Some((_, other)) if other == count => {}
            Some((other, expected)) => {
                return Err(at(name, format!("{count} elements, and {} has {expected}", printable(other))));
            }
        }
    }
    let none = || "EXT_mesh_gpu_instancing: expected an attribute".to_owned();
    first.map(|(_, count)| count).ok_or_else(none)
}

/// From each instance to its node. Attributes of other names are for other programs.
///
/// # Errors
/// A line if the type of an attribute does not fit, bytes are missing, or a rotation is none.
pub(super) fn transforms(
    document: &Document,
    accessors: &Accessors,
    node: &Node,
    instancing: &Instancing,
) -> Result<Vec<DAffine3>, String> {
    let attribute = |name: &str, wanted: Wanted| match instancing.attributes.get(name) {
        Some(&index) => accessors.read(index, wanted).map(Some).map_err(|why| at(name, why)),
        None => Ok(None),
    };
    let translations = attribute("TRANSLATION", Wanted::Vectors)?;
    let rotations = attribute("ROTATION", Wanted::Rotations)?;
    let scales = attribute("SCALE", Wanted::Vectors)?;
    // All counts are equal, and the number of objects that follow from them has been checked.
    (0..declared(document, node)? as usize)
        .map(|i| {
            let [translation, scale] = [translations, scales].map(|v| v.map(|v| v.numbers(i)));
            nodes::compose(translation, rotations.map(|r| r.numbers(i)), scale)
                .map_err(|why| at("ROTATION", format!("element {i}: {why}")))
        })
        .collect()
}

fn at(attribute: &str, why: String) -> String {
    format!("EXT_mesh_gpu_instancing: {}: {why}", printable(attribute))
}
