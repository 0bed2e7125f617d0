//! Cameras, as each format can say them.

use super::numbers::{double, joined, single, vector};
use crate::scene::formats::limits::MAX_CAMERA_PIXELS;
use crate::scene::formats::looking;
use crate::scene::{Camera, ImageSize};
use glam::Vec3;
use std::fmt::Write;

/// The keys of a TOML table, a line each.
///
/// # Errors
/// If it is none that could be read back.
pub(super) fn toml(camera: &Camera) -> Result<String, String> {
    let Camera { origin, forward, right, up, tan_half_height, size, .. } = camera;
    if !looking::are_upright(*right, *up, *forward) || !origin.is_finite() {
        return Err("its axes are no unit vectors at right angles".into());
    }
    if !(*tan_half_height > 0.0 && tan_half_height.is_finite()) {
        return Err("it has no field of view".into());
    }
    let mut text = format!("position = {}\n", vector(*origin));
    let axes = [right, up, forward].map(|axis| vector(*axis)).join(", ");
    let _ = writeln!(text, "axes = [{axes}]\nhalf_height = {}", double(*tan_half_height));
    if let Some(size) = size {
        let ImageSize { width, height } = checked(*size)?;
        let _ = writeln!(text, "size = [{width}, {height}]");
    }
    Ok(text)
}

fn checked(ImageSize { width, height }: ImageSize) -> Result<ImageSize, String> {
    ImageSize::checked(width, height, MAX_CAMERA_PIXELS)
        .map_err(|why| format!("size {width} x {height}: {why}"))
}

/// The lines of an NFF viewpoint.
///
/// # Errors
/// If it has no image size, which NFF must say, or looks nowhere.
pub(super) fn nff(camera: &Camera) -> Result<String, String> {
    let size = checked(camera.size.ok_or("it has no image size, and NFF must say one")?)?;
    // The angle of NFF goes from the centre of the first row to that of the last.
    let rows = f64::from(size.height);
    let widened = if size.height > 1 { rows / (rows - 1.0) } else { 1.0 };
    let angle = 2.0 * libm::atan(camera.tan_half_height / widened).to_degrees();
    if !(angle > 0.0 && angle < 180.0) {
        return Err(format!("an angle of {angle} degrees, expected one between 0 and 180"));
    }
    let at = target(camera).ok_or("it looks nowhere")?;
    let point = |point: Vec3| joined(&point.to_array(), " ");
    Ok(format!(
        "v\nfrom {}\nat {}\nup {}\nangle {}\nhither {}\nresolution {} {}\n",
        point(camera.origin),
        point(at),
        point(camera.up),
        double(angle),
        single(0.0),
        size.width,
        size.height
    ))
}

/// A point that the camera looks at: of those at powers of two the first from which its axes come out again,
/// or else one far enough for its rounding not to matter.
fn target(camera: &Camera) -> Option<Vec3> {
    let at = |power: i32| camera.origin + camera.forward * 2.0f32.powi(power);
    let made = |at: Vec3| looking::camera("", [camera.origin, at, camera.up], 45.0).ok();
    let is_same =
        |other: Camera| (other.forward, other.right, other.up) == (camera.forward, camera.right, camera.up);
    let reach = camera.origin.abs().max_element().max(1.0);
    let (nearest, far) = (reach.log2().ceil() as i32, reach.log2().ceil() as i32 + 24);
    let exact = (nearest..far).map(at).find(|&at| at.is_finite() && made(at).is_some_and(is_same));
    exact.or_else(|| Some(at(far)).filter(|&at| at.is_finite() && made(at).is_some()))
}
