//! `bench`: its documents at a few pixels, its ratios and exit codes, and what is refused.

use crate::{BLOCKS, Folder, Run, json, lightbuffer, names};
use serde_json::Value;
use std::ffi::OsStr;
use std::path::Path;

fn bench(scenes: &[&str], folder: &Path, options: &[&str]) -> Run {
    let arguments = ["bench", "-q", "--size", "64x36", "--repeats", "2", "--truth-samples", "200", "-o"];
    let arguments = arguments.map(OsStr::new).into_iter().chain([folder.as_os_str()]);
    let scenes = scenes.iter().map(OsStr::new);
    lightbuffer(arguments.chain(scenes).chain(options.iter().map(OsStr::new)))
}

fn rows<'a>(document: &'a Value, key: &str) -> &'a [Value] {
    document[key].as_array().unwrap()
}

const TESTERS: &str = "--testers";

#[test]
fn the_document_has_the_keys_that_were_agreed() {
    let folder = Folder::new();
    let out = folder.path("out");
    let run = bench(&[BLOCKS], &out, &[TESTERS, "light-buffer,brute-force", "--threads", "2,1"]).done();
    assert_eq!(names(&out), ["bench.csv", "bench.json", "speed-error.svg"]);
    let document = json(&std::fs::read_to_string(out.join("bench.json")).unwrap());
    assert!(document["machine"]["cores"].as_u64().unwrap() >= 1);
    assert!(document["machine"]["cpu"].is_string());
    let all = rows(&document, "rows");
    // Two testers in two orders, with two numbers of threads.
    assert_eq!(all.len(), 8);
    let keys = ["primitives", "lights", "threads", "queries", "wrong", "wrong_checked", "bytes", "rounds"];
    let times = ["build_seconds", "query_seconds", "frame_seconds", "ns_per_query"];
    for row in all {
        assert!(row["scene"].as_str().unwrap().contains("blocks") && row["parameter"].is_string());
        assert!(keys.iter().all(|key| row[key].is_u64()), "{row}");
        assert!(times.iter().all(|key| row[key].as_f64().is_some_and(|time| time > 0.0)), "{row}");
        assert_eq!((&row["wrong"], &row["side"]), (&0.into(), &"native".into()));
        assert!(row["wrong_checked"].as_u64().unwrap() >= 200);
        let frame = row["frame_seconds"].as_f64().unwrap();
        assert!(frame >= row["build_seconds"].as_f64().unwrap());
        assert_eq!(row["interleaved"].as_bool().unwrap(), row["rounds"] == 2);
    }
    let threads: Vec<_> = rows(&document, "ratios").iter().map(|ratio| ratio["threads"].as_u64()).collect();
    assert_eq!(threads, [Some(2), Some(1)]);
    // Nobody of Embree's was asked.
    assert!(
        rows(&document, "ratios").iter().all(|ratio| ratio["query"].is_null() && ratio["frame"].is_null())
    );
    assert!(run.stdout.contains("ns/query") && run.stdout.contains("brute-force"));
    let csv = std::fs::read_to_string(out.join("bench.csv")).unwrap();
    let fields = csv.lines().next().unwrap().split(',').count();
    assert_eq!(csv.lines().count(), 9);
    assert!(csv.lines().all(|line| line.split(',').count() == fields));
}

#[test]
fn resolutions_are_rows_and_the_copy_is_the_document() {
    let folder = Folder::new();
    let out = folder.path("out");
    let options = [TESTERS, "light-buffer", "--resolution", "16,64,auto", "--lights", "2", "--json", "-"];
    let run = bench(&["builtin:house-of-cards"], &out, &options).done();
    assert_eq!(run.stdout, std::fs::read_to_string(out.join("bench.json")).unwrap());
    let document = json(&run.stdout);
    let parameters: Vec<_> =
        rows(&document, "rows").iter().map(|row| row["parameter"].as_str().unwrap()).collect();
    let orders = ["rows", "tiles"];
    let expected: Vec<String> = ["16", "64", "auto"]
        .iter()
        .flat_map(|r| orders.map(|order| format!("R={r} order={order}")))
        .collect();
    assert_eq!(parameters, expected);
    assert!(rows(&document, "rows").iter().all(|row| row["lights"] == 2 && row["wrong"] == 0));
}

#[cfg(feature = "embree")]
#[test]
fn embree_over_native_is_a_ratio_for_each_scene_in_the_order_given() {
    let folder = Folder::new();
    let out = folder.path("out");
    let testers =
        "light-buffer,shadow-buffer,embree,embree-fast,embree-fast-packet8-low,embree-fast-packet1-low-ftz";
    let options = [TESTERS, testers, "--epsilon", "1e-4,0,1e-2", "--threads", "1", "--json", "-"];
    let run = bench(&[BLOCKS, "builtin:three-spheres"], &out, &options).done();
    let document = json(&run.stdout);
    assert!(document["machine"]["embree"].is_string());
    let ratios = rows(&document, "ratios");
    assert_eq!(ratios.len(), 2);
    assert!(ratios[0]["scene"].as_str().unwrap().contains("blocks"));
    assert_eq!(ratios[1]["scene"], "builtin:three-spheres");
    for ratio in ratios {
        let fastest = |side: &str, time: &str| {
            let of_side = rows(&document, "rows").iter().filter(|row| {
                row["scene"] == ratio["scene"] && row["side"] == side && row["interleaved"] == true
            });
            of_side.map(|row| row[time].as_f64().unwrap()).fold(f64::MAX, f64::min)
        };
        for (key, time) in [("query", "query_seconds"), ("frame", "frame_seconds")] {
            let expected = fastest("embree", time) / fastest("native", time);
            assert!((ratio[key].as_f64().unwrap() / expected - 1.0).abs() < 1e-12, "{ratio}");
        }
    }
    let epsilons = |scene: &str| {
        let of_scene = rows(&document, "rows").iter().filter(|row| row["scene"] == scene);
        of_scene.filter_map(|row| row["epsilon"].as_f64()).filter(|&epsilon| epsilon != 1e-4).count()
    };
    assert_eq!(epsilons("builtin:three-spheres"), 2);
    assert!(rows(&document, "rows").iter().any(|row| row["side"] == "approximate"));
}

#[test]
fn growth_is_measured_step_by_step() {
    let folder = Folder::new();
    let out = folder.path("out");
    let options = [TESTERS, "light-buffer", "--growth", "triangles", "--json", "-"];
    let document = json(&bench(&["builtin:stacked-triangles"], &out, &options).done().stdout);
    let triangles: Vec<u64> =
        rows(&document, "growth").iter().map(|step| step["at"].as_u64().unwrap()).collect();
    assert!(triangles.len() > 5 && triangles.is_sorted() && triangles[0] == 1);
    assert!(rows(&document, "growth").iter().all(|step| step["over"] == "triangles"));
    assert!(rows(&document, "rows").is_empty());
    assert_eq!(names(&out), ["bench.csv", "bench.json", "growth-triangles.svg"]);
    let lights = [TESTERS, "light-buffer", "--growth", "lights", "--json", "-"];
    let document = json(&bench(&[BLOCKS], &folder.path("lights"), &lights).done().stdout);
    let counts: Vec<_> =
        rows(&document, "growth").iter().map(|step| step["lights"].as_u64().unwrap()).collect();
    assert_eq!(counts, [1, 2, 4, 8, 16, 32, 64]);
}

#[test]
fn what_is_too_slow_or_too_large_is_skipped_by_name() {
    let folder = Folder::new();
    let out = folder.path("out");
    let options = [
        TESTERS,
        "light-buffer,shadow-buffer",
        "--resolution",
        "4096",
        "--memory-limit",
        "64M",
        "--json",
        "-",
    ];
    let document = json(&bench(&[BLOCKS], &out, &options).done().stdout);
    let skipped = rows(&document, "skipped");
    assert!(skipped.iter().any(|one| one["tester"] == "light-buffer"), "{skipped:?}");
    assert!(skipped[0]["why"].as_str().unwrap().contains("--memory-limit"));
    assert!(rows(&document, "ratios")[0]["query"].is_null());
}

#[test]
fn what_there_is_not_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let out = folder.path("out");
    let refused = |options: &[&str], words: &str| {
        bench(&[BLOCKS], &out, options).misused(words);
        assert!(!out.exists(), "{options:?}");
    };
    refused(&[TESTERS, "magic"], "no shadow tester `magic`");
    refused(&[TESTERS, "exact"], "it is the arbiter");
    refused(&["--resolution", "0"], "4096");
    refused(&["--resolution", "64,,auto"], "--resolution");
    refused(&["--epsilon", "0.5"], "--epsilon");
    refused(&["--threads", "0"], "--threads");
    refused(&["--repeats", "0"], "--repeats");
    refused(&["--growth", "cameras"], "triangles");
    refused(&["--growth", "triangles"], "built-in scenes");
    refused(&["--growth", "lights", "--lights", "3"], "1 to 64");
    refused(&["--memory-limit", "1K"], "--memory-limit");
    bench(&["builtin:kitchen"], &out, &["--growth", "triangles"]).misused("one size");
    bench(&["nothing.obj"], &out, &[]).misused("nothing.obj");
    lightbuffer(["bench", "-o", out.to_str().unwrap()]).misused("SCENE");
    assert!(!out.exists());
}

#[test]
fn a_result_never_replaces_a_scene() {
    let folder = Folder::new();
    let scene = folder.write("bench.json", "{}");
    let toml = folder.path("bench.csv");
    std::fs::copy("scenes/blocks.obj", &toml).unwrap();
    // A scene by the name of a result would be replaced by it: neither is one that can be read.
    for name in [scene, toml] {
        let line = bench(&[name.to_str().unwrap()], &folder.path(""), &[]).failed();
        assert!(line.contains("bench."), "{line}");
    }
}

#[test]
fn first_hits_of_the_t_buffer_stand_beside_those_of_embree() {
    let folder = Folder::new();
    let out = folder.path("out");
    let options = ["--first-hits", TESTERS, "bounding-volumes", "--finalists", "1", "--threads", "1,2"];
    let run = bench(&[BLOCKS], &out, &options).done();
    assert!(run.stdout.contains("Embree over t-buffer"), "{}", run.stdout);
    let document = json(&std::fs::read_to_string(out.join("bench.json")).unwrap());
    let reports = rows(&document, "first_hits");
    assert_eq!(reports.iter().map(|report| report["threads"].as_u64().unwrap()).collect::<Vec<_>>(), [1, 2]);
    for report in reports {
        let rows = rows(report, "rows");
        assert_eq!((&rows[0]["method"], &rows[0]["differ"]), (&"t-buffer".into(), &0.into()));
        assert!(
            rows.len() > 30
                && rows[1..].iter().all(|row| row["method"].as_str().unwrap().starts_with("embree-fast"))
        );
        let in_rounds: Vec<_> = rows.iter().filter(|row| row["interleaved"] == true).collect();
        assert!((2..=3).contains(&in_rounds.len()) && in_rounds.iter().all(|row| row["rounds"] == 2));
        // Embree sees the same but where a ray passes an edge within its rounding.
        let pixels = report["width"].as_u64().unwrap() * report["height"].as_u64().unwrap();
        assert!(rows.iter().all(|row| row["differ"].as_u64().unwrap() * 1000 < pixels));
        let best = |key: &str| {
            let times = in_rounds[1..].iter().map(|row| row[key].as_f64().unwrap());
            times.reduce(f64::min).unwrap() / rows[0][key].as_f64().unwrap()
        };
        assert!((report["frame"].as_f64().unwrap() / best("frame_seconds") - 1.0).abs() < 1e-9);
        assert!((report["query"].as_f64().unwrap() / best("query_seconds") - 1.0).abs() < 1e-9);
    }
}
