//! Why Embree is wrong, pixel by pixel, and what its epsilon has to do with it.
#![cfg(feature = "embree")]

use crate::{BLOCKS, Folder, json, validate};
use lightbuffer::film::read_exr;
use serde_json::Value;

/// So large a share that shadows come away from what casts them.
const LARGE: &str = "0.01";

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no count"))
}

#[test]
fn the_verdict_says_at_each_pixel_why_embree_is_wrong() {
    let folder = Folder::new();
    let out = folder.path("out");
    let options = ["--json", "-", "--embree-epsilon", LARGE];
    let report = json(&validate(BLOCKS, &out, &options).done().stdout);
    let light = &report["lights"][0];
    let planes = read_exr(&out.join("image.exr")).unwrap();
    let name = light["name"].as_str().unwrap();
    let codes = planes.channel(&format!("shadow.{name}.verdict")).unwrap();
    let with_cause = |hundred: u64| codes.iter().filter(|&&code| code as u64 / 100 == hundred).count() as u64;
    let causes = &light["testers"]["embree"]["causes"];
    assert!(number(&causes["epsilon"]) > 0, "{causes}");
    for (hundred, cause) in [(1, "epsilon"), (2, "input_rounding"), (3, "traversal")] {
        assert_eq!(with_cause(hundred), number(&causes[cause]), "{cause}");
    }
    for code in codes {
        let (cause, verdict) = (*code as u64 / 100, *code as u64 % 10);
        assert_eq!(cause > 0, verdict == 5 || verdict == 6, "code {code}");
    }
}

#[test]
fn large_epsilons_leak_and_the_sweep_says_how_much() {
    let folder = Folder::new();
    let options = ["--json", "-", "--lights", "2", "--sweep-epsilon", "--embree-epsilon", LARGE];
    let report = json(&validate(BLOCKS, &folder.path("out"), &options).done().stdout);
    let sweep = report["epsilon_sweep"].as_array().unwrap();
    assert_eq!(sweep.len(), 2 * lightbuffer::verdict::EPSILONS.len(), "two testers");
    let at = |tester: &str, epsilon: f64| {
        let is_it = |row: &&Value| {
            row["tester"] == tester && (row["epsilon"].as_f64().unwrap() - epsilon).abs() <= 1e-6 * epsilon
        };
        sweep.iter().find(is_it).unwrap_or_else(|| panic!("{tester} at {epsilon}"))
    };
    for tester in ["embree", "embree-fast"] {
        let counted = &report["totals"]["testers"][tester];
        let swept = at(tester, 0.01);
        assert_eq!(counted["false_light"], swept["false_light"], "{tester}");
        assert_eq!(counted["false_shadow"], swept["false_shadow"], "{tester}");
        let leaks = [1e-4, 1e-3, 1e-2].map(|epsilon| number(&at(tester, epsilon)["false_light"]));
        assert!(leaks.is_sorted() && leaks[2] > 0, "{tester}: {leaks:?}");
    }
    // Without the receiver left out, nothing but an epsilon keeps rays off the surface that they begin on.
    assert!(
        number(&at("embree-fast", 0.0)["false_shadow"]) > number(&at("embree-fast", 1e-4)["false_shadow"])
    );
}

#[test]
fn without_the_option_there_is_no_sweep() {
    let folder = Folder::new();
    let report = json(&validate(BLOCKS, &folder.path("out"), &["--json", "-"]).done().stdout);
    assert_eq!(report.get("epsilon_sweep"), None);
}
