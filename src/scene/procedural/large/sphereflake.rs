//! Haines's sphereflake: a ball with nine balls a third its size on it, and so on, as triangles.
//!
//! It is `balls` of the Standard Procedural Databases ("A Proposal for Standard Graphics Environments", 1987) with each
//! ball a mesh of its own that is closed. All of them are one object.

use super::skin::Skin;
use super::{SIZE, studio};
use crate::error::Result;
use crate::scene::procedural::spd::ball_directions;
use crate::scene::procedural::spd::turn_to;
use crate::scene::procedural::studio::{glossy, matt};
use crate::scene::{ObjectInput, Scene, SmoothNormals};
use glam::{DAffine3, DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// Meridians of a ball, and bands from pole to pole: 960 triangles.
const MERIDIANS: usize = 32;
const BANDS: usize = 16;

/// So many generations of balls, the first one alone among them.
pub(in crate::scene::procedural) fn build(generations: u32) -> Result<Scene> {
    let mut studio = studio("sphereflake", [0.35, 0.5, 0.7], [2.6, 3.4, 1.9]);
    let ground = studio.material(matt("ground", [0.55, 0.5, 0.42]));
    let mut floor = Skin::default();
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
    let corners = corners.map(|[x, z]| floor.point(DVec3::new(6.0 * x, -0.75, 6.0 * z)));
    floor.quadrangle(corners);
    studio.add_input(floor.into_object("ground", ground))?;
    let material = studio.material(glossy("ball", [0.75, 0.55, 0.3], 0.25, 40.0));
    let mut flake = Flake { skin: Skin::default(), ball: ball(), directions: ball_directions() };
    // The databases have z up.
    let upright = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);
    flake.grow(DVec3::ZERO, 0.5, DVec3::Z, generations, &upright);
    let Flake { skin, ball, .. } = flake;
    let normals = SmoothNormals {
        normals: ball.points.iter().map(|p| p.as_vec3()).collect(),
        corners: skin.triangles.iter().map(|t| t.map(|corner| corner % ball.points.len() as u32)).collect(),
    };
    let input = skin.into_object("balls", material);
    studio.add_input(ObjectInput { normals: Some(normals), ..input })?;
    studio.camera([1.6, 1.15, 2.1], [-0.05, -0.02, 0.0], 40.0, SIZE);
    Ok(studio.finish())
}

/// A ball of radius 1 around the origin, closed.
pub(super) fn ball() -> Skin {
    let mut skin = Skin::default();
    let bottom = skin.point(DVec3::NEG_Y);
    let rings: Vec<Vec<u32>> = (1..BANDS)
        .map(|band| {
            let (radius, depth) = libm::sincos(PI * band as f64 / BANDS as f64);
            let corner = |meridian: usize| {
                let (sin, cos) = libm::sincos(TAU * meridian as f64 / MERIDIANS as f64);
                DVec3::new(radius * sin, -depth, radius * cos)
            };
            (0..MERIDIANS).map(|meridian| skin.point(corner(meridian))).collect()
        })
        .collect();
    let top = skin.point(DVec3::Y);
    let lowest: Vec<u32> = rings[0].iter().rev().copied().collect();
    skin.fan(&lowest, bottom);
    for pair in rings.windows(2) {
        skin.wall(&pair[0], &pair[1]);
    }
    skin.fan(&rings[rings.len() - 1], top);
    skin
}

struct Flake {
    skin: Skin,
    ball: Skin,
    directions: [DVec3; 9],
}

impl Flake {
    fn grow(&mut self, centre: DVec3, radius: f64, direction: DVec3, generations: u32, upright: &DMat3) {
        let place =
            DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(radius)), *upright * centre);
        self.skin.add(&self.ball, &place);
        if generations == 1 {
            return;
        }
        let turn = turn_to(direction);
        for child in self.directions {
            let towards = (turn * child).normalize();
            let child_radius = radius / 3.0;
            let centre = centre + towards * (radius + child_radius);
            self.grow(centre, child_radius, towards, generations - 1, upright);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_closed_and_nearly_a_sphere() {
        let ball = ball();
        assert_eq!((ball.open_edges(), ball.triangles.len(), ball.points.len()), (0, 960, 482));
        assert!((ball.volume() / (4.0 / 3.0 * PI) - 1.0).abs() < 0.03);
    }
}
