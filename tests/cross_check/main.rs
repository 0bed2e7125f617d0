//! Every tester of the registry over the same queries, one by one, against the definition in integers.

mod cases;
mod random;
mod runner;

use lightbuffer::shadow::{Basis, REGISTRY, Resolution};
use runner::{Asked, Setting, ask};

/// Resolutions from a single cell a face to many more than there are triangles.
const RESOLUTIONS: [u32; 4] = [1, 7, 64, 1000];

fn setting(resolution: u32) -> Setting {
    Setting { resolution: Resolution::Cells(resolution), threads: 2 }
}

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
        for entry in REGISTRY.iter().filter(|entry| entry.basis != Basis::Measured) {
            for resolution in RESOLUTIONS {
                let answers = ask(entry, &asked, setting(resolution));
                asked.assert_equal(&answers, &truth, &format!("{} at R = {resolution}", entry.name));
            }
        }
    }
}

#[cfg(feature = "embree")]
#[test]
fn embree_answers_every_case_and_is_right_where_no_edge_is_near() {
    for case in cases::all() {
        let asked = Asked::of(&case);
        let truth = asked.plain_truth();
        for entry in REGISTRY.iter().filter(|entry| entry.basis == Basis::Measured) {
            let answers = ask(entry, &asked, setting(1));
            let wrong = answers.iter().zip(&truth).filter(|(a, t)| a != t).count();
            // Its errors are measured, not forgiven without bound: a broken oracle gets most answers wrong.
            assert!(
                wrong * 20 <= truth.len(),
                "{}: {} wrong {wrong} of {}",
                case.name,
                entry.name,
                truth.len()
            );
        }
    }
}

#[test]
fn masks_do_not_depend_on_threads() {
    for case in cases::all() {
        let asked = Asked::of(&case);
        for entry in REGISTRY.iter().filter(|entry| entry.basis != Basis::Measured) {
            let one = ask(entry, &asked, Setting { resolution: Resolution::Auto, threads: 1 });
            let two = ask(entry, &asked, Setting { resolution: Resolution::Auto, threads: 2 });
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
        for entry in REGISTRY.iter().filter(|entry| entry.basis != Basis::Measured) {
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
        .flat_map(|case| {
            ask(lightbuffer::shadow::find("light-buffer").unwrap(), &Asked::of(case), setting(64))
        })
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
            asked.audit(Resolution::Cells(resolution));
        }
    }
}
