//! Figures 10 and 11, "Counter-top" and "Kitchen": one environment of 224 objects, 1298 polygons, 4 spheres,
//! 76 cylinders and 35 quadrics under five lights, from two points of view.
//!
//! A kitchen along a wall: sink under a window, counter, stove and hood, refrigerator, cupboards above and
//! below, and what a cook has left on the counter. Lengths in metres; the wall is at z = 0, the counter's
//! front edge at z = 0.62.

mod appliances;
mod cabinets;
mod crockery;
mod food;
mod glassware;
mod palette;
mod room;

use self::palette::Palette;
use super::studio::{PAPER_SIZE, Studio};
use crate::error::Result;
use crate::geometry::curved::{Ellipsoid, Shape};
use crate::scene::{ImageSize, Scene};
use glam::Vec3;

/// Upper side of the counter.
const TOP: f32 = 0.92;

/// What is added to heights so that things stand on each other without sharing a plane.
const HAIR: f32 = 0.0005;

/// What stands on the counter stands here.
const ON_TOP: f32 = TOP + HAIR;

/// The counter from near.
pub(super) fn counter_top() -> Result<Scene> {
    let mut studio = furnished("counter-top")?;
    studio.camera([2.2, 1.52, 1.5], [1.6, 1.03, 0.22], 37.0, PAPER_SIZE);
    Ok(studio.finish())
}

/// All of the kitchen.
pub(super) fn kitchen() -> Result<Scene> {
    let mut studio = furnished("kitchen")?;
    let size = ImageSize { width: 436, height: 479 };
    studio.camera([3.35, 1.78, 4.4], [1.72, 1.12, 0.1], 38.0, size);
    Ok(studio.finish())
}

fn furnished(name: &str) -> Result<Studio> {
    let mut studio = Studio::new(name);
    let palette = Palette::new(&mut studio);
    let mut set = Set { studio, palette };
    room::add(&mut set)?;
    cabinets::add(&mut set)?;
    appliances::add(&mut set)?;
    glassware::add(&mut set)?;
    crockery::add(&mut set)?;
    food::add(&mut set)?;
    let mut studio = set.studio;
    studio.background([0.1, 0.14, 0.2]);
    studio.lamp("window", [-3.2, 5.6, -6.0], [0.55, 0.53, 0.48]);
    studio.lamp("room", [3.2, 2.35, 3.4], [0.34, 0.32, 0.29]);
    studio.lamp("corner", [0.3, 2.3, 2.8], [0.2, 0.2, 0.21]);
    studio.near_lamp("pendant", [1.5, 1.86, 1.15], [0.34, 0.29, 0.2]);
    studio.near_lamp("hood", [2.5, 1.58, 0.3], [0.13, 0.12, 0.1]);
    Ok(studio)
}

/// The scene in the making, and its materials.
struct Set {
    studio: Studio,
    palette: Palette,
}

/// An upright cylinder with its lower end at a place.
fn column([x, y, z]: [f32; 3], radius: f32, height: f32) -> Shape {
    Shape::cylinder(Vec3::new(x, y, z), Vec3::new(x, y + height, z), radius)
}

/// An upright truncated cone with its lower end at a place, its radii from below.
fn funnel([x, y, z]: [f32; 3], radii: [f32; 2], height: f32) -> Shape {
    Shape::cone(Vec3::new(x, y, z), radii[0], Vec3::new(x, y + height, z), radii[1])
}

/// An ellipsoid along the axes.
fn egg_shape(centre: [f32; 3], half: [f32; 3]) -> Shape {
    let axes = [Vec3::X * half[0], Vec3::Y * half[1], Vec3::Z * half[2]];
    Shape::Ellipsoid(Ellipsoid { centre: centre.into(), axes })
}

/// A cylinder between two points.
fn rod(from: [f32; 3], to: [f32; 3], radius: f32) -> Shape {
    Shape::cylinder(from.into(), to.into(), radius)
}
