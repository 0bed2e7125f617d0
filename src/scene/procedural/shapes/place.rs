//! Transforms with `libm`'s trigonometry, so that they have the same bits everywhere.

use glam::{DAffine3, DMat3, DVec3};

/// Moved by an offset.
pub(in crate::scene::procedural) fn moved(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

/// Turned about the x axis, from y to z.
pub(in crate::scene::procedural) fn turned_x(angle: f64) -> DAffine3 {
    let (sin, cos) = libm::sincos(angle);
    DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::new(0.0, cos, sin), DVec3::new(0.0, -sin, cos)))
}

/// Turned about the y axis, from z to x.
pub(in crate::scene::procedural) fn turned_y(angle: f64) -> DAffine3 {
    let (sin, cos) = libm::sincos(angle);
    DAffine3::from_mat3(DMat3::from_cols(DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos)))
}

/// Turned about the z axis, from x to y.
pub(in crate::scene::procedural) fn turned_z(angle: f64) -> DAffine3 {
    let (sin, cos) = libm::sincos(angle);
    DAffine3::from_mat3(DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z))
}

/// What stands on the origin along y, put between two points and stretched along their distance.
pub(in crate::scene::procedural) fn along(from: DVec3, to: DVec3, length: f64) -> DAffine3 {
    let axis = (to - from).normalize();
    let side = axis.any_orthonormal_vector();
    let stretch = (to - from).length() / length;
    let matrix = DMat3::from_cols(side, axis * stretch, side.cross(axis));
    DAffine3::from_mat3_translation(matrix, from)
}
