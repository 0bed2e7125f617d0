//! Polygons that share their corners.

use super::normals;
use crate::error::{Error, Result};
use crate::scene::ObjectInput;
use crate::scene::formats::polygon;
use glam::{DAffine3, DVec3};

/// Polygons over shared corners, each counter-clockwise from outside.
#[derive(Debug, Clone)]
pub(in crate::scene::procedural) struct Mesh {
    /// Corners; rounded to f32 when an object is made of them.
    pub points: Vec<DVec3>,
    /// Polygons: indices of at least three corners each.
    pub faces: Vec<Vec<usize>>,
    /// Cosine of the angle between faces up to which they are shaded as one smooth surface.
    pub cos_crease: f64,
}

/// Cosine of forty degrees.
const USUAL_CREASE: f64 = 0.766;

impl Default for Mesh {
    fn default() -> Mesh {
        Mesh { points: Vec::new(), faces: Vec::new(), cos_crease: USUAL_CREASE }
    }
}

impl Mesh {
    /// Polygons over corners.
    pub fn new(points: Vec<DVec3>, faces: Vec<Vec<usize>>) -> Mesh {
        Mesh { points, faces, ..Mesh::default() }
    }

    /// The same, smooth across edges up to this angle in degrees.
    pub fn smooth_up_to(self, degrees: f64) -> Mesh {
        Mesh { cos_crease: libm::cos(degrees.to_radians()), ..self }
    }

    /// All of another mesh besides; where the two overlap, both stay.
    pub fn with(mut self, other: &Mesh) -> Mesh {
        let base = self.points.len();
        self.points.extend(&other.points);
        self.faces.extend(other.faces.iter().map(|face| face.iter().map(|corner| base + corner).collect()));
        self
    }

    /// All of several meshes.
    pub fn union(parts: impl IntoIterator<Item = Mesh>) -> Mesh {
        let mut parts = parts.into_iter();
        let first = parts.next().unwrap_or_default();
        parts.fold(first, |sum, part| sum.with(&part))
    }

    /// The mesh where a transform takes it; one that mirrors turns its faces round, so that they still look
    /// outwards.
    pub fn placed(&self, transform: &DAffine3) -> Mesh {
        let points = self.points.iter().map(|&p| transform.transform_point3(p)).collect();
        let placed = Mesh { points, faces: self.faces.clone(), ..*self };
        if transform.matrix3.determinant() < 0.0 { placed.inside_out() } else { placed }
    }

    /// The same surface seen from its other side.
    pub fn inside_out(mut self) -> Mesh {
        self.faces.iter_mut().for_each(|face| face.reverse());
        self
    }

    /// The mesh as an object of this name, cut into triangles, with normals where it is smooth.
    ///
    /// # Errors
    /// [`Error::Usage`] for a polygon with more corners than can be cut.
    pub fn into_object(self, name: impl Into<String>) -> Result<ObjectInput> {
        let positions: Vec<_> = self.points.iter().map(|p| p.as_vec3()).collect();
        let (mut triangles, mut origins) = (Vec::new(), Vec::new());
        for (number, face) in self.faces.iter().enumerate() {
            let corners: Vec<_> = face.iter().map(|&corner| positions[corner]).collect();
            let cut = polygon::triangulate(&corners, face.len()).map_err(Error::Usage)?;
            for triangle in cut.triangles {
                triangles.push(triangle.map(|corner| face[corner] as u32));
                origins.push((number, triangle));
            }
        }
        let polygons = Some(self.faces.len() as u32);
        let normals = normals::of(&self, &origins);
        Ok(ObjectInput { polygons, normals, ..ObjectInput::new(name, positions, triangles) })
    }
}

#[cfg(test)]
impl Mesh {
    /// Whether every edge belongs to exactly two faces that run through it in opposite directions, and the
    /// faces look outwards.
    pub fn is_closed(&self) -> bool {
        let mut edges = std::collections::HashMap::new();
        for face in &self.faces {
            for (place, &from) in face.iter().enumerate() {
                let to = face[(place + 1) % face.len()];
                let forth = from < to;
                let count = edges.entry((from.min(to), from.max(to))).or_insert((0, 0));
                if forth { count.0 += 1 } else { count.1 += 1 }
            }
        }
        edges.values().all(|&count| count == (1, 1)) && self.volume() > 0.0
    }

    /// The volume inside.
    pub fn volume(&self) -> f64 {
        let face = |face: &Vec<usize>| {
            let at = |i: usize| self.points[face[i]];
            (1..face.len() - 1).map(|i| at(0).dot(at(i).cross(at(i + 1)))).sum::<f64>()
        };
        self.faces.iter().map(face).sum::<f64>() / 6.0
    }
}
