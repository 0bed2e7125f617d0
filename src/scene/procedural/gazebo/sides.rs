//! What stands between two posts, made for the side that looks along z.

use super::{EAVES, FLOOR, POSTS, turn};
use crate::scene::procedural::shapes::{Mesh, cuboid, moved, prism, turned_x};
use std::f64::consts::FRAC_PI_2;

/// Distance of a side from the middle, and half its length.
fn apothem() -> f64 {
    POSTS * libm::cos(turn(0.5))
}

fn half_side() -> f64 {
    POSTS * libm::sin(turn(0.5))
}

/// 6 polygons: a beam on two posts; those of all sides meet at mitres.
pub(super) fn beam() -> Mesh {
    let tangent = libm::tan(turn(0.5));
    let (near, far) = (apothem() - 0.09, apothem() + 0.09);
    let outline =
        [[-far * tangent, -far], [far * tangent, -far], [near * tangent, -near], [-near * tangent, -near]];
    prism(&outline, EAVES, EAVES + 0.16)
}

/// 6 polygons each: the rails that a lattice stands between.
pub(super) fn rails() -> (Mesh, Mesh) {
    let half = half_side() - 0.1;
    let rail = |low: f64, high: f64, thick: f64| {
        cuboid([-half, low, apothem() - thick], [half, high, apothem() + thick])
    };
    (rail(FLOOR + 0.85, FLOOR + 0.92, 0.055), rail(FLOOR + 0.12, FLOOR + 0.18, 0.04))
}

/// Slats of 6 polygons each, leaning to the right in front and to the left behind.
pub(super) fn lattice() -> Mesh {
    const A_WAY: usize = 10;
    let half = half_side() - 0.1;
    let (low, high) = (FLOOR + 0.16, FLOOR + 0.87);
    let rise = high - low;
    let pitch = (2.0 * half - rise) / (A_WAY - 1) as f64;
    let slat = |number: usize, way: f64| {
        let foot = -half + pitch * number as f64;
        // A slat is a prism lying across the panel, cut level with the rails.
        let outline = [[foot, low], [foot + 0.05, low], [foot + rise, high], [foot + rise - 0.05, high]];
        let mut outline = outline.map(|[x, y]| [way * x, y]);
        if way < 0.0 {
            outline.reverse();
        }
        let near = if way > 0.0 { 0.002 } else { -0.022 };
        prism(&outline, near, near + 0.02).placed(&turned_x(FRAC_PI_2)).placed(&moved(0.0, 0.0, apothem()))
    };
    let slats = [1.0, -1.0].into_iter().flat_map(|way| (0..A_WAY).map(move |number| (number, way)));
    Mesh::union(slats.map(|(number, way)| slat(number, way)))
}

/// Nine little balusters and a rail under the beam, and a bracket of 9 polygons at either post.
pub(super) fn fretwork() -> Mesh {
    let half = half_side() - 0.08;
    let z = apothem();
    let rail = cuboid([-half, EAVES - 0.34, z - 0.03], [half, EAVES - 0.29, z + 0.03]);
    let sticks = (0..9).map(|number| {
        let x = half * (number as f64 - 4.0) / 4.5;
        cuboid([x - 0.017, EAVES - 0.29, z - 0.017], [x + 0.017, EAVES, z + 0.017])
    });
    let bracket = |side: f64| {
        let quarter =
            [[0.0, 0.0], [0.09, 0.26], [0.2, 0.42], [0.36, 0.51], [0.5, 0.55], [0.5, 0.6], [0.0, 0.6]];
        let mut outline = quarter.map(|[x, y]| [side * (x - half), y + EAVES - 0.94]);
        if side < 0.0 {
            outline.reverse();
        }
        prism(&outline, -0.025, 0.025).placed(&turned_x(FRAC_PI_2)).placed(&moved(0.0, 0.0, z))
    };
    Mesh::union(sticks).with(&rail).with(&bracket(1.0)).with(&bracket(-1.0))
}

/// 18 polygons: a board on two feet inside the railing.
pub(super) fn bench() -> Mesh {
    let tangent = libm::tan(turn(0.5));
    let (near, far) = (apothem() - 0.55, apothem() - 0.1);
    let half = near * tangent - 0.06;
    let seat = cuboid([-half, FLOOR + 0.4, near], [half, FLOOR + 0.45, far]);
    let foot = |x: f64| cuboid([x - 0.03, FLOOR, near + 0.05], [x + 0.03, FLOOR + 0.4, far - 0.05]);
    seat.with(&foot(-0.75 * half)).with(&foot(0.75 * half))
}

/// 6 polygons: a slab from the eaves to the cupola, leaving a little gap to its neighbours' ridges.
pub(super) fn roof_panel() -> Mesh {
    let tangent = libm::tan(turn(0.5));
    let (inner, outer) = (0.36, 3.15);
    let (top, bottom) = (4.62, EAVES + 0.12);
    let slope = libm::atan2(top - bottom, outer - inner);
    let length = libm::hypot(top - bottom, outer - inner);
    // Laid flat with its eaves along x at the origin and its ridge towards -z, then leant inwards.
    let half = |radius: f64| radius * tangent - 0.004;
    let outline = [[-half(outer), 0.0], [half(outer), 0.0], [half(inner), length], [-half(inner), length]];
    prism(&outline, 0.0, 0.05).placed(&(moved(0.0, bottom, outer) * turned_x(slope)))
}
