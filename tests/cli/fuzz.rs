//! `fuzz`: its counts, its table, and what is refused. What it finds is tested in `tests/differential.rs`.

use crate::{Folder, json, lightbuffer};

#[test]
fn the_counts_are_the_same_as_json_and_as_a_table() {
    let folder = Folder::new();
    let (out, file) = (folder.path("out"), folder.path("counts.json"));
    let (out, file) = (out.to_str().unwrap(), file.to_str().unwrap());
    let run = lightbuffer(["fuzz", "--scenes", "8", "--seed", "3", "-q", "-o", out, "--json", file]).done();
    let counts = json(&std::fs::read_to_string(file).unwrap());
    assert_eq!(
        (&counts["scenes"], &counts["seed"], &counts["disagreements"]),
        (&8.into(), &3.into(), &0.into())
    );
    assert!(counts["arbiter_checked"].as_u64().unwrap() > 0);
    for tester in ["brute-force", "bounding-volumes", "light-buffer"] {
        assert_eq!(counts["testers"][tester]["wrong"], 0, "{tester}");
        assert!(run.stdout.contains(tester), "{}", run.stdout);
    }
    assert_eq!(counts["testers"]["embree"].is_object(), cfg!(feature = "embree"));
    assert_eq!(run.stderr, "");
    // Nothing was found, and no folder was made.
    assert_eq!(crate::names(&folder.path(".")), ["counts.json"]);
}

#[test]
fn one_scene_can_be_tried_again_by_its_number() {
    let counts = |arguments: &[&str]| {
        let run = lightbuffer(["fuzz", "-q", "--json", "-"].iter().chain(arguments)).done();
        json(&run.stdout)["queries"].as_u64().unwrap()
    };
    let [all, first, second] = [
        counts(&["--scenes", "2", "--first", "5", "--threads", "2"]),
        counts(&["--scenes", "1", "--first", "5"]),
        counts(&["--scenes", "1", "--first", "6"]),
    ];
    assert_eq!(all, first + second);
}

#[test]
fn a_finding_of_the_past_is_asked_again() {
    let file = "tests/regressions/light-buffer-false-light-1-27.toml";
    let run = lightbuffer(["fuzz", "--replay", file]).done();
    for who in ["definition", "exact", "brute-force", "bounding-volumes", "light-buffer", "no longer there"] {
        assert!(run.stdout.contains(who), "{}", run.stdout);
    }
}

#[test]
fn what_cannot_be_written_or_read_is_refused() {
    let folder = Folder::new();
    let file = folder.path("file");
    std::fs::write(&file, "version = 1\nno finding").unwrap();
    let name = file.to_str().unwrap();
    let line = lightbuffer(["fuzz", "--scenes", "1", "-o", name]).failed();
    assert!(line.contains("cannot create the folder"), "{line}");
    let missing = folder.path("missing/counts.json");
    let line = lightbuffer(["fuzz", "--scenes", "1", "--json", missing.to_str().unwrap()]).failed();
    assert!(line.contains("cannot write"), "{line}");
    let line = lightbuffer(["fuzz", "--replay", name]).failed();
    assert!(line.contains("file:2"), "{line}");
    let line = lightbuffer(["fuzz", "--replay", missing.to_str().unwrap()]).failed();
    assert!(line.contains("cannot read"), "{line}");
    lightbuffer(["fuzz", "--replay", name, "--seed", "3"]).misused("cannot be used with");
}
