//! Completions, the manual, and colours only where they are wanted.

use crate::{BLOCKS, Folder, Run, lightbuffer, names};
use std::process::Command;

#[test]
fn every_shell_gets_completions_of_every_command() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = lightbuffer(["completions", shell]).done().stdout;
        for word in ["validate", "report", "compare", "embree-epsilon", "failpercent"] {
            assert!(script.contains(word), "{word} is not in the completions of {shell}");
        }
    }
    lightbuffer(["completions", "tcsh"]).misused("possible values: bash");
    // Bash takes it, and completes a command by it.
    let script = lightbuffer(["completions", "bash"]).done().stdout;
    let ask = format!(
        "{script}\nCOMP_WORDS=(lightbuffer val); COMP_CWORD=1; _lightbuffer lightbuffer val lightbuffer; echo \"${{COMPREPLY[@]}}\""
    );
    let output = Command::new("bash").args(["-c", &ask]).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "validate", "{output:?}");
}

#[test]
fn the_manual_has_a_page_for_every_command() {
    let folder = Folder::new();
    let pages = folder.path("man");
    lightbuffer(["manual".as_ref(), "-o".as_ref(), pages.as_os_str()]).done();
    let found = names(&pages);
    for page in ["lightbuffer.1", "lightbuffer-validate.1", "lightbuffer-report.1", "lightbuffer-compare.1"] {
        assert!(found.iter().any(|name| name == page), "{page} is not in {found:?}");
    }
    assert!(!found.iter().any(|name| name == "lightbuffer-help.1"), "{found:?}");
    let page = std::fs::read_to_string(pages.join("lightbuffer-compare.1")).unwrap();
    assert!(
        page.contains(".TH lightbuffer\\-compare 1") || page.contains(".TH lightbuffer-compare 1"),
        "{page}"
    );
    assert!(page.contains("failpercent") && page.contains("idiff"), "{page}");
    let first = lightbuffer(["manual"]).done().stdout;
    assert_eq!(first, std::fs::read_to_string(pages.join("lightbuffer.1")).unwrap());
}

fn with(variable: &str, arguments: &[&str]) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_lightbuffer"))
        .args(arguments)
        .env_remove("NO_COLOR")
        .env_remove("CLICOLOR_FORCE")
        .env(variable, "1")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Run { code: output.status.code().unwrap(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// Into a pipe nothing is coloured, whatever `NO_COLOR` says; `CLICOLOR_FORCE` colours errors, warnings and help.
#[test]
fn colours_are_for_those_who_want_them() {
    let cases: [&[&str]; 3] = [
        &["info", "missing.obj"],
        &["validate", "--help"],
        &["replay", BLOCKS, "--pixel", "9999,0", "--size", "8x8"],
    ];
    for arguments in cases {
        let plain = lightbuffer(arguments);
        let none = with("NO_COLOR", arguments);
        let forced = with("CLICOLOR_FORCE", arguments);
        for run in [&plain, &none] {
            assert!(!run.stdout.contains('\x1b') && !run.stderr.contains('\x1b'), "{arguments:?}");
        }
        let coloured = format!("{}{}", forced.stdout, forced.stderr);
        assert!(coloured.contains('\x1b'), "{arguments:?}: {coloured}");
        assert_eq!((plain.code, &plain.stderr), (none.code, &none.stderr));
    }
}
