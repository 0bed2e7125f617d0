//! Embree's library is not there, or is something else: the loader says so in one line.

use crate::{BLOCKS, Folder};
use std::process::Command;

#[test]
fn the_loader_names_the_library() {
    let folder = Folder::new();
    for name in ["libembree3.so.3", "libembree4.so.4"] {
        folder.write(name, "");
    }
    let output = Command::new(env!("CARGO_BIN_EXE_lightbuffer"))
        .args(["info", BLOCKS])
        .env("LD_LIBRARY_PATH", folder.path(""))
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(127), "{said}");
    assert!(said.contains("error while loading shared libraries: ") && said.contains("libembree"), "{said}");
    assert_eq!(said.lines().count(), 1);
}
