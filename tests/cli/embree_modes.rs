//! Modes of Embree by name, and all of them at once.

use crate::{BLOCKS, Folder, json, validate};

#[cfg(feature = "embree")]
mod with_embree {
    use super::*;
    use lightbuffer::embree::{Device, EmbreeMode};
    use lightbuffer::film::read_exr;
    use lightbuffer::shadow::REGISTRY;

    /// Names of the modes that the switch adds, in the table's order.
    fn modes() -> Vec<String> {
        let device = Device::new(1).unwrap();
        let there = |mode: &EmbreeMode| mode.is_for_speed() && mode.expect_in(&device).is_ok();
        let modes: Vec<_> = EmbreeMode::all().filter(there).map(|mode| mode.to_string()).collect();
        assert_eq!(modes.len(), if device.has_streams() { 60 } else { 48 });
        modes
    }

    #[test]
    fn all_modes_have_rows_and_leave_the_pictures_alone() {
        let folder = Folder::new();
        let (out, usual) = (folder.path("out"), folder.path("usual"));
        let table = validate(BLOCKS, &out, &["--embree-modes"]).done().stdout;
        let report = json(&std::fs::read_to_string(out.join("validate.json")).unwrap());
        let testers = report["totals"]["testers"].as_object().unwrap();
        let usual_names = || REGISTRY.iter().map(|entry| entry.name.to_owned());
        assert_eq!(testers.len(), usual_names().chain(modes()).count());
        let rows: Vec<_> = table.lines().filter(|line| line.starts_with("  ")).collect();
        assert!(rows.iter().all(|row| row.len() <= 110), "{table}");
        let names: Vec<_> = rows.iter().skip(1).map(|row| row.split_whitespace().next().unwrap()).collect();
        assert_eq!(names, usual_names().chain(modes()).collect::<Vec<_>>(), "{table}");
        let queries = report["totals"]["queries"].as_u64().unwrap();
        for name in modes() {
            let tester = &testers[&name];
            assert!(tester["wrong"].as_u64().unwrap() * 50 < queries, "{name}: {tester}");
            assert!(tester["shadowed"].as_u64().unwrap() > 50, "{name}: {tester}");
            assert!(tester["build_seconds"].as_f64().unwrap() > 0.0, "{name}: {tester}");
            assert!(tester["ns_per_query"].as_f64().unwrap() > 0.0, "{name}: {tester}");
        }
        validate(BLOCKS, &usual, &[]).done();
        for name in ["image.exr", "key.verdict.png", "key.difference.png"] {
            let [with, without] = [&out, &usual].map(|folder| std::fs::read(folder.join(name)).unwrap());
            assert!(with == without, "{name} depends on --embree-modes");
        }
    }

    #[test]
    fn a_mode_that_is_named_has_a_row_and_a_channel() {
        let folder = Folder::new();
        let mode = "embree-robust-packet8-high-ftz";
        let options = ["--testers", &format!("embree,{mode}"), "--json", "-"];
        let report = json(&validate(BLOCKS, &folder.path("out"), &options).done().stdout);
        let testers = report["totals"]["testers"].as_object().unwrap();
        assert_eq!(testers.keys().collect::<Vec<_>>(), ["embree", mode, "exact", "light-buffer"]);
        let image = read_exr(&folder.path("out").join("image.exr")).unwrap();
        let mask = image.channel(&format!("shadow.key.{mode}")).unwrap();
        assert_eq!(testers[mode]["shadowed"], mask.iter().filter(|&&sample| sample == 1.0).count());
        assert_eq!(image.attribute("testers"), Some(format!("exact light-buffer embree {mode}").as_str()));
    }

    /// The switch beside names: a mode that is named too keeps its channel, and nothing is asked twice.
    #[test]
    fn names_and_the_switch_go_together() {
        let folder = Folder::new();
        let mode = "embree-fast-packet4-low";
        let options = ["--testers", mode, "--embree-modes", "--json", "-"];
        let report = json(&validate(BLOCKS, &folder.path("out"), &options).done().stdout);
        let mut expected: Vec<_> =
            modes().into_iter().chain(["exact", "light-buffer"].map(String::from)).collect();
        expected.sort();
        let testers = report["totals"]["testers"].as_object().unwrap();
        assert_eq!(testers.keys().collect::<Vec<_>>(), expected.iter().collect::<Vec<_>>());
        let image = read_exr(&folder.path("out").join("image.exr")).unwrap();
        let masks: Vec<_> = image.channels().iter().filter(|c| c.name.contains("embree")).collect();
        assert_eq!(masks.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), [format!("shadow.key.{mode}")]);
    }

    #[test]
    fn modes_make_pictures_too() {
        let folder = Folder::new();
        let options =
            ["--testers", "exact", "--shadow", "embree-fast-packet1-medium-incoherent", "--json", "-"];
        let report = json(&validate(BLOCKS, &folder.path("out"), &options).done().stdout);
        assert!(report["totals"]["testers"]["embree-fast-packet1-medium-incoherent"]["shadowed"].is_u64());
    }

    #[test]
    fn modes_that_are_not_there_are_refused_before_any_work() {
        let folder = Folder::new();
        let run = |options: &[&str]| validate(BLOCKS, &folder.path("out"), options);
        for name in ["embree-fast-packet2-low", "embree-slow-packet1-low", "embree-fast-packet16-high-daz"] {
            run(&["--testers", name]).misused(EmbreeMode::GRAMMAR);
            run(&["--testers", name]).misused(&format!("no shadow tester `{name}`; there are: exact, "));
        }
        if !Device::new(1).unwrap().has_streams() {
            run(&["--testers", "embree-fast-stream-low"]).misused("no ray streams");
            run(&["--shadow", "embree-fast-stream-low"]).misused("no ray streams");
        }
        assert!(!folder.path("out").exists());
    }
}

#[cfg(not(feature = "embree"))]
#[test]
fn without_embree_its_modes_are_no_testers() {
    let folder = Folder::new();
    let run = |options: &[&str]| validate(BLOCKS, &folder.path("out"), options);
    for name in ["embree", "embree-fast", "embree-fast-packet16-high-ftz"] {
        run(&["--testers", name]).misused(&format!(
            "no shadow tester `{name}` (built without the feature `embree`); there are: exact, "
        ));
    }
    run(&["--embree-modes"]).misused("--embree-modes: built without the feature `embree`");
    assert!(!folder.path("out").exists());
    // The rest of it is there.
    json(&validate(BLOCKS, &folder.path("out"), &["--json", "-"]).done().stdout);
}
