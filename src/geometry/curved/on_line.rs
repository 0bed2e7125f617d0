//! A surface along a line: its polynomial and its bounds as functions of the place on the line.

use super::shape::{Cone, Disc, Ellipsoid, InfinitePlane, Quadric, Shape, Sphere};
use crate::geometry::number::{self, Number, Vector, cross, dot, scaled, vector};
use glam::Vec3;

/// The line of points (start + t along) / weight, in world space, with a positive weight.
pub(crate) struct Line<N> {
    pub start: Vector<N>,
    pub weight: N,
    pub along: Vector<N>,
}

/// A surface along a line. Everything is scaled by positive constants.
pub(crate) struct OnLine<N> {
    /// The polynomial `c + b t + a t^2`, in the order c, b, a.
    pub surface: [N; 3],
    /// Linear functions `g + h t` that must not be negative.
    pub half_spaces: Vec<[N; 2]>,
    /// A quadratic function that must not be negative at a point of the surface.
    pub within: Option<[N; 3]>,
}

impl<N: Number> Line<N> {
    /// The start relative to a point, times the weight.
    fn from(&self, origin: Vec3) -> Vector<N> {
        number::minus(&self.start, &scaled(&vector(origin), &self.weight))
    }

    /// `u . v` along the line, for linear u = p + t q and v = r + t s.
    fn product(p: &Vector<N>, q: &Vector<N>, r: &Vector<N>, s: &Vector<N>) -> [N; 3] {
        [dot(p, r), dot(p, s).plus(&dot(q, r)), dot(q, s)]
    }
}

fn minus<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    number::minus(&a, &b)
}

/// The square of a linear function.
fn squared<N: Number>([g, h]: &[N; 2]) -> [N; 3] {
    let gh = g.times(h);
    [g.squared(), gh.plus(&gh), h.squared()]
}

impl<N: Number> OnLine<N> {
    /// A shape along a line.
    pub fn new(shape: &Shape, line: &Line<N>) -> OnLine<N> {
        match shape {
            Shape::Sphere(sphere) => OnLine::whole(of_sphere(sphere, line)),
            Shape::Ellipsoid(ellipsoid) => OnLine::whole(of_ellipsoid(ellipsoid, line)),
            Shape::Cone(cone) => of_cone(cone, line),
            Shape::Disc(disc) => of_disc(disc, line),
            Shape::Plane(InfinitePlane { point, normal }) => {
                OnLine::whole(of_plane(&line.from(*point), &vector(*normal), line))
            }
            Shape::Quadric(quadric) => of_quadric(quadric, line),
        }
    }

    fn whole(surface: [N; 3]) -> OnLine<N> {
        OnLine { surface, half_spaces: Vec::new(), within: None }
    }
}

/// `r^2` in the scale of squares of what `line.from` gives.
fn square_of<N: Number>(radius: f32, line: &Line<N>) -> N {
    N::exactly(radius).times(&line.weight).squared()
}

fn of_sphere<N: Number>(sphere: &Sphere, line: &Line<N>) -> [N; 3] {
    let (p, v) = (line.from(sphere.centre), &line.along);
    let [c, b, a] = Line::product(&p, v, &p, v);
    [c.minus(&square_of(sphere.radius, line)), b, a]
}

/// With M the matrix of the axes: |det M  M^-1 w|^2 - det M^2.
fn of_ellipsoid<N: Number>(ellipsoid: &Ellipsoid, line: &Line<N>) -> [N; 3] {
    let [x, y, z] = ellipsoid.axes.map(vector::<N>);
    let rows = [cross(&y, &z), cross(&z, &x), cross(&x, &y)];
    let determinant = dot(&x, &rows[0]).times(&line.weight);
    let p = line.from(ellipsoid.centre);
    let (u, v) = (rows.each_ref().map(|row| dot(row, &p)), rows.each_ref().map(|row| dot(row, &line.along)));
    let [c, b, a] = Line::product(&u, &v, &u, &v);
    [c.minus(&determinant.squared()), b, a]
}

/// With the axis v, L = v . v and s = w . v: the distance from the axis is |w x v| / sqrt L, the radius there
/// (r0 L + (r1 - r0) s) / L, and so the polynomial L |w x v|^2 - (r0 L + (r1 - r0) s)^2.
fn of_cone<N: Number>(cone: &Cone, line: &Line<N>) -> OnLine<N> {
    let axis = number::minus(&vector::<N>(cone.apex), &vector(cone.base));
    let length = dot(&axis, &axis);
    let p = line.from(cone.base);
    let (across_p, across_v) = (cross(&p, &axis), cross(&line.along, &axis));
    let distance = Line::product(&across_p, &across_v, &across_p, &across_v);
    let height = [dot(&p, &axis), dot(&line.along, &axis)];
    let growth = N::exactly(cone.apex_radius).minus(&N::exactly(cone.base_radius));
    let at_base = N::exactly(cone.base_radius).times(&length).times(&line.weight);
    let radius = [at_base.plus(&growth.times(&height[0])), growth.times(&height[1])];
    let surface = minus(scaled(&distance, &length), squared(&radius));
    let to_apex = [length.times(&line.weight).minus(&height[0]), height[1].negated()];
    OnLine { surface, half_spaces: vec![height, to_apex], within: None }
}

fn of_plane<N: Number>(p: &Vector<N>, normal: &Vector<N>, line: &Line<N>) -> [N; 3] {
    [dot(normal, p), dot(normal, &line.along), N::exactly(0.0)]
}

fn of_disc<N: Number>(disc: &Disc, line: &Line<N>) -> OnLine<N> {
    let (p, v) = (line.from(disc.centre), &line.along);
    let zero = || N::exactly(0.0);
    let [c, b, a] = Line::product(&p, v, &p, v);
    let within = [square_of(disc.radius, line).minus(&c), zero().minus(&b), zero().minus(&a)];
    let surface = of_plane(&p, &vector(disc.normal), line);
    OnLine { surface, half_spaces: Vec::new(), within: Some(within) }
}

fn of_quadric<N: Number>(quadric: &Quadric, line: &Line<N>) -> OnLine<N> {
    let (p, v) = (line.from(quadric.reference), &line.along);
    let mut surface = [0, 1, 2].map(|_| N::exactly(0.0));
    let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
    for (&coefficient, (i, j)) in quadric.second.iter().zip(pairs) {
        let term = [p[i].times(&p[j]), p[i].times(&v[j]).plus(&p[j].times(&v[i])), v[i].times(&v[j])];
        let coefficient = N::exactly(coefficient);
        surface = std::array::from_fn(|k| surface[k].plus(&term[k].times(&coefficient)));
    }
    let first = scaled(&vector::<N>(quadric.first), &line.weight);
    let constant = N::exactly(quadric.constant).times(&line.weight.squared());
    surface[0] = surface[0].plus(&dot(&first, &p)).plus(&constant);
    surface[1] = surface[1].plus(&dot(&first, v));
    let side =
        |i: usize, border: f32| [line.start[i].minus(&N::exactly(border).times(&line.weight)), v[i].clone()];
    let half_spaces = (0..3).flat_map(|i| {
        let [g, h] = side(i, quadric.high[i]);
        [side(i, quadric.low[i]), [g.negated(), h.negated()]]
    });
    OnLine { surface, half_spaces: half_spaces.collect(), within: None }
}
