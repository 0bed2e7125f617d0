//! Lists against the exact overlap of triangles and cells.

use super::cube::Face;
use super::*;
use crate::geometry::LightPosition;
use crate::scene::{ObjectInput, SceneBuilder};
use crate::shadow::SceneIndex;
use dashu_int::IBig;
use glam::Vec3;
use proptest::prelude::*;

mod contents;

/// Coordinates are integers, so that small integers decide everything exactly.
fn scene(triangles: &[[[i8; 3]; 3]]) -> Scene {
    let mut builder = SceneBuilder::new("test");
    for corners in triangles {
        let positions = corners.map(|p| Vec3::from(p.map(f32::from))).to_vec();
        let input = ObjectInput::new("t", positions, vec![[0, 1, 2]]);
        builder.add_object(input).unwrap();
    }
    builder.finish()
}

fn build<'a>(scene: &'a Scene, index: &'a SceneIndex, resolution: u32) -> LightBuffer<'a> {
    build_for(Vec3::ZERO.into(), scene, index, resolution)
}

fn build_for<'a>(
    light: LightPosition,
    scene: &'a Scene,
    index: &'a SceneIndex,
    resolution: u32,
) -> LightBuffer<'a> {
    let input = BuildInput {
        resolution: Resolution::Cells(resolution),
        // Nothing may be left out of the lists but what full occlusions cut off.
        receivers: Receivers::Anywhere,
        ..BuildInput::new(scene, index, light)
    };
    LightBuffer::new(&input).unwrap()
}

type Integers = [i64; 3];

fn cross(a: Integers, b: Integers) -> Integers {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Integers, b: Integers) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Whether two closed convex cones with these extreme rays share a ray: either some ray of one lies in the
/// other, or two of their sides cross. All in integers.
fn cones_meet(a: &[Integers], b: &[Integers]) -> bool {
    let faces = |rays: &[Integers]| -> Vec<Integers> {
        let centre = rays.iter().fold([0; 3], |s, r| [s[0] + r[0], s[1] + r[1], s[2] + r[2]]);
        (0..rays.len())
            .map(|i| cross(rays[i], rays[(i + 1) % rays.len()]))
            .map(|n| if dot(n, centre) < 0 { n.map(|x| -x) } else { n })
            .collect()
    };
    let (fa, fb) = (faces(a), faces(b));
    let holds = |faces: &[Integers], ray: Integers| faces.iter().all(|&n| dot(n, ray) >= 0);
    if a.iter().any(|&r| holds(&fb, r)) || b.iter().any(|&r| holds(&fa, r)) {
        return true;
    }
    // The line where two sides cross, in both directions, in both cones.
    fa.iter().any(|&m| {
        fb.iter().any(|&n| {
            let line = cross(m, n);
            [line, line.map(|x| -x)].into_iter().any(|l| l != [0; 3] && holds(&fa, l) && holds(&fb, l))
        })
    })
}

/// Whether two closed convex polygons have a point in common: unless the line of a side separates them. Exact
/// for coordinates whose products f64 holds.
fn polygons_meet(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let separates = |polygon: &[[f64; 2]], other: &[[f64; 2]]| {
        (0..polygon.len()).any(|i| {
            let (p, q) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            let side = |r: &[f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            let inner = polygon.iter().map(side).fold(0.0, |s: f64, v| if v.abs() > s.abs() { v } else { s });
            other.iter().all(|r| side(r) * inner.signum() < 0.0)
        })
    };
    !separates(a, b) && !separates(b, a)
}

impl sheet::Sheet {
    /// x' and y' of a point times the resolution and the largest component of the light's direction: integers
    /// for the scenes of these tests.
    fn scaled(&self, p: glam::DVec3, resolution: u32) -> [f64; 2] {
        let p = p - self.origin.as_dvec3();
        let [.., along] = self.axes;
        let direction = self.direction.as_dvec3();
        [0, 1].map(|i| {
            let own = self.axes[i];
            f64::from(resolution) * (p[own] * direction[along] - p[along] * direction[own])
        })
    }

    /// The corners of a cell in the same units.
    fn scaled_cell(&self, column: u32, row: u32, resolution: u32) -> [[f64; 2]; 4] {
        let [.., along] = self.axes;
        let steepness = f64::from(self.direction[along]);
        let border =
            |i: usize, k: u32| (2.0 * f64::from(k) - f64::from(resolution)) * self.extent(i) * steepness;
        [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(di, dj)| [border(0, column + di), border(1, row + dj)])
    }
}

/// The four corner rays of a cell in world space.
fn cell_rays(face: Face, column: u32, row: u32, resolution: u32) -> Vec<Integers> {
    let (r, i, j) = (i64::from(resolution), i64::from(column), i64::from(row));
    let border = |k: i64| 2 * k - r;
    [(0, 0), (1, 0), (1, 1), (0, 1)]
        .map(|(di, dj)| {
            let local = [border(i + di), border(j + dj), r];
            let axis = |v: glam::DVec3| face.coordinates(v);
            // The face's axes are a signed permutation of the world's.
            let mut world = [0; 3];
            for (k, slot) in world.iter_mut().enumerate() {
                let mut unit = [0.0; 3];
                unit[k] = 1.0;
                let in_face = axis(glam::DVec3::from_array(unit));
                *slot = (0..3).map(|m| in_face[m] as i64 * local[m]).sum();
            }
            world
        })
        .to_vec()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn every_cell_that_a_triangle_meets_lists_it_or_lies_behind_a_cover(
        triangles in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-4i8..5)), 1..5),
        resolution in prop::sample::select(vec![1u32, 2, 3, 5, 8]),
    ) {
        let scene = scene(&triangles);
        let index = SceneIndex::new(&scene);
        let buffer = build(&scene, &index, resolution);
        buffer.validate().map_err(TestCaseError::fail)?;
        for (caster, &primitive) in buffer.casters.primitives.iter().enumerate() {
            let corners = scene.corners(primitive).map(|p| p.to_array().map(|x| x as i64));
            for face in Face::ALL {
                for row in 0..resolution {
                    for column in 0..resolution {
                        let cell = cell_rays(face, column, row, resolution);
                        if !cones_meet(&corners, &cell) {
                            continue;
                        }
                        let stored = buffer.sides[face.index()].as_ref();
                        let found = stored.and_then(|lists| {
                            let (full_occlusion, list) = lists.list(lists.cell(column, row)?);
                            Some(list.iter().any(|r| r.caster as usize == caster) || full_occlusion < f32::INFINITY)
                        });
                        prop_assert_eq!(found, Some(true), "caster {} in cell {:?} {} {}", caster, face, column, row);
                    }
                }
            }
        }
    }

    #[test]
    fn lists_are_those_of_casting_on_all_sides(
        triangles in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-4i8..5)), 1..20),
        resolution in prop::sample::select(vec![1u32, 2, 3, 8, 33]),
    ) {
        let scene = scene(&triangles);
        let index = SceneIndex::new(&scene);
        let input = BuildInput::new(&scene, &index, Vec3::ZERO);
        let casters = Casters::new(&scene, &index, input.light);
        let cells = Cells::new(&casters.space, std::iter::empty());
        // Every third triangle is there to be asked about.
        let receiving: Vec<_> = (0..scene.triangles.len() as u32).step_by(3).collect();
        let coherent = build::build(&input, &casters, &receiving, &cells, resolution).unwrap();
        let on_all = build::build_on(&input, &casters, &receiving, &cells, resolution, |_| u8::MAX).unwrap();
        prop_assert_eq!(coherent, on_all);
    }

    #[test]
    fn every_cell_of_a_sheet_that_a_triangle_meets_lists_it_or_lies_behind_a_cover(
        triangles in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-4i8..5)), 1..5),
        direction in prop::array::uniform3(-3i8..4),
        resolution in prop::sample::select(vec![1u32, 2, 3, 5, 8]),
    ) {
        prop_assume!(direction != [0; 3]);
        let scene = scene(&triangles);
        let index = SceneIndex::new(&scene);
        let direction = Vec3::from(direction.map(f32::from));
        let buffer = build_for(LightPosition::Towards(direction), &scene, &index, resolution);
        buffer.validate().map_err(TestCaseError::fail)?;
        let Cells::Sheet(sheet) = buffer.cells else { unreachable!() };
        for (caster, &primitive) in buffer.casters.primitives.iter().enumerate() {
            let corners = scene.corners(primitive).map(|p| sheet.scaled(p.as_dvec3(), resolution));
            for (row, column) in (0..resolution).flat_map(|row| (0..resolution).map(move |c| (row, c))) {
                if !polygons_meet(&corners, &sheet.scaled_cell(column, row, resolution)) {
                    continue;
                }
                let stored = buffer.sides[0].as_ref();
                let found = stored.and_then(|lists| {
                    let (full_occlusion, list) = lists.list(lists.cell(column, row)?);
                    Some(list.iter().any(|r| r.caster as usize == caster) || full_occlusion < f32::INFINITY)
                });
                prop_assert_eq!(found, Some(true), "caster {} in cell {} {}", caster, column, row);
            }
        }
    }

    #[test]
    fn a_full_occlusion_covers_its_cell(
        corners in prop::array::uniform3(prop::array::uniform3(-4i8..5)),
        resolution in 1u32..12,
    ) {
        let scene = scene(&[corners]);
        let index = SceneIndex::new(&scene);
        let buffer = build(&scene, &index, resolution);
        for face in Face::ALL {
            let Some(lists) = &buffer.sides[face.index()] else { continue };
            for (row, column) in (0..resolution).flat_map(|row| (0..resolution).map(move |c| (row, c))) {
                let Some(cell) = lists.cell(column, row) else { continue };
                let (depth, _) = lists.list(cell);
                if depth == f32::INFINITY {
                    continue;
                }
                let [a, b, c] = scene.corners(0).map(|p| p.to_array().map(|x| x as i64));
                let volume = dot(a, cross(b, c)).signum();
                for ray in cell_rays(face, column, row, resolution) {
                    for n in [cross(a, b), cross(b, c), cross(c, a)] {
                        prop_assert!(dot(n, ray) * volume >= 0);
                    }
                    // The corner of the cell on the triangle is at most that deep: z' = R h / (N . ray).
                    let normal = cross([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
                    let z = i64::from(resolution) as f64 * dot(normal, a) as f64 / dot(normal, ray) as f64;
                    prop_assert!(z <= f64::from(depth) * (1.0 + 1e-12));
                }
            }
        }
    }
}

#[test]
fn a_convex_solid_of_many_triangles_darkens_a_cell_that_none_of_them_covers() {
    // An octahedron around (0, 0, 4): from the origin four triangles meet in the middle of the +z face.
    let rim = [[2, 0, 4], [0, 2, 4], [-2, 0, 4], [0, -2, 4]];
    let mut positions: Vec<Vec3> = rim.iter().map(|p| Vec3::from(p.map(|x| x as f32))).collect();
    positions.extend([Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.0, 0.0, 6.0)]);
    let triangles = (0..4u32).flat_map(|i| [[i, (i + 1) % 4, 4], [i, (i + 1) % 4, 5]]).collect();
    let mut builder = SceneBuilder::new("octahedron");
    builder.add_object(ObjectInput::new("o", positions, triangles)).unwrap();
    let scene = builder.finish();
    let index = SceneIndex::new(&scene);
    // With odd R the central cell straddles all four front triangles.
    let buffer = build(&scene, &index, 9);
    let lists = buffer.sides[4].as_ref().unwrap();
    let (depth, list) = lists.list(lists.cell(4, 4).unwrap());
    assert!(depth < 4.0, "{depth}");
    assert!(list.iter().all(|r| r.near <= depth));
    let mut answers = [false; 2];
    let points =
        [Vec3::new(0.05, 0.02, 7.0), Vec3::new(0.05, 0.02, 1.0)].map(|p| SurfacePoint::bare(p).unwrap());
    let counters = buffer.occluded(&points, &mut answers).unwrap();
    assert_eq!(answers, [true, false]);
    assert_eq!(counters.full_occlusions, 1);
}

#[test]
fn the_base_surface_is_not_tested() {
    // One object of two triangles; the second crosses the plane of the first, far aside, so that the object
    // is not convex and no other rule leaves its triangles out.
    let corners = [[-4, -4, 3], [4, -4, 3], [0, 4, 3], [90, 0, 1], [90, 1, 5], [91, 0, 4]];
    let positions = corners.map(|p: [i8; 3]| Vec3::from(p.map(f32::from))).to_vec();
    let mut builder = SceneBuilder::new("two");
    let triangles = vec![[0, 1, 2], [3, 4, 5]];
    builder.add_object(ObjectInput::new("two", positions, triangles)).unwrap();
    let scene = builder.finish();
    let index = SceneIndex::new(&scene);
    assert_eq!(index.convexity(&scene), [None]);
    let buffer = build(&scene, &index, 1);
    let point = SurfacePoint::on_ray(&scene, Vec3::ZERO, Vec3::new(0.1, 0.1, 1.0), 0);
    let mut answer = [true];
    let counters = buffer.occluded(&[point], &mut answer).unwrap();
    assert_eq!((answer, counters.lists, counters.tests), ([false], 1, 0));
}

#[test]
fn a_convex_solid_does_not_test_itself() {
    let mut builder = SceneBuilder::new("tetrahedron");
    let positions = vec![
        Vec3::new(0.0, 0.0, 2.0),
        Vec3::new(2.0, 0.0, 4.0),
        Vec3::new(-1.0, 2.0, 4.0),
        Vec3::new(-1.0, -2.0, 4.0),
    ];
    let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 2, 3]];
    builder.add_object(ObjectInput::new("t", positions, triangles)).unwrap();
    let scene = builder.finish();
    let index = SceneIndex::new(&scene);
    let buffer = build(&scene, &index, 1);
    let point = SurfacePoint::on_ray(&scene, Vec3::ZERO, Vec3::new(0.1, 0.0, 3.0), 0);
    let point_elsewhere = SurfacePoint::on_ray(&scene, Vec3::ZERO, Vec3::new(-0.1, 0.0, 3.0), 1);
    let mut answers = [true; 2];
    let counters = buffer.occluded(&[point, point_elsewhere], &mut answers).unwrap();
    assert_eq!((answers, counters.tests), ([false; 2], 0));
}

#[test]
fn points_in_space_need_a_buffer_built_for_them() {
    let scene = scene(&[[[-4, -4, 3], [4, -4, 3], [0, 4, 3]]]);
    let index = SceneIndex::new(&scene);
    let input = BuildInput::new(&scene, &index, Vec3::ZERO);
    let buffer = LightBuffer::new(&input).unwrap();
    let error = buffer.occluded(&[SurfacePoint::bare(Vec3::Z).unwrap()], &mut [false]).unwrap_err();
    assert!(error.to_string().contains("Receivers::Anywhere"));
}

#[test]
fn integers_of_the_test_do_not_overflow() {
    // The largest products above: corners below 8, cell rays below 16, degree 5.
    let bound = IBig::from(8).pow(3) * IBig::from(16).pow(2) * IBig::from(64);
    assert!(bound < IBig::from(i64::MAX));
}

#[test]
fn depths_bound_the_triangle_from_both_sides() {
    for value in [0.1f64, 1.0 / 3.0, 1.0 + 1e-9, 1.0 - 1e-9, 1e-40, 0.0, 3.4e38] {
        let (low, high) = (build::round_down(value), build::round_up(value));
        assert!(f64::from(low) <= value && value <= f64::from(high), "{value}");
        assert!(high <= low.next_up(), "{value}");
    }
    assert_eq!(build::round_up(f64::INFINITY), f32::INFINITY);
}

#[test]
fn the_resolution_that_is_chosen_is_a_power_of_two_about_the_root() {
    let expected =
        [(0, 32), (1024, 32), (1089, 64), (4096, 64), (5000, 128), (1 << 20, 1024), (1 << 30, 1024)];
    for (casters, cells) in expected {
        assert_eq!(automatic_resolution(casters), cells, "{casters}");
    }
}

#[test]
fn a_cell_beside_what_is_stored_has_no_list() {
    let header = Header { start: 0, full_occlusion: f32::INFINITY };
    let lists = SideLists {
        first: [4, 7],
        count: [3, 2],
        headers: vec![header; 7],
        records: vec![Record { near: 1.0, caster: 0 }; 5],
        groups: CellGroups::default(),
    };
    assert_eq!([lists.cell(4, 7), lists.cell(6, 7), lists.cell(5, 8)], [Some(0), Some(2), Some(4)]);
    assert_eq!([lists.cell(3, 7), lists.cell(7, 7), lists.cell(4, 6), lists.cell(4, 9)], [None; 4]);
    assert_eq!(lists.bytes(), 7 * 8 + 5 * 8);
}
