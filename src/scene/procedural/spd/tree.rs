//! A tree of cones that forks in two at every tip, with a sphere in every joint.

use super::{NO_SHINE, level_square, studio, surface, upright};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::scene::Scene;
use crate::scene::procedural::shapes::{turned_y, turned_z};
use crate::scene::procedural::studio::Studio;
use glam::{DMat3, DVec3};

const LIGHTS: [[f32; 3]; 7] = [
    [-5.0, 5.0, 50.0],
    [30.0, -30.0, 30.0],
    [-40.0, -30.0, 20.0],
    [10.0, 30.0, 40.0],
    [-30.0, 40.0, 10.0],
    [50.0, 25.0, 20.0],
    [-10.0, -60.0, 30.0],
];

/// Radius at the end of a branch over that at its beginning.
const TAPER: f64 = 0.67;

/// The two branches of a fork: how far each leans, where to, and its length over its parent's.
const FORK: [(f64, f64, f64); 2] = [(40.0, 0.0, 0.65), (25.0, 140.0, 0.7)];

pub(in crate::scene::procedural) fn build(size: u32) -> Result<Scene> {
    let mut studio = studio("tree", &upright([4.5, 0.4, 2.0], [0.0, 0.0, 1.5]), &LIGHTS);
    let ground = studio.material(surface("ground", [0.2, 0.7, 0.2], [1.0, 0.0, NO_SHINE]));
    studio.add_input(level_square("ground", ground, 50.0, 0.0))?;
    let bark = studio.material(surface("bark", [0.55, 0.4, 0.2], [1.0, 0.0, NO_SHINE]));
    // Each fork lies across the one before.
    let turns = FORK.map(|(lean, azimuth, ratio)| {
        let [lean, azimuth, across] = [lean, azimuth, 90.0].map(f64::to_radians);
        ((turned_z(azimuth) * turned_y(lean) * turned_z(across)).matrix3, ratio)
    });
    let mut tree = Tree { studio, bark, turns, count: 0 };
    tree.grow(DVec3::ZERO, DMat3::IDENTITY, [1.0, 0.15], size)?;
    Ok(tree.studio.finish())
}

struct Tree {
    studio: Studio,
    bark: u32,
    turns: [(DMat3, f64); 2],
    count: u32,
}

impl Tree {
    fn grow(&mut self, base: DVec3, frame: DMat3, [length, radius]: [f64; 2], forks: u32) -> Result<()> {
        let tip = base + frame.z_axis * length;
        let end = radius * TAPER;
        self.count += 1;
        let (base, apex) = (base.as_vec3(), tip.as_vec3());
        let shapes = [Shape::cone(base, radius as f32, apex, end as f32), Shape::sphere(apex, end as f32)];
        self.studio.add(format!("branch {}", self.count), self.bark, shapes)?;
        if forks > 0 {
            for (turn, ratio) in self.turns {
                self.grow(tip, frame * turn, [length * ratio, end], forks - 1)?;
            }
        }
        Ok(())
    }
}
