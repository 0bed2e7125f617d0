//! Signals: whenever one arrives, no file is half written, what was there before is unharmed, and the program dies of
//! the signal with at most one line.

use crate::{BLOCKS, Folder, SIZE, names};
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

const SIGHUP: i32 = 1;
const SIGINT: i32 = 2;
const SIGTERM: i32 = 15;

fn program(arguments: &[&str], out: &Path) -> Command {
    // Under nohup, and in the background of a script, signals are ignored, which children inherit and the program keeps to.
    let mut command = Command::new("env");
    command.arg("--default-signal=HUP,INT,TERM").arg(env!("CARGO_BIN_EXE_lightbuffer"));
    command.args(arguments).arg("-o").arg(out).current_dir(env!("CARGO_MANIFEST_DIR"));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Sends a signal, and returns how the program ended and what it said.
fn end(mut child: Child, signal: i32) -> (ExitStatus, String) {
    let sent = Command::new("kill").arg(format!("-{signal}")).arg(child.id().to_string()).status().unwrap();
    assert!(sent.success() || child.try_wait().unwrap().is_some());
    let output = child.wait_with_output().unwrap();
    (output.status, String::from_utf8(output.stderr).unwrap())
}

/// A run that has enough to do for a signal to find it at work: the first message comes before it.
fn busy(out: &Path) -> Child {
    let arguments =
        ["validate", "scenes/courtyard.glb", "--size", "1920x1080", "--stats", "--no-floor", "-t", "1"];
    let mut command = program(&arguments, out);
    command.args(["--light", "0,7,0"]);
    command.spawn().unwrap()
}

#[test]
fn a_run_dies_of_the_signal_and_leaves_nothing() {
    for (signal, name) in [(SIGINT, "SIGINT"), (SIGTERM, "SIGTERM"), (SIGHUP, "SIGHUP")] {
        let folder = Folder::new();
        let child = busy(&folder.path("a/new/folder"));
        // Long after the start of the program, and long before its end.
        thread::sleep(Duration::from_millis(400));
        let began = Instant::now();
        let (status, said) = end(child, signal);
        assert_eq!(status.signal(), Some(signal), "{status} {said}");
        assert_eq!(said, format!("lightbuffer: stopped by {name}; no file is half written\n"));
        // Seconds would do for a person; this is for machines with a lot else to do.
        assert!(began.elapsed() < Duration::from_secs(20), "{:?}", began.elapsed());
        assert!(names(&folder.path("")).is_empty());
    }
}

#[test]
fn whenever_the_signal_comes_the_folder_holds_the_old_results_or_the_new_ones() {
    let folder = Folder::new();
    let out = folder.path("out");
    let arguments = ["validate", "-q", BLOCKS, SIZE[0], SIZE[1], "--testers", "light-buffer", "--no-floor"];
    let run = || program(&arguments, &out).spawn().unwrap();
    let began = Instant::now();
    assert!(run().wait_with_output().unwrap().status.success());
    let whole = began.elapsed();
    // Times are in the document, so results of different runs differ; no map may be replaced alone.
    let states =
        || -> Vec<_> { names(&out).iter().map(|name| std::fs::metadata(out.join(name)).unwrap()).collect() };
    let inodes = || -> Vec<u64> { states().iter().map(std::os::unix::fs::MetadataExt::ino).collect() };
    let expected = names(&out);
    let mut before = inodes();
    let (mut killed, mut done) = (0, 0);
    for i in 0..30_u32 {
        let child = run();
        // Over the whole run and a little beyond, in an order that is no order.
        thread::sleep(whole * (i * 17 % 30) / 24);
        let (status, said) = end(child, [SIGINT, SIGTERM, SIGHUP][i as usize % 3]);
        assert!(said.lines().count() <= 1, "{said}");
        assert_eq!(names(&out), expected, "after {status}");
        let after = inodes();
        let replaced = before.iter().zip(&after).filter(|(one, other)| one != other).count();
        assert!(replaced == 0 || replaced == expected.len(), "{replaced} files replaced, {status}");
        assert!(status.code().is_none() || status.success(), "{status} {said}");
        assert!(lightbuffer::film::read_exr(&out.join("image.exr")).is_ok());
        before = after;
        if status.success() { done += 1 } else { killed += 1 }
    }
    assert!(killed > 5, "{killed} killed, {done} done");
}

#[test]
fn a_big_picture_that_is_being_written_is_gone_with_the_signal() {
    let folder = Folder::new();
    let old = folder.write("picture.exr", "old");
    for i in 0..6 {
        let arguments =
            ["render", "-q", BLOCKS, "--size", "640x480", "--no-shadows", "--no-floor", "--exposure", "1"];
        let child = program(&arguments, &old).spawn().unwrap();
        // The file is open, without a name or with a temporary one, as soon as it is written.
        let opened = format!("/proc/{}/fd", child.id());
        let is_written = || {
            let files = std::fs::read_dir(&opened).into_iter().flatten().flatten();
            files
                .filter_map(|file| file.path().read_link().ok())
                .any(|file| file.starts_with(folder.path("")))
        };
        let began = Instant::now();
        while !is_written() && began.elapsed() < Duration::from_secs(20) {
            thread::yield_now();
        }
        thread::sleep(Duration::from_millis(4 * i));
        let (status, said) = end(child, SIGTERM);
        let there = names(&folder.path(""));
        match status.signal() {
            Some(SIGTERM) if there == ["picture.exr"] => {
                assert_eq!(std::fs::read(&old).unwrap(), b"old", "{said}")
            }
            // It was faster: both files, whole.
            _ => {
                assert_eq!(there, ["picture.exr", "picture.png"]);
                lightbuffer::film::read_exr(&old).unwrap();
                std::fs::write(&old, "old").unwrap();
                std::fs::remove_file(folder.path("picture.png")).unwrap();
            }
        }
    }
}

/// What nobody can clean up after: there is no name to clean.
#[cfg(target_os = "linux")]
#[test]
fn a_killed_run_leaves_no_half_file_either() {
    let folder = Folder::new();
    for i in 0..8_u32 {
        let arguments = ["render", "-q", BLOCKS, "--size", "320x240", "--no-shadows", "--no-floor"];
        let child = program(&arguments, &folder.path("picture.exr")).spawn().unwrap();
        thread::sleep(Duration::from_millis(40 * u64::from(i)));
        let (_, _) = end(child, 9);
        let there = names(&folder.path(""));
        assert!(there.iter().all(|name| name.starts_with("picture.")), "{there:?}");
        if there.contains(&"picture.exr".to_owned()) {
            lightbuffer::film::read_exr(&folder.path("picture.exr")).unwrap();
        }
    }
}

#[test]
fn what_another_killed_run_left_is_mentioned_and_not_mistaken() {
    let folder = Folder::new();
    let remains = folder.write("out/.lightbuffer-AbCdEf.part", "half of something");
    let arguments = ["validate", BLOCKS, SIZE[0], SIZE[1], "--testers", "light-buffer"];
    let output = program(&arguments, &folder.path("out")).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("out: an unfinished file (.lightbuffer-*.part) of a run that was killed"),
        "{said}"
    );
    assert_eq!(std::fs::read(remains).unwrap(), b"half of something");
}

/// `nohup`: whoever starts a run may want it to go on.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_is_ignored_from_the_start_is_ignored() {
    let folder = Folder::new();
    let shell = r#"trap '' HUP; exec "$0" "$@""#;
    let mut command = Command::new("sh");
    command.arg0("sh").args(["-c", shell, env!("CARGO_BIN_EXE_lightbuffer"), "render", "-q", BLOCKS]);
    command.args(["--size", "320x240", "--no-verdict", "-o"]).arg(folder.path("picture.exr"));
    let child = command.current_dir(env!("CARGO_MANIFEST_DIR")).stderr(Stdio::piped()).spawn().unwrap();
    thread::sleep(Duration::from_millis(50));
    let (status, said) = end(child, SIGHUP);
    assert!(status.success(), "{status} {said}");
}

/// A device that waits for its reader: neither that nor a standard error that nobody reads keeps the process.
#[test]
fn a_run_that_waits_for_a_reader_can_be_stopped() {
    let folder = Folder::new();
    let pipe = folder.path("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightbuffer"));
    command.args(["info", BLOCKS, "--json"]).arg(&pipe).current_dir(env!("CARGO_MANIFEST_DIR"));
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // The text comes first; then it waits.
    let mut line = String::new();
    BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
    let (status, said) = end(child, SIGTERM);
    assert_eq!(status.signal(), Some(SIGTERM), "{said}");
    assert!(said.ends_with("lightbuffer: stopped by SIGTERM; no file is half written\n"), "{said}");
    // And with a reader it is a file like others.
    let child = command.stdout(Stdio::null()).spawn().unwrap();
    let mut text = String::new();
    std::fs::File::open(&pipe).unwrap().read_to_string(&mut text).unwrap();
    assert!(child.wait_with_output().unwrap().status.success());
    assert_eq!(crate::json(&text)["scene"], "blocks.obj");
}
