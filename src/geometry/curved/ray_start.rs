//! Where rays begin on their lines: at their origin, or where the line meets the surface that they leave.

use super::on_line::OnLine;
use super::root::{self, ExactParameter, Field};
use super::{Crossing, Shape};
use crate::geometry::bounded::Bounded;
use crate::geometry::planes::Plane;
use crate::geometry::ray_triangle::{self, RayParameter};
use glam::{DVec3, Vec3};

/// The beginning of a ray, which does not belong to it.
///
/// The origin of a ray that leaves a surface is a rounded point, beside the surface. The ray begins where its
/// line meets that (TRUTH, "Rays of reflection and refraction"), so that it can neither hit the surface again
/// there nor miss what lies between.
#[derive(Debug, Clone, Copy)]
pub struct RayStart {
    rounded: RayParameter,
    place: Place,
}

#[derive(Debug, Clone, Copy)]
enum Place {
    Origin,
    Plane([Vec3; 3]),
    Curved(Shape, Crossing),
}

impl RayStart {
    /// The ray's origin.
    pub fn origin() -> RayStart {
        RayStart { rounded: RayParameter { value: 0.0, error: 0.0 }, place: Place::Origin }
    }

    /// Where a ray's line meets the plane of a triangle that it is not parallel to.
    pub fn on_triangle(origin: Vec3, direction: Vec3, corners: [Vec3; 3]) -> RayStart {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let plane = Plane::through(b - a, c - a);
        let place = |v: DVec3| {
            let (value, error) = plane.dot(v, v.abs() * f64::EPSILON);
            Bounded { value, error }
        };
        let t = place(a - origin.as_dvec3()).quotient(&place(direction.as_dvec3()));
        RayStart { rounded: parameter(t), place: Place::Plane(corners) }
    }

    /// Where a ray's line passes through a curved surface so; `None` if it does not.
    pub fn on_curved(origin: Vec3, direction: Vec3, shape: &Shape, crossing: Crossing) -> Option<RayStart> {
        let on_line = OnLine::new(shape, &root::ray_line::<Bounded>(origin, direction));
        let place = Place::Curved(*shape, crossing);
        let rounded = match root::place(&on_line.surface, crossing) {
            Some(t) if t.error.is_finite() => parameter(t),
            _ => {
                let exact = OnLine::new(shape, &root::ray_line(origin, direction));
                root::exact_place(&exact.surface, crossing)?;
                RayParameter { value: 0.0, error: f64::INFINITY }
            }
        };
        Some(RayStart { rounded, place })
    }

    /// In f64, within its error.
    pub fn rounded(&self) -> RayParameter {
        self.rounded
    }

    /// Exactly, for the ray that it was made for.
    pub fn exact(&self, origin: Vec3, direction: Vec3) -> ExactParameter {
        match &self.place {
            Place::Origin => ExactParameter::zero(),
            Place::Plane(corners) => ray_triangle::exact_parameter(origin, direction, *corners),
            Place::Curved(shape, crossing) => root::exact_parameter(origin, direction, shape, *crossing),
        }
    }
}

fn parameter(t: Bounded) -> RayParameter {
    RayParameter { value: t.value, error: t.error }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::InfinitePlane;

    #[test]
    fn a_ray_begins_on_a_surface_where_its_line_meets_it() {
        let ball = Shape::sphere(Vec3::Z * 5.0, 1.0);
        let start = RayStart::on_curved(Vec3::ZERO, Vec3::Z, &ball, Crossing::Entering).expect("it meets it");
        assert!(start.rounded().value == 4.0 && start.rounded().error < 1e-12);
        // Not where it runs beside it.
        let plane = Shape::Plane(InfinitePlane { point: Vec3::Z, normal: Vec3::Z });
        assert!(RayStart::on_curved(Vec3::ZERO, Vec3::X, &plane, Crossing::Entering).is_none());
        // Where it touches, the place is known exactly alone.
        let touch = RayStart::on_curved(Vec3::X, Vec3::Z, &ball, Crossing::Leaving).expect("it touches it");
        assert_eq!(
            touch.exact(Vec3::X, Vec3::Z).order(&start.exact(Vec3::ZERO, Vec3::Z)),
            std::cmp::Ordering::Greater
        );
    }
}
