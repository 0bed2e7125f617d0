//! Normals from files, made safe to normalise.

use crate::scene::SmoothNormals;
use glam::{DMat3, DVec3, Vec3};

/// Replaces every unusable normal (zero or not finite) by the face normal of its triangle, and returns how
/// many corners that concerns. `corners` of a triangle may hold [`NO_NORMAL`] where the file gives none.
pub(in crate::scene) fn repair(
    normals: &mut SmoothNormals,
    positions: &[Vec3],
    triangles: &[[u32; 3]],
) -> usize {
    let mut replaced = 0;
    for (corners, triangle) in normals.corners.iter_mut().zip(triangles) {
        let usable = |corner: u32| {
            let normal = normals.normals.get(corner as usize).copied().unwrap_or(Vec3::ZERO);
            normal.is_finite() && normal != Vec3::ZERO
        };
        let bad = corners.map(|corner| !usable(corner));
        if !bad.contains(&true) {
            continue;
        }
        let face = normals.normals.len() as u32;
        normals.normals.push(face_normal(triangle.map(|v| positions[v as usize])));
        for (corner, bad) in corners.iter_mut().zip(bad) {
            if bad {
                replaced += usize::from(*corner != NO_NORMAL);
                *corner = face;
            }
        }
    }
    replaced
}

/// Stands in [`SmoothNormals::corners`] for a corner without a normal until [`repair`] has run.
pub(in crate::scene) const NO_NORMAL: u32 = u32::MAX;

/// The unit normal of a triangle; y for one of zero area, which is dropped anyway.
fn face_normal(corners: [Vec3; 3]) -> Vec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    unit((b - a).cross(c - a)).unwrap_or(Vec3::Y)
}

/// The matrix that turns normals where another turns positions: the inverse transpose but for a factor above
/// 0, which needs no division.
pub(in crate::scene) fn matrix(m: &DMat3) -> DMat3 {
    let cofactors =
        DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    cofactors * if m.determinant() < 0.0 { -1.0 } else { 1.0 }
}

/// A direction as a unit vector, if it has one.
pub(in crate::scene) fn unit(direction: DVec3) -> Option<Vec3> {
    // Scaled first: the square of a length near the ends of the range would overflow or vanish.
    let scale = direction.abs().max_element();
    if !(scale > 0.0 && scale.is_finite()) {
        return None;
    }
    Some((direction / scale).normalize().as_vec3())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unusable_normals_become_face_normals() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let mut normals = SmoothNormals {
            normals: vec![Vec3::X, Vec3::ZERO, Vec3::NAN],
            corners: vec![[0, 1, 2], [0, 0, NO_NORMAL], [0, 0, 0]],
        };
        let replaced = repair(&mut normals, &positions, &[[0, 1, 2]; 3]);
        assert_eq!(replaced, 2);
        assert_eq!(normals.corners, [[0, 3, 3], [0, 0, 4], [0, 0, 0]]);
        assert_eq!(normals.normals[3], Vec3::Z);
    }

    #[test]
    fn directions_at_the_ends_of_the_range_have_a_length() {
        assert_eq!(unit(DVec3::new(0.0, 1e-300, 0.0)), Some(Vec3::Y));
        assert_eq!(unit(DVec3::new(1e300, 0.0, 0.0)), Some(Vec3::X));
        assert_eq!(unit(DVec3::ZERO), None);
        assert_eq!(unit(DVec3::new(f64::INFINITY, 0.0, 0.0)), None);
    }
}
