//! Alpha masks of glTF: textures that are none, images that lie.

use crate::fixtures::{Folder, data_uri, triangle};
use crate::gltf_parts::{accessor, attributes, float_accessor, paint, png};
use crate::refused;
use serde_json::{Value, json};

/// The triangle with a mask of two texels.
fn masked() -> Value {
    let mut document = triangle();
    document["materials"][0]["alphaMode"] = json!("MASK");
    paint(
        &mut document,
        json!({ "uri": data_uri(&png(2, &[0, 255])) }),
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
    );
    document
}

#[track_caller]
fn mask_refused(spoil: impl FnOnce(&mut Value), words: &[&str]) {
    let mut document = masked();
    spoil(&mut document);
    let folder = Folder::new();
    refused(&folder.write("bad.gltf", document.to_string()), words);
}

#[test]
fn masks_whose_texture_is_none() {
    let material = "bad.gltf: material 0 `paint`: ";
    let texture = |d: &mut Value, key: &str, value: Value| {
        d["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"][key] = value;
    };
    mask_refused(|d| d["materials"][0]["alphaMode"] = json!("DITHER\n"), &[material, "found `DITHER\\n`"]);
    mask_refused(|d| texture(d, "index", json!(u64::MAX)), &[material, "texture 18446744073709551615 of 1"]);
    mask_refused(|d| d["textures"][0]["source"] = json!(4), &[material, "texture 0: image 4 of 1"]);
    mask_refused(|d| d["textures"][0]["sampler"] = json!(3), &[material, "texture 0: sampler 3 of 0"]);
    let wrap = |d: &mut Value| {
        d["textures"][0]["sampler"] = json!(0);
        d["samplers"] = json!([{ "wrapT": 1 }]);
    };
    mask_refused(
        wrap,
        &[material, "texture 0: sampler 0: expected to wrap by 33071, 33648 or 10497, found 1"],
    );
    let primitive = "bad.gltf: mesh 0, primitive 0: ";
    mask_refused(
        |d| texture(d, "texCoord", json!(5)),
        &[primitive, "expected an attribute TEXCOORD_5 for its material's alpha"],
    );
    let transform = |transform: Value| {
        move |d: &mut Value| texture(d, "extensions", json!({ "KHR_texture_transform": transform }))
    };
    mask_refused(transform(json!({ "offset": [1] })), &["bad.gltf:1: invalid length 1"]);
    mask_refused(transform(json!({ "texCoord": -1 })), &["bad.gltf:1: invalid value: integer `-1`"]);
    mask_refused(transform(json!({ "rotation": "a" })), &["bad.gltf:1: invalid type: string"]);
    for scale in [1e39, 1e308] {
        let words = "TEXCOORD_0: a coordinate on the texture is not finite";
        mask_refused(transform(json!({ "scale": [scale, scale], "rotation": 1 })), &[primitive, words]);
    }
    for value in [f32::NAN, f32::INFINITY] {
        let spoil = |d: &mut Value| {
            let coordinates = float_accessor(d, "VEC2", &[0.0, 0.0, 0.0, value, 0.0, 0.0]);
            attributes(d)["TEXCOORD_0"] = json!(coordinates);
        };
        mask_refused(spoil, &[primitive, "is not finite"]);
    }
    let short = |d: &mut Value| {
        let coordinates = float_accessor(d, "VEC2", &[0.0; 4]);
        attributes(d)["TEXCOORD_0"] = json!(coordinates);
    };
    mask_refused(short, &[primitive, "TEXCOORD_0: 2 elements, and POSITION has 3"]);
    let bytes = |d: &mut Value| {
        let coordinates = accessor(d, &[0; 6], (5121, "VEC2"), 3);
        attributes(d)["TEXCOORD_0"] = json!(coordinates);
    };
    mask_refused(
        bytes,
        &["expected VEC2 of FLOAT or normalized UNSIGNED_BYTE", "found VEC2 of UNSIGNED_BYTE"],
    );
}

#[test]
fn masks_whose_image_is_none() {
    let image = "bad.gltf: material 0 `paint`: texture 0: image 0: ";
    let uri = |uri: &str| {
        let uri = json!(uri);
        move |d: &mut Value| d["images"][0]["uri"] = uri
    };
    for (name, words) in [
        ("none.png", "cannot read `none.png`"),
        ("../secret.png", "it leaves the scene's folder"),
        ("%2e%2e/secret.png", "it leaves the scene's folder"),
        ("/dev/zero", "it leaves the scene's folder"),
        ("http://localhost/a.png", "expected a relative path"),
        ("bad.gltf", "it is the scene file itself"),
        ("", "the name is empty"),
        ("data:image/png;base64,@", "the data URI is not base64"),
        ("data:image/png,abc", "expected a data URI in base64"),
    ] {
        mask_refused(uri(name), &[image, words]);
    }
    mask_refused(|d| d["images"][0] = json!({}), &[image, "expected either a uri or a bufferView"]);
    mask_refused(|d| d["images"][0]["bufferView"] = json!(0), &[image, "expected either"]);
    mask_refused(|d| d["images"][0] = json!({ "bufferView": 99 }), &[image, "bufferView 99 of 4"]);
    let huge = |d: &mut Value| {
        d["images"][0] = json!({ "bufferView": 0 });
        d["bufferViews"][0]["byteOffset"] = json!(u64::MAX);
    };
    mask_refused(huge, &[image, "bufferView 0: 36 bytes from byte 18446744073709551615 on exceed"]);
    for bytes in [&b""[..], b"GIF89a", b"RIFF\0\0\0\0WEBP", b"\x89PNG\r\n\x1a"] {
        mask_refused(uri(&data_uri(bytes)), &[image, "expected PNG or JPEG"]);
    }
}

#[test]
fn pictures_that_break_off_or_lie() {
    let whole = png(2, &[0, 255]);
    let image = "image 0: it cannot be read as PNG";
    let folder = Folder::new();
    for length in 8..whole.len() - 12 {
        let mut document = masked();
        document["images"][0]["uri"] = json!(data_uri(&whole[..length]));
        refused(&folder.write("bad.gltf", document.to_string()), &[image]);
    }
    let mut file = whole.clone();
    file[20] ^= 1;
    mask_refused(|d| d["images"][0]["uri"] = json!(data_uri(&file)), &[image]);
}

#[test]
fn pictures_of_few_bytes_and_many_texels() {
    // A header that is in order, and hardly a byte behind it.
    let picture = |width: u32, height: u32| {
        let mut header = b"IHDR".to_vec();
        header.extend(width.to_be_bytes());
        header.extend(height.to_be_bytes());
        header.extend([8, 6, 0, 0, 0]);
        let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
        for chunk in [header, b"IDATx".to_vec()] {
            file.extend((chunk.len() as u32 - 4).to_be_bytes());
            file.extend(&chunk);
            file.extend(checksum(&chunk).to_be_bytes());
        }
        file
    };
    let spoil =
        |width, height| move |d: &mut Value| d["images"][0]["uri"] = json!(data_uri(&picture(width, height)));
    mask_refused(spoil(8192, 8193), &["image 0: 8192 x 8193 texels, expected at most 67108864"]);
    mask_refused(spoil(i32::MAX as u32, 2), &["image 0: "]);
    mask_refused(spoil(i32::MAX as u32, i32::MAX as u32), &["image 0: "]);
    mask_refused(spoil(u32::MAX, u32::MAX), &["image 0: it cannot be read as PNG"]);
    mask_refused(spoil(0, 5), &["image 0: it cannot be read as PNG"]);
    mask_refused(spoil(2, 2), &["image 0: it cannot be read as PNG"]);
}

/// The checksum of a PNG chunk.
fn checksum(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 * (sum & 1)))
    })
}
