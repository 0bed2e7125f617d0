//! Where results may go and where they may not: read-only folders, links, files of the scene, two results of one name.

use crate::{BLOCKS, Folder, Run, SIZE, lightbuffer, names, validate};
use std::ffi::OsStr;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

fn render(scene: impl AsRef<OsStr>, picture: &Path, options: &[&str]) -> Run {
    let arguments = ["render", "-q", "--no-verdict", SIZE[0], SIZE[1], "-o"].map(OsStr::new);
    let places = [picture.as_os_str(), scene.as_ref()];
    lightbuffer(arguments.into_iter().chain(places).chain(options.iter().map(OsStr::new)))
}

/// Runs the program as somebody whom permissions mean something to: nobody in place of root, else whoever this is.
fn unprivileged(folder: &Folder, arguments: &[&str]) -> Run {
    // Its own place may be closed to nobody.
    let program = folder.path("lightbuffer");
    if !program.exists() {
        std::fs::copy(env!("CARGO_BIN_EXE_lightbuffer"), &program).unwrap();
    }
    let id = Command::new("id").arg("-u").output().unwrap().stdout;
    let mut command = match id.as_slice() {
        b"0\n" => {
            let mut command = Command::new("setpriv");
            command.args(["--reuid=65534", "--regid=65534", "--clear-groups"]).arg(&program);
            command
        }
        _ => Command::new(&program),
    };
    let output = command.args(arguments).current_dir("/").output().unwrap();
    Run {
        code: output.status.code().expect("no signal"),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

fn set_mode(path: &Path, mode: u32) {
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).unwrap();
}

/// Said before the work, not after it: the scene would take an hour.
#[test]
fn a_folder_that_must_not_be_written_is_refused_before_the_work() {
    let folder = Folder::new();
    set_mode(&folder.path(""), 0o755);
    for (name, mode) in [("read-only", 0o555), ("no-search", 0o644)] {
        folder.write(&format!("{name}/old"), "old");
        set_mode(&folder.path(name), mode);
        let path = |file: &str| folder.path(name).join(file).to_str().unwrap().to_owned();
        let (dir, below, picture) = (path(""), path("new/folder"), path("p.exr"));
        let (json, scene) = (path("f.json"), path("s.toml"));
        let large = ["--size", "16000x16000", "--memory-limit", "999G"];
        let runs = [
            [&["validate", "builtin:kitchen", "-o", &dir][..], &large].concat(),
            [&["validate", "builtin:kitchen", "-o", &below], &large[..]].concat(),
            [&["render", "builtin:kitchen", "-o", &picture], &large[..]].concat(),
            vec!["validate", "builtin:hard-cases", "-o", &dir],
            vec!["info", "builtin:kitchen", "--json", &json],
            vec!["replay", "builtin:kitchen", "--pixel", "0,0", "--json", &json],
            vec!["reproduce", "haines-greenberg", "-o", &dir],
            vec!["generate", "kitchen", "-o", &scene],
        ];
        for arguments in runs {
            let line = unprivileged(&folder, &arguments).failed();
            assert!(line.contains(&format!("/{name}/")), "{line}");
            assert!(line.ends_with("ermission denied (os error 13)"), "{line}");
        }
        set_mode(&folder.path(name), 0o755);
        assert_eq!(names(&folder.path(name)), ["old"]);
    }
}

#[test]
fn a_file_system_without_files_of_ours() {
    for place in ["/proc/self/p.exr", "/proc/self/none/p.exr"] {
        let line = render(BLOCKS, Path::new(place), &[]).failed();
        assert!(line.starts_with(&format!("lightbuffer: {place}: cannot write: ")), "{line}");
    }
    let line = validate(BLOCKS, Path::new("/proc/self/none"), &[]).failed();
    assert!(line.starts_with("lightbuffer: /proc/self/none: cannot create the folder: "), "{line}");
}

#[test]
fn folders_in_the_way() {
    let folder = Folder::new();
    for name in ["picture.exr", "other.png", "facts.json"] {
        std::fs::create_dir(folder.path(name)).unwrap();
    }
    let facts = folder.path("facts.json");
    for (picture, named) in [("picture.exr", "picture.exr"), ("other.exr", "other.png")] {
        let line = render(BLOCKS, &folder.path(picture), &[]).failed();
        assert!(line.contains(&format!("{named}: cannot write: ")) && line.contains("directory"), "{line}");
    }
    let json = ["--json", facts.to_str().unwrap()];
    render(BLOCKS, &folder.path("third.exr"), &json).failed();
    assert_eq!(names(&folder.path("")), ["facts.json", "other.png", "picture.exr"]);
}

#[test]
fn a_result_never_replaces_a_file_of_the_scene() {
    let folder = Folder::new();
    let obj = folder.write("scene.obj", "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    let mtl = folder.write("scene.mtl", "newmtl a\nKd 1 0 0\n");
    let link = folder.path("link.json");
    symlink("scene.mtl", &link).unwrap();
    let before = [&obj, &mtl].map(|file| std::fs::read(file).unwrap());
    for json in [&obj, &mtl, &link] {
        let json = json.to_str().unwrap();
        for command in [&["info", "-q"][..], &["render", "-q", "--size", "9x9", "-o", "never.exr"]] {
            let line = lightbuffer(command.iter().chain(&[obj.to_str().unwrap(), "--json", json])).failed();
            assert_eq!(line, format!("lightbuffer: {json}: a result would replace a file of the scene"));
        }
    }
    assert_eq!([&obj, &mtl].map(|file| std::fs::read(file).unwrap()), before);
}

#[test]
fn two_results_of_one_name() {
    let folder = Folder::new();
    let picture = folder.path("p.exr");
    symlink("p.png", folder.path("link")).unwrap();
    for json in ["p.exr", "p.png", "link"] {
        let json = folder.path(json);
        let line = render(BLOCKS, &picture, &["--json", json.to_str().unwrap()]).failed();
        assert!(line.ends_with(": two results have this name"), "{line}");
    }
    let out = folder.path("out");
    let copy = out.join("validate.json");
    std::fs::create_dir(&out).unwrap();
    let line = validate(BLOCKS, &out, &["--json", copy.to_str().unwrap()]).failed();
    assert!(line.ends_with("validate.json: two results have this name"), "{line}");
    assert!(names(&out).is_empty());
}

#[test]
fn links_lead_to_the_result() {
    let folder = Folder::new();
    let old = folder.write("far/old.json", "old");
    symlink("far/old.json", folder.path("link.json")).unwrap();
    symlink("far", folder.path("out")).unwrap();
    let link = folder.path("link.json");
    lightbuffer(["info", "-q", BLOCKS, "--json", link.to_str().unwrap()]).done();
    assert!(link.is_symlink());
    crate::json(&std::fs::read_to_string(old).unwrap());
    render(BLOCKS, &folder.path("out/p.exr"), &[]).done();
    assert_eq!(names(&folder.path("far")), ["old.json", "p.exr", "p.png"]);
}

#[test]
fn names_with_line_breaks_stay_on_their_line() {
    let folder = Folder::new();
    let line = render(BLOCKS, &folder.path("no\nsuch\u{1b}[31m/p.exr"), &[]).failed();
    assert!(line.contains(r"no\nsuch\u{1b}[31m/p.exr: cannot write: No such file"), "{line}");
    let picture = folder.path("a\nb.exr");
    let run =
        lightbuffer(["render", BLOCKS, "--no-verdict", SIZE[0], SIZE[1], "-o", picture.to_str().unwrap()]);
    assert!(run.done().stderr.lines().all(|line| line.starts_with("lightbuffer: ")));
}
