//! `validate builtin:hard-cases`: its document, its table, and what is refused.

use crate::{Folder, json, lightbuffer};

const NAME: &str = "builtin:hard-cases";

#[test]
fn every_case_is_judged_and_no_native_answer_is_wrong() {
    let folder = Folder::new();
    let out = folder.path("out");
    let out = out.to_str().unwrap();
    let run = lightbuffer(["validate", NAME, "-q", "-o", out, "--resolution", "16"]).done();
    let report = json(&std::fs::read_to_string(folder.path("out").join("validate.json")).unwrap());
    assert_eq!((&report["scene"], &report["lights"]), (&NAME.into(), &json("[]")));
    let cases = report["cases"].as_array().unwrap();
    let numbers: Vec<u64> = cases.iter().map(|case| case["number"].as_u64().unwrap()).collect();
    assert_eq!(numbers, (1..=47).collect::<Vec<_>>());
    let mut queries = 0;
    for case in cases {
        let name = case["name"].as_str().unwrap();
        assert!(!name.is_empty());
        queries += case["queries"].as_u64().unwrap();
        for tester in ["exact", "brute-force", "bounding-volumes", "light-buffer"] {
            assert_eq!(case["testers"][tester]["wrong"], 0, "{name}: {tester}");
            assert!(case["testers"][tester]["refused"].is_null(), "{name}: {tester}");
        }
        assert!(case["testers"]["shadow-buffer"].is_null(), "{name}");
        if cfg!(feature = "embree") {
            let embree = &case["testers"]["embree"];
            assert!(embree["wrong"].is_u64() || embree["refused"].is_string(), "{name}: {embree}");
        }
        assert!(run.stdout.contains(name), "{name}");
    }
    assert_eq!(report["totals"]["queries"], queries);
    assert_eq!(report["totals"]["verdicts"]["native_wrong"], 0);
    let last = run.stdout.lines().last().unwrap();
    assert!(last.starts_with("0 of ") && last.contains(" native answers wrong; "), "{last}");
    let pictures = (1..=47).map(|number| format!("case-{number:02}.svg"));
    let files: Vec<_> = pictures.chain(["validate.json".into()]).collect();
    assert_eq!(crate::names(&folder.path("out")), files);
    let sliver = std::fs::read_to_string(folder.path("out").join("case-27.svg")).unwrap();
    assert!(sliver.starts_with("<svg") && sliver.contains("Embree wrong"), "{sliver}");
}

#[test]
fn they_are_for_validate_alone_and_without_a_camera() {
    let folder = Folder::new();
    let out = folder.path("out");
    let [exr, toml] = ["a.exr", "a.toml"].map(|name| folder.path(name).to_str().unwrap().to_owned());
    let commands: [&[&str]; 3] =
        [&["render", NAME, "-o", &exr], &["info", NAME], &["generate", "hard-cases", "-o", &toml]];
    for command in commands {
        let line = lightbuffer(command).failed();
        assert!(line.contains("builtin:hard-cases is for `validate` alone"), "{line}");
    }
    let options: [&[&str]; 7] = [
        &["--size", "64x64"],
        &["--light", "1,2,3"],
        &["--lights", "2"],
        &["--camera", "eye"],
        &["--stats"],
        &["--shadow", "brute-force"],
        &["--sweep-epsilon"],
    ];
    for option in options {
        let arguments = [&["validate", NAME, "-o", out.to_str().unwrap()], option].concat();
        let line = lightbuffer(arguments).failed();
        assert!(line.contains(option[0]), "{line}");
    }
    assert!(!out.exists());
}
