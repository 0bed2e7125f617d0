//! Primitives of meshes: read once, placed as often as nodes show them.

use super::accessors::{self, Elements};
use super::buffers::Buffers;
use super::schema::{Document, Primitive};
use crate::scene::SmoothNormals;
use crate::scene::formats::shading_normals;
use glam::{DAffine3, DMat3, Vec3};

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

/// A primitive in its mesh's space, with the vertices that its triangles use and no others.
pub(super) struct Geometry {
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    triangles: Vec<[u32; 3]>,
    /// Corners that were left over after the last whole triangle.
    pub(super) left_over: usize,
}

/// Reads a primitive that is not [`Mode::Thin`].
///
/// # Errors
/// A line for every size, type or index that does not fit.
pub(super) fn read(
    document: &Document,
    buffers: &Buffers,
    primitive: &Primitive,
) -> Result<Geometry, String> {
    let attribute = |name: &str| -> Result<Option<Elements>, String> {
        let Some(&index) = primitive.attributes.get(name) else { return Ok(None) };
        accessors::vectors(document, buffers, index).map(Some).map_err(|why| format!("{name}: {why}"))
    };
    let positions = attribute("POSITION")?.ok_or("expected an attribute POSITION")?;
    let normals = attribute("NORMAL")?;
    if normals.is_some_and(|normals| normals.len() != positions.len()) {
        let found = normals.map_or(0, |normals| normals.len());
        return Err(format!("NORMAL: {found} elements, and POSITION has {}", positions.len()));
    }
    let (corners, left_over) = corners(document, buffers, primitive, positions.len())?;
    // Only what is used is kept, so memory is bounded by the triangles however many vertices there are.
    let mut used: Vec<u32> = corners.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let renumber = |vertex: u32| match used.len() == positions.len() {
        true => vertex,
        false => used.partition_point(|&other| other < vertex) as u32,
    };
    let gather = |elements: &Elements| used.iter().map(|&i| Vec3::from(elements.vec3(i as usize))).collect();
    Ok(Geometry {
        positions: gather(&positions),
        normals: normals.as_ref().map(gather),
        triangles: corners.iter().map(|triangle| triangle.map(renumber)).collect(),
        left_over,
    })
}

/// The triangles as indices below `count`, and how many corners were left over.
fn corners(
    document: &Document,
    buffers: &Buffers,
    primitive: &Primitive,
    count: usize,
) -> Result<(Vec<[u32; 3]>, usize), String> {
    let sequence: Vec<u32> = match primitive.indices {
        Some(index) => {
            let located = |why: String| format!("indices: {why}");
            let indices = accessors::scalars(document, buffers, index).map_err(located)?;
            let sequence: Vec<u32> = (0..indices.len()).map(|i| indices.unsigned(i)).collect();
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

impl Geometry {
    /// Places the primitive. Each coordinate is computed in f64 and rounded once.
    pub(super) fn place(&self, world: &DAffine3) -> Instance {
        let positions: Vec<Vec3> =
            self.positions.iter().map(|p| world.transform_point3(p.as_dvec3()).as_vec3()).collect();
        // A mirrored solid would be inside out: its triangles are turned round, as the specification asks.
        let mirrored = world.matrix3.determinant() < 0.0;
        let triangles = match mirrored {
            true => self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
            false => self.triangles.clone(),
        };
        let mut normals_replaced = 0;
        let normals = self.normals.as_ref().map(|normals| {
            let cofactors = cofactors(&world.matrix3) * if mirrored { -1.0 } else { 1.0 };
            let turn = |n: &Vec3| shading_normals::unit(cofactors * n.as_dvec3()).unwrap_or(Vec3::ZERO);
            let mut normals =
                SmoothNormals { normals: normals.iter().map(turn).collect(), corners: triangles.clone() };
            normals_replaced = shading_normals::repair(&mut normals, &positions, &triangles);
            normals
        });
        Instance { positions, triangles, normals, normals_replaced }
    }
}

/// The inverse transpose times the determinant, which needs no division.
fn cofactors(m: &DMat3) -> DMat3 {
    DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}
