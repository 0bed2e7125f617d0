//! Cameras.

use super::document::name_of;
use super::schema::CameraEntry;
use super::values::{Exactly, Number};
use crate::scene::formats::limits::MAX_CAMERA_PIXELS;
use crate::scene::formats::looking;
use crate::scene::{Camera, ImageSize};
use glam::Vec3;

/// The field of view of a camera that says none.
const USUAL_DEGREES: f64 = 45.0;

/// The camera of a table; `index` counts from 0 and names it if it has no name.
///
/// # Errors
/// A line for keys that are missing or do not go together, and for numbers that leave no direction to look in,
/// no field of view or no pixels.
pub(super) fn read(entry: &CameraEntry, index: usize) -> Result<Camera, String> {
    let size = match entry.size.map(|size| size.0) {
        None => None,
        Some([width, height]) => {
            let size = ImageSize::checked(width, height, MAX_CAMERA_PIXELS);
            Some(size.map_err(|why| format!("size {width} x {height}: {why}"))?)
        }
    };
    let position = entry.position.ok_or("expected a `position`, found none")?.0;
    let name = name_of("camera", index, entry.name.as_deref());
    let camera = match (entry.target, entry.axes) {
        (Some(target), None) => {
            let up = entry.up.map_or(Vec3::Y, |up| up.0);
            looking::camera(&name, [position, target.0, up], USUAL_DEGREES)
                .map_err(|why| why.message("`position` and `target`"))?
        }
        (None, Some(Exactly(axes))) if entry.up.is_none() => {
            let [right, up, forward] = axes.map(|axis| axis.0);
            if !looking::are_upright(right, up, forward) {
                return Err(
                    "expected `axes` to be unit vectors to the right, up and ahead, at right angles".into()
                );
            }
            Camera {
                name,
                origin: position,
                forward,
                right,
                up,
                tan_half_height: 1.0,
                size: None,
                window: None,
            }
        }
        (None, Some(_)) => return Err("`up` is for cameras with a `target`".into()),
        (None, None) => return Err("expected a `target` or `axes`, found neither".into()),
        (Some(_), Some(_)) => return Err("expected either `target` or `axes`, found both".into()),
    };
    Ok(Camera { size, tan_half_height: tan_half_height(entry)?, ..camera })
}

fn tan_half_height(entry: &CameraEntry) -> Result<f64, String> {
    match (entry.vertical_degrees, entry.half_height) {
        (Some(_), Some(_)) => Err("expected either `vertical_degrees` or `half_height`, found both".into()),
        (None, Some(Number(tangent))) if tangent > 0.0 => Ok(tangent),
        (None, Some(Number(tangent))) => Err(format!("expected `half_height` above 0, found {tangent}")),
        (degrees, None) => {
            let degrees = degrees.map_or(USUAL_DEGREES, |Number(degrees)| degrees);
            if !(degrees > 0.0 && degrees < 180.0) {
                return Err(format!("expected `vertical_degrees` between 0 and 180, found {degrees}"));
            }
            Ok(libm::tan(degrees.to_radians() * 0.5))
        }
    }
}
