//! Answers do not depend on how they are found.

use crate::{BLOCKS, Folder, validate};

/// The file of a run, bytes and all: nothing of resolution, threads or time may be in it.
fn picture(folder: &Folder, name: &str, options: &[&str]) -> Vec<u8> {
    validate(BLOCKS, &folder.path(name), options).done();
    std::fs::read(folder.path(name).join("image.exr")).unwrap()
}

#[test]
fn pictures_are_the_same_for_every_resolution_and_number_of_threads() {
    let folder = Folder::new();
    let reference = picture(&folder, "reference", &["--resolution", "auto"]);
    for resolution in ["1", "7", "64", "1000"] {
        for threads in ["1", "2"] {
            let other = picture(&folder, "other", &["--resolution", resolution, "-t", threads]);
            assert!(other == reference, "R = {resolution} on {threads} threads gives other bytes");
        }
    }
    // The comparison is not of two things that cannot differ.
    assert!(picture(&folder, "other", &["--light", "1,9,2"]) != reference);
}
