//! Points in integers, those on curved surfaces included.

use super::integer::{
    Homogeneous, IntegerLight, IntegerVector, Scale, cross, dot, minus, scale_of_light, sign,
};
use super::integer_shape::{IntegerShape, Surface, scale_of_shape};
use super::surd::{Field, Surd};
use crate::geometry::curved::{Crossing, Shape};
use crate::geometry::{ExactPosition, LightPosition};
use dashu_int::IBig;
use glam::Vec3;

/// An exact point relative to the origin of a light: (rational + irrational sqrt(D)) / w with w > 0, in units
/// of a scale.
#[derive(Debug, Clone)]
pub struct RelativePoint {
    /// Numerators but for their irrational part.
    pub rational: IntegerVector,
    /// What is multiplied by the root.
    pub irrational: IntegerVector,
    /// Denominator.
    pub w: IBig,
    /// Knows D.
    pub field: Field,
}

/// The scale of everything that a position is made of, and of a light.
pub fn scale_of(position: &ExactPosition, light: LightPosition) -> Scale {
    let own = match *position {
        ExactPosition::OnCurved { origin, ref shape, .. } => Scale::of([origin]).finer(scale_of_shape(shape)),
        ExactPosition::Bare(p) => Scale::of([p]),
        ExactPosition::OnRay { origin, direction, triangle } => {
            Scale::of([origin, direction].into_iter().chain(triangle))
        }
    };
    own.finer(scale_of_light(light))
}

impl RelativePoint {
    /// The position minus the origin.
    ///
    /// # Panics
    /// If it is said to be where a line meets a curved surface that it does not meet.
    pub fn new(position: &ExactPosition, light: &IntegerLight, scale: Scale) -> RelativePoint {
        let from = light.origin();
        match *position {
            ExactPosition::OnCurved { origin, direction, ref shape, crossing } => {
                let start = minus(&scale.point(origin), &from);
                on_curved(start, direction, &IntegerShape::new(shape, light, scale), crossing)
            }
            ExactPosition::Bare(p) => RelativePoint::rational(minus(&scale.point(p), &from), IBig::ONE),
            ExactPosition::OnRay { origin, direction, triangle } => {
                let [a, b, c] = triangle.map(|p| scale.point(p));
                let (o, d) = (scale.point(origin), scale.point(direction));
                let normal = cross(&minus(&b, &a), &minus(&c, &a));
                let (t, w) = (dot(&normal, &minus(&a, &o)), dot(&normal, &d));
                let start = minus(&o, &from);
                RelativePoint::along(&start, &d, t, w)
            }
        }
    }

    fn rational(xyz: IntegerVector, w: IBig) -> RelativePoint {
        let irrational = [IBig::ZERO, IBig::ZERO, IBig::ZERO];
        RelativePoint { rational: xyz, irrational, w, field: Field::rational() }
    }

    /// The point at t / w of a line.
    fn along(start: &IntegerVector, direction: &IntegerVector, t: IBig, w: IBig) -> RelativePoint {
        let (t, w) = if sign(&w) < 0 { (-t, -w) } else { (t, w) };
        RelativePoint::rational([0, 1, 2].map(|i| &start[i] * &w + &t * &direction[i]), w)
    }

    /// Scalar product of the numerators with a vector.
    pub fn dot(&self, vector: &IntegerVector) -> Surd {
        let rational = dot(vector, &self.rational);
        // The plain test spends its time here, and most points are rational.
        let is_rational = *self.field.square() == IBig::ZERO;
        let irrational = if is_rational { IBig::ZERO } else { dot(vector, &self.irrational) };
        Surd { rational, irrational }
    }

    /// The rational part in homogeneous coordinates, and the irrational one.
    pub fn homogeneous(&self) -> (Homogeneous, Homogeneous) {
        let [x, y, z] = self.rational.clone();
        let [u, v, w] = self.irrational.clone();
        ([x, y, z, self.w.clone()], [u, v, w, IBig::ZERO])
    }
}

/// Where the line from a start, relative to the origin of the light, meets a surface.
fn on_curved(
    start: IntegerVector,
    direction: Vec3,
    shape: &IntegerShape,
    crossing: Crossing,
) -> RelativePoint {
    // Signs alone count, so a direction has a scale of its own.
    let direction = Scale::of([direction]).point(direction);
    let o = homogeneous(&start, IBig::ONE);
    let d = homogeneous(&direction, IBig::ZERO);
    let form = match &shape.surface {
        Surface::Plane(_) => {
            let [value, slope] = [&o, &d].map(|x| shape.plane_value(x));
            assert!(sign(&slope) != 0, "a ray along a plane does not meet it");
            return RelativePoint::along(&start, &direction, -value, slope);
        }
        Surface::Quadric(form) => form,
    };
    let [o, d] = [&o, &d].map(|x| shape.local(x));
    let (a, b, c) = (form.polar(&d, &d), form.polar(&o, &d), form.polar(&o, &o));
    if sign(&a) == 0 {
        assert!(sign(&b) != 0, "a ray along a surface does not meet it");
        return RelativePoint::along(&start, &direction, -c, b * IBig::from(2));
    }
    // t = (-b -+ sqrt(b^2 - a c)) / a, which falls through zero with the upper sign whatever that of a is.
    let square = &b * &b - &a * &c;
    assert!(sign(&square) >= 0, "a ray that passes a surface does not meet it");
    let root = match crossing {
        Crossing::Entering => -IBig::ONE,
        Crossing::Leaving => IBig::ONE,
    };
    let (a, b, root) = if sign(&a) < 0 { (-a, -b, -root) } else { (a, b, root) };
    RelativePoint {
        rational: [0, 1, 2].map(|i| &start[i] * &a - &b * &direction[i]),
        irrational: direction.map(|x| x * &root),
        w: a,
        field: Field::new(square),
    }
}

fn homogeneous([x, y, z]: &IntegerVector, w: IBig) -> Homogeneous {
    [x.clone(), y.clone(), z.clone(), w]
}

/// The scale of a position on a line and of what it is a point of, for a shape alone.
pub fn scale_with(position: &ExactPosition, light: LightPosition, shape: &Shape) -> Scale {
    scale_of(position, light).finer(scale_of_shape(shape))
}
