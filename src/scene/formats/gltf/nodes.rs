//! The tree of nodes and where each stands in the world.

use super::schema::{Document, Node};
use crate::scene::formats::limits::MAX_NODE_DEPTH;
use crate::scene::formats::text::printable;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A node that is part of the scene.
pub(super) struct Placed<'a> {
    pub(super) index: usize,
    pub(super) node: &'a Node,
    /// From the node's space to the world's; finite.
    pub(super) world: DAffine3,
    /// The node that it hangs on.
    pub(super) parent: Option<usize>,
}

impl Placed<'_> {
    /// The same as it is in its own space.
    pub(super) fn by_itself(&self) -> Self {
        Placed { world: DAffine3::IDENTITY, ..*self }
    }
}

/// What is wrong with a node: its index and a line.
pub(super) type NodeError = (usize, String);

/// `node 3`, with its name if it has one.
pub(super) fn describe(document: &Document, index: usize) -> String {
    match document.nodes.get(index).and_then(|node| node.name.as_deref()) {
        Some(name) => format!("node {index} `{}`", printable(name)),
        None => format!("node {index}"),
    }
}

/// All nodes of the default scene, parents before children, in the order of the file's lists. Without a
/// default scene it is scene 0, and without any scene every node that is no child.
///
/// # Errors
/// If a list names a node that does not exist, a node has several parents or is its own ancestor, the tree
/// is deeper than [`MAX_NODE_DEPTH`], or a transform is not finite.
pub(super) fn place_all(document: &Document) -> Result<Vec<Placed<'_>>, NodeError> {
    let parents = parents(document)?;
    check_cycles(&parents)?;
    let mut stack: Vec<(usize, DAffine3, usize)> = Vec::new();
    for root in roots(document, &parents)?.into_iter().rev() {
        stack.push((root, DAffine3::IDENTITY, 1));
    }
    let mut placed = Vec::new();
    while let Some((index, parent, depth)) = stack.pop() {
        if depth > MAX_NODE_DEPTH {
            return Err((index, format!("it has more than {} ancestors", MAX_NODE_DEPTH - 1)));
        }
        let node = &document.nodes[index];
        let world = parent * local(node).map_err(|why| (index, why))?;
        if !world.is_finite() {
            return Err((index, "its transform in the world is not finite".into()));
        }
        stack.extend(node.children.iter().rev().map(|&child| (child as usize, world, depth + 1)));
        placed.push(Placed { index, node, world, parent: parents[index] });
    }
    Ok(placed)
}

/// The parent of each node.
fn parents(document: &Document) -> Result<Vec<Option<usize>>, NodeError> {
    let mut parents = vec![None; document.nodes.len()];
    for (index, node) in document.nodes.iter().enumerate() {
        for &child in &node.children {
            let slot = usize::try_from(child).ok().and_then(|child| parents.get_mut(child));
            let Some(slot) = slot else {
                return Err((index, format!("child node {child} of {}", document.nodes.len())));
            };
            if let Some(other) = slot.replace(index) {
                return Err((index, format!("its child, node {child}, is a child of node {other} already")));
            }
        }
    }
    Ok(parents)
}

/// With at most one parent each, nodes form trees and rings.
fn check_cycles(parents: &[Option<usize>]) -> Result<(), NodeError> {
    const UNSEEN: usize = usize::MAX;
    let mut seen_from = vec![UNSEEN; parents.len()];
    for start in 0..parents.len() {
        let mut current = Some(start);
        while let Some(index) = current.filter(|&index| seen_from[index] != start) {
            if seen_from[index] != UNSEEN {
                break;
            }
            seen_from[index] = start;
            current = parents[index];
            if current.is_some_and(|parent| seen_from[parent] == start) {
                return Err((index, "it is its own ancestor".into()));
            }
        }
    }
    Ok(())
}

fn roots(document: &Document, parents: &[Option<usize>]) -> Result<Vec<usize>, NodeError> {
    if document.scenes.is_empty() && document.scene.is_none() {
        return Ok((0..parents.len()).filter(|&index| parents[index].is_none()).collect());
    }
    let chosen = document.scene.unwrap_or(0);
    let scene = usize::try_from(chosen).ok().and_then(|i| document.scenes.get(i));
    let Some(scene) = scene else {
        return Err((usize::MAX, format!("scene {chosen} of {}", document.scenes.len())));
    };
    let mut listed = vec![false; parents.len()];
    let mut roots = Vec::new();
    for &root in &scene.nodes {
        let index = usize::try_from(root).ok().filter(|&i| i < parents.len());
        let Some(index) = index else {
            return Err((usize::MAX, format!("scene {chosen}: node {root} of {}", parents.len())));
        };
        if let Some(parent) = parents[index] {
            return Err((index, format!("scene {chosen} lists it, and it is a child of node {parent}")));
        }
        if std::mem::replace(&mut listed[index], true) {
            return Err((index, format!("scene {chosen} lists it twice")));
        }
        roots.push(index);
    }
    Ok(roots)
}

/// The transform of a node in its parent.
pub(super) fn local(node: &Node) -> Result<DAffine3, String> {
    if let Some(m) = &node.matrix {
        return affine(m).ok_or_else(|| "expected 0 0 0 1 as the last row of its matrix".into());
    }
    compose(node.translation, node.rotation, node.scale)
}

/// A matrix, column by column, whose last row is 0 0 0 1.
pub(super) fn affine(m: &[f64; 16]) -> Option<DAffine3> {
    // Products of matrices that an exporter rounds come out a little off.
    let fits = [m[3], m[7], m[11], m[15] - 1.0].iter().all(|entry| entry.abs() <= 1e-6);
    let column = |at: usize| DVec3::new(m[at], m[at + 1], m[at + 2]);
    let linear = DMat3::from_cols(column(0), column(4), column(8));
    fits.then_some(DAffine3 { matrix3: linear, translation: column(12) })
}

/// A transform of its parts, each of which may be missing: first the scale, then the rotation.
///
/// # Errors
/// A line if the rotation is not of unit length, or near it.
pub(super) fn compose(
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
) -> Result<DAffine3, String> {
    let scale = scale.map_or(DVec3::ONE, DVec3::from);
    let rotation = DQuat::from_array(rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
    let length = rotation.length();
    // Files round the four numbers, so the length is made exact; one that is far off is no rotation.
    if !(0.5..=2.0).contains(&length) {
        return Err(format!("expected a unit quaternion as its rotation, found one of length {length}"));
    }
    let translation = translation.map_or(DVec3::ZERO, DVec3::from);
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation / length, translation))
}
