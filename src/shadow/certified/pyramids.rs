//! Which of two triangles is before the other as a light sees them, in f64: one against sixteen.
//!
//! With corners a, b, c relative to the light and their volume a . (b x c) positive, the pyramid of light and triangle is where
//! (a x b) . d, (b x c) . d and (c x a) . d are not negative. With the normal N = (b - a) x (c - a) of the triangle's plane N . d is less than the
//! volume on the side of the light, and N . d over the volume is w in a direction d. All is in the axes of a side of the cube.
//!
//! Bounds, with r = 2^-53, m the largest sum of a corner's coordinates without their signs, and e that of an edge. A corner is wrong by r of itself,
//! as a difference of corners of the scene is. Of a product of two vectors each component is wrong by 4 r of both its terms, and these are
//! at most m e in all three together for the normal of an edge, a x (b - a), and e e for N. Another scalar product adds 4 r and the other's m: 8 r m e m',
//! of which twice as much is allowed for. N . d less the volume is wrong by 9 r e e (m + m') and 24 r are allowed for. Two w differ as
//! V' N . d and V N' . d do, which are wrong by 17 r of e e e' e' (m + m') and the largest coordinate of d, of which 32 r are allowed for.

use glam::DVec3;

/// Triangles side by side.
pub(super) const LANES: usize = 16;

/// Numbers of a pyramid: three corners, three normals of edges, and that of the plane, axis by axis; the volume; the sizes m and e; the indices of
/// the corners, which f64 holds; 1 if the corners are exact, and 1 if moreover the plane is along two axes.
const NUMBERS: usize = 29;
const EDGES: usize = 9;
const PLANE: usize = 18;
const VOLUME: usize = 21;
const SIZE: usize = 22;
const LENGTH: usize = 23;
const INDICES: usize = 24;
const EXACT: usize = 27;
const ALONG_AXES: usize = 28;

/// The bits of a number beside its sign and its power of two.
const MANTISSA: u64 = (1 << (f64::MANTISSA_DIGITS - 1)) - 1;

const R: f64 = 0.5 * f64::EPSILON;

/// A light and a triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pyramid {
    numbers: [f64; NUMBERS],
    /// Whether corners 1 and 2 have changed places.
    is_swapped: bool,
}

/// Sixteen of them, number by number.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct Pyramids([[f64; LANES]; NUMBERS]);

/// What is certain of sixteen triangles and one in a cell.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub(super) struct Relations {
    /// Where both are in the same direction of the cell, the other is nearer than the one.
    pub before: [u32; LANES],
    /// The other blocks no point that the one has in the cell.
    pub harmless: [u32; LANES],
    /// Where it is 0, the edge of the other from that corner does not go through the inside of the one.
    pub cuts: [[u32; LANES]; 3],
}

/// A cell: the direction of its centre in half cells, from which its borders are one to each side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place(pub [f64; 3]);

/// A triangle as a pyramid has it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Base {
    /// In the axes of a side.
    pub corners: [DVec3; 3],
    /// Where the light is.
    pub light: DVec3,
    pub indices: [u32; 3],
}

/// Whether a difference of two numbers in f64 was not rounded.
fn is_sum(corner: DVec3, light: DVec3, difference: DVec3) -> bool {
    // Each is exact if one of the two is, and the larger of them is the one that has to be.
    (0..3).all(|axis| {
        let (a, b, d) = (corner[axis], light[axis], difference[axis]);
        a - d == b && b + d == a
    })
}

impl Pyramid {
    /// If it is not certain which way round the corners are, nothing is said of the planes.
    pub fn new(base: Base) -> Pyramid {
        let Base { mut corners, light, mut indices } = base;
        let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
        let norm = |of: DVec3| of.abs().element_sum();
        let [a, b, c] = corners;
        let size = norm(a - light).max(norm(b - light)).max(norm(c - light));
        let length = norm(b - a).max(norm(c - b)).max(norm(a - c));
        let volume = normal(corners).dot(a - light);
        if volume < 0.0 {
            corners.swap(1, 2);
            indices.swap(1, 2);
        }
        let is_certain = volume.abs() > 32.0 * R * length * length * size;
        let known = |of: DVec3| if is_certain { of } else { DVec3::NAN };
        let mut numbers = [0.0; NUMBERS];
        for i in 0..3 {
            let (p, q) = (corners[i], corners[if i == 2 { 0 } else { i + 1 }]);
            let edge = known((p - light).cross(q - p));
            numbers[3 * i..3 * i + 3].copy_from_slice(&(p - light).to_array());
            numbers[EDGES + 3 * i..EDGES + 3 * i + 3].copy_from_slice(&edge.to_array());
            numbers[INDICES + i] = f64::from(indices[i]);
        }
        let plane = known(normal(corners));
        numbers[PLANE..PLANE + 3].copy_from_slice(&plane.to_array());
        numbers[VOLUME] = plane.dot(corners[0] - light);
        (numbers[SIZE], numbers[LENGTH]) = (size, length);
        let relative = corners.map(|corner| corner - light);
        // What a sum gives back was not rounded.
        let is_exact = (0..3).all(|i| is_sum(corners[i], light, relative[i]));
        numbers[EXACT] = f64::from(u8::from(is_exact));
        let along = (0..3).find(|&axis| corners.iter().all(|corner| corner[axis] == corners[0][axis]));
        if let Some(axis) = along.filter(|_| is_certain && is_exact) {
            // With a normal of one component, a power of two, values are rounded once, and those of the plane are 0.
            let component = f64::from_bits(plane[axis].to_bits() & !MANTISSA);
            let mut normal = [0.0; 3];
            normal[axis] = component;
            numbers[PLANE..PLANE + 3].copy_from_slice(&normal);
            numbers[VOLUME] = component * relative[0][axis];
            numbers[ALONG_AXES] = 1.0;
        }
        Pyramid { numbers, is_swapped: volume < 0.0 }
    }

    /// Where the edge from a corner to the next is here, corners being counted as in the scene.
    #[inline(always)]
    pub fn edge(&self, edge: usize) -> usize {
        if self.is_swapped { 2 - edge } else { edge }
    }

    /// A direction inside of the triangle and in the cell, in the middle of what they share; `None` if nothing is certain to be. For a triangle before the side.
    pub fn inside(&self, place: &Place) -> Option<[f64; 3]> {
        let Place([x, y, r]) = *place;
        let mut polygon = [[0.0; 2]; 8];
        let mut count = 3;
        for (i, at) in polygon.iter_mut().take(3).enumerate() {
            let [a, b, depth] = [self.numbers[3 * i], self.numbers[3 * i + 1], self.numbers[3 * i + 2]];
            *at = [a / depth * r - x, b / depth * r - y];
            if depth <= 0.0 {
                return None;
            }
        }
        for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            let within = |at: [f64; 2]| 1.0 - sign * at[axis];
            let (before, mut kept) = (polygon, 0);
            for i in 0..count {
                let (p, q) = (before[i], before[if i + 1 == count { 0 } else { i + 1 }]);
                let (of_p, of_q) = (within(p), within(q));
                if of_p >= 0.0 {
                    polygon[kept] = p;
                    kept += 1;
                }
                if (of_p < 0.0) != (of_q < 0.0) {
                    let t = of_p / (of_p - of_q);
                    polygon[kept] = [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])];
                    kept += 1;
                }
            }
            count = kept;
        }
        let (mut sum, share) = ([0.0; 2], 1.0 / count as f64);
        for at in &polygon[..count] {
            sum = [sum[0] + at[0], sum[1] + at[1]];
        }
        let at = [x + sum[0] * share, y + sum[1] * share, r];
        let is_in_cell = (at[0] - x).abs() <= 1.0 && (at[1] - y).abs() <= 1.0;
        let slack = 16.0 * R * (self.numbers[SIZE] * self.numbers[LENGTH] * r);
        let is_inside = |e: usize| {
            let normal = &self.numbers[EDGES + 3 * e..EDGES + 3 * e + 3];
            normal[0] * at[0] + normal[1] * at[1] + normal[2] * at[2] > slack
        };
        (is_in_cell && is_inside(0) && is_inside(1) && is_inside(2)).then_some(at)
    }
}

/// The product of two vectors whose components begin there.
macro_rules! dot {
    ($one:expr, $i:expr; $other:expr, $j:expr; $lane:expr) => {
        $one[$i] * $other[$j][$lane]
            + $one[$i + 1] * $other[$j + 1][$lane]
            + $one[$i + 2] * $other[$j + 2][$lane]
    };
}

/// Which corners of others are one of this one, 1 for each that is.
#[inline(always)]
fn equal(one: &[f64; NUMBERS], others: &[[f64; LANES]; NUMBERS], corner: usize) -> [[u64; LANES]; 3] {
    let mut equal = [[0; LANES]; 3];
    for (equal, others) in equal.iter_mut().zip(&others[INDICES..INDICES + 3]) {
        for i in 0..LANES {
            equal[i] = u64::from(one[INDICES + corner] == others[i]);
        }
    }
    equal
}

impl Pyramids {
    /// None.
    pub fn new() -> Pyramids {
        Pyramids([[f64::NAN; LANES]; NUMBERS])
    }

    /// Takes one in.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, pyramid: &Pyramid) {
        for (numbers, &number) in self.0.iter_mut().zip(&pyramid.numbers) {
            numbers[lane] = number;
        }
    }

    /// What they are to one in a cell.
    ///
    /// A corner of both is exactly on the planes that it makes. The other is harmless if a plane through the light and an edge of either parts the two
    /// and holds nothing of them but what both share, where neither is before the other; or if it lies on or behind the plane of the one; or the one on
    /// or before the plane of the other; or the other plane is behind this one in all of the cell.
    #[inline(always)]
    pub fn relations(&self, one: &Pyramid, place: &Place, found: &mut Relations) {
        let (one, others, Place([x, y, r])) = (&one.numbers, &self.0, *place);
        let (m, e) = (one[SIZE], one[LENGTH]);
        let (exact, along_axes) = (u64::from(one[EXACT] != 0.0), u64::from(one[ALONG_AXES] != 0.0));
        let same = [equal(one, others, 0), equal(one, others, 1), equal(one, others, 2)];
        let mut parted = [0u64; LANES];
        // Corner c of the other is beyond edge e of the one, or on it as one of its ends.
        let mut beyond = [[[0u64; LANES]; 3]; 3];
        for edge in 0..3 {
            let next = if edge == 2 { 0 } else { edge + 1 };
            for c in 0..3 {
                for i in 0..LANES {
                    let slack = 16.0 * R * (m * e * others[SIZE][i]);
                    let at = dot!(one, EDGES + 3 * edge; others, 3 * c; i);
                    beyond[edge][c][i] = u64::from(at < -slack) | same[edge][c][i] | same[next][c][i];
                }
            }
            for i in 0..LANES {
                parted[i] |= beyond[edge][0][i] & beyond[edge][1][i] & beyond[edge][2][i];
            }
        }
        for edge in 0..3 {
            let next = if edge == 2 { 0 } else { edge + 1 };
            for i in 0..LANES {
                let slack = 16.0 * R * (others[SIZE][i] * others[LENGTH][i] * m);
                let at = [
                    dot!(one, 0; others, EDGES + 3 * edge; i),
                    dot!(one, 3; others, EDGES + 3 * edge; i),
                    dot!(one, 6; others, EDGES + 3 * edge; i),
                ];
                let (mut inside, mut outside) = (1, 1);
                for c in 0..3 {
                    let is_on = same[c][edge][i] | same[c][next][i];
                    inside &= u64::from(at[c] > slack) | is_on;
                    outside &= u64::from(at[c] < -slack) | is_on;
                }
                parted[i] |= outside;
                let mut passes = inside | outside;
                for of_edge in &beyond {
                    passes |= of_edge[edge][i] & of_edge[next][i];
                }
                found.cuts[edge][i] = (passes ^ 1) as u32;
            }
        }
        for i in 0..LANES {
            let (n, f) = (others[SIZE][i], others[LENGTH][i]);
            let (of_one, of_other) = (24.0 * R * (e * e * (m + n)), 24.0 * R * (f * f * (m + n)));
            let (mut other_behind, mut other_before) = (1, 1);
            let (mut one_behind, mut one_before) = (1, 1);
            for c in 0..3 {
                let other_at = dot!(one, PLANE; others, 3 * c; i) - one[VOLUME];
                let one_at = dot!(one, 3 * c; others, PLANE; i) - others[VOLUME][i];
                let is_shared_by_other = same[0][c][i] | same[1][c][i] | same[2][c][i];
                let is_shared_by_one = same[c][0][i] | same[c][1][i] | same[c][2][i];
                let is_on_one = u64::from(other_at == 0.0) & along_axes & u64::from(others[EXACT][i] != 0.0);
                let is_on_other = u64::from(one_at == 0.0) & exact & u64::from(others[ALONG_AXES][i] != 0.0);
                other_behind &= u64::from(other_at > of_one) | is_shared_by_other | is_on_one;
                other_before &= u64::from(other_at < -of_one);
                one_before &= u64::from(one_at < -of_other) | is_shared_by_one | is_on_other;
                one_behind &= u64::from(one_at > of_other);
            }
            // By how much the other is nearer, over both volumes.
            let (v, u) = (one[VOLUME], others[VOLUME][i]);
            let a = v * others[PLANE][i] - u * one[PLANE];
            let b = v * others[PLANE + 1][i] - u * one[PLANE + 1];
            let c = v * others[PLANE + 2][i] - u * one[PLANE + 2];
            let (at, change) = (a * x + b * y + c * r, a.abs() + b.abs());
            let slack = 32.0 * R * ((e * e) * (f * f) * (m + n) * r);
            let is_nearer = u64::from(at - change > slack);
            let is_farther = u64::from(at + change < -slack);
            found.before[i] = (other_before | one_behind | is_nearer) as u32;
            found.harmless[i] = (parted[i] | other_behind | one_before | is_farther) as u32;
        }
    }

    /// Which of them cover a direction in half cells, off their edges, 1 for each.
    #[inline(always)]
    pub fn cover(&self, at: [f64; 3], inside: &mut [u32; LANES]) {
        let numbers = &self.0;
        for (i, inside) in inside.iter_mut().enumerate() {
            let slack = 16.0 * R * (numbers[SIZE][i] * numbers[LENGTH][i] * at[2]);
            let mut is_inside = true;
            for e in 0..3 {
                is_inside &= dot!(at, 0; numbers, EDGES + 3 * e; i) > slack;
            }
            *inside = u32::from(is_inside);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::occlusion::PreciseQuery;
    use crate::geometry::{ExactPosition, LightSpace, Sign, planes};
    use glam::Vec3;
    use proptest::prelude::*;

    /// Before a light in the origin, with few bits: many of them are on a plane or a line.
    fn corner() -> impl Strategy<Value = Vec3> {
        (-6i8..7, -6i8..7, 8i8..14).prop_map(|(x, y, z)| Vec3::new(x.into(), y.into(), z.into()) * 0.125)
    }

    /// Two triangles of six vertices, some of which are vertices of both.
    fn situation() -> impl Strategy<Value = ([Vec3; 6], [[u32; 3]; 2])> {
        let triangle =
            || Just(vec![0u32, 1, 2, 3, 4, 5]).prop_shuffle().prop_map(|all| [all[0], all[1], all[2]]);
        (prop::array::uniform6(corner()), [triangle(), triangle()])
    }

    fn blocks(point: Vec3, corners: [Vec3; 3]) -> bool {
        let space = LightSpace::from(Vec3::ZERO);
        PreciseQuery::new(&space, point.as_dvec3(), || ExactPosition::Bare(point)).blocks(corners).0
    }

    /// Points of a triangle, corners and edges among them, that f32 holds.
    fn points([a, b, c]: [Vec3; 3]) -> impl Iterator<Item = Vec3> {
        let weights = (0..=8).flat_map(|i| (0..=8 - i).map(move |j| (i as f32 / 8.0, j as f32 / 8.0)));
        weights.map(move |(s, t)| a + s * (b - a) + t * (c - a))
    }

    fn is_strictly_inside(direction: Vec3, corners: [Vec3; 3]) -> bool {
        let [a, b, c] = planes::oriented(Vec3::ZERO, corners).expect("not edge-on");
        [[a, b], [b, c], [c, a]]
            .into_iter()
            .all(|[p, q]| planes::orientation(Vec3::ZERO, [p, q, direction]) == Sign::Positive)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(6000))]
        #[test]
        fn what_is_certain_of_two_triangles_is_so(
            (vertices, indices) in situation(),
            resolution in prop::sample::select(vec![1u32, 2, 3, 8]),
            cell in [0.0f64..1.0, 0.0..1.0],
            offset in prop::sample::select(vec![0.0f32, 0.1, 1e-7]),
        ) {
            let vertices = vertices.map(|vertex| Vec3::new(vertex.x, vertex.y, vertex.z + offset));
            let corners = indices.map(|indices| indices.map(|index| vertices[index as usize]));
            prop_assume!(corners.iter().all(|&corners| planes::oriented(Vec3::ZERO, corners).is_some()));
            let pyramid = |i: usize| Pyramid::new(Base {
                corners: corners[i].map(Vec3::as_dvec3), light: DVec3::ZERO, indices: indices[i],
            });
            let r = f64::from(resolution);
            let [x, y] = cell.map(|at| (at * r).floor() * 2.0 + 1.0 - r);
            let place = Place([x, y, r]);
            let in_cell = |p: Vec3| {
                let p = p.as_dvec3();
                ((p.x * r - x * p.z).abs() <= p.z) && ((p.y * r - y * p.z).abs() <= p.z)
            };
            let one = pyramid(0);
            let mut others = Pyramids::new();
            others.set(5, &pyramid(1));
            let (mut relations, mut inside) = (Relations::default(), [0; LANES]);
            others.relations(&one, &place, &mut relations);
            for lane in (0..LANES).filter(|lane| *lane != 5) {
                prop_assert_eq!(relations.before[lane] | relations.harmless[lane], 0, "nothing is there");
            }
            for point in points(corners[0]).filter(|&point| in_cell(point)) {
                let is_blocked = blocks(point, corners[1]);
                prop_assert!(relations.harmless[5] == 0 || !is_blocked, "{point}");
                prop_assert!(relations.before[5] == 0 || is_blocked || !blocks(8.0 * point, corners[1]), "{point}");
            }
            for edge in 0..3 {
                let (p, q) = (corners[1][edge], corners[1][(edge + 1) % 3]);
                for step in 0..=16 {
                    let point = p + (q - p) * (step as f32 / 16.0);
                    let passes = relations.cuts[pyramid(1).edge(edge)][5] == 0;
                    prop_assert!(!passes || offset != 0.0 || !is_strictly_inside(point, corners[0]), "{point}");
                }
            }
            if let Some(at) = one.inside(&place) {
                let direction = DVec3::from(at).as_vec3();
                others.set(6, &one);
                others.cover(at, &mut inside);
                prop_assert!(inside[6] == 1 && (at[0] - x).abs() <= 1.0 && (at[1] - y).abs() <= 1.0);
                if DVec3::from(at) == direction.as_dvec3() {
                    prop_assert!(inside[5] == 0 || is_strictly_inside(direction, corners[1]));
                }
            }
        }
    }

    #[test]
    fn a_wall_that_stands_on_the_ground_is_not_shadowed_by_it() {
        let ground = [[-4.0, 2.0, 1.0], [4.0, 2.0, 1.0], [0.0, 2.0, 9.0]];
        let wall = [[-1.0, 2.0, 4.0], [1.0, 2.0, 4.0], [0.0, 1.0, 4.0]];
        let pyramid = |corners: [[f64; 3]; 3], first| {
            Pyramid::new(Base {
                corners: corners.map(DVec3::from),
                light: DVec3::ZERO,
                indices: [first, first + 1, first + 2],
            })
        };
        let (ground, wall) = (pyramid(ground, 0), pyramid(wall, 3));
        let mut others = Pyramids::new();
        others.set(0, &ground);
        others.set(1, &wall);
        let (place, mut relations) = (Place([0.0, 0.0, 1.0]), Relations::default());
        others.relations(&wall, &place, &mut relations);
        assert_eq!(relations.harmless[..2], [1, 1]);
        others.relations(&ground, &place, &mut relations);
        assert_eq!(
            (relations.harmless[..2].to_vec(), relations.before[..2].to_vec()),
            (vec![1, 0], vec![0, 0])
        );
    }
}
