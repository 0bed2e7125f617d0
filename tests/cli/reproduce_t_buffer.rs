//! `reproduce raghuvanshi-dhande`: the figures of the t-buffer paper at a few pixels and objects.

use crate::{Folder, Run, json, lightbuffer, names};
use lightbuffer::film::read_exr;
use serde_json::Value;
use std::ffi::OsStr;
use std::path::Path;

fn reproduce(folder: &Path, options: &[&str]) -> Run {
    let arguments = ["reproduce", "raghuvanshi-dhande", "-q", "--size", "40x30", "--repetitions", "1", "-o"];
    let arguments = arguments.map(OsStr::new).into_iter().chain([folder.as_os_str()]);
    lightbuffer(arguments.chain(options.iter().map(OsStr::new)))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("{value} is no list"))
}

fn curve<'a>(figure: &'a Value, kind: &str, name: &str) -> &'a Value {
    let found = list(&figure["curves"]).iter().find(|curve| curve["kind"] == kind && curve["name"] == name);
    found.unwrap_or_else(|| panic!("{kind}: {name} of {}", figure["curves"]))
}

fn fact<'a>(figure: &'a Value, words: &str) -> &'a Value {
    let found = list(&figure["facts"]).iter().find(|fact| fact["what"].as_str().unwrap().contains(words));
    found.unwrap_or_else(|| panic!("{words} of {}", figure["facts"]))
}

fn places(curve: &Value) -> Vec<f64> {
    list(&curve["points"]).iter().map(|point| number(&point[0])).collect()
}

#[test]
fn pictures_have_what_is_switched_on() {
    let folder = Folder::new();
    let out = folder.path("out");
    let run = reproduce(&out, &["--figures", "9,10,11,12", "--most-objects", "60"]).done();
    let document = json(&std::fs::read_to_string(out.join("reproduce.json")).unwrap());
    let figures = list(&document["figures"]);
    assert_eq!(figures.iter().map(|f| &f["figure"]).collect::<Vec<_>>(), [9, 10, 11, 12]);
    assert_eq!(document["native_wrong"], 0);
    let picture = |i: usize| &figures[i]["pictures"][0];
    assert_eq!(picture(0)["left_out"], serde_json::json!(["reflections", "textures"]));
    assert_eq!(picture(1)["left_out"], serde_json::json!(["textures"]));
    assert_eq!(picture(2)["left_out"], serde_json::json!([]));
    assert_eq!(picture(2)["shadow"], "shadow-buffer 400 x 800");
    for i in 0..3 {
        assert_eq!(picture(i)["unlike_classical"], 0);
        let wrong = number(&picture(i)["errors"]["wrong_share"]);
        assert!(if i < 2 { wrong == 0.0 } else { wrong < 0.1 }, "{wrong}");
    }
    // Mirrors show more points that ask for light.
    assert!(number(&picture(1)["queries"]) > number(&picture(0)["queries"]));
    let stacks: Vec<_> = list(&figures[3]["pictures"]).iter().map(|p| (&p["scene"], &p["objects"])).collect();
    assert_eq!(stacks.len(), 4);
    assert_eq!(stacks[1], (&"builtin:stacked-spheres".into(), &50.into()));
    assert_eq!(stacks[2], (&"builtin:stacked-triangles".into(), &3.into()));
    let files = names(&out);
    for figure in figures {
        assert_eq!((&figure["width"], &figure["height"]), (&40.into(), &30.into()));
        for picture in list(&figure["pictures"]) {
            for kind in ["png", "exr"] {
                assert!(files.iter().any(|file| picture[kind] == file.as_str()), "{picture}");
            }
        }
    }
    let image = read_exr(&out.join("figure-9.exr")).unwrap();
    assert_eq!(image.attribute("leftOut"), Some("reflections textures"));
    assert!(image.channel("shadow.lamp.brute-force").is_some());
    assert!(
        run.stdout.contains("Figure 11: ") && run.stdout.ends_with("0 wrong answers of what must be exact\n")
    );
}

#[test]
fn gains_follow_from_what_was_counted() {
    let folder = Folder::new();
    let out = folder.path("out");
    let run = reproduce(&out, &["--figures", "13,14,15,16", "--most-objects", "60", "--json", "-"]).done();
    let document = json(&run.stdout);
    assert_eq!(std::fs::read_to_string(out.join("reproduce.json")).unwrap(), run.stdout);
    assert_eq!(document["native_wrong"], 0);
    let kinds: Vec<_> = list(&document["series"]).iter().map(|series| &series["kind"]).collect();
    assert_eq!(kinds, ["spheres", "triangles"]);
    let [times, alone, coarse, fine] = list(&document["figures"]) else { panic!("four figures") };
    for (kind, series) in ["spheres", "triangles"].into_iter().zip(list(&document["series"])) {
        for frame in list(&series["frames"]) {
            let tests = |of: &Value| number(&of["tests"]);
            let shadow = tests(&frame["testers"][0]);
            assert_eq!(frame["testers"][0]["name"], "brute-force");
            assert_eq!(tests(&frame["classical"]), 1200.0 * number(&frame["objects"]));
            let predicted = (tests(&frame["classical"]) + shadow) / (tests(&frame["t_buffer"]) + shadow);
            assert!((predicted - number(&frame["predicted_gain"])).abs() < 1e-9);
            assert!(predicted > 1.0 && predicted < number(&frame["gain_limit"]));
            assert!(number(&frame["covered"]) >= 0.99 * 1200.0);
        }
        for name in ["classical", "t-buffer", "t-buffer and light-buffer"] {
            assert_eq!(places(curve(times, kind, name)), [10.0, 20.0, 50.0, 60.0]);
        }
        assert_eq!(places(curve(alone, kind, "predicted by counted tests")), [10.0, 20.0, 50.0, 60.0]);
        let gain = curve(coarse, kind, "shadow-buffer 400 x 800");
        let r_squared = number(&gain["fit"]["r_squared"]);
        assert!((0.0..=1.0).contains(&r_squared));
        assert_eq!(list(&gain["fit"]["coefficients"]).len(), 2);
        assert_eq!(number(&fact(coarse, &format!("{kind}: r^2"))["measured"]), r_squared);
        // Both sizes are in figure 16.
        for rows in ["1000 x 2000", "400 x 800"] {
            assert_eq!(places(curve(fine, kind, &format!("shadow-buffer {rows}"))).len(), 4);
        }
    }
    assert_eq!(fact(alone, "spheres: at 60 objects gain")["paper"], 2.2);
    assert!(fact(alone, "triangles: at 60 objects gain")["paper"].is_null());
    assert_eq!(
        names(&out),
        [
            "figure-13.svg",
            "figure-14.svg",
            "figure-15.svg",
            "figure-16.svg",
            "reproduce.csv",
            "reproduce.json",
            "reproduce.txt"
        ]
    );
    let csv = std::fs::read_to_string(out.join("reproduce.csv")).unwrap();
    let fields = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|line| line.split(',').count() == fields), "{csv}");
    assert!(std::fs::read_to_string(out.join("figure-15.svg")).unwrap().starts_with("<svg "));
}

#[test]
fn errors_of_the_shadow_buffer_fall_with_its_cells() {
    let folder = Folder::new();
    let out = folder.path("out");
    let run = reproduce(&out, &["--figures", "17,18", "--most-objects", "20"]).done();
    let document = json(&std::fs::read_to_string(out.join("reproduce.json")).unwrap());
    let [times, quality] = list(&document["figures"]) else { panic!("two figures") };
    let all = &times["curves"][0];
    assert_eq!(places(all), (1..=10).map(|step| f64::from(200 * step)).collect::<Vec<_>>());
    assert_eq!(list(&all["fit"]["coefficients"]).len(), 3);
    let correlation = fact(times, "correlation");
    assert_eq!(correlation["paper"], 0.9996);
    assert!((0.0..=1.0).contains(&number(&correlation["measured"])), "{correlation}");
    // Times are noisy; a hundred times as many cells are not.
    let filling = list(&times["curves"][1]["points"]);
    assert!(number(&filling[9][1]) > number(&filling[0][1]), "{filling:?}");
    let pictures = list(&quality["pictures"]);
    assert_eq!(pictures.len(), 6);
    assert_eq!((&pictures[0]["shadow"], &pictures[0]["errors"]["wrong"]), (&"brute-force".into(), &0.into()));
    let wrong = |i: usize| number(&pictures[i]["errors"]["wrong"]);
    assert!(wrong(1) > 0.0 && wrong(5) < wrong(1));
    for picture in &pictures[1..] {
        let errors = &picture["errors"];
        assert_eq!(
            number(&errors["wrong"]),
            number(&errors["false_shadow"]) + number(&errors["false_light"])
        );
        assert!(number(&picture["edges"]["share"]) > 0.9, "{picture}");
    }
    assert!(run.stdout.contains("within a cell of an edge"));
}

#[test]
fn options_of_the_other_paper_are_refused() {
    let folder = Folder::new();
    let out = folder.path("out");
    let line = reproduce(&out, &["--environments", "chessboard"]).failed();
    assert!(line.ends_with("--environments is for `reproduce haines-greenberg` alone"), "{line}");
    let other = ["reproduce", "haines-greenberg", "--most-objects", "9", "-o", out.to_str().unwrap()];
    assert!(
        lightbuffer(other).failed().contains("--most-objects is for `reproduce raghuvanshi-dhande` alone")
    );
    reproduce(&out, &["--figures", "8"]).misused("figures from 9 to 18");
    reproduce(&out, &["--most-objects", "0"]).misused("--most-objects");
    assert!(!out.exists());
}
