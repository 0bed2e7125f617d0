//! Dark by facing: what turns its back to the light is no shadow query (row 12 of the notes on the 1986
//! paper, TRUTH "Facing"), unless light passes through it.

use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::geometry::curved::{Crossing, Shape};
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::planes::orientation;
use crate::geometry::{LightPosition, LightSpace, Sign};
use crate::scene::{PrimitiveIndex, Scene};
use crate::visibility::{PointSource, SurfacePoint};
use glam::Vec3;
use rayon::prelude::*;

/// A light and the exact side of every triangle's plane that it is on.
pub struct Sides {
    triangles: Vec<Sign>,
    space: LightSpace,
}

/// The sides of its surface that the viewer and the light are on, as seen from a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Facing {
    /// Strictly on the same side, or the point has no surface.
    Towards,
    /// Strictly on different ones.
    Away,
    /// One of them is in the surface's plane, or tangent plane.
    EdgeOn,
}

impl Sides {
    /// Sides of all planes for one light.
    pub fn of(scene: &Scene, light: impl Into<LightPosition>) -> Sides {
        let _floats = StandardFloats::new();
        let light = light.into();
        let triangles = 0..scene.triangles.len() as u32;
        let triangles = triangles
            .into_par_iter()
            .map(|t| orientation(light, scene.corners(t)))
            .in_standard_floats()
            .collect();
        let bounds = scene.bounds().unwrap_or_default();
        Sides { triangles, space: LightSpace::new(light, bounds) }
    }

    /// How the surface of a point faces the light.
    pub fn facing(&self, scene: &Scene, point: &SurfacePoint) -> Facing {
        let _floats = StandardFloats::new();
        let sides = match point.source {
            // The ray comes from where it does not go, so its direction tells the side of its start.
            PointSource::Ray { direction, primitive, .. } => {
                let eye = orientation(LightPosition::Towards(-direction), scene.corners(primitive));
                self.triangles[primitive as usize] * eye
            }
            PointSource::OnCurved { origin, direction, primitive, crossing } => {
                self.on_curved(scene, point, (origin, direction), primitive, crossing)
            }
            PointSource::Bare => Sign::Positive,
        };
        match sides {
            Sign::Positive => Facing::Towards,
            Sign::Negative => Facing::Away,
            Sign::Zero => Facing::EdgeOn,
        }
    }

    fn on_curved(
        &self,
        scene: &Scene,
        point: &SurfacePoint,
        (origin, direction): (Vec3, Vec3),
        primitive: PrimitiveIndex,
        crossing: Crossing,
    ) -> Sign {
        let shape: &Shape = scene.shape(primitive).expect("the source of a point on a curved surface");
        if shape.is_touched(origin, direction) {
            return Sign::Zero;
        }
        let query = PreciseQuery::new(&self.space, point.position, || point.exact(scene));
        // A ray that enters comes from where the polynomial is above zero.
        let eye = if crossing == Crossing::Entering { Sign::Positive } else { Sign::Negative };
        eye * query.side_of_light(shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ObjectInput, SceneBuilder};

    /// How a point of the triangle in the plane y = 0 faces a light, seen by an eye straight above or below
    /// it, whichever way its corners are written.
    fn facing(eye_height: f32, light: Vec3) -> Facing {
        let eye = Vec3::new(0.2, eye_height, 0.2);
        let [one, other] = [[0, 1, 2], [0, 2, 1]].map(|corners| {
            let mut builder = SceneBuilder::new("test");
            let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
            let (name, triangles) = ("t", vec![corners]);
            builder.add_object(ObjectInput::new(name, positions, triangles)).unwrap();
            let scene = builder.finish();
            let point = SurfacePoint::on_ray(&scene, eye, Vec3::NEG_Y * eye_height.signum(), 0);
            Sides::of(&scene, light).facing(&scene, &point)
        });
        assert_eq!(one, other);
        one
    }

    #[test]
    fn only_a_light_strictly_on_the_side_of_the_eye_is_faced() {
        let smallest = f32::from_bits(1);
        for (eye, height, expected) in [
            (1.0, 3.0, Facing::Towards),
            (-1.0, -3.0, Facing::Towards),
            (1.0, -3.0, Facing::Away),
            (-1.0, 3.0, Facing::Away),
            (1.0, smallest, Facing::Towards),
            (1.0, -smallest, Facing::Away),
            (1.0, 0.0, Facing::EdgeOn),
            (-1.0, -0.0, Facing::EdgeOn),
        ] {
            assert_eq!(facing(eye, Vec3::new(5.0, height, -7.0)), expected, "eye {eye}, light {height}");
        }
    }

    #[test]
    fn a_sphere_faces_a_light_beyond_its_tangent_plane() {
        let mut builder = SceneBuilder::new("test");
        let curved = vec![Shape::sphere(Vec3::ZERO, 1.0)];
        builder.add_object(ObjectInput { curved, ..ObjectInput::new("ball", vec![], vec![]) }).unwrap();
        let scene = builder.finish();
        let facing = |origin: Vec3, light: Vec3| {
            let point = SurfacePoint::on_ray(&scene, origin, Vec3::NEG_Y, 0);
            Sides::of(&scene, light).facing(&scene, &point)
        };
        let above = 1.0f32.next_up();
        // From above at the north pole, then from inside at the south pole.
        let (north, south) = (Vec3::Y * 3.0, Vec3::ZERO);
        assert_eq!(facing(north, Vec3::new(9.0, above, 0.0)), Facing::Towards);
        assert_eq!(facing(north, Vec3::new(9.0, 1.0, 0.0)), Facing::EdgeOn);
        assert_eq!(facing(north, Vec3::new(9.0, 1.0f32.next_down(), 0.0)), Facing::Away);
        assert_eq!(facing(south, Vec3::new(9.0, 1.0, 0.0)), Facing::Towards);
        assert_eq!(facing(south, Vec3::new(9.0, -above, 0.0)), Facing::Away);
        // A ray that only touches the sphere.
        assert_eq!(facing(Vec3::new(1.0, 3.0, 0.0), Vec3::new(9.0, 0.0, 0.0)), Facing::EdgeOn);
    }

    #[test]
    fn a_point_on_no_surface_faces_every_light() {
        let scene = Scene::empty("nothing");
        let point = SurfacePoint::bare(Vec3::ONE).unwrap();
        assert_eq!(Sides::of(&scene, Vec3::ZERO).facing(&scene, &point), Facing::Towards);
    }
}
