//! Figure 8, "Gazebo at Night": 80 objects of 3222 polygons under eight lights.
//!
//! An octagonal gazebo on a lawn: a floor with three steps, eight turned posts on blocks, beams and fretwork
//! between them, railings of crossed slats on the seven sides without the steps, benches, a roof in eight
//! panels with a cupola, and under it a chandelier with seven candles, whose flames are seven of the lights.
//! The eighth is the moon. Lengths in metres.

mod chandelier;
mod sides;

use self::chandelier::{candle, candle_flame, chain, chandelier};
use self::sides::{beam, bench, fretwork, lattice, roof_panel};
use super::shapes::{Caps, Mesh, circle, cuboid, lathe, moved, prism, turned_y};
use super::studio::{PAPER_SIZE, Studio, glossy, matt, metal, polished};
use crate::error::Result;
use crate::scene::Scene;
use std::f64::consts::{PI, TAU};

/// Sides, of which the first has the steps.
const SIDES: usize = 8;

/// Distance of the posts from the middle.
const POSTS: f64 = 2.6;

/// Upper side of the floor.
const FLOOR: f64 = 0.6;

/// Lower side of the beams.
const EAVES: f64 = 3.1;

const CANDLES: usize = 7;

pub(super) fn build() -> Result<Scene> {
    let mut studio = Studio::new("gazebo");
    let lawn = studio.material(matt("lawn", [0.13, 0.27, 0.085]));
    studio.add("lawn", lawn, cuboid([-26.0, -0.5, -30.0], [26.0, 0.0, 22.0]))?;
    add_floor(&mut studio)?;
    add_sides(&mut studio)?;
    add_roof(&mut studio)?;
    add_chandelier(&mut studio)?;
    for number in 0..CANDLES {
        let flame = candle_flame(number).as_vec3().to_array();
        studio.lamp(&format!("candle {}", number + 1), flame, [0.15, 0.105, 0.055]);
    }
    studio.background([0.004, 0.006, 0.012]);
    studio.lamp("moon", [-60.0, 75.0, 40.0], [0.085, 0.11, 0.17]);
    studio.camera([5.6, 2.35, 10.9], [-0.15, 2.25, 0.0], 38.0, PAPER_SIZE);
    Ok(studio.finish())
}

/// The middle of a side, or with half a number more a corner.
fn turn(side: f64) -> f64 {
    TAU * side / SIDES as f64
}

fn add_floor(studio: &mut Studio) -> Result<()> {
    let boards = studio.material(polished("boards", [0.36, 0.25, 0.16], 0.1));
    let stone = studio.material(matt("stone", [0.4, 0.39, 0.37]));
    // Corners at half numbers of sides; the profile is turned from z, where the steps are.
    let outline = |radius: f64| circle(radius, SIDES, turn(0.5) - 0.5 * PI);
    let platform = prism(&outline(2.95), 0.0, FLOOR - 0.1).with(&prism(&outline(3.05), FLOOR - 0.1, FLOOR));
    studio.add("floor", boards, platform)?;
    let apothem = 3.05 * libm::cos(turn(0.5));
    for step in 0..3 {
        let (top, far) = (FLOOR - 0.15 * (step + 1) as f64, apothem + 0.32 * (step + 1) as f64);
        let slab = cuboid([-1.0, 0.0, far - 0.36], [1.0, top, far]);
        studio.add(format!("step {}", step + 1), stone, slab)?;
    }
    for number in 0..3 {
        let outline = circle(0.42, 7, number as f64);
        let place = moved([-0.12, 0.2, 0.02][number], 0.0, apothem + 1.75 + number as f64 * 1.05);
        studio.add(
            format!("flagstone {}", number + 1),
            stone,
            prism(&outline, 0.002, 0.05).placed(&place),
        )?;
    }
    Ok(())
}

/// 74 polygons: a turned post of height 1.
fn post() -> Mesh {
    let profile = [
        [0.07, 0.0],
        [0.1, 0.03],
        [0.075, 0.06],
        [0.085, 0.2],
        [0.115, 0.34],
        [0.07, 0.45],
        [0.06, 0.85],
        [0.095, 0.89],
        [0.085, 0.97],
        [0.09, 1.0],
    ];
    let scale = EAVES - FLOOR - 0.2;
    let profile = profile.map(|[radius, height]| [radius, FLOOR + 0.2 + height * scale]);
    lathe(&profile, 8, Caps::Flat).smooth_up_to(50.0)
}

fn add_sides(studio: &mut Studio) -> Result<()> {
    let white = studio.material(glossy("white paint", [0.74, 0.73, 0.7], 0.15, 20.0));
    let green = studio.material(glossy("green paint", [0.16, 0.3, 0.2], 0.15, 20.0));
    let wood = studio.material(glossy("bench wood", [0.42, 0.25, 0.12], 0.2, 25.0));
    for side in 0..SIDES {
        let number = side + 1;
        let corner = turned_y(turn(side as f64 + 0.5)) * moved(0.0, 0.0, POSTS);
        let block = cuboid([-0.13, FLOOR, -0.13], [0.13, FLOOR + 0.2, 0.13]);
        studio.add(format!("post {number}"), white, post().with(&block).placed(&corner))?;
        let middle = turned_y(turn(side as f64));
        studio.add(format!("beam {number}"), white, beam().placed(&middle))?;
        studio.add(format!("fretwork {number}"), white, fretwork().placed(&middle))?;
        if side == 0 {
            continue;
        }
        let (upper, lower) = sides::rails();
        studio.add(format!("upper rail {number}"), green, upper.placed(&middle))?;
        studio.add(format!("lower rail {number}"), green, lower.placed(&middle))?;
        studio.add(format!("lattice {number}"), white, lattice().placed(&middle))?;
        studio.add(format!("bench {number}"), wood, bench().placed(&middle))?;
    }
    Ok(())
}

fn add_roof(studio: &mut Studio) -> Result<()> {
    let shingles = studio.material(matt("shingles", [0.27, 0.13, 0.1]));
    let white = studio.material(glossy("cupola paint", [0.72, 0.71, 0.69], 0.15, 20.0));
    let copper = studio.material(metal("copper", [0.3, 0.14, 0.07], [0.35, 0.2, 0.12]));
    for side in 0..SIDES {
        let panel = roof_panel().placed(&turned_y(turn(side as f64)));
        studio.add(format!("roof panel {}", side + 1), shingles, panel)?;
    }
    // A ring of eight sides and a hat on it.
    let cupola = [[0.46, 4.42], [0.46, 4.55], [0.38, 4.58], [0.38, 4.95], [0.5, 5.0], [0.5, 5.06]];
    studio.add("cupola", white, eight_sided(&cupola, Caps::Flat))?;
    let hat = [[0.62, 5.062], [0.6, 5.12], [0.34, 5.34], [0.14, 5.6]];
    studio.add("cupola roof", shingles, eight_sided(&hat, Caps::Pointed { tip: 5.85 }))?;
    let finial =
        [[0.05, 5.68], [0.03, 5.82], [0.04, 5.88], [0.1, 5.96], [0.1, 6.04], [0.04, 6.12], [0.01, 6.5]];
    studio.add("finial", copper, lathe(&finial, 10, Caps::Flat).smooth_up_to(50.0))
}

/// Turned in eight steps, flat sides parallel to the gazebo's.
fn eight_sided(profile: &[[f64; 2]], caps: Caps) -> Mesh {
    lathe(profile, SIDES, caps).placed(&turned_y(turn(0.5)))
}

fn add_chandelier(studio: &mut Studio) -> Result<()> {
    let iron = studio.material(glossy("wrought iron", [0.06; 3], 0.3, 30.0));
    let wax = studio.material(matt("wax", [0.8, 0.75, 0.62]));
    studio.add("chain", iron, chain())?;
    studio.add("chandelier", iron, chandelier())?;
    for number in 0..CANDLES {
        studio.add(format!("candle {}", number + 1), wax, candle(number))?;
    }
    Ok(())
}
