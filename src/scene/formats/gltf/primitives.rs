//! Primitives of meshes: read once, placed as often as nodes show them.

use super::accessors::{self, Accessors, Elements, Wanted};
use super::alpha::Masking;
use super::schema::{Document, Primitive};
use super::textures::Placement;
use crate::scene::SmoothNormals;
use crate::scene::formats::shading_normals;
use glam::{DAffine3, DVec2, DVec3, Vec3};
use std::collections::BTreeMap;

/// How a primitive strings its vertices together.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    List,
    Strip,
    Fan,
    /// Points or lines, which have no surface.
    Thin,
}

/// The mode of a primitive.
pub(super) fn mode(primitive: &Primitive) -> Result<Mode, String> {
    match primitive.mode.unwrap_or(4) {
        4 => Ok(Mode::List),
        5 => Ok(Mode::Strip),
        6 => Ok(Mode::Fan),
        0..=3 => Ok(Mode::Thin),
        other => Err(format!("expected a mode from 0 to 6, found {other}")),
    }
}

/// How many triangles a primitive declares, before anything of it is read.
pub(super) fn declared_triangles(document: &Document, primitive: &Primitive) -> Result<u64, String> {
    let position = primitive.attributes.get("POSITION");
    let corners = match (primitive.indices, position) {
        (Some(indices), _) => accessors::find(document, indices)?.count,
        (None, Some(&position)) => accessors::find(document, position)?.count,
        (None, None) => return Ok(0),
    };
    Ok(match mode(primitive)? {
        Mode::List => corners / 3,
        Mode::Strip | Mode::Fan => corners.saturating_sub(2),
        Mode::Thin => 0,
    })
}

/// Vertices of a primitive, with their numbers as the file means them, in f64.
#[derive(Clone)]
pub(super) struct Shape {
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Option<Vec<DVec3>>,
    /// Of the set that the alpha mask of the material takes, if it has one.
    pub(super) coordinates: Option<Vec<DVec2>>,
}

/// A primitive in its mesh's space, with the vertices that its triangles use and no others.
pub(super) struct Geometry {
    /// Before morph targets and skins.
    pub(super) shape: Shape,
    /// Which vertices of the file those are, in increasing order.
    pub(super) used: Vec<u32>,
    /// How many vertices the file has.
    pub(super) vertices: usize,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Corners that were left over after the last whole triangle.
    pub(super) left_over: usize,
}

/// An attribute that must have an element for each vertex.
///
/// # Errors
/// A line if it is there and has not, or its type does not fit.
pub(super) fn attribute<'a>(
    accessors: &Accessors<'a>,
    attributes: &BTreeMap<String, u64>,
    name: &str,
    wanted: Wanted,
    vertices: usize,
) -> Result<Option<Elements<'a>>, String> {
    let Some(&index) = attributes.get(name) else { return Ok(None) };
    let elements = accessors.read(index, wanted).map_err(|why| format!("{name}: {why}"))?;
    match elements.len() == vertices {
        true => Ok(Some(elements)),
        false => Err(format!("{name}: {} elements, and POSITION has {vertices}", elements.len())),
    }
}

/// Reads a primitive that is not [`Mode::Thin`], with the texture coordinates that its mask needs.
///
/// # Errors
/// A line for every size, type or index that does not fit.
pub(super) fn read(
    document: &Document,
    accessors: &Accessors,
    primitive: &Primitive,
    masking: Option<&Masking>,
) -> Result<Geometry, String> {
    let attributes = &primitive.attributes;
    let &index = attributes.get("POSITION").ok_or("expected an attribute POSITION")?;
    if primitive.extensions.draco.is_some()
        && accessors::find(document, index).is_ok_and(|a| a.buffer_view.is_none() && a.sparse.is_none())
    {
        return Err("it is compressed by `KHR_draco_mesh_compression`, which is not supported".into());
    }
    let positions = accessors.read(index, Wanted::Positions).map_err(|why| format!("POSITION: {why}"))?;
    let vertices = positions.len();
    let normals = attribute(accessors, attributes, "NORMAL", Wanted::Normals, vertices)?;
    let coordinates = match masking {
        Some(masking) => {
            let name = masking.placement.attribute();
            let found = attribute(accessors, attributes, &name, Wanted::TextureCoordinates, vertices)?;
            Some(found.ok_or_else(|| format!("expected an attribute {name} for its material's alpha"))?)
        }
        None => None,
    };
    let (corners, left_over) = corners(accessors, primitive, vertices)?;
    // Only what is used is kept, so memory is bounded by the triangles however many vertices there are.
    let mut used: Vec<u32> = corners.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let renumber = |vertex: u32| match used.len() == vertices {
        true => vertex,
        false => used.partition_point(|&other| other < vertex) as u32,
    };
    let gather = |elements: &Elements| used.iter().map(|&i| elements.vec3(i as usize)).collect();
    let pairs =
        |elements: &Elements| used.iter().map(|&i| DVec2::from_array(elements.numbers(i as usize))).collect();
    Ok(Geometry {
        shape: Shape {
            positions: gather(&positions),
            normals: normals.as_ref().map(gather),
            coordinates: coordinates.as_ref().map(pairs),
        },
        triangles: corners.iter().map(|triangle| triangle.map(renumber)).collect(),
        used,
        vertices,
        left_over,
    })
}

/// The triangles as indices below `count`, and how many corners were left over.
fn corners(
    accessors: &Accessors,
    primitive: &Primitive,
    count: usize,
) -> Result<(Vec<[u32; 3]>, usize), String> {
    let sequence: Vec<u32> = match primitive.indices {
        Some(index) => {
            let located = |why: String| format!("indices: {why}");
            let indices = accessors.read(index, Wanted::Indices).map_err(located)?;
            let sequence: Vec<u32> = (0..indices.len()).map(|i| indices.integers::<1>(i)[0]).collect();
            if let Some(position) = sequence.iter().position(|&vertex| vertex as usize >= count) {
                let why = format!(
                    "accessor {index}: element {position} is vertex {} of {count}",
                    sequence[position]
                );
                return Err(located(why));
            }
            sequence
        }
        None => (0..u32::try_from(count).map_err(|_| format!("{count} vertices"))?).collect(),
    };
    let triangles = match mode(primitive)? {
        Mode::List => sequence.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        // Every other triangle of a strip is wound the other way round.
        Mode::Strip => {
            let turned =
                |(i, c): (usize, &[u32])| if i % 2 == 0 { [c[0], c[1], c[2]] } else { [c[0], c[2], c[1]] };
            sequence.windows(3).enumerate().map(turned).collect()
        }
        Mode::Fan => match sequence.split_first() {
            Some((&apex, rim)) => rim.windows(2).map(|c| [c[0], c[1], apex]).collect(),
            None => Vec::new(),
        },
        Mode::Thin => Vec::new(),
    };
    let left_over = match mode(primitive)? {
        Mode::List => sequence.len() % 3,
        _ if sequence.len() < 3 => sequence.len(),
        _ => 0,
    };
    Ok((triangles, left_over))
}

/// A primitive in the world.
pub(super) struct Instance {
    pub(super) positions: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) normals: Option<SmoothNormals>,
    /// Corners whose normal was of no use.
    pub(super) normals_replaced: usize,
}

impl Shape {
    /// Places the shape with its triangles. Each coordinate is computed in f64 and rounded once.
    pub(super) fn place(&self, triangles: &[[u32; 3]], world: &DAffine3) -> Instance {
        let positions: Vec<Vec3> =
            self.positions.iter().map(|&p| world.transform_point3(p).as_vec3()).collect();
        // A mirrored solid would be inside out: its triangles are turned round, as the specification asks.
        let mirrored = world.matrix3.determinant() < 0.0;
        let triangles: Vec<[u32; 3]> = match mirrored {
            true => triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
            false => triangles.to_vec(),
        };
        let mut normals_replaced = 0;
        let normals = self.normals.as_ref().map(|normals| {
            let matrix = shading_normals::matrix(&world.matrix3);
            let turn = |&n: &DVec3| shading_normals::unit(matrix * n).unwrap_or(Vec3::ZERO);
            let mut normals =
                SmoothNormals { normals: normals.iter().map(turn).collect(), corners: triangles.clone() };
            normals_replaced = shading_normals::repair(&mut normals, &positions, &triangles);
            normals
        });
        Instance { positions, triangles, normals, normals_replaced }
    }

    /// Where the vertices lie on the texture, rounded once.
    ///
    /// # Errors
    /// A line if that is nowhere.
    pub(super) fn on_texture(&self, placement: &Placement) -> Result<Option<Vec<[f32; 2]>>, String> {
        let Some(coordinates) = &self.coordinates else { return Ok(None) };
        let placed: Vec<[f32; 2]> = coordinates.iter().map(|&c| placement.apply(c)).collect();
        match placed.iter().flatten().all(|coordinate| coordinate.is_finite()) {
            true => Ok(Some(placed)),
            false => Err(format!("{}: a coordinate on the texture is not finite", placement.attribute())),
        }
    }
}
