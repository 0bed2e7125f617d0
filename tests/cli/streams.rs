//! Standard output and standard error that are closed, full, or read no more: never a panic, and results all the same.

use crate::{BLOCKS, Folder, names};
use std::process::{Command, Output};

/// The program with redirections of the shell.
fn shell(redirection: &str, arguments: &[&str]) -> Output {
    Command::new("sh")
        .args(["-c", &format!(r#""$0" "$@" {redirection}"#), env!("CARGO_BIN_EXE_lightbuffer")])
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

#[test]
fn nobody_has_to_read_messages() {
    let folder = Folder::new();
    let picture = folder.path("p.exr");
    let render =
        ["render", BLOCKS, "--size", "48x27", "--no-verdict", "--stats", "-o", picture.to_str().unwrap()];
    for redirection in ["2>/dev/full", "2>&-", "2>&1 | true", ">&- 2>&-", "<&-"] {
        let output = shell(redirection, &render);
        assert_eq!(output.status.code(), Some(0), "{redirection}: {output:?}");
        assert_eq!(names(&folder.path("")), ["p.exr", "p.png"], "{redirection}");
        std::fs::remove_file(&picture).unwrap();
    }
    // The exit code still tells an error.
    for redirection in ["2>/dev/full", "2>&-"] {
        assert_eq!(shell(redirection, &["info", "none.obj"]).status.code(), Some(2), "{redirection}");
    }
}

#[test]
fn who_reads_the_head_has_read_enough() {
    let folder = Folder::new();
    let out = folder.path("out");
    let validate = ["validate", BLOCKS, "--size", "48x27", "--testers", "light-buffer", "--json", "-", "-o"];
    let validate = [&validate[..], &[out.to_str().unwrap()]].concat();
    for (redirection, lines) in [("| head -1", 1), ("| true", 0)] {
        let output = shell(redirection, &validate);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(!errors.contains("panicked") && !errors.contains("cannot write"), "{errors}");
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), lines);
    }
    // The shell tells the code of the last command alone; that the results are there tells that of the first.
    assert!(names(&out).contains(&"validate.json".to_owned()));
}

#[test]
fn a_full_standard_output_is_an_error_wherever_results_go_there() {
    let folder = Folder::new();
    let out = folder.path("out");
    let commands = [
        vec![
            "validate",
            "-q",
            BLOCKS,
            "--size",
            "9x9",
            "--testers",
            "light-buffer",
            "-o",
            out.to_str().unwrap(),
        ],
        vec!["replay", "-q", BLOCKS, "--size", "9x9", "--pixel", "4,4"],
        vec!["info", "-q", BLOCKS],
        vec!["generate", "--list"],
    ];
    for arguments in commands {
        let output = shell(">/dev/full", &arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {errors}");
        assert!(errors.starts_with("lightbuffer: standard output: cannot write: No space"), "{errors}");
        assert!(names(&folder.path("")).is_empty(), "{arguments:?}");
    }
}
