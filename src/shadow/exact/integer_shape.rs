//! Curved surfaces in integers, and how segments meet them.

use super::integer::{Homogeneous, IntegerLight, IntegerVector, Meeting, Scale, cross, decode, dot, minus};
use super::point::{RelativePoint, scale_with};
use super::roots::{Bound, Quadratic, Roots};
use super::surd::{Field, Surd};
use crate::geometry::curved::Shape;
use crate::geometry::{ExactPosition, LightPosition};
use dashu_int::IBig;
use glam::Vec3;

/// A curved surface relative to the origin of a light, in units of a scale.
#[derive(Debug, Clone)]
pub struct IntegerShape {
    /// What its own coordinates are relative to.
    reference: IntegerVector,
    /// The surface, in its own coordinates.
    pub surface: Surface,
    /// Planes on whose positive side it lies, in its own coordinates.
    sides: Vec<Homogeneous>,
    /// For a disc, what is not negative within its rim.
    rim: Option<Form>,
}

/// What a surface is a part of: where this is zero.
#[derive(Debug, Clone)]
pub enum Surface {
    /// Of degree 1.
    Plane(Homogeneous),
    /// Of degree 2.
    Quadric(Form),
}

/// A symmetric bilinear form of homogeneous coordinates: a multiple of the polynomial, where both are the same.
#[derive(Debug, Clone)]
pub struct Form {
    rows: Box<[Homogeneous; 4]>,
}

/// How a curved surface lies to the open segment between a light and a point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CurvedMeeting {
    /// How often the segment passes through it, rims included.
    pub crossings: usize,
    /// One of these is off the rims.
    pub passes_through: bool,
    /// The segment touches it without passing through, or meets a rim.
    pub touches: bool,
    /// The point lies on it.
    pub ends_on: bool,
}

/// The points that a surface and an open segment have in common.
#[derive(Debug, Clone)]
pub struct Common {
    /// Whether the point at which the segment begins lies on the surface, and how the segment goes on.
    pub start: Option<StartsOn>,
    /// All others, unless the segment runs along the surface.
    pub places: Vec<RootPlace>,
}

/// How a segment leaves a surface that it begins on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartsOn {
    /// It stays on what the surface is a part of.
    Along,
    /// It leaves it.
    Across,
}

/// A point that a surface and an open segment have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RootPlace {
    /// Whether the segment passes through there.
    pub kind: RootKind,
    /// Whether the surface ends there.
    pub is_on_rim: bool,
}

/// How often a point is a root.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RootKind {
    /// Once: the segment passes through.
    Simple,
    /// Twice: the segment touches.
    Double,
}

impl CurvedMeeting {
    /// The same in the words for triangles.
    pub fn meeting(&self) -> Meeting {
        if self.passes_through {
            Meeting::Interior
        } else if self.touches {
            Meeting::Boundary(Vec::new())
        } else if self.ends_on {
            Meeting::EndsOn
        } else {
            Meeting::Misses
        }
    }
}

/// The coarsest scale that the lengths of a shape are integers in.
pub fn scale_of_shape(shape: &Shape) -> Scale {
    let length = Vec3::splat;
    match shape {
        Shape::Sphere(s) => Scale::of([s.centre, length(s.radius)]),
        Shape::Ellipsoid(e) => Scale::of([e.centre].into_iter().chain(e.axes)),
        Shape::Cone(c) => Scale::of([c.base, c.apex, length(c.base_radius), length(c.apex_radius)]),
        Shape::Disc(d) => Scale::of([d.centre, length(d.radius)]),
        Shape::Plane(p) => Scale::of([p.point]),
        Shape::Quadric(q) => Scale::of([q.reference, q.low, q.high]),
    }
}

impl IntegerShape {
    /// A shape in a scale that its lengths are integers in.
    pub fn new(shape: &Shape, light: &IntegerLight, scale: Scale) -> IntegerShape {
        let from = light.origin();
        let place = |p: Vec3| minus(&scale.point(p), &from);
        let smooth = |reference, form| IntegerShape {
            reference,
            surface: Surface::Quadric(form),
            sides: Vec::new(),
            rim: None,
        };
        match shape {
            Shape::Sphere(s) => smooth(place(s.centre), ball(scale.number(s.radius))),
            Shape::Ellipsoid(e) => smooth(place(e.centre), ellipsoid(e.axes.map(|axis| scale.point(axis)))),
            Shape::Cone(c) => {
                let axis = minus(&scale.point(c.apex), &scale.point(c.base));
                let form = cone(&axis, scale.number(c.base_radius), scale.number(c.apex_radius));
                let length = dot(&axis, &axis);
                let back = axis.each_ref().map(|x| -x);
                let sides = vec![with(axis, IBig::ZERO), with(back, length)];
                IntegerShape { sides, ..smooth(place(c.base), form) }
            }
            Shape::Disc(d) => {
                let inside = ball(scale.number(d.radius)).negated();
                IntegerShape { rim: Some(inside), ..flat(place(d.centre), d.normal) }
            }
            Shape::Plane(p) => flat(place(p.point), p.normal),
            Shape::Quadric(q) => {
                let [low, high] =
                    [q.low, q.high].map(|corner| minus(&scale.point(corner), &scale.point(q.reference)));
                let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| Scale::of([axis]).point(axis));
                let above = axes.clone().into_iter().zip(low).map(|(axis, end)| with(axis, -end));
                let below = axes.into_iter().zip(high).map(|(axis, end)| with(axis.map(|x| -x), end));
                let sides = above.chain(below).collect();
                let form = general(q.second, q.first, q.constant, scale);
                IntegerShape { sides, ..smooth(place(q.reference), form) }
            }
        }
    }

    /// A point or direction in its own coordinates.
    pub fn local(&self, x: &Homogeneous) -> Homogeneous {
        let [a, b, c] = [0, 1, 2].map(|i| &x[i] - &self.reference[i] * &x[3]);
        [a, b, c, x[3].clone()]
    }

    /// What the plane of a flat surface says of a point or direction; 0 for other surfaces.
    pub fn plane_value(&self, x: &Homogeneous) -> IBig {
        match &self.surface {
            Surface::Plane(plane) => product(plane, &self.local(x)),
            Surface::Quadric(_) => IBig::ZERO,
        }
    }

    /// How it lies to the open segment between a light and a point.
    pub fn meet(&self, light: &Homogeneous, point: &RelativePoint) -> CurvedMeeting {
        let common = self.common_points(light, point, &[]);
        let mut meeting = CurvedMeeting { ends_on: common.start.is_some(), ..CurvedMeeting::default() };
        for place in common.places {
            let passes = place.kind == RootKind::Simple;
            meeting.crossings += usize::from(passes);
            meeting.passes_through |= passes && !place.is_on_rim;
            meeting.touches |= !passes || place.is_on_rim;
        }
        meeting
    }

    /// All points that it has in common with the open segment between a light and a point, where further
    /// bounds are not negative.
    pub fn common_points(&self, light: &Homogeneous, point: &RelativePoint, further: &[Bound]) -> Common {
        let segment = self.segment(light, point);
        let quadratic = match &self.surface {
            Surface::Plane(plane) => {
                let [start, slope] = segment.linear(plane);
                Quadratic::new(&point.field, [start, slope, Surd::ZERO])
            }
            Surface::Quadric(form) => segment.quadratic(form),
        };
        let bounds = self.bounds(&segment);
        let roots = quadratic.roots();
        let is_start =
            quadratic.sign_at_zero() == 0 && bounds.iter().all(|bound| bound.sign_at_zero(&point.field) >= 0);
        let start = match roots {
            Roots::Everywhere => StartsOn::Along,
            _ => StartsOn::Across,
        };
        let (count, kind) = match roots {
            Roots::Everywhere => (0, RootKind::Double),
            Roots::Simple(count) => (count, RootKind::Simple),
            Roots::Double => (1, RootKind::Double),
        };
        let sign = |number, bound: &Bound| quadratic.sign_at_root(roots, number, bound);
        let place = |number| {
            let signs: Vec<i32> = bounds.iter().map(|bound| sign(number, bound)).collect();
            let is_there =
                signs.iter().all(|&sign| sign >= 0) && further.iter().all(|bound| sign(number, bound) >= 0);
            is_there.then_some(RootPlace { kind, is_on_rim: signs.contains(&0) })
        };
        Common { start: is_start.then_some(start), places: (0..count).filter_map(place).collect() }
    }

    fn bounds<'f>(&self, segment: &Segment<'f>) -> Vec<Bound<'f>> {
        let sides = self.sides.iter().map(|side| Bound::Linear(segment.linear(side)));
        sides.chain(self.rim.iter().map(|rim| Bound::Quadratic(segment.quadratic(rim)))).collect()
    }

    /// A light and a point in its own coordinates.
    fn segment<'f>(&self, light: &Homogeneous, point: &'f RelativePoint) -> Segment<'f> {
        let (rational, irrational) = point.homogeneous();
        Segment {
            light: self.local(light),
            rational: self.local(&rational),
            irrational: self.local(&irrational),
            field: &point.field,
        }
    }
}

/// The points P + s L with s > 0, where P may be irrational.
struct Segment<'f> {
    light: Homogeneous,
    rational: Homogeneous,
    irrational: Homogeneous,
    field: &'f Field,
}

impl<'f> Segment<'f> {
    /// Constant term and slope of a plane's values.
    fn linear(&self, plane: &Homogeneous) -> [Surd; 2] {
        let [rational, irrational] = [&self.rational, &self.irrational].map(|x| product(plane, x));
        [Surd { rational, irrational }, Surd::from(product(plane, &self.light))]
    }

    /// The values of a form.
    fn quadratic(&self, form: &Form) -> Quadratic<'f> {
        let (p, i, l) = (&self.rational, &self.irrational, &self.light);
        let two = IBig::from(2);
        let constant = Surd {
            rational: form.polar(p, p) + form.polar(i, i) * self.field.square(),
            irrational: form.polar(p, i) * &two,
        };
        let slope = Surd { rational: form.polar(p, l), irrational: form.polar(i, l) }.times(&two);
        Quadratic::new(self.field, [constant, slope, Surd::from(form.polar(l, l))])
    }
}

impl Form {
    /// The form of x and y.
    pub fn polar(&self, x: &Homogeneous, y: &Homogeneous) -> IBig {
        self.rows.iter().zip(x).filter(|(_, x)| **x != IBig::ZERO).map(|(row, x)| x * product(row, y)).sum()
    }

    fn negated(self) -> Form {
        Form { rows: Box::new(self.rows.map(|row| row.map(|x| -x))) }
    }

    /// x . S x + first . x + constant, from S and half of the other two.
    fn new(square: impl Fn(usize, usize) -> IBig, half_first: &IntegerVector, constant: IBig) -> Form {
        let row = |i: usize| [0, 1, 2, 3].map(|j| if j == 3 { half_first[i].clone() } else { square(i, j) });
        let [x, y, z] = half_first.clone();
        Form { rows: Box::new([row(0), row(1), row(2), [x, y, z, constant]]) }
    }
}

/// |x|^2 - radius^2
fn ball(radius: IBig) -> Form {
    let unit = |i, j| if i == j { IBig::ONE } else { IBig::ZERO };
    Form::new(unit, &[IBig::ZERO, IBig::ZERO, IBig::ZERO], -(&radius * &radius))
}

/// |adj(M) x|^2 - det(M)^2, where the axes are the columns of M.
fn ellipsoid([a, b, c]: [IntegerVector; 3]) -> Form {
    let adjugate = [cross(&b, &c), cross(&c, &a), cross(&a, &b)];
    let determinant = dot(&a, &adjugate[0]);
    let square = |i: usize, j: usize| adjugate.iter().map(|row| &row[i] * &row[j]).sum();
    Form::new(square, &[IBig::ZERO, IBig::ZERO, IBig::ZERO], -(&determinant * &determinant))
}

/// L (L |x|^2 - (x . v)^2) - (r L + d x . v)^2 with L = v . v, where the radius grows from r by d along v.
fn cone(axis: &IntegerVector, base_radius: IBig, apex_radius: IBig) -> Form {
    let length = dot(axis, axis);
    let growth = apex_radius - &base_radius;
    let at_base = base_radius * &length;
    let across = &length + &growth * &growth;
    let square = |i: usize, j: usize| {
        let along = -(&across * &axis[i] * &axis[j]);
        if i == j { along + &length * &length } else { along }
    };
    let first = axis.each_ref().map(|x| -(&at_base * &growth * x));
    Form::new(square, &first, -(&at_base * &at_base))
}

/// The polynomial of a general quadric, times some power of two.
fn general(second: [f32; 6], first: Vec3, constant: f32, scale: Scale) -> Form {
    // In units of 2^e a coefficient of degree n stands for 2^(n e) times as much; all of it doubled.
    let unit = scale.exponent();
    let scaled = |value: f32, degree: i32, factor: i32| {
        let (mantissa, exponent) = decode(value);
        (mantissa, exponent + degree * unit + factor)
    };
    let [xx, yy, zz, xy, yz, zx] = second;
    let numbers = [
        scaled(xx, 2, 1),
        scaled(yy, 2, 1),
        scaled(zz, 2, 1),
        scaled(xy, 2, 0),
        scaled(yz, 2, 0),
        scaled(zx, 2, 0),
        scaled(first.x, 1, 0),
        scaled(first.y, 1, 0),
        scaled(first.z, 1, 0),
        scaled(constant, 0, 1),
    ];
    let least = numbers.iter().filter(|n| n.0 != 0).map(|n| n.1).min().unwrap_or(0);
    let [xx, yy, zz, xy, yz, zx, x, y, z, constant] = numbers.map(|(mantissa, exponent)| {
        if mantissa == 0 { IBig::ZERO } else { IBig::from(mantissa) << (exponent - least) as usize }
    });
    let square = |i: usize, j: usize| {
        let entry = match (i.min(j), i.max(j)) {
            (0, 0) => &xx,
            (1, 1) => &yy,
            (2, 2) => &zz,
            (0, 1) => &xy,
            (1, 2) => &yz,
            _ => &zx,
        };
        entry.clone()
    };
    Form::new(square, &[x, y, z], constant)
}

fn flat(reference: IntegerVector, normal: Vec3) -> IntegerShape {
    let plane = with(Scale::of([normal]).point(normal), IBig::ZERO);
    IntegerShape { reference, surface: Surface::Plane(plane), sides: Vec::new(), rim: None }
}

fn with([x, y, z]: IntegerVector, w: IBig) -> Homogeneous {
    [x, y, z, w]
}

fn product(a: &Homogeneous, b: &Homogeneous) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2] + &a[3] * &b[3]
}

/// Meets a curved surface exactly.
pub fn meet(light: LightPosition, shape: &Shape, position: &ExactPosition) -> CurvedMeeting {
    let scale = scale_with(position, light, shape);
    let light = IntegerLight::new(light, scale);
    let point = RelativePoint::new(position, &light, scale);
    IntegerShape::new(shape, &light, scale).meet(&light.homogeneous(), &point)
}

/// Whether a point lies on a curved surface.
pub fn holds(shape: &Shape, point: Vec3) -> bool {
    // Any direction will do.
    meet(LightPosition::Towards(Vec3::X), shape, &ExactPosition::Bare(point)).ends_on
}
