//! Bad input and bad places: exit code 2, one line, and nothing written.

use crate::fixtures::{triangle, triangle_bytes, triangle_glb};
use crate::{BLOCKS, Folder, SIZE, lightbuffer, names, validate};
use serde_json::json;
use std::path::Path;

/// Asserts that every command refuses a scene in one line with its path and the words, and writes nothing.
#[track_caller]
fn refused(folder: &Folder, scene: &Path, words: &str) {
    let before = names(&folder.path(""));
    let (out, picture) = (folder.path("out"), folder.path("out.exr"));
    let (path, picture) = (scene.to_str().unwrap(), picture.to_str().unwrap());
    let lines = [
        validate(scene, &out, &[]).failed(),
        lightbuffer(["render", path, SIZE[0], SIZE[1], "-o", picture]).failed(),
        lightbuffer(["info", path]).failed(),
    ];
    for line in lines {
        assert!(line.starts_with(&format!("lightbuffer: {path}")), "{line:?} does not name the file");
        assert!(line.contains(words), "{words:?} is not in {line:?}");
    }
    assert_eq!(names(&folder.path("")), before);
}

#[test]
fn a_glb_that_breaks_off() {
    let folder = Folder::new();
    let whole = triangle_glb();
    for bytes in [0, 11, 30, whole.len() / 2, whole.len() - 1] {
        let scene = folder.write("short.glb", &whole[..bytes]);
        refused(&folder, &scene, "short.glb: ");
    }
}

#[test]
fn an_obj_with_an_index_out_of_range() {
    let folder = Folder::new();
    let scene = folder.write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    refused(&folder, &scene, "far.obj:4: ");
}

#[test]
fn a_ply_that_declares_more_than_it_holds() {
    let folder = Folder::new();
    let text = "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\nproperty float x\n\
                property float y\nproperty float z\nelement face 1\nproperty list uint int vertex_index\nend_header\n";
    refused(
        &folder,
        &folder.write("many.ply", text),
        "many.ply:3: element `vertex`: it declares 99999999999",
    );
}

#[test]
fn an_nff_that_lets_more_light_through_than_there_is() {
    let folder = Folder::new();
    let scene = folder.write("ball.nff", "f 1 1 1 1 0 1 2 1\ns 0 0 0 1\n");
    refused(&folder, &scene, "ball.nff:1: expected a transmittance from 0 to 1, found 2");
}

#[test]
fn a_gltf_that_reads_outside_its_folder() {
    let folder = Folder::new();
    folder.write("secret.bin", triangle_bytes());
    for uri in ["../secret.bin", "%2e%2e/secret.bin", "/dev/zero"] {
        let mut document = triangle();
        document["buffers"][0]["uri"] = json!(uri);
        let scene = folder.write("scene/escape.gltf", document.to_string());
        refused(&folder, &scene, "it leaves the scene's folder");
    }
}

#[test]
fn nodes_in_a_circle() {
    let folder = Folder::new();
    let mut document = triangle();
    document["nodes"] = json!([{ "children": [1] }, { "children": [0], "mesh": 0 }]);
    let scene = folder.write("circle.gltf", document.to_string());
    refused(&folder, &scene, "node ");
}

#[test]
fn what_is_no_scene_at_all() {
    let folder = Folder::new();
    refused(&folder, Path::new("/dev/zero"), "expected a name that ends in");
    refused(&folder, &folder.path("none.obj"), "cannot read: No such file");
    let empty = folder.write("empty.obj", "");
    refused(&folder, &empty, "at least one triangle");
    let name = folder.write("two\nlines.obj", "f 1 2 3\n");
    let line = lightbuffer(["info".as_ref(), name.as_os_str()]).failed();
    assert!(line.contains(r"two\nlines.obj:1: "), "{line}");
}

#[cfg(unix)]
#[test]
fn a_device_under_the_name_of_a_scene() {
    let folder = Folder::new();
    for name in ["zero.obj", "zero.ply", "zero.gltf", "zero.glb", "zero.nff", "zero.toml"] {
        std::os::unix::fs::symlink("/dev/zero", folder.path(name)).unwrap();
        refused(&folder, &folder.path(name), "expected a regular file, found a device");
    }
}

#[test]
fn a_mesh_too_large_to_be_framed() {
    let folder = Folder::new();
    let scene = folder.write("vast.obj", "v 3e38 0 0\nv -3e38 0 0\nv 0 3e38 0\nf 1 2 3\n");
    for command in [&["info"][..], &["validate", "-o", "never"]] {
        let arguments = command.iter().map(|a| a.as_ref()).chain([scene.as_os_str()]);
        let line = lightbuffer(arguments).failed();
        assert_eq!(line, "lightbuffer: vast.obj: too large to be given a camera");
    }
    assert_eq!(names(&folder.path("")), ["vast.obj"]);
}

#[test]
fn places_that_cannot_be_written() {
    let folder = Folder::new();
    let file = folder.write("file", "");
    for out in [file.clone(), file.join("below"), file.join("far/below")] {
        let line = validate(BLOCKS, &out, &[]).failed();
        assert!(line.contains("cannot create the folder"), "{line}");
    }
    for picture in ["file/picture.exr", "none/picture.exr"] {
        let picture = folder.path(picture);
        let arguments = ["render", "-q", BLOCKS, SIZE[0], SIZE[1], "-o", picture.to_str().unwrap()];
        let line = lightbuffer(arguments).failed();
        assert!(line.contains("picture.exr: cannot write"), "{line}");
    }
    let copy = folder.path("none/copy.json");
    let line = validate(BLOCKS, &folder.path("out"), &["--json", copy.to_str().unwrap()]).failed();
    assert!(line.contains("copy.json: cannot write"), "{line}");
    assert_eq!(names(&folder.path("")), ["file"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error() {
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_lightbuffer"))
        .args(["info", "-q", BLOCKS])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr).unwrap().starts_with("lightbuffer: standard output: cannot write")
    );
}
