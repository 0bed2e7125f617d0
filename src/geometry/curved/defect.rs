//! What keeps numbers from being a surface.

use super::shape::Shape;
use crate::geometry::Sign;
use crate::geometry::expansion::{self, Expansion};
use glam::Vec3;

/// Why there is no surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Defect {
    /// A number is NaN or infinite.
    NonFinite,
    /// It has no area, or a number is outside its range.
    Degenerate,
}

/// The first defect of a shape, if it has one.
pub(super) fn of(shape: &Shape) -> Option<Defect> {
    if !shape.numbers().iter().all(|number| number.is_finite()) {
        return Some(Defect::NonFinite);
    }
    let sound = match shape {
        Shape::Sphere(s) => s.radius > 0.0,
        Shape::Ellipsoid(e) => {
            let [a, b, c] = e.axes.map(|axis| axis.to_array().map(Expansion::from));
            expansion::dot(&expansion::cross(&a, &b), &c).sign() != Sign::Zero
        }
        Shape::Cone(c) => {
            let radii = [c.base_radius, c.apex_radius];
            c.base != c.apex && radii.iter().all(|&r| r >= 0.0) && radii != [0.0; 2]
        }
        Shape::Disc(d) => d.radius > 0.0 && d.normal != Vec3::ZERO,
        Shape::Plane(p) => p.normal != Vec3::ZERO,
        Shape::Quadric(q) => {
            let is_constant = q.second == [0.0; 6] && q.first == Vec3::ZERO;
            !is_constant && q.low.cmplt(q.high).all()
        }
    };
    (!sound).then_some(Defect::Degenerate)
}
