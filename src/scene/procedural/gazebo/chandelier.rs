//! The chandelier: a hoop on seven arms, seven candles, and the chain it hangs on.

use super::CANDLES;
use crate::scene::procedural::shapes::{Caps, Closing, Mesh, circle, lathe, moved, prism, tube};
use crate::scene::procedural::shapes::{turned_ring, turned_y};
use glam::DVec3;
use std::f64::consts::TAU;

/// Height of the hoop.
const HOOP: f64 = 2.2;

const RADIUS: f64 = 0.36;

/// Upper side of the candles.
const CANDLE_TOP: f64 = HOOP + 0.25;

fn angle(number: usize) -> f64 {
    TAU * (number as f64 + 0.35) / CANDLES as f64
}

/// 90 polygons for the hoop, 26 for each arm, 42 for the hub.
pub(super) fn chandelier() -> Mesh {
    let triangle = [[RADIUS + 0.018, HOOP - 0.02], [RADIUS + 0.018, HOOP + 0.02], [RADIUS - 0.018, HOOP]];
    let hoop = turned_ring(&triangle, 30);
    let hub = [
        [0.02, HOOP - 0.1],
        [0.07, HOOP - 0.04],
        [0.07, HOOP + 0.04],
        [0.03, HOOP + 0.1],
        [0.02, HOOP + 0.5],
        [0.03, HOOP + 0.52],
    ];
    let hub = lathe(&hub, 8, Caps::Flat).smooth_up_to(50.0);
    (0..CANDLES).fold(hoop.with(&hub), |all, number| all.with(&arm().placed(&turned_y(angle(number)))))
}

/// An arm of four sides that swings down from the hub to the hoop.
fn arm() -> Mesh {
    let path: Vec<_> = (0..=6)
        .map(|i| i as f64 / 6.0)
        .map(|t| {
            let sag = 0.09 * libm::sin(TAU * 0.5 * t);
            (DVec3::new(0.0, HOOP + 0.02 - sag, 0.04 + (RADIUS - 0.04) * t), 0.014)
        })
        .collect();
    tube(&path, 4, Closing::Capped)
}

/// 14 polygons.
pub(super) fn candle(number: usize) -> Mesh {
    let at = turned_y(angle(number)) * moved(0.0, 0.0, RADIUS);
    prism(&circle(0.03, 12, 0.0), HOOP + 0.021, CANDLE_TOP).placed(&at)
}

/// Where the light of a candle is: just above its wick.
pub(super) fn candle_flame(number: usize) -> DVec3 {
    let at = turned_y(angle(number)) * moved(0.0, CANDLE_TOP + 0.045, RADIUS);
    at.translation
}

/// Links of 32 polygons, each turned by a right angle against the one before.
pub(super) fn chain() -> Mesh {
    const LINKS: usize = 6;
    let (low, high) = (HOOP + 0.5, 4.42);
    let pitch = (high - low) / LINKS as f64;
    let link = |number: usize| {
        let path: Vec<_> = (0..8)
            .map(|i| {
                let (sin, cos) = libm::sincos(TAU * i as f64 / 8.0);
                (DVec3::new(0.05 * cos, 0.58 * pitch * sin, 0.0), 0.012)
            })
            .collect();
        let turn = turned_y(TAU * 0.25 * (number % 2) as f64);
        tube(&path, 4, Closing::Loop).placed(&(moved(0.0, low + pitch * (number as f64 + 0.5), 0.0) * turn))
    };
    Mesh::union((0..LINKS).map(link))
}
