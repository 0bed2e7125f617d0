//! Pieces of the build by themselves.

use super::*;

#[test]
fn bands_are_the_rows_of_the_window_in_pieces() {
    let window = Window { columns: [3, 12], rows: [5, 37] };
    assert_eq!((window.width(), window.height(), window.is_empty()), (10, 33, false));
    // Sixteen pieces of three rows at most, the last one shorter if they do not come out even.
    let expected: Vec<_> = (0..11).map(|i| [5 + 3 * i, 7 + 3 * i]).collect();
    assert_eq!(bands(&window), expected);
    let uneven = bands(&Window { rows: [5, 36], columns: [0, 0] });
    assert_eq!((uneven.len(), uneven[0], uneven[15]), (16, [5, 6], [35, 36]));
    let odd = bands(&Window { rows: [0, 16], columns: [0, 0] });
    assert_eq!((odd.len(), odd[8]), (9, [16, 16]));
    // No piece has many more than 2^16 cells.
    let wide = bands(&Window { columns: [0, 4095], rows: [0, 4095] });
    assert_eq!((wide.len(), wide[1]), (256, [16, 31]));
    assert!(Window { columns: [u32::MAX, 0], rows: [u32::MAX, 0] }.is_empty());
    assert!(!Window { columns: [7, 7], rows: [2, 2] }.is_empty());
}

#[test]
fn depths_are_rounded_to_the_next_f32_outwards() {
    for value in [0.1, -0.1, 1.0 / 3.0, 16_777_217.0, 1e-50, -1e-50] {
        let (down, up) = (round_down(value), round_up(value));
        assert!(f64::from(down) < value && value < f64::from(up) && down.next_up() == up, "{value}");
    }
    for exact in [0.0, 0.5, -3.0] {
        assert_eq!([round_down(exact), round_up(exact)], [exact as f32; 2]);
    }
}

#[test]
fn starts_are_sums_of_what_stands_before() {
    assert_eq!(starts(4, &[(1, 0), (3, 0), (1, 1), (3, 2), (3, 5)]), [0, 0, 2, 2, 5]);
}

#[test]
fn what_bands_count_is_added_up() {
    let count = |n: u64| Statistics {
        resolution: 8,
        culled: n,
        sides: n,
        cells: 2 * n,
        touched_cells: 3 * n,
        non_empty: 5 * n,
        records: 7 * n,
        transparent_records: n,
        bounding_volumes: 11 * n,
        longest_list: 13 * n,
        pruned: 17 * n,
        full_occlusions: 19 * n,
        dropped_lists: 23 * n,
        dropped_full_occlusions: 29 * n,
    };
    let mut found = count(3);
    found.join(&count(4));
    // What is known of the whole buffer is not counted by bands, and of two lists one is the longest.
    let whole = Statistics { culled: 3, sides: 3, transparent_records: 3, longest_list: 13 * 4, ..count(7) };
    assert_eq!(found, whole);
}

#[test]
fn a_cell_is_counted_for_what_became_of_it() {
    let candidate = Candidate {
        near: 1.0,
        far: 2.0,
        role: Role::Blocks(0),
        cover: Cover::Part,
        self_shadow: SelfShadow::Never,
    };
    let finished = |full_occlusion: f32, pruned: u32, dropped: Dropped| cell::Finished {
        full_occlusion,
        pruned,
        dropped,
    };
    let mut found = Statistics::default();
    found.add_cell(3, &[candidate; 2], finished(2.0, 1, Dropped::Nothing));
    found.add_cell(1, &[], finished(f32::INFINITY, 0, Dropped::List));
    found.add_cell(1, &[candidate], finished(f32::INFINITY, 0, Dropped::FullOcclusion));
    found.add_cell(0, &[], finished(f32::INFINITY, 0, Dropped::Nothing));
    found.add_cell(0, &[], finished(f32::INFINITY, 0, Dropped::Nothing));
    let expected = Statistics {
        cells: 5,
        touched_cells: 3,
        non_empty: 2,
        records: 3,
        longest_list: 2,
        pruned: 1,
        full_occlusions: 1,
        dropped_lists: 1,
        dropped_full_occlusions: 1,
        ..Statistics::default()
    };
    assert_eq!(found, expected);
}

/// A triangle before a light in the origin, cast on the face that looks along z.
fn cast(corners: [DVec3; 3], cells: u32, most: Cover, stands_for: StandsFor) -> (Cast, Grid) {
    let (grid, frame) = (side_grid(cells), Frame::perspective(DVec3::X, DVec3::Y, DVec3::Z));
    let planes = OrientedPlanes::of_hull(DVec3::ZERO, corners).unwrap();
    let footprint = Footprint::new(&grid, &frame, &planes).unwrap();
    (Cast { role: Role::Blocks(0), most, stands_for, footprint }, grid)
}

fn wide() -> [DVec3; 3] {
    [(-9.0, -9.0), (9.0, -9.0), (0.0, 9.0)].map(|(x, y)| DVec3::new(x, y, 2.0))
}

#[test]
fn a_candidate_is_what_its_cast_stands_for() {
    let of = |most: Cover, stands_for: StandsFor| {
        let (cast, grid) = cast(wide(), 5, most, stands_for);
        candidate(&cast, &grid, 2, 2)
    };
    let itself = of(Cover::Whole, StandsFor::Itself);
    assert!(itself.near < 2.0 && itself.near > 1.999 && itself.far > 2.0 && itself.far < 2.001);
    assert_eq!((itself.cover, itself.self_shadow), (Cover::Whole, SelfShadow::Never));
    assert_eq!(of(Cover::Part, StandsFor::Itself), Candidate { cover: Cover::Part, ..itself });
    let curved = Candidate { self_shadow: SelfShadow::Perhaps, ..itself };
    assert_eq!(of(Cover::Whole, StandsFor::Hull), curved);
    assert_eq!(of(Cover::Whole, StandsFor::HullAroundLight), Candidate { near: 0.0, ..curved });
    let inner = of(Cover::Whole, StandsFor::Inner { margin: 0.5 });
    assert_eq!(inner, Candidate { far: inner.far, ..curved });
    assert!((inner.far - itself.far - 0.5).abs() < 1e-6, "{}", inner.far);
}

#[test]
fn lists_are_refused_from_the_first_byte_on_that_they_may_need_too_much() {
    // In the middle three of eight columns in one row, and the one between them in the next.
    let corners = [(-0.45, -0.2), (0.2, -0.2), (-0.12, 0.1)].map(|(x, y)| DVec3::new(x, y, 1.0));
    let (cast, grid) = cast(corners, 8, Cover::Whole, StandsFor::Itself);
    assert_eq!((cast.footprint.columns(), cast.footprint.rows()), ([2, 4], [3, 4]));
    assert_eq!(cells_around(&cast.footprint), 6);
    let rows = [3, 4].map(|row| cast.footprint.span(&grid, row).map(|[left, right]| right - left + 1));
    assert_eq!(rows, [Some(3), Some(1)]);
    let scene = crate::scene::SceneBuilder::new("nothing").finish();
    let index = crate::shadow::SceneIndex::new(&scene);
    let casts = [cast];
    let is_refused = |bytes: u64, bounding_volumes: VolumeThreshold| {
        let memory = crate::memory::MemoryLimit::bytes(bytes);
        let input = BuildInput { memory, bounding_volumes, ..BuildInput::new(&scene, &index, Vec3::ZERO) };
        check_memory(&casts, &grid, 8, &input).is_err()
    };
    // Two numbers of a cell and a cast, their place in the order, and a record of eight bytes: for four cells.
    assert_eq!([79, 80].map(|bytes| is_refused(bytes, VolumeThreshold::Off)), [true, false]);
    // With a group of three numbers for each.
    assert_eq!([127, 128].map(|bytes| is_refused(bytes, VolumeThreshold::MoreThan(1))), [true, false]);
}
