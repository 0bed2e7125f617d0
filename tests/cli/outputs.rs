//! What `validate` leaves: the channels of the picture, the maps, and nothing else.

use crate::{BLOCKS, Folder, HEIGHT, WIDTH, json, names, validate};
use lightbuffer::film::{ImagePlanes, read_exr};
use std::path::Path;
use std::process::Command;

/// The channels beside those of the lights.
const PICTURE: [&str; 15] = [
    "R",
    "G",
    "B",
    "A",
    "Z",
    "P.X",
    "P.Y",
    "P.Z",
    "N.X",
    "N.Y",
    "N.Z",
    "albedo.R",
    "albedo.G",
    "albedo.B",
    "id.object",
];

fn channels(light: &str) -> Vec<String> {
    let testers = lightbuffer::shadow::REGISTRY.iter().map(|entry| entry.name);
    let difference = cfg!(feature = "embree").then_some("difference");
    let of_light = testers.chain(difference).chain(["verdict"]).map(|name| format!("shadow.{light}.{name}"));
    PICTURE.iter().map(|name| name.to_string()).chain(of_light).collect()
}

fn channel<'i>(image: &'i ImagePlanes, name: &str) -> &'i [f32] {
    image.channel(name).unwrap_or_else(|| panic!("no channel {name}"))
}

fn picture(folder: &Path) -> ImagePlanes {
    read_exr(&folder.join("image.exr")).unwrap()
}

#[test]
fn the_files_are_there_and_nothing_else() {
    let folder = Folder::new();
    let out = folder.path("a/new/folder");
    validate(BLOCKS, &out, &[]).done();
    let maps: &[&str] = if cfg!(feature = "embree") {
        &["key.difference.png", "key.verdict.png"]
    } else {
        &["key.verdict.png"]
    };
    let expected: Vec<_> = ["image.exr", "image.png"].iter().chain(maps).chain(&["validate.json"]).collect();
    assert_eq!(names(&out).iter().collect::<Vec<_>>(), expected);
    let preview = image::open(out.join("image.png")).unwrap();
    assert_eq!((preview.width() as usize, preview.height() as usize), (WIDTH, HEIGHT));
    // A folder that is there already is used again.
    validate(BLOCKS, &out, &[]).done();
    assert_eq!(names(&out).len(), expected.len());
}

#[test]
fn the_picture_has_every_channel_and_says_what_made_it() {
    let folder = Folder::new();
    validate(BLOCKS, &folder.path("out"), &[]).done();
    let image = picture(&folder.path("out"));
    assert_eq!((image.size().width as usize, image.size().height as usize), (WIDTH, HEIGHT));
    let mut have: Vec<_> = image.channels().iter().map(|c| c.name.clone()).collect();
    let mut want = channels("key");
    have.sort();
    want.sort();
    assert_eq!(have, want);
    let attribute = |name: &str| image.attribute(name).unwrap_or_else(|| panic!("no attribute {name}"));
    assert_eq!(attribute("version"), env!("CARGO_PKG_VERSION"));
    assert_eq!(
        (attribute("scene"), attribute("camera"), attribute("shadow")),
        ("blocks.obj", "framed", "light-buffer")
    );
    assert_eq!(attribute("sceneHash").len(), 16);
    let testers: Vec<_> = lightbuffer::shadow::REGISTRY.iter().map(|entry| entry.name).collect();
    assert_eq!(attribute("testers"), testers.join(" "));
    if cfg!(feature = "embree") {
        assert_eq!(attribute("embreeEpsilon"), "1e-4");
        assert!(attribute("embree").contains('.'));
    }
}

#[test]
fn openexrs_own_tool_reads_it() {
    let folder = Folder::new();
    validate(BLOCKS, &folder.path("out"), &[]).done();
    let tool = Command::new("exrheader")
        .arg(folder.path("out/image.exr"))
        .output()
        .expect("exrheader of the Debian package openexr: run `make packages`");
    let text = String::from_utf8_lossy(&tool.stdout);
    assert!(tool.status.success(), "{text}");
    for name in channels("key") {
        assert!(text.contains(&format!("    {name}, 32-bit floating-point")), "{name} is not in {text}");
    }
}

#[test]
fn planes_hold_what_their_names_say() {
    let folder = Folder::new();
    // Without the floor there is a background, and both kinds of darkness.
    validate(BLOCKS, &folder.path("out"), &["--no-floor"]).done();
    let image = picture(&folder.path("out"));
    let [alpha, depth, verdict, truth] =
        ["A", "Z", "shadow.key.verdict", "shadow.key.exact"].map(|name| channel(&image, name));
    let background = alpha.iter().filter(|&&a| a == 0.0).count();
    assert!(background > 200 && background < alpha.len() - 200, "{background} pixels of background");
    for pixel in 0..alpha.len() {
        let seen = alpha[pixel] == 1.0;
        assert!(seen || alpha[pixel] == 0.0);
        assert_eq!(depth[pixel].is_finite(), seen);
        assert!(if seen { depth[pixel] > 0.0 } else { depth[pixel] == f32::INFINITY });
        assert_eq!(verdict[pixel] % 10.0 == 0.0, !seen);
        let normal = ["N.X", "N.Y", "N.Z"].map(|name| channel(&image, name)[pixel]);
        let length = normal.iter().map(|n| n * n).sum::<f32>().sqrt();
        assert!((length - f32::from(u8::from(seen))).abs() < 1e-5);
        for other in image.channels().iter().filter(|c| c.name != "Z") {
            assert!(other.samples[pixel].is_finite(), "{}", other.name);
            assert!(seen || other.samples[pixel] == 0.0, "{}", other.name);
        }
        // Occluded to the truth is 3, whoever is wrong is more.
        if [2.0, 3.0].contains(&(verdict[pixel] % 10.0)) {
            assert_eq!(truth[pixel] == 1.0, verdict[pixel] % 10.0 == 3.0);
        }
        if verdict[pixel] < 2.0 {
            assert_eq!(truth[pixel], 0.0);
        }
    }
    for code in [0.0, 1.0, 2.0, 3.0] {
        assert!(verdict.contains(&code), "no pixel has the verdict {code}");
    }
}

#[test]
fn masks_add_up_to_the_document() {
    let folder = Folder::new();
    let run = validate(BLOCKS, &folder.path("out"), &["--json", "-"]).done();
    let light = &json(&run.stdout)["lights"][0];
    let image = picture(&folder.path("out"));
    for entry in lightbuffer::shadow::REGISTRY {
        let mask = channel(&image, &format!("shadow.key.{}", entry.name));
        assert!(mask.iter().all(|&m| m == 0.0 || m == 1.0));
        let shadowed = mask.iter().filter(|&&m| m == 1.0).count();
        assert_eq!(light["testers"][entry.name]["shadowed"], shadowed, "{}", entry.name);
        assert!(shadowed > 50, "{}", entry.name);
    }
    let verdict = channel(&image, "shadow.key.verdict");
    let facing_away = verdict.iter().filter(|&&v| v == 1.0).count();
    assert_eq!(light["facing_away"], facing_away);
    assert_eq!(light["queries"], verdict.iter().filter(|&&v| v >= 2.0).count());
}

/// Embree that leaves out a fifth of every segment at both ends is wrong where blockers are near, and every
/// such pixel is in the maps.
#[cfg(feature = "embree")]
#[test]
fn differences_and_verdicts_follow_from_the_masks() {
    let folder = Folder::new();
    let options = ["--embree-epsilon", "0.2", "--json", "-"];
    let report = json(&validate(BLOCKS, &folder.path("out"), &options).done().stdout);
    let image = picture(&folder.path("out"));
    let [native, embree, truth, difference, verdict] =
        ["light-buffer", "embree", "exact", "difference", "verdict"]
            .map(|name| channel(&image, &format!("shadow.key.{name}")));
    let mut embree_wrong = 0;
    for pixel in 0..truth.len() {
        assert_eq!(difference[pixel], native[pixel] - embree[pixel]);
        assert_eq!(native[pixel], truth[pixel]);
        assert_eq!(verdict[pixel] % 10.0 == 5.0, embree[pixel] != truth[pixel]);
        embree_wrong += usize::from(embree[pixel] != truth[pixel]);
    }
    assert!(embree_wrong > 50, "{embree_wrong}");
    assert_eq!(report["totals"]["verdicts"]["embree_wrong"], embree_wrong);
    assert_eq!(report["totals"]["testers"]["embree"]["false_light"], embree_wrong);
    // The other way round: Embree's picture, judged as the tester of --shadow.
    let options = ["--embree-epsilon", "0.2", "--shadow", "embree"];
    validate(BLOCKS, &folder.path("other"), &options).done();
    let other = picture(&folder.path("other"));
    assert!(channel(&other, "shadow.key.difference").iter().all(|&d| d == 0.0));
    assert_eq!(
        channel(&other, "shadow.key.verdict").iter().filter(|&&v| v % 10.0 == 6.0).count(),
        embree_wrong
    );
    assert_ne!(channel(&other, "R"), channel(&image, "R"));
}

#[test]
fn lights_have_channels_and_maps_of_their_own() {
    let folder = Folder::new();
    let out = folder.path("out");
    validate(BLOCKS, &out, &["--lights", "2", "--testers", "light-buffer"]).done();
    let image = picture(&out);
    assert_ne!(channel(&image, "shadow.light-1.exact"), channel(&image, "shadow.light-2.exact"));
    // Embree was not asked, so there is nothing to differ from.
    assert!(image.channels().iter().all(|c| !c.name.ends_with(".difference")));
    assert_eq!(
        names(&out),
        ["image.exr", "image.png", "light-1.verdict.png", "light-2.verdict.png", "validate.json"]
    );
}
