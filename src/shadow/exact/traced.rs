//! The exact answer to a float ray, so that a tester's error can be told from the error of its question.

use super::hierarchy::Visit;
use super::integer::{Homogeneous, IntegerLight, LitTriangle, Scale, at_most, decode, dot, side};
use super::integer_shape::{IntegerShape, StartsOn};
use super::point::{RelativePoint, scale_of, scale_with};
use super::roots::Bound;
use super::surd::Surd;
use super::{Arbiter, interval, mask};
use crate::float_environment::StandardFloats;
use crate::geometry::curved::Shape;
use crate::geometry::{ExactPosition, LightPosition};
use crate::scene::{MaskedTriangle, Primitive};
use crate::shadow::TracedRay;
use dashu_int::IBig;
use glam::Vec3;

/// Which part of a ray counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Span {
    /// From `t_near` to `t_far`, both included.
    Traced,
    /// All between the origin and the light, without these.
    Whole,
}

impl Arbiter<'_> {
    /// Whether a closed opaque primitive that casts meets the ray, exactly. A triangle whose plane holds the
    /// ray's direction does not, and neither does a curved surface that the ray runs along.
    pub fn is_blocked(&self, ray: &TracedRay, span: Span) -> bool {
        let _floats = StandardFloats::new();
        let mut blocked = false;
        let towards = LightPosition::Towards(ray.direction);
        self.opaque.walk(towards, &interval::point(ray.origin), |caster| {
            if ray.excluded != Some(caster.primitive) {
                blocked = match self.scene.primitive(caster.primitive) {
                    Primitive::Triangle(corners) => {
                        meets(ray, span, corners, self.scene.masked(caster.primitive).as_ref())
                    }
                    Primitive::Curved(shape) => meets_curved(ray, span, shape),
                };
            }
            if blocked { Visit::Stop } else { Visit::Continue }
        });
        blocked
    }
}

fn meets_curved(ray: &TracedRay, span: Span, shape: &Shape) -> bool {
    let position = ExactPosition::Bare(ray.origin);
    let towards = LightPosition::Towards(ray.direction);
    // One scale for points and direction, so that s in P + s L is t.
    let scale = scale_with(&position, towards, shape).finer(Scale::of([ray.direction]));
    let direction = scale.point(ray.direction);
    let light = IntegerLight::Towards(direction.clone());
    let surface = IntegerShape::new(shape, &light, scale);
    let origin = RelativePoint::new(&position, &light, scale);
    let meets = |light: &Homogeneous, bounds: &[Bound]| surface.common_points(light, &origin, bounds);
    match span {
        Span::Traced => {
            let mut bounds = Vec::new();
            for (end, is_upper) in [(ray.t_near, false), (ray.t_far, true)] {
                if end.is_infinite() {
                    if is_upper == (end < 0.0) {
                        return false;
                    }
                    continue;
                }
                let (numerator, denominator) = fraction(end);
                let (start, slope) =
                    if is_upper { (numerator, -denominator) } else { (-numerator, denominator) };
                bounds.push(Bound::Linear([Surd::from(start), Surd::from(slope)]));
            }
            let common = meets(&light.homogeneous(), &bounds);
            let is_origin_traced = ray.t_near <= 0.0 && ray.t_far >= 0.0;
            !common.places.is_empty() || (is_origin_traced && common.start == Some(StartsOn::Across))
        }
        Span::Whole if ray.t_light.is_infinite() => !meets(&light.homogeneous(), &[]).places.is_empty(),
        Span::Whole => {
            let (numerator, denominator) = fraction(ray.t_light);
            let [x, y, z] =
                [0, 1, 2].map(|i| &origin.rational[i] * &denominator + &direction[i] * &numerator);
            !meets(&[x, y, z, denominator], &[]).places.is_empty()
        }
    }
}

/// A finite float as a fraction with a positive denominator.
fn fraction(value: f32) -> (IBig, IBig) {
    let (mantissa, exponent) = decode(value);
    let (up, down) = (exponent.max(0) as usize, (-exponent).max(0) as usize);
    (IBig::from(mantissa) << up, IBig::ONE << down)
}

fn meets(ray: &TracedRay, span: Span, corners: [Vec3; 3], masked: Option<&MaskedTriangle>) -> bool {
    let position = ExactPosition::Bare(ray.origin);
    // One scale for points and direction, so that t is a quotient without a unit.
    let scale = scale_of(&position, LightPosition::Towards(ray.direction))
        .finer(Scale::of(corners))
        .finer(Scale::of([ray.direction]));
    let direction = scale.point(ray.direction);
    let light = IntegerLight::Towards(direction.clone());
    let Some(triangle) = LitTriangle::new(&light, corners, scale) else { return false };
    let origin = RelativePoint::new(&position, &light, scale);
    if triangle.edges.iter().any(|edge| side(edge, &origin) < 0) {
        return false;
    }
    // t = (value - normal . origin) / (normal . direction); the normal points away from the light.
    let (normal, value) = &triangle.own;
    let (numerator, denominator) = (dot(normal, &origin.rational) - value, -dot(normal, &direction));
    let (from_near, to_far) = match span {
        Span::Traced => {
            (at_most(ray.t_near, &numerator, &denominator), !below(ray.t_far, &numerator, &denominator))
        }
        Span::Whole => {
            (below(0.0, &numerator, &denominator), !at_most(ray.t_light, &numerator, &denominator))
        }
    };
    from_near && to_far && masked.is_none_or(|masked| mask::is_there(masked, &triangle, &origin))
}

/// t < numerator / denominator.
fn below(t: f32, numerator: &IBig, denominator: &IBig) -> bool {
    // -t > -numerator / denominator
    !at_most(-t, &-numerator, denominator)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [Vec3; 3] =
        [Vec3::new(-1.0, -1.0, 2.0), Vec3::new(3.0, -1.0, 2.0), Vec3::new(-1.0, 3.0, 2.0)];

    fn ray(t_near: f32, t_far: f32) -> TracedRay {
        TracedRay {
            origin: Vec3::ZERO,
            direction: Vec3::Z * 4.0,
            t_near,
            t_far,
            t_light: 1.0,
            excluded: None,
        }
    }

    #[test]
    fn both_ends_of_what_is_traced_count_and_one_ulp_decides() {
        let met = |t_near, t_far| meets(&ray(t_near, t_far), Span::Traced, TRIANGLE, None);
        assert!(met(0.0, 1.0) && met(0.5, 1.0) && met(0.0, 0.5) && met(0.5, f32::INFINITY));
        assert!(!met(0.5f32.next_up(), 1.0) && !met(0.0, 0.5f32.next_down()));
    }

    #[test]
    fn the_ends_of_the_whole_segment_do_not_count() {
        let met = |origin: Vec3, t_light| {
            meets(&TracedRay { origin, t_light, ..ray(0.9, 0.1) }, Span::Whole, TRIANGLE, None)
        };
        assert!(met(Vec3::ZERO, 1.0) && met(Vec3::ZERO, f32::INFINITY));
        assert!(!met(Vec3::ZERO, 0.5) && met(Vec3::ZERO, 0.5f32.next_up()));
        assert!(!met(Vec3::new(0.0, 0.0, 2.0), 1.0), "it begins on the triangle");
        assert!(!met(Vec3::new(0.0, 0.0, 2.5), 1.0), "it lies behind");
    }

    #[test]
    fn ends_decide_within_one_ulp_on_a_sphere_too() {
        // Met at t = 0.5 and, from behind, at t = 1.
        let sphere = Shape::sphere(Vec3::Z * 3.0, 1.0);
        let traced = |t_near, t_far| meets_curved(&ray(t_near, t_far), Span::Traced, &sphere);
        assert!(traced(0.0, 0.5) && traced(0.75, 1.0) && traced(1.0, f32::INFINITY));
        assert!(!traced(0.0, 0.5f32.next_down()) && !traced(0.5f32.next_up(), 1.0f32.next_down()));
        assert!(!traced(1.0f32.next_up(), f32::INFINITY));
        let whole = |origin: Vec3, t_light| {
            meets_curved(&TracedRay { origin, t_light, ..ray(0.9, 0.1) }, Span::Whole, &sphere)
        };
        assert!(whole(Vec3::ZERO, 0.5f32.next_up()) && !whole(Vec3::ZERO, 0.5));
        assert!(whole(Vec3::ZERO, f32::INFINITY));
        // From the sphere itself: through it, and away from it.
        assert!(whole(Vec3::Z * 2.0, 1.0) && !whole(Vec3::Z * 2.0, 0.5) && !whole(Vec3::Z * 4.0, 1.0));
        let from_far_side = TracedRay { origin: Vec3::Z * 4.0, ..ray(0.0, 1.0) };
        assert!(meets_curved(&from_far_side, Span::Traced, &sphere), "t = 0 is traced");
        assert!(!meets_curved(&TracedRay { t_near: 1e-30, ..from_far_side }, Span::Traced, &sphere));
    }

    #[test]
    fn edges_belong_to_the_triangle_and_planes_along_the_ray_do_not_block() {
        let beside = |x: f32| {
            meets(
                &TracedRay { origin: Vec3::new(x, 0.0, 0.0), ..ray(0.0, 1.0) },
                Span::Traced,
                TRIANGLE,
                None,
            )
        };
        assert!(beside(-1.0) && !beside((-1.0f32).next_down()));
        let edge_on = [Vec3::ZERO, Vec3::Z, Vec3::Y];
        assert!(!meets(&ray(0.0, 1.0), Span::Traced, edge_on, None));
    }
}
