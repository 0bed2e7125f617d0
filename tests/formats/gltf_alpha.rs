//! Alpha masks of glTF materials.

use crate::fixtures::{Folder, data_uri, glb, triangle};
use crate::gltf_parts::{attributes, float_accessor, normalized, paint, png, view};
use crate::warned;
use lightbuffer::scene::{AlphaMask, Coverage, Scene, Wrap, formats};
use serde_json::{Value, json};

/// Six texels, of alpha 0 to 255.
const ALPHAS: [u8; 6] = [0, 127, 128, 254, 255, 51];
const CORNERS: [[f32; 2]; 3] = [[0.0, 0.25], [1.0, 0.0], [-2.0, 7.5]];

fn load(document: &Value) -> Scene {
    let folder = Folder::new();
    formats::load(&folder.write("test.gltf", document.to_string())).unwrap()
}

/// The triangle painted with the six texels, three in a row, in a material of these entries.
fn painted(material: Value) -> Value {
    let mut document = triangle();
    document["materials"][0] = material;
    paint(&mut document, json!({ "uri": data_uri(&png(3, &ALPHAS)) }), CORNERS);
    document
}

fn opaque(mask: &AlphaMask) -> Vec<bool> {
    let texels = (0..mask.height).flat_map(|row| (0..mask.width).map(move |column| (column, row)));
    texels.map(|(column, row)| mask.is_opaque(column, row)).collect()
}

/// Which texels are opaque in the only mask of a scene.
fn only_mask(scene: &Scene) -> Vec<bool> {
    assert_eq!(scene.alpha_masks.len(), 1);
    opaque(&scene.alpha_masks[0])
}

#[test]
fn a_texel_is_there_from_the_cutoff_on() {
    let scene = load(&painted(json!({ "alphaMode": "MASK" })));
    let mask = &scene.alpha_masks[0];
    assert_eq!((mask.width, mask.height, mask.wrap), (3, 2, [Wrap::Repeat; 2]));
    // A half lies between 127 and 128 of 255.
    assert_eq!(only_mask(&scene), [false, false, true, true, true, false]);
    assert_eq!(scene.material(0).coverage, Coverage::Masked(0));
    let coordinates = scene.objects[0].texture_coordinates.as_ref().unwrap();
    assert_eq!((coordinates.coordinates.as_slice(), coordinates.corners[0]), (&CORNERS[..], [0, 1, 2]));
    assert_eq!(warned(&scene, "textures are not drawn (1 material)"), 1);

    let factor = |alpha: f64| json!({ "baseColorFactor": [1, 1, 1, alpha] });
    let entry = |alpha: f64, cutoff: f64| json!({ "alphaMode": "MASK", "alphaCutoff": cutoff, "pbrMetallicRoughness": factor(alpha) });
    // At the cutoff itself it is there: 51 of 255 is a fifth.
    assert_eq!(only_mask(&load(&painted(entry(1.0, 51.0 / 255.0)))), [false, true, true, true, true, true]);
    assert_eq!(only_mask(&load(&painted(entry(0.5, 0.5)))), [false, false, false, false, true, false]);
    assert_eq!(only_mask(&load(&painted(entry(0.5, 0.498)))), [false, false, false, true, true, false]);
}

#[test]
fn transparent_surfaces_are_there_from_one_half_on() {
    let scene = load(&painted(json!({ "alphaMode": "BLEND", "alphaCutoff": 0.9 })));
    assert_eq!(only_mask(&scene), [false, false, true, true, true, false]);
    let warning = "transparent textures count as there where their alpha is at least one half (1 material)";
    assert_eq!(warned(&scene, warning), 2);
}

#[test]
fn only_what_has_both_texels_and_holes_is_masked() {
    let solid = [
        painted(json!({ "alphaMode": "OPAQUE" })),
        painted(json!({})),
        painted(json!({ "alphaMode": "MASK", "alphaCutoff": 0 })),
    ];
    for document in solid.iter().chain([&{
        let mut document = painted(json!({ "alphaMode": "MASK" }));
        document["images"][0]["uri"] = json!(data_uri(&png(1, &[128, 255])));
        document
    }]) {
        let scene = load(document);
        assert_eq!((scene.material(0).coverage, scene.alpha_masks.len()), (Coverage::Solid, 0));
        assert!(scene.objects[0].texture_coordinates.is_none());
        assert_eq!(warned(&scene, "textures are not drawn"), 1);
    }
    // Without a texture the factor decides, and without both there is nothing to decide.
    let mut document = triangle();
    document["materials"][0]["alphaMode"] = json!("MASK");
    let scene = load(&document);
    assert_eq!((scene.material(0).coverage, scene.warnings.len()), (Coverage::Solid, 0));
}

#[test]
fn what_is_nowhere_opaque_is_left_out_and_counted() {
    let glass =
        json!({ "alphaMode": "BLEND", "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, 0.1] } });
    for (material, alphas) in [
        (glass, [255; 6]),
        (json!({ "alphaMode": "MASK", "alphaCutoff": 1.5 }), [255; 6]),
        (json!({ "alphaMode": "MASK" }), [127; 6]),
    ] {
        let mut document = painted(material);
        document["images"][0]["uri"] = json!(data_uri(&png(3, &alphas)));
        let primitives = document["meshes"][0]["primitives"].as_array_mut().unwrap();
        let mut plain = primitives[0].clone();
        plain.as_object_mut().unwrap().remove("material");
        primitives.push(plain);
        document["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0 }]);
        document["scenes"][0]["nodes"] = json!([0, 1]);
        let scene = load(&document);
        assert_eq!((scene.objects.len(), scene.triangles.len(), scene.alpha_masks.len()), (2, 2, 0));
        warned(&scene, "surfaces that are nowhere opaque are left out (2 triangles)");
    }
}

#[test]
fn images_come_from_files_data_uris_and_views() {
    let folder = Folder::new();
    let file = png(3, &ALPHAS);
    folder.write("some images/mask.png", &file);
    let mut document = painted(json!({ "alphaMode": "MASK" }));
    let inside = document.clone();
    document["images"][0] = json!({ "uri": "some%20images/mask.png" });
    let beside = document.clone();
    let view = view(&mut document, &file);
    document["images"][0] = json!({ "bufferView": view, "mimeType": "image/png" });
    for document in [inside, beside, document] {
        let scene = formats::load(&folder.write("test.glb", glb(&document, &[]))).unwrap();
        assert_eq!(only_mask(&scene), [false, false, true, true, true, false]);
    }
}

#[test]
fn images_without_alpha_are_opaque() {
    let mut grey = std::io::Cursor::new(Vec::new());
    image::GrayImage::new(2, 2).write_to(&mut grey, image::ImageFormat::Png).unwrap();
    // Of a JPEG file the first bytes are enough.
    for file in [grey.into_inner(), vec![0xff, 0xd8, 0xff, 0xe0]] {
        let mut document = painted(json!({ "alphaMode": "MASK" }));
        document["images"][0]["uri"] = json!(data_uri(&file));
        assert_eq!(load(&document).material(0).coverage, Coverage::Solid);
    }
    // What only an extension can read is named.
    let mut document = painted(json!({ "alphaMode": "MASK" }));
    document["textures"][0] = json!({ "extensions": { "KHR_texture_basisu": { "source": 0 } } });
    let scene = load(&document);
    assert_eq!(scene.material(0).coverage, Coverage::Solid);
    warned(&scene, "alpha of textures that an extension brings is drawn opaque (1 material)");
}

#[test]
fn alpha_of_16_bits_is_not_rounded_to_8() {
    // The number below a half, the one above, and none.
    let texels: Vec<u16> = [32767u16, 32768, 0].iter().flat_map(|&alpha| [9, alpha]).collect();
    let mut file = std::io::Cursor::new(Vec::new());
    let image = image::ImageBuffer::<image::LumaA<u16>, _>::from_raw(3, 1, texels).unwrap();
    image.write_to(&mut file, image::ImageFormat::Png).unwrap();
    let mut document = painted(json!({ "alphaMode": "MASK" }));
    document["images"][0]["uri"] = json!(data_uri(&file.into_inner()));
    assert_eq!(only_mask(&load(&document)), [false, true, false]);
}

#[test]
fn samplers_say_how_the_image_goes_on_and_masks_are_shared() {
    let mut document = painted(json!({ "alphaMode": "MASK" }));
    document["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648, "magFilter": 9729 }]);
    document["textures"] =
        json!([{ "source": 0, "sampler": 0 }, { "source": 0 }, { "source": 0, "sampler": 0 }]);
    let material = |texture: u32| json!({ "alphaMode": "MASK", "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } });
    document["materials"] = json!([material(0), material(1), material(2), material(9)]);
    let primitive = document["meshes"][0]["primitives"][0].clone();
    let primitives = (0..3).map(|index| {
        let mut primitive = primitive.clone();
        primitive["material"] = json!(index);
        primitive
    });
    document["meshes"][0]["primitives"] = json!(primitives.collect::<Vec<_>>());
    // The last material is not shown, so nobody looks at its texture.
    let scene = load(&document);
    let masks: Vec<_> = (0..3).map(|triangle| scene.material(triangle).coverage.mask()).collect();
    assert_eq!(masks, [Some(0), Some(1), Some(0)]);
    assert_eq!(scene.alpha_masks[0].wrap, [Wrap::ClampToEdge, Wrap::MirroredRepeat]);
    assert_eq!(scene.alpha_masks[1].wrap, [Wrap::Repeat; 2]);
}

#[test]
fn texture_coordinates_are_transformed_once_and_rounded_once() {
    let mut document = painted(json!({ "alphaMode": "MASK" }));
    let coordinates = float_accessor(&mut document, "VEC2", &[0.1, 0.2, 1.0, 0.0, 0.0, 1.0]);
    attributes(&mut document)["TEXCOORD_3"] = json!(coordinates);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({
        "index": 0, "texCoord": 7,
        "extensions": { "KHR_texture_transform": { "offset": [0.5, 0.1], "scale": [0.1, -3], "texCoord": 3 } },
    });
    document["extensionsRequired"] = json!(["KHR_texture_transform"]);
    // A mirrored node turns the triangle round, and its coordinates with it.
    document["nodes"][0]["scale"] = json!([-1, 1, 1]);
    let scene = load(&document);
    let found = scene.objects[0].texture_coordinates.as_ref().unwrap();
    let by_hand = |u: f32, v: f32| [(f64::from(u) * 0.1 + 0.5) as f32, (f64::from(v) * -3.0 + 0.1) as f32];
    assert_eq!(found.coordinates, [by_hand(0.1, 0.2), by_hand(1.0, 0.0), by_hand(0.0, 1.0)]);
    assert_eq!(found.corners, [[0, 2, 1]]);
}

#[test]
fn texture_coordinates_of_bytes_and_of_morph_targets() {
    let mut document = painted(json!({ "alphaMode": "MASK" }));
    let bytes = normalized(&mut document, &[0, 51, 255, 0, 0, 255], (5121, "VEC2"), 3);
    attributes(&mut document)["TEXCOORD_0"] = json!(bytes);
    let target = float_accessor(&mut document, "VEC2", &[1.0, 0.0].repeat(3));
    document["meshes"][0]["primitives"][0]["targets"] = json!([{ "TEXCOORD_0": target }]);
    document["meshes"][0]["weights"] = json!([2]);
    let scene = load(&document);
    let found = scene.objects[0].texture_coordinates.as_ref().unwrap();
    assert_eq!(found.coordinates, [[2.0, 0.2], [3.0, 0.0], [2.0, 1.0]]);
}
