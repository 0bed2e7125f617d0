//! The definition itself, in integers: every primitive, no filter, no culling. It checks the arbiter.

use super::Occlusion;
use super::integer::{IntegerLight, LitTriangle, Scale, scale_of_light, side};
use super::integer_shape::{IntegerShape, scale_of_shape};
use super::mask;
use super::point::{RelativePoint, scale_of};
use crate::float_environment::StandardFloats;
use crate::geometry::LightPosition;
use crate::scene::{Primitive, PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;

/// All primitives of a scene that cast, exact and relative to one light, in one scale.
pub struct PlainTest<'a> {
    scene: &'a Scene,
    light: IntegerLight,
    scale: Scale,
    opaque: Vec<Caster>,
    transparent: Vec<Caster>,
}

/// A primitive.
struct Caster {
    primitive: PrimitiveIndex,
    form: Form,
}

enum Form {
    Triangle(LitTriangle),
    Curved(IntegerShape),
}

impl<'a> PlainTest<'a> {
    /// Prepares the primitives; the scale holds each of them, the light and the points that will be asked.
    pub fn new(scene: &'a Scene, light: LightPosition, points: &[SurfacePoint]) -> PlainTest<'a> {
        let _floats = StandardFloats::new();
        let casting = || (0..scene.primitive_count()).filter(|&p| scene.object(p).shadowing.casts);
        let scale_of_caster = |p| match scene.primitive(p) {
            Primitive::Triangle(corners) => Scale::of(corners),
            Primitive::Curved(shape) => scale_of_shape(shape),
        };
        let casters = casting().map(scale_of_caster);
        let points = points.iter().map(|p| scale_of(&p.exact(scene), light));
        let scale = casters.chain(points).fold(scale_of_light(light), Scale::finer);
        let light = IntegerLight::new(light, scale);
        let caster = |primitive| {
            let form = match scene.primitive(primitive) {
                Primitive::Triangle(corners) => Form::Triangle(LitTriangle::new(&light, corners, scale)?),
                Primitive::Curved(shape) => Form::Curved(IntegerShape::new(shape, &light, scale)),
            };
            Some(Caster { primitive, form })
        };
        let (transparent, opaque) =
            casting().filter_map(caster).partition(|caster| scene.is_transparent(caster.primitive));
        PlainTest { scene, light, scale, opaque, transparent }
    }

    /// Whether any opaque primitive blocks the open segment from the point to the light.
    pub fn decide(&self, point: &SurfacePoint) -> Occlusion {
        let _floats = StandardFloats::new();
        let p = self.relative(point);
        let blocks = |caster: &Caster| match &caster.form {
            Form::Triangle(t) => {
                t.edges.iter().all(|edge| side(edge, &p) >= 0)
                    && side(&t.own, &p) > 0
                    && self.is_there(caster.primitive, t, &p)
            }
            Form::Curved(shape) => {
                let meeting = shape.meet(&self.light.homogeneous(), &p);
                meeting.passes_through || meeting.touches
            }
        };
        if self.opaque.iter().any(blocks) { Occlusion::Occluded } else { Occlusion::Lit }
    }

    /// The transparent primitives that the segment crosses, in ascending order, each as often as it does.
    pub fn crossed(&self, point: &SurfacePoint) -> Vec<PrimitiveIndex> {
        let _floats = StandardFloats::new();
        let p = self.relative(point);
        let crossings = |caster: &Caster| match &caster.form {
            Form::Triangle(t) => usize::from(t.is_crossed(&p) && self.is_there(caster.primitive, t, &p)),
            Form::Curved(shape) => shape.meet(&self.light.homogeneous(), &p).crossings,
        };
        let crossed = |caster: &Caster| std::iter::repeat_n(caster.primitive, crossings(caster));
        self.transparent.iter().flat_map(crossed).collect()
    }

    fn relative(&self, point: &SurfacePoint) -> RelativePoint {
        RelativePoint::new(&point.exact(self.scene), &self.light, self.scale)
    }

    fn is_there(&self, primitive: PrimitiveIndex, triangle: &LitTriangle, point: &RelativePoint) -> bool {
        self.scene.masked(primitive).is_none_or(|masked| mask::is_there(&masked, triangle, point))
    }
}
