//! Profiles and boards of the chair, with as many bands as its count of polygons asks for.

use crate::scene::procedural::shapes::{Closing, Mesh, bevelled_prism, loft, rounded_rectangle};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Radii of a turned part at equal steps of its height from 0 to 1: `bands` of them and one more.
fn profile(bands: usize, radius: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    (0..=bands).map(|i| i as f64 / bands as f64).map(|t| [radius(t), t]).collect()
}

/// A swelling of this height around a place, as wide to both sides.
fn bead(t: f64, place: f64, width: f64, height: f64) -> f64 {
    let away = (t - place) / width;
    if away.abs() < 1.0 { height * libm::cos(0.5 * PI * away) } else { 0.0 }
}

/// 24 bands: slender below, with a vase and two rings above.
pub(super) fn leg_profile() -> Vec<[f64; 2]> {
    profile(24, |t| {
        let taper = 0.15 + 0.06 * t;
        taper
            + bead(t, 0.2, 0.16, 0.05)
            + bead(t, 0.46, 0.045, 0.075)
            + bead(t, 0.68, 0.17, 0.09)
            + bead(t, 0.9, 0.045, 0.07)
            - bead(t, 0.83, 0.05, 0.045)
    })
}

/// 12 bands: thickest in the middle, with a ring there.
pub(super) fn stretcher_profile() -> Vec<[f64; 2]> {
    profile(12, |t| 0.1 + 0.07 * libm::sin(PI * t) + bead(t, 0.5, 0.1, 0.06))
}

/// 20 bands.
pub(super) fn post_profile() -> Vec<[f64; 2]> {
    profile(20, |t| {
        0.17 - 0.04 * t
            + bead(t, 0.16, 0.12, 0.06)
            + bead(t, 0.35, 0.055, 0.08)
            + bead(t, 0.62, 0.2, 0.05)
            + bead(t, 0.96, 0.06, 0.06)
    })
}

/// 16 bands: an arrow-like swelling below the middle.
pub(super) fn spindle_profile() -> Vec<[f64; 2]> {
    profile(16, |t| 0.075 + bead(t, 0.42, 0.25, 0.06) + bead(t, 0.72, 0.07, 0.045))
}

/// 14 bands: a baluster.
pub(super) fn support_profile() -> Vec<[f64; 2]> {
    profile(14, |t| 0.1 + bead(t, 0.3, 0.3, 0.11) + bead(t, 0.72, 0.1, 0.07) - bead(t, 0.56, 0.1, 0.02))
}

/// 98 polygons around its upper side: rounded, its edges bevelled.
pub(super) fn seat() -> Mesh {
    let outline = rounded_rectangle([1.78, 1.72], 0.7, 8);
    bevelled_prism(&outline, &[[-0.42, 0.9], [-0.3, 1.0], [-0.1, 1.0], [0.0, 0.94]]).smooth_up_to(30.0)
}

/// 130 polygons: a board with a rim, its inside lower.
pub(super) fn tray() -> Mesh {
    let outline = rounded_rectangle([2.15, 1.0], 0.6, 8);
    let levels = [[0.0, 0.94], [0.08, 1.0], [0.34, 1.0], [0.34, 0.96], [0.16, 0.92]];
    bevelled_prism(&outline, &levels).smooth_up_to(30.0)
}

/// 62 polygons.
pub(super) fn footrest() -> Mesh {
    let outline = rounded_rectangle([1.95, 0.5], 0.2, 5);
    bevelled_prism(&outline, &[[0.0, 0.96], [0.06, 1.0], [0.16, 1.0], [0.2, 0.96]]).smooth_up_to(30.0)
}

/// An oval section across a path, `flat` being its half height, `wide` its half width.
fn oval(centre: DVec3, direction: DVec3, [wide, flat]: [f64; 2]) -> Vec<DVec3> {
    let side = DVec3::Y.cross(direction).normalize();
    let up = direction.cross(side).normalize();
    (0..12)
        .map(|step| {
            let (sin, cos) = libm::sincos(TAU * step as f64 / 12.0);
            centre + side * (wide * cos) + up * (flat * sin)
        })
        .collect()
}

/// 146 polygons: a bent rail around the origin, highest in the middle.
pub(super) fn crest() -> Mesh {
    let at = |t: f64| {
        let x = 2.0 * t - 1.0;
        DVec3::new(1.72 * x, 0.3 * (1.0 - x * x), -0.36 * (1.0 - x * x))
    };
    skin(12, at, |t| {
        let swell = libm::sin(PI * t);
        [0.12 + 0.03 * swell, 0.18 + 0.3 * swell]
    })
}

/// 122 polygons: from the post forward over the support, ending in a broad hand.
pub(super) fn arm(side: f64) -> Mesh {
    let at =
        |t: f64| DVec3::new(side * (1.4 + 0.36 * libm::sin(0.62 * PI * t)), 7.38 - 0.1 * t, -1.72 + 3.4 * t);
    skin(10, at, |t| [0.15 + 0.12 * t * t + 0.03 * libm::sin(PI * t), 0.11])
}

/// Ovals along a path, so many bands.
fn skin(bands: usize, at: impl Fn(f64) -> DVec3, size: impl Fn(f64) -> [f64; 2]) -> Mesh {
    let section = |band: usize| {
        let t = band as f64 / bands as f64;
        oval(at(t), (at(t + 1e-3) - at(t - 1e-3)).normalize(), size(t))
    };
    loft(&(0..=bands).map(section).collect::<Vec<_>>(), Closing::Capped).smooth_up_to(50.0)
}
