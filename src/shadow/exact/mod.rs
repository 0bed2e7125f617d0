//! The arbiter: truth about a shadow query, by exact arithmetic and nothing that it judges.
//!
//! It has its own interval arithmetic, its own integers, its own culling and its own first stage; it shares
//! only the definition of a query with the testers. [`plain`] is the same answer without any culling or
//! filter, for checking the arbiter itself.

mod bounds;
mod casters;
mod hierarchy;
mod integer;
mod integer_shape;
mod interval;
mod interval_planes;
mod interval_shape;
mod mask;
mod own_surface;
pub mod plain;
mod point;
mod query;
mod roots;
mod surd;
#[cfg(test)]
mod tests;
mod touching;
mod traced;

pub use integer::Meeting;
pub use traced::Span;

use super::{Basis, BuildInput, Counters, Crossings, Lights, ShadowTester, TesterEntry};
use crate::error::Result;
use crate::float_environment::StandardFloats;
use crate::geometry::{ExactPosition, LightPosition};
use crate::scene::{Primitive, PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;
use casters::Casters;
use glam::Vec3;
use hierarchy::Visit;
use query::Query;

/// `exact` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "exact",
    basis: Basis::Truth,
    lights: Lights::All,
    of_scene: None,
    build: &|input| {
        let _floats = StandardFloats::new();
        Ok(Box::new(Arbiter::new(input)))
    },
    expected_tests: |_, queries| 100.0 * queries,
};

/// The truth about one query.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Truth {
    /// Whether the light is hidden or seen.
    pub occlusion: Occlusion,
    /// Whether the query is on the edge between the two.
    pub contact: Contact,
}

/// Whether anything blocks the segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occlusion {
    /// Nothing blocks.
    Lit,
    /// Something does.
    Occluded,
}

/// TRUTH, "Touching".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Contact {
    /// The segment passes through primitives or past them.
    Clear,
    /// It meets only boundaries that do not close around it, or only touches curved surfaces, or it ends on
    /// what is not the receiver's surface.
    Touching,
}

/// Decides every query of one light.
pub struct Arbiter<'a> {
    scene: &'a Scene,
    light: LightPosition,
    /// What blocks light.
    opaque: Casters,
    /// What lets a part of it through.
    transparent: Casters,
    /// What blocks and holds the light itself: an end of every segment.
    around_light: Vec<PrimitiveIndex>,
}

impl<'a> Arbiter<'a> {
    /// Prepares the hierarchies over all primitives that cast.
    pub fn new(input: &BuildInput<'a>) -> Arbiter<'a> {
        let _floats = StandardFloats::new();
        let (scene, light) = (input.scene, input.light);
        let casting = (0..scene.primitive_count()).filter(|&p| scene.object(p).shadowing.casts);
        let (transparent, opaque) = casting.partition(|&p| scene.is_transparent(p));
        let mut arbiter = Arbiter {
            scene,
            light,
            opaque: Casters::new(scene, light, opaque),
            transparent: Casters::new(scene, light, transparent),
            around_light: Vec::new(),
        };
        arbiter.around_light = arbiter.primitives_around_light();
        arbiter
    }

    fn primitives_around_light(&self) -> Vec<PrimitiveIndex> {
        let LightPosition::At(light) = self.light else { return Vec::new() };
        let position = ExactPosition::Bare(light);
        let mut found = Vec::new();
        self.opaque.walk_to_light(&interval::point(light), |caster| {
            let is_on = match self.scene.primitive(caster.primitive) {
                // A direction off the triangle's plane decides whether the light lies on it.
                Primitive::Triangle(corners) => [Vec3::X, Vec3::Y, Vec3::Z]
                    .map(LightPosition::Towards)
                    .into_iter()
                    .any(|eye| integer::meet(eye, corners, &position) == Meeting::EndsOn),
                Primitive::Curved(shape) => integer_shape::holds(shape, light),
            };
            if is_on {
                found.push(caster.primitive);
            }
            Visit::Continue
        });
        found
    }

    /// Every primitive that casts and that the segment of a point meets, but for what ends in the receiver's
    /// own surface, in the order of their indices. Transparent ones are among them.
    pub fn meetings(&self, point: &SurfacePoint) -> Vec<(PrimitiveIndex, Meeting)> {
        let _floats = StandardFloats::new();
        let query = Query::new(self.scene, self.light, point);
        let mut found = Vec::new();
        for casters in [&self.opaque, &self.transparent] {
            casters.walk_to_light(&query.absolute(), |caster| {
                let meeting = query.meeting(caster);
                let is_own = || meeting == Meeting::EndsOn && query.is_own_surface(caster.primitive);
                if meeting != Meeting::Misses && !is_own() {
                    found.push((caster.primitive, meeting));
                }
                Visit::Continue
            });
        }
        found.sort_by_key(|(primitive, _)| *primitive);
        found
    }

    /// The truth about one point.
    pub fn decide(&self, point: &SurfacePoint) -> Truth {
        let _floats = StandardFloats::new();
        let query = Query::new(self.scene, self.light, point);
        let mut passes_through = false;
        let mut boundaries = Vec::new();
        let mut touches_curved = false;
        let mut ends_on = false;
        self.opaque.walk_to_light(&query.absolute(), |caster| {
            match query.meeting(caster) {
                Meeting::Misses => {}
                Meeting::Interior => {
                    passes_through = true;
                    return Visit::Stop;
                }
                Meeting::Boundary(_) => match self.scene.primitive(caster.primitive) {
                    Primitive::Triangle(corners) => boundaries.push(corners),
                    Primitive::Curved(_) => touches_curved = true,
                },
                Meeting::EndsOn => ends_on |= !query.is_own_surface(caster.primitive),
            }
            Visit::Continue
        });
        let occluded = passes_through || touches_curved || !boundaries.is_empty();
        let light_on = || self.around_light.iter().any(|&primitive| !query.is_own_surface(primitive));
        let slips_past = || touching::leaves_a_gap(self.light, &query.position, &boundaries);
        let touching =
            !passes_through && (ends_on || touches_curved || light_on() || (occluded && slips_past()));
        Truth {
            occlusion: if occluded { Occlusion::Occluded } else { Occlusion::Lit },
            contact: if touching { Contact::Touching } else { Contact::Clear },
        }
    }

    /// The transparent primitives that cast and that the segment of a point crosses, in ascending order; what
    /// it crosses twice is there twice. The point itself is no crossing.
    pub fn crossed(&self, point: &SurfacePoint) -> Vec<PrimitiveIndex> {
        let _floats = StandardFloats::new();
        let mut crossed = Vec::new();
        if self.transparent.is_empty() {
            return crossed;
        }
        let query = Query::new(self.scene, self.light, point);
        self.transparent.walk_to_light(&query.absolute(), |caster| {
            crossed.extend(std::iter::repeat_n(caster.primitive, query.crossings(caster)));
            Visit::Continue
        });
        crossed.sort_unstable();
        crossed
    }
}

impl ShadowTester for Arbiter<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let _floats = StandardFloats::new();
        for (point, answer) in points.iter().zip(answers) {
            *answer = self.decide(point).occlusion == Occlusion::Occluded;
        }
        Ok(Counters::default())
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        let _floats = StandardFloats::new();
        for point in points {
            crossings.push(Arbiter::crossed(self, point));
        }
        Ok(Counters::default())
    }

    fn bytes(&self) -> usize {
        self.opaque.bytes() + self.transparent.bytes()
    }
}
