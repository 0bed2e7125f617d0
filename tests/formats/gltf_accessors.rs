//! glTF accessors of every kind: sparse, quantised, and both.

use crate::corners;
use crate::fixtures::{Folder, floats, triangle};
use crate::gltf_parts::{accessor, attributes, float_accessor, normalized, replace};
use lightbuffer::scene::{Scene, formats};
use serde_json::{Value, json};

fn load(document: &Value) -> Scene {
    let folder = Folder::new();
    let scene = formats::load(&folder.write("test.gltf", document.to_string())).unwrap();
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene
}

#[test]
fn sparse_elements_replace_those_of_the_view() {
    let mut document = triangle();
    replace(&mut document, 0, &[0, 2], &floats(&[0.5, 0.25, 0.0, 0.0, 3.0, -1.0]));
    assert_eq!(corners(&load(&document)), [[[0.5, 0.25, 0.0], [1.0, 0.0, 0.0], [0.0, 3.0, -1.0]]]);
}

#[test]
fn sparse_elements_without_a_view_stand_among_zeros() {
    let mut document = triangle();
    document["accessors"][0] = json!({ "componentType": 5126, "count": 3, "type": "VEC3" });
    replace(&mut document, 0, &[1, 2], &floats(&[0.0, 7.0, 0.0, 0.0, 3.0, -1.0]));
    assert_eq!(corners(&load(&document)), [[[0.0, 0.0, 0.0], [0.0, 7.0, 0.0], [0.0, 3.0, -1.0]]]);
}

#[test]
fn indices_of_vertices_and_of_sparse_elements_have_every_type() {
    for (kind, bytes) in [(5121, 1), (5123, 2), (5125, 4)] {
        let wide = |values: &[u32]| -> Vec<u8> {
            values.iter().flat_map(|v| v.to_le_bytes()[..bytes].to_vec()).collect()
        };
        let mut document = triangle();
        let indices = accessor(&mut document, &wide(&[2, 2, 0]), (kind, "SCALAR"), 3);
        document["meshes"][0]["primitives"][0]["indices"] = json!(indices);
        let [from, to] =
            [&wide(&[1])[..], &wide(&[1])[..]].map(|bytes| crate::gltf_parts::view(&mut document, bytes));
        document["accessors"][indices]["sparse"] = json!({
            "count": 1,
            "indices": { "bufferView": from, "componentType": kind },
            "values": { "bufferView": to },
        });
        let scene = load(&document);
        assert_eq!(corners(&scene), [[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]], "{kind}");
    }
}

#[test]
fn quantised_positions_are_decoded_exactly_and_rounded_once() {
    let third = |numerator: f64, denominator: f64| (numerator / denominator * 3.0 + 1.0) as f32;
    let cases: [(u32, bool, Vec<u8>, [f32; 3]); 8] = [
        (5120, false, vec![0x80, 0xff, 127], [-383.0, -2.0, 382.0]),
        (5121, false, vec![0x80, 0xff, 127], [385.0, 766.0, 382.0]),
        (5122, false, vec![0, 0x80, 0xff, 0xff, 0xff, 0x7f], [-98303.0, -2.0, 98302.0]),
        (5123, false, vec![0, 0x80, 0xff, 0xff, 0xff, 0x7f], [98305.0, 196606.0, 98302.0]),
        // Both -128 and -127 are -1.
        (5120, true, vec![0x80, 0x81, 5], [-2.0, -2.0, third(5.0, 127.0)]),
        (5121, true, vec![0x80, 0xff, 5], [third(128.0, 255.0), 4.0, third(5.0, 255.0)]),
        (5122, true, vec![0, 0x80, 7, 0, 0xff, 0x7f], [-2.0, third(7.0, 32767.0), 4.0]),
        (5123, true, vec![0, 0x80, 7, 0, 0xff, 0xff], [third(32768.0, 65535.0), third(7.0, 65535.0), 4.0]),
    ];
    for (kind, is_normalized, corner, expected) in cases {
        let mut document = triangle();
        document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
        document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        document["nodes"][0]["scale"] = json!([3, 3, 3]);
        document["nodes"][0]["translation"] = json!([1, 1, 1]);
        // The other corners, far enough from the first for a triangle; elements are padded to four bytes.
        let size = corner.len() / 3;
        let mut bytes = corner.clone();
        bytes.resize(4 * size, 0);
        let one = |at: usize| {
            let mut element = vec![0; 4 * size];
            element[(at + 1) * size - 1] = 0x60;
            element
        };
        bytes.extend([one(0), one(1)].concat());
        let positions = accessor(&mut document, &bytes, (kind, "VEC3"), 3);
        document["accessors"][positions]["normalized"] = json!(is_normalized);
        let view = document["accessors"][positions]["bufferView"].as_u64().unwrap() as usize;
        document["bufferViews"][view]["byteStride"] = json!(4 * size);
        attributes(&mut document)["POSITION"] = json!(positions);
        assert_eq!(corners(&load(&document))[0][0], expected, "{kind} {is_normalized}");
    }
}

#[test]
fn quantised_normals_and_sparse_quantised_positions() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    let normals = normalized(&mut document, &[0, 0, 0x81].repeat(3), (5120, "VEC3"), 3);
    let positions = accessor(&mut document, &[0, 0, 0, 1, 0, 0, 0, 1, 0], (5120, "VEC3"), 3);
    replace(&mut document, positions, &[2], &[0xfe, 2, 9]);
    attributes(&mut document)["NORMAL"] = json!(normals);
    attributes(&mut document)["POSITION"] = json!(positions);
    let scene = load(&document);
    assert_eq!(corners(&scene), [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-2.0, 2.0, 9.0]]]);
    let found = scene.objects[0].normals.as_ref().unwrap();
    assert_eq!(found.normals[0].to_array(), [0.0, 0.0, -1.0]);
}

#[test]
fn a_matrix_of_the_node_is_applied_before_the_one_rounding() {
    let mut document = triangle();
    let positions = float_accessor(&mut document, "VEC3", &[0.1, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    attributes(&mut document)["POSITION"] = json!(positions);
    document["nodes"][0]["scale"] = json!([0.1, 1, 1]);
    let scene = load(&document);
    assert_eq!(scene.corners(0)[0].x, (f64::from(0.1f32) * 0.1) as f32);
}
