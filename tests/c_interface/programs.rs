//! The example and a program that makes every mistake, linked both ways, by themselves and under valgrind.

use crate::{Linking, compiled, done, root, under_valgrind};
use lightbuffer::shadow::{Basis, REGISTRY};
use std::process::Command;

/// Built as its first lines say.
const EXAMPLE: &str = "examples/c/occlusion.c";

/// The example's picture, counted by hand: rays are 10 / 128 apart and hit the floor within 4 of its middle; the square's
/// shadow there reaches to 1.5.
fn counts_of_the_example() -> String {
    let place = |i: u32| 10.0 * (f64::from(i) + 0.5) / 128.0 - 5.0;
    let within = |most: f64| (0..128).filter(|&i| place(i).abs() <= most).count().pow(2);
    let (floor, shadow) = (within(4.0), within(1.5));
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "lightbuffer {version}\nwhere rays hit: {} lit, {shadow} occluded, 0 facing away, {} without a surface\n\
         points in space: 2 lit, 1 occluded, 0 facing away, 0 without a surface\n",
        floor - shadow,
        128 * 128 - floor
    )
}

#[test]
fn the_example_runs_linked_both_ways_and_valgrind_finds_nothing() {
    for linking in [Linking::Static, Linking::Shared] {
        let program = compiled(&root().join(EXAMPLE), linking, &["-std=c99"]);
        let plain = done(&mut Command::new(&program), "");
        assert_eq!(String::from_utf8_lossy(&plain.stdout), counts_of_the_example(), "{linking:?}");
        let watched = done(&mut under_valgrind(&program), "Debian package valgrind");
        assert_eq!(watched.stdout, plain.stdout, "{linking:?}");
        assert!(watched.stderr.is_empty(), "{}", String::from_utf8_lossy(&watched.stderr));
    }
}

#[test]
fn every_mistake_has_its_code_and_line_and_threads_may_ask_at_once() {
    let source = root().join("tests/c_interface/errors.c");
    let exact = REGISTRY.iter().filter(|entry| entry.basis != Basis::Measured).map(|entry| entry.name);
    let exact: Vec<&str> = exact.chain(["auto"]).collect();
    let embree = cfg!(feature = "embree").then_some("embree");
    for linking in [Linking::Static, Linking::Shared] {
        let program = compiled(&source, linking, &["-std=c99"]);
        done(Command::new(&program).args(&exact).args(embree), "");
        if linking == Linking::Shared {
            let watched = done(under_valgrind(&program).args(&exact), "Debian package valgrind");
            assert!(watched.stderr.is_empty(), "{}", String::from_utf8_lossy(&watched.stderr));
        }
    }
}
