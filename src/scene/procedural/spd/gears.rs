//! A block of gears that mesh with their neighbours, some of them of glass.

use super::{NO_SHINE, level_square, studio, surface, transparent, upright};
use crate::error::Result;
use crate::scene::Scene;
use crate::scene::procedural::shapes::{Closing, Mesh, loft};
use glam::DVec3;

const LIGHTS: [[f32; 3]; 5] =
    [[2.0, 4.0, 4.0], [-2.0, 4.0, 3.0], [2.0, -2.5, 2.5], [-1.0, -4.0, 2.0], [-1.111, -2.121, 2.626]];

const TEETH: usize = 36;

/// A tooth's corners: degrees from its middle, and whether they are on its tip.
const TOOTH: [(f64, bool); 4] = [(-1.9, true), (1.9, true), (3.0, false), (7.0, false)];

pub(in crate::scene::procedural) fn build(size: u32) -> Result<Scene> {
    let mut studio = studio("gears", &upright([-1.1, -2.1, 2.6], [0.0; 3]), &LIGHTS);
    let ground = studio.material(surface("ground", [1.0, 0.85, 0.7], [0.3, 0.6, 3.0827]));
    studio.add_input(level_square("ground", ground, 2.0, 0.0))?;
    for z in 0..size {
        for y in 0..size {
            for x in 0..size {
                let [red, green, blue] = weights([x, y, z]);
                let most = red.max(green).max(blue) as f32;
                let colour = [red, green, blue].map(|weight| (weight as f32 + 0.07) / (most + 0.07));
                let is_glass = (x + 3 * y + 4 * z) % 5 == 0;
                let material = match is_glass {
                    true => transparent(surface("glass gear", colour, [0.2, 0.0, NO_SHINE]), 0.8, 1.1),
                    false => surface("gear", colour, [1.0, 0.0, NO_SHINE]),
                };
                let material = studio.material(material);
                studio.add(format!("gear {x} {y} {z}"), material, gear([x, y, z], size))?;
            }
        }
    }
    Ok(studio.finish())
}

/// Shares of red, green and blue, each from 0 to 6, different from neighbour to neighbour.
fn weights([x, y, z]: [u32; 3]) -> [u32; 3] {
    [(5 + x + 3 * y + 5 * z) % 7, (3 + 3 * x + 2 * y + 6 * z) % 7, (2 + 4 * x + 2 * y + 6 * z) % 7]
}

/// A gear; the block is 2 wide, whatever the number of gears along it.
fn gear([x, y, z]: [u32; 3], size: u32) -> Mesh {
    let unit = 1.0 / (19.0 * f64::from(size) + 1.0);
    let place = |number: u32| (2.0 * f64::from(number) - f64::from(size - 1)) * 19.0 * unit;
    // Neighbours are turned by half a tooth.
    let phase = if (x + y + z) % 2 == 0 { 0.0 } else { 180.0 / TEETH as f64 };
    let top = 1.0 - f64::from(z) / f64::from(size);
    let level = |height: f64| -> Vec<DVec3> {
        let corner = |number: usize| {
            let (degrees, is_tip) = TOOTH[number % TOOTH.len()];
            let angle = degrees + phase + 360.0 * (number / TOOTH.len()) as f64 / TEETH as f64;
            let (sin, cos) = libm::sincos(angle.to_radians());
            let radius = if is_tip { 19.9 * unit } else { 18.0 * unit };
            DVec3::new(place(x) + radius * cos, place(y) + radius * sin, height)
        };
        (0..TEETH * TOOTH.len()).map(corner).collect()
    };
    loft(&[level(top - 0.4 / f64::from(size)), level(top)], Closing::Capped)
}
