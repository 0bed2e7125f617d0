//! Parts to add to a glTF document.

use crate::fixtures::{data_uri, floats};
use serde_json::{Value, json};

/// `componentType` of floats.
pub const FLOAT: u32 = 5126;

fn push(list: &mut Value, entry: Value) -> usize {
    if list.is_null() {
        *list = json!([]);
    }
    let list = list.as_array_mut().unwrap();
    list.push(entry);
    list.len() - 1
}

/// A view of some bytes, in a buffer of their own.
pub fn view(document: &mut Value, bytes: &[u8]) -> usize {
    let length = bytes.len();
    let buffer = push(&mut document["buffers"], json!({ "byteLength": length, "uri": data_uri(bytes) }));
    push(&mut document["bufferViews"], json!({ "buffer": buffer, "byteLength": length }))
}

/// An accessor of some bytes, by `componentType` and `type`.
pub fn accessor(document: &mut Value, bytes: &[u8], kind: (u32, &str), count: usize) -> usize {
    let view = view(document, bytes);
    let entry = json!({ "bufferView": view, "componentType": kind.0, "type": kind.1, "count": count });
    push(&mut document["accessors"], entry)
}

/// The same with numbers that stand for 0 to 1 or -1 to 1.
pub fn normalized(document: &mut Value, bytes: &[u8], kind: (u32, &str), count: usize) -> usize {
    let index = accessor(document, bytes, kind, count);
    document["accessors"][index]["normalized"] = json!(true);
    index
}

/// An accessor of floats with as many numbers an element as `shape` says.
pub fn float_accessor(document: &mut Value, shape: &str, values: &[f32]) -> usize {
    let lanes = match shape {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 16,
    };
    accessor(document, &floats(values), (FLOAT, shape), values.len() / lanes)
}

/// Makes an accessor sparse: some of its elements, by 16-bit indices, are replaced.
pub fn replace(document: &mut Value, accessor: usize, indices: &[u16], values: &[u8]) {
    let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
    let (from, to) = (view(document, &bytes), view(document, values));
    document["accessors"][accessor]["sparse"] = json!({
        "count": indices.len(),
        "indices": { "bufferView": from, "componentType": 5123 },
        "values": { "bufferView": to },
    });
}

/// The attributes of the triangle.
pub fn attributes(document: &mut Value) -> &mut Value {
    &mut document["meshes"][0]["primitives"][0]["attributes"]
}

/// Gives the triangle a texture with this image as base colour, and the texture coordinates of its corners.
pub fn paint(document: &mut Value, image: Value, corners: [[f32; 2]; 3]) {
    let coordinates = float_accessor(document, "VEC2", corners.as_flattened());
    attributes(document)["TEXCOORD_0"] = json!(coordinates);
    let image = push(&mut document["images"], image);
    let texture = push(&mut document["textures"], json!({ "source": image }));
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
}

/// A PNG file of white texels with these alphas, row by row.
pub fn png(width: u32, alphas: &[u8]) -> Vec<u8> {
    let texels = alphas.iter().flat_map(|&alpha| [255, 255, 255, alpha]).collect();
    let image = image::RgbaImage::from_raw(width, alphas.len() as u32 / width, texels).unwrap();
    let mut file = std::io::Cursor::new(Vec::new());
    image.write_to(&mut file, image::ImageFormat::Png).unwrap();
    file.into_inner()
}
