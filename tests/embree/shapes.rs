//! Random curved surfaces, and where segments cross them, found by looking for changes of sign.

use super::meshes::Numbers;
use glam::{DMat3, DVec3, Vec3};
use lightbuffer::geometry::curved::{Cone, Disc, Ellipsoid, InfinitePlane, Quadric, Shape};

/// What is nearer than this to a border is in doubt.
const CLEAR: f64 = 1e-3;

/// About 0 on the unbounded surface and of the size of a distance near it.
fn side(shape: &Shape, p: DVec3) -> f64 {
    match shape {
        Shape::Sphere(s) => (p - s.centre.as_dvec3()).length() - f64::from(s.radius),
        Shape::Ellipsoid(e) => {
            let [a, b, c] = e.axes.map(|axis| axis.as_dvec3());
            let unit = DMat3::from_cols(a, b, c).inverse() * (p - e.centre.as_dvec3());
            (unit.length() - 1.0) * a.length().min(b.length()).min(c.length())
        }
        Shape::Cone(c) => {
            let w = p - c.base.as_dvec3();
            let along = height(c, p);
            let radius = f64::from(c.base_radius) * (1.0 - along) + f64::from(c.apex_radius) * along;
            let off = w - along * (c.apex.as_dvec3() - c.base.as_dvec3());
            off.length() - radius
        }
        Shape::Disc(d) => (p - d.centre.as_dvec3()).dot(d.normal.as_dvec3().normalize()),
        Shape::Plane(d) => (p - d.point.as_dvec3()).dot(d.normal.as_dvec3().normalize()),
        Shape::Quadric(q) => {
            let w = p - q.reference.as_dvec3();
            let [xx, yy, zz, xy, yz, zx] = q.second.map(f64::from);
            let square = xx * w.x * w.x + yy * w.y * w.y + zz * w.z * w.z;
            let mixed = xy * w.x * w.y + yz * w.y * w.z + zx * w.z * w.x;
            square + mixed + w.dot(q.first.as_dvec3()) + f64::from(q.constant)
        }
    }
}

/// 0 at the base, 1 at the apex.
fn height(c: &Cone, p: DVec3) -> f64 {
    let axis = c.apex.as_dvec3() - c.base.as_dvec3();
    (p - c.base.as_dvec3()).dot(axis) / axis.length_squared()
}

/// How far inside its bounds a point of the unbounded surface is.
fn margin(shape: &Shape, p: DVec3) -> f64 {
    match shape {
        Shape::Cone(c) => height(c, p).min(1.0 - height(c, p)),
        Shape::Disc(d) => f64::from(d.radius) - (p - d.centre.as_dvec3()).length(),
        Shape::Quadric(q) => (p - q.low.as_dvec3()).min(q.high.as_dvec3() - p).min_element(),
        _ => 1.0,
    }
}

/// At how many points a segment crosses a shape; `None` if that is in doubt.
pub fn crossings(shape: &Shape, from: [f32; 3], to: [f32; 3]) -> Option<usize> {
    let [from, to] = [from, to].map(|p| Vec3::from_array(p).as_dvec3());
    let at = |t: f64| from + t * (to - from);
    let value = |t: f64| side(shape, at(t));
    let steps = 600;
    let time = |i: usize| i as f64 / steps as f64;
    let values: Vec<f64> = (0..=steps).map(|i| value(time(i))).collect();
    if values[0].abs() < CLEAR || values[steps].abs() < CLEAR {
        return None;
    }
    // Nearly touching: the least distance from the surface is small and there are no two crossings to show for it.
    let turns =
        |w: &[f64]| (w[1].abs() <= w[0].abs() && w[1].abs() <= w[2].abs()) && w[1].abs() < 2.0 * CLEAR;
    let is_touched = values.windows(3).any(|w| turns(w) && w[0] * w[2] > 0.0);
    if is_touched {
        return None;
    }
    let mut times = 0;
    for i in (0..steps).filter(|&i| values[i] * values[i + 1] <= 0.0) {
        let (mut low, mut high) = (time(i), time(i + 1));
        for _ in 0..40 {
            let middle = (low + high) / 2.0;
            if value(middle) * values[i] > 0.0 { low = middle } else { high = middle }
        }
        let inside = margin(shape, at(low));
        if inside.abs() < CLEAR {
            return None;
        }
        times += usize::from(inside > 0.0);
    }
    Some(times)
}

/// Shapes of all kinds, one after another, in the unit cube.
pub fn random(count: usize) -> Vec<Shape> {
    let mut numbers = Numbers(11);
    (0..count)
        .map(|i| {
            let centre = Vec3::from_array(numbers.point());
            let offset = Vec3::from_array(numbers.point()) - 0.5;
            let size = 0.05 + 0.1 * numbers.next();
            match i % 6 {
                0 => Shape::sphere(centre, size),
                1 => {
                    let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| size * (axis + 0.5 * offset));
                    Shape::Ellipsoid(Ellipsoid { centre, axes })
                }
                2 => Shape::cone(centre, size, centre + 0.4 * offset, 0.3 * size),
                3 => Shape::Disc(Disc { centre, normal: offset, radius: 1.5 * size }),
                // Outside of most of the cube: a plane through the middle would block half of all rays.
                4 => Shape::Plane(InfinitePlane {
                    point: 1.1 * (centre + Vec3::ONE),
                    normal: Vec3::ONE + offset,
                }),
                _ => Shape::Quadric(Quadric {
                    reference: centre,
                    second: [1.0, -1.5, 0.5, 0.25, -0.5, 0.75],
                    first: 0.1 * offset,
                    constant: 0.01 * (size - 0.1),
                    low: centre - 1.5 * size,
                    high: centre + size,
                }),
            }
        })
        .collect()
}

/// Ends of segments through the unit cube.
pub fn rays(count: usize) -> Vec<([f32; 3], [f32; 3])> {
    let mut numbers = Numbers(13);
    (0..count).map(|_| (numbers.point(), numbers.point())).collect()
}

/// Unit vectors in all directions.
pub fn directions(count: usize) -> Vec<Vec3> {
    let mut numbers = Numbers(17);
    let mut next = || Vec3::from_array(numbers.point()) - 0.5;
    (0..count).map(|_| next().normalize()).collect()
}
