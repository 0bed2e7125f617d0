//! One point and one light, held against one primitive at a time: in intervals, and if those cannot tell in
//! integers.

use super::casters::{Caster, FirstStage};
use super::integer::{self, IntegerLight, LitTriangle, Meeting, Scale};
use super::interval::{self, Box3, cross, dot, minus};
use super::interval_shape::{IntervalShape, Reach, Start};
use super::point::{RelativePoint, scale_of};
use super::{integer_shape, mask, own_surface};
use crate::geometry::curved::Shape;
use crate::geometry::{ExactPosition, LightPosition};
use crate::scene::{PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;
use glam::Vec3;

/// A point that a light shines on.
pub struct Query<'a> {
    scene: &'a Scene,
    light: LightPosition,
    /// The exact point.
    pub position: ExactPosition,
    /// What it lies on.
    receiver: Option<PrimitiveIndex>,
    /// A box around it, relative to the origin of the light.
    relative: Box3,
    /// From it towards the light.
    direction: Box3,
    reach: Reach,
}

impl<'a> Query<'a> {
    /// The query of a point.
    pub fn new(scene: &'a Scene, light: LightPosition, point: &SurfacePoint) -> Query<'a> {
        let position = point.exact(scene);
        let relative = relative_box(&position, light);
        let (direction, reach) = match light {
            LightPosition::At(_) => (relative.map(|x| -x), Reach::Segment),
            LightPosition::Towards(direction) => (interval::point(direction), Reach::HalfLine),
        };
        Query { scene, light, position, receiver: point.primitive(), relative, direction, reach }
    }

    /// A box around the point in world space.
    pub fn absolute(&self) -> Box3 {
        let light = origin_of(self.light);
        [0, 1, 2].map(|i| self.relative[i] + light[i])
    }

    /// Whether a primitive lies in the surface that the point is on.
    pub fn is_own_surface(&self, primitive: PrimitiveIndex) -> bool {
        self.receiver.is_some_and(|receiver| own_surface::is_shared(self.scene, receiver, primitive))
    }

    /// How the segment meets a primitive, holes left out.
    pub fn meeting(&self, caster: &Caster) -> Meeting {
        match &caster.first_stage {
            // The receiver lies in its own plane, where nothing blocks.
            FirstStage::Triangle(_) if self.receiver == Some(caster.primitive) => Meeting::Misses,
            FirstStage::Triangle(planes) => {
                let corners = self.scene.corners(caster.primitive);
                let exactly = || integer::meet(self.light, corners, &self.position);
                self.unless_a_hole(planes.meet(&self.relative).unwrap_or_else(exactly), caster.primitive)
            }
            FirstStage::Curved(shape) => match self.certain_crossings(shape, caster.primitive, 1) {
                Some(0) => Meeting::Misses,
                Some(_) => Meeting::Interior,
                None => {
                    integer_shape::meet(self.light, self.shape(caster.primitive), &self.position).meeting()
                }
            },
        }
    }

    /// How often the segment crosses a primitive, as crossings of transparent ones are counted.
    pub fn crossings(&self, caster: &Caster) -> usize {
        match &caster.first_stage {
            FirstStage::Triangle(_) if self.receiver == Some(caster.primitive) => 0,
            FirstStage::Triangle(planes) => {
                let corners = self.scene.corners(caster.primitive);
                let is_crossed = match planes.meet(&self.relative) {
                    Some(meeting) => meeting == Meeting::Interior,
                    None => integer::crosses(self.light, corners, &self.position),
                };
                usize::from(is_crossed && !self.is_in_a_hole(caster.primitive))
            }
            FirstStage::Curved(shape) => {
                self.certain_crossings(shape, caster.primitive, 2).unwrap_or_else(|| {
                    integer_shape::meet(self.light, self.shape(caster.primitive), &self.position).crossings
                })
            }
        }
    }

    fn certain_crossings(
        &self,
        shape: &IntervalShape,
        primitive: PrimitiveIndex,
        enough: usize,
    ) -> Option<usize> {
        let receiver = self.receiver.and_then(|receiver| self.scene.shape(receiver));
        let from = if receiver == Some(self.shape(primitive)) { Start::On } else { Start::Anywhere };
        shape.crossings(&self.relative, &self.direction, self.reach, from, enough)
    }

    /// How often it crosses a curved surface, if intervals can tell.
    #[cfg(test)]
    pub fn certainly_crossed(&self, caster: &Caster) -> Option<usize> {
        match &caster.first_stage {
            FirstStage::Triangle(_) => None,
            FirstStage::Curved(shape) => self.certain_crossings(shape, caster.primitive, 2),
        }
    }

    fn shape(&self, primitive: PrimitiveIndex) -> &Shape {
        self.scene.shape(primitive).expect("a curved caster")
    }

    /// A triangle that is met in a hole of its mask is missed.
    fn unless_a_hole(&self, meeting: Meeting, primitive: PrimitiveIndex) -> Meeting {
        let is_through = matches!(meeting, Meeting::Interior | Meeting::Boundary(_));
        if is_through && self.is_in_a_hole(primitive) { Meeting::Misses } else { meeting }
    }

    /// Whether a triangle that is met has a hole there.
    fn is_in_a_hole(&self, primitive: PrimitiveIndex) -> bool {
        let Some(masked) = self.scene.masked(primitive) else { return false };
        let corners = self.scene.corners(primitive);
        let scale = scale_of(&self.position, self.light).finer(Scale::of(corners));
        let light = IntegerLight::new(self.light, scale);
        let point = RelativePoint::new(&self.position, &light, scale);
        let triangle = LitTriangle::new(&light, corners, scale).expect("a triangle that is met");
        !mask::is_there(&masked, &triangle, &point)
    }
}

/// What points are taken relative to in intervals: the light, or the origin.
pub fn origin_of(light: LightPosition) -> Box3 {
    match light {
        LightPosition::At(point) => interval::point(point),
        LightPosition::Towards(_) => interval::point(Vec3::ZERO),
    }
}

/// An interval box around the exact point minus the origin.
fn relative_box(position: &ExactPosition, light: LightPosition) -> Box3 {
    let light = origin_of(light);
    let (origin, direction, t) = match *position {
        ExactPosition::Bare(p) => return minus(&interval::point(p), &light),
        ExactPosition::OnCurved { origin, direction, ref shape, crossing } => {
            let o = interval::point(origin);
            let start = interval::point(Vec3::ZERO);
            let t = IntervalShape::new(shape, &o).root(&start, &interval::point(direction), crossing);
            (origin, direction, t)
        }
        ExactPosition::OnRay { origin, direction, triangle } => {
            let [a, b, c] = triangle.map(interval::point);
            let (o, d) = (interval::point(origin), interval::point(direction));
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            (origin, direction, dot(&normal, &minus(&a, &o)).divided_by(dot(&normal, &d)))
        }
    };
    interval::along(&minus(&interval::point(origin), &light), &interval::point(direction), t)
}
