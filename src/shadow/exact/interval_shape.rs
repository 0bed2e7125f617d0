//! Curved surfaces in intervals: the first stage, which decides most queries.

use super::interval::{Box3, Decided, Interval, along, cross, dot, minus, point};
use crate::geometry::curved::{Crossing, Shape};
use glam::Vec3;

/// A curved surface relative to some origin.
#[derive(Debug, Clone)]
pub struct IntervalShape {
    /// What its own coordinates are relative to.
    reference: Box3,
    kind: Kind,
}

#[derive(Debug, Clone)]
enum Kind {
    Sphere { radius: Interval },
    Ellipsoid { adjugate: [Box3; 3], determinant: Interval },
    Cone { axis: Box3, length: Interval, base: Interval, growth: Interval },
    Flat { normal: Box3, radius: Option<Interval> },
    Quadric { rows: [Box3; 3], half_first: Box3, constant: Interval, low: Box3, high: Box3 },
}

/// Which part of a line counts, in multiples of its direction; its ends do not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// From 0 to 1.
    Segment,
    /// From 0 on.
    HalfLine,
}

/// What the start of a line has to do with a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// It may be anywhere.
    Anywhere,
    /// It lies exactly on the surface.
    On,
}

/// c + 2 b s + a s^2 along a line, and b^2 - a c as precisely as the kind of surface allows.
struct Along {
    c: Interval,
    b: Interval,
    a: Interval,
    discriminant: Interval,
}

/// Whether a root is where it counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    In,
    Out,
    Unknown,
}

/// What must not be negative along a line: start + slope s.
type Side = (Interval, Interval);

/// A line in a surface's own coordinates.
struct Line {
    start: Box3,
    direction: Box3,
    reach: Reach,
}

const ONE: Interval = Interval { low: 1.0, high: 1.0 };
const TWO: Interval = Interval { low: 2.0, high: 2.0 };

impl IntervalShape {
    /// A shape relative to an origin.
    pub fn new(shape: &Shape, origin: &Box3) -> IntervalShape {
        let number = Interval::exactly;
        let difference = |a: Vec3, b: Vec3| minus(&point(a), &point(b));
        let (reference, kind) = match shape {
            Shape::Sphere(s) => (s.centre, Kind::Sphere { radius: number(s.radius) }),
            Shape::Ellipsoid(e) => {
                let [a, b, c] = e.axes.map(point);
                let adjugate = [cross(&b, &c), cross(&c, &a), cross(&a, &b)];
                let determinant = dot(&a, &adjugate[0]);
                (e.centre, Kind::Ellipsoid { adjugate, determinant })
            }
            Shape::Cone(c) => {
                let axis = difference(c.apex, c.base);
                let base = number(c.base_radius);
                let growth =
                    if c.apex_radius == c.base_radius { number(0.0) } else { number(c.apex_radius) - base };
                (c.base, Kind::Cone { axis, length: dot(&axis, &axis), base, growth })
            }
            Shape::Disc(d) => {
                (d.centre, Kind::Flat { normal: point(d.normal), radius: Some(number(d.radius)) })
            }
            Shape::Plane(p) => (p.point, Kind::Flat { normal: point(p.normal), radius: None }),
            Shape::Quadric(q) => {
                let [xx, yy, zz] = [0, 1, 2].map(|i| number(q.second[i]));
                let [xy, yz, zx] = [3, 4, 5].map(|i| number(q.second[i]).divided_by(TWO));
                let kind = Kind::Quadric {
                    rows: [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]],
                    half_first: point(q.first).map(|x| x.divided_by(TWO)),
                    constant: number(q.constant),
                    low: difference(q.low, q.reference),
                    high: difference(q.high, q.reference),
                };
                (q.reference, kind)
            }
        };
        IntervalShape { reference: minus(&point(reference), origin), kind }
    }

    /// Where a line from a start, relative to the origin, passes through the surface: multiples of its
    /// direction.
    pub fn root(&self, start: &Box3, direction: &Box3, crossing: Crossing) -> Interval {
        let start = minus(start, &self.reference);
        let along = self.along(&start, direction);
        if matches!(self.kind, Kind::Flat { .. }) {
            return along.single();
        }
        let [entering, leaving] = along.roots();
        match crossing {
            Crossing::Entering => entering,
            Crossing::Leaving => leaving,
        }
    }

    /// How often the part of a line that begins at some point relative to the origin passes through the
    /// surface, off its rims; `None` if intervals cannot tell. Where `enough` crossings are certain, that is
    /// the answer.
    pub fn crossings(
        &self,
        start: &Box3,
        direction: &Box3,
        reach: Reach,
        from: Start,
        enough: usize,
    ) -> Option<usize> {
        let start = minus(start, &self.reference);
        let line = Line { start, direction: *direction, reach };
        let along = self.along(&line.start, direction);
        let places = match (&self.kind, from) {
            // Its only root is the start.
            (Kind::Flat { .. }, Start::On) => return Some(0),
            (_, Start::On) => vec![self.place(along.other_than_start(), &line)],
            _ if self.is_passed(&along, &line) => return Some(0),
            (Kind::Flat { .. }, _) => vec![self.place(along.single(), &line)],
            _ => {
                let places = along.roots().map(|root| self.place(root, &line)).to_vec();
                match along.discriminant.decided() {
                    Decided::Below => return Some(0),
                    Decided::Above => {}
                    // Perhaps there are none, and if there are they may be one.
                    Decided::Open if places == [Place::Out; 2] => return Some(0),
                    Decided::Open => return None,
                }
                places
            }
        };
        let certain = places.iter().filter(|place| **place == Place::In).count();
        (certain >= enough || !places.contains(&Place::Unknown)).then_some(certain)
    }

    /// The polynomial along a line in own coordinates.
    fn along(&self, w: &Box3, d: &Box3) -> Along {
        match &self.kind {
            Kind::Sphere { radius } => round(w, d, *radius),
            Kind::Ellipsoid { adjugate, determinant } => {
                let image = |v: &Box3| [0, 1, 2].map(|i| dot(&adjugate[i], v));
                round(&image(w), &image(d), *determinant)
            }
            Kind::Cone { axis, length, base, growth } => {
                let (across_w, across_d) = (cross(w, axis), cross(d, axis));
                let radius = *base * *length + *growth * dot(w, axis);
                let widening = *growth * dot(d, axis);
                Along::new(
                    *length * square(&across_w) - radius.squared(),
                    *length * dot(&across_w, &across_d) - radius * widening,
                    *length * square(&across_d) - widening.squared(),
                )
            }
            Kind::Flat { normal, .. } => {
                let zero = Interval::exactly(0.0);
                // 2 b is the slope.
                Along::new(dot(normal, w), dot(normal, d).divided_by(TWO), zero)
            }
            Kind::Quadric { rows, half_first, constant, .. } => {
                let image = |v: &Box3| [0, 1, 2].map(|i| dot(&rows[i], v));
                let (image_w, image_d) = (image(w), image(d));
                Along::new(
                    dot(w, &image_w) + TWO * dot(half_first, w) + *constant,
                    dot(w, &image_d) + dot(half_first, d),
                    dot(d, &image_d),
                )
            }
        }
    }

    /// The planes that bound it, along a line.
    fn sides(&self, line: &Line) -> impl Iterator<Item = Side> {
        let (w, d) = (&line.start, &line.direction);
        let mut sides = [None; 6];
        match &self.kind {
            Kind::Cone { axis, length, .. } => {
                let (start, slope) = (dot(w, axis), dot(d, axis));
                sides[0] = Some((start, slope));
                sides[1] = Some((*length - start, -slope));
            }
            Kind::Quadric { low, high, .. } => {
                for i in 0..3 {
                    sides[2 * i] = Some((w[i] - low[i], d[i]));
                    sides[2 * i + 1] = Some((high[i] - w[i], -d[i]));
                }
            }
            _ => {}
        }
        sides.into_iter().flatten()
    }

    /// Whether the polynomial certainly has no root between the ends of the line and the bounds.
    fn is_passed(&self, along: &Along, line: &Line) -> bool {
        let mut span = match line.reach {
            Reach::Segment => Interval { low: 0.0, high: 1.0 },
            Reach::HalfLine => Interval { low: 0.0, high: f64::INFINITY },
        };
        for (start, slope) in self.sides(line) {
            if slope.is_zero() && start.decided() == Decided::Below {
                return true;
            }
            let end = (-start).divided_by(slope);
            match slope.decided() {
                Decided::Above => span.low = span.low.max(end.low),
                Decided::Below => span.high = span.high.min(end.high),
                Decided::Open => {}
            }
        }
        span.is_empty() || along.value(span).decided() != Decided::Open
    }

    /// Whether a root lies on the line, within the bounds and off the rims.
    fn place(&self, root: Interval, line: &Line) -> Place {
        let mut place = Place::In;
        let mut demand = |value: Interval| match value.decided() {
            Decided::Above => {}
            Decided::Below => place = Place::Out,
            Decided::Open if place == Place::In => place = Place::Unknown,
            Decided::Open => {}
        };
        demand(root);
        if line.reach == Reach::Segment {
            demand(ONE - root);
        }
        for (start, slope) in self.sides(line) {
            demand(start + slope * root);
        }
        if let Kind::Flat { radius: Some(radius), .. } = &self.kind {
            demand(radius.squared() - square(&along(&line.start, &line.direction, root)));
        }
        place
    }
}

impl Along {
    fn new(c: Interval, b: Interval, a: Interval) -> Along {
        Along { c, b, a, discriminant: b.squared() - a * c }
    }

    fn value(&self, s: Interval) -> Interval {
        self.c + s * (TWO * self.b + s * self.a)
    }

    /// Where it falls through zero and where it rises, if it does.
    fn roots(&self) -> [Interval; 2] {
        let root = self.discriminant.root();
        let (less, more) = (-self.b - root, root - self.b);
        // The product of both is c / a.
        let entering = less.divided_by(self.a).and(self.c.divided_by(more));
        let leaving = more.divided_by(self.a).and(self.c.divided_by(less));
        [entering, leaving]
    }

    /// The root of a polynomial of degree 1.
    fn single(&self) -> Interval {
        -self.c.divided_by(TWO * self.b)
    }

    /// The second root of a polynomial that has one at 0.
    fn other_than_start(&self) -> Interval {
        -(TWO * self.b).divided_by(self.a)
    }
}

/// |x|^2 - radius^2 along a line.
fn round(w: &Box3, d: &Box3, radius: Interval) -> Along {
    let a = square(d);
    // By Lagrange's identity: far from a small sphere the difference of squares would lose every digit.
    let discriminant = a * radius.squared() - square(&cross(w, d));
    Along { c: square(w) - radius.squared(), b: dot(w, d), a, discriminant }
}

fn square(v: &Box3) -> Interval {
    v[0].squared() + v[1].squared() + v[2].squared()
}
