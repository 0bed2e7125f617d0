//! A fractal mountain under four balls of glass.
//!
//! Heights are found by halving: the middle of an edge lies between its ends, and off by a random amount that
//! shrinks with the edge. That amount is a hash of the place, so that both sides of an edge agree.

use super::{NO_SHINE, studio, surface, transparent, upright};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::random::Random;
use crate::scene::{ObjectInput, Scene};
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;

/// How much less rough each halving is: 2 to the power of minus this.
const SMOOTHNESS: f64 = 1.05;

/// The most that the middle of the largest edges is lifted or lowered, times 0.4.
const ROUGHNESS: f64 = 0.72;

/// How far the middle of the whole is lifted, in the same unit.
const PEAK: f64 = 0.9;

const BALL: f64 = 0.17;

pub(in crate::scene::procedural) fn build(size: u32) -> Result<Scene> {
    let mut studio = studio("mount", &upright([-1.6, 1.6, 1.7], [0.0; 3]), &[[-100.0, -100.0, 100.0]]);
    let glass = transparent(surface("glass", [1.0; 3], [0.1, 0.1, 101.148]), 0.9, 1.5);
    let glass = studio.material(glass);
    for (number, place) in balls().into_iter().enumerate() {
        let ball = Shape::sphere(place.as_vec3(), BALL as f32);
        studio.add(format!("ball {}", number + 1), glass, ball)?;
    }
    let rock = studio.material(surface("rock", [0.5, 0.45, 0.35], [1.0, 0.0, NO_SHINE]));
    let (positions, triangles) = mountain(size);
    studio.add_input(ObjectInput { material: rock, ..ObjectInput::new("mountain", positions, triangles) })?;
    Ok(studio.finish())
}

/// Four balls that touch each other, one on top.
fn balls() -> [DVec3; 4] {
    let top = DVec3::new(-0.8, 0.8, 1.20821);
    let distance = 2.0 * BALL / 6f64.sqrt();
    std::array::from_fn(|number| match number {
        0 => top,
        _ => {
            let (sin, cos) = libm::sincos(TAU * (number - 1) as f64 / 3.0);
            top + DVec3::new(cos + sin, sin - cos, -2.0) * distance
        }
    })
}

/// A square of 2^size by 2^size cells, two triangles each.
fn mountain(size: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let cells = 1usize << size;
    let row = cells + 1;
    let mut heights = vec![0.0f64; row * row];
    let mut step = cells;
    let mut rough = ROUGHNESS;
    while step > 1 {
        let half = step / 2;
        // Edges along x, along y, and the middles of the squares, in this order.
        for (odd_x, odd_y) in [(true, false), (false, true), (true, true)] {
            for y in (if odd_y { half } else { 0 }..=cells).step_by(step) {
                for x in (if odd_x { half } else { 0 }..=cells).step_by(step) {
                    let at = |x: usize, y: usize| heights[y * row + x];
                    let mean = match (odd_x, odd_y) {
                        (true, false) => 0.5 * (at(x - half, y) + at(x + half, y)),
                        (false, true) => 0.5 * (at(x, y - half) + at(x, y + half)),
                        _ => 0.25 * (at(x - half, y) + at(x + half, y) + at(x, y - half) + at(x, y + half)),
                    };
                    let off = match (step == cells, odd_x && odd_y) {
                        // A peak in the middle of everything, and gentle borders.
                        (true, true) => PEAK,
                        (true, false) => 0.4 * noise([x, y], cells),
                        (false, _) => noise([x, y], cells),
                    };
                    heights[y * row + x] = mean + rough * off;
                }
            }
        }
        step = half;
        rough *= libm::exp2(-SMOOTHNESS);
    }
    let coordinate = |number: usize| -1.0 + 2.0 * number as f32 / cells as f32;
    let position = |i: usize| Vec3::new(coordinate(i % row), coordinate(i / row), heights[i] as f32);
    let corner = |x: usize, y: usize| (y * row + x) as u32;
    let cell = |i: usize| {
        let (x, y) = (i % cells, i / cells);
        let (near, far) = (corner(x, y), corner(x + 1, y + 1));
        [[near, corner(x + 1, y), far], [far, corner(x, y + 1), near]]
    };
    ((0..row * row).map(position).collect(), (0..cells * cells).flat_map(cell).collect())
}

/// A number from -1 to 1 for a place on the square; the same place has the same at every size.
fn noise(place: [usize; 2], cells: usize) -> f64 {
    let [x, y] = place.map(|number| ((number << 20) / cells) as u64);
    Random::new((x << 32) | y).signed()
}
