//! Stove with kettle, pot and pan, hood, refrigerator and toaster.

use super::{HAIR, ON_TOP, Set, column, egg_shape, funnel, rod};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::scene::procedural::shapes::{Caps, Closing, bevelled_prism, circle, cuboid, lathe, moved, prism};
use crate::scene::procedural::shapes::{rounded_rectangle, tube};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Upper side of the burners.
const HOB: f32 = 0.945;

pub(super) fn add(set: &mut Set) -> Result<()> {
    add_stove(set)?;
    add_hood_and_refrigerator(set)?;
    add_cookware(set)?;
    let Set { studio, palette } = set;
    let outline = rounded_rectangle([0.14, 0.085], 0.03, 3);
    let levels = [[0.0, 0.95], [0.02, 1.0], [0.17, 1.0], [0.19, 0.9]];
    let toaster = bevelled_prism(&outline, &levels);
    studio.add("toaster", palette.steel, toaster.placed(&moved(2.98, f64::from(ON_TOP), 0.2)))
}

fn add_stove(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    studio.add("stove", palette.enamel, cuboid([2.2, 0.001, 0.002], [2.8, 0.9, 0.6]))?;
    studio.add("hob", palette.oven, cuboid([2.2, 0.9005, 0.002], [2.8, 0.925, 0.62]))?;
    let window = cuboid([2.3, 0.36, 0.6315], [2.7, 0.62, 0.636]);
    studio.add(
        "oven door",
        palette.enamel,
        cuboid([2.21, 0.15, 0.601], [2.79, 0.72, 0.631]).with(&window),
    )?;
    studio.add("oven handle", palette.steel, rod([2.26, 0.68, 0.67], [2.74, 0.68, 0.67], 0.01))?;
    studio.add("towel", palette.red, cuboid([2.36, 0.42, 0.682], [2.58, 0.7, 0.687]))?;
    for (number, [x, z]) in BURNERS.into_iter().enumerate() {
        let ring = column([x, 0.9255, z], 0.085, HOB - 0.9255);
        studio.add(format!("burner {}", number + 1), palette.iron, ring)?;
        let x = 2.29 + 0.14 * number as f32;
        let lever = rod([x, 0.77, 0.618], [x, 0.83, 0.618], 0.012);
        studio.add(format!("lever {}", number + 1), palette.iron, lever)?;
    }
    Ok(())
}

const BURNERS: [[f32; 2]; 4] = [[2.35, 0.18], [2.65, 0.18], [2.35, 0.45], [2.65, 0.45]];

fn add_hood_and_refrigerator(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    let hood =
        bevelled_prism(&[[-0.3, -0.25], [0.3, -0.25], [0.3, 0.25], [-0.3, 0.25]], &[[1.6, 1.0], [1.82, 0.5]]);
    let chimney = cuboid([2.36, 1.8205, 0.128], [2.64, 2.08, 0.377]);
    studio.add("hood", palette.steel, hood.placed(&moved(2.5, 0.0, 0.253)).with(&chimney))?;
    studio.add("refrigerator", palette.enamel, cuboid([3.34, 0.02, 0.002], [4.06, 1.85, 0.62]))?;
    for (name, low, high) in [("freezer door", 1.32, 1.85), ("refrigerator door", 0.05, 1.3)] {
        studio.add(name, palette.enamel, cuboid([3.34, low, 0.622], [4.06, high, 0.68]))?;
        let y = if low > 1.0 { 1.36 } else { 0.9 };
        let handle = rod([3.4, y, 0.715], [3.4, y + 0.32, 0.715], 0.012);
        studio.add(format!("handle of {name}"), palette.steel, handle)?;
    }
    Ok(())
}

fn add_cookware(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    let at = |burner: usize, y: f32| [BURNERS[burner][0], y, BURNERS[burner][1]];
    let on = |burner: usize| moved(BURNERS[burner][0].into(), 0.0, BURNERS[burner][1].into());
    // The kettle.
    studio.add("kettle", palette.steel, funnel(at(0, HOB + HAIR), [0.095, 0.055], 0.11))?;
    studio.add("kettle lid", palette.steel, egg_shape(at(0, HOB + 0.11), [0.056, 0.025, 0.056]))?;
    let [x, y, z] = at(0, HOB);
    let spout = Shape::cone(Vec3::new(x + 0.06, y + 0.05, z), 0.02, Vec3::new(x + 0.135, y + 0.11, z), 0.01);
    studio.add("kettle spout", palette.steel, spout)?;
    let path: Vec<_> = (0..=8)
        .map(|i| PI * i as f64 / 8.0)
        .map(|angle| {
            let (sin, cos) = libm::sincos(angle);
            (DVec3::new(0.075 * cos, f64::from(HOB) + 0.09 + 0.11 * sin, 0.0), 0.008)
        })
        .collect();
    let handle = tube(&path, 6, Closing::Capped).smooth_up_to(70.0);
    studio.add("kettle handle", palette.iron, handle.placed(&on(0)))?;
    // The pot and its lid.
    studio.add("pot", palette.red, column(at(3, HOB + HAIR), 0.11, 0.12))?;
    let lid = [[0.114, 0.12], [0.114, 0.128], [0.06, 0.145], [0.02, 0.148]];
    let lid = lid.map(|[radius, height]| [radius, f64::from(HOB) + height + 0.001]);
    studio.add("pot lid", palette.red, lathe(&lid, 16, Caps::Flat).placed(&on(3)))?;
    let [x, y, z] = at(3, HOB);
    studio.add("knob of the lid", palette.iron, column([x, y + 0.149, z], 0.016, 0.025))?;
    for (name, side) in [("left handle of the pot", -1.0), ("right handle of the pot", 1.0)] {
        let x = x + 0.132 * side;
        studio.add(name, palette.iron, rod([x, y + 0.09, z - 0.035], [x, y + 0.09, z + 0.035], 0.009))?;
    }
    // The pan.
    studio.add("pan", palette.iron, funnel(at(2, HOB + HAIR), [0.1, 0.12], 0.04))?;
    let bottom = prism(&circle(0.099, 16, 0.0), f64::from(HOB) + 0.001, f64::from(HOB) + 0.006);
    studio.add("bottom of the pan", palette.iron, bottom.placed(&on(2)))?;
    let [x, y, z] = at(2, HOB);
    let handle = rod([x - 0.08, y + 0.036, z + 0.095], [x - 0.17, y + 0.055, z + 0.21], 0.01);
    studio.add("handle of the pan", palette.wood, handle)
}
