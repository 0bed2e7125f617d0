//! A camera's picture as a grid of boxes that hold its rays.

use crate::geometry::footprint::{Frame, Grid};
use crate::geometry::ray_triangle::RayParameter;
use crate::scene::{Camera, ImageSize, Raster, Scene};
use glam::{DVec3, Vec3};

/// The largest image at distance 1, from its centre, on which [`pixel_grid`] bounds the rays: their depth
/// is 1 within 2^-22 of their length.
const WIDEST_IMAGE: f64 = 1_048_576.0;

/// Rows of a band.
pub(super) const BAND_ROWS: usize = 32;

/// The most that the column or row of a vertex' place may be wrong by beside its own rounding, in pixels.
pub(super) const PLACE_ERROR: f64 = 1.0 / 1024.0;

/// Who looks at what.
pub(super) struct View<'a> {
    pub scene: &'a Scene,
    pub camera: &'a Camera,
    /// Where the camera is.
    pub apex: DVec3,
    pub raster: Raster,
    pub grid: Grid,
    pub frame: Frame,
    /// Of the grid.
    pub reach: [f64; 2],
    /// From pixel to pixel, along the axis on which it is less.
    pub smallest_step: f64,
    /// Whether some triangles are not there everywhere.
    pub has_holes: bool,
    /// How far beside a vertex' place a ray can be that passes it, along each axis and in pixels.
    pub margins: [f32; 2],
    /// More than any ray's depth differs from 1.
    depth_error: f64,
}

impl<'a> View<'a> {
    /// `None` if the picture is so wide that a ray's rounding can turn it behind the image plane, where there are no
    /// footprints.
    pub fn new(scene: &'a Scene, camera: &'a Camera, size: ImageSize) -> Option<View<'a>> {
        let raster = camera.raster(size);
        let length = 1.0 + raster.x0.abs() + raster.y0.abs();
        if length > WIDEST_IMAGE {
            return None;
        }
        let grid = pixel_grid(&raster, size);
        let margins =
            [0, 1].map(|axis| ((grid.half[axis] / grid.step[axis].abs() + PLACE_ERROR) * 1.000_001) as f32);
        let [x, y, z] = [camera.right, camera.up, camera.forward].map(|axis| axis.as_dvec3());
        Some(View {
            scene,
            camera,
            apex: camera.origin.as_dvec3(),
            raster,
            reach: grid.reach(),
            frame: Frame::perspective(x, y, z),
            smallest_step: grid.step[0].abs().min(grid.step[1].abs()),
            has_holes: !scene.alpha_masks.is_empty(),
            margins,
            grid,
            depth_error: length / 2_097_152.0,
        })
    }

    /// The ray of a pixel.
    pub fn direction(&self, column: u32, row: u32) -> Vec3 {
        self.camera.direction(&self.raster, column, row)
    }

    /// Bounds of 1 / depth where a ray hits something.
    pub fn nearness(&self, hit: RayParameter) -> [f32; 2] {
        // The depth is that of the ray's direction, times the parameter; half of this would be for the roundings.
        let error = self.depth_error * 2.0 + 1e-6;
        let least = (1.0 - error) / (hit.value + hit.error);
        let most = (1.0 + error) / (hit.value - hit.error);
        let is_bounded = hit.value > hit.error && least > 1e-30 && most < 1e30;
        if is_bounded { [least as f32, most as f32] } else { [0.0, f32::INFINITY] }
    }
}

/// Pixel centres as boxes that hold the rounded rays: a ray's direction is within 2^-24 of each of its
/// coordinates, which on the image plane moves it by less than 2^-20 of (1 + distance from the centre)^2.
fn pixel_grid(raster: &Raster, size: ImageSize) -> Grid {
    let half = 1.0 + raster.x0.abs() + raster.y0.abs();
    let half = half * half / 1_048_576.0;
    Grid {
        // Off by roundings of f64, far less than what the boxes are wider than the rays.
        origin: [raster.x0, raster.y0 + f64::from(raster.first_row) * raster.step_y],
        step: [raster.step_x, raster.step_y],
        half: [half; 2],
        count: [size.width, size.height],
    }
}
