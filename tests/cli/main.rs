//! The program as people run it: its options, what it writes where, and how it exits.

mod bench;
mod compare;
mod embree_modes;
mod epsilon;
mod exr_tools;
#[path = "../formats/fixtures.rs"]
mod fixtures;
mod frames;
#[cfg(unix)]
mod full_disks;
mod fuzz;
mod hard_cases;
mod hostile;
mod info;
mod manual;
mod many_lights;
mod masks;
mod memory;
#[cfg(all(feature = "embree", target_os = "linux"))]
mod missing_library;
mod outputs;
#[cfg(unix)]
mod places;
#[path = "../formats/polygon_writers.rs"]
mod polygon_writers;
mod render;
mod replay;
mod report;
mod reproduce;
mod reproduce_t_buffer;
mod same_scene;
mod shadow_buffer;
mod shards;
#[cfg(unix)]
mod signals;
#[cfg(unix)]
mod streams;
mod switches;
mod trees;
mod usage;
mod validate;
mod view;

use fixtures::Folder;
use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// The scene of most tests: 732 triangles without light or camera, so that floor, light and camera are added.
const BLOCKS: &str = "scenes/blocks.obj";

/// Few pixels: these tests are about the program; the library has its own about pictures.
const SIZE: [&str; 2] = ["--size", "96x54"];
const WIDTH: usize = 96;
const HEIGHT: usize = 54;

/// How a run of the program ended.
struct Run {
    code: i32,
    stdout: String,
    stderr: String,
}

/// Runs the program from the root of the repository.
fn lightbuffer<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_lightbuffer"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    Run {
        code: output.status.code().expect("no signal"),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

impl Run {
    /// Asserts that the run was done and right.
    #[track_caller]
    fn done(self) -> Run {
        assert_eq!(self.code, 0, "{}{}", self.stdout, self.stderr);
        self
    }

    /// Asserts that it failed with one line on standard error, and returns that line.
    #[track_caller]
    fn failed(self) -> String {
        assert_eq!((self.code, self.stdout.as_str()), (2, ""), "{}", self.stderr);
        let line = self.stderr.strip_suffix('\n').expect("a whole line").to_owned();
        assert!(!line.contains(char::is_control), "more than a line: {line:?}");
        assert!(line.starts_with("lightbuffer: "), "{line}");
        line
    }

    /// Asserts that the arguments were refused with a message that holds the words.
    #[track_caller]
    fn misused(self, words: &str) {
        assert_eq!((self.code, self.stdout.as_str()), (2, ""), "{}", self.stderr);
        assert!(self.stderr.starts_with("error: ") || self.stderr.starts_with("lightbuffer: "));
        assert!(self.stderr.contains(words), "{words:?} is not in {:?}", self.stderr);
    }
}

/// Names of what is in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// `validate SCENE -o FOLDER` on a small image, quietly, with more options.
fn validate(scene: impl AsRef<OsStr>, folder: &Path, options: &[&str]) -> Run {
    let arguments = ["validate", "-q", SIZE[0], SIZE[1], "-o"].map(OsStr::new);
    let places = [folder.as_os_str(), scene.as_ref()];
    lightbuffer(arguments.into_iter().chain(places).chain(options.iter().map(OsStr::new)))
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error} in {text}"))
}
