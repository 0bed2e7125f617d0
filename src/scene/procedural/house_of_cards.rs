//! Figure 6, "House of Cards": 41 objects of 3286 polygons under five lights.
//!
//! Five storeys take forty cards: fifteen pairs that lean on each other and ten that lie on them. A card has
//! twenty points at each of its round corners and so 82 polygons.

use super::shapes::{Mesh, cuboid, moved, prism, rounded_rectangle, turned_y, turned_z};
use super::studio::{PAPER_SIZE, Studio, polished};
use crate::error::Result;
use crate::random::Random;
use crate::scene::{Material, Scene};

/// A card, in units of its shorter side.
const LENGTH: f64 = 1.4;
const THICKNESS: f64 = 0.016;

/// Between the feet of a pair, and so between pairs: lying cards just do not touch.
const SPAN: f64 = 1.43;

const STOREYS: usize = 5;

pub(super) fn build() -> Result<Scene> {
    let mut studio = Studio::new("house-of-cards");
    let table = studio.material(polished("lacquer", [0.085, 0.03, 0.02], 0.34));
    studio.add("table", table, cuboid([-40.0, -0.5, -60.0], [40.0, 0.0, 9.0]))?;
    add_house(&mut studio)?;
    studio.lamp("key", [-5.0, 6.0, 4.0], [0.66, 0.62, 0.55]);
    studio.lamp("fill", [5.5, 4.5, 3.6], [0.24, 0.26, 0.32]);
    studio.lamp("back", [3.2, 6.6, -3.6], [0.3, 0.28, 0.25]);
    studio.lamp("side", [-5.6, 3.0, -0.7], [0.22, 0.17, 0.12]);
    studio.lamp("top", [0.5, 9.5, 0.7], [0.22, 0.22, 0.22]);
    studio.camera([6.6, 6.6, 11.2], [0.1, 2.0, 0.0], 37.0, PAPER_SIZE);
    Ok(studio.finish())
}

fn add_house(studio: &mut Studio) -> Result<()> {
    let backs = [
        coated("red back", [0.62, 0.06, 0.06]),
        coated("blue back", [0.07, 0.13, 0.48]),
        coated("face", [0.82, 0.8, 0.74]),
    ]
    .map(|material| studio.material(material));
    let mut random = Random::new(1986);
    let lean = libm::asin(0.5 * SPAN / LENGTH);
    // Half the thickness of two cards meets above the middle of a pair, and a hair is left between them.
    let shift = 0.5 * THICKNESS / libm::cos(lean) + 0.002;
    let foot = 0.5 * THICKNESS * libm::sin(lean) + 0.001;
    let storey = LENGTH * libm::cos(lean) + 2.0 * foot + THICKNESS + 0.002;
    for level in 0..STOREYS {
        let pairs = STOREYS - level;
        let floor = level as f64 * storey;
        let middle = |pair: usize| (pair as f64 - 0.5 * (pairs - 1) as f64) * SPAN;
        for pair in 0..pairs {
            for (side, name) in [(-1.0, "left"), (1.0, "right")] {
                let centre = moved(
                    middle(pair) + side * (0.25 * SPAN + shift),
                    floor + foot + 0.5 * (storey - 2.0 * foot - THICKNESS),
                    wobble(&mut random, 0.02),
                );
                let place = centre * turned_y(wobble(&mut random, 0.012)) * turned_z(side * lean);
                let back = backs[usize::from(side > 0.0) * 2 + usize::from(side < 0.0) * (level % 2)];
                studio.add(
                    format!("storey {} pair {} {name}", level + 1, pair + 1),
                    back,
                    standing().placed(&place),
                )?;
            }
        }
        for lying in 0..pairs - 1 {
            let x = 0.5 * (middle(lying) + middle(lying + 1));
            let y = floor + storey - 0.5 * THICKNESS - 0.001;
            let place = moved(x, y, wobble(&mut random, 0.03)) * turned_y(wobble(&mut random, 0.015));
            studio.add(
                format!("floor {} card {}", level + 2, lying + 1),
                backs[1 - level % 2],
                lying_card().placed(&place),
            )?;
        }
    }
    Ok(())
}

/// Coated paper mirrors a little.
fn coated(name: &str, diffuse: [f32; 3]) -> Material {
    polished(name, diffuse, 0.05)
}

fn wobble(random: &mut Random, most: f64) -> f64 {
    most * random.signed()
}

/// A card on its back around the origin, its length along x.
fn lying_card() -> Mesh {
    let outline = rounded_rectangle([0.5 * LENGTH, 0.5], 0.09, 20);
    prism(&outline, -0.5 * THICKNESS, 0.5 * THICKNESS)
}

/// A card on its shorter side around the origin.
fn standing() -> Mesh {
    lying_card().placed(&turned_z(std::f64::consts::FRAC_PI_2))
}
