//! `render`: one picture, with or without a verdict.

use crate::{BLOCKS, Folder, Run, SIZE, json, lightbuffer, names, validate};
use lightbuffer::film::{ImagePlanes, read_exr};

fn render(folder: &Folder, name: &str, options: &[&str]) -> Run {
    let path = folder.path(name);
    let arguments = ["render", BLOCKS, SIZE[0], SIZE[1], "-o", path.to_str().unwrap()];
    lightbuffer(arguments.iter().chain(options))
}

fn shadows(image: &ImagePlanes) -> Vec<&str> {
    let names = image.channels().iter().map(|c| c.name.as_str());
    names.filter(|name| name.starts_with("shadow.")).collect()
}

#[test]
fn a_picture_and_its_preview_are_written_and_said() {
    let folder = Folder::new();
    let run = render(&folder, "picture.exr", &[]).done();
    assert_eq!(names(&folder.path("")), ["picture.exr", "picture.png"]);
    assert_eq!(run.stdout, "");
    assert!(run.stderr.ends_with(&format!("lightbuffer: wrote {}\n", folder.path("picture.exr").display())));
    assert_eq!(render(&folder, "quiet.exr", &["-q"]).done().stderr, "");
}

#[cfg(feature = "embree")]
#[test]
fn verdicts_are_in_the_picture_unless_left_out() {
    let folder = Folder::new();
    render(&folder, "judged.exr", &[]).done();
    render(&folder, "plain.exr", &["--no-verdict"]).done();
    let [judged, plain] = ["judged.exr", "plain.exr"].map(|name| read_exr(&folder.path(name)).unwrap());
    assert_eq!(
        shadows(&judged),
        ["shadow.key.difference", "shadow.key.embree", "shadow.key.light-buffer", "shadow.key.verdict"]
    );
    assert_eq!(shadows(&plain), ["shadow.key.light-buffer"]);
    for name in ["R", "Z", "N.X", "shadow.key.light-buffer"] {
        assert_eq!(judged.channel(name), plain.channel(name), "{name}");
    }
}

#[test]
fn exact_testers_draw_the_picture_of_the_truth() {
    let folder = Folder::new();
    for tester in ["exact", "brute-force", "bounding-volumes", "light-buffer"] {
        render(&folder, &format!("{tester}.exr"), &["--no-verdict", "--shadow", tester]).done();
    }
    validate(BLOCKS, &folder.path("out"), &[]).done();
    let truth = read_exr(&folder.path("out/image.exr")).unwrap();
    for tester in ["exact", "brute-force", "bounding-volumes", "light-buffer"] {
        let image = read_exr(&folder.path(&format!("{tester}.exr"))).unwrap();
        assert_eq!(shadows(&image), [format!("shadow.key.{tester}")]);
        assert_eq!(image.attribute("shadow"), Some(tester));
        for (name, like) in [("R", "R"), ("G", "G"), (&format!("shadow.key.{tester}"), "shadow.key.exact")] {
            assert_eq!(image.channel(name).unwrap(), truth.channel(like).unwrap(), "{tester}: {name}");
        }
    }
}

#[test]
fn facts_of_the_run_are_printed_as_json() {
    let folder = Folder::new();
    let run = render(&folder, "picture.exr", &["-q", "--no-verdict", "--lights", "2", "--json", "-"]).done();
    let facts = json(&run.stdout);
    assert_eq!((&facts["shadow"], &facts["width"]), (&"light-buffer".into(), &96.into()));
    let image = read_exr(&folder.path("picture.exr")).unwrap();
    for light in facts["lights"].as_array().unwrap() {
        let mask =
            image.channel(&format!("shadow.{}.light-buffer", light["name"].as_str().unwrap())).unwrap();
        assert_eq!(light["shadowed"], mask.iter().filter(|&&m| m == 1.0).count());
    }
}

#[test]
fn exposure_is_for_the_preview_alone() {
    let folder = Folder::new();
    render(&folder, "dark.exr", &["--no-verdict"]).done();
    render(&folder, "light.exr", &["--no-verdict", "--exposure", "1.5"]).done();
    let read = |name: &str| std::fs::read(folder.path(name)).unwrap();
    assert!(read("dark.exr") == read("light.exr"));
    let brightness = |name: &str| {
        let picture = image::open(folder.path(name)).unwrap().to_rgb8();
        picture.as_raw().iter().map(|&v| u64::from(v)).sum::<u64>()
    };
    assert!(brightness("light.png") > brightness("dark.png") * 6 / 5);
}
