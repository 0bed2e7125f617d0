//! TOML scenes.

use crate::fixtures::{Folder, triangle};
use crate::refused;
use lightbuffer::scene::formats;

const MESH: &str = "[[mesh]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";

/// Asserts that a text is refused with a message that holds the words.
#[track_caller]
fn text_refused(text: impl AsRef<[u8]>, words: &[&str]) {
    let folder = Folder::new();
    folder.write("scene/some.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    refused(&folder.write("scene/bad.toml", text), words);
}

/// The same for elements after the first line and a good mesh of three.
#[track_caller]
fn elements_refused(elements: &str, words: &[&str]) {
    text_refused(format!("version = 1\n{MESH}{elements}\n"), words);
}

#[test]
fn no_scene_at_all() {
    text_refused("", &["bad.toml:1: expected `version = 1`"]);
    text_refused("version = 1\n", &["bad.toml: expected at least one triangle"]);
    text_refused("\nversion = 2\nnew = 1\n", &["bad.toml:2: expected `version = 1`, found another"]);
    text_refused("version = 1.0\n", &["bad.toml:1: expected `version = 1`"]);
    text_refused("version = 1\n= 1\n", &["bad.toml:2: "]);
    text_refused("version = 1\nname = 'a\n", &["bad.toml:2: "]);
    text_refused(b"version = 1\n\n# \xff\n", &["bad.toml:3: expected text in UTF-8"]);
    text_refused([0; 50], &["bad.toml:1: "]);
    text_refused("version = 1\nversion = 1\n", &["bad.toml:2: duplicate key"]);
}

#[test]
fn unknown_and_missing_keys_have_lines() {
    text_refused("version = 1\nnmae = 'a'\n", &["bad.toml:2: unknown field `nmae`"]);
    elements_refused("colour = 1", &["bad.toml:5: unknown field `colour`"]);
    elements_refused("[[lihgt]]", &["bad.toml:5: unknown field `lihgt`"]);
    elements_refused("transform = { sclae = 2 }", &["bad.toml:5: unknown field `sclae`"]);
    elements_refused(
        "transform = { rotate = { axis = [1, 0, 0] } }",
        &["bad.toml:5: missing field `degrees`"],
    );
    elements_refused("\n[[include]]", &["bad.toml:6: missing field `path`"]);
    elements_refused(
        "[[camera]]\nposition = [0, 0, 1]",
        &["bad.toml:5: camera 1: expected a `target` or `axes`"],
    );
    elements_refused("[[light]]\nname = 'a'", &["bad.toml:5: missing field `type`"]);
    elements_refused("[mesh]", &["bad.toml:5: "]);
}

#[test]
fn values_of_another_kind_or_range() {
    let light = "[[light]]\ntype = 'point'\nposition = ";
    elements_refused(&format!("{light}[0, 0]"), &["bad.toml:7: expected 3 values, found 2"]);
    elements_refused(&format!("{light}[0, 0, 0, 0]"), &["bad.toml:7: expected 3 values, found 4"]);
    elements_refused(&format!("{light}[0, nan, 0]"), &["bad.toml:7: expected a finite number, found NaN"]);
    elements_refused(&format!("{light}[0, 1e400, 0]"), &["bad.toml:7: "]);
    elements_refused(
        &format!("{light}[0, 1e39, 0]"),
        &["bad.toml:7: expected numbers in the range of 32-bit"],
    );
    elements_refused(&format!("{light}'here'"), &["bad.toml:7: ", "expected an array of 3 values"]);
    elements_refused(&format!("{light}{}", 1u64 << 63), &["bad.toml:7: "]);
    let strong = |words: &str| format!("{light}[0, 0, 0]\nintensity = {words}");
    elements_refused(&strong("-1"), &["bad.toml:8: expected a number from 0 to 1e30, found -1"]);
    elements_refused(&strong("[1, 2, 1e31]"), &["bad.toml:8: expected a number from 0 to 1e30"]);
    elements_refused(&strong("inf"), &["bad.toml:8: expected a finite number"]);
    elements_refused(&strong("[1, 2]"), &["bad.toml:8: expected 3 values, found 2"]);
    elements_refused(&strong("'bright'"), &["bad.toml:8: ", "expected a number or an array of 3"]);
    elements_refused("[[light]]\ntype = 'area'", &["bad.toml:6: unknown variant `area`"]);
    elements_refused("cast_shadows = 1", &["bad.toml:5: "]);
    elements_refused(
        "[[material]]\nname = 'a'\ndiffuse = 1.5",
        &["bad.toml:7: expected a number from 0 to 1e0"],
    );
    elements_refused(
        "[[material]]\nname = 'a'\nshininess = 0",
        &["bad.toml:5: material `a`: expected a shininess"],
    );
    elements_refused(
        "[[material]]\nname = 'a'\n[[material]]\nname = 'a'",
        &["bad.toml:7: a second material `a`"],
    );
}

#[test]
fn lights_that_contradict_themselves() {
    let spot = "[[light]]\nname = 'key'\ntype = 'spot'\nposition = [0, 1, 0]\n";
    let light = |rest: &str, words: &str| {
        elements_refused(&format!("{spot}{rest}"), &["bad.toml:5: light 1 `key`: ", words])
    };
    light("", "expected a `direction` or a `target`, found neither");
    light("direction = [0, 1, 0]\ntarget = [0, 0, 0]", "expected either `direction` or `target`, found both");
    light("target = [0, 1, 0]", "`position` and `target` leave no direction");
    light("target = [0, 0, 0]\ntowards = [0, 1, 0]", "`towards` is for directional lights");
    light("target = [0, 0, 0]\nfalloff = 'none'\nrange = 3", "either `range` or `falloff");
    for range in ["0", "-1", "1e39", "1e-60"] {
        light(&format!("target = [0, 0, 0]\nrange = {range}"), "expected a range above 0");
    }
    for degrees in ["inner_degrees = 46", "outer_degrees = 0", "outer_degrees = 91", "inner_degrees = -1"] {
        light(
            &format!("target = [0, 0, 0]\n{degrees}"),
            "expected 0 <= inner_degrees <= outer_degrees <= 90",
        );
    }
    elements_refused(
        &format!("{spot}direction = [0, 0, 0]"),
        &["bad.toml:9: expected a direction, found zero"],
    );
    elements_refused(
        &format!("{spot}direction = [0, 1e-60, 0]"),
        &["bad.toml:9: expected a direction, found zero"],
    );
    let rest = |kind: &str, rest: &str, words: &str| {
        elements_refused(&format!("[[light]]\ntype = '{kind}'\n{rest}"), &["bad.toml:5: light 1: ", words]);
    };
    rest("point", "", "expected a `position`");
    rest("point", "position = [0, 0, 0]\ntarget = [0, 0, 0]", "`target` is for spot lights");
    rest("directional", "", "expected a `direction` or `towards`");
    rest(
        "directional",
        "towards = [0, 1, 0]\nposition = [0, 0, 0]",
        "`position` is for point and spot lights",
    );
    rest("directional", "towards = [0, 1, 0]\nouter_degrees = 3", "`outer_degrees` is for spot lights");
    rest("directional", "towards = [0, 1, 0]\ndirection = [0, 1, 0]", "found both");
    let many = "[[light]]\ntype = 'directional'\ntowards = [0, 1, 0]\n".repeat(16_385);
    elements_refused(&many, &["bad.toml:49157: expected at most 16384 lights"]);
}

#[test]
fn cameras_that_see_nothing() {
    let camera = |rest: &str, words: &str| {
        let text = format!("[[camera]]\nposition = [0, 0, 5]\n{rest}");
        elements_refused(&text, &["bad.toml:5: camera 1: ", words]);
    };
    camera("target = [0, 0, 5]", "`position` and `target` leave no direction to look in");
    camera("target = [0, 0, 0]\nup = [0, 0, 3]", "`up` is the direction to look in");
    for degrees in ["0", "180", "-3", "1e300"] {
        camera(&format!("target = [0, 0, 0]\nvertical_degrees = {degrees}"), "between 0 and 180");
    }
    camera("target = [0, 0, 0]\nsize = [0, 5]", "both sides must be at least 1");
    camera("target = [0, 0, 0]\nsize = [4294967295, 4294967295]", "more than 16777216 pixels");
    elements_refused(
        "[[camera]]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nsize = [-1, 5]",
        &["bad.toml:8: "],
    );
}

#[test]
fn meshes_that_are_none() {
    let mesh = |rest: &str, words: &[&str]| {
        let text = format!("[[mesh]]\nname = 'm'\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n{rest}");
        elements_refused(&text, words);
    };
    mesh("", &["bad.toml:5: missing field `faces`"]);
    mesh("faces = [\n[0, 1, 2],\n[0, 1, 3]]", &["bad.toml:10: mesh 2 `m`, face 2: vertex 3 of 3"]);
    mesh("faces = [[0, 1]]", &["bad.toml:8: mesh 2 `m`, face 1: expected at least 3 corners, found 2"]);
    mesh("faces = [[0, 1, -1]]", &["bad.toml:8: "]);
    mesh("faces = [[0, 1, 4294967296]]", &["bad.toml:8: "]);
    mesh("faces = [[0, 1, 1.5]]", &["bad.toml:8: "]);
    mesh("faces = [[0, 1, 2]]\nnormals = [[0, 0, 1]]", &["bad.toml:5: mesh 2 `m`: 1 normals for 3 vertices"]);
    mesh(
        "faces = [[0, 1, 2]]\nnormals = [[0, 0, 1], [0, 0, 1], [0, 0, 0]]",
        &["mesh 2 `m`: a normal of zero"],
    );
    mesh("faces = [[0, 1, 2]]\nmaterial = 'none'", &["bad.toml:9: no material `none`"]);
    let comb: String = (0..5000).map(|i| format!("[{i}, {}, 0], ", i % 2 * 5)).collect();
    let face: Vec<usize> = (0..5001).collect();
    elements_refused(
        &format!("[[mesh]]\nvertices = [{comb} [2500, -9, 0]]\nfaces = [{face:?}]"),
        &["bad.toml:7: mesh 2, face 1: expected at most 4096 corners"],
    );
}

#[test]
fn transforms_that_leave_nothing() {
    let transform = |text: &str, words: &str| {
        elements_refused(&format!("transform = {{ {text} }}"), &["bad.toml:5: ", words]);
    };
    for flat in [
        "scale = 0",
        "scale = [1, 0, 1]",
        "matrix = [[1, 2, 3, 0], [4, 5, 6, 0], [7, 8, 9, 0], [0, 0, 0, 1]]",
        "matrix = [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]]",
    ] {
        transform(flat, "the transform makes everything flat");
    }
    transform("scale = nan", "expected a finite number");
    transform("rotate = { axis = [0, 0, 0], degrees = 3 }", "expected `axis` to be a direction");
    transform("rotate = { axis = [0, 1, 0], degrees = inf }", "expected a finite number");
    let unit = "[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]";
    transform(&format!("matrix = [{unit}, [0, 0, 1, 1]]"), "last row of `matrix` to be [0, 0, 0, 1]");
    transform(&format!("matrix = [{unit}]"), "expected 4 values, found 3");
    transform(&format!("matrix = [{unit}, [0, 0, 0, 1]], scale = 2"), "expected either `matrix` or");
}

#[test]
fn places_beyond_all_floats_are_dropped_or_refused() {
    let folder = Folder::new();
    let text =
        format!("version = 1\n{MESH}{MESH}transform = {{ scale = 1e300, translate = [1e300, 0, 0] }}\n");
    let scene = formats::load(&folder.write("far.toml", text)).unwrap();
    assert_eq!((scene.triangles.len(), scene.dropped.non_finite), (1, 1));
    let light = "version = 1\n[[light]]\nname = 'a'\ntype = 'point'\nposition = [1, 0, 0]\n";
    folder.write("light.toml", light);
    let include = "[[include]]\npath = 'light.toml'\ntransform = { scale = 1e300 }\n";
    let path = folder.write("bad.toml", format!("version = 1\n{MESH}{include}"));
    refused(&path, &["light.toml: light `a`: the transform of an include leaves it no place"]);
    folder.write("middle.toml", format!("version = 1\n{include}"));
    let path = folder.write("bad.toml", format!("version = 1\n{MESH}{}", include.replace("light", "middle")));
    refused(&path, &["middle.toml:2: its transform inside those around it is not finite"]);
}

#[test]
fn nesting_that_would_overflow_the_stack() {
    let n = 200_000;
    for text in [
        format!("version = {}{}", "[".repeat(n), "]".repeat(n)),
        format!("version = 1\nname = {}", "[".repeat(n)),
        format!("version = 1\nname = {}1{}", "{ a = ".repeat(n), " }".repeat(n)),
        format!("version = 1\n{}name = 1", "a.".repeat(n)),
        format!("version = 1\n[{}name]", "a.".repeat(n)),
        format!("version = 1\n[[{}name]]", "a.".repeat(n)),
    ] {
        text_refused(text, &["bad.toml:", "recur"]);
    }
}

#[test]
fn more_text_than_the_limit() {
    let folder = Folder::new();
    let comment = format!("version = 1\n#{}\n", " ".repeat(9 << 20));
    folder.write("inner.toml", &comment);
    let include = "[[include]]\npath = 'inner.toml'\n";
    let path = folder.write("bad.toml", format!("{comment}{include}"));
    refused(&path, &["inner.toml: it holds 943", "may be read at most"]);
    refused(&folder.write("bad.toml", " ".repeat((16 << 20) + 1)), &["16777216 may be read at most"]);
}

#[test]
fn paths_that_lead_out_or_to_no_scene() {
    let include = |path: &str, words: &str| {
        elements_refused(&format!("[[include]]\npath = '{path}'"), &["bad.toml:5: ", words]);
    };
    for path in
        ["../secret.obj", "x/../../secret.obj", "..\\secret.obj", "/etc/passwd", "\\\\host\\share.obj"]
    {
        include(path, "it leaves the scene's folder");
    }
    include("file:///etc/passwd", "without scheme or drive");
    include("", "the name is empty");
    include("none.obj", "cannot read `none.obj`: No such file");
    include("bad.toml", "it is the scene file itself");
    include(&"x".repeat(10_000), "...");
    let folder = Folder::new();
    folder.write("some.txt", "v 0 0 0\n");
    folder.write("folder.obj/a", "");
    folder.write("empty.obj", "");
    let text = |path: &str| format!("version = 1\n{MESH}[[include]]\npath = '{path}'\n");
    refused(
        &folder.write("bad.toml", text("some.txt")),
        &["bad.toml:5: `some.txt`: expected a name that ends"],
    );
    refused(&folder.write("bad.toml", text("folder.obj")), &["folder.obj: expected a regular file"]);
    refused(&folder.write("bad.toml", text("empty.obj")), &["empty.obj: expected at least one triangle"]);
    elements_refused(
        "[[include]]\npath = 'some.obj'\nmaterial = 'none'",
        &["bad.toml:7: no material `none`"],
    );
}

#[cfg(unix)]
#[test]
fn links_and_pipes_are_no_way_out() {
    let folder = Folder::new();
    folder.write("secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let path = folder.write("scene/bad.toml", "version = 1\n[[include]]\npath = 'out.obj'\n");
    std::os::unix::fs::symlink("../secret.obj", folder.path("scene/out.obj")).unwrap();
    refused(&path, &["bad.toml:2: ", "a link leads out"]);
    std::fs::remove_file(folder.path("scene/out.obj")).unwrap();
    assert!(
        std::process::Command::new("mkfifo").arg(folder.path("scene/out.obj")).status().unwrap().success()
    );
    refused(&path, &["out.obj: expected a regular file, found a device or pipe"]);
}

#[test]
fn files_that_include_each_other() {
    let folder = Folder::new();
    let include = |path: &str| format!("version = 1\n[[include]]\npath = '{path}'\n");
    folder.write("b.toml", include("c.toml"));
    folder.write("c.toml", include("bad.toml"));
    refused(&folder.write("bad.toml", include("b.toml")), &["c.toml:2: `bad.toml` includes this file"]);
    folder.write("c.toml", include("b.toml"));
    refused(&folder.write("bad.toml", include("b.toml")), &["c.toml:2: `b.toml` includes this file"]);
    for depth in 0..17 {
        folder.write(&format!("{depth}.toml"), include(&format!("{}.toml", depth + 1)));
    }
    folder.write("15.toml", format!("version = 1\n{MESH}"));
    assert!(formats::load(&folder.path("0.toml")).is_ok());
    folder.write("15.toml", include("16.toml"));
    folder.write("16.toml", format!("version = 1\n{MESH}"));
    refused(&folder.path("0.toml"), &["15.toml:2: expected at most 16 files inside each other"]);
    assert!(formats::load(&folder.path("1.toml")).is_ok());
}

#[test]
fn few_bytes_that_would_become_more_than_a_machine_holds() {
    let folder = Folder::new();
    let grid: String = (0..200).map(|i| format!("v {i} 0 0\nv {i} 1 0\n")).collect();
    let faces: String = (1..399).map(|i| format!("f {i} {} {}\n", i + 1, i + 2)).collect();
    folder.write("some.obj", format!("{grid}{faces}").repeat(20));
    let include = "[[include]]\npath = 'some.obj'\n";
    // 7,960 triangles ten thousand times.
    let path = folder.write("bad.toml", format!("version = 1\n{}", include.repeat(10_000)));
    refused(&path, &["bad.toml:", "triangles, expected at most 67108864"]);
    // Doubled in each of many files.
    folder.write("0.toml", format!("version = 1\n{MESH}[[light]]\ntype = 'point'\nposition = [0, 9, 0]\n"));
    let within = |depth: usize, times: usize, rest: &str| {
        let include = format!("[[include]]\npath = '{}.toml'\n{rest}", depth - 1);
        format!("version = 1\n{}", include.repeat(times))
    };
    for depth in 1..4 {
        folder.write(&format!("{depth}.toml"), within(depth, 1000, "lights = false\n"));
    }
    refused(&folder.path("3.toml"), &["3.toml:", "expected at most 1048576"]);
    folder.write("1.toml", within(1, 16_385, ""));
    refused(&folder.path("1.toml"), &["1.toml:32770: 16385 lights, expected at most 16384"]);
    // Files of nothing at all.
    folder.write("0.toml", "version = 1\n");
    for depth in 1..10 {
        folder.write(&format!("{depth}.toml"), within(depth, 100, ""));
    }
    refused(&folder.path("9.toml"), &["4.toml:4: ", "included files, expected at most 1048576"]);
}

#[test]
fn an_error_in_an_included_file_names_that_file() {
    let folder = Folder::new();
    let mut document = triangle();
    document["accessors"][0]["count"] = 9.into();
    folder.write("sub/bad.gltf", document.to_string());
    folder.write("sub/bad.obj", "v 0 0 0\nv 1 0 x\n");
    for (name, words) in [("sub/bad.gltf", "sub/bad.gltf: "), ("sub\\bad.obj", "sub/bad.obj:2: ")] {
        let path = folder.write("good.toml", format!("version = 1\n[[include]]\npath = '{name}'\n"));
        refused(&path, &[words]);
    }
}

#[test]
fn a_file_cut_anywhere() {
    let folder = Folder::new();
    let whole = format!("version = 1\n[[light]]\ntype = 'point'\nposition = [1, 2, 3]\n{MESH}");
    for length in 0..whole.len() - 3 {
        refused(&folder.write("bad.toml", &whole[..length]), &["bad.toml:"]);
    }
    assert!(formats::load(&folder.write("good.toml", whole)).is_ok());
}
