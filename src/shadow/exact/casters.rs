//! What the arbiter holds segments against: primitives, their first stage, and where they are.

use super::bounds;
use super::hierarchy::{Hierarchy, Visit};
use super::interval::Box3;
use super::interval_planes::IntervalPlanes;
use super::interval_shape::IntervalShape;
use super::query::origin_of;
use crate::float_environment::InStandardFloats;
use crate::geometry::LightPosition;
use crate::scene::{Primitive, PrimitiveIndex, Scene};
use rayon::prelude::*;

/// Some primitives relative to one light.
pub struct Casters {
    light: LightPosition,
    hierarchy: Hierarchy,
    /// First those in the hierarchy, then those without an end, which every segment is held against.
    casters: Vec<Caster>,
    bounded: usize,
}

/// A primitive and its first stage.
pub struct Caster {
    /// The primitive.
    pub primitive: PrimitiveIndex,
    /// It in intervals.
    pub first_stage: FirstStage,
}

/// A primitive in intervals.
pub enum FirstStage {
    /// A triangle.
    Triangle(IntervalPlanes),
    /// A curved surface.
    Curved(IntervalShape),
}

impl Casters {
    /// Prepares some primitives of a scene.
    pub fn new(scene: &Scene, light: LightPosition, primitives: Vec<PrimitiveIndex>) -> Casters {
        let mut boxes = Vec::with_capacity(primitives.len());
        let mut bounded = Vec::with_capacity(primitives.len());
        let mut endless = Vec::new();
        for primitive in primitives {
            let found = match scene.primitive(primitive) {
                Primitive::Triangle(corners) => Some(bounds::of_triangle(corners)),
                Primitive::Curved(shape) => bounds::of_shape(shape),
            };
            match found {
                Some(found) => {
                    boxes.push(found);
                    bounded.push(primitive);
                }
                None => endless.push(primitive),
            }
        }
        let count = bounded.len();
        bounded.extend(endless);
        let caster = |primitive| Caster { primitive, first_stage: FirstStage::new(scene, light, primitive) };
        let casters = bounded.into_par_iter().map(caster).in_standard_floats().collect();
        Casters { light, hierarchy: Hierarchy::new(&boxes), casters, bounded: count }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.casters.is_empty()
    }

    /// Calls `visit` with each that the segment from a light to a point in a box may meet, until it returns
    /// [`Visit::Stop`].
    pub fn walk(&self, light: LightPosition, point: &Box3, mut visit: impl FnMut(&Caster) -> Visit) {
        let (bounded, endless) = self.casters.split_at(self.bounded);
        if endless.iter().any(|caster| visit(caster) == Visit::Stop) {
            return;
        }
        self.hierarchy.walk(light, point, |index| visit(&bounded[index as usize]));
    }

    /// The same for the light that they were prepared for.
    pub fn walk_to_light(&self, point: &Box3, visit: impl FnMut(&Caster) -> Visit) {
        self.walk(self.light, point, visit);
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.casters.len() * size_of::<Caster>() + self.hierarchy.bytes()
    }
}

impl FirstStage {
    fn new(scene: &Scene, light: LightPosition, primitive: PrimitiveIndex) -> FirstStage {
        match scene.primitive(primitive) {
            Primitive::Triangle(corners) => FirstStage::Triangle(IntervalPlanes::new(light, corners)),
            Primitive::Curved(shape) => FirstStage::Curved(IntervalShape::new(shape, &origin_of(light))),
        }
    }
}
