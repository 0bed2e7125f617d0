//! Tools of others read our OpenEXR files, with all layers by name.

use crate::{BLOCKS, Folder, lightbuffer, validate};
use lightbuffer::film::{read_exr, write_exr};
use std::path::Path;
use std::process::{Command, Output};

fn tool(name: &str, arguments: &[&Path]) -> Output {
    Command::new(name).args(arguments).output().unwrap_or_else(|error| {
        panic!("{name} of the Debian package openimageio-tools ({error}): run `make packages`")
    })
}

#[test]
fn openimageio_lists_every_layer_and_finds_the_same_statistics() {
    let folder = Folder::new();
    validate(BLOCKS, &folder.path("out"), &[]).done();
    let path = folder.path("out/image.exr");
    let info = tool("oiiotool", &["--info".as_ref(), "-v".as_ref(), "--stats".as_ref(), &path]);
    let text = String::from_utf8_lossy(&info.stdout);
    assert!(info.status.success(), "{text}");
    assert!(text.contains("96 x   54") && text.contains("float"), "{text}");
    let image = read_exr(&path).unwrap();
    let channels = text.lines().find(|line| line.contains("channel list:")).expect("a list of channels");
    let listed: Vec<&str> =
        channels.split_once("channel list:").unwrap().1.split(',').map(str::trim).collect();
    let mut wanted: Vec<&str> = image.channels().iter().map(|channel| channel.name.as_str()).collect();
    let mut found = listed.clone();
    wanted.sort_unstable();
    found.sort_unstable();
    assert_eq!(found, wanted);
    // Its means, in the order of its list, are those of the samples.
    let means = text.lines().find(|line| line.contains("Stats Avg:")).expect("statistics");
    let means: Vec<f64> = means
        .split_once("Avg:")
        .unwrap()
        .1
        .split_whitespace()
        .take_while(|word| !word.starts_with('('))
        .map(|word| word.parse().unwrap())
        .collect();
    let place = listed.iter().position(|&name| name == "shadow.key.exact").unwrap();
    let samples = image.channel("shadow.key.exact").unwrap();
    let mean = samples.iter().map(|&v| f64::from(v)).sum::<f64>() / samples.len() as f64;
    assert!((means[place] - mean).abs() < 1e-5, "{} {mean}", means[place]);
    assert!(mean > 0.01);
    assert!(text.contains("lightbuffer:sceneHash") && text.contains("lightbuffer:version"), "{text}");
}

/// Of the same images with the same thresholds, `compare` ends as `idiff` does, but for one thing.
#[test]
fn compare_ends_as_idiff_does() {
    let folder = Folder::new();
    validate(BLOCKS, &folder.path("out"), &[]).done();
    let original = folder.path("out/image.exr");
    let image = read_exr(&original).unwrap();
    // Twenty samples of one channel a little off, and one far.
    let mut changed = lightbuffer::film::ImagePlanes::new(image.size());
    for channel in image.channels() {
        let mut samples = channel.samples.clone();
        if channel.name == "N.X" {
            samples[100..120].iter_mut().for_each(|sample| *sample += 0.01);
            samples[3000] += 0.5;
        }
        changed.add_channel(&channel.name, samples).unwrap();
    }
    let other = folder.path("changed.exr");
    write_exr(&other, &changed).unwrap();
    let mut small =
        lightbuffer::film::ImagePlanes::new(lightbuffer::scene::ImageSize { width: 4, height: 4 });
    small.add_channel("R", vec![0.0; 16]).unwrap();
    let smaller = folder.path("small.exr");
    write_exr(&smaller, &small).unwrap();
    let missing = folder.path("missing.exr");

    // What `idiff` and what `compare` ends with. The former never warns where no pixel fails; that is not what its
    // manual says, and would hide what one asked to be warned of. Nor does 2.4 tell another size from a failure.
    let cases: [(&Path, &[&str], [i32; 2]); 10] = [
        (&original, &[], [0, 0]),
        (&other, &[], [2, 2]),
        (&other, &["--fail", "0.005", "--failpercent", "1"], [1, 1]),
        (&other, &["--fail", "1", "--warn", "1"], [0, 0]),
        (&other, &["--fail", "0.005", "--failpercent", "1", "--warn", "1"], [0, 0]),
        (&other, &["--fail", "0.005", "--failpercent", "0.1", "--warn", "1"], [2, 2]),
        (&other, &["--fail", "0.005", "--failpercent", "1", "--hardfail", "0.4", "--warn", "1"], [2, 2]),
        (&other, &["--fail", "0.005", "--failpercent", "1", "--warn", "1", "--hardwarn", "0.4"], [1, 1]),
        (&other, &["--fail", "1"], [0, 1]),
        (&smaller, &[], [2, 3]),
    ];
    for (path, options, [theirs_wanted, ours_wanted]) in cases {
        let one_dash: Vec<String> = options.iter().map(|option| option.replace("--", "-")).collect();
        let mut arguments: Vec<&Path> = one_dash.iter().map(Path::new).collect();
        arguments.extend([original.as_path(), path]);
        let theirs = tool("idiff", &arguments);
        assert_eq!(theirs.status.code(), Some(theirs_wanted), "idiff {arguments:?}: {theirs:?}");
        let paths = [original.as_os_str(), path.as_os_str()];
        let command = ["compare".as_ref()].into_iter().chain(paths).chain(options.iter().map(|o| o.as_ref()));
        let ours = lightbuffer(command);
        assert_eq!(ours.code, ours_wanted, "compare {options:?}: {}{}", ours.stdout, ours.stderr);
    }
    let gone = lightbuffer(["compare".as_ref(), original.as_os_str(), missing.as_os_str()]);
    assert_eq!((gone.code, gone.stdout.as_str()), (4, ""), "{}", gone.stderr);
    assert!(gone.stderr.contains("missing.exr: cannot open"), "{}", gone.stderr);
}
