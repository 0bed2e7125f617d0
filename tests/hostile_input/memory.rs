//! What a few bytes can ask for: refused within a limit before any memory is asked for.

use crate::fixtures::{Folder, data_uri, triangle};
use crate::gltf_parts::{paint, png};
use lightbuffer::memory::MemoryLimit;
use lightbuffer::scene::formats;
use serde_json::{Value, json};
use std::path::Path;

const LIMIT: MemoryLimit = MemoryLimit::bytes(64 << 20);

/// Asserts that a file is refused within the limit, in one line with these words.
#[track_caller]
fn too_large(path: &Path, words: &[&str]) {
    let line = formats::load_within(path, LIMIT).expect_err("this file must be refused").to_string();
    crate::assert_one_line(path, &line);
    for word in words {
        assert!(line.contains(word), "{word:?} is not in {line:?}");
    }
}

/// One triangle, shown so often by an accessor of zeros without bytes.
fn instanced(count: u64) -> Value {
    let mut document = triangle();
    let accessors = document["accessors"].as_array_mut().unwrap();
    accessors.push(json!({ "componentType": 5126, "count": count, "type": "VEC3" }));
    document["nodes"][0]["extensions"] =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": 3 } } });
    document
}

#[test]
fn instances() {
    let folder = Folder::new();
    let few = folder.write("few.gltf", instanced(1000).to_string());
    assert_eq!(formats::load_within(&few, LIMIT).unwrap().objects.len(), 1000);
    let many = folder.write("many.gltf", instanced(500_000).to_string());
    too_large(
        &many,
        &["nodes: 500000 triangles in 500000 objects would need about", "--memory-limit is 64 MiB"],
    );
}

#[test]
fn zeros_without_bytes() {
    let mut document = triangle();
    document["meshes"][0]["primitives"] = json!([{ "attributes": { "POSITION": 3 } }]);
    let accessors = document["accessors"].as_array_mut().unwrap();
    accessors.push(json!({ "componentType": 5126, "count": 3_000_000, "type": "VEC3" }));
    let folder = Folder::new();
    too_large(&folder.write("zeros.gltf", document.to_string()), &["1000000 triangles in 1 objects"]);
}

#[test]
fn files_included_again_and_again() {
    let folder = Folder::new();
    folder.write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let includes = |path: &str, times: usize| {
        format!("version = 1\n{}", format!("[[include]]\npath = '{path}'\n").repeat(times))
    };
    let some = folder.write("some.toml", includes("part.obj", 200));
    assert_eq!(formats::load_within(&some, LIMIT).unwrap().objects.len(), 200);
    let many = folder.write("many.toml", includes("some.toml", 500));
    too_large(&many, &["many.toml:", "objects would need about"]);
}

/// A PNG file that declares other sides, with the checksum put right.
fn declaring(width: u32, height: u32) -> Vec<u8> {
    let mut file = png(2, &[0, 255]);
    file[16..20].copy_from_slice(&width.to_be_bytes());
    file[20..24].copy_from_slice(&height.to_be_bytes());
    let checksum = crc32fast::hash(&file[12..29]);
    file[29..33].copy_from_slice(&checksum.to_be_bytes());
    file
}

#[test]
fn masks_that_declare_more_than_their_bytes_hold() {
    let masked = |picture: &[u8]| {
        let mut document = triangle();
        document["materials"][0]["alphaMode"] = json!("MASK");
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        paint(&mut document, json!({ "uri": data_uri(picture) }), corners);
        document.to_string()
    };
    let folder = Folder::new();
    formats::load_within(&folder.write("fits.gltf", masked(&declaring(2, 1))), LIMIT).unwrap();
    let lying = folder.write("lies.gltf", masked(&declaring(8000, 8000)));
    crate::refused(&lying, &["image 0: 8000 x 8000 texels, more than", "bytes can hold"]);
    // Enough bytes behind the picture make its claim possible, and it is still too much.
    let possible = [declaring(5000, 5000), vec![0; 100_000]].concat();
    too_large(
        &folder.write("large.gltf", masked(&possible)),
        &["5000 x 5000 texels would need about 120 MiB"],
    );
}
