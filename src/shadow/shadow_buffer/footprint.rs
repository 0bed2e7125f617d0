//! The cells whose centre ray can hit something: a superset, row by row.
//!
//! The centres of a row lie on the circle of one polar angle, and a plane n through the light leaves of that
//! circle the arc where |n_xy| sin(theta) cos(phi - phi_n) >= limit - n_z z. A triangle is three such planes,
//! through the light and an edge each; a ball, and a ball's cone around anything else, is the plane that cuts its
//! cap off the sphere; a plane without end is half of the sphere. Arcs are intersected as columns, so an
//! intersection of two pieces is exact. Everything is widened by far more than directions, normals and angles are
//! rounded by, and exact signs decide each ray afterwards.

use super::sphere::Sphere;
use crate::geometry::ROUNDOFF;
use crate::geometry::curved::{Shape, hull};
use crate::geometry::planes::OrientedPlanes;
use glam::{DVec3, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// What a direction is off by at most, each coordinate, for its rounding to f32; four times that.
const DIRECTION: f64 = 1.0 / 4_194_304.0;

/// Radians by which caps are widened: far above the rounding of directions.
const MARGIN: f64 = 1e-6;

/// Caps wider than this are taken for the whole sphere: a triangle is inside of a cap around its corners only if
/// that is less than half of the sphere.
const WIDEST: f64 = FRAC_PI_2 - 0.01;

/// Directions d of about unit length with `normal . d >= limit`.
#[derive(Debug, Clone, Copy)]
struct HalfSpace {
    normal: DVec3,
    limit: f64,
}

/// A superset of the cells whose centre ray can hit a primitive.
#[derive(Debug, Clone)]
pub(super) struct Footprint {
    /// First and last row.
    rows: [u32; 2],
    half_spaces: [Option<HalfSpace>; 3],
}

/// Columns of one row, from first to last, in ascending order without overlaps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Spans {
    pieces: [[u32; 2]; MOST_PIECES],
    count: usize,
}

/// Three arcs, of which each is at most two pieces, leave at most four pieces in common.
const MOST_PIECES: usize = 4;

impl Footprint {
    /// Of a triangle.
    pub fn of_triangle(sphere: &Sphere, planes: &OrientedPlanes) -> Option<Footprint> {
        let half_space = |k: usize| {
            let plane = &planes.edges[k];
            let error = plane.normal.abs().element_sum() * DIRECTION
                + plane.size.element_sum() * (16.0 * ROUNDOFF)
                + f64::MIN_POSITIVE;
            HalfSpace { normal: plane.normal, limit: -error }
        };
        let rows = match Cap::around(&planes.corners) {
            Some(cap) => cap.rows(sphere)?,
            None => [0, sphere.rows() - 1],
        };
        Some(Footprint { rows, half_spaces: [0, 1, 2].map(|k| Some(half_space(k))) })
    }

    /// Of a curved surface.
    pub fn of_shape(sphere: &Sphere, light: Vec3, shape: &Shape) -> Option<Footprint> {
        let light = light.as_dvec3();
        let cap = match shape {
            Shape::Plane(plane) => {
                let normal = plane.normal.as_dvec3().normalize();
                let to_plane = plane.point.as_dvec3() - light;
                let height = normal.dot(to_plane);
                // Too near to the plane to tell its side is the whole sphere.
                let is_certain = height.abs() > to_plane.length() * 1e-12;
                let half_space = HalfSpace { normal: normal * height.signum(), limit: -DIRECTION };
                let half_spaces = [is_certain.then_some(half_space), None, None];
                return Some(Footprint { rows: [0, sphere.rows() - 1], half_spaces });
            }
            Shape::Sphere(ball) => {
                let to_centre = ball.centre.as_dvec3() - light;
                Cap::of_ball(to_centre, f64::from(ball.radius))
            }
            _ => {
                let corners = hull::outer(shape).unwrap_or_default().concat();
                let corners: Vec<DVec3> = corners.into_iter().map(|corner| corner - light).collect();
                Cap::around(&corners)
            }
        };
        Some(match cap {
            Some(cap) => {
                Footprint { rows: cap.rows(sphere)?, half_spaces: [Some(cap.half_space()), None, None] }
            }
            None => Footprint { rows: [0, sphere.rows() - 1], half_spaces: [None; 3] },
        })
    }

    /// First and last row.
    pub fn rows(&self) -> [u32; 2] {
        self.rows
    }

    /// The columns of one row.
    pub fn spans(&self, sphere: &Sphere, row: u32) -> Spans {
        let mut spans = Spans::all(sphere.columns());
        let circle = sphere.row_centres(row);
        for half_space in self.half_spaces.iter().flatten() {
            let HalfSpace { normal, limit } = half_space;
            let most = libm::hypot(normal.x, normal.y) * circle.radius;
            let least = limit - normal.z * circle.z;
            // Comparisons with NaN leave everything.
            if least > most {
                return Spans::none();
            }
            if least > -most {
                let middle = libm::atan2(normal.y, normal.x);
                let half = libm::acos(least / most);
                spans = spans.within(&Spans::arc(sphere.columns(), middle - half, middle + half));
            }
        }
        spans
    }
}

/// Directions within an angle, below a right one, of an axis of unit length.
#[derive(Debug, Clone, Copy)]
struct Cap {
    axis: DVec3,
    angle: f64,
}

impl Cap {
    /// A cap that holds the directions to points, and so to everything between them; `None` if none is narrow
    /// enough, as around a light between them.
    fn around(points: &[DVec3]) -> Option<Cap> {
        let unit = |p: &DVec3| p.try_normalize();
        let sum = points.iter().map(unit).try_fold(DVec3::ZERO, |sum, u| Some(sum + u?))?;
        let axis = sum.try_normalize()?;
        // The angle by its tangent keeps its digits where it is small.
        let angle = |p: &DVec3| libm::atan2(axis.cross(*p).length(), axis.dot(*p));
        let widest = points.iter().map(angle).fold(0.0, f64::max) + MARGIN;
        (widest <= WIDEST).then_some(Cap { axis, angle: widest })
    }

    /// The directions that hit a ball; `None` if that is at the light or around it.
    fn of_ball(to_centre: DVec3, radius: f64) -> Option<Cap> {
        let angle = libm::asin(radius / to_centre.length()) + MARGIN;
        // The comparison with NaN fails.
        (angle <= WIDEST).then_some(Cap { axis: to_centre.normalize(), angle })
    }

    fn half_space(&self) -> HalfSpace {
        HalfSpace { normal: self.axis, limit: libm::cos(self.angle) - 1e-15 }
    }

    /// First and last row whose centres can be inside; `None` if there is none.
    fn rows(&self, sphere: &Sphere) -> Option<[u32; 2]> {
        let middle = libm::atan2(libm::hypot(self.axis.x, self.axis.y), -self.axis.z);
        let rows = f64::from(sphere.rows());
        let place = |theta: f64| theta / PI * rows - 0.5;
        let first = place(middle - self.angle).ceil().max(0.0);
        let last = place(middle + self.angle).floor().min(rows - 1.0);
        (first <= last).then_some([first as u32, last as u32])
    }
}

impl Spans {
    /// Every column.
    fn all(columns: u32) -> Spans {
        Spans::none().with([0, columns - 1])
    }

    fn none() -> Spans {
        Spans { pieces: [[0; 2]; MOST_PIECES], count: 0 }
    }

    fn with(mut self, piece: [u32; 2]) -> Spans {
        self.pieces[self.count] = piece;
        self.count += 1;
        self
    }

    /// Columns with their centre between two azimuths, which are less than a turn apart.
    fn arc(columns: u32, from: f64, to: f64) -> Spans {
        let place = |phi: f64| phi / TAU * f64::from(columns) - 0.5;
        // Rounding has far less to say than the margins of the planes; this is for whole numbers.
        let (first, last) = ((place(from) - 1e-9).ceil() as i64, (place(to) + 1e-9).floor() as i64);
        let count = i64::from(columns);
        if last < first {
            return Spans::none();
        }
        if last - first + 1 >= count {
            return Spans::all(columns);
        }
        let (first, last) = (first.rem_euclid(count) as u32, last.rem_euclid(count) as u32);
        match first <= last {
            true => Spans::none().with([first, last]),
            false => Spans::none().with([0, last]).with([first, columns - 1]),
        }
    }

    /// What both have.
    fn within(&self, other: &Spans) -> Spans {
        let mut common = Spans::none();
        for &[a, b] in self.iter() {
            for &[c, d] in other.iter() {
                if a.max(c) <= b.min(d) {
                    common = common.with([a.max(c), b.min(d)]);
                }
            }
        }
        common
    }

    /// First and last column of each piece.
    pub fn iter(&self) -> impl Iterator<Item = &[u32; 2]> {
        self.pieces[..self.count].iter()
    }
}

#[cfg(test)]
mod tests {
    use super::super::sphere::Cell;
    use super::*;
    use crate::geometry::curved::tests as shapes;
    use crate::geometry::curved::{InfinitePlane, RayStart};
    use crate::geometry::ray_triangle::RayTriangle;
    use proptest::prelude::*;

    fn holds(footprint: Option<&Footprint>, sphere: &Sphere, Cell { row, column }: Cell) -> bool {
        footprint.is_some_and(|footprint| {
            (footprint.rows()[0]..=footprint.rows()[1]).contains(&row)
                && footprint.spans(sphere, row).iter().any(|&[a, b]| (a..=b).contains(&column))
        })
    }

    fn cells(sphere: &Sphere) -> impl Iterator<Item = Cell> {
        let columns = sphere.columns();
        (0..sphere.rows()).flat_map(move |row| (0..columns).map(move |column| Cell { row, column }))
    }

    /// How many centre rays hit, and how many the footprint has; fails if it lacks one.
    fn check(sphere: &Sphere, light: Vec3, corners: [Vec3; 3]) -> [usize; 2] {
        let Some(triangle) = RayTriangle::new(light, corners) else { return [0; 2] };
        let footprint = Footprint::of_triangle(sphere, triangle.planes());
        let mut counts = [0; 2];
        for cell in cells(sphere) {
            let (hit, held) =
                (triangle.hit(sphere.centre(cell)).is_some(), holds(footprint.as_ref(), sphere, cell));
            assert!(held || !hit, "{corners:?} from {light:?}: {cell:?}");
            counts[0] += usize::from(hit);
            counts[1] += usize::from(held);
        }
        counts
    }

    #[test]
    fn arcs_wrap_and_meet_in_pieces() {
        let pieces = |spans: Spans| spans.iter().copied().collect::<Vec<_>>();
        // Centres at 45, 135, 225 and 315 degrees.
        assert_eq!(pieces(Spans::arc(4, 0.0, 1.0)), [[0, 0]]);
        assert_eq!(pieces(Spans::arc(4, -1.0, 1.0)), [[0, 0], [3, 3]]);
        assert_eq!(pieces(Spans::arc(4, 7.0, 8.0)), [[0, 0]].to_vec());
        assert_eq!(pieces(Spans::arc(4, 0.1, 0.2)), [[0; 2]; 0]);
        assert_eq!(pieces(Spans::arc(4, -3.0, 3.2)), [[0, 3]]);
        let both = Spans::arc(100, -2.0, 2.0).within(&Spans::arc(100, 1.5, 5.0));
        assert_eq!(pieces(both), [[24, 31], [68, 79]]);
    }

    #[test]
    fn a_triangle_has_little_more_cells_than_it_hits() {
        let sphere = Sphere::new(200, 400).unwrap();
        for corners in [
            [Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 1.0, 0.0), Vec3::new(1.0, 0.0, 1.0)],
            // Around a pole, and across the seam.
            [Vec3::new(1.0, 0.0, 1.0), Vec3::new(-1.0, 1.0, 1.0), Vec3::new(-1.0, -1.0, 1.0)],
            [Vec3::new(1.0, 1.0, -1.0), Vec3::new(1.0, -1.0, 0.5), Vec3::new(1.0, 0.2, 2.0)],
            // Nearly half of the sphere.
            [Vec3::new(9.0, 0.0, -0.1), Vec3::new(-9.0, 9.0, -0.1), Vec3::new(-9.0, -9.0, -0.1)],
        ] {
            let [hit, held] = check(&sphere, Vec3::ZERO, corners);
            assert!(hit > 500 && held <= hit + hit / 50 + 2, "{corners:?}: {hit} hit, {held} held");
        }
    }

    #[test]
    fn triangles_smaller_than_a_cell_have_few() {
        let sphere = Sphere::new(100, 200).unwrap();
        let aim = sphere.centre(Cell { row: 30, column: 77 });
        let corners = [aim, aim + Vec3::X * 1e-4, aim + Vec3::new(1e-4, 1e-4, 2e-4)];
        let [hit, held] = check(&sphere, Vec3::ZERO, corners);
        assert_eq!([hit, held], [1, 1]);
    }

    #[test]
    fn balls_have_their_caps_and_planes_half_of_the_sphere() {
        let sphere = Sphere::new(60, 120).unwrap();
        let count = |light: Vec3, shape: &Shape| {
            let footprint = Footprint::of_shape(&sphere, light, shape);
            let start = RayStart::origin();
            let mut counts = [0; 2];
            for cell in cells(&sphere) {
                let hit = shape.first_hit(light, sphere.centre(cell), &start).is_some();
                let held = holds(footprint.as_ref(), &sphere, cell);
                assert!(held || !hit, "{shape:?} from {light:?}: {cell:?}");
                counts[0] += usize::from(hit);
                counts[1] += usize::from(held);
            }
            counts
        };
        for light in [Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 0.1, 2.0), Vec3::new(1.3, -1.0, 0.4)] {
            let [hit, held] = count(light, &Shape::sphere(Vec3::ZERO, 1.0));
            assert!(hit > 100 && held == hit, "{light:?}: {hit} hit, {held} held");
        }
        assert_eq!(count(Vec3::new(0.2, 0.0, 0.0), &Shape::sphere(Vec3::ZERO, 1.0)), [7200; 2]);
        // On the surface.
        count(Vec3::X, &Shape::sphere(Vec3::ZERO, 1.0));
        let plane = |normal: Vec3| Shape::Plane(InfinitePlane { point: Vec3::ZERO, normal });
        for normal in [Vec3::Y, Vec3::NEG_Z, Vec3::new(1.0, 2.0, -3.0)] {
            let [hit, held] = count(Vec3::new(0.3, 2.0, 0.1), &plane(normal));
            assert_eq!([hit, held], [3600, 3600], "{normal:?}");
        }
        assert_eq!(count(Vec3::X, &plane(Vec3::Y))[0], 0);
    }

    fn point() -> impl Strategy<Value = Vec3> {
        let coordinate = prop_oneof![(-2i32..3).prop_map(|x| x as f32), -2.0f32..2.0];
        prop::array::uniform3(coordinate).prop_map(Vec3::from)
    }

    /// A scale, a stretch along z, and a place.
    fn triangle() -> impl Strategy<Value = [Vec3; 3]> {
        let size = prop_oneof![Just(1.0f32), Just(1e-4), Just(1e6), 0.01f32..3.0];
        (prop::array::uniform3(point()), size, prop_oneof![Just(1.0f32), Just(1e-6), Just(0.0)], point())
            .prop_map(|(corners, size, flat, at)| {
                corners.map(|p| p * Vec3::new(size, size, size * flat) + at)
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(600))]
        #[test]
        fn every_cell_that_is_hit_is_held(
            corners in triangle(), light in point(), rows in 1u32..40, columns in 1u32..60,
        ) {
            check(&Sphere::new(rows, columns).unwrap(), light, corners);
        }

        #[test]
        fn every_cell_that_hits_a_curved_surface_is_held(
            shape in shapes::shape(), light in point(), rows in 1u32..20, columns in 1u32..30,
        ) {
            let sphere = Sphere::new(rows, columns).unwrap();
            let footprint = Footprint::of_shape(&sphere, light, &shape);
            let start = RayStart::origin();
            for cell in cells(&sphere) {
                let hit = shape.first_hit(light, sphere.centre(cell), &start).is_some();
                prop_assert!(!hit || holds(footprint.as_ref(), &sphere, cell), "{:?}", cell);
            }
        }
    }
}
