//! The scenes in which rays are aimed.

use super::super::parts::{Corners, ball, cuboid, grid, square, v, with_curved};
use crate::geometry::curved::{Ellipsoid, Shape};
use crate::random::Random;
use crate::scene::Scene;
use glam::{DVec3, Vec3};

/// A scene, and what can be aimed at in it.
pub struct Stage {
    pub scene: Scene,
    /// What casts, without the floor.
    pub triangles: Vec<Corners>,
    pub shapes: Vec<Shape>,
    place: Place,
}

/// Where a scene is and how large: its numbers are of the order of 1 before.
#[derive(Debug, Clone, Copy)]
struct Place {
    centre: DVec3,
    size: f64,
}

impl Place {
    fn new(random: &mut Random) -> Place {
        let size = [-20, -4, 0, 0, 0, 3, 20][(random.unit() * 7.0) as usize];
        let size = 2f64.powi(size);
        let away = [0.0, 0.0, 1.0, 30.0, 3000.0][(random.unit() * 5.0) as usize];
        Place { centre: direction(random) * (away * size), size }
    }

    fn of(&self, point: DVec3) -> Vec3 {
        (self.centre + point * self.size).as_vec3()
    }

    fn of_all(&self, triangles: &[Corners]) -> Vec<Corners> {
        triangles.iter().map(|corners| corners.map(|p| self.of(p.as_dvec3()))).collect()
    }
}

/// A direction of length 1, none of them preferred by much.
fn direction(random: &mut Random) -> DVec3 {
    loop {
        let vector = DVec3::new(random.signed(), random.signed(), random.signed());
        let length = vector.length();
        if (0.1..=1.0).contains(&length) {
            return vector / length;
        }
    }
}

impl Stage {
    /// A closed ball of triangles above a floor.
    pub fn ball(random: &mut Random) -> Stage {
        let steps = 3 + (random.unit() * 6.0) as u32;
        Stage::flat(&ball(DVec3::new(0.1, 0.2, -0.1), 1.0, steps), random)
    }

    /// Any triangles above a floor.
    pub fn any(random: &mut Random) -> Stage {
        let mut part = |scale: f64| {
            v((random.signed() * scale) as f32, random.signed() as f32, (random.signed() * scale) as f32)
        };
        match (part(1.0).x * 2.0 + 2.0) as u32 {
            0 => Stage::ball(random),
            1 => {
                let heights: Vec<f32> = (0..81).map(|_| part(1.0).y).collect();
                let place = |x: i32, z: i32| {
                    v(0.3 * (x - 4) as f32, 0.5 * heights[(9 * x + z) as usize], 0.3 * (z - 4) as f32)
                };
                Stage::flat(&grid(8, place), random)
            }
            2 => {
                let (low, high) = (part(1.0), part(1.0));
                let inner = cuboid(v(-0.5, -0.25, -0.5), v(0.25, 0.5, 0.75));
                let outer = cuboid(low.min(high) - 0.25, low.max(high) + 0.25);
                Stage::flat(&[inner, outer].concat(), random)
            }
            _ => {
                let soup: Vec<Corners> = (0..16).map(|_| [part(1.5), part(1.5), part(1.5)]).collect();
                Stage::flat(&soup, random)
            }
        }
    }

    /// Curved surfaces above a floor.
    pub fn curved(random: &mut Random) -> Stage {
        let place = Place::new(random);
        // Each in a quarter of its own, so that few rays which touch one meet another.
        let quarters = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let mut near = |quarter: usize, reach: f64| {
            let (x, z) = quarters[quarter];
            let aside = DVec3::new(random.signed(), random.signed(), random.signed()) * reach;
            place.of(DVec3::new(1.5 * x, 0.5, 1.5 * z) + aside)
        };
        let (a, b, ends, tips) =
            (near(0, 0.25), near(1, 0.25), [near(2, 0.5), near(2, 0.5)], [near(3, 0.5), near(3, 0.5)]);
        let mut length = |least: f64| ((least + 0.25 * random.unit()) * place.size) as f32;
        let axes = [v(1.0, 0.3, 0.0), v(-0.3, 1.0, 0.2), v(0.1, -0.2, 1.0)].map(|axis| axis * length(0.1));
        let shapes = vec![
            Shape::sphere(a, length(0.2)),
            Shape::Ellipsoid(Ellipsoid { centre: b, axes }),
            Shape::cylinder(ends[0], ends[1], length(0.1)),
            Shape::cone(tips[0], length(0.2), tips[1], length(0.01)),
        ];
        let sound = shapes.into_iter().filter(|shape| shape.defect().is_none()).collect::<Vec<_>>();
        let scene = with_curved(&place.of_all(&square(40.0, -6.0)), &sound);
        Stage { scene, triangles: Vec::new(), shapes: sound, place }
    }

    fn flat(triangles: &[Corners], random: &mut Random) -> Stage {
        let place = Place::new(random);
        let triangles = place.of_all(triangles);
        let scene = super::super::parts::soup(&[place.of_all(&square(6.0, -2.0)), triangles.clone()]);
        Stage { scene, triangles, shapes: Vec::new(), place }
    }

    /// A place for the light, above the floor.
    pub fn light(&self, random: &mut Random) -> Vec3 {
        let from = direction(random);
        self.place.of(DVec3::new(from.x, from.y.abs() + 0.3, from.z) * (0.5 + 3.0 * random.unit()))
    }

    /// A place to look from, likewise.
    pub fn eye(&self, random: &mut Random) -> Vec3 {
        self.light(random)
    }

    /// What its lengths are multiples of.
    pub fn size(&self) -> f64 {
        self.place.size
    }
}
