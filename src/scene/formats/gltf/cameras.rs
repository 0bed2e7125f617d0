//! Perspective cameras.

use super::nodes::Placed;
use super::schema::{CameraEntry, Document};
use crate::scene::Camera;
use crate::scene::formats::text::printable;

/// The camera of a node, `None` if it is orthographic. The image's own proportions replace `aspectRatio`.
///
/// # Errors
/// A line if there is no such camera, its field of view is none, or its transform has no view direction.
pub(super) fn read(document: &Document, placed: &Placed, index: u64) -> Result<Option<Camera>, String> {
    let entry = usize::try_from(index).ok().and_then(|i| document.cameras.get(i));
    let entry = entry.ok_or_else(|| format!("camera {index} of {}", document.cameras.len()))?;
    let Some(perspective) = &entry.perspective else { return Ok(None) };
    if !(perspective.yfov > 0.0 && perspective.yfov < std::f64::consts::PI) {
        return Err(format!("camera {index}: yfov {}, expected an angle between 0 and pi", perspective.yfov));
    }
    // It looks along -z with y up; scale and shear are taken out again.
    let axes = placed.world.matrix3;
    let forward = (-axes.z_axis).try_normalize();
    let right =
        forward.and_then(|forward| (axes.x_axis - axes.x_axis.dot(forward) * forward).try_normalize());
    let origin = placed.world.translation.as_vec3();
    let (Some(forward), Some(right), true) = (forward, right, origin.is_finite()) else {
        return Err(format!("camera {index}: its node's transform leaves no direction to look at"));
    };
    Ok(Some(Camera {
        name: name(placed, entry, index),
        origin,
        forward: forward.as_vec3(),
        right: right.as_vec3(),
        up: right.cross(forward).as_vec3(),
        tan_half_height: libm::tan(perspective.yfov * 0.5),
        size: None,
        window: None,
    }))
}

/// A node is the camera in its place; the entry may be shared by several.
fn name(placed: &Placed, entry: &CameraEntry, index: u64) -> String {
    let given = placed.node.name.as_deref().or(entry.name.as_deref());
    given.map_or_else(|| format!("camera-{index}"), printable)
}
