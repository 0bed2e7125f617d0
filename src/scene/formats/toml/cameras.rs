//! Cameras.

use super::document::name_of;
use super::schema::CameraEntry;
use super::values::Number;
use crate::scene::formats::limits::MAX_CAMERA_PIXELS;
use crate::scene::formats::looking;
use crate::scene::{Camera, ImageSize};
use glam::Vec3;

/// The field of view of a camera that says none.
const USUAL_DEGREES: f64 = 45.0;

/// The camera of a table; `index` counts from 0 and names it if it has no name.
///
/// # Errors
/// A line for numbers that leave no direction to look in, no field of view or no pixels.
pub(super) fn read(entry: &CameraEntry, index: usize) -> Result<Camera, String> {
    let degrees = entry.vertical_degrees.map_or(USUAL_DEGREES, |Number(degrees)| degrees);
    if !(degrees > 0.0 && degrees < 180.0) {
        return Err(format!("expected `vertical_degrees` between 0 and 180, found {degrees}"));
    }
    let size = match entry.size.map(|size| size.0) {
        None => None,
        Some([width, height]) => {
            let size = ImageSize::checked(width, height, MAX_CAMERA_PIXELS);
            Some(size.map_err(|why| format!("size {width} x {height}: {why}"))?)
        }
    };
    let up = entry.up.map_or(Vec3::Y, |up| up.0);
    let name = name_of("camera", index, entry.name.as_deref());
    let camera = looking::camera(&name, [entry.position.0, entry.target.0, up], degrees)
        .map_err(|why| why.message("`position` and `target`"))?;
    Ok(Camera { size, ..camera })
}
