//! Cupboards with their doors and handles, the counter, the sink and its tap.

use super::{Set, TOP, column, rod};
use crate::error::Result;
use crate::scene::procedural::shapes::{
    Closing, Mesh, bevelled_prism, cuboid, moved, rounded_rectangle, tube,
};
use glam::DVec3;

/// A front between two x and two heights, and where its handle is.
struct Front {
    name: &'static str,
    x: [f64; 2],
    y: [f64; 2],
    handle: Handle,
}

#[derive(Clone, Copy)]
enum Handle {
    /// Upright near the right edge, at its upper or lower end.
    Right,
    /// Upright near the left edge.
    Left,
    /// Level across the middle.
    Level,
}

const fn front(name: &'static str, x: [f64; 2], y: [f64; 2], handle: Handle) -> Front {
    Front { name, x, y, handle }
}

const LOW: [f64; 2] = [0.12, 0.86];
const UNDER_DRAWER: [f64; 2] = [0.12, 0.68];
const DRAWER: [f64; 2] = [0.7, 0.86];
const HIGH: [f64; 2] = [1.44, 2.14];

const BASE_FRONTS: [Front; 10] = [
    front("door 1", [0.02, 0.44], LOW, Handle::Right),
    front("door 2", [0.46, 0.88], LOW, Handle::Left),
    front("door 3", [0.9, 1.53], UNDER_DRAWER, Handle::Right),
    front("door 4", [1.55, 2.18], UNDER_DRAWER, Handle::Left),
    front("drawer 1", [0.9, 1.53], DRAWER, Handle::Level),
    front("drawer 2", [1.55, 2.18], DRAWER, Handle::Level),
    front("door 5", [2.82, 3.05], UNDER_DRAWER, Handle::Right),
    front("door 6", [3.07, 3.3], UNDER_DRAWER, Handle::Left),
    front("drawer 3", [2.82, 3.05], DRAWER, Handle::Level),
    front("drawer 4", [3.07, 3.3], DRAWER, Handle::Level),
];

const HIGH_FRONTS: [Front; 6] = [
    front("cupboard 1", [1.36, 1.57], HIGH, Handle::Right),
    front("cupboard 2", [1.58, 1.78], HIGH, Handle::Left),
    front("cupboard 3", [1.79, 1.99], HIGH, Handle::Right),
    front("cupboard 4", [2.0, 2.19], HIGH, Handle::Left),
    front("cupboard 5", [2.82, 3.05], HIGH, Handle::Right),
    front("cupboard 6", [3.07, 3.3], HIGH, Handle::Left),
];

pub(super) fn add(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    studio.add("left cabinet", palette.cabinet, cuboid([0.001, 0.1, 0.002], [2.19, 0.879, 0.58]))?;
    studio.add("right cabinet", palette.cabinet, cuboid([2.81, 0.1, 0.002], [3.31, 0.879, 0.58]))?;
    studio.add("plinth", palette.iron, cuboid([0.001, 0.001, 0.002], [3.31, 0.099, 0.52]))?;
    studio.add("left cupboard", palette.cabinet, cuboid([1.35, 1.43, 0.002], [2.2, 2.15, 0.31]))?;
    studio.add("right cupboard", palette.cabinet, cuboid([2.81, 1.43, 0.002], [3.31, 2.15, 0.31]))?;
    for front in &BASE_FRONTS {
        add_front(set, front, 0.581, true)?;
    }
    for front in &HIGH_FRONTS {
        add_front(set, front, 0.311, false)?;
    }
    add_counter(set)
}

/// Twelve polygons: a board and a raised panel on it; and a bar to pull.
fn add_front(set: &mut Set, front: &Front, z: f64, is_base: bool) -> Result<()> {
    let Set { studio, palette } = set;
    let ([x0, x1], [y0, y1]) = (front.x, front.y);
    let border = 0.05;
    let panel = cuboid([x0 + border, y0 + border, z + 0.0205], [x1 - border, y1 - border, z + 0.027]);
    let board = cuboid([x0, y0, z], [x1, y1, z + 0.02]).with(&panel);
    studio.add(front.name, palette.door, board)?;
    // Doors below are pulled at their upper end, those above at their lower.
    let upright = |x: f64| {
        let y = if is_base { y1 - 0.18 } else { y0 + 0.06 };
        ([x, y], [x, y + 0.12])
    };
    let middle = (0.5 * (x0 + x1), 0.5 * (y0 + y1));
    let (from, to) = match front.handle {
        Handle::Right => upright(x1 - 0.025),
        Handle::Left => upright(x0 + 0.025),
        Handle::Level => ([middle.0 - 0.07, middle.1], [middle.0 + 0.07, middle.1]),
    };
    let place = |[x, y]: [f64; 2]| [x as f32, y as f32, z as f32 + 0.045];
    studio.add(format!("handle of {}", front.name), palette.steel, rod(place(from), place(to), 0.007))
}

fn add_counter(set: &mut Set) -> Result<()> {
    let Set { studio, palette } = set;
    let (low, high) = (0.88, f64::from(TOP));
    let slab = |x: [f64; 2], z: [f64; 2]| cuboid([x[0], low, z[0]], [x[1], high, z[1]]);
    // Around the hole for the sink, and beyond the stove.
    let slabs = [
        slab([0.001, 0.44], [0.002, 0.62]),
        slab([1.14, 2.195], [0.002, 0.62]),
        slab([0.44, 1.14], [0.002, 0.1]),
        slab([0.44, 1.14], [0.52, 0.62]),
        slab([2.805, 3.315], [0.002, 0.62]),
    ];
    studio.add("counter", palette.granite, Mesh::union(slabs))?;
    let outline = rounded_rectangle([0.345, 0.205], 0.05, 3);
    let levels = [[high - 0.17, 0.97], [high + 0.006, 0.99], [high + 0.006, 0.95], [high - 0.16, 0.9]];
    let basin = bevelled_prism(&outline, &levels).placed(&moved(0.79, 0.0, 0.31));
    studio.add("sink", palette.steel, basin)?;
    studio.add("tap foot", palette.steel, column([0.79, TOP + 0.0005, 0.06], 0.026, 0.05))?;
    studio.add("tap pipe", palette.steel, column([0.79, TOP + 0.05, 0.06], 0.013, 0.17))?;
    for (name, side) in [("cold tap", -1.0f32), ("hot tap", 1.0)] {
        studio.add(name, palette.steel, column([0.79 + 0.09 * side, TOP + 0.0005, 0.06], 0.018, 0.06))?;
    }
    let path: Vec<_> = (0..=9)
        .map(|i| std::f64::consts::PI * i as f64 / 9.0)
        .map(|angle| {
            let (sin, cos) = libm::sincos(angle);
            (DVec3::new(0.79, high + 0.22 + 0.075 * sin, 0.135 - 0.075 * cos), 0.0125)
        })
        .collect();
    studio.add("tap spout", palette.steel, tube(&path, 6, Closing::Capped).smooth_up_to(70.0))
}
