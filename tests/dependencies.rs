//! What we build with may be used by whoever uses us: every licence is one that `deny.toml` allows, and every source is
//! the registry. `make deny` asks more, with a network.

use serde_json::Value;
use std::collections::BTreeSet;
use std::process::Command;

/// Everything that a build of any target may need, by `cargo metadata`.
fn packages() -> Vec<Value> {
    let arguments = ["metadata", "--format-version", "1", "--locked", "--all-features"];
    let output = Command::new(env!("CARGO")).args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output();
    let output = output.expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    metadata["packages"].as_array().expect("packages").clone()
}

/// The licences that `deny.toml` allows.
fn allowed() -> BTreeSet<String> {
    let text = include_str!("../deny.toml").parse::<toml::Table>().expect("TOML");
    let names = text["licenses"]["allow"].as_array().expect("a list of licences");
    names.iter().map(|name| name.as_str().expect("a name").to_string()).collect()
}

/// Whether an expression of licences leaves a choice that is allowed.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> bool {
    // Crates from before the standard wrote a slash for "or".
    let parsed =
        spdx::Expression::parse_mode(expression, spdx::ParseMode::LAX).expect("a licence expression");
    parsed.evaluate(|requirement| {
        requirement.license.id().is_some_and(|id| allowed.contains(id.name)) && requirement.addition.is_none()
    })
}

#[test]
fn every_dependency_has_a_licence_that_is_allowed_and_comes_from_the_registry() {
    let (packages, allowed) = (packages(), allowed());
    assert!(packages.len() > 50, "only {} packages", packages.len());
    for package in &packages {
        let name = package["name"].as_str().expect("a name");
        let expression = package["license"].as_str().unwrap_or_else(|| panic!("{name} names no licence"));
        assert!(is_allowed(expression, &allowed), "{name} has the licence {expression}");
        let source = &package["source"];
        let is_ours = name == "lightbuffer" && source.is_null();
        assert!(is_ours || source.as_str().is_some_and(|s| s.starts_with("registry+")), "{name}: {source}");
    }
}

#[test]
fn a_choice_is_enough_and_both_are_needed_where_both_are_named() {
    let allowed = ["MIT", "ISC"].map(String::from).into();
    for (expression, expected) in [
        ("MIT", true),
        ("MIT/Apache-2.0", true),
        ("GPL-3.0-only OR ISC", true),
        ("MIT AND ISC", true),
        ("MIT AND Apache-2.0", false),
        ("GPL-3.0-only", false),
        ("Apache-2.0 WITH LLVM-exception OR GPL-2.0-only", false),
    ] {
        assert_eq!(is_allowed(expression, &allowed), expected, "{expression}");
    }
}
