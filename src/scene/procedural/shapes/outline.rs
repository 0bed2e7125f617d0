//! Closed outlines in the plane, counter-clockwise.

use std::f64::consts::{FRAC_PI_2, TAU};

/// A regular polygon with so many corners on a circle; `phase` is the angle of the first.
pub(in crate::scene::procedural) fn circle(radius: f64, corners: usize, phase: f64) -> Vec<[f64; 2]> {
    (0..corners)
        .map(|corner| {
            let (sin, cos) = libm::sincos(phase + TAU * corner as f64 / corners as f64);
            [radius * cos, radius * sin]
        })
        .collect()
}

/// A rectangle around the origin whose corners are arcs of so many points each.
pub(in crate::scene::procedural) fn rounded_rectangle(
    half: [f64; 2],
    radius: f64,
    points_a_corner: usize,
) -> Vec<[f64; 2]> {
    let centres = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let mut outline = Vec::with_capacity(4 * points_a_corner);
    for (quarter, [sx, sy]) in centres.into_iter().enumerate() {
        for point in 0..points_a_corner {
            let share = point as f64 / (points_a_corner - 1).max(1) as f64;
            let (sin, cos) = libm::sincos((quarter as f64 + share) * FRAC_PI_2);
            outline.push([sx * (half[0] - radius) + radius * cos, sy * (half[1] - radius) + radius * sin]);
        }
    }
    outline
}
