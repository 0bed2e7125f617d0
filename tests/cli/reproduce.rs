//! `reproduce`: the tables of the 1986 paper at a few pixels, their documents, and what is refused.

use crate::{Folder, json, lightbuffer, names};
use serde_json::Value;
use std::ffi::OsStr;
use std::path::Path;

fn reproduce(folder: &Path, options: &[&str]) -> crate::Run {
    let arguments = ["reproduce", "haines-greenberg", "-q", "--size", "48x45", "--repetitions", "1", "-o"];
    let arguments = arguments.map(OsStr::new).into_iter().chain([folder.as_os_str()]);
    lightbuffer(arguments.chain(options.iter().map(OsStr::new)))
}

fn column<'a>(environment: &'a Value, name: &str) -> &'a Value {
    let columns = environment["columns"].as_array().unwrap();
    columns.iter().find(|column| column["name"] == name).unwrap_or_else(|| panic!("{name} of {columns:?}"))
}

#[test]
fn a_table_is_measured_beside_the_papers() {
    let folder = Folder::new();
    let out = folder.path("out");
    let options = ["--environments", "chessboard", "--largest-resolution", "200", "--truth-samples", "500"];
    let run = reproduce(&out, &options).done();
    assert_eq!(names(&out), ["chessboard.svg", "reproduce.csv", "reproduce.json", "reproduce.txt"]);
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    assert_eq!(read("reproduce.txt"), run.stdout);
    assert!(run.stdout.contains("Figure 5, Chessboard") && run.stdout.contains("0 wrong answers"));
    assert!(read("chessboard.svg").starts_with("<svg ") && read("chessboard.svg").contains("1986, control"));

    let document = json(&read("reproduce.json"));
    let environments = document["environments"].as_array().unwrap();
    assert_eq!(environments.len(), 1);
    let chessboard = &environments[0];
    assert_eq!((&chessboard["width"], &chessboard["height"]), (&48.into(), &45.into()));
    assert_eq!(chessboard["counts"], chessboard["paper_counts"]);
    assert_eq!(chessboard["counts"]["polygons"], 4944);
    assert_eq!(chessboard["truth"]["wrong"], 0);
    assert_eq!(chessboard["truth"]["queries"], 500);
    for tester in ["brute-force", "bounding-volumes", "light-buffer"] {
        assert_eq!(chessboard["truth"]["testers"][tester], 0, "{tester}");
    }
    let named: Vec<_> = chessboard["columns"].as_array().unwrap().iter().map(|c| &c["name"]).collect();
    assert_eq!(named, ["control", "R = 10", "R = 20", "R = 50", "R = 100", "R = 200"]);
    let number = |value: &Value| value.as_f64().unwrap();
    let control = column(chessboard, "control");
    assert!(control["lists"].is_null() && control["paper"]["tests_per_ray"]["value"] == 99.0);
    assert!(column(chessboard, "R = 200")["paper"].is_null());
    for (name, resolution) in [("R = 10", 10.0), ("R = 100", 100.0)] {
        let found = column(chessboard, name);
        assert!(number(&found["tests_per_ray"]) < number(&control["tests_per_ray"]));
        let (items, squares) = (number(&found["lists"]["items"]), 6.0 * resolution * resolution * 4.0);
        assert!((items / squares - number(&found["lists"]["items_per_square"])).abs() < 1e-9);
        assert_eq!((&found["wrong"], &found["unlike_control"]), (&0.into(), &0.into()));
    }
    let csv = read("reproduce.csv");
    let fields = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == fields));
    assert!(csv.contains("chessboard,5,R = 10,10,tests_per_ray,,") && csv.contains(",20.9,no\n"));
}

#[test]
fn the_kitchen_is_asked_of_the_counter_tops_buffers() {
    let folder = Folder::new();
    let options =
        ["--environments", "kitchen,counter-top", "--largest-resolution", "100", "--truth-samples", "100"];
    let run = reproduce(&folder.path("out"), &[&options[..], &["--json", "-"]].concat()).done();
    let document = json(&run.stdout);
    let environments = document["environments"].as_array().unwrap();
    assert_eq!(environments.iter().map(|e| &e["name"]).collect::<Vec<_>>(), ["counter-top", "kitchen"]);
    let (near, far) = (&environments[0], &environments[1]);
    assert_eq!((&near["buffers_of"], &far["buffers_of"]), (&Value::Null, &"counter-top".into()));
    assert!(near["average_tree_size"] != far["average_tree_size"]);
    for name in ["R = 10", "R = 100"] {
        let (near, far) = (column(near, name), column(far, name));
        assert_eq!(near["lists"], far["lists"]);
        assert!(near["lists"]["transparent"].as_u64().unwrap() > 0);
        assert!(near["preprocess_seconds"].as_f64().unwrap() > 0.0 && far["preprocess_seconds"] == 0.0);
    }
    assert_eq!((&near["truth"]["wrong"], &far["truth"]["wrong"]), (&0.into(), &0.into()));
    assert!(near["check"]["paper_control_over_finest"].is_number());
    assert!(far["check"]["paper_control_over_finest"].is_null());
}

#[test]
fn what_there_is_not_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let out = folder.path("out");
    lightbuffer(["reproduce", "somebody-else", "-o", out.to_str().unwrap()]).misused("haines-greenberg");
    reproduce(&out, &["--environments", "chess"]).misused("house-of-cards");
    reproduce(&out, &["--largest-resolution", "5000"]).misused("4096");
    reproduce(&out, &["--truth-samples", "few"]).misused("--truth-samples");
    assert!(!out.exists());
}

#[test]
fn buffers_that_do_not_fit_are_skipped_by_name() {
    let folder = Folder::new();
    let options = ["--environments", "house-of-cards", "--memory-limit", "4M", "--truth-samples", "50"];
    let run = reproduce(&folder.path("out"), &options).done();
    assert!(run.stdout.contains("skipped for want of memory: R = 200, R = 500, R = 1000, R = 2048"));
}
