//! The rays that leave a point where a ray hits something.

use super::branch::{reflected, refracted};
use super::{Following, TreeRules};
use crate::geometry::curved::{Crossing, RayStart};
use crate::geometry::planes::orientation;
use crate::geometry::{LightPosition, Sign};
use crate::scene::{Primitive, PrimitiveIndex, Scene};
use crate::shading::normal_at;
use crate::visibility::hierarchy::Ray;
use crate::visibility::{PointSource, SurfacePoint};
use glam::{DVec3, Vec3};

/// What made a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A mirror.
    Reflection,
    /// A transparent surface that it passes through.
    Refraction,
    /// A transparent surface that it does not pass through, for it meets that too flat from inside.
    TotalReflection,
}

/// A ray that leaves a surface.
pub struct Branch {
    /// What made it.
    pub kind: Kind,
    /// The share of its radiance that goes the way that its parent came, linear Rec. 709.
    pub share: [f32; 3],
    /// The ray; `None` if rounding or a bent shading normal leaves it on the wrong side of the surface, or beside it.
    pub ray: Option<Ray>,
}

/// The side of a surface that a ray leaves to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    /// Where its parent came from.
    Viewer,
    /// The other one.
    Beyond,
}

/// The point's surface and the ray that found it.
struct Hit {
    primitive: PrimitiveIndex,
    direction: Vec3,
    crossing: Option<Crossing>,
}

impl Hit {
    fn of(point: &SurfacePoint) -> Option<Hit> {
        match point.source {
            PointSource::Ray { direction, primitive, .. } => {
                Some(Hit { primitive, direction, crossing: None })
            }
            PointSource::OnCurved { direction, primitive, crossing, .. } => {
                Some(Hit { primitive, direction, crossing: Some(crossing) })
            }
            PointSource::Bare => None,
        }
    }

    /// Whether the ray comes from outside: where the polynomial of a curved surface is positive, and from where
    /// the corners of a triangle go round counter-clockwise.
    fn comes_from_outside(&self, scene: &Scene) -> bool {
        match scene.primitive(self.primitive) {
            Primitive::Triangle(corners) => {
                orientation(LightPosition::Towards(-self.direction), corners) == Sign::Negative
            }
            Primitive::Curved(_) => self.crossing == Some(Crossing::Entering),
        }
    }
}

/// The rays of reflection and refraction of a point that the rules follow; none for a point on no surface.
pub fn branches(scene: &Scene, point: &SurfacePoint, rules: &TreeRules) -> Vec<Branch> {
    let Some(hit) = Hit::of(point) else { return Vec::new() };
    let material = scene.material(hit.primitive);
    if !rules.follow(material) {
        return Vec::new();
    }
    let direction = hit.direction.as_dvec3().normalize();
    let normal = normal_at(scene, hit.primitive, point.position, -direction);
    let leave = |towards: DVec3, side: Side| leave(scene, point, &hit, towards, side);
    let mirrored = || leave(reflected(direction, normal), Side::Viewer);
    let mut branches = Vec::new();
    if rules.reflections == Following::On && material.mirror != [0.0; 3] {
        branches.push(Branch { kind: Kind::Reflection, share: material.mirror, ray: mirrored() });
    }
    if let (Following::On, Some(transmission)) = (rules.refractions, material.transmission) {
        let index = f64::from(transmission.refractive_index);
        let ratio = if hit.comes_from_outside(scene) { 1.0 / index } else { index };
        let (kind, ray) = match refracted(direction, normal, ratio) {
            Some(bent) => (Kind::Refraction, leave(bent, Side::Beyond)),
            None => (Kind::TotalReflection, mirrored()),
        };
        if kind != Kind::TotalReflection || rules.reflections == Following::On {
            branches.push(Branch { kind, share: transmission.transmittance, ray });
        }
    }
    branches
}

/// The ray from a point, with origin and direction rounded to floats and from then on given (TRUTH, "Rays of
/// reflection and refraction").
fn leave(scene: &Scene, point: &SurfacePoint, hit: &Hit, towards: DVec3, side: Side) -> Option<Ray> {
    let (origin, direction) = (point.position.as_vec3(), towards.as_vec3());
    if !origin.is_finite() || !direction.is_finite() || direction == Vec3::ZERO {
        return None;
    }
    let start = match scene.primitive(hit.primitive) {
        Primitive::Triangle(corners) => {
            let along = |direction: Vec3| orientation(LightPosition::Towards(-direction), corners);
            let wanted = match side {
                Side::Viewer => -along(hit.direction),
                Side::Beyond => along(hit.direction),
            };
            (along(direction) == wanted).then(|| RayStart::on_triangle(origin, direction, corners))?
        }
        Primitive::Curved(shape) => {
            let came_entering = hit.crossing? == Crossing::Entering;
            let crossing = match (side, came_entering) {
                (Side::Viewer, true) | (Side::Beyond, false) => Crossing::Leaving,
                _ => Crossing::Entering,
            };
            let outwards = shape.gradient(point.position).dot(direction.as_dvec3());
            let wanted = if crossing == Crossing::Leaving { outwards > 0.0 } else { outwards < 0.0 };
            wanted.then(|| RayStart::on_curved(origin, direction, shape, crossing))??
        }
    };
    Some(Ray { origin, direction, start })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::Shape;
    use crate::scene::{Material, ObjectInput, SceneBuilder};

    #[test]
    fn a_mirrored_ray_whose_rounded_line_misses_its_surface_is_none() {
        // Here floats are 2^-13 apart: where a ray grazes the ball, rounding may leave its point above the tangent.
        let centre = Vec3::new(1024.0, 0.0, 1024.0);
        let shape = Shape::sphere(centre, 1.0);
        let mut builder = SceneBuilder::new("a mirror");
        let material = builder.add_material(Material { mirror: [1.0; 3], ..Material::default() });
        let ball = ObjectInput { curved: vec![shape], material, ..ObjectInput::new("ball", vec![], vec![]) };
        builder.add_object(ball).expect("no index");
        let scene = builder.finish();
        let origin = centre + Vec3::new(1.0, 0.0, -4.0);
        let (mut met, mut missed) = (0, 0);
        for steps in 1..200_u8 {
            let direction = Vec3::new(f32::from(steps) * -1e-7, 0.0, 1.0);
            let Some(hit) = shape.first_hit(origin, direction, &RayStart::origin()) else { continue };
            let point = SurfacePoint::on_curved(&scene, origin, direction, 0, hit.crossing);
            let [branch] = &branches(&scene, &point, &TreeRules::of_depth(2))[..] else {
                panic!("one mirror");
            };
            match &branch.ray {
                // It begins somewhere.
                Some(ray) => {
                    ray.start.exact(ray.origin, ray.direction);
                    met += 1;
                }
                None => missed += 1,
            }
        }
        assert!(met > 0 && missed > 0, "{met} and {missed}");
    }
}
