//! `compare`: statistics, what never passes in silence, and its exit codes.

use crate::{Folder, Run, json, lightbuffer};
use lightbuffer::film::{ImagePlanes, write_exr};
use lightbuffer::scene::ImageSize;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// An image of 16 x 12 pixels: R, G and B even, and Z as given.
fn image(folder: &Folder, name: &str, red: f32, depth: f32) -> PathBuf {
    let mut planes = ImagePlanes::new(ImageSize { width: 16, height: 12 });
    for (name, value) in [("R", red), ("G", 0.5), ("B", 0.25)] {
        planes.add_channel(name, vec![value; 192]).unwrap();
    }
    let mut samples = vec![1.0; 192];
    samples[20] = depth;
    planes.add_channel("Z", samples).unwrap();
    let path = folder.path(name);
    write_exr(&path, &planes).unwrap();
    path
}

fn compare(one: &Path, other: &Path, options: &[&str]) -> Run {
    let paths = [one.as_os_str(), other.as_os_str()];
    lightbuffer([OsStr::new("compare")].into_iter().chain(paths).chain(options.iter().map(OsStr::new)))
}

#[test]
fn statistics_are_those_of_the_samples() {
    let folder = Folder::new();
    let (one, other) = (image(&folder, "a.exr", 0.75, 3.0), image(&folder, "b.exr", 0.5, 1.0));
    let run = compare(&one, &other, &["--json", "-"]);
    assert_eq!(run.code, 2, "{}", run.stderr);
    let report = json(&run.stdout);
    assert_eq!((&report["result"], &report["exit_code"]), (&"fail".into(), &2.into()));
    let channel = |name: &str| {
        let all = report["channels"].as_array().unwrap();
        all.iter().find(|channel| channel["channel"] == name).unwrap().clone()
    };
    let (red, depth) = (channel("R"), channel("Z"));
    assert_eq!(
        (&red["differ"], &red["max"], &red["mean"], &red["rms"]),
        (&192.into(), &0.25.into(), &0.25.into(), &0.25.into())
    );
    assert_eq!(
        (&depth["differ"], &depth["max"], &depth["max_at"]),
        (&1.into(), &2.0.into(), &serde_json::json!([4, 1]))
    );
    assert_eq!((&report["pixels"], &report["failing"]), (&192.into(), &192.into()));
    // A third of the samples are a quarter off, of a half.
    let metrics = &report["metrics"];
    let near = |value: &serde_json::Value, wanted: f64| (value.as_f64().unwrap() - wanted).abs() < 1e-6;
    assert!(near(&metrics["mse"], 0.0625 / 3.0), "{metrics}");
    assert!(near(&metrics["mrse"], 0.0625 / (0.51 * 0.51) / 3.0), "{metrics}");
    assert!(near(&metrics["psnr"], 16.812_412_4), "{metrics}");
    assert!(metrics["flip"].as_f64().unwrap() > 0.1 && metrics["ssim"].as_f64().unwrap() < 1.0);
    let table = compare(&one, &other, &[]).stdout;
    assert!(table.contains("MRSE 8.010e-2") && table.contains("fail: 192 of 192 pixels"), "{table}");
    assert_eq!(compare(&one, &other, &["-q"]).stdout, "");
}

#[test]
fn nan_and_infinity_never_pass_in_silence() {
    let folder = Folder::new();
    let whole = image(&folder, "whole.exr", 0.5, 1.0);
    let (nan, infinite) =
        (image(&folder, "nan.exr", 0.5, f32::NAN), image(&folder, "far.exr", 0.5, f32::INFINITY));
    let lenient = ["--fail", "1e30", "--failpercent", "100", "--warn", "1e30", "--warnpercent", "100"];
    for (one, other) in [(&whole, &nan), (&nan, &whole), (&nan, &nan), (&whole, &infinite)] {
        let run = compare(one, other, &lenient);
        assert_eq!(run.code, 2, "{one:?} {other:?}: {}", run.stdout);
        assert!(run.stdout.contains("fail: 1 of 192 pixels"), "{}", run.stdout);
    }
    assert_eq!(compare(&infinite, &infinite, &[]).code, 0);
}

#[test]
fn other_sizes_and_channels_are_a_mismatch_that_says_what() {
    let folder = Folder::new();
    let whole = image(&folder, "whole.exr", 0.5, 1.0);
    let mut planes = ImagePlanes::new(ImageSize { width: 16, height: 12 });
    planes.add_channel("R", vec![0.5; 192]).unwrap();
    let red = folder.path("red.exr");
    write_exr(&red, &planes).unwrap();
    let run = compare(&whole, &red, &[]);
    assert_eq!(
        (run.code, run.stdout.as_str()),
        (3, "mismatch: the second image has no channel B and 2 more\n")
    );
    let run = compare(&red, &whole, &["--json", "-"]);
    assert_eq!((run.code, &json(&run.stdout)["result"]), (3, &"mismatch".into()));
    assert_eq!(compare(&whole, &red, &["--channels", "R"]).code, 0);
    assert_eq!(compare(&whole, &red, &["--channels", "R,Z"]).code, 3);
}

#[test]
fn what_cannot_be_compared_ends_with_four() {
    let folder = Folder::new();
    let whole = image(&folder, "whole.exr", 0.5, 1.0);
    let broken = folder.write("broken.exr", "no image");
    for (other, options) in [(&broken, &[][..]), (&whole, &["--fail", "-1"]), (&whole, &["--nonsense"])] {
        let run = compare(&whole, other, options);
        assert_eq!((run.code, run.stdout.as_str()), (4, ""), "{options:?}: {}", run.stderr);
        assert!(!run.stderr.is_empty());
    }
    let help = lightbuffer(["compare", "--help"]).done().stdout;
    for words in
        ["0  same", "1  warn", "2  fail", "3  the images have different", "4  an image cannot be read"]
    {
        assert!(help.contains(words), "{words} is not in {help}");
    }
}
