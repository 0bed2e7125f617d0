//! The arbiter's own boxes around primitives, never too small.

use super::interval::{Box3, Interval, dot, minus, point};
use crate::geometry::curved::Shape;
use glam::Vec3;

/// Lowest and highest corner of a box.
pub type Bounds = (Vec3, Vec3);

/// The smallest box around a triangle.
pub fn of_triangle([a, b, c]: [Vec3; 3]) -> Bounds {
    (a.min(b).min(c), a.max(b).max(c))
}

/// A box around a curved surface; `None` for one without end.
pub fn of_shape(shape: &Shape) -> Option<Bounds> {
    let number = Interval::exactly;
    Some(match shape {
        Shape::Sphere(s) => around(s.centre, [number(s.radius); 3]),
        Shape::Ellipsoid(e) => {
            let [a, b, c] = e.axes.map(point);
            let squares = |i: usize| a[i].squared() + b[i].squared() + c[i].squared();
            around(e.centre, [0, 1, 2].map(|i| squares(i).root()))
        }
        Shape::Cone(c) => {
            let axis = minus(&point(c.apex), &point(c.base));
            let base = around(c.base, reach_of_circle(&axis, c.base_radius));
            let apex = around(c.apex, reach_of_circle(&axis, c.apex_radius));
            (base.0.min(apex.0), base.1.max(apex.1))
        }
        Shape::Disc(d) => around(d.centre, reach_of_circle(&point(d.normal), d.radius)),
        Shape::Plane(_) => return None,
        Shape::Quadric(q) => (q.low, q.high),
    })
}

/// How far a circle across an axis reaches along each coordinate: its radius times the sine of the angle
/// between the two.
fn reach_of_circle(axis: &Box3, radius: f32) -> Box3 {
    let length = dot(axis, axis);
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
        let sine = (axis[i].squared() + axis[j].squared()).divided_by(length).root();
        // It is at most 1, which intervals know nothing of where the axis is short.
        sine.and(Interval { low: 0.0, high: 1.0 }) * Interval::exactly(radius)
    })
}

fn around(centre: Vec3, reach: Box3) -> Bounds {
    let centre = point(centre);
    let low = [0, 1, 2].map(|i| ((centre[i] - reach[i]).low as f32).next_down());
    let high = [0, 1, 2].map(|i| ((centre[i] + reach[i]).high as f32).next_up());
    (Vec3::from(low), Vec3::from(high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_hardly_larger_than_what_is_in_them() {
        let cylinder = Shape::cylinder(Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 2.0, 7.0), 0.5);
        let (low, high) = of_shape(&cylinder).unwrap();
        assert!(low.cmplt(Vec3::new(0.5, 1.5, 3.0)).all() && high.cmpgt(Vec3::new(1.5, 2.5, 7.0)).all());
        assert!(low.distance(Vec3::new(0.5, 1.5, 3.0)) < 1e-5);
        assert!(high.distance(Vec3::new(1.5, 2.5, 7.0)) < 1e-5);
    }

    #[test]
    fn axes_too_short_for_f64_give_the_whole_reach() {
        let disc = crate::geometry::curved::Shape::Disc(crate::geometry::curved::Disc {
            centre: Vec3::ZERO,
            normal: Vec3::Z * 1e-44,
            radius: 1.0,
        });
        let (low, high) = of_shape(&disc).unwrap();
        assert!(low.x <= -1.0 && high.y >= 1.0);
    }
}
