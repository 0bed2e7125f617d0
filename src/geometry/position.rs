//! Where a point is, exactly, and the f64 point nearest to it.

use super::bounded_double::BoundedDouble;
use super::curved::root;
use super::curved::{Crossing, Shape};
use super::double_double::DoubleDouble;
use super::exact_number::{self, ExactNumber, ExactVector};
use super::expansion::{self, Expansion};
use super::surd::Surd;
use glam::{DVec3, Vec3};

/// An exact position in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExactPosition {
    /// Where the line of a ray meets the plane of a triangle that it is not parallel to.
    OnRay {
        /// Start of the ray.
        origin: Vec3,
        /// Direction of the ray, not normalised.
        direction: Vec3,
        /// The triangle.
        triangle: [Vec3; 3],
    },
    /// Where the line of a ray passes through a curved surface.
    OnCurved {
        /// Start of the ray.
        origin: Vec3,
        /// Direction of the ray, not normalised.
        direction: Vec3,
        /// The surface.
        shape: Shape,
        /// Which of the points where the line meets it.
        crossing: Crossing,
    },
    /// These coordinates.
    Bare(Vec3),
}

/// A point in homogeneous coordinates with w > 0, relative to some origin. Of degree 4, 4, 4, 3 in the inputs on
/// a triangle, and with a square root on a curved surface.
#[derive(Debug, Clone)]
pub struct HomogeneousPoint {
    /// Coordinates times `w`.
    pub xyz: ExactVector,
    /// The positive denominator.
    pub w: ExactNumber,
}

impl ExactPosition {
    /// The exact position relative to `origin`, with a positive denominator.
    pub fn relative_to(&self, origin: Vec3) -> HomogeneousPoint {
        match *self {
            ExactPosition::Bare(p) => {
                let xyz = exact_number::vector(expansion::difference(p, origin));
                HomogeneousPoint { xyz, w: ExactNumber::from(1.0) }
            }
            ExactPosition::OnCurved { origin: o, direction, shape, crossing } => {
                let t = root::exact_parameter(o, direction, &shape, crossing);
                let w = ExactNumber::Surd(Surd::rational(t.denominator));
                let t = ExactNumber::Surd(t.numerator);
                let start = exact_number::vector(expansion::difference(o, origin));
                let d = direction.to_array().map(ExactNumber::from);
                let xyz = [0, 1, 2].map(|i| &(&start[i] * &w) + &(&d[i] * &t));
                HomogeneousPoint { xyz, w }
            }
            ExactPosition::OnRay { origin: o, direction, triangle: [a, b, c] } => {
                let normal = expansion::cross(&expansion::difference(b, a), &expansion::difference(c, a));
                let d = direction.to_array().map(Expansion::from);
                let mut w = expansion::dot(&normal, &d);
                let mut t = expansion::dot(&normal, &expansion::difference(a, o));
                if w.sign() == super::Sign::Negative {
                    (w, t) = (-&w, -&t);
                }
                let start = expansion::difference(o, origin);
                let xyz = [0, 1, 2].map(|i| &(&start[i] * &w) + &(&d[i] * &t));
                HomogeneousPoint { xyz: exact_number::vector(xyz), w: w.into() }
            }
        }
    }

    /// The position with each coordinate correctly rounded to f64.
    pub fn rounded(&self) -> DVec3 {
        match *self {
            ExactPosition::Bare(p) => p.as_dvec3(),
            ExactPosition::OnRay { origin, direction, triangle } => {
                round_in_double_double(origin, direction, triangle).unwrap_or_else(|| {
                    let exact = self.relative_to(Vec3::ZERO);
                    DVec3::from_array(exact.xyz.map(|x| x.divide_rounded(&exact.w)))
                })
            }
            ExactPosition::OnCurved { origin, direction, shape, crossing } => {
                root::rounded(origin, direction, &shape, crossing).unwrap_or_else(|| {
                    let exact = self.relative_to(Vec3::ZERO);
                    DVec3::from_array(exact.xyz.map(|x| x.divide_rounded(&exact.w)))
                })
            }
        }
    }
}

/// The hit point in double-double arithmetic, if its error bound allows no other rounding.
fn round_in_double_double(origin: Vec3, direction: Vec3, triangle: [Vec3; 3]) -> Option<DVec3> {
    let [x, y, z] = in_double_double(origin, direction, triangle)?;
    Some(DVec3::new(x.rounded()?, y.rounded()?, z.rounded()?))
}

/// The coordinates of the hit point; `None` if the ray may be parallel to the triangle's plane.
///
/// With u the roundoff of one double-double operation: the components of the normal carry at most 3u of the
/// sum of their absolute terms (differences of f32 are exact), scalar products 3u more; each bound below
/// takes 16u of the sum of absolute terms, more than twice what the count asks for.
fn in_double_double(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<[BoundedDouble; 3]> {
    const BOUND: f64 = 16.0 * DoubleDouble::ROUNDOFF;
    let vector = |p: Vec3, q: Vec3| [0, 1, 2].map(|i| DoubleDouble::difference(p[i], q[i]));
    let (e, f, g) = (vector(b, a), vector(c, a), vector(a, origin));
    let minor = |i: usize, j: usize| e[i].multiply(f[j]).add(e[j].multiply(f[i]).negate());
    let minor_size = |i: usize, j: usize| (e[i].high * f[j].high).abs() + (e[j].high * f[i].high).abs();
    let normal = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let size = [minor_size(1, 2), minor_size(2, 0), minor_size(0, 1)];
    let d = direction.to_array().map(|x| DoubleDouble { high: f64::from(x), low: 0.0 });
    let dot = |v: &[DoubleDouble; 3]| {
        let sum = normal[0].multiply(v[0]).add(normal[1].multiply(v[1])).add(normal[2].multiply(v[2]));
        let bound = size[0] * v[0].high.abs() + size[1] * v[1].high.abs() + size[2] * v[2].high.abs();
        (sum, BOUND * bound)
    };
    let (numerator, numerator_error) = dot(&g);
    let (denominator, denominator_error) = dot(&d);
    let t = numerator.divide(denominator);
    if denominator.high.abs() <= 4.0 * denominator_error || t.high.abs() >= 1e200 {
        return None;
    }
    let t_error = 1.5 * (numerator_error + t.high.abs() * denominator_error) / denominator.high.abs()
        + BOUND * t.high.abs();
    let coordinate = |i: usize| {
        let start = f64::from(origin[i]);
        let step = t.multiply(d[i]);
        let sum = step.add(DoubleDouble { high: start, low: 0.0 });
        let error = d[i].high.abs() * t_error + BOUND * (start.abs() + step.high.abs());
        BoundedDouble::from_parts(sum, error)
    };
    Some([0, 1, 2].map(coordinate))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn coordinate() -> impl Strategy<Value = f32> {
        prop_oneof![
            -1.0f32..1.0,
            (-8i32..8).prop_map(|x| x as f32),
            (-1.0f32..1.0).prop_map(|x| 148_376.0 + x),
            (-1.0f32..1.0).prop_map(|x| x * 1e-30),
        ]
    }

    fn point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(coordinate()).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn the_fast_way_rounds_as_the_exact_one(o in point(), d in point(), a in point(), b in point(), c in point()) {
            let position = ExactPosition::OnRay { origin: o, direction: d, triangle: [a, b, c] };
            let exact = position.relative_to(Vec3::ZERO);
            prop_assume!(exact.w.sign() == crate::geometry::Sign::Positive);
            let expected = exact.xyz.map(|x| x.divide_rounded(&exact.w));
            prop_assert_eq!(position.rounded().to_array(), expected);
        }
    }

    #[test]
    fn ordinary_hits_need_no_exact_arithmetic() {
        let triangle = [Vec3::new(-1.0, 0.1, -3.0), Vec3::new(1.3, -0.2, -3.5), Vec3::new(0.1, 1.7, -2.9)];
        let hit = round_in_double_double(Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.01, 0.05, -1.0), triangle);
        assert!(hit.is_some());
    }

    #[test]
    fn hits_of_every_size_need_no_exact_arithmetic() {
        let triangle = [Vec3::new(-1.0, 0.1, -3.0), Vec3::new(1.3, -0.2, -3.5), Vec3::new(0.1, 1.7, -2.9)];
        let (origin, direction) = (Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.01, 0.05, -1.0));
        for [places, directions] in [[-40, 0], [40, 0], [0, -40], [0, 40], [30, -30], [-30, 30]] {
            let (scale, length) = (2.0_f32.powi(places), 2.0_f32.powi(directions));
            let hit = round_in_double_double(origin * scale, direction * length, triangle.map(|p| p * scale));
            assert!(hit.is_some(), "2^{places} and 2^{directions}");
        }
    }

    #[test]
    fn coordinates_are_as_uncertain_as_is_derived() {
        // Along z, with n = (0, 0, 4) and t = 2. In units of the bound: the height 8 within 8, the slope 4 within 4, so
        // that t is within 1.5 (8 + 2 * 4) / 4 + 2 = 8, and z = 16 + 2 within 8 + 16 + 2.
        let corners = [[-1.0, -1.0, 18.0], [1.0, -1.0, 18.0], [0.0, 1.0, 18.0]];
        for axis in 0..3 {
            let turned = |mut p: [f32; 3]| {
                p.rotate_left(axis);
                Vec3::from(p)
            };
            let origin = turned([5.0, 0.0, 16.0]);
            let found =
                in_double_double(origin, turned([0.0, 0.0, 1.0]), corners.map(turned)).expect("it is hit");
            let (x, z) = (found[(3 - axis) % 3], found[2 - axis]);
            assert_eq!((x.rounded(), z.rounded()), (Some(5.0), Some(18.0)));
            let bound = 16.0 * DoubleDouble::ROUNDOFF;
            assert!((x.parts().1 / (5.0 * bound) - 1.0).abs() < 1e-9, "{}", x.parts().1 / bound);
            assert!((z.parts().1 / (26.0 * bound) - 1.0).abs() < 1e-9, "{}", z.parts().1 / bound);
        }
    }

    #[test]
    fn rays_along_the_plane_are_left_to_exact_arithmetic() {
        let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
        assert!(round_in_double_double(Vec3::Z, Vec3::X, triangle).is_none());
    }
}
