//! What cases say beside their answers: bounded work, what is dropped, what is left of the light.

use crate::ways::{Way, Who, ask, others, with_buffer};
use crate::{assert_same, case, truths};
use lightbuffer::geometry::batch::InstructionSet;
use lightbuffer::hard_cases;
use lightbuffer::measure::{Question, answer};
use lightbuffer::scene::Dropped;
use lightbuffer::shadow::brute_force::BruteForce;
use lightbuffer::shadow::exact::Arbiter;
use lightbuffer::shadow::{BuildInput, Crossings, Resolution, SceneIndex, ShadowTester};

#[test]
fn case_07_takes_as_many_tests_as_one_triangle_would() {
    for situation in case(7).situations() {
        let queries = situation.points.len() as u64;
        for cells in [1, 64] {
            with_buffer(&situation, cells, |buffer| {
                let answers = answer(buffer, &situation.points, Question::Occlusion, &|_| {}).unwrap();
                assert!(answers.counters.tests <= queries, "{}", answers.counters.tests);
                assert_eq!(buffer.counts().longest_list, 1);
            });
        }
        let index = SceneIndex::new(&situation.scene);
        let input = BuildInput::new(&situation.scene, &index, situation.light);
        let brute = BruteForce::new(&input, InstructionSet::best());
        let answers = answer(&brute, &situation.points, Question::Occlusion, &|_| {}).unwrap();
        assert!(answers.counters.tests <= queries, "{}", answers.counters.tests);
    }
}

/// Lists of all 10,000 would be longer than lists are made.
#[test]
fn case_07_at_the_finest_resolutions() {
    let situations = case(7).situations();
    let truth = &truths(&situations)[0];
    for entry in others() {
        for resolution in [512, 2048].map(Resolution::Cells) {
            let way = Way { resolution, ..Way::of(Who::Other(entry, InstructionSet::best())) };
            assert_same(&situations[0], &way.to_string(), &ask(&way, &situations[0]), truth);
        }
    }
}

#[test]
fn case_09_at_every_resolution_to_64_and_some_to_2048() {
    let situations = case(9).situations();
    let situation = &situations[0];
    let truth = &truths(&situations[..1])[0];
    for cells in (1..=64).chain([96, 128, 192, 255, 257, 384, 500, 768, 1024, 1500, 2047, 2048]) {
        let way = Way { receivers: situation.receivers(), ..Way::light_buffer(cells) };
        assert_same(situation, &way.to_string(), &ask(&way, situation), truth);
    }
}

#[test]
fn case_30_drops_what_has_no_area() {
    for situation in case(30).situations() {
        assert_eq!(situation.scene.dropped, Dropped { degenerate: 4, ..Dropped::default() });
    }
}

#[test]
fn case_34_has_lists_no_longer_than_the_teapot() {
    let situations = case(34).situations();
    let longest =
        |cells: u32| situations.iter().map(move |s| with_buffer(s, cells, |b| b.counts().longest_list));
    let all = situations[0].scene.triangles.len() as u64;
    // From near it, cells are far smaller than the teapot. From the stand it is in a cell or two, and no list can be
    // shorter than what is seen there.
    let [near, stand, beyond] = [0, 1, 2].map(|light| longest(64).nth(light).unwrap());
    assert!(near * 8 < all, "{near} of {all}");
    assert!(stand <= all && beyond <= all);
    let finer = longest(512).next().unwrap();
    assert!(finer * 3 < near * 2, "{finer} of {near}");
}

#[test]
fn case_37_drops_and_counts_what_is_not_finite() {
    let situations = case(37).situations();
    assert_eq!(situations[0].scene.dropped, Dropped::default());
    assert_eq!(situations[1].scene.dropped, Dropped { degenerate: 0, non_finite: 9, curved: 3 });
    assert_eq!(situations[1].scene.triangles.len(), situations[0].scene.triangles.len());
}

#[test]
fn case_44_drops_surfaces_of_radius_zero() {
    let situations = case(44).situations();
    let dropped: usize = situations.iter().map(|s| s.scene.dropped.curved).sum();
    assert_eq!(dropped, 3);
}

#[test]
fn case_45_leaves_the_same_light_in_every_order() {
    let situations = case(45).situations();
    let shares: Vec<Vec<[u32; 3]>> = situations[..4]
        .iter()
        .map(|situation| {
            let index = SceneIndex::new(&situation.scene);
            let arbiter = Arbiter::new(&BuildInput::new(&situation.scene, &index, situation.light));
            let mut crossings = Crossings::default();
            ShadowTester::crossed(&arbiter, &situation.points, &mut crossings).unwrap();
            let share = |i| crossings.transmittance(&situation.scene, i);
            (0..situation.points.len()).map(|i| share(i).map(f32::to_bits)).collect()
        })
        .collect();
    let expected = 0.9f32 as f64;
    let left = f64::from(f32::from_bits(shares[0][0][0]));
    assert!((left / expected.powi(64) - 1.0).abs() < 1e-6, "{left}");
    assert!(shares.iter().flatten().all(|share| *share == shares[0][0]));
}

#[test]
fn answers_do_not_depend_on_the_build_profile() {
    // FNV-1a over all that is true: the same in debug and in release.
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut queries = 0;
    for case in hard_cases::all() {
        for situation in case.situations() {
            for (occluded, crossed) in ask(&Way::light_buffer(32), &situation) {
                queries += 1;
                for byte in [u64::from(occluded), crossed.len() as u64] {
                    hash = (hash ^ byte).wrapping_mul(0x0000_0100_0000_01b3);
                }
            }
        }
    }
    assert_eq!((queries, hash), RECORDED, "record anew only if the cases changed");
}

/// Queries of all cases, and a hash of their answers.
const RECORDED: (u64, u64) = (96_934, 11_117_227_709_612_262_481);
