//! Transforms, in f64.

use super::schema::{RotationEntry, TransformEntry};
use super::values::{Exactly, Number};
use glam::{DAffine3, DMat3, DVec3};

/// The least volume that unit columns may span; below, everything would be flat.
const FLAT: f64 = 1e-12;

/// The transform of a table, or `None` if the table is empty.
///
/// # Errors
/// A line for keys that do not go together and for numbers that leave nothing to see.
pub(super) fn read(entry: &TransformEntry) -> Result<Option<DAffine3>, String> {
    let TransformEntry { matrix, scale, rotate, translate } = entry;
    let transform = match (matrix, scale, rotate, translate) {
        (None, None, None, None) => return Ok(None),
        (Some(rows), None, None, None) => affine(rows)?,
        (Some(_), ..) => {
            return Err("expected either `matrix` or `scale`, `rotate` and `translate`, found both".into());
        }
        (None, ..) => {
            let turn = rotate.as_ref().map_or(Ok(DMat3::IDENTITY), rotation)?;
            let scale = scale.map_or(DVec3::ONE, |scale| scale.0);
            DAffine3 {
                matrix3: turn * DMat3::from_diagonal(scale),
                translation: translate.map_or(DVec3::ZERO, Exactly::vector),
            }
        }
    };
    let columns = [transform.matrix3.x_axis, transform.matrix3.y_axis, transform.matrix3.z_axis];
    let units = columns.map(|column| column / column.abs().max_element());
    let volume = units[0].dot(units[1].cross(units[2])).abs();
    // Not a number, if a column is zero.
    match volume > FLAT {
        true => Ok(Some(transform)),
        false => Err("the transform makes everything flat".into()),
    }
}

fn affine(Exactly(rows): &Exactly<Exactly<Number, 4>, 4>) -> Result<DAffine3, String> {
    let [x, y, z, last] = rows.map(|row| row.0.map(|Number(number)| number));
    if last != [0.0, 0.0, 0.0, 1.0] {
        return Err(format!("expected the last row of `matrix` to be [0, 0, 0, 1], found {last:?}"));
    }
    let column = |i: usize| DVec3::new(x[i], y[i], z[i]);
    Ok(DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) })
}

/// The matrix of a right-handed turn.
pub(super) fn rotation(turn: &RotationEntry) -> Result<DMat3, String> {
    let axis = axis(turn)?;
    let (sin, cos) = sin_cos_degrees(turn.degrees.0);
    let (along, rest) = (axis * sin, axis * (1.0 - cos));
    Ok(DMat3::from_cols(
        rest.x * axis + DVec3::new(cos, along.z, -along.y),
        rest.y * axis + DVec3::new(-along.z, cos, along.x),
        rest.z * axis + DVec3::new(along.y, -along.x, cos),
    ))
}

/// The axis of a turn, of length 1.
pub(super) fn axis(turn: &RotationEntry) -> Result<DVec3, String> {
    let axis = turn.axis.vector();
    let size = axis.abs().max_element();
    // Scaled first: the square of a length near the ends of the range would overflow or vanish.
    (axis / size).try_normalize().ok_or_else(|| "expected `axis` to be a direction, found zero".into())
}

/// Sine and cosine of an angle in degrees, the same on every platform and exact at right angles.
pub(super) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    // Exact: the remainder of floats is.
    let rest = degrees % 90.0;
    let (sin, cos) = (libm::sin(rest.to_radians()), libm::cos(rest.to_radians()));
    match ((degrees - rest) / 90.0) % 4.0 {
        1.0 | -3.0 => (cos, -sin),
        2.0 | -2.0 => (-sin, -cos),
        3.0 | -1.0 => (-cos, sin),
        _ => (sin, cos),
    }
}

/// The cosine of an angle in degrees, as cones of lights have it.
pub(in crate::scene::formats) fn cosine_of_degrees(degrees: f64) -> f64 {
    sin_cos_degrees(degrees).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_angles_are_exact_and_others_are_close() {
        for (degrees, expected) in [
            (0.0, (0.0, 1.0)),
            (90.0, (1.0, 0.0)),
            (180.0, (0.0, -1.0)),
            (270.0, (-1.0, 0.0)),
            (360.0, (0.0, 1.0)),
            (-90.0, (-1.0, 0.0)),
            (-180.0, (0.0, -1.0)),
            (-270.0, (1.0, 0.0)),
            (3690.0, (1.0, 0.0)),
        ] {
            assert_eq!(sin_cos_degrees(degrees), expected, "{degrees}");
        }
        for step in -100..100 {
            let degrees = f64::from(step) * 7.3;
            let (sin, cos) = sin_cos_degrees(degrees);
            assert!((sin - degrees.to_radians().sin()).abs() < 1e-12, "{degrees}");
            assert!((cos - degrees.to_radians().cos()).abs() < 1e-12, "{degrees}");
        }
        let (sin, cos) = sin_cos_degrees(1e300);
        assert!((sin * sin + cos * cos - 1.0).abs() < 1e-12);
    }

    #[test]
    fn turns_are_right_handed_around_any_axis() {
        let turn = |axis: [f64; 3], degrees: f64| {
            rotation(&RotationEntry { axis: Exactly(axis.map(Number)), degrees: Number(degrees) }).unwrap()
        };
        assert_eq!(turn([0.0, 0.0, 5.0], 90.0) * DVec3::X, DVec3::Y);
        assert_eq!(turn([0.0, 1e-300, 0.0], 90.0) * DVec3::Z, DVec3::X);
        let third = turn([1e300; 3], 120.0) * DVec3::X;
        assert!(third.abs_diff_eq(DVec3::Y, 1e-15), "{third}");
    }
}
