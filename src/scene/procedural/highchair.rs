//! Figure 7, "Sarah's Highchair": 33 objects of 6702 polygons, two cylinders and eight quadrics under three
//! lights.
//!
//! A child's chair of turned wood: four splayed legs on rubber feet, stretchers, a footrest, a saddled seat,
//! a back of spindles under a bent crest, arms on turned supports, and a tray on two steel rods with a cup and
//! an egg. Lengths in decimetres.

mod parts;

use self::parts::{arm, crest, footrest, leg_profile, post_profile, seat, spindle_profile};
use self::parts::{stretcher_profile, support_profile, tray};
use super::shapes::{Caps, Mesh, along, circle, cuboid, lathe, moved, prism};
use super::studio::{PAPER_SIZE, Studio, glossy, matt, metal, polished};
use crate::error::Result;
use crate::geometry::curved::{Ellipsoid, Shape};
use crate::scene::Scene;
use glam::{DVec3, Vec3};

pub(super) fn build() -> Result<Scene> {
    let mut studio = Studio::new("highchair");
    let floor = studio.material(polished("floor", [0.3, 0.19, 0.11], 0.3));
    studio.add("floor", floor, cuboid([-26.0, -0.4, -7.0], [20.0, 0.0, 20.0]))?;
    let wall = studio.material(matt("wall", [0.56, 0.6, 0.58]));
    studio.add("wall", wall, cuboid([-26.0, 0.002, -7.4], [20.0, 22.0, -7.0]))?;
    let chair = Chair {
        wood: studio.material(glossy("beech", [0.62, 0.4, 0.2], 0.3, 40.0)),
        dark: studio.material(glossy("cherry", [0.46, 0.2, 0.1], 0.35, 50.0)),
        rubber: studio.material(matt("rubber", [0.05; 3])),
        steel: studio.material(metal("steel", [0.2; 3], [0.5; 3])),
        cup: studio.material(glossy("red enamel", [0.7, 0.07, 0.06], 0.5, 80.0)),
        egg: studio.material(glossy("egg", [0.78, 0.66, 0.52], 0.15, 20.0)),
    };
    chair.add_base(&mut studio)?;
    chair.add_back(&mut studio)?;
    chair.add_tray(&mut studio)?;
    studio.lamp("window", [-5.5, 11.5, 5.5], [0.75, 0.73, 0.68]);
    studio.lamp("ceiling", [1.7, 13.0, 2.2], [0.3, 0.29, 0.26]);
    studio.lamp("corner", [6.0, 6.5, 4.4], [0.24, 0.2, 0.15]);
    studio.camera([9.0, 10.2, 17.4], [0.35, 4.75, 0.0], 37.0, PAPER_SIZE);
    Ok(studio.finish())
}

/// Upper side of the seat.
const SEAT: f64 = 5.6;

/// Where a leg stands and where it meets the seat, for the corner with these signs.
fn leg_ends([sx, sz]: [f64; 2]) -> [DVec3; 2] {
    [DVec3::new(2.05 * sx, 0.16, 2.0 * sz), DVec3::new(1.3 * sx, SEAT - 0.42, 1.2 * sz)]
}

/// A point of a leg at this height.
fn on_leg(corner: [f64; 2], height: f64) -> DVec3 {
    let [foot, top] = leg_ends(corner);
    foot + (top - foot) * ((height - foot.y) / (top.y - foot.y))
}

/// A turned part of height 1 between two points.
fn turned(profile: &[[f64; 2]], steps: usize, from: DVec3, to: DVec3) -> Mesh {
    lathe(profile, steps, Caps::Flat).smooth_up_to(50.0).placed(&along(from, to, 1.0))
}

const CORNERS: [([f64; 2], &str); 4] = [
    ([-1.0, 1.0], "front left"),
    ([1.0, 1.0], "front right"),
    ([1.0, -1.0], "back right"),
    ([-1.0, -1.0], "back left"),
];

/// Materials of the chair.
struct Chair {
    wood: u32,
    dark: u32,
    rubber: u32,
    steel: u32,
    cup: u32,
    egg: u32,
}

impl Chair {
    fn add_base(&self, studio: &mut Studio) -> Result<()> {
        for (corner, name) in CORNERS {
            let [foot, top] = leg_ends(corner);
            studio.add(format!("leg {name}"), self.wood, turned(&leg_profile(), 24, foot, top))?;
            let below = Vec3::new(foot.x as f32, 0.002, foot.z as f32);
            let above = Vec3::new(foot.x as f32, 0.3, foot.z as f32);
            studio.add(format!("foot {name}"), self.rubber, Shape::cone(below, 0.26, above, 0.19))?;
        }
        let stretcher = stretcher_profile();
        for (name, from, to, height) in [
            ("front stretcher", 0, 1, 1.5),
            ("right stretcher", 1, 2, 2.0),
            ("back stretcher", 2, 3, 1.5),
            ("left stretcher", 3, 0, 2.0),
        ] {
            let [from, to] = [from, to].map(|corner: usize| on_leg(CORNERS[corner].0, height));
            studio.add(name, self.dark, turned(&stretcher, 20, from, to))?;
        }
        let rest = footrest().placed(&moved(0.0, 2.75, 2.05));
        studio.add("footrest", self.wood, rest)?;
        studio.add("seat", self.dark, seat().placed(&moved(0.0, SEAT, 0.0)))
    }

    fn add_back(&self, studio: &mut Studio) -> Result<()> {
        let post =
            |side: f64| [DVec3::new(1.28 * side, SEAT - 0.12, -1.3), DVec3::new(1.5 * side, 9.7, -1.95)];
        for (side, name) in [(-1.0, "left post"), (1.0, "right post")] {
            let [from, to] = post(side);
            let finial = Shape::Ellipsoid(Ellipsoid {
                centre: (to + (to - from).normalize() * 0.2).as_vec3(),
                axes: [Vec3::X * 0.17, Vec3::Y * 0.26, Vec3::Z * 0.17],
            });
            studio.add(name, self.wood, (turned(&post_profile(), 24, from, to), [finial]))?;
        }
        studio.add("crest", self.dark, crest().placed(&moved(0.0, 9.05, -1.88)))?;
        for number in 0..5 {
            let place = number as f64 - 2.0;
            // The crest is bent backwards, and so are the tops of the spindles.
            let bend = -0.09 * (4.0 - place * place);
            let from = DVec3::new(0.42 * place, SEAT - 0.12, -1.36);
            let to = DVec3::new(0.47 * place, 8.85, -1.84 + bend * 0.7);
            let name = format!("spindle {}", number + 1);
            studio.add(name, self.wood, turned(&spindle_profile(), 16, from, to))?;
        }
        for (side, name) in [(-1.0, "left"), (1.0, "right")] {
            studio.add(format!("{name} arm"), self.dark, arm(side))?;
            let from = DVec3::new(1.42 * side, SEAT - 0.12, 0.95);
            let to = DVec3::new(1.66 * side, 7.32, 1.15);
            studio.add(format!("{name} support"), self.wood, turned(&support_profile(), 16, from, to))?;
        }
        Ok(())
    }

    fn add_tray(&self, studio: &mut Studio) -> Result<()> {
        const TOP: f32 = 7.78;
        studio.add("tray", self.wood, tray().placed(&moved(0.0, 7.62, 1.75)))?;
        for (side, name) in [(-1.0, "left rod"), (1.0, "right rod")] {
            let rod =
                Shape::cylinder(Vec3::new(1.66 * side, 7.53, -0.6), Vec3::new(1.66 * side, 7.53, 2.2), 0.07);
            studio.add(name, self.steel, rod)?;
        }
        let (x, z) = (0.95, 1.75);
        let bottom = prism(&circle(0.3, 22, 0.0), f64::from(TOP) + 0.002, f64::from(TOP) + 0.05);
        let cup = Shape::cone(Vec3::new(x, TOP + 0.003, z), 0.31, Vec3::new(x, TOP + 0.85, z), 0.42);
        studio.add("cup", self.cup, (bottom.placed(&moved(x.into(), 0.0, z.into())), [cup]))?;
        let egg = Ellipsoid {
            centre: Vec3::new(-0.55, TOP + 0.262, 1.95),
            axes: [Vec3::new(0.33, 0.0, 0.1), Vec3::Y * 0.26, Vec3::new(-0.08, 0.0, 0.26)],
        };
        studio.add("egg", self.egg, Shape::Ellipsoid(egg))
    }
}
