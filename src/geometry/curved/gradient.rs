//! The direction across a surface, in f64: for shading alone.

use super::shape::{Cone, Quadric, Shape};
use glam::{DVec3, Vec3};

impl Shape {
    /// The gradient of the surface's polynomial at a point, up to a positive factor: outwards, where there is an
    /// inside. Zero where the surface has no normal, as at the tip of a cone.
    pub fn gradient(&self, p: DVec3) -> DVec3 {
        match self {
            Shape::Sphere(sphere) => p - sphere.centre.as_dvec3(),
            Shape::Ellipsoid(ellipsoid) => {
                let w = p - ellipsoid.centre.as_dvec3();
                let [x, y, z] = ellipsoid.axes.map(Vec3::as_dvec3);
                [y.cross(z), z.cross(x), x.cross(y)].iter().map(|&row| row * row.dot(w)).sum()
            }
            Shape::Cone(cone) => of_cone(cone, p),
            Shape::Disc(disc) => disc.normal.as_dvec3(),
            Shape::Plane(plane) => plane.normal.as_dvec3(),
            Shape::Quadric(quadric) => of_quadric(quadric, p),
        }
    }
}

/// Of L |w x v|^2 - (r0 L + (r1 - r0) s)^2 with L = v . v and s = w . v, halved.
fn of_cone(cone: &Cone, p: DVec3) -> DVec3 {
    let (base, apex) = (cone.base.as_dvec3(), cone.apex.as_dvec3());
    let (w, v) = (p - base, apex - base);
    let (length, along) = (v.length_squared(), w.dot(v));
    let growth = f64::from(cone.apex_radius) - f64::from(cone.base_radius);
    let radius = f64::from(cone.base_radius) * length + growth * along;
    (w * length - v * along) * length - v * (growth * radius)
}

fn of_quadric(quadric: &Quadric, p: DVec3) -> DVec3 {
    let w = p - quadric.reference.as_dvec3();
    let [xx, yy, zz, xy, yz, zx] = quadric.second.map(f64::from);
    let second = DVec3::new(
        2.0 * xx * w.x + xy * w.y + zx * w.z,
        xy * w.x + 2.0 * yy * w.y + yz * w.z,
        zx * w.x + yz * w.y + 2.0 * zz * w.z,
    );
    second + quadric.first.as_dvec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::Ellipsoid;

    #[test]
    fn normals_look_outwards() {
        let across = |shape: Shape, p: [f64; 3]| shape.gradient(DVec3::from_array(p)).normalize();
        assert_eq!(across(Shape::sphere(Vec3::X, 2.0), [1.0, 2.0, 0.0]), DVec3::Y);
        let cylinder = Shape::cylinder(Vec3::ZERO, Vec3::Z * 3.0, 1.0);
        assert_eq!(across(cylinder, [0.0, 1.0, 2.0]), DVec3::Y);
        // 45 degrees: the normal leans towards the tip.
        let cone = Shape::cone(Vec3::ZERO, 1.0, Vec3::Z, 0.0);
        assert!((across(cone, [0.5, 0.0, 0.5]) - DVec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-12);
        let axes = [Vec3::X * 3.0, Vec3::Y, Vec3::Z];
        let ellipsoid = Shape::Ellipsoid(Ellipsoid { centre: Vec3::ZERO, axes });
        assert_eq!(across(ellipsoid, [3.0, 0.0, 0.0]), DVec3::X);
    }

    #[test]
    fn the_gradient_of_a_quadric_is_that_of_its_polynomial() {
        // 1.5 x^2 + 2 y^2 + 3 z^2 + 4 xy + 5 yz + 6 zx + 7 x + 8 y + 9 z, at (2, 3, 5) from the reference.
        let quadric = Quadric {
            reference: Vec3::new(1.0, -1.0, 2.0),
            second: [1.5, 2.0, 3.0, 4.0, 5.0, 6.0],
            first: Vec3::new(7.0, 8.0, 9.0),
            constant: 10.0,
            low: Vec3::splat(-9.0),
            high: Vec3::splat(9.0),
        };
        let found = Shape::Quadric(quadric).gradient(DVec3::new(3.0, 2.0, 7.0));
        let along_x = 2.0 * 1.5 * 2.0 + 4.0 * 3.0 + 6.0 * 5.0 + 7.0;
        let along_y = 4.0 * 2.0 + 2.0 * 2.0 * 3.0 + 5.0 * 5.0 + 8.0;
        let along_z = 6.0 * 2.0 + 5.0 * 3.0 + 2.0 * 3.0 * 5.0 + 9.0;
        assert_eq!(found, DVec3::new(along_x, along_y, along_z));
    }
}
