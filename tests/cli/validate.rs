//! `validate`: the document, the table and the exit code.

use crate::{BLOCKS, Folder, SIZE, json, lightbuffer, validate};
use serde_json::{Map, Value};

/// Counts and costs of a tester; keys of the contract, in the order that serde_json sorts them.
const TESTER: [&str; 8] = [
    "build_seconds",
    "bytes",
    "false_light",
    "false_shadow",
    "ns_per_query",
    "shadowed",
    "undecided",
    "wrong",
];
const VERDICTS: [&str; 5] = ["agree", "both_wrong", "embree_wrong", "native_wrong", "touching"];

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

fn number(value: &Value, key: &str) -> u64 {
    value[key].as_u64().unwrap_or_else(|| panic!("{key} of {value}"))
}

fn testers(value: &Value) -> &Map<String, Value> {
    value["testers"].as_object().unwrap()
}

fn names() -> Vec<&'static str> {
    let mut names: Vec<_> = lightbuffer::shadow::REGISTRY.iter().map(|entry| entry.name).collect();
    names.sort();
    names
}

#[test]
fn the_document_has_the_keys_that_are_promised() {
    let folder = Folder::new();
    let run = validate(BLOCKS, &folder.path("out"), &["--json", "-", "--lights", "2"]).done();
    let report = json(&run.stdout);
    let embree = cfg!(feature = "embree").then_some("embree");
    let mut expected: Vec<_> =
        ["height", "lights", "scene", "skipped", "threads", "totals", "version", "width"].into();
    expected.extend(["image_metrics", "machine", "replay"]);
    expected.extend(embree);
    expected.sort();
    assert_eq!(keys(&report), expected);
    assert_eq!(
        (&report["scene"], &report["width"], &report["height"]),
        (&"blocks.obj".into(), &96.into(), &54.into())
    );
    assert_eq!(report["skipped"], json("[]"));
    if embree.is_some() {
        assert_eq!(keys(&report["embree"]), ["epsilon", "flushes_denormals", "isa", "streams", "version"]);
        assert!(report["embree"]["version"].as_str().unwrap().split('.').count() == 3);
        assert!(!report["embree"]["isa"].as_str().unwrap().is_empty());
    }
    let lights = report["lights"].as_array().unwrap();
    assert_eq!(lights.iter().map(|l| &l["name"]).collect::<Vec<_>>(), ["light-1", "light-2"]);
    for light in lights {
        let promised = [
            "facing_away",
            "name",
            "not_receiving",
            "outside_cone",
            "queries",
            "testers",
            "verdicts",
            "wrong_pixels",
        ];
        assert_eq!(keys(light), promised);
    }
    assert_eq!(keys(&report["totals"]), ["queries", "testers", "verdicts"]);
    for place in lights.iter().chain([&report["totals"]]) {
        assert_eq!(keys(&place["verdicts"]), VERDICTS);
        assert_eq!(keys(&place["testers"]), names());
        for tester in testers(place).values() {
            let promised = keys(tester).into_iter().filter(|key| *key != "causes");
            assert_eq!(promised.collect::<Vec<_>>(), TESTER);
        }
    }
}

#[test]
fn its_numbers_agree_with_each_other() {
    let folder = Folder::new();
    let run = validate(BLOCKS, &folder.path("out"), &["--json", "-", "--lights", "3"]).done();
    let report = json(&run.stdout);
    let totals = &report["totals"];
    let mut sums = [0; 8];
    for light in report["lights"].as_array().unwrap() {
        let (queries, verdicts) = (number(light, "queries"), &light["verdicts"]);
        let judged = ["agree", "native_wrong", "embree_wrong", "both_wrong"].map(|key| number(verdicts, key));
        assert_eq!(judged.iter().sum::<u64>(), queries);
        assert!(number(verdicts, "touching") <= queries);
        assert!(queries > 0 && queries + number(light, "facing_away") <= 96 * 54);
        let truth = number(&light["testers"]["exact"], "shadowed");
        for (name, tester) in testers(light) {
            let [shadowed, false_shadow, false_light, wrong] =
                ["shadowed", "false_shadow", "false_light", "wrong"].map(|key| number(tester, key));
            assert_eq!(wrong, false_shadow + false_light, "{name}");
            assert_eq!(shadowed + false_light, truth + false_shadow, "{name}");
            assert!(tester["build_seconds"].as_f64().unwrap() >= 0.0, "{name}");
            assert!(tester["ns_per_query"].as_f64().unwrap() > 0.0, "{name}");
            assert!(number(tester, "bytes") > 0, "{name}");
            if ["exact", "brute-force", "bounding-volumes", "light-buffer"].contains(&name.as_str()) {
                assert_eq!(wrong, 0, "{name}");
            }
        }
        assert_eq!((judged[1], judged[3]), (0, 0));
        if cfg!(feature = "embree") {
            assert_eq!(judged[2], number(&light["testers"]["embree"], "wrong"));
        }
        let light_buffer = &light["testers"]["light-buffer"];
        let counts = [judged[0], judged[1], judged[2], judged[3], queries, number(verdicts, "touching")];
        let counts =
            counts.into_iter().chain([number(light_buffer, "undecided"), number(light_buffer, "bytes")]);
        sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
    }
    let verdicts = &totals["verdicts"];
    let expected = ["agree", "native_wrong", "embree_wrong", "both_wrong"].map(|key| number(verdicts, key));
    assert_eq!(sums[..4], expected);
    assert_eq!((sums[4], sums[5]), (number(totals, "queries"), number(verdicts, "touching")));
    let light_buffer = &totals["testers"]["light-buffer"];
    assert_eq!((sums[6], sums[7]), (number(light_buffer, "undecided"), number(light_buffer, "bytes")));
}

#[test]
fn json_on_standard_output_stands_there_alone_and_copies_are_equal() {
    let folder = Folder::new();
    let (out, copy) = (folder.path("out"), folder.path("copy.json"));
    let printed = validate(BLOCKS, &out, &["--json", "-"]).done();
    assert_eq!(printed.stdout, std::fs::read_to_string(out.join("validate.json")).unwrap());
    assert!(printed.stdout.starts_with("{\n") && printed.stdout.ends_with("\n}\n"));
    let run = validate(BLOCKS, &out, &["--json", copy.to_str().unwrap()]).done();
    let written = std::fs::read_to_string(out.join("validate.json")).unwrap();
    assert_eq!(written, std::fs::read_to_string(copy).unwrap());
    assert!(run.stdout.starts_with("light key: "), "{}", run.stdout);
}

#[test]
fn the_table_has_a_row_a_tester_and_a_sum() {
    let folder = Folder::new();
    let table = validate(BLOCKS, &folder.path("out"), &["--lights", "2"]).done().stdout;
    for name in names() {
        assert_eq!(table.lines().filter(|l| l.split_whitespace().next() == Some(name)).count(), 3, "{table}");
    }
    let header = "tester build ms ns/query memory false shadow false light wrong undecided";
    assert!(table.lines().any(|l| l.split_whitespace().collect::<Vec<_>>().join(" ") == header), "{table}");
    assert!(table.lines().last().unwrap().starts_with("0 of "), "{table}");
    assert!(table.contains("all lights: "), "{table}");
}

#[test]
fn only_the_testers_that_are_named_are_asked_beside_the_truth_and_the_pictures() {
    let folder = Folder::new();
    let run = validate(BLOCKS, &folder.path("out"), &["--testers", "brute-force", "--json", "-"]).done();
    assert_eq!(keys(&json(&run.stdout)["totals"]["testers"]), ["brute-force", "exact", "light-buffer"]);
    let options = ["--testers", "exact", "--shadow", "exact", "--json", "-"];
    let run = validate(BLOCKS, &folder.path("exact"), &options).done();
    assert_eq!(keys(&json(&run.stdout)["totals"]["testers"]), ["exact"]);
}

#[test]
fn the_arbiter_is_checked_against_integers_on_demand() {
    let folder = Folder::new();
    let options = ["--testers", "exact", "--check-arbiter", "500"];
    let table = validate(BLOCKS, &folder.path("out"), &options).done().stdout;
    assert!(table.contains("arbiter against all triangles in integers: 0 wrong of 500"), "{table}");
}

#[test]
fn points_that_all_face_away_are_reported() {
    let folder = Folder::new();
    let floor = folder.write("floor.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n");
    let (floor, out) = (floor.to_str().unwrap(), folder.path("out"));
    let options = ["validate", floor, SIZE[0], SIZE[1], "--light", "0.2,-5,0.2", "-o", out.to_str().unwrap()];
    let run = lightbuffer(options).done();
    assert!(run.stderr.contains("every visible point faces away from every light"), "{}", run.stderr);
    assert!(run.stdout.starts_with("light light-1: 0 queries, "), "{}", run.stdout);
    let report = json(&std::fs::read_to_string(out.join("validate.json")).unwrap());
    assert_eq!((number(&report["lights"][0], "queries"), number(&report["totals"], "queries")), (0, 0));
    assert!(number(&report["lights"][0], "facing_away") > 1000);
}

#[test]
fn statistics_say_what_was_built() {
    let folder = Folder::new();
    let run = validate(BLOCKS, &folder.path("out"), &["--stats", "--resolution", "17"]).done();
    for words in
        ["t-buffer: 5,184 rays", "key light-buffer: ", "  resolution: 17\n", "  triangles in cells: "]
    {
        assert!(run.stderr.contains(words), "{words:?} is not in {}", run.stderr);
    }
}

/// What is printed about a run with some options, and the bytes of its picture.
fn image(folder: &Folder, name: &str, options: &[&str]) -> (String, Vec<u8>) {
    let out = folder.path(name);
    let usual = ["--stats", "--resolution", "17", "--testers", "light-buffer"];
    let run = validate(BLOCKS, &out, &[&usual, options].concat());
    (run.done().stderr, std::fs::read(out.join("image.exr")).unwrap())
}

#[test]
fn culling_leaves_out_casters_and_changes_no_mask() {
    let folder = Folder::new();
    let image = |cull: &str| image(&folder, cull, &["--cull", cull]);
    let ((off, all), (solids, culled)) = (image("off"), image("solids"));
    // Without it nothing is counted that it would leave out: certified cells know nothing of it.
    assert!(!off.contains("  casters culled: "), "{off}");
    assert!(solids.contains("  casters culled: ") && !solids.contains("  casters culled: 0\n"), "{solids}");
    assert!(all == culled, "the pictures differ");
}

#[test]
fn bounding_volumes_and_object_coherence_change_no_mask() {
    let folder = Folder::new();
    let (plain, expected) = image(&folder, "plain", &[]);
    assert!(!plain.contains("  bounding-volume records: "), "{plain}");
    assert!(!plain.contains(" by the last occluder"), "{plain}");
    let (grouped, picture) = image(&folder, "grouped", &["--volume-threshold", "6"]);
    assert!(!grouped.contains("  bounding-volume records: 0\n"), "{grouped}");
    assert!(grouped.contains(" bounding volumes\n"), "{grouped}");
    assert!(picture == expected, "bounding volumes change the picture");
    let (coherent, picture) = image(&folder, "coherent", &["--object-coherence"]);
    assert!(coherent.contains(" by the last occluder\n"), "{coherent}");
    assert!(picture == expected, "object coherence changes the picture");
}
