//! Surfaces that are not triangles, by the floats that define them.
//!
//! Each is the zero set of a polynomial of degree 1 or 2 in exact numbers, cut off by bounds. Where there is
//! an inside, the polynomial is negative there. Both sides of all of them are seen and block light.

use super::defect::Defect;
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// A surface that is not a triangle. All numbers are in world space, exact as they stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A whole sphere.
    Sphere(Sphere),
    /// A whole ellipsoid.
    Ellipsoid(Ellipsoid),
    /// The wall of a cylinder or of a cone, without caps.
    Cone(Cone),
    /// A flat round disc.
    Disc(Disc),
    /// A plane without end.
    Plane(InfinitePlane),
    /// A piece of a general quadric.
    Quadric(Quadric),
}

/// Points at one distance from a centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// The centre.
    pub centre: Vec3,
    /// Above 0.
    pub radius: f32,
}

/// The image of the unit sphere under an affine map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// The centre.
    pub centre: Vec3,
    /// Where the map takes the three unit vectors: linearly independent, not necessarily perpendicular.
    pub axes: [Vec3; 3],
}

/// The wall of a truncated cone (NFF's `c`), without caps: a cylinder if both radii are equal. Points whose
/// foot on the axis lies between base and apex, ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// One end of the axis.
    pub base: Vec3,
    /// Radius there, from 0.
    pub base_radius: f32,
    /// The other end of the axis.
    pub apex: Vec3,
    /// Radius there, from 0; not both are 0.
    pub apex_radius: f32,
}

/// Points of a plane within a distance of a centre, rim included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// The centre.
    pub centre: Vec3,
    /// Perpendicular to the disc, not necessarily of unit length.
    pub normal: Vec3,
    /// Above 0.
    pub radius: f32,
}

/// A plane without end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InfinitePlane {
    /// A point of it.
    pub point: Vec3,
    /// Perpendicular to it, not necessarily of unit length.
    pub normal: Vec3,
}

/// The points x of a box with `w . S w + first . w + constant = 0`, where `w = x - reference` and the
/// symmetric S has the entries of `second`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadric {
    /// What coordinates are relative to.
    pub reference: Vec3,
    /// Coefficients of xx, yy, zz, xy, yz, zx; the last three are twice an entry of S.
    pub second: [f32; 6],
    /// Coefficients of x, y, z.
    pub first: Vec3,
    /// The constant term.
    pub constant: f32,
    /// Lowest corner of the box, in world space.
    pub low: Vec3,
    /// Highest corner of the box.
    pub high: Vec3,
}

impl Shape {
    /// A sphere.
    pub fn sphere(centre: Vec3, radius: f32) -> Shape {
        Shape::Sphere(Sphere { centre, radius })
    }

    /// The wall of a cylinder between two points.
    pub fn cylinder(base: Vec3, apex: Vec3, radius: f32) -> Shape {
        Shape::cone(base, radius, apex, radius)
    }

    /// The wall of a truncated cone between two points.
    pub fn cone(base: Vec3, base_radius: f32, apex: Vec3, apex_radius: f32) -> Shape {
        Shape::Cone(Cone { base, base_radius, apex, apex_radius })
    }

    /// What the numbers lack to be a surface, decided exactly.
    pub fn defect(&self) -> Option<Defect> {
        super::defect::of(self)
    }

    /// Whether it is a plane without end, which no box holds.
    pub fn is_endless(&self) -> bool {
        matches!(self, Shape::Plane(_))
    }

    /// The name of the kind.
    pub fn kind(&self) -> &'static str {
        match self {
            Shape::Sphere(_) => "sphere",
            Shape::Ellipsoid(_) => "ellipsoid",
            Shape::Cone(cone) if cone.base_radius == cone.apex_radius => "cylinder",
            Shape::Cone(_) => "cone",
            Shape::Disc(_) => "disc",
            Shape::Plane(_) => "plane",
            Shape::Quadric(_) => "quadric",
        }
    }

    /// Every number that defines it, for hashes and for telling equal ones apart from others.
    pub fn numbers(&self) -> Vec<f32> {
        let join = |parts: &[&[f32]]| parts.concat();
        match self {
            Shape::Sphere(s) => join(&[&[0.0], &s.centre.to_array(), &[s.radius]]),
            Shape::Ellipsoid(e) => {
                let [a, b, c] = e.axes.map(|axis| axis.to_array());
                join(&[&[1.0], &e.centre.to_array(), &a, &b, &c])
            }
            Shape::Cone(c) => {
                let (base, apex) = (c.base.to_array(), c.apex.to_array());
                join(&[&[2.0], &base, &[c.base_radius], &apex, &[c.apex_radius]])
            }
            Shape::Disc(d) => join(&[&[3.0], &d.centre.to_array(), &d.normal.to_array(), &[d.radius]]),
            Shape::Plane(p) => join(&[&[4.0], &p.point.to_array(), &p.normal.to_array()]),
            Shape::Quadric(q) => {
                let (reference, first) = (q.reference.to_array(), q.first.to_array());
                let (low, high) = (q.low.to_array(), q.high.to_array());
                join(&[&[5.0], &reference, &q.second, &first, &[q.constant], &low, &high])
            }
        }
    }

    /// An axis-aligned box that holds it, rounded outwards; `None` for a plane without end.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let around = |centre: DVec3, reach: DVec3| {
            // A few roundings of f64 went into the reach.
            let reach = reach * (1.0 + 1e-12);
            (outwards(centre - reach, f32::next_down), outwards(centre + reach, f32::next_up))
        };
        Some(match self {
            Shape::Sphere(s) => around(s.centre.as_dvec3(), DVec3::splat(s.radius.into())),
            Shape::Ellipsoid(e) => {
                let squares: DVec3 = e.axes.iter().map(|a| a.as_dvec3() * a.as_dvec3()).sum();
                around(e.centre.as_dvec3(), DVec3::from_array(squares.to_array().map(f64::sqrt)))
            }
            Shape::Cone(c) => {
                let axis = (c.apex.as_dvec3() - c.base.as_dvec3()).normalize_or_zero();
                let [base, apex] = [(c.base, c.base_radius), (c.apex, c.apex_radius)]
                    .map(|(centre, radius)| around(centre.as_dvec3(), round_reach(axis, radius)));
                (base.0.min(apex.0), base.1.max(apex.1))
            }
            Shape::Disc(d) => {
                around(d.centre.as_dvec3(), round_reach(d.normal.as_dvec3().normalize_or_zero(), d.radius))
            }
            Shape::Plane(_) => return None,
            Shape::Quadric(q) => (q.low, q.high),
        })
    }

    /// A ball that holds it, within a few roundings of f64; `None` for a plane without end.
    pub(crate) fn ball(&self) -> Option<(DVec3, f64)> {
        Some(match self {
            Shape::Sphere(s) => (s.centre.as_dvec3(), f64::from(s.radius)),
            Shape::Ellipsoid(e) => {
                let squares: f64 = e.axes.iter().map(|axis| axis.as_dvec3().length_squared()).sum();
                (e.centre.as_dvec3(), squares.sqrt())
            }
            Shape::Cone(c) => {
                let (base, apex) = (c.base.as_dvec3(), c.apex.as_dvec3());
                let widest = f64::from(c.base_radius.max(c.apex_radius));
                ((base + apex) * 0.5, (apex - base).length() * 0.5 + widest)
            }
            Shape::Disc(d) => (d.centre.as_dvec3(), f64::from(d.radius)),
            Shape::Plane(_) => return None,
            Shape::Quadric(q) => {
                let (low, high) = (q.low.as_dvec3(), q.high.as_dvec3());
                ((low + high) * 0.5, (high - low).length() * 0.5)
            }
        })
    }

    /// The surface where a transform takes it, each number computed in f64 and rounded once.
    ///
    /// # Errors
    /// In words, if that is not a surface of these kinds: cones and discs take turns, shifts and even
    /// scaling, quadrics shifts and scaling along the axes.
    pub fn transformed(&self, transform: &DAffine3) -> Result<Shape, &'static str> {
        let place = |p: Vec3| transform.transform_point3(p.as_dvec3()).as_vec3();
        let turn = |v: Vec3| transform.transform_vector3(v.as_dvec3()).as_vec3();
        let scale = even_scale(&transform.matrix3);
        let scaled = |radius: f32, scale: f64| (f64::from(radius) * scale) as f32;
        let normal = |v: Vec3| {
            let turned = transform.matrix3.inverse().transpose() * v.as_dvec3();
            turned.normalize_or_zero().as_vec3()
        };
        Ok(match self {
            Shape::Sphere(s) => match scale {
                Some(scale) => Shape::sphere(place(s.centre), scaled(s.radius, scale)),
                None => {
                    let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| turn(axis * s.radius));
                    Shape::Ellipsoid(Ellipsoid { centre: place(s.centre), axes })
                }
            },
            Shape::Ellipsoid(e) => {
                Shape::Ellipsoid(Ellipsoid { centre: place(e.centre), axes: e.axes.map(turn) })
            }
            Shape::Cone(c) => {
                let scale = scale.ok_or("a cylinder or cone can be turned, moved and scaled evenly alone")?;
                Shape::Cone(Cone {
                    base: place(c.base),
                    base_radius: scaled(c.base_radius, scale),
                    apex: place(c.apex),
                    apex_radius: scaled(c.apex_radius, scale),
                })
            }
            Shape::Disc(d) => {
                let scale = scale.ok_or("a disc can be turned, moved and scaled evenly alone")?;
                Shape::Disc(Disc {
                    centre: place(d.centre),
                    normal: normal(d.normal),
                    radius: scaled(d.radius, scale),
                })
            }
            Shape::Plane(p) => {
                Shape::Plane(InfinitePlane { point: place(p.point), normal: normal(p.normal) })
            }
            Shape::Quadric(q) => Shape::Quadric(scaled_quadric(q, transform)?),
        })
    }
}

/// The factor of a transform that keeps all angles, within rounding.
fn even_scale(matrix: &DMat3) -> Option<f64> {
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let scale = matrix.determinant().abs().cbrt();
    let tolerance = 1e-9 * scale * scale;
    let even = columns.iter().all(|c| (c.length_squared() - scale * scale).abs() <= tolerance);
    let square = [(0, 1), (1, 2), (2, 0)].iter().all(|&(i, j)| columns[i].dot(columns[j]).abs() <= tolerance);
    (even && square && scale > 0.0).then_some(scale)
}

fn scaled_quadric(q: &Quadric, transform: &DAffine3) -> Result<Quadric, &'static str> {
    let m = transform.matrix3;
    let scale = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
    if m != DMat3::from_diagonal(scale) || scale.to_array().contains(&0.0) {
        return Err("a quadric can be moved and scaled along the axes alone");
    }
    let place = |p: Vec3| transform.transform_point3(p.as_dvec3()).as_vec3();
    let by = |value: f32, a: usize, b: usize| (f64::from(value) / (scale[a] * scale[b])) as f32;
    let [xx, yy, zz, xy, yz, zx] = q.second;
    let (one, other) = (place(q.low), place(q.high));
    Ok(Quadric {
        reference: place(q.reference),
        second: [by(xx, 0, 0), by(yy, 1, 1), by(zz, 2, 2), by(xy, 0, 1), by(yz, 1, 2), by(zx, 2, 0)],
        first: (q.first.as_dvec3() / scale).as_vec3(),
        constant: q.constant,
        low: one.min(other),
        high: one.max(other),
    })
}

/// How far a circle with this unit axis reaches along the coordinates.
fn round_reach(axis: DVec3, radius: f32) -> DVec3 {
    let radius = f64::from(radius);
    // The axis carries a few roundings, which count most where it is along a coordinate.
    DVec3::from_array(axis.to_array().map(|a| radius * ((1.0 - a * a).max(0.0) + 1e-14).sqrt()))
}

fn outwards(p: DVec3, step: fn(f32) -> f32) -> Vec3 {
    Vec3::from_array(p.to_array().map(|x| step(x as f32)))
}
