//! Every tester that has a name over the same queries, one by one, against the definition in integers.

mod cases;
mod curved;
#[cfg(feature = "embree")]
mod embree;
mod frames;
mod random;
mod runner;
mod shadow_buffer;

use lightbuffer::shadow::light_buffer::LightBuffer;
use lightbuffer::shadow::{
    Basis, Culling, Lights, ObjectCoherence, Resolution, TesterEntry, VolumeThreshold, find, testers,
};
use runner::{Asked, Setting, ask};

/// The light buffer as in 1986, whatever is asked for; `light-buffer` is that one for some lights and options alone.
static OF_1986: TesterEntry = TesterEntry {
    name: "light-buffer of 1986",
    basis: Basis::Exact,
    lights: Lights::All,
    build: &|input| Ok(Box::new(LightBuffer::new(input)?)),
    of_scene: None,
    expected_tests: |_, queries| 10.0 * queries,
};

/// Every tester that claims to be exact.
fn exact_testers() -> impl Iterator<Item = &'static TesterEntry> {
    testers().filter(|entry| entry.basis != Basis::Measured).chain([&OF_1986])
}

/// Resolutions from a single cell a face to many more than there are triangles.
const RESOLUTIONS: [u32; 4] = [1, 7, 64, 1000];

fn setting(resolution: u32) -> Setting {
    Setting::of(Resolution::Cells(resolution))
}

/// Settings of the light buffer that change what its lists look like or how they are gone through.
fn ways_through_lists() -> impl Iterator<Item = Setting> {
    let grouped = [1, 7, 64].into_iter().flat_map(|resolution| {
        THRESHOLDS.map(|most_single| Setting {
            bounding_volumes: VolumeThreshold::MoreThan(most_single),
            ..setting(resolution)
        })
    });
    let coherent = |setting| Setting { object_coherence: ObjectCoherence::LastOccluder, ..setting };
    let both = Setting {
        culling: Culling::ClosedSolids,
        bounding_volumes: VolumeThreshold::MoreThan(0),
        ..coherent(setting(7))
    };
    grouped.chain([1, 64].map(|resolution| coherent(setting(resolution)))).chain([both])
}

/// More polygons of an object in a cell than this stand behind a bounding volume.
const THRESHOLDS: [u32; 2] = [6, 0];

#[test]
fn every_exact_tester_is_right_in_every_case_at_every_resolution() {
    for case in cases::all() {
        let asked = Asked::of(&case);
        let truth = asked.plain_truth();
        assert!(
            truth.iter().any(|&t| t) && !truth.iter().all(|&t| t),
            "{}: nothing to tell apart",
            case.name
        );
        for entry in exact_testers() {
            // These know no resolution.
            let once = ["exact", "brute-force", "bounding-volumes"].contains(&entry.name);
            for &resolution in if once { &RESOLUTIONS[..1] } else { &RESOLUTIONS } {
                let answers = ask(entry, &asked, setting(resolution));
                asked.assert_equal(&answers, &truth, &format!("{} at R = {resolution}", entry.name));
            }
            let answers = ask(entry, &asked, Setting::of(Resolution::Auto));
            asked.assert_equal(&answers, &truth, &format!("{} at R = auto", entry.name));
        }
        for resolution in RESOLUTIONS {
            let setting = Setting { culling: Culling::ClosedSolids, ..setting(resolution) };
            let answers = ask(light_buffer(), &asked, setting);
            asked.assert_equal(&answers, &truth, &format!("culling at R = {resolution}"));
        }
        for setting in ways_through_lists() {
            let answers = ask(light_buffer(), &asked, setting);
            asked.assert_equal(&answers, &truth, &format!("light-buffer with {setting:?}"));
        }
    }
}

fn light_buffer() -> &'static TesterEntry {
    find("light-buffer").expect("a tester of the registry")
}

#[test]
fn far_sides_are_culled_unless_the_light_is_inside() {
    let culled = |name: &str| {
        let cases = cases::all();
        let case = cases.iter().find(|case| case.name == name).expect("a case");
        Asked::of(case).culled()
    };
    // Three boxes of two or three far sides each, two triangles a side. The floor is no solid.
    let boxes = culled("boxes that touch the floor and each other");
    assert!(boxes.iter().all(|n| (12..=18).contains(n) && n % 2 == 0), "{boxes:?}");
    let inside = culled("a light inside a box with a window");
    assert_eq!(inside, [10, 6], "of the inner box alone");
    // Whichever of the copies is cast.
    assert_eq!(culled("a thousand copies of one box"), [6]);
    let ring = culled("a ring through a box, with lights in the hole, on the ring and inside it");
    assert!(ring[0] > 40 && ring[1] > 40, "{ring:?}");
    assert!(ring[4] <= 10, "inside the ring, only the box counts: {ring:?}");
}

#[test]
fn bounding_volumes_stand_in_the_lists_of_crowded_cells() {
    let cases = cases::all();
    let crowded = cases.iter().find(|case| case.name == cases::CROWDED).expect("a case");
    let asked = Asked::of(crowded);
    for setting in ways_through_lists().filter(|s| s.bounding_volumes != VolumeThreshold::Off) {
        let records = asked.bounding_volumes(setting);
        assert!(records.iter().all(|&records| records > 0), "{setting:?}: {records:?}");
    }
    assert!(asked.bounding_volumes(setting(1)).iter().all(|&records| records == 0));
}

#[test]
fn the_last_occluder_answers_for_many_points() {
    for case in cases::all() {
        let asked = Asked::of(&case);
        let coherent = Setting { object_coherence: ObjectCoherence::LastOccluder, ..setting(1) };
        assert!(asked.coherence_hits(coherent) > 0, "{}", case.name);
        assert_eq!(asked.coherence_hits(setting(1)), 0);
    }
}

#[test]
fn masks_do_not_depend_on_threads() {
    for case in cases::all() {
        let asked = Asked::of(&case);
        for entry in exact_testers() {
            let [one, two] = [1, 2].map(|threads| {
                let setting = Setting {
                    culling: Culling::ClosedSolids,
                    object_coherence: ObjectCoherence::LastOccluder,
                    ..Setting::of(Resolution::Auto)
                };
                ask(entry, &asked, Setting { threads, ..setting })
            });
            assert_eq!(one, two, "{}: {}", case.name, entry.name);
        }
    }
}

#[test]
fn masks_do_not_depend_on_the_order_of_triangles_or_corners() {
    for case in cases::all() {
        let asked = Asked::of(&case);
        let turned = cases::turned(&case);
        let again = Asked::of(&turned);
        for entry in exact_testers() {
            assert_eq!(
                asked.by_pixel(&ask(entry, &asked, setting(32))),
                again.by_pixel(&ask(entry, &again, setting(32))),
                "{}: {}",
                case.name,
                entry.name
            );
        }
    }
}

#[test]
fn masks_do_not_depend_on_the_build_profile() {
    // The same numbers in debug and in release: a checksum of all masks of all cases.
    let bits = cases::all().iter().flat_map(|case| Asked::of(case).plain_truth()).collect::<Vec<_>>();
    let native = cases::all()
        .iter()
        .flat_map(|case| ask(light_buffer(), &Asked::of(case), setting(64)))
        .collect::<Vec<_>>();
    assert_eq!(runner::checksum(&bits), runner::checksum(&native));
    assert_eq!(
        runner::checksum(&native),
        runner::RECORDED_CHECKSUM,
        "{} queries; record anew only if the cases changed",
        native.len()
    );
}

#[test]
fn buffers_pass_their_own_audit() {
    for case in cases::all() {
        let asked = Asked::of(&case);
        for resolution in RESOLUTIONS {
            for culling in [Culling::Off, Culling::ClosedSolids] {
                asked.audit(Setting { culling, ..setting(resolution) });
            }
        }
        ways_through_lists().for_each(|setting| asked.audit(setting));
    }
}
