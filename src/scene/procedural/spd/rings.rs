//! A pyramid of knots, each of six pentagonal rings that are linked with each other.

use super::{NO_SHINE, quadrangle, studio, surface, upright};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::scene::Scene;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_8, TAU};

/// From the middle of a knot to the corners of its rings.
const RADIUS: f64 = 0.930995;

/// Of the tubes and the spheres that join them.
const TUBE: f32 = 0.07412;

const COLOURS: [[f32; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]];

pub(in crate::scene::procedural) fn build(size: u32) -> Result<Scene> {
    let layer = 1.0 / libm::sin(FRAC_PI_8);
    let near = -layer as f32;
    let view = upright([-1.0, near, 0.5], [-1.0, near + 1.0, 0.5]);
    let lights = [[3.0, near, 3.0], [-4.0, near, 1.0], [2.0, near, -4.0]];
    let mut studio = studio("rings", &view, &lights);
    let white = studio.material(surface("background", [1.0; 3], [1.0, 0.0, NO_SHINE]));
    let far = layer * f64::from(size + 1);
    // A little more than what the camera sees of that plane.
    let half = (1.01 * libm::tan(FRAC_PI_8) * (far + layer)) as f32;
    let corner = |sx: f32, sz: f32| [-1.0 + sx * half, far as f32, 0.5 + sz * half];
    let corners = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
    studio.add_input(quadrangle("background", white, corners))?;
    let materials = COLOURS.map(|colour| studio.material(surface("ring", colour, [0.5, 0.2, 3.0827])));
    let mut count = 0;
    for row in 1..=size {
        let place = |step: u32| 2.0 * f64::from(step) - f64::from(row - 1);
        for cell in 0..row * row {
            let centre = DVec3::new(place(cell % row), layer * f64::from(row), place(cell / row));
            for (ring, material) in materials.into_iter().enumerate() {
                count += 1;
                studio.add(format!("ring {count}"), material, pentagon(centre, ring))?;
            }
        }
    }
    Ok(studio.finish())
}

/// The ring of this number: the first lies level, the others lean on it, each a fifth of a turn further. Their
/// axes are those of an icosahedron.
fn pentagon(centre: DVec3, ring: usize) -> [Shape; 10] {
    let (first, second) = if ring == 0 {
        (DVec3::X, DVec3::Y)
    } else {
        let (sin, cos) = libm::sincos(TAU * (0.1 + 0.2 * (ring - 1) as f64));
        let fifth = 1.0 / 5f64.sqrt();
        (DVec3::new(cos, sin, 0.0), DVec3::new(-sin * fifth, cos * fifth, 2.0 * fifth))
    };
    let corner = |number: usize| {
        let (sin, cos) = libm::sincos(TAU * number as f64 / 5.0);
        (centre + (first * cos + second * sin) * RADIUS).as_vec3()
    };
    std::array::from_fn(|part| match part % 2 {
        0 => Shape::cylinder(corner(part / 2), corner((part / 2 + 4) % 5), TUBE),
        _ => Shape::sphere(corner(part / 2), TUBE),
    })
}
