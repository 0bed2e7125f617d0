//! Normals for shading. None of them ever decides who sees a light.

use crate::scene::{Primitive, PrimitiveIndex, Scene, SmoothNormals};
use glam::{DVec3, Vec3};

/// The unit normal that a point of a primitive is shaded with, on the side that the viewer is on; `view` is the
/// unit vector to the viewer.
pub fn normal_at(scene: &Scene, primitive: PrimitiveIndex, position: DVec3, view: DVec3) -> DVec3 {
    match scene.primitive(primitive) {
        Primitive::Triangle(corners) => {
            let object = scene.object(primitive);
            let geometric = geometric_normal(corners, view);
            let within = (primitive - object.first) as usize;
            let weights = barycentric(corners.map(|c| c.as_dvec3()), position);
            shading_normal(object.normals.as_ref(), within, weights, geometric)
        }
        Primitive::Curved(shape) => match shape.gradient(position).try_normalize() {
            Some(normal) if normal.dot(view) < 0.0 => -normal,
            Some(normal) => normal,
            None => view,
        },
    }
}

/// Weights of the corners at a point of the triangle; they add up to 1.
pub(super) fn barycentric([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    if area == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let wb = (p - a).cross(c - a).dot(normal) / area;
    let wc = (b - a).cross(p - a).dot(normal) / area;
    [1.0 - wb - wc, wb, wc]
}

/// The unit normal of a triangle on the side that the viewer is on.
///
/// `view` is the unit vector from the surface to the viewer. A triangle so thin that its normal vanishes in
/// f64 gets `view`.
pub fn geometric_normal(corners: [Vec3; 3], view: DVec3) -> DVec3 {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    // The exponents of f32 leave room enough in f64: nothing here can overflow or underflow.
    match (b - a).cross(c - a).try_normalize() {
        Some(normal) if normal.dot(view) < 0.0 => -normal,
        Some(normal) => normal,
        None => view,
    }
}

/// The interpolated normal at a point of a triangle, of unit length.
///
/// `triangle` counts within the object; `barycentric` are the weights of its three corners; `geometric` is
/// what [`geometric_normal`] gives. The normal is turned to the side of the geometric one, and so to the
/// viewer, whichever way the file's normals and corners go round; it is compared with that and not with the
/// view, because at a silhouette a smooth normal may well lean away, and turning it there would draw bright
/// speckles around every object. Where there are no normals, or they cancel or are not finite, it is the
/// geometric one.
pub fn shading_normal(
    normals: Option<&SmoothNormals>,
    triangle: usize,
    barycentric: [f64; 3],
    geometric: DVec3,
) -> DVec3 {
    let Some(smooth) = normals else { return geometric };
    let corner = |index: u32| smooth.normals[index as usize].as_dvec3().normalize_or_zero();
    let [a, b, c] = smooth.corners[triangle].map(corner);
    let sum = a * barycentric[0] + b * barycentric[1] + c * barycentric[2];
    // Opposite normals cancel to rounding noise, which has a direction but no meaning.
    if !(sum.length_squared() > 1e-12 && sum.is_finite()) {
        return geometric;
    }
    let normal = sum.normalize();
    if normal.dot(geometric) < 0.0 { -normal } else { normal }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn smooth(normals: [Vec3; 3]) -> SmoothNormals {
        SmoothNormals { normals: normals.to_vec(), corners: vec![[0, 1, 2]] }
    }

    #[test]
    fn corners_have_their_own_weight() {
        let corners = [DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 3.0, 1.0)];
        assert_eq!(barycentric(corners, corners[0]), [1.0, 0.0, 0.0]);
        assert_eq!(barycentric(corners, corners[1]), [0.0, 1.0, 0.0]);
        assert_eq!(barycentric(corners, corners[2]), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn the_geometric_normal_looks_at_the_viewer_from_either_side() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        assert_eq!(geometric_normal(corners, DVec3::Z), DVec3::Z);
        assert_eq!(geometric_normal(corners, DVec3::NEG_Z), DVec3::NEG_Z);
        assert_eq!(geometric_normal([Vec3::ZERO; 3], DVec3::X), DVec3::X);
        let tiny = corners.map(|corner| corner * 1e-42);
        assert_relative_eq!(geometric_normal(tiny, DVec3::Z).z, 1.0);
        let huge = corners.map(|corner| corner * 3e38);
        assert_relative_eq!(geometric_normal(huge, DVec3::Z).z, 1.0);
    }

    #[test]
    fn interpolation_weighs_directions_not_lengths() {
        let normals = smooth([Vec3::X * 100.0, Vec3::Z, Vec3::Z]);
        let middle = shading_normal(Some(&normals), 0, [0.5, 0.5, 0.0], DVec3::Z);
        assert_relative_eq!(middle.x, middle.z);
        assert_relative_eq!(middle.length(), 1.0);
        assert_eq!(shading_normal(Some(&normals), 0, [0.0, 0.0, 1.0], DVec3::NEG_Z), DVec3::NEG_Z);
    }

    #[test]
    fn useless_normals_give_way_to_the_geometric_one() {
        let third = [1.0 / 3.0; 3];
        for normals in [[Vec3::ZERO; 3], [Vec3::NAN; 3], [Vec3::INFINITY; 3]] {
            assert_eq!(shading_normal(Some(&smooth(normals)), 0, third, DVec3::Y), DVec3::Y);
        }
        let opposite = smooth([Vec3::X, Vec3::NEG_X, Vec3::Z]);
        assert_eq!(shading_normal(Some(&opposite), 0, [0.5, 0.5, 0.0], DVec3::Y), DVec3::Y);
        assert_eq!(shading_normal(None, 7, third, DVec3::Y), DVec3::Y);
    }
}
