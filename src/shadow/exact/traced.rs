//! The exact answer to a float ray, so that a tester's error can be told from the error of its question.

use super::hierarchy::Visit;
use super::integer::{IntegerLight, LitTriangle, RelativePoint, Scale, at_most, dot, scale_of, side};
use super::{Arbiter, interval, mask};
use crate::geometry::{ExactPosition, LightPosition};
use crate::scene::MaskedTriangle;
use crate::shadow::TracedRay;
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
    /// Whether a closed triangle that casts meets the ray, exactly. One whose plane holds the ray's direction
    /// does not.
    pub fn is_blocked(&self, ray: &TracedRay, span: Span) -> bool {
        let mut blocked = false;
        let towards = LightPosition::Towards(ray.direction);
        self.hierarchy.walk(towards, &interval::point(ray.origin), |casting| {
            if ray.excluded != Some(self.triangles[casting as usize]) {
                let masked = self.scene.masked(self.triangles[casting as usize]);
                blocked = meets(ray, span, self.corners(casting), masked.as_ref());
            }
            if blocked { Visit::Stop } else { Visit::Continue }
        });
        blocked
    }
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
    let (numerator, denominator) = (dot(normal, &origin.xyz) - value, -dot(normal, &direction));
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
fn below(t: f32, numerator: &dashu_int::IBig, denominator: &dashu_int::IBig) -> bool {
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
