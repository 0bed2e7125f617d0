//! Primitives by number: all triangles first, then all curved surfaces.

use super::Scene;
use crate::geometry::curved::Shape;
use glam::Vec3;

/// Number of a primitive of a [`Scene`]: below the number of triangles an index into [`Scene::triangles`],
/// above that, counted from there, one into [`Scene::curved`].
pub type PrimitiveIndex = u32;

/// A curved surface of a [`Scene`], and the object it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvedPrimitive {
    /// The surface, without defects.
    pub shape: Shape,
    /// Index into [`Scene::objects`].
    pub object: u32,
}

/// What a primitive is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Primitive<'a> {
    /// A triangle by its corners, in world space.
    Triangle([Vec3; 3]),
    /// A curved surface.
    Curved(&'a Shape),
}

impl Scene {
    /// How many primitives there are.
    pub fn primitive_count(&self) -> u32 {
        (self.triangles.len() + self.curved.len()) as u32
    }

    /// Whether a primitive is a curved surface.
    pub fn is_curved(&self, primitive: PrimitiveIndex) -> bool {
        primitive as usize >= self.triangles.len()
    }

    /// A primitive by its number.
    pub fn primitive(&self, primitive: PrimitiveIndex) -> Primitive<'_> {
        match self.shape(primitive) {
            Some(shape) => Primitive::Curved(shape),
            None => Primitive::Triangle(self.corners(primitive)),
        }
    }

    /// The surface of a primitive, if it is curved.
    pub fn shape(&self, primitive: PrimitiveIndex) -> Option<&Shape> {
        let curved = (primitive as usize).checked_sub(self.triangles.len())?;
        Some(&self.curved[curved].shape)
    }

    /// A box along the axes around a primitive; `None` for a plane without end.
    pub fn primitive_bounds(&self, primitive: PrimitiveIndex) -> Option<(Vec3, Vec3)> {
        match self.primitive(primitive) {
            Primitive::Triangle([a, b, c]) => Some((a.min(b).min(c), a.max(b).max(c))),
            Primitive::Curved(shape) => shape.bounds(),
        }
    }

    /// Index into [`Scene::objects`] of the object that a primitive belongs to.
    pub fn object_index(&self, primitive: PrimitiveIndex) -> u32 {
        match (primitive as usize).checked_sub(self.triangles.len()) {
            Some(curved) => self.curved[curved].object,
            None => self.triangles[primitive as usize].object,
        }
    }

    /// Object m and surface n of a primitive, both counted from 1 as in the 1986 paper: first its triangles,
    /// then its curved surfaces.
    pub fn object_and_surface(&self, primitive: PrimitiveIndex) -> (u32, u32) {
        let index = self.object_index(primitive);
        let object = &self.objects[index as usize];
        let surface = match (primitive as usize).checked_sub(self.triangles.len()) {
            Some(curved) => object.count + (curved as u32 - object.first_curved),
            None => primitive - object.first,
        };
        (index + 1, surface + 1)
    }

    /// Whether light passes through a primitive and is attenuated.
    pub fn is_transparent(&self, primitive: PrimitiveIndex) -> bool {
        self.material(primitive).transmission.is_some()
    }

    /// Whether anything that casts shadows is transparent: then answers are more than lit or occluded.
    pub fn has_transparent_casters(&self) -> bool {
        let attenuates = |object: &super::Object| {
            let is_there = object.count + object.curved_count > 0;
            let material = &self.materials[object.material as usize];
            is_there && object.shadowing.casts && material.transmission.is_some()
        };
        self.objects.iter().any(attenuates)
    }
}
