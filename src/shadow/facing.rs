//! Dark by facing: what turns its back to the light is no shadow query (row 12 of the notes on the 1986
//! paper, TRUTH "Facing").

use crate::geometry::planes::orientation;
use crate::geometry::{LightPosition, Sign};
use crate::scene::Scene;
use crate::visibility::{PointSource, SurfacePoint};
use rayon::prelude::*;

/// The exact side of every triangle's plane that some point lies on.
pub struct Sides(Vec<Sign>);

impl Sides {
    /// Sides of all planes for one point, or for a light infinitely far away.
    pub fn of(scene: &Scene, point: impl Into<LightPosition>) -> Sides {
        let point = point.into();
        let triangles = 0..scene.triangles.len() as u32;
        Sides(triangles.into_par_iter().map(|t| orientation(point, scene.corners(t))).collect())
    }
}

/// Whether a surface point faces the light: the start of its ray and the light lie strictly on the same
/// side of its plane. Bare points have no face and always count as facing.
///
/// `light` are the sides of the light, `eye` those of the start of the point's ray.
pub fn faces(point: &SurfacePoint, light: &Sides, eye: &Sides) -> bool {
    match point.source {
        PointSource::Ray { primitive, .. } => {
            light.0[primitive as usize] * eye.0[primitive as usize] == Sign::Positive
        }
        PointSource::OnCurved { .. } => todo!("points on curved surfaces"),
        PointSource::Bare => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ObjectInput, SceneBuilder};
    use glam::Vec3;

    /// Whether a point of the triangle in the plane y = 0 faces a light, seen by an eye straight above or
    /// below it, whichever way its corners are written.
    fn faces_light(eye_height: f32, light: Vec3) -> bool {
        let eye = Vec3::new(0.2, eye_height, 0.2);
        let [one, other] = [[0, 1, 2], [0, 2, 1]].map(|corners| {
            let mut builder = SceneBuilder::new("test");
            let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Z];
            let (name, triangles) = ("t", vec![corners]);
            builder.add_object(ObjectInput::new(name, positions, triangles)).unwrap();
            let scene = builder.finish();
            let point = SurfacePoint::on_ray(&scene, eye, Vec3::NEG_Y * eye_height.signum(), 0);
            faces(&point, &Sides::of(&scene, light), &Sides::of(&scene, eye))
        });
        assert_eq!(one, other);
        one
    }

    #[test]
    fn only_a_light_strictly_on_the_side_of_the_eye_is_faced() {
        let smallest = f32::from_bits(1);
        for (eye, height, expected) in [
            (1.0, 3.0, true),
            (-1.0, -3.0, true),
            (1.0, -3.0, false),
            (-1.0, 3.0, false),
            (1.0, smallest, true),
            (1.0, -smallest, false),
            (1.0, 0.0, false),
            (-1.0, -0.0, false),
        ] {
            assert_eq!(faces_light(eye, Vec3::new(5.0, height, -7.0)), expected, "eye {eye}, light {height}");
        }
    }

    #[test]
    fn a_point_on_no_surface_faces_every_light() {
        let nothing = Sides(Vec::new());
        assert!(faces(&SurfacePoint::bare(Vec3::ONE).unwrap(), &nothing, &nothing));
    }
}
