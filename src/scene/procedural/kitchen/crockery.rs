//! Canisters, plates, mugs, the crock with its spoons, rolling pin, cutting board and knife, and paper.

use super::{ON_TOP, Set, TOP, column, egg_shape, funnel, rod};
use crate::error::Result;
use crate::scene::procedural::shapes::{Caps, Closing, bevelled_prism, cuboid, lathe, moved};
use crate::scene::procedural::shapes::{rounded_rectangle, tube, turned_y};
use glam::DVec3;
use std::f64::consts::PI;

pub(super) fn add(set: &mut Set) -> Result<()> {
    add_canisters(set)?;
    add_plates_and_mugs(set)?;
    add_crock(set)?;
    add_board(set)
}

fn add_canisters(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    for (number, (radius, height, x)) in
        [(0.075f32, 0.2f32, 1.37f32), (0.062, 0.165, 1.53), (0.052, 0.13, 1.665)].into_iter().enumerate()
    {
        let name = format!("canister {}", number + 1);
        studio.add(name.clone(), palette.blue, column([x, ON_TOP, 0.115], radius, height))?;
        let (wide, top) = (f64::from(radius) + 0.004, f64::from(ON_TOP + height) + 0.0005);
        let profile = [[wide, top], [wide, top + 0.018], [0.35 * wide, top + 0.03]];
        let lid = lathe(&profile, 12, Caps::Flat).placed(&moved(x.into(), 0.0, 0.115));
        studio.add(format!("{name} lid"), palette.wood, lid)?;
    }
    Ok(())
}

fn add_plates_and_mugs(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    for number in 0..4 {
        let y = TOP + 0.0095 + 0.0185 * number as f32;
        let plate = egg_shape([0.22, y, 0.3], [0.125, 0.009, 0.125]);
        studio.add(format!("plate {}", number + 1), palette.ceramic, plate)?;
    }
    for (number, ([x, z], material)) in
        [([1.99f32, 0.36f32], palette.red), ([3.16, 0.42], palette.ceramic)].into_iter().enumerate()
    {
        let name = format!("mug {}", number + 1);
        studio.add(name.clone(), material, funnel([x, ON_TOP, z], [0.034, 0.041], 0.095))?;
        let path: Vec<_> = (0..=6)
            .map(|i| PI * (i as f64 / 6.0 - 0.5))
            .map(|angle| {
                let (sin, cos) = libm::sincos(angle);
                (DVec3::new(0.034 + 0.032 * cos, f64::from(TOP) + 0.05 + 0.03 * sin, 0.0), 0.006)
            })
            .collect();
        let handle = tube(&path, 6, Closing::Capped).smooth_up_to(70.0);
        let place = moved(x.into(), 0.0, z.into()) * turned_y(-0.5);
        studio.add(format!("{name} handle"), material, handle.placed(&place))?;
    }
    Ok(())
}

fn add_crock(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    let [x, z] = [2.1f32, 0.13f32];
    studio.add("crock", palette.ceramic, column([x, ON_TOP, z], 0.055, 0.15))?;
    let spoons = [[0.045f32, 0.02f32], [-0.04, 0.03], [0.005, -0.035], [-0.012, 0.045]];
    for (number, [dx, dz]) in spoons.into_iter().enumerate() {
        let (foot, top) = ([x - 0.4 * dx, TOP + 0.01, z - 0.4 * dz], [x + 1.4 * dx, TOP + 0.3, z + 1.4 * dz]);
        let name = format!("spoon {}", number + 1);
        studio.add(name.clone(), palette.wood, rod(foot, top, 0.006))?;
        // The last is a stick to stir with.
        if number < 3 {
            let bowl = egg_shape([x + 1.5 * dx, TOP + 0.325, z + 1.5 * dz], [0.022, 0.034, 0.011]);
            studio.add(format!("{name} bowl"), palette.wood, bowl)?;
        }
    }
    Ok(())
}

fn add_board(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    let turn = turned_y(0.18);
    let outline = rounded_rectangle([0.19, 0.12], 0.03, 4);
    let levels = [[0.0, 0.985], [0.003, 1.0], [0.017, 1.0], [0.02, 0.985]];
    let place = moved(2.0, f64::from(ON_TOP), 0.47) * turn;
    studio.add("cutting board", palette.wood, bevelled_prism(&outline, &levels).placed(&place))?;
    let blade = cuboid([-0.17, 0.0205, 0.07], [0.02, 0.0225, 0.1]).placed(&place);
    studio.add("knife blade", palette.steel, blade)?;
    let grip = cuboid([0.021, 0.0205, 0.072], [0.13, 0.036, 0.097]).placed(&place);
    studio.add("knife grip", palette.iron, grip)?;
    let (y, z) = (TOP + 0.0275, 0.57);
    for (name, from, to, radius) in [
        ("rolling pin", 1.34, 1.58, 0.027),
        ("left grip of the pin", 1.27, 1.345, 0.011),
        ("right grip of the pin", 1.575, 1.65, 0.011),
    ] {
        studio.add(name, palette.wood, rod([from, y, z], [to, y, z - 0.02], radius))?;
    }
    studio.add("paper roll", palette.paper, column([3.22, ON_TOP, 0.12], 0.06, 0.25))?;
    let pages = cuboid([2.864, f64::from(ON_TOP), 0.364], [3.016, f64::from(ON_TOP) + 0.034, 0.556]);
    let cover = cuboid([2.86, f64::from(ON_TOP) + 0.0345, 0.36], [3.02, f64::from(ON_TOP) + 0.04, 0.56]);
    studio.add("cookbook", palette.blue, pages.with(&cover))
}
