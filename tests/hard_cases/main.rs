//! The 47 hard cases, one test each: what is known of every answer, the definition in integers, the arbiter and
//! every native tester must say the same, however testers are set. What Embree says is not asked here;
//! `lightbuffer validate builtin:hard-cases` counts it.

mod beside;
#[cfg(target_arch = "x86_64")]
mod flush_to_zero;
mod ways;

use lightbuffer::hard_cases::{self, COUNT, HardCase, Situation};
use ways::{Answer, Way, ask, ways};

/// Names of tests, each with the number of its case.
macro_rules! cases {
    ($($name:ident = $number:literal;)*) => {
        $(#[test]
        fn $name() {
            every_answer_is_right($number);
        })*

        /// The numbers that have a test.
        const TESTED: &[u32] = &[$($number),*];
    };
}

cases! {
    case_01_borders_of_two_faces = 1;
    case_02_corners_of_three_faces = 2;
    case_03_borders_of_cells = 3;
    case_04_axes_with_signed_zeros = 4;
    case_05_triangle_over_three_faces = 5;
    case_06_edge_on_and_inside_a_cell = 6;
    case_07_duplicates = 7;
    case_08_long_slope = 8;
    case_09_resolutions = 9;
    case_10_light_in_a_plane = 10;
    case_11_light_on_a_surface = 11;
    case_12_light_inside_a_mesh = 12;
    case_13_light_one_ulp_off_a_wall = 13;
    case_14_point_in_the_light = 14;
    case_15_denormal_distance = 15;
    case_16_light_very_far_away = 16;
    case_17_box_on_a_floor = 17;
    case_18_grazing = 18;
    case_19_convex_edge = 19;
    case_20_nested_spheres = 20;
    case_21_doubled_receiver = 21;
    case_22_occluder_before_the_light = 22;
    case_23_occluder_beyond_the_light = 23;
    case_24_edges_of_an_integer_grid = 24;
    case_25_vertices_of_many_valences = 25;
    case_26_silhouettes = 26;
    case_27_grazed_sliver = 27;
    case_28_missed_sliver = 28;
    case_29_needle = 29;
    case_30_zero_area = 30;
    case_31_far_from_the_origin = 31;
    case_32_powers_of_two = 32;
    case_33_offset_and_scale = 33;
    case_34_teapot_in_a_stadium = 34;
    case_35_huge_and_flat = 35;
    case_36_denormal_vertices = 36;
    case_37_vertices_that_are_not_finite = 37;
    case_38_inverted_winding = 38;
    case_39_edges_of_many_faces = 39;
    case_40_t_junction = 40;
    case_41_touched_sphere = 41;
    case_42_small_and_large_spheres = 42;
    case_43_along_a_cylinder = 43;
    case_44_cones = 44;
    case_45_transparent_layers = 45;
    case_46_opaque_behind_transparent = 46;
    case_47_orders = 47;
}

#[test]
fn the_numbers_are_1_to_47_and_each_has_a_test() {
    let numbers: Vec<u32> = (1..=COUNT).collect();
    assert_eq!(COUNT, 47);
    assert_eq!(hard_cases::all().map(|case| case.number).collect::<Vec<_>>(), numbers);
    assert_eq!(TESTED, numbers);
}

fn case(number: u32) -> &'static HardCase {
    hard_cases::find(number).expect("a case of this number")
}

/// The truth about every situation of a case, by all that know it without culling: what the case says, the
/// integers, and the arbiter.
fn truths(situations: &[Situation]) -> Vec<Vec<Answer>> {
    let mut truths: Vec<Vec<Answer>> = Vec::new();
    let mut occluded: Vec<Vec<bool>> = Vec::new();
    for situation in situations {
        assert!(!situation.points.is_empty(), "{}: nobody is asked", situation.name);
        let truth = ask(&Way::arbiter(), situation);
        if let Some(plain) = ways::plain(situation) {
            assert_same(situation, "the arbiter against the definition", &truth, &plain);
        }
        if let Some(known) = situation.known(&occluded) {
            assert_eq!(known.len(), truth.len(), "{}", situation.name);
            let known: Vec<Answer> =
                known.iter().zip(&truth).map(|(&occluded, t)| (occluded, t.1.clone())).collect();
            assert_same(situation, "the arbiter against what is known", &truth, &known);
        }
        if let Some(times) = &situation.crossings {
            let found: Vec<usize> = truth.iter().map(|(_, crossed)| crossed.len()).collect();
            assert_eq!(&found, times, "{}", situation.name);
        }
        occluded.push(truth.iter().map(|(occluded, _)| *occluded).collect());
        truths.push(truth);
    }
    truths
}

fn every_answer_is_right(number: u32) {
    let situations = case(number).situations();
    for (situation, truth) in situations.iter().zip(truths(&situations)) {
        for way in ways(situation) {
            assert_same(situation, &way.to_string(), &ask(&way, situation), &truth);
        }
    }
}

/// The first wrong answer in bits, if there is one.
fn assert_same(situation: &Situation, who: &str, answers: &[Answer], truth: &[Answer]) {
    assert_eq!(answers.len(), truth.len());
    let Some(first) = (0..truth.len()).find(|&i| answers[i] != truth[i]) else { return };
    let wrong = (0..truth.len()).filter(|&i| answers[i] != truth[i]).count();
    let point = &situation.points[first];
    panic!(
        "{}: {who}: {wrong} of {} wrong, first {point:?} (bits {:x?}), light {:?}: {:?}, truth {:?}",
        situation.name,
        truth.len(),
        point.position.to_array().map(f64::to_bits),
        situation.light,
        answers[first],
        truth[first]
    );
}
