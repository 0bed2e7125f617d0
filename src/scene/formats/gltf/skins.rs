//! Skins, in the pose that the nodes have at rest.
//!
//! A vertex goes to the mean of where its joints would take it, weighted: the sum of `weight * joint's world
//! matrix * inverse bind matrix * vertex`, over the sum of the weights, which files round. The transform of
//! the node that shows the mesh is left out, as the specification says. All of it is in f64.

use super::accessors::{Accessors, Elements, Wanted};
use super::nodes::{self, Placed};
use super::primitives::{self, Geometry, Shape};
use super::schema::{Document, Primitive, SkinEntry};
use crate::scene::formats::limits::MAX_JOINTS;
use crate::scene::formats::shading_normals;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// Skins, each computed when a node first wears it.
pub(super) struct Skins<'a> {
    document: &'a Document,
    accessors: &'a Accessors<'a>,
    /// The transform of each node that is part of the scene.
    worlds: BTreeMap<u64, DAffine3>,
    /// From a vertex as the mesh has it to the world, for each joint of a skin.
    matrices: BTreeMap<u64, Vec<DAffine3>>,
    joints: usize,
}

impl<'a> Skins<'a> {
    pub(super) fn new(document: &'a Document, accessors: &'a Accessors<'a>, placed: &[Placed]) -> Skins<'a> {
        let world = |place: &Placed| (place.index as u64, place.world);
        let needed: &[Placed] = if document.skins.is_empty() { &[] } else { placed };
        let worlds = needed.iter().map(world).collect();
        Skins { document, accessors, worlds, matrices: BTreeMap::new(), joints: 0 }
    }

    /// The matrices of a skin's joints.
    ///
    /// # Errors
    /// A line if there is no such skin, a joint is not part of the scene or is listed twice, all skins
    /// together have more than [`MAX_JOINTS`], or the inverse bind matrices do not fit.
    pub(super) fn matrices(&mut self, index: u64) -> Result<&[DAffine3], String> {
        if !self.matrices.contains_key(&index) {
            let entry = usize::try_from(index).ok().and_then(|i| self.document.skins.get(i));
            let entry = entry.ok_or_else(|| format!("skin {index} of {}", self.document.skins.len()))?;
            self.joints += entry.joints.len();
            let matrices = self.compute(entry).map_err(|why| format!("skin {index}: {why}"))?;
            self.matrices.insert(index, matrices);
        }
        Ok(self.matrices.get(&index).map_or(&[], |matrices| matrices))
    }

    fn compute(&self, entry: &SkinEntry) -> Result<Vec<DAffine3>, String> {
        if self.joints > MAX_JOINTS {
            return Err(format!("expected at most {MAX_JOINTS} joints in all skins together"));
        }
        let inverses = match entry.inverse_bind_matrices {
            Some(index) => {
                let read = self.accessors.read(index, Wanted::Matrices);
                Some(read.map_err(|why| format!("inverseBindMatrices: {why}"))?)
            }
            None => None,
        };
        if let Some(found) = inverses.filter(|inverses| inverses.len() < entry.joints.len()) {
            let (found, joints) = (found.len(), entry.joints.len());
            return Err(format!("inverseBindMatrices: {found} elements, and there are {joints} joints"));
        }
        let mut listed = BTreeSet::new();
        let joint = |(number, node): (usize, &u64)| {
            if !listed.insert(*node) {
                return Err(format!("joint {number}: node {node} is a joint already"));
            }
            let world = self.worlds.get(node);
            let world =
                world.ok_or_else(|| format!("joint {number}: node {node} is not part of the scene"))?;
            let inverse = match inverses {
                Some(inverses) => nodes::affine(&inverses.numbers(number)).filter(DAffine3::is_finite),
                None => Some(DAffine3::IDENTITY),
            };
            let inverse = inverse.ok_or_else(|| {
                format!("inverseBindMatrices: element {number} is not finite, or its last row not 0 0 0 1")
            })?;
            Ok(*world * inverse)
        };
        entry.joints.iter().enumerate().map(joint).collect()
    }
}

/// Joints and weights of all vertices, four a vertex.
pub(super) type Influences<'a> = (Elements<'a>, Elements<'a>);

/// All sets of joints and weights of a primitive, from `JOINTS_0` and `WEIGHTS_0` on.
///
/// # Errors
/// A line if there is no set, half a set, or one whose type or count does not fit.
pub(super) fn influences<'a>(
    accessors: &Accessors<'a>,
    primitive: &Primitive,
    vertices: usize,
) -> Result<Vec<Influences<'a>>, String> {
    let mut sets = Vec::new();
    loop {
        let number = sets.len();
        let attribute = |name: &str, wanted: Wanted| {
            let name = format!("{name}_{number}");
            primitives::attribute(accessors, &primitive.attributes, &name, wanted, vertices)
        };
        match (attribute("JOINTS", Wanted::Joints)?, attribute("WEIGHTS", Wanted::Weights)?) {
            (Some(joints), Some(weights)) => sets.push((joints, weights)),
            (None, None) if number > 0 => return Ok(sets),
            _ => return Err(format!("expected attributes JOINTS_{number} and WEIGHTS_{number}")),
        }
    }
}

/// A shape in the world, where its joints take it.
///
/// # Errors
/// A line if a vertex names a joint that does not exist or has a weight below 0, or if its weights are all 0:
/// then nothing says where it is.
pub(super) fn skinned(
    geometry: &Geometry,
    mut shape: Shape,
    sets: &[Influences],
    matrices: &[DAffine3],
) -> Result<Shape, String> {
    for (slot, &vertex) in geometry.used.iter().enumerate() {
        let matrix = matrix(vertex as usize, sets, matrices)?;
        let position = &mut shape.positions[slot];
        *position = matrix.transform_point3(*position);
        if let Some(normals) = &mut shape.normals {
            normals[slot] = shading_normals::matrix(&matrix.matrix3) * normals[slot];
        }
    }
    Ok(shape)
}

fn matrix(vertex: usize, sets: &[Influences], matrices: &[DAffine3]) -> Result<DAffine3, String> {
    let (mut matrix3, mut translation, mut sum) = (DMat3::ZERO, DVec3::ZERO, 0.0);
    for (number, (joints, weights)) in sets.iter().enumerate() {
        let pairs = joints.integers::<4>(vertex).into_iter().zip(weights.numbers::<4>(vertex));
        for (joint, weight) in pairs {
            let Some(matrix) = matrices.get(joint as usize) else {
                let count = matrices.len();
                return Err(format!("JOINTS_{number}: element {vertex} names joint {joint} of {count}"));
            };
            if !(weight >= 0.0 && weight.is_finite()) {
                return Err(format!("WEIGHTS_{number}: element {vertex} has the weight {weight}"));
            }
            if weight > 0.0 {
                matrix3 += matrix.matrix3 * weight;
                translation += matrix.translation * weight;
                sum += weight;
            }
        }
    }
    match sum > 0.0 {
        true => Ok(DAffine3 { matrix3: matrix3 / sum, translation: translation / sum }),
        false => Err(format!("WEIGHTS_0: the weights of element {vertex} are all 0")),
    }
}
