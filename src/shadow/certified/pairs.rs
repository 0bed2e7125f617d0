//! Queries and triangles that f32 leaves open, in f64, eight pairs at a time.
//!
//! What is computed, and what it is wrong by, is as for one pair (`geometry/planes.rs`, `geometry/occlusion.rs`), but that the side of the
//! triangle's plane on which the light is comes out of f64 too. Where a sign is not certain the pair is decided exactly.

use super::walk::Walk;
use crate::geometry::ROUNDOFF;
use crate::geometry::batch::InstructionSet;
use crate::geometry::dispatch::for_instruction_sets;
use crate::geometry::fetch::fetch;
use crate::geometry::occlusion::PreciseQuery;
use crate::shadow::{Counters, precise};

/// Pairs that are decided at a time.
const LANES: usize = 8;

/// As many as are kept before they are decided, at least.
const MANY: usize = 1024;

/// Queries and triangles of the scene that may block them.
#[derive(Debug, Default)]
pub(super) struct Pairs {
    all: Vec<(u32, u32)>,
}

type Vector = [f64; 3];

/// Eight pairs, number by number.
#[derive(Debug, Default)]
#[repr(C, align(64))]
struct Eight {
    /// Of each corner, axis by axis.
    corners: [[[f64; LANES]; 3]; 3],
    /// Queries, rounded.
    points: [[f64; LANES]; 3],
}

/// What is certain of eight pairs.
#[derive(Debug, Default)]
#[repr(C, align(64))]
struct Decided {
    /// Whether the triangle blocks the query, and whether it does not; neither if that is not certain.
    blocks: [u64; LANES],
    misses: [u64; LANES],
}

impl Pairs {
    /// Whether it is time to decide them.
    #[inline(always)]
    pub fn are_many(&self) -> bool {
        self.all.len() >= MANY
    }

    /// Adds one. What it needs is on its way from memory then.
    #[inline(always)]
    pub fn push(&mut self, walk: &Walk<'_>, query: u32, triangle: u32) {
        fetch(&walk.points[query as usize].position);
        for vertex in walk.scene.triangles[triangle as usize].vertices {
            fetch(&walk.scene.vertices[vertex as usize]);
        }
        self.all.push((query, triangle));
    }

    /// Decides all of them, but those of queries that are dark before their turn.
    pub fn decide(
        &mut self,
        set: InstructionSet,
        walk: &Walk<'_>,
        occluded: &mut [bool],
        counters: &mut Counters,
    ) {
        let light = walk.light.as_dvec3().to_array();
        let (mut eight, mut decided) = (Eight::default(), Decided::default());
        self.all.retain(|&(query, _)| !occluded[query as usize]);
        for pairs in self.all.chunks(LANES) {
            for (lane, &(query, triangle)) in pairs.iter().enumerate() {
                let point = walk.points[query as usize].position.to_array();
                let corners = walk.scene.corners(triangle);
                for axis in 0..3 {
                    eight.points[axis][lane] = point[axis];
                    for (corner, of_corner) in corners.iter().zip(&mut eight.corners) {
                        of_corner[axis][lane] = f64::from(corner[axis]);
                    }
                }
            }
            decide(set, light, &eight, &mut decided);
            counters.undecided += pairs.len() as u64;
            for (lane, &(query, triangle)) in pairs.iter().enumerate() {
                let is_dark = &mut occluded[query as usize];
                if decided.misses[lane] == 0 && !*is_dark {
                    *is_dark = decided.blocks[lane] == 1 || blocks_exactly(walk, query, triangle, counters);
                }
            }
        }
        self.all.clear();
    }
}

/// Whether a triangle blocks a query.
#[cold]
fn blocks_exactly(walk: &Walk<'_>, query: u32, triangle: u32, counters: &mut Counters) -> bool {
    let point = &walk.points[query as usize];
    let query = PreciseQuery::new(walk.space, point.position, || point.exact(walk.scene));
    precise::blocks(walk.scene, triangle, point.primitive(), &query, counters)
}

/// A plane: its normal, and what the sizes of the terms of each component are together.
#[derive(Clone, Copy)]
struct Plane {
    normal: Vector,
    size: Vector,
}

#[inline(always)]
fn at(of: &[[f64; LANES]; 3], lane: usize) -> Vector {
    [of[0][lane], of[1][lane], of[2][lane]]
}

#[inline(always)]
fn difference(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn plane(a: Vector, b: Vector) -> Plane {
    let (ayz, azy) = (a[1] * b[2], a[2] * b[1]);
    let (azx, axz) = (a[2] * b[0], a[0] * b[2]);
    let (axy, ayx) = (a[0] * b[1], a[1] * b[0]);
    Plane {
        normal: [ayz - azy, azx - axz, axy - ayx],
        size: [ayz.abs() + azy.abs(), azx.abs() + axz.abs(), axy.abs() + ayx.abs()],
    }
}

/// The scalar product of a normal with a vector, and its bound: each component of the vector is wrong by twice a roundoff of its own size and of
/// `of`'s.
#[inline(always)]
fn product(plane: &Plane, v: Vector, of: Vector) -> [f64; 2] {
    let n = plane.normal;
    let value = (n[0] * v[0] + n[1] * v[1]) + n[2] * v[2];
    let (x, y, z) = (v[0].abs(), v[1].abs(), v[2].abs());
    let error = [
        x * (16.0 * ROUNDOFF) + of[0].abs() * (4.0 * ROUNDOFF),
        y * (16.0 * ROUNDOFF) + of[1].abs() * (4.0 * ROUNDOFF),
        z * (16.0 * ROUNDOFF) + of[2].abs() * (4.0 * ROUNDOFF),
    ];
    let bound = (plane.size[0] * error[0] + plane.size[1] * error[1]) + plane.size[2] * error[2];
    [value, bound * (1.0 + 8.0 * ROUNDOFF) + 1e-300]
}

#[inline(always)]
fn decide_body(_: InstructionSet, light: Vector, eight: &Eight, decided: &mut Decided) {
    for i in 0..LANES {
        let (a, b, c) = (at(&eight.corners[0], i), at(&eight.corners[1], i), at(&eight.corners[2], i));
        let p = at(&eight.points, i);
        let (ab, bc, ca) = (difference(b, a), difference(c, b), difference(a, c));
        let from_light = difference(p, light);
        let la = difference(a, light);
        let edges = [
            product(&plane(la, ab), from_light, p),
            product(&plane(difference(b, light), bc), from_light, p),
            product(&plane(difference(c, light), ca), from_light, p),
        ];
        let own = plane(ab, difference(c, a));
        let [volume, volume_error] = product(&own, la, [0.0; 3]);
        let [height, height_error] = product(&own, difference(p, a), p);
        // What is positive inside is negative where corners go round the other way.
        let sign = if volume < 0.0 { -1.0 } else { 1.0 };
        let (mut is_inside, mut is_outside) = (true, false);
        for edge in &edges {
            is_inside &= sign * edge[0] > edge[1];
            is_outside |= sign * edge[0] < -edge[1];
        }
        let is_known = volume.abs() > volume_error;
        let is_behind = sign * height > height_error;
        let is_before = sign * height < -height_error;
        decided.blocks[i] = u64::from(is_known & is_inside & is_behind);
        decided.misses[i] = u64::from(is_known & (is_outside | is_before));
    }
}

for_instruction_sets! {
    fn decide = decide_body, (light: Vector, eight: &Eight, decided: &mut Decided)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{ExactPosition, LightSpace};
    use glam::{DVec3, Vec3};
    use proptest::prelude::*;

    fn vertex() -> impl Strategy<Value = Vec3> {
        let few = (-4i8..5, -4i8..5, -4i8..5)
            .prop_map(|(x, y, z)| Vec3::new(f32::from(x), f32::from(y), f32::from(z)));
        prop_oneof![few, prop::array::uniform3(-4.0f32..4.0).prop_map(Vec3::from)]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        /// Points are inside of triangles and beside them, and where the light sees their corners and edges.
        #[test]
        fn what_is_certain_is_true(
            light in vertex(),
            triangles in prop::collection::vec([vertex(), vertex(), vertex()], LANES),
            places in prop::collection::vec((0u8..5, 0u8..5, prop::sample::select(vec![0.5f32, 1.0, 1.5, 2.0])), LANES),
        ) {
            let mut eight = Eight::default();
            let mut points = Vec::new();
            for (lane, ([a, b, c], &(i, j, far))) in triangles.iter().zip(&places).enumerate() {
                let (i, j) = (f32::from(i) / 4.0, f32::from(j) / 4.0);
                let point = light + ((*a + i * (*b - *a) + j * (*c - *a)) - light) * far;
                points.push(point);
                for axis in 0..3 {
                    eight.points[axis][lane] = f64::from(point[axis]);
                    for (corner, at) in [a, b, c].into_iter().zip(&mut eight.corners) {
                        at[axis][lane] = f64::from(corner[axis]);
                    }
                }
            }
            let of_set = |set: InstructionSet| {
                let mut decided = Decided::default();
                decide(set, light.as_dvec3().to_array(), &eight, &mut decided);
                [decided.blocks, decided.misses]
            };
            let [blocks, misses] = of_set(InstructionSet::Portable);
            for set in [InstructionSet::Avx2, InstructionSet::Avx512].into_iter().filter(|set| set.is_available()) {
                prop_assert_eq!(of_set(set), [blocks, misses]);
            }
            let space = LightSpace::from(light);
            for (lane, (&corners, &point)) in triangles.iter().zip(&points).enumerate() {
                let query = PreciseQuery::new(&space, point.as_dvec3(), || ExactPosition::Bare(point));
                let (truth, _) = query.blocks(corners);
                prop_assert!(blocks[lane] == 0 || truth, "{} is blocked by none", point);
                prop_assert!(misses[lane] == 0 || !truth, "{} is blocked", point);
            }
        }
    }

    #[test]
    fn most_pairs_are_certain() {
        let mut eight = Eight::default();
        let corners = [DVec3::new(-1.0, -1.0, 2.0), DVec3::new(1.0, -1.0, 2.0), DVec3::new(0.0, 1.0, 2.0)];
        for lane in 0..LANES {
            let point = match lane {
                0..4 => DVec3::new(0.0, 1e-9 * lane as f64, 2.0 + 1e-9),
                4..6 => DVec3::new(0.0, 0.0, 2.0 - 1e-9),
                6 => DVec3::new(0.0, 1.0 + 1e-9, 2.0),
                // On an edge as f64 sees it.
                _ => DVec3::new(0.0, 2.0, 4.0),
            };
            for axis in 0..3 {
                eight.points[axis][lane] = point[axis];
                for (corner, at) in corners.iter().zip(&mut eight.corners) {
                    at[axis][lane] = corner[axis];
                }
            }
        }
        let mut decided = Decided::default();
        decide(InstructionSet::Portable, [0.0; 3], &eight, &mut decided);
        assert_eq!(decided.blocks, [1, 1, 1, 1, 0, 0, 0, 0]);
        assert_eq!(decided.misses, [0, 0, 0, 0, 1, 1, 1, 0]);
    }
}
