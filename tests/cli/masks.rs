//! Answers do not depend on how they are found.

use crate::{BLOCKS, Scratch, validate};

/// The file of a run, bytes and all: nothing of resolution, threads or time may be in it.
fn picture(scratch: &Scratch, name: &str, options: &[&str]) -> Vec<u8> {
    validate(BLOCKS, &scratch.path(name), options).done();
    std::fs::read(scratch.path(name).join("image.exr")).unwrap()
}

#[test]
fn pictures_are_the_same_for_every_resolution_and_number_of_threads() {
    let scratch = Scratch::new();
    let reference = picture(&scratch, "reference", &["--resolution", "auto"]);
    for resolution in ["1", "7", "64", "1000"] {
        for threads in ["1", "2"] {
            let other = picture(&scratch, "other", &["--resolution", resolution, "-t", threads]);
            assert!(other == reference, "R = {resolution} on {threads} threads gives other bytes");
        }
    }
    // The comparison is not of two things that cannot differ.
    assert!(picture(&scratch, "other", &["--light", "1,9,2"]) != reference);
}
