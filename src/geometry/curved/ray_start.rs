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

    /// Where a ray's line passes through a curved surface so, bounds aside; `None` if it does not, which is decided
    /// exactly: a rounded line may miss the surface that it grazes.
    pub fn on_curved(origin: Vec3, direction: Vec3, shape: &Shape, crossing: Crossing) -> Option<RayStart> {
        let in_floats = OnLine::new(shape, &root::ray_line::<Bounded>(origin, direction)).surface;
        let meets = root::has_crossing(&in_floats, crossing).unwrap_or_else(|| {
            let exact = OnLine::new(shape, &root::ray_line(origin, direction));
            root::exact_place(&exact.surface, crossing).is_some()
        });
        let rounded = || match root::place(&in_floats, crossing) {
            Some(t) if t.error.is_finite() => parameter(t),
            _ => RayParameter { value: 0.0, error: f64::INFINITY },
        };
        meets.then(|| RayStart { rounded: rounded(), place: Place::Curved(*shape, crossing) })
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
    use crate::geometry::curved::{Ellipsoid, InfinitePlane};
    use crate::geometry::surd::Surd;

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

    #[test]
    fn a_ray_begins_nowhere_on_a_surface_that_its_line_misses_by_a_roundoff() {
        let ball = Shape::sphere(Vec3::ZERO, 1.0);
        // From beside the ball floats tell by how much; from far away only exact numbers do.
        for z in [0.0, -1e6] {
            for crossing in [Crossing::Entering, Crossing::Leaving] {
                let start = |x: f32| RayStart::on_curved(Vec3::new(x, 0.0, z), Vec3::Z, &ball, crossing);
                assert!(start(1.0_f32.next_up()).is_none(), "{z} {crossing:?}");
                for x in [1.0_f32, 1.0_f32.next_down()] {
                    let exact = start(x).expect("it meets it").exact(Vec3::new(x, 0.0, z), Vec3::Z);
                    let place = root::round(&exact.numerator, &Surd::rational(exact.denominator));
                    let half = (1.0 - f64::from(x).powi(2)).sqrt();
                    let along = if crossing == Crossing::Entering { -half } else { half };
                    assert!((place - (along - f64::from(z))).abs() < 1e-9, "{z} {crossing:?}: {place}");
                }
            }
        }
    }

    #[test]
    fn a_start_whose_computation_overflows_is_known_exactly_alone() {
        // A discriminant of 1e380.
        let ball =
            Shape::Ellipsoid(Ellipsoid { centre: Vec3::ZERO, axes: Vec3::AXES.map(|axis| axis * 1e38) });
        for (crossing, sign) in [(Crossing::Entering, -1.0), (Crossing::Leaving, 1.0)] {
            let start = RayStart::on_curved(Vec3::ZERO, Vec3::X, &ball, crossing).expect("it meets it");
            assert_eq!((start.rounded().value, start.rounded().error), (0.0, f64::INFINITY));
            let exact = start.exact(Vec3::ZERO, Vec3::X);
            let place = root::round(&exact.numerator, &Surd::rational(exact.denominator));
            assert_eq!(place, sign * f64::from(1e38_f32));
        }
    }

    #[test]
    fn a_ray_begins_on_a_plane_if_it_passes_through_it_to_that_side() {
        // A direction that is parallel to it but for 2^-48.
        let normal = Vec3::new(1.0, 1.0, 2.0_f32.powi(-24));
        let plane = Shape::Plane(InfinitePlane { point: Vec3::ZERO, normal });
        for (z, wanted) in [(1.0, Crossing::Leaving), (-1.0, Crossing::Entering)] {
            let direction = Vec3::new(1.0, -1.0, z * 2.0_f32.powi(-24));
            for crossing in [Crossing::Entering, Crossing::Leaving] {
                let start = RayStart::on_curved(-normal, direction, &plane, crossing);
                assert_eq!(start.is_some(), crossing == wanted, "{z} {crossing:?}");
            }
        }
    }
}
