//! Figure 9, "Glass-Leaved Tree": 768 objects under three lights; a slab of six polygons, 511 truncated cones
//! and 256 glass spheres.
//!
//! The tree grows as in the GMT model of Aono and Kunii (1984): every branch ends in two, each bent off by an
//! angle of its own and shorter by a ratio of its own, the larger turned less. The plane of a fork is turned
//! from that of the fork before. Weight draws thin branches down and a steady wind pushes them aside.

use super::shapes::cuboid;
use super::studio::{PAPER_SIZE, Studio, glass, glossy, matt};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::random::Random;
use crate::scene::Scene;
use glam::DVec3;

/// Branches fork so often: nine generations are 511 branches with 256 tips.
const GENERATIONS: u32 = 9;

/// How a child differs from its parent.
struct Rule {
    /// Angle between the two, in degrees.
    bend: f64,
    /// Of their lengths.
    length_ratio: f64,
    /// Of their radii.
    radius_ratio: f64,
}

/// The larger child of every branch, and the smaller.
const RULES: [Rule; 2] = [
    Rule { bend: 20.0, length_ratio: 0.86, radius_ratio: 0.76 },
    Rule { bend: 37.0, length_ratio: 0.77, radius_ratio: 0.66 },
];

/// Turn of the plane of a fork against the one before, in degrees: near the golden angle, so that branches
/// fill the space around.
const DIVERGENCE: f64 = 131.0;

/// What a branch is drawn to, by one over its radius: down, and where the wind blows.
const DRAWN_TO: DVec3 = DVec3::new(0.0022, -0.0012, 0.0006);

const LEAF_RADIUS: f64 = 0.23;

/// A branch that is about to grow.
#[derive(Clone, Copy)]
struct Shoot {
    base: DVec3,
    direction: DVec3,
    /// Perpendicular to the direction: where the next fork opens.
    side: DVec3,
    length: f64,
    radius: f64,
    generation: u32,
}

struct Grove {
    studio: Studio,
    bark: u32,
    leaf: u32,
    random: Random,
    leaves: u32,
    branches: u32,
}

pub(super) fn build() -> Result<Scene> {
    let mut studio = Studio::new("glass-leaved-tree");
    let ground = studio.material(matt("ground", [0.3, 0.36, 0.27]));
    studio.add("ground", ground, cuboid([-60.0, -0.5, -60.0], [60.0, 0.0, 30.0]))?;
    let bark = studio.material(glossy("bark", [0.36, 0.22, 0.12], 0.12, 12.0));
    let leaf = studio.material(glass("glass", [0.8, 0.93, 0.82], 1.2));
    let mut grove = Grove { studio, bark, leaf, random: Random::new(1984), leaves: 0, branches: 0 };
    grove.grow(Shoot {
        base: DVec3::ZERO,
        direction: DVec3::new(-0.06, 1.0, 0.02).normalize(),
        side: DVec3::X,
        length: 2.1,
        radius: 0.36,
        generation: 1,
    })?;
    let mut studio = grove.studio;
    studio.background([0.16, 0.25, 0.38]);
    studio.lamp("sun", [-14.0, 22.0, 12.0], [0.95, 0.9, 0.8]);
    studio.lamp("sky", [13.0, 17.0, 9.0], [0.24, 0.28, 0.36]);
    studio.lamp("low sun", [4.0, 9.0, -18.0], [0.32, 0.27, 0.2]);
    studio.camera([6.0, 13.0, 23.0], [0.5, 5.1, 0.0], 34.0, PAPER_SIZE);
    Ok(studio.finish())
}

impl Grove {
    fn grow(&mut self, shoot: Shoot) -> Result<()> {
        let Shoot { base, direction, side, length, radius, generation } = shoot;
        let tip = base + direction * length;
        let last = generation == GENERATIONS;
        // As thick at the end as its thicker child begins.
        let end_radius = radius * RULES[0].radius_ratio;
        self.branches += 1;
        let branch = Shape::cone(base.as_vec3(), radius as f32, tip.as_vec3(), end_radius as f32);
        self.studio.add(format!("branch {}", self.branches), self.bark, branch)?;
        if last {
            // The leaf hangs on the tip of its branch.
            let centre = tip + direction * (0.9 * LEAF_RADIUS);
            self.leaves += 1;
            let leaf = Shape::sphere(centre.as_vec3(), LEAF_RADIUS as f32);
            return self.studio.add(format!("leaf {}", self.leaves), self.leaf, leaf);
        }
        for (rule, sign) in RULES.iter().zip([1.0, -1.0]) {
            let bend = rule.bend + 5.0 * self.random.signed();
            let (sin, cos) = libm::sincos((sign * bend).to_radians());
            let child_radius = radius * rule.radius_ratio;
            let drawn = DRAWN_TO / child_radius;
            let direction = (direction * cos + side * sin + drawn).normalize();
            let (sin, cos) = libm::sincos((DIVERGENCE + 12.0 * self.random.signed()).to_radians());
            let across = (side - direction * side.dot(direction)).normalize();
            let side = across * cos + direction.cross(across) * sin;
            let length = length * rule.length_ratio * (1.0 + 0.1 * self.random.signed());
            let child = Shoot {
                base: tip,
                direction,
                side,
                length,
                radius: child_radius,
                generation: generation + 1,
            };
            self.grow(child)?;
        }
        Ok(())
    }
}
