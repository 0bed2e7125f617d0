//! `--memory-limit`: what would need more is refused in one line before anything is written, and what runs stays within.

use crate::{BLOCKS, Folder, lightbuffer, names, validate};
use std::process::Command;

/// Beside what is estimated: the program itself, Embree's library, stacks and what the allocator keeps.
const BASE: u64 = 64 << 20;

#[test]
fn every_command_that_builds_is_refused_in_one_line() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name).to_str().unwrap().to_owned();
    let (out, picture) = (path("out"), path("p.exr"));
    let large = ["--size", "16000x16000", "--memory-limit", "256M"];
    let commands = [
        [&["validate", BLOCKS, "-o", &out][..], &large].concat(),
        [&["render", BLOCKS, "-o", &picture], &large[..]].concat(),
        [&["render", BLOCKS, "--no-shadows", "-o", &picture], &large[..]].concat(),
        [&["replay", BLOCKS, "--pixel", "0,0"], &large[..]].concat(),
        [&["reproduce", "raghuvanshi-dhande", "-q", "--figures", "9", "-o", &out], &large[..]].concat(),
    ];
    for mut arguments in commands {
        // The line stands alone where nothing is said about the floor that was added.
        if !arguments.contains(&"-q") {
            arguments.push("-q");
        }
        let line = lightbuffer(&arguments).failed();
        let whats = ["an image of 16000x16000 pixels with a light", "the answers of"];
        assert!(
            line.contains(" would need about ") && whats.iter().any(|what| line.contains(what)),
            "{line}"
        );
        assert!(line.ends_with(" and --memory-limit is 256 MiB"), "{line}");
    }
    let line = validate("builtin:kitchen", &folder.path("out"), &["--memory-limit", "100K"]).failed();
    assert!(line.contains("primitives would need about"), "{line}");
    assert!(names(&folder.path("")).is_empty());
}

/// Panes of glass that mirror: every level has twice the rays of the one before.
#[test]
fn trees_without_end_are_refused() {
    let folder = Folder::new();
    let mut scene =
        String::from("v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 30\nhither 1\nresolution 32 32\nl 0 9 9\n");
    scene += "f 1 1 1 0.1 0.9 5 0.9 1.1\n";
    for i in 0..40 {
        scene += &format!("s {} {} {} 1.5\n", i % 5 - 2, i / 5 % 4 - 2, i % 3 - 1);
    }
    let scene = folder.write("glass.nff", scene);
    let options = ["--depth", "64", "--memory-limit", "16M", "--testers", "light-buffer"];
    let line = validate(&scene, &folder.path("out"), &options).failed();
    assert!(line.contains("ray trees of ") && line.ends_with(" and --memory-limit is 16 MiB"), "{line}");
    assert_eq!(names(&folder.path("")), ["glass.nff"]);
}

/// The most memory that a run ever had, in bytes, by the system's account, and whether it was done.
#[cfg(target_os = "linux")]
fn peak(arguments: &[&str]) -> (u64, bool) {
    use std::io::Read;
    use std::process::Stdio;
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightbuffer"));
    command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR"));
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    // The highest mark is kept by the system; what comes after the last look is the end of the program.
    let ended = loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let mark = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kibibytes = mark.and_then(|mark| mark.trim().strip_suffix(" kB")?.parse::<u64>().ok());
        peak = peak.max(kibibytes.unwrap_or(0) << 10);
        if let Some(ended) = child.try_wait().unwrap() {
            break ended;
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    };
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert!(ended.success() || said.contains(" and --memory-limit is "), "{said}");
    (peak, ended.success())
}

/// The smallest limit that a run is not refused under is one that it keeps.
#[cfg(target_os = "linux")]
#[test]
fn what_runs_stays_within_the_limit() {
    let folder = Folder::new();
    let out = folder.path("out").to_str().unwrap().to_owned();
    let picture = folder.path("p.exr").to_str().unwrap().to_owned();
    let small = ["--size", "256x144", "--testers", "light-buffer,embree-fast"];
    let native = ["--size", "256x144", "--testers", "light-buffer"];
    let testers = if cfg!(feature = "embree") { small } else { native };
    for arguments in [
        [&["validate", "-q", BLOCKS, "-o", &out][..], &testers].concat(),
        vec!["render", "-q", BLOCKS, "--no-verdict", "--size", "1024x576", "-o", &picture],
        vec!["render", "-q", "scenes/courtyard.glb", "--no-verdict", "--size", "320x180", "-o", &picture],
        vec!["render", "-q", BLOCKS, "--no-verdict", "--lights", "32", "--size", "160x90", "-o", &picture],
        vec![
            "render",
            "-q",
            BLOCKS,
            "--no-verdict",
            "--size",
            "64x64",
            "--resolution",
            "1024",
            "-o",
            &picture,
        ],
    ] {
        let limit = (4..).map(|n| 1_u64 << n).find_map(|mebibytes| {
            let limit = format!("{mebibytes}M");
            let (peak, done) = peak(&[&arguments[..], &["--memory-limit", &limit]].concat());
            done.then_some((mebibytes << 20, peak))
        });
        let (limit, peak) = limit.unwrap();
        assert!(peak <= limit + BASE, "{} MiB under a limit of {}: {arguments:?}", peak >> 20, limit >> 20);
    }
}

/// Less address space than the program asks for: it may abort, but no file is half written.
#[test]
fn a_system_that_gives_less_leaves_no_half_file() {
    let folder = Folder::new();
    let picture = folder.write("p.exr", "old");
    for mebibytes in [60, 100, 150, 250] {
        let shell = format!(r#"ulimit -v {}; ulimit -c 0; exec "$0" "$@""#, mebibytes << 10);
        let output = Command::new("sh")
            .args(["-c", &shell, env!("CARGO_BIN_EXE_lightbuffer"), "render", "-q", BLOCKS, "--no-verdict"])
            .args(["-t", "1", "--size", "1024x576", "-o", picture.to_str().unwrap()])
            // glibc would try to map another 128 MiB at each allocation of a thread, which takes minutes.
            .env("MALLOC_ARENA_MAX", "1")
            .env("RUST_BACKTRACE", "0")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        if !output.status.success() {
            assert_eq!(names(&folder.path("")), ["p.exr"], "{output:?}");
            assert_eq!(std::fs::read(&picture).unwrap(), b"old");
        }
    }
}
