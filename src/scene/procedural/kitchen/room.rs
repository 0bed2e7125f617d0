//! Walls, window, tiles, the pendant lamp, a clock and two stools.

use super::{Set, column, funnel};
use crate::error::Result;
use crate::scene::procedural::shapes::{Mesh, circle, cuboid, mitred_frame, moved, prism, turned_x};
use std::f64::consts::FRAC_PI_2;

/// The window's middle and half its size.
const WINDOW: [[f64; 2]; 2] = [[0.8, 1.62], [0.46, 0.44]];

pub(super) fn add(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    studio.add("floor", palette.floor, cuboid([-0.1, -0.1, -0.1], [6.2, 0.0, 6.0]))?;
    let [[x, y], [half_x, half_y]] = WINDOW;
    // Four pieces around the window.
    let wall = |low: [f64; 2], high: [f64; 2]| cuboid([low[0], low[1], -0.1], [high[0], high[1], 0.0]);
    let walls = [
        wall([0.0, 0.001], [6.2, y - half_y]),
        wall([0.0, y + half_y], [6.2, 2.6]),
        wall([0.0, y - half_y], [x - half_x, y + half_y]),
        wall([x + half_x, y - half_y], [6.2, y + half_y]),
    ];
    studio.add("back wall", palette.plaster, Mesh::union(walls))?;
    studio.add("left wall", palette.plaster, cuboid([-0.1, 0.001, -0.1], [-0.001, 2.6, 6.0]))?;
    studio.add("ceiling", palette.frame, cuboid([-0.1, 2.601, -0.1], [6.2, 2.7, 6.0]))?;
    let section = [[-0.03, -0.07], [0.05, -0.07], [0.05, 0.02], [-0.03, 0.02]];
    let frame = mitred_frame([half_x, half_y], &section)
        .placed(&(moved(x, y, 0.0) * turned_x(FRAC_PI_2)))
        .with(&cuboid([x - 0.015, y - half_y, -0.06], [x + 0.015, y + half_y, -0.03]))
        .with(&cuboid([x - half_x, y - 0.012, -0.058], [x + half_x, y + 0.012, -0.032]));
    studio.add("window frame", palette.frame, frame)?;
    add_tiles(set)?;
    add_lamp_and_clock(set)?;
    add_stools(set)
}

/// 48 tiles between counter and cupboards.
fn add_tiles(set: &mut Set) -> Result<()> {
    const ACROSS: usize = 16;
    let Set { studio, palette } = set;
    for row in 0..3 {
        for column in 0..ACROSS {
            let low = [1.305 + 0.125 * column as f64, 0.925 + 0.166 * row as f64, 0.0005];
            let high = [low[0] + 0.12, low[1] + 0.161, 0.012];
            let is_blue = (column + row * 3) % 5 == 2;
            let name = format!("tile {}", row * ACROSS + column + 1);
            studio.add(name, palette.tiles[usize::from(is_blue)], cuboid(low, high))?;
        }
    }
    Ok(())
}

fn add_lamp_and_clock(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    studio.add("lamp cord", palette.iron, column([1.5, 2.05, 1.15], 0.006, 0.55))?;
    studio.add("lamp shade", palette.red, funnel([1.5, 1.83, 1.15], [0.2, 0.03], 0.22))?;
    let face = prism(&circle(0.14, 12, 0.0), 0.0, 0.03);
    studio.add("clock", palette.ceramic, face.placed(&(moved(2.5, 2.28, 0.001) * turned_x(FRAC_PI_2))))
}

fn add_stools(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    for (number, [x, z]) in [[1.15f32, 1.75], [2.0, 1.95]].into_iter().enumerate() {
        let name = format!("stool {}", number + 1);
        let seat = prism(&circle(0.17, 16, 0.0), 0.62, 0.66);
        studio.add(format!("{name} seat"), palette.wood, seat.placed(&moved(x.into(), 0.0, z.into())))?;
        for (leg, [sx, sz]) in [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].into_iter().enumerate() {
            let foot = [x + 0.17 * sx, 0.001, z + 0.17 * sz];
            let top = [x + 0.09 * sx, 0.618, z + 0.09 * sz];
            studio.add(format!("{name} leg {}", leg + 1), palette.wood, super::rod(foot, top, 0.016))?;
        }
    }
    Ok(())
}
