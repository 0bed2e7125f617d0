//! Names that lead out of the scene's folder, or to what is no file.

use crate::fixtures::{Folder, triangle, triangle_bytes};
use crate::refused;
use lightbuffer::scene::formats;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Writes a glTF file in a folder of its own that takes its buffer from `uri`. Beside that folder lies
/// `secret.bin`, a buffer that would do.
fn scene_with_buffer(folder: &Folder, uri: &str) -> PathBuf {
    folder.write("secret.bin", triangle_bytes());
    let mut document = triangle();
    document["buffers"][0]["uri"] = json!(uri);
    folder.write("scene/bad.gltf", document.to_string())
}

#[track_caller]
fn buffer_refused(uri: &str, words: &[&str]) {
    let folder = Folder::new();
    refused(
        &scene_with_buffer(&folder, uri),
        &[&["bad.gltf: mesh 0, primitive 0: ", "buffer 0: "], words].concat(),
    );
}

#[track_caller]
fn library_refused(name: &str, words: &[&str]) {
    let folder = Folder::new();
    folder.write("secret.mtl", "newmtl a\n");
    let text = format!("mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    refused(&folder.write("scene/bad.obj", text), &[&["bad.obj: mtllib"], words].concat());
}

#[test]
fn parent_folders() {
    for uri in [
        "../secret.bin",
        "%2e%2e/secret.bin",
        "..%2Fsecret.bin",
        "..\\secret.bin",
        "x/../../secret.bin",
        "%2e%2e%5csecret.bin",
    ] {
        buffer_refused(uri, &["it leaves the scene's folder"]);
    }
    for name in ["../secret.mtl", "..\\secret.mtl", "./../secret.mtl"] {
        library_refused(name, &["it leaves the scene's folder"]);
    }
}

#[test]
fn absolute_paths() {
    for uri in ["/etc/passwd", "/dev/zero", "%2fdev%2fzero", "//host/share", "\\\\host\\share"] {
        buffer_refused(uri, &["it leaves the scene's folder"]);
    }
    library_refused("/dev/zero", &["it leaves the scene's folder"]);
}

#[test]
fn schemes() {
    for uri in [
        "file:///etc/passwd",
        "http://localhost/mesh.bin",
        "https://localhost/mesh.bin",
        "C:\\mesh.bin",
        "x:y",
    ] {
        buffer_refused(uri, &["without scheme or drive"]);
    }
    library_refused("file:///etc/passwd", &["without scheme or drive"]);
}

#[test]
fn names_that_are_no_names() {
    buffer_refused("", &["the name is empty"]);
    buffer_refused("%00", &["zero byte"]);
    buffer_refused("%ff%fe", &["not UTF-8"]);
    buffer_refused("none.bin", &["cannot read `none.bin`: No such file"]);
    buffer_refused(&"x".repeat(10_000), &["cannot read", "..."]);
}

#[test]
fn the_scene_as_its_own_resource() {
    buffer_refused("bad.gltf", &["it is the scene file itself"]);
    buffer_refused("./%62ad.gltf", &["it is the scene file itself"]);
    library_refused("bad.obj", &["it is the scene file itself"]);
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder() {
    let folder = Folder::new();
    let scene = scene_with_buffer(&folder, "mesh.bin");
    let link = scene.with_file_name("mesh.bin");
    for target in ["../secret.bin", "/dev/zero", "/etc/passwd"] {
        std::os::unix::fs::symlink(target, &link).unwrap();
        refused(&scene, &["a link leads out of the scene's folder"]);
        std::fs::remove_file(&link).unwrap();
    }
    std::os::unix::fs::symlink("mesh.bin", &link).unwrap();
    refused(&scene, &["cannot read `mesh.bin`"]);
    // A link that stays inside is fine.
    std::fs::remove_file(&link).unwrap();
    std::fs::write(scene.with_file_name("real.bin"), triangle_bytes()).unwrap();
    std::os::unix::fs::symlink("real.bin", &link).unwrap();
    assert!(formats::load(&scene).is_ok());
}

#[cfg(unix)]
#[test]
fn devices_pipes_and_folders() {
    let folder = Folder::new();
    let scene = scene_with_buffer(&folder, "mesh.bin");
    std::fs::create_dir(scene.with_file_name("mesh.bin")).unwrap();
    refused(&scene, &["expected a regular file, found a folder"]);
    for extension in ["obj", "ply", "gltf", "glb", "nff"] {
        let path = scene.with_file_name(format!("zero.{extension}"));
        std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
        refused(&path, &["expected a regular file, found a device"]);
        let path = scene.with_file_name(format!("folder.{extension}"));
        std::fs::create_dir(&path).unwrap();
        refused(&path, &["expected a regular file, found a folder"]);
        let path = scene.with_file_name(format!("pipe.{extension}"));
        let made = std::process::Command::new("mkfifo").arg(&path).status().unwrap();
        assert!(made.success());
        refused(&path, &["expected a regular file, found a device or pipe"]);
    }
}

#[test]
fn a_scene_file_larger_than_the_limit() {
    let folder = Folder::new();
    for name in ["large.obj", "large.ply", "large.gltf", "large.glb", "large.nff"] {
        // Without blocks on the disk.
        let path = folder.write(name, "");
        std::fs::File::options().write(true).open(&path).unwrap().set_len((2 << 30) + 1).unwrap();
        refused(&path, &["it holds 2147483649 bytes, and 2147483648 may be read at most"]);
    }
}

#[test]
fn resources_larger_than_the_limit() {
    let folder = Folder::new();
    let scene = scene_with_buffer(&folder, "mesh.bin");
    let path = scene.with_file_name("mesh.bin");
    std::fs::File::create(&path).unwrap().set_len((2 << 30) + 1).unwrap();
    refused(&scene, &["will not read `mesh.bin`", "2147483648 may be read at most"]);
}

#[test]
fn files_of_other_kinds_and_none() {
    let folder = Folder::new();
    refused(&folder.write("scene.stl", ""), &["expected a name that ends in"]);
    refused(&folder.write("scene", ""), &["expected a name that ends in"]);
    let missing = folder.write("a.obj", "").with_file_name("none.obj");
    refused(&missing, &["cannot read: No such file"]);
    // A path without a folder is looked up in the current one.
    let message = formats::load(Path::new("no-such-scene.glb")).unwrap_err().to_string();
    assert!(message.starts_with("no-such-scene.glb: cannot read"), "{message}");
}
