//! Help, version and what is refused before any work is done.

use crate::{BLOCKS, Folder, SIZE, lightbuffer, names, validate};
use std::ffi::OsStr;

#[test]
fn help_and_version_are_results() {
    for arguments in [&["--help"][..], &["-h"], &["validate", "--help"], &["render", "-h"], &["help", "info"]]
    {
        let run = lightbuffer(arguments).done();
        assert!(run.stdout.contains("Usage: lightbuffer"), "{}", run.stdout);
        assert_eq!(run.stderr, "");
    }
    let version = lightbuffer(["--version"]).done().stdout;
    assert_eq!(version, format!("lightbuffer {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn help_explains_exit_codes_channels_and_verdicts() {
    assert!(lightbuffer(["--help"]).done().stdout.contains("Exit codes: 0 done and right; 1 done, but"));
    for command in ["validate", "render"] {
        let help = lightbuffer([command, "--help"]).done().stdout;
        for words in ["shadow.LIGHT.difference", "shadow.LIGHT.verdict", "5 Embree wrong", "else 1280x720]"] {
            assert!(help.contains(words), "{command}: {words}");
        }
    }
}

#[test]
fn what_makes_no_sense_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    let output = folder.path("out");
    let output = output.to_str().unwrap();
    let run = |options: &[&str]| lightbuffer(["validate", BLOCKS, "-o", output].iter().chain(options));
    run(&["--frobnicate"]).misused("'--frobnicate'");
    run(&["--shadow", "best"]).misused("; there are: exact, ");
    run(&["--testers", "exact,worst"]).misused("no shadow tester `worst`");
    run(&["--testers", ""]).misused("no shadow tester ``");
    for size in ["0x54", "96x0", "96", "96x54x3", "-1x5", "99999x99999", "axb"] {
        run(&[&format!("--size={size}")]).misused("'--size <WxH>'");
    }
    for resolution in ["0", "4097", "-1", "many", "1.5"] {
        run(&[&format!("--resolution={resolution}")]).misused("expected auto or a number from 1 to 4096");
    }
    for cull in ["on", "", "Solids"] {
        run(&[&format!("--cull={cull}")]).misused("expected off or solids");
    }
    for threshold in ["-1", "", "six"] {
        run(&[&format!("--volume-threshold={threshold}")]).misused("'--volume-threshold <N>'");
    }
    for light in ["1,2", "1,2,3,4", "1,2,nan", "a,b,c", ""] {
        run(&["--light", light]).misused("expected three finite numbers X,Y,Z");
    }
    run(&["--lights", "0"]).misused("1..=64");
    run(&["--lights", "2", "--light", "1,2,3"]).misused("cannot be used with");
    run(&["--threads", "0"]).misused("1..=1024");
    run(&["--embree-epsilon", "0.5"]).misused("[0, 0.5)");
    run(&["--exposure", "nan"]).misused("stops from -100 to 100");
    run(&["--camera", "none"]).misused("no camera `none`; the scene has: framed");
    run(&["--light", "3e38,3e38,3e38"]).misused("light-1: too far from the scene");
    lightbuffer(["frobnicate"]).misused("'frobnicate'");
    lightbuffer(["validate", BLOCKS]).misused("--output <DIR>");
    lightbuffer(["validate", "-o", output]).misused("<SCENE>");
    assert!(names(&folder.path("")).is_empty());
}

#[test]
fn a_picture_is_named_exr_because_its_preview_is_named_png() {
    let folder = Folder::new();
    for name in ["picture.png", "picture", "picture.exr.gz"] {
        let path = folder.path(name);
        lightbuffer(["render", BLOCKS, SIZE[0], SIZE[1], "-o", path.to_str().unwrap()])
            .misused("expected a name that ends in .exr");
    }
    assert!(names(&folder.path("")).is_empty());
}

#[test]
fn errors_of_arguments_with_line_breaks_stay_on_their_line() {
    let folder = Folder::new();
    let output = folder.path("out");
    let line = lightbuffer(["info", "no\nsuch\u{1b}[31m.obj"]).failed();
    assert!(line.contains(r"no\nsuch\u{1b}[31m.obj: cannot read"), "{line}");
    let arguments = ["validate", "-q", BLOCKS, "--camera", "a\nb", "-o", output.to_str().unwrap()];
    assert!(lightbuffer(arguments).failed().contains(r"no camera `a\nb`"));
}

#[test]
fn what_needs_more_memory_than_allowed_is_refused_before_it_is_asked_for() {
    let folder = Folder::new();
    let out = folder.path("out");
    let large = ["validate", "-q", BLOCKS, "--size", "16000x16000", "--memory-limit", "1G", "-o"];
    let line = lightbuffer(large.map(OsStr::new).into_iter().chain([out.as_os_str()])).failed();
    assert!(line.contains(" would need about "), "{line}");
    assert!(line.ends_with("and --memory-limit is 1024 MiB"), "{line}");
    let line = validate(BLOCKS, &out, &["--resolution", "4096", "--memory-limit", "200M"]).failed();
    assert!(line.contains("a light buffer of 4096 cells along an edge would need "), "{line}");
    assert!(!out.exists());
    validate(BLOCKS, &out, &["--resolution", "64", "--memory-limit", "200M"]).done();
    validate(BLOCKS, &folder.path("none"), &["--memory-limit", "much"]).misused("such as 16G");
}
