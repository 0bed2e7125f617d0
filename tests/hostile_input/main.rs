//! Files that lie, overflow, escape or break off: one line that names file and place, no panic, and no more
//! memory than the file's own bytes justify.

mod animations;
mod binary_files;
#[path = "../formats/fixtures.rs"]
mod fixtures;
mod gltf_alpha;
mod gltf_features;
mod gltf_files;
#[path = "../formats/gltf_parts.rs"]
mod gltf_parts;
mod memory;
mod mutations;
mod nff_files;
mod obj_files;
mod paths;
mod ply_files;
#[path = "../formats/ply_writer.rs"]
mod ply_writer;
mod samples;
mod toml_curved;
mod toml_files;

use lightbuffer::scene::formats;
use std::path::Path;

/// Asserts that a file is refused in one line that begins with its path and holds the words.
#[track_caller]
fn refused(path: &Path, words: &[&str]) {
    let message = formats::load(path).expect_err("this file must be refused").to_string();
    assert_one_line(path, &message);
    for word in words {
        assert!(message.contains(word), "{word:?} is not in {message:?}");
    }
}

/// Asserts the form of a message about a file.
#[track_caller]
fn assert_one_line(path: &Path, message: &str) {
    // A material library beside the file may be the one to blame.
    let folder = path.parent().unwrap().display().to_string();
    assert!(message.starts_with(&folder), "{message:?} does not name the file");
    assert!(!message.chars().any(char::is_control), "{message:?} is more than a line");
    assert!(message.len() < folder.len() + 600, "{message:?} is too long");
}
