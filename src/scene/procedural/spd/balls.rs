//! A ball with nine balls a third its size on it, and so on: a fractal of spheres.

use super::{NO_SHINE, level_square, studio, surface, upright};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::scene::Scene;
use crate::scene::procedural::studio::Studio;
use glam::{DMat3, DQuat, DVec3};
use std::f64::consts::TAU;

pub(in crate::scene::procedural) fn build(size: u32) -> Result<Scene> {
    let view = upright([2.1, 1.3, 1.7], [0.0; 3]);
    let mut studio = studio("balls", &view, &[[4.0, 3.0, 2.0], [1.0, -4.0, 4.0], [-3.0, 1.0, 5.0]]);
    let ground = studio.material(surface("ground", [1.0, 0.75, 0.33], [0.8, 0.0, NO_SHINE]));
    studio.add_input(level_square("ground", ground, 12.0, -0.5))?;
    let material = studio.material(surface("ball", [1.0, 0.9, 0.7], [0.5, 0.5, 3.0827]));
    let mut balls = Balls { studio, material, count: 0, directions: directions() };
    balls.grow(DVec3::ZERO, 0.5, DVec3::Z, size)?;
    Ok(balls.studio.finish())
}

struct Balls {
    studio: Studio,
    material: u32,
    count: u32,
    directions: [DVec3; 9],
}

/// Where the nine stand on a ball whose own back is at -z: three above, six around its equator.
pub(in crate::scene::procedural) fn directions() -> [DVec3; 9] {
    // Three close neighbours; on the equator at fifteen degrees to either side of the diagonal's thirty.
    let (low, high) = (libm::sincos(TAU / 24.0), libm::sincos(5.0 * TAU / 24.0));
    let triple = [
        DVec3::new(1.0, 1.0, 2.0).normalize(),
        DVec3::new(low.1, low.0, 0.0),
        DVec3::new(high.1, high.0, 0.0),
    ];
    std::array::from_fn(|number| {
        let (sin, cos) = libm::sincos(TAU * (number / 3) as f64 / 3.0);
        let DVec3 { x, y, z } = triple[number % 3];
        DVec3::new(cos * x - sin * y, sin * x + cos * y, z)
    })
}

/// The shortest turn that takes z to a direction.
pub(in crate::scene::procedural) fn turn_to(direction: DVec3) -> DMat3 {
    // Straight down every turn by half a circle about a level axis is as short; it is the y axis's.
    match direction.z < -1.0 + 1e-9 {
        true => DMat3::from_diagonal(DVec3::new(-1.0, 1.0, -1.0)),
        false => DMat3::from_quat(DQuat::from_rotation_arc(DVec3::Z, direction)),
    }
}

impl Balls {
    fn grow(&mut self, centre: DVec3, radius: f64, direction: DVec3, generations: u32) -> Result<()> {
        self.count += 1;
        let ball = Shape::sphere(centre.as_vec3(), radius as f32);
        self.studio.add(format!("ball {}", self.count), self.material, ball)?;
        if generations == 0 {
            return Ok(());
        }
        let turn = turn_to(direction);
        for child in self.directions {
            let towards = (turn * child).normalize();
            let child_radius = radius / 3.0;
            self.grow(centre + towards * (radius + child_radius), child_radius, towards, generations - 1)?;
        }
        Ok(())
    }
}
