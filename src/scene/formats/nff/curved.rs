//! `s` and `c` lines: spheres, and the walls of cylinders and cones.

use super::words::{Complaint, Words};
use crate::geometry::curved::Shape;
use glam::Vec3;

/// Reads what follows `s`: `x y z radius`.
///
/// A negative radius says that the inside is to be seen; both sides always are, and the sign goes.
pub(super) fn sphere(words: &mut Words) -> Result<Shape, Complaint> {
    let [x, y, z, radius] = words.numbers()?;
    Ok(Shape::sphere(Vec3::new(x, y, z), radius.abs()))
}

/// Reads what follows `c`: `x y z radius` of the base, then of the apex.
///
/// # Errors
/// Radii of different signs, of which one says that the inside is to be seen and the other that it is not.
pub(super) fn cone(words: &mut Words) -> Result<Shape, Complaint> {
    let first = words.line();
    let [base, apex] = [words.numbers::<4>()?, words.numbers::<4>()?];
    let [base_radius, apex_radius] = [base[3], apex[3]];
    if base_radius < 0.0 && apex_radius > 0.0 || base_radius > 0.0 && apex_radius < 0.0 {
        let why = format!("expected radii of one sign, found {base_radius} and {apex_radius}");
        return Err((first, why));
    }
    let end = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
    Ok(Shape::cone(end(base), base_radius.abs(), end(apex), apex_radius.abs()))
}
