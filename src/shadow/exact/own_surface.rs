//! Does a primitive lie in the surface that a point is on?

use super::integer::{IntegerVector, Scale, cross, dot, minus, sign};
use crate::geometry::curved::Shape;
use crate::scene::{Primitive, PrimitiveIndex, Scene};
use dashu_int::IBig;
use glam::Vec3;

/// Whether two primitives are parts of one surface: of one plane, decided exactly, or of curved surfaces given
/// by the same numbers.
pub fn is_shared(scene: &Scene, one: PrimitiveIndex, other: PrimitiveIndex) -> bool {
    one == other
        || match (scene.primitive(one), scene.primitive(other)) {
            (Primitive::Curved(a), Primitive::Curved(b)) if a == b => true,
            (a, b) => flat(a).zip(flat(b)).is_some_and(|(a, b)| a.is_coplanar(&b)),
        }
}

/// A plane by one of its points and a normal, or by three of its points.
enum Flat {
    Normal(Vec3, Vec3),
    Points([Vec3; 3]),
}

fn flat(primitive: Primitive) -> Option<Flat> {
    match primitive {
        Primitive::Triangle(corners) => Some(Flat::Points(corners)),
        Primitive::Curved(Shape::Disc(disc)) => Some(Flat::Normal(disc.centre, disc.normal)),
        Primitive::Curved(Shape::Plane(plane)) => Some(Flat::Normal(plane.point, plane.normal)),
        Primitive::Curved(_) => None,
    }
}

impl Flat {
    fn scale(&self) -> Scale {
        match *self {
            Flat::Normal(point, _) => Scale::of([point]),
            Flat::Points(corners) => Scale::of(corners),
        }
    }

    /// A point and a normal; normals have a scale of their own.
    fn plane(&self, scale: Scale) -> (IntegerVector, IntegerVector) {
        match *self {
            Flat::Normal(point, normal) => (scale.point(point), Scale::of([normal]).point(normal)),
            Flat::Points(corners) => {
                let [a, b, c] = corners.map(|corner| scale.point(corner));
                let normal = cross(&minus(&b, &a), &minus(&c, &a));
                (a, normal)
            }
        }
    }

    fn is_coplanar(&self, other: &Flat) -> bool {
        let scale = self.scale().finer(other.scale());
        let ((p, n), (q, m)) = (self.plane(scale), other.plane(scale));
        cross(&n, &m).iter().all(|x| *x == IBig::ZERO) && sign(&dot(&n, &minus(&q, &p))) == 0
    }
}
