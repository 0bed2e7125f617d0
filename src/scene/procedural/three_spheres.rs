//! Figures 9, 10, 11 and 18 of the t-buffer paper (Raghuvanshi and Dhande 2004): three stacked spheres on an
//! infinite ground, under one point light and a sky.
//!
//! How they are stacked, their colours and the view are not given; two stand side by side here and the third lies
//! on both. Each of them touches the others, so that they show in each other.

use super::studio::{Studio, matt, polished};
use crate::error::Result;
use crate::geometry::curved::{InfinitePlane, Shape};
use crate::scene::{ImageSize, Mapping, Material, Pattern, Scene, Texture};
use glam::Vec3;

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

pub(super) fn build() -> Result<Scene> {
    let mut studio = Studio::new("three-spheres");
    let ground = painted(&mut studio, matt("ground", [0.62, 0.6, 0.54]), [0.2, 0.24, 0.22], 1.0)?;
    let plane = InfinitePlane { point: Vec3::ZERO, normal: Vec3::Y };
    studio.add("ground", ground, Shape::Plane(plane))?;
    let red = studio.material(polished("red", [0.6, 0.09, 0.06], 0.3));
    let blue = studio.material(polished("blue", [0.07, 0.16, 0.52], 0.3));
    let top = painted(&mut studio, polished("gold", [0.68, 0.5, 0.14], 0.22), [0.3, 0.12, 0.04], 0.25)?;
    // The centres are the corners of an upright triangle with three equal sides.
    let height = 1.0 + 3.0_f64.sqrt() as f32;
    studio.add("left sphere", red, Shape::sphere(Vec3::new(-1.0, 1.0, 0.0), 1.0))?;
    studio.add("right sphere", blue, Shape::sphere(Vec3::new(1.0, 1.0, 0.0), 1.0))?;
    studio.add("top sphere", top, Shape::sphere(Vec3::new(0.0, height, 0.0), 1.0))?;
    studio.background([0.28, 0.5, 0.85]);
    studio.lamp("lamp", [-5.0, 8.0, 6.0], [0.95, 0.93, 0.88]);
    studio.camera([1.2, 3.1, 8.6], [0.25, 1.55, 0.0], 36.0, SIZE);
    Ok(studio.finish())
}

/// A material cut from a block of cells of its own colour and another.
fn painted(studio: &mut Studio, material: Material, other: [f32; 3], size: f32) -> Result<u32> {
    // The cells do not end in the ground, where rounding would decide which of two a point is in.
    let mapping = Mapping::Solid { origin: Vec3::splat(-0.4 * size), size };
    let texture = studio.texture(Texture { pattern: Pattern::Checker { other }, mapping })?;
    Ok(studio.material(Material { texture: Some(texture), ..material }))
}
