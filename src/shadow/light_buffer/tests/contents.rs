//! What small buffers hold and what queries to them cost, counted by hand.

use super::*;
use crate::geometry::curved::{InfinitePlane, Shape, Sphere};
use crate::geometry::footprint::Footprint;
use crate::geometry::planes::{OrientedPlanes, oriented};
use crate::scene::{AlphaMask, Coverage, Material, Shadowing, TextureCoordinates, Transmission, Wrap};
use crate::shadow::light_buffer::cells::side_grid;
use crate::shadow::{Culling, VolumeThreshold};

/// A triangle across the z axis, `half` wide.
fn across(z: f32, half: f32) -> Vec<Vec3> {
    [(-half, -half), (half, -half), (0.0, half)].map(|(x, y)| Vec3::new(x, y, z)).to_vec()
}

fn triangle(corners: Vec<Vec3>) -> ObjectInput {
    ObjectInput::new("t", corners, vec![[0, 1, 2]])
}

fn with_curved(shape: Shape) -> ObjectInput {
    ObjectInput { curved: vec![shape], ..ObjectInput::new("c", vec![], vec![]) }
}

fn of_objects(objects: Vec<ObjectInput>) -> Scene {
    let mut builder = SceneBuilder::new("test");
    objects.into_iter().for_each(|object| builder.add_object(object).unwrap());
    builder.finish()
}

/// A buffer for points anywhere, around a light in the origin.
fn anywhere<'a>(scene: &'a Scene, index: &'a SceneIndex, cells: u32) -> BuildInput<'a> {
    BuildInput {
        resolution: Resolution::Cells(cells),
        receivers: Receivers::Anywhere,
        ..BuildInput::new(scene, index, Vec3::ZERO)
    }
}

fn ask(buffer: &LightBuffer<'_>, points: &[Vec3]) -> (Vec<bool>, Counters) {
    let points: Vec<_> = points.iter().map(|&p| SurfacePoint::bare(p).unwrap()).collect();
    let mut answers = vec![false; points.len()];
    let counters = buffer.occluded(&points, &mut answers).unwrap();
    (answers, counters)
}

/// The least full-occlusion depth of all cells.
fn nearest_cover(buffer: &LightBuffer<'_>) -> f32 {
    let headers = buffer.sides.iter().flatten().flat_map(|lists| &lists.headers);
    headers.map(|header| header.full_occlusion).fold(f32::INFINITY, f32::min)
}

#[test]
fn a_query_looks_up_one_cell_exactly_where_it_must() {
    let scene = of_objects(vec![triangle(across(3.0, 0.25))]);
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 4)).unwrap();
    // In cells with and without a list, on a side without any, and on the border between cells, where one is found
    // by exact signs.
    let inside = [Vec3::new(0.1, 0.2, 5.0), Vec3::new(4.0, 4.5, 5.0), Vec3::new(5.0, 0.1, 0.2)];
    let (answers, counters) = ask(&buffer, &inside);
    assert_eq!((answers, counters.cells, counters.exact), (vec![true, false, false], 3, 0));
    let border = [Vec3::new(0.0, 4.5, 5.0), Vec3::new(2.5, 4.5, 5.0)];
    let (_, counters) = ask(&buffer, &border);
    assert_eq!((counters.cells, counters.exact), (2, 2));
}

#[test]
fn what_has_no_end_blocks_without_a_list() {
    let ground = InfinitePlane { point: Vec3::Y * -2.0, normal: Vec3::Y };
    let scene = of_objects(vec![with_curved(Shape::Plane(ground)), triangle(across(3.0, 0.25))]);
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 4)).unwrap();
    let (answers, counters) = ask(&buffer, &[Vec3::new(9.0, -3.0, 7.0), Vec3::new(9.0, -1.0, 7.0)]);
    // The first one never gets to a cell.
    assert_eq!((answers, counters.cells), (vec![true, false], 1));
}

#[test]
fn only_what_is_there_everywhere_and_blocks_covers_cells() {
    let wide = || triangle(across(3.0, 40.0));
    let cover = |scene: &Scene, receivers: Receivers| {
        let index = SceneIndex::new(scene);
        let input = BuildInput { receivers, ..anywhere(scene, &index, 1) };
        let buffer = LightBuffer::new(&input).unwrap();
        let counts = buffer.counts();
        assert_eq!(buffer.occupancy().full_occlusions, counts.full_occlusions);
        assert_eq!(counts.sides, buffer.sides.iter().flatten().count() as u64);
        nearest_cover(&buffer)
    };
    let depth = cover(&of_objects(vec![wide()]), Receivers::Anywhere);
    assert!(depth > 3.0 && depth < 3.001, "{depth}");
    let mut builder = SceneBuilder::new("masked");
    let mask = builder.add_alpha_mask(AlphaMask::new(2, 1, [Wrap::Repeat; 2], |column, _| column == 0));
    let material = builder.add_material(Material { coverage: Coverage::Masked(mask), ..Material::default() });
    let coordinates = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let texture_coordinates = Some(TextureCoordinates { coordinates, corners: vec![[0, 1, 2]] });
    builder.add_object(ObjectInput { material, texture_coordinates, ..wide() }).unwrap();
    assert_eq!(cover(&builder.finish(), Receivers::Anywhere), f32::INFINITY);
    // What only receives covers nothing, in front of what blocks.
    let shadowing = Shadowing { casts: false, ..Shadowing::default() };
    let small = triangle(across(4.0, 0.25));
    let scene = of_objects(vec![ObjectInput { shadowing, ..wide() }, small]);
    assert_eq!(cover(&scene, Receivers::Surfaces), f32::INFINITY);
}

/// A wide transparent triangle before a small one of glass and an opaque one.
fn glass() -> Scene {
    let mut builder = SceneBuilder::new("glass");
    let transmission = Some(Transmission { transmittance: [0.5; 3], refractive_index: 1.0 });
    let material = builder.add_material(Material { transmission, ..Material::default() });
    for (z, half) in [(3.0, 40.0), (4.0, 0.25)] {
        builder.add_object(ObjectInput { material, ..triangle(across(z, half)) }).unwrap();
    }
    builder.add_object(triangle(across(6.0, 0.25))).unwrap();
    builder.finish()
}

#[test]
fn glass_covers_nothing_and_is_crossed_in_the_order_of_its_depth() {
    let scene = glass();
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 1)).unwrap();
    let transparent = buffer.transparent.as_ref().unwrap();
    let headers = || transparent.sides.iter().flatten().flat_map(|lists| &lists.headers);
    assert!(headers().all(|header| header.full_occlusion == f32::INFINITY));
    let crossed = |points: &[Vec3]| {
        let points: Vec<_> = points.iter().map(|&p| SurfacePoint::bare(p).unwrap()).collect();
        let mut crossings = Crossings::default();
        let counters = buffer.crossed(&points, &mut crossings).unwrap();
        let found: Vec<_> = (0..points.len()).map(|i| crossings.of(i).to_vec()).collect();
        (found, counters)
    };
    let (x, y) = (0.01, 0.02);
    let places = [2.0, 3.5, 5.0].map(|z| Vec3::new(x * z, y * z, z));
    let (found, counters) = crossed(&places);
    assert_eq!(found, [vec![], vec![0u32], vec![0, 1]]);
    // Lists are left at the first record behind the point.
    assert_eq!((counters.cells, counters.exact, counters.tests), (3, 0, 3));
    // On the border between sides; that of the cell is found exactly.
    let (found, counters) = crossed(&[Vec3::new(5.0, 0.5, 5.0)]);
    assert_eq!((found, counters.cells), (vec![vec![0]], 1));
    assert!(counters.exact >= 1);
    // Beside the light nothing is crossed.
    assert!(crossed(&[Vec3::ZERO]).0[0].is_empty());
    assert_eq!(buffer.counts().transparent_records, transparent.records());
}

#[test]
fn a_sphere_is_listed_once_and_covers_what_is_inside_of_it() {
    let sphere = Sphere { centre: Vec3::Z * 8.0, radius: 4.0 };
    let scene = of_objects(vec![with_curved(Shape::Sphere(sphere))]);
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 15)).unwrap();
    let counts = buffer.counts();
    assert_eq!((counts.longest_list, counts.records, counts.sides), (1, counts.non_empty, 1));
    let lists = buffer.sides[4].as_ref().unwrap();
    let (cover, list) = lists.list(lists.cell(7, 7).unwrap());
    // The polygon inside touches where tangents do: 8 - 4 * 4 / 8 = 6 away.
    assert!(cover > 5.9 && cover < 6.1, "{cover}");
    assert!(list[0].near > 3.0 && list[0].near < 4.0, "{}", list[0].near);
    let (answers, counters) = ask(&buffer, &[Vec3::new(0.0, 0.0, 13.0), Vec3::new(0.0, 0.0, 3.0)]);
    assert_eq!((answers, counters.full_occlusions), (vec![true, false], 1));
    // Where it does not cover the cell it is tested in floats.
    let beside = 13.0 * 0.5;
    let (answers, counters) = ask(&buffer, &[Vec3::new(beside, 0.0, 13.0)]);
    assert_eq!((answers, counters.tests, counters.undecided), (vec![true], 1, 0));
    // A light inside of its hull has it before every cell.
    let inside = of_objects(vec![with_curved(Shape::sphere(Vec3::X, 2.0))]);
    let index = SceneIndex::new(&inside);
    let buffer = LightBuffer::new(&anywhere(&inside, &index, 2)).unwrap();
    let records = || buffer.sides.iter().flatten().flat_map(|lists| &lists.records);
    assert!(records().count() == 24 && records().all(|record| record.near == 0.0));
}

#[test]
fn a_test_that_floats_leave_open_is_counted() {
    let scene = of_objects(vec![triangle(across(3.0, 1.0))]);
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 1)).unwrap();
    // Behind the middle of its lower edge, which belongs to it, behind its inside, and beside it.
    let points = [Vec3::new(0.1, -2.0, 6.0), Vec3::new(0.1, -1.0, 6.0), Vec3::new(0.1, -2.5, 6.0)];
    let (answers, counters) = ask(&buffer, &points);
    assert_eq!((answers, counters.tests, counters.undecided), (vec![true, true, false], 3, 1));
}

#[test]
fn a_triangle_that_is_seen_almost_edge_on_is_listed() {
    // The volume before the light is 1, of products of 2^62: floats do not tell on which side of the plane that is.
    let corners = [
        [-3_162_467.0, -888_664.0, 2_091_827.0],
        [-572_508.0, -160_877.0, 378_687.0],
        [-1_055_636.0, -296_638.0, 698_253.0],
    ];
    let corners = corners.map(Vec3::from).to_vec();
    let scene = of_objects(vec![triangle(corners)]);
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 4)).unwrap();
    buffer.validate().unwrap();
    assert!(buffer.counts().records > 0);
}

#[test]
fn many_rows_of_cells_hold_what_projects_on_them() {
    // Bands of two rows and more; every third cell has a small triangle before its middle.
    const CELLS: u32 = 40;
    let middle = |k: u32| (2.0 * k as f32 + 1.0) / CELLS as f32 - 1.0;
    let places: Vec<_> = (0..CELLS * CELLS).step_by(3).map(|i| (i % CELLS, i / CELLS)).collect();
    let objects = places.iter().map(|&(column, row)| {
        let corners = across(1.0, 0.2 / CELLS as f32);
        triangle(corners.iter().map(|&p| p + Vec3::new(middle(column), middle(row), 0.0)).collect())
    });
    let scene = of_objects(objects.collect());
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, CELLS)).unwrap();
    let lists = buffer.sides[4].as_ref().unwrap();
    for (caster, &(column, row)) in places.iter().enumerate() {
        let (_, list) = lists.list(lists.cell(column, row).unwrap());
        assert_eq!(list.iter().map(|record| record.caster as usize).collect::<Vec<_>>(), [caster]);
    }
    assert_eq!(buffer.counts().records, places.len() as u64);
}

#[test]
fn a_flat_polygon_alone_in_a_scene_has_no_list() {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 3.0 + x));
    let square = || ObjectInput::new("square", corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    let counts = |scene: &Scene| {
        let index = SceneIndex::new(scene);
        let input = BuildInput { receivers: Receivers::Surfaces, ..anywhere(scene, &index, 3) };
        LightBuffer::new(&input).unwrap().counts()
    };
    let alone = counts(&of_objects(vec![square()]));
    assert_eq!((alone.records, alone.dropped_lists), (0, alone.touched_cells));
    assert!(alone.touched_cells > 0);
    // What is curved may shadow itself.
    let curved = counts(&of_objects(vec![with_curved(Shape::sphere(Vec3::Z * 8.0, 1.0))]));
    assert!(curved.records > 0 && curved.dropped_lists == 0);
}

#[test]
fn two_sides_of_a_solid_cover_a_cell_that_neither_covers_alone() {
    // An edge towards the light, far beyond the cell in the middle.
    let tips = [
        Vec3::new(0.0, -9.0, 3.0),
        Vec3::new(0.0, 9.0, 3.0),
        Vec3::new(-9.0, 0.0, 9.0),
        Vec3::new(9.0, 0.0, 9.0),
    ];
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    let scene = of_objects(vec![ObjectInput::new("wedge", tips.to_vec(), triangles)]);
    let index = SceneIndex::new(&scene);
    let input = BuildInput { culling: Culling::ClosedSolids, ..anywhere(&scene, &index, 9) };
    let buffer = LightBuffer::new(&input).unwrap();
    let lists = buffer.sides[4].as_ref().unwrap();
    let (cover, list) = lists.list(lists.cell(4, 4).unwrap());
    assert_eq!((list.len(), buffer.counts().culled), (2, 2));
    assert!(cover > 3.0 && cover < 5.0, "{cover}");
}

#[test]
fn every_part_of_a_buffer_counts_in_its_bytes() {
    // A wedge that is culled and convex, glass, and lists with groups.
    let tips = [
        Vec3::new(0.0, -9.0, 3.0),
        Vec3::new(0.0, 9.0, 3.0),
        Vec3::new(-9.0, 0.0, 9.0),
        Vec3::new(9.0, 0.0, 9.0),
    ];
    let mut builder = SceneBuilder::extend(glass());
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    builder.add_object(ObjectInput::new("wedge", tips.to_vec(), triangles)).unwrap();
    let scene = builder.finish();
    let index = SceneIndex::new(&scene);
    let input = BuildInput {
        culling: Culling::ClosedSolids,
        bounding_volumes: VolumeThreshold::MoreThan(1),
        ..anywhere(&scene, &index, 3)
    };
    let buffer = LightBuffer::new(&input).unwrap();
    // Three triangles of glass and behind it, four of the wedge, of which two are culled.
    let triangles = 7;
    assert_eq!(buffer.harmless.bytes(), triangles * 8);
    assert_eq!(buffer.culled.as_ref().unwrap().bytes(), triangles);
    let lists = |sides: &[Option<SideLists>]| sides.iter().flatten().map(SideLists::bytes).sum::<usize>();
    let groups: usize = buffer.sides.iter().flatten().map(|lists| lists.groups.bytes()).sum();
    let stored: usize =
        buffer.sides.iter().flatten().map(|lists| lists.headers.len() + lists.records.len()).sum();
    assert_eq!(lists(&buffer.sides), 8 * stored + groups);
    assert!(groups > 0);
    let transparent = buffer.transparent.as_ref().unwrap();
    assert_eq!(transparent.bytes(), transparent_casters(&scene, &index).bytes() + lists(&transparent.sides));
    let volumes = scene.objects.len() * size_of::<Option<Volume>>();
    let parts = [
        buffer.casters.bytes(),
        buffer.harmless.bytes(),
        buffer.culled.as_ref().unwrap().bytes(),
        transparent.bytes(),
        volumes,
        lists(&buffer.sides),
    ];
    assert!(parts.iter().all(|&bytes| bytes > 1));
    assert_eq!(buffer.bytes(), parts.iter().sum::<usize>());
}

fn transparent_casters(scene: &Scene, index: &SceneIndex) -> Casters {
    Casters::transparent(scene, index, Vec3::ZERO.into())
}

#[test]
fn statistics_say_what_was_built() {
    let scene = of_objects(vec![triangle(across(3.0, 40.0)), triangle(across(4.0, 0.25))]);
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 2)).unwrap();
    let statistics = buffer.statistics();
    let of = |name: &str| {
        let found: Vec<_> = statistics.iter().filter(|(row, _)| *row == name).collect();
        let [(_, value)] = found[..] else { panic!("{name}: {found:?}") };
        value.clone()
    };
    let counts = buffer.counts();
    assert_eq!([of("resolution"), of("sides built"), of("casters culled")], ["2", "5", "0"]);
    assert_eq!(of("list items"), counts.records.to_string());
    // Of 6 sides with 4 squares each.
    assert_eq!(of("list items per square"), format!("{:.3}", counts.records as f64 / 24.0));
    assert_eq!(of("non-empty squares"), format!("{:.1} %", 100.0 * counts.non_empty as f64 / 24.0));
}

#[test]
fn the_corners_of_what_is_cast_are_its_own_or_those_of_a_box_around_it() {
    let sphere = Shape::sphere(Vec3::new(3.0, -4.0, 5.0), 2.0);
    let scene = of_objects(vec![triangle(across(3.0, 1.0)), with_curved(sphere)]);
    let index = SceneIndex::new(&scene);
    let casters = Casters::some(&scene, &index, Vec3::ZERO.into(), index.casting(&scene));
    let found: Vec<Vec3> = corners(&scene, &casters).collect();
    assert_eq!(found[..3], across(3.0, 1.0));
    let (low, high) = sphere.bounds().unwrap();
    let boxed: Vec<Vec3> = (0..8)
        .map(|i| {
            let end = |axis: usize| if i / [1, 2, 4][axis] % 2 == 0 { low[axis] } else { high[axis] };
            Vec3::new(end(0), end(1), end(2))
        })
        .collect();
    assert_eq!(found[3..], boxed);
}

#[test]
fn a_sheet_lists_a_triangle_in_the_cells_that_it_meets_at_its_depth_there() {
    // Half of a square of 8 by 8 cells, in the plane z = x, under a light straight above and one from aside.
    let corners = [Vec3::splat(-8.0), Vec3::new(8.0, -8.0, 8.0), Vec3::new(-8.0, 8.0, -8.0)];
    let scene = of_objects(vec![triangle(corners.to_vec())]);
    let index = SceneIndex::new(&scene);
    for direction in [Vec3::new(0.0, 0.0, 2.0), Vec3::new(-1.0, 0.0, 2.0)] {
        let buffer = build_for(LightPosition::Towards(direction), &scene, &index, 8);
        let lists = buffer.sides[0].as_ref().unwrap();
        // Seen along the rays it is as wide as from -8 to 8 or from -12 to 12: columns are steps of 2 in depth.
        let origin = buffer.casters.space.origin().z;
        for row in 0..8 {
            for column in 0..8 {
                let records = lists.cell(column, row).map_or(&[][..], |cell| lists.list(cell).1);
                // Those beyond its longest side have a corner on it.
                assert_eq!(records.len(), usize::from(column + row <= 8), "{column} {row}");
                if column + row < 7 {
                    let nearest = 8.0 - 2.0 * (column + 1) as f32 + origin;
                    assert!((records[0].near - nearest).abs() < 1e-3, "{column} {row}: {}", records[0].near);
                }
            }
        }
    }
}

#[test]
fn footprints_on_a_sheet_are_no_wider_than_their_boxes() {
    // Under this light x' is x + z / 2, from -12 to 12 over eight columns; y' is y, from -8 to 8 over eight rows.
    let corners = [Vec3::splat(-8.0), Vec3::splat(8.0), Vec3::new(-8.0, 8.0, -8.0)];
    let scene = of_objects(vec![triangle(corners.to_vec())]);
    let index = SceneIndex::new(&scene);
    let light = LightPosition::Towards(Vec3::new(-1.0, 0.0, 2.0));
    let buffer = build_for(light, &scene, &index, 8);
    let space = &buffer.casters.space;
    assert_eq!(space.origin(), Vec3::ZERO);
    let small = [Vec3::new(-1.5, 0.5, 4.0), Vec3::new(3.5, 0.6, 4.0), Vec3::new(-1.0, 3.5, 4.0)];
    let small = oriented(light, small).expect("not edge-on").map(|p| p.as_dvec3());
    let planes = OrientedPlanes::new(space, small);
    let footprint = Footprint::new(&side_grid(8), &buffer.cells.frame(0), &planes).expect("on the sheet");
    assert_eq!((footprint.columns(), footprint.rows()), ([4, 5], [4, 5]));
}

#[test]
fn squares_of_transparent_surfaces_alone_count() {
    let glass = Transmission { transmittance: [0.5; 3], refractive_index: 1.0 };
    let mut builder = SceneBuilder::new("test");
    let material = builder.add_material(Material { transmission: Some(glass), ..Material::default() });
    builder.add_object(triangle(across(3.0, 1.0))).unwrap();
    builder.add_object(ObjectInput { material, ..triangle(across(-3.0, 0.25)) }).unwrap();
    let scene = builder.finish();
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 4)).unwrap();
    let (found, counts) = (buffer.occupancy(), buffer.counts());
    // One in each of the four squares around the middle of the side that looks along -z.
    assert_eq!((found.transparent, counts.transparent_records), (4, 4));
    assert_eq!((found.opaque, found.non_empty), (counts.records, counts.non_empty + 4));
}

#[test]
fn what_a_steep_cone_hides_beside_a_border_of_cells_is_dark() {
    // Seen from the light its rim is 2^-19 beyond the plane z = 4 y, which is a border between rows of cells.
    let beyond = 2.0_f32.powi(-19);
    let base = Vec3::new(0.0, 1.75, 6.0 + beyond);
    let scene = of_objects(vec![with_curved(Shape::cone(base, 0.0, base + Vec3::Y * 0.25, 2.0))]);
    let index = SceneIndex::new(&scene);
    let buffer = LightBuffer::new(&anywhere(&scene, &index, 8)).unwrap();
    // Twice as far away, behind half of that, and by half of it beside the rim.
    let (answers, _) = ask(&buffer, &[1.0, 3.0].map(|n| Vec3::new(0.0, 4.0, 16.0 + n * beyond)));
    assert_eq!(answers, [true, false]);
}
