//! Polygons in every format.

use crate::fixtures::{data_uri, floats};
use serde_json::json;
use std::fmt::Write;

pub fn obj(polygons: &[Vec<[f32; 3]>]) -> String {
    let mut text = String::new();
    for polygon in polygons {
        polygon.iter().for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").unwrap());
        let numbers: Vec<_> = (1..=polygon.len()).rev().map(|i| format!("-{i}")).collect();
        writeln!(text, "f {}", numbers.join(" ")).unwrap();
    }
    text
}

pub fn ply(polygons: &[Vec<[f32; 3]>]) -> String {
    let (mut vertices, mut faces, mut count) = (String::new(), String::new(), 0);
    for polygon in polygons {
        polygon.iter().for_each(|[x, y, z]| writeln!(vertices, "{x} {y} {z}").unwrap());
        write!(faces, "{}", polygon.len()).unwrap();
        (count..count + polygon.len()).for_each(|i| write!(faces, " {i}").unwrap());
        faces.push('\n');
        count += polygon.len();
    }
    format!(
        "ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar ushort vertex_indices\nend_header\n{vertices}{faces}",
        polygons.len()
    )
}

pub fn nff(polygons: &[Vec<[f32; 3]>]) -> String {
    let mut text = String::new();
    for (i, polygon) in polygons.iter().enumerate() {
        if i % 2 == 0 {
            text += "f 1 0.5 0.25 0.8 0.1 10 0 1\n";
        }
        writeln!(text, "p {}", polygon.len()).unwrap();
        polygon.iter().for_each(|[x, y, z]| writeln!(text, "{x} {y} {z}").unwrap());
    }
    text
}

/// glTF has triangles alone, so it is handed those that another format's polygons became.
pub fn gltf(triangles: &[[[f32; 3]; 3]]) -> String {
    let count = 3 * triangles.len();
    let bytes = floats(triangles.as_flattened().as_flattened());
    let all = || triangles.as_flattened().iter().copied();
    let fold = |of: fn(f32, f32) -> f32| all().reduce(|a, b| [0, 1, 2].map(|i| of(a[i], b[i])));
    json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3",
                        "min": fold(f32::min), "max": fold(f32::max) }],
        "bufferViews": [{ "buffer": 0, "byteLength": bytes.len() }],
        "buffers": [{ "byteLength": bytes.len(), "uri": data_uri(&bytes) }],
    })
    .to_string()
}

/// One mesh, with the corners of each polygon by itself.
pub fn toml(polygons: &[Vec<[f32; 3]>]) -> String {
    let (mut vertices, mut faces, mut count) = (String::new(), String::new(), 0);
    for polygon in polygons {
        polygon.iter().for_each(|[x, y, z]| writeln!(vertices, "[{x}, {y}, {z}],").unwrap());
        writeln!(faces, "{:?},", (count..count + polygon.len()).collect::<Vec<_>>()).unwrap();
        count += polygon.len();
    }
    format!("version = 1\n[[mesh]]\nvertices = [\n{vertices}]\nfaces = [\n{faces}]\n")
}
