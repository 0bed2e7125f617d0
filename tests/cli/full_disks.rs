//! A disk that is full or a file that may grow no more: one line, exit code 2, and what was there before.

use crate::{BLOCKS, Folder, lightbuffer, names};
use std::path::Path;
use std::process::Command;

/// A run that may write files of so many units of the shell's `ulimit -f`, which has no end for whoever is root either:
/// exit code and standard error.
fn with_limit(units: u32, arguments: &[&str]) -> (Option<i32>, String) {
    let shell = format!(r#"ulimit -f {units}; exec "$0" "$@""#);
    let output = Command::new("sh")
        .args(["-c", &shell, env!("CARGO_BIN_EXE_lightbuffer")])
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[track_caller]
fn one_line(text: &str, words: &str) {
    assert!(text.starts_with("lightbuffer: ") && text.contains(words), "{words:?} is not in {text:?}");
    assert!(text.ends_with('\n') && text.lines().count() == 1, "{text:?}");
}

/// Whichever of its files is the one that does not fit, none of them appears and none that was there is replaced.
#[test]
fn a_picture_that_does_not_fit_leaves_the_old_one() {
    let folder = Folder::new();
    let picture = folder.write("picture.exr", "old");
    let arguments =
        ["render", "-q", BLOCKS, "--size", "96x96", "--no-verdict", "-o", picture.to_str().unwrap()];
    let mut refused = 0;
    for units in [0, 1, 4, 32, 128, 256] {
        let (code, said) = with_limit(units, &arguments);
        if code == Some(0) {
            continue;
        }
        refused += 1;
        assert_eq!(code, Some(2), "{said}");
        one_line(&said, "picture.");
        one_line(&said, "cannot write: File too large");
        assert_eq!(names(&folder.path("")), ["picture.exr"]);
        assert_eq!(std::fs::read(&picture).unwrap(), b"old");
    }
    assert!(refused >= 3, "{refused} refused");
    lightbuffer(arguments).done();
    let bytes = std::fs::metadata(&picture).unwrap().len();
    // Too little by less than a unit of 512 bytes: what is still in buffers must not be forgotten.
    let (code, _) = with_limit(u32::try_from((bytes - 1) / 512).unwrap(), &arguments);
    assert_eq!(code, Some(2));
}

#[test]
fn a_validation_that_does_not_fit_takes_its_folder_along() {
    let folder = Folder::new();
    let out = folder.path("a/b");
    let arguments = ["validate", "-q", BLOCKS, "--size", "96x54", "--testers", "light-buffer", "-o"];
    let arguments = [&arguments[..], &[out.to_str().unwrap()]].concat();
    let (code, said) = with_limit(4, &arguments);
    assert_eq!(code, Some(2), "{said}");
    one_line(&said, "cannot write: File too large");
    assert!(names(&folder.path("")).is_empty());
}

#[test]
fn scenes_and_documents_that_do_not_fit() {
    let folder = Folder::new();
    let (scene, document) = (folder.write("scene.toml", "old"), folder.write("facts.json", "old"));
    for arguments in [
        ["generate", "kitchen", "-o", scene.to_str().unwrap()].as_slice(),
        &["info", "-q", "builtin:kitchen", "--json", document.to_str().unwrap()],
    ] {
        let (code, said) = with_limit(0, arguments);
        assert_eq!(code, Some(2), "{said}");
        one_line(&said, "cannot write: File too large");
    }
    assert_eq!(names(&folder.path("")), ["facts.json", "scene.toml"]);
    assert!([scene, document].iter().all(|file| std::fs::read(file).unwrap() == b"old"));
}

#[cfg(target_os = "linux")]
#[test]
fn full_devices_are_an_error_and_stay_devices() {
    let line = lightbuffer(["info", "-q", BLOCKS, "--json", "/dev/full"]);
    // The text comes first: it is no file.
    assert_eq!(line.code, 2);
    one_line(&line.stderr, "/dev/full: cannot write: No space left on device");
    lightbuffer(["info", "-q", BLOCKS, "--json", "/dev/null"]).done();
    for device in ["/dev/full", "/dev/null"] {
        assert!(!Path::new(device).is_file());
    }
    // A standard output that is full keeps files from being replaced.
    let folder = Folder::new();
    let document = folder.write("facts.json", "old");
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightbuffer"));
    command.args(["info", "-q", BLOCKS, "--json"]).arg(&document).current_dir(env!("CARGO_MANIFEST_DIR"));
    let output = command.stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(std::fs::read(document).unwrap(), b"old");
}

/// A real disk of 64 KiB, for who may make one; what it shows beyond the tests above is the system's other error.
#[cfg(target_os = "linux")]
#[test]
fn a_small_disk_runs_full() {
    let folder = Folder::new();
    let disk = folder.path("disk");
    std::fs::create_dir(&disk).unwrap();
    let script = r#"mount -t tmpfs -o size=64k none "$1" && cp "$2" "$1/picture.exr" && { "$0" render -q "$2" --size 96x96 --no-verdict -o "$1/picture.exr"; echo "code $?"; ls -A "$1"; cmp "$2" "$1/picture.exr" && echo same; }"#;
    // In a name space of its own, so that nothing has to be unmounted; without root's rights as its own root.
    let output = Command::new("unshare")
        .args(["--mount", "--map-root-user", "sh", "-c", script, env!("CARGO_BIN_EXE_lightbuffer")])
        .args([disk.as_os_str(), BLOCKS.as_ref()])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let (said, errors) =
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    if said.is_empty() {
        // No name spaces for users here. `/dev/full` says the same, above.
        assert!(errors.starts_with("unshare: ") || errors.starts_with("mount: "), "{errors}");
        return;
    }
    assert_eq!(said, "code 2\npicture.exr\nsame\n", "{errors}");
    one_line(&errors, "cannot write: No space left on device");
}
