//! Closed solids out of boxes, turned profiles and tubes. Lengths in metres, y up.

use std::f64::consts::{PI, TAU};

pub type Point = [f64; 3];

/// A closed surface of triangles that share their points, wound outwards.
#[derive(Clone, Default)]
pub struct Solid {
    pub points: Vec<Point>,
    pub triangles: Vec<[usize; 3]>,
}

/// How a turned profile is closed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Profile {
    /// The last point joins the first: a ring.
    Loop,
    /// The first and the last point lie on the axis.
    AxisToAxis,
}

impl Solid {
    /// A box between two corners.
    pub fn cuboid(low: Point, high: Point) -> Solid {
        let points =
            (0..8).map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 0 { low[k] } else { high[k] })).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Solid { points, triangles: quads.iter().flat_map(|&q| halves(q)).collect() }.outward()
    }

    /// A profile of (radius, height) turned about the y axis in so many steps.
    pub fn turned(profile: &[[f64; 2]], closing: Profile, steps: usize) -> Solid {
        Solid::turned_with(profile, closing, steps, |_, radius| radius)
    }

    /// The same with a radius that depends on the step.
    pub fn turned_with(
        profile: &[[f64; 2]],
        closing: Profile,
        steps: usize,
        shape: impl Fn(usize, f64) -> f64,
    ) -> Solid {
        let mut solid = Solid::default();
        let mut rings: Vec<Vec<usize>> = Vec::new();
        for (place, &[radius, height]) in profile.iter().enumerate() {
            let is_pole = closing == Profile::AxisToAxis && (place == 0 || place == profile.len() - 1);
            if is_pole {
                rings.push(vec![solid.points.len(); steps]);
                solid.points.push([0.0, height, 0.0]);
                continue;
            }
            rings.push((0..steps).map(|step| solid.points.len() + step).collect());
            for step in 0..steps {
                let (sin, cos) = libm::sincos(TAU * step as f64 / steps as f64);
                let radius = shape(step, radius);
                solid.points.push([radius * cos, height, radius * sin]);
            }
        }
        let bands = if closing == Profile::Loop { rings.len() } else { rings.len() - 1 };
        for band in 0..bands {
            let (low, high) = (&rings[band], &rings[(band + 1) % rings.len()]);
            for step in 0..steps {
                let next = (step + 1) % steps;
                solid.add_quad([low[step], high[step], high[next], low[next]]);
            }
        }
        solid.outward()
    }

    /// A tube of the given radius around a closed curve.
    pub fn tube(curve: impl Fn(f64) -> Point, radius: f64, around: usize, along: usize) -> Solid {
        let mut solid = Solid::default();
        for step in 0..along {
            let at = step as f64 / along as f64;
            let (here, ahead) = (curve(at), curve(at + 1e-3));
            let tangent = unit(sub(ahead, here));
            // Away from the origin on the whole: a frame that closes when the curve does.
            let side = unit(cross(tangent, add(here, ahead)));
            let out = cross(side, tangent);
            for turn in 0..around {
                let (sin, cos) = libm::sincos(TAU * turn as f64 / around as f64);
                solid.points.push(add(here, add(scale(out, radius * cos), scale(side, radius * sin))));
            }
        }
        for step in 0..along {
            let (low, high) = (step * around, (step + 1) % along * around);
            for turn in 0..around {
                let next = (turn + 1) % around;
                solid.add_quad([low + turn, low + next, high + next, high + turn]);
            }
        }
        solid.outward()
    }

    /// A ball of radius 1 around the origin.
    pub fn ball(rings: usize, steps: usize) -> Solid {
        let profile: Vec<[f64; 2]> = (0..=rings)
            .map(|ring| {
                let (sin, cos) = libm::sincos(PI * ring as f64 / rings as f64);
                [sin, -cos]
            })
            .collect();
        Solid::turned(&profile, Profile::AxisToAxis, steps)
    }

    /// Both solids; where they overlap, both stay.
    pub fn with(mut self, other: &Solid) -> Solid {
        let base = self.points.len();
        self.points.extend(&other.points);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| base + i)));
        self
    }

    fn add_quad(&mut self, quad: [usize; 4]) {
        // At a pole two corners are one.
        let whole = |t: &[usize; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        self.triangles.extend(halves(quad).into_iter().filter(whole));
    }

    /// Turns the triangles round if they enclose a negative volume.
    pub fn outward(mut self) -> Solid {
        let volume: f64 = self.corners().map(|[a, b, c]| dot(a, cross(b, c))).sum();
        if volume < 0.0 {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        self
    }

    fn corners(&self) -> impl Iterator<Item = [Point; 3]> {
        self.triangles.iter().map(|t| t.map(|i| self.points[i]))
    }

    /// Points with normals for shading: smooth where triangles meet at less than about 40 degrees.
    pub fn shaded(&self) -> Shaded {
        const COS_CREASE: f64 = 0.766;
        let areas: Vec<Point> = self.corners().map(|[a, b, c]| cross(sub(b, a), sub(c, a))).collect();
        let mut around = vec![Vec::new(); self.points.len()];
        for (face, triangle) in self.triangles.iter().enumerate() {
            triangle.iter().for_each(|&point| around[point].push(face));
        }
        let mut shaded = Shaded::default();
        let mut made: Vec<Vec<([f32; 3], u16)>> = vec![Vec::new(); self.points.len()];
        for (face, triangle) in self.triangles.iter().enumerate() {
            let corners = triangle.map(|point| {
                let smooth = around[point]
                    .iter()
                    .filter(|&&other| dot(unit(areas[face]), unit(areas[other])) > COS_CREASE);
                let normal =
                    unit(smooth.fold([0.0; 3], |sum, &other| add(sum, areas[other]))).map(|v| v as f32);
                if let Some(&(_, vertex)) = made[point].iter().find(|(known, _)| *known == normal) {
                    return vertex;
                }
                let vertex = u16::try_from(shaded.positions.len()).expect("at most 65536 vertices a mesh");
                made[point].push((normal, vertex));
                shaded.positions.push(self.points[point].map(|v| v as f32));
                shaded.normals.push(normal);
                vertex
            });
            shaded.triangles.push(corners);
        }
        shaded
    }
}

/// A solid as a renderer's mesh.
#[derive(Default)]
pub struct Shaded {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub triangles: Vec<[u16; 3]>,
}

/// A smooth curve through points, so many steps a span (Catmull and Rom).
pub fn smooth(points: &[[f64; 2]], steps: usize) -> Vec<[f64; 2]> {
    let at = |i: isize| points[i.clamp(0, points.len() as isize - 1) as usize];
    let mut curve = Vec::new();
    for span in 0..points.len() as isize - 1 {
        let [p, q, r, s] = [-1, 0, 1, 2].map(|offset| at(span + offset));
        for step in 0..steps {
            let t = step as f64 / steps as f64;
            curve.push([0, 1].map(|k| {
                let linear = r[k] - p[k];
                let square = 2.0 * p[k] - 5.0 * q[k] + 4.0 * r[k] - s[k];
                let cube = 3.0 * (q[k] - r[k]) + s[k] - p[k];
                q[k] + 0.5 * t * (linear + t * (square + t * cube))
            }));
        }
    }
    curve.push(at(points.len() as isize - 1));
    curve
}

fn halves([a, b, c, d]: [usize; 4]) -> [[usize; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

pub fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn scale(a: Point, by: f64) -> Point {
    a.map(|v| v * by)
}

pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn unit(a: Point) -> Point {
    scale(a, 1.0 / dot(a, a).sqrt())
}
