//! GLB: headers and chunks.

use crate::fixtures::{Folder, glb, triangle, triangle_glb};
use crate::refused;

/// Asserts that the valid file is refused once some bytes are overwritten.
#[track_caller]
fn overwritten(at: usize, bytes: &[u8], words: &[&str]) {
    let mut file = triangle_glb();
    file[at..at + bytes.len()].copy_from_slice(bytes);
    file_refused(&file, words);
}

#[track_caller]
fn file_refused(file: &[u8], words: &[&str]) {
    let folder = Folder::new();
    refused(&folder.write("bad.glb", file), words);
}

#[test]
fn an_empty_file_and_one_of_another_kind() {
    file_refused(b"", &["bad.glb: expected a GLB file"]);
    file_refused(b"{}", &["expected a GLB file"]);
    file_refused(b"glTF", &["GLB header: expected 12 bytes, found 4"]);
    overwritten(4, &[1, 0, 0, 0], &["GLB header: expected version 2, found 1"]);
}

#[test]
fn a_length_that_is_not_the_files() {
    let length = triangle_glb().len();
    for declared in [0u32, 11, 12, length as u32 - 1, length as u32 + 1, u32::MAX] {
        let words = format!("GLB header: it declares {declared} bytes, and the file holds {length}");
        overwritten(8, &declared.to_le_bytes(), &[&words]);
    }
}

#[test]
fn chunks_that_exceed_the_file() {
    overwritten(12, &u32::MAX.to_le_bytes(), &["GLB JSON chunk: it declares 4294967295 bytes"]);
    overwritten(16, b"XSON", &["GLB JSON chunk: expected the type `JSON`, found `XSON`"]);
    overwritten(16, b"\n\x1b\xff\0", &["GLB JSON chunk: expected the type `JSON`"]);
    let json_length = u32::from_le_bytes(triangle_glb()[12..16].try_into().unwrap()) as usize;
    overwritten(
        20 + json_length,
        &u32::MAX.to_le_bytes(),
        &["GLB binary chunk: it declares 4294967295 bytes"],
    );
    // A length that ends inside the next chunk's header.
    overwritten(12, &(json_length as u32 + 90).to_le_bytes(), &["bad.glb: "]);
}

#[test]
fn a_file_cut_anywhere() {
    let whole = triangle_glb();
    for length in 4..whole.len() {
        let mut file = whole[..length].to_vec();
        file_refused(&file, &["GLB header"]);
        if length >= 12 {
            // The same with an honest length in front.
            file[8..12].copy_from_slice(&(length as u32).to_le_bytes());
            file_refused(&file, &["bad.glb: "]);
        }
    }
}

#[test]
fn errors_in_the_json_name_their_place() {
    overwritten(20, b"x", &["bad.glb: JSON chunk, line 1, column 1: expected value"]);
}

#[test]
fn a_buffer_without_its_binary_chunk() {
    let mut document = triangle();
    document["buffers"] = serde_json::json!([{ "byteLength": 78 }]);
    file_refused(&glb(&document, &[]), &["buffer 0: it declares 78 bytes and holds 0"]);
    document["buffers"] = serde_json::json!([{ "byteLength": 0 }, { "byteLength": 78 }]);
    document["bufferViews"][0]["buffer"] = serde_json::json!(1);
    file_refused(&glb(&document, &[0; 80]), &["buffer 1: it has no URI"]);
}
