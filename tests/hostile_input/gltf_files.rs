//! glTF as text.

use crate::fixtures::{Folder, data_uri, triangle, triangle_bytes};
use crate::refused;
use lightbuffer::scene::formats;
use serde_json::{Value, json};

/// Asserts that a text is refused with a message that holds the words.
#[track_caller]
fn text_refused(text: impl AsRef<[u8]>, words: &[&str]) {
    let folder = Folder::new();
    refused(&folder.write("bad.gltf", text), words);
}

/// Asserts that the valid triangle is refused once it is spoilt.
#[track_caller]
fn spoilt(spoil: impl FnOnce(&mut Value), words: &[&str]) {
    let mut document = triangle();
    spoil(&mut document);
    text_refused(document.to_string(), words);
}

#[test]
fn an_empty_file_and_one_without_triangles() {
    text_refused("", &["bad.gltf:1: "]);
    text_refused("{}", &["bad.gltf:1: ", "missing field `asset`"]);
    spoilt(|d| d["nodes"] = json!([{}]), &["bad.gltf: expected at least one triangle"]);
}

#[test]
fn a_file_that_breaks_off() {
    let text = serde_json::to_string_pretty(&triangle()).unwrap();
    text_refused(&text[..text.len() / 2], &["bad.gltf:", "EOF", "column"]);
    text_refused(&text[..text.len() - 1], &["bad.gltf:", "EOF"]);
}

#[test]
fn json_that_nests_for_ever() {
    text_refused("[".repeat(1 << 20), &["bad.gltf:1: "]);
    // What is passed over is passed over without recursion.
    let deep = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"extras\":{}", "[".repeat(1 << 20));
    text_refused(deep, &["bad.gltf:1: EOF while parsing"]);
    let deep =
        format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{{\"extras\":{}", "{\"a\":".repeat(1 << 20));
    text_refused(deep, &["bad.gltf:1: EOF while parsing"]);
}

#[test]
fn json_that_grows_in_memory() {
    let many = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}{{}}]}}", "{},".repeat(1 << 21));
    text_refused(many, &["expected at most 2097152 objects"]);
}

#[test]
fn json_of_wrong_types() {
    spoilt(|d| d["nodes"] = json!(7), &["bad.gltf:1: invalid type: integer `7`"]);
    spoilt(|d| d["accessors"][0]["count"] = json!(-3), &["invalid value: integer `-3`"]);
    spoilt(|d| d["nodes"][0]["matrix"] = json!([1, 2, 3]), &["invalid length 3"]);
    let twice = triangle().to_string().replacen("{", "{\"nodes\":[],", 1);
    text_refused(twice, &["duplicate field `nodes`"]);
    spoilt(|d| d["asset"] = json!("a\nb\u{7}"), &["bad.gltf:1: ", "invalid type"]);
}

#[test]
fn versions_and_extensions_that_are_not_supported() {
    spoilt(|d| d["asset"]["version"] = json!("1.0"), &["asset: expected version 2.0, found `1.0`"]);
    spoilt(|d| d["asset"]["minVersion"] = json!("2.1"), &["it needs version `2.1`"]);
    for name in ["KHR_draco_mesh_compression", "KHR_meshopt_compression", "EXT_meshopt_compression"] {
        spoilt(|d| d["extensionsRequired"] = json!([name]), &[&format!("`{name}` is not supported")]);
    }
}

#[test]
fn indices_out_of_range_anywhere() {
    let primitive = "mesh 0, primitive 0: ";
    spoilt(|d| d["scene"] = json!(3), &["scene 3 of 1"]);
    spoilt(|d| d["scenes"][0]["nodes"] = json!([4]), &["scene 0: node 4 of 1"]);
    spoilt(|d| d["nodes"][0]["mesh"] = json!(5), &["node 0 `corner`: mesh 5 of 1"]);
    spoilt(|d| d["nodes"][0]["camera"] = json!(6), &["node 0 `corner`: camera 6 of 0"]);
    spoilt(|d| d["nodes"][0]["children"] = json!([7]), &["node 0 `corner`: child node 7 of 1"]);
    let light = json!({ "KHR_lights_punctual": { "light": 8 } });
    spoilt(|d| d["nodes"][0]["extensions"] = light, &["light 8 of 0"]);
    spoilt(|d| d["meshes"][0]["primitives"][0]["material"] = json!(9), &[primitive, "material 9 of 1"]);
    spoilt(|d| d["meshes"][0]["primitives"][0]["indices"] = json!(10), &[primitive, "accessor 10 of 3"]);
    spoilt(
        |d| d["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(11),
        &["POSITION: accessor 11 of 3"],
    );
    spoilt(
        |d| d["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(12),
        &["NORMAL: accessor 12 of 3"],
    );
    spoilt(|d| d["accessors"][0]["bufferView"] = json!(13), &["accessor 0: bufferView 13 of 3"]);
    spoilt(|d| d["bufferViews"][0]["buffer"] = json!(14), &["bufferView 0: buffer 14 of 1"]);
}

#[test]
fn indices_are_not_cut_to_32_bits() {
    let wraps = 1u64 << 32;
    spoilt(|d| d["nodes"][0]["mesh"] = json!(wraps), &["mesh 4294967296 of 1"]);
    spoilt(|d| d["scenes"][0]["nodes"] = json!([wraps]), &["node 4294967296 of 1"]);
    spoilt(|d| d["accessors"][0]["bufferView"] = json!(wraps), &["bufferView 4294967296 of 3"]);
    spoilt(|d| d["nodes"][0]["mesh"] = json!(u64::MAX), &["mesh 18446744073709551615 of 1"]);
    spoilt(|d| d["accessors"][0]["componentType"] = json!(5126 + wraps), &["found VEC3 of 4294972422"]);
}

#[test]
fn accessors_that_exceed_their_view() {
    spoilt(
        |d| d["accessors"][0]["count"] = json!(4),
        &["accessor 0: 4 elements", "exceed the 36 bytes of bufferView 0"],
    );
    spoilt(|d| d["accessors"][0]["byteOffset"] = json!(1), &["from byte 1 on, exceed"]);
    spoilt(|d| d["accessors"][2]["count"] = json!(4), &["indices: accessor 2: 4 elements of 2 bytes"]);
}

#[test]
fn offsets_and_counts_that_overflow() {
    // What `offset + stride * (count - 1) + size` gives in 64 bits is small in each of these.
    spoilt(|d| d["accessors"][0]["byteOffset"] = json!(u64::MAX - 30), &["exceed"]);
    spoilt(|d| d["accessors"][1]["count"] = json!(u64::MAX / 12 + 2), &["exceed"]);
    spoilt(|d| d["bufferViews"][0]["byteOffset"] = json!(u64::MAX), &["exceed the 78 of buffer 0"]);
    let huge = |d: &mut Value| {
        d["bufferViews"][0] =
            json!({ "buffer": 0, "byteOffset": 4, "byteLength": u64::MAX - 2, "byteStride": 252 });
        d["accessors"][0]["count"] = json!(1u64 << 56);
    };
    spoilt(huge, &["bufferView 0"]);
}

#[test]
fn counts_without_bytes_behind_them() {
    spoilt(
        |d| d["accessors"][2]["count"] = json!(300_000_000u64),
        &["100000000 triangles, expected at most 67108864"],
    );
    spoilt(
        |d| d["accessors"][2]["count"] = json!(100_000_000),
        &["accessor 2: 100000000 elements", "exceed"],
    );
    spoilt(
        |d| d["accessors"][0] = json!({ "componentType": 5126, "count": 1u64 << 40, "type": "VEC3" }),
        &["accessor 0: 1099511627776 elements without a bufferView, expected at most 4194304"],
    );
}

#[test]
fn views_that_exceed_their_buffer() {
    spoilt(
        |d| d["bufferViews"][0]["byteLength"] = json!(79),
        &["bufferView 0: 79 bytes from byte 0 on exceed the 78 of buffer 0"],
    );
    spoilt(
        |d| d["bufferViews"][1]["byteOffset"] = json!(60),
        &["bufferView 1: 36 bytes from byte 60 on exceed"],
    );
}

#[test]
fn buffers_that_hold_less_than_they_declare() {
    spoilt(|d| d["buffers"][0]["byteLength"] = json!(79), &["buffer 0: it declares 79 bytes and holds 78"]);
    spoilt(|d| d["buffers"][0]["byteLength"] = json!(u64::MAX), &["and holds 78"]);
    spoilt(|d| d["buffers"][0]["uri"] = json!(data_uri(&triangle_bytes()[..40])), &["holds 40"]);
    spoilt(|d| d["buffers"][0] = json!({ "byteLength": 78 }), &["buffer 0: it has no URI"]);
}

#[test]
fn data_uris_that_are_none() {
    spoilt(|d| d["buffers"][0]["uri"] = json!("data:application/octet-stream;base64"), &["expected a comma"]);
    spoilt(|d| d["buffers"][0]["uri"] = json!("data:text/plain,abc"), &["expected a data URI in base64"]);
    spoilt(|d| d["buffers"][0]["uri"] = json!("data:;base64,@@@@"), &["the data URI is not base64"]);
    spoilt(|d| d["buffers"][0]["uri"] = json!("data:"), &["expected a comma"]);
}

#[test]
fn strides_that_make_no_sense() {
    for stride in [0u64, 1, 11, 253, u64::MAX] {
        let words = format!("byteStride {stride}, expected 12 to 252");
        spoilt(|d| d["bufferViews"][0]["byteStride"] = json!(stride), &[&words]);
    }
    spoilt(
        |d| d["bufferViews"][0]["byteStride"] = json!(24),
        &["3 elements of 12 bytes, 24 apart", "exceed"],
    );
}

#[test]
fn types_that_do_not_fit() {
    spoilt(
        |d| d["accessors"][0]["type"] = json!("VEC2"),
        &["POSITION: accessor 0: expected VEC3 of FLOAT, found VEC2 of FLOAT"],
    );
    spoilt(|d| d["accessors"][0]["componentType"] = json!(5123), &["found VEC3 of UNSIGNED_SHORT"]);
    spoilt(|d| d["accessors"][0]["componentType"] = json!(7), &["found VEC3 of 7"]);
    spoilt(|d| d["accessors"][2]["componentType"] = json!(5126), &["indices: accessor 2: expected SCALAR"]);
    spoilt(|d| d["accessors"][2]["type"] = json!("VEC3"), &["found VEC3 of UNSIGNED_SHORT"]);
    spoilt(|d| d["accessors"][0]["type"] = json!("MAT4\n"), &["MAT4\\n"]);
    spoilt(|d| d["accessors"][0]["sparse"] = json!({}), &["bad.gltf:1: missing field `count`"]);
    spoilt(
        |d| d["accessors"][1]["componentType"] = json!(5120),
        &["expected VEC3 of FLOAT, found VEC3 of BYTE"],
    );
    spoilt(|d| d["meshes"][0]["primitives"][0]["mode"] = json!(7), &["expected a mode from 0 to 6, found 7"]);
    spoilt(
        |d| d["meshes"][0]["primitives"][0]["attributes"] = json!({}),
        &["expected an attribute POSITION"],
    );
    spoilt(|d| d["accessors"][1]["count"] = json!(2), &["NORMAL: 2 elements, and POSITION has 3"]);
}

#[test]
fn a_vertex_index_past_the_end() {
    let mut bytes = triangle_bytes();
    bytes[76] = 3;
    let words = ["mesh 0, primitive 0: indices: accessor 2: element 2 is vertex 3 of 3"];
    spoilt(|d| d["buffers"][0]["uri"] = json!(data_uri(&bytes)), &words);
}

#[test]
fn matrices_that_are_not_finite_or_not_affine() {
    let text = triangle().to_string();
    let spoil = |transform: &str| text.replace("\"mesh\":0", &format!("\"mesh\":0,{transform}"));
    text_refused(spoil("\"translation\":[NaN,0,0]"), &["bad.gltf:1: "]);
    text_refused(spoil("\"scale\":[1e999,1,1]"), &["number out of range"]);
    text_refused(spoil("\"rotation\":[0,0,0,0]"), &["node 0 `corner`: expected a unit quaternion"]);
    text_refused(spoil("\"rotation\":[1e308,1e308,0,0]"), &["expected a unit quaternion"]);
    text_refused(spoil("\"matrix\":[1,0,0,0.5,0,1,0,0,0,0,1,0,0,0,0,1]"), &["expected 0 0 0 1"]);
    let overflow = |d: &mut Value| {
        d["nodes"] =
            json!([{ "scale": [1e200, 1, 1], "children": [1] }, { "mesh": 0, "scale": [1e200, 1, 1] }]);
    };
    spoilt(overflow, &["node 1: its transform in the world is not finite"]);
    spoilt(
        |d| d["nodes"][0]["scale"] = json!([1e60, 1, 1]),
        &["found 1 of zero area or with numbers that are not finite"],
    );
}

#[test]
fn nodes_in_a_ring() {
    let ring =
        |d: &mut Value| d["nodes"] = json!([{ "children": [1] }, { "children": [2] }, { "children": [0] }]);
    spoilt(ring, &["it is its own ancestor"]);
    spoilt(|d| d["nodes"][0]["children"] = json!([0]), &["node 0 `corner`: it is its own ancestor"]);
    // A ring that the scene does not reach is as wrong.
    let apart = |d: &mut Value| d["nodes"] = json!([{ "mesh": 0 }, { "children": [2] }, { "children": [1] }]);
    spoilt(apart, &["it is its own ancestor"]);
}

#[test]
fn nodes_with_several_parents() {
    let shared = |d: &mut Value| {
        d["nodes"] = json!([{ "children": [2] }, { "children": [2] }, { "mesh": 0 }]);
        d["scenes"][0]["nodes"] = json!([0, 1]);
    };
    spoilt(shared, &["node 1: its child, node 2, is a child of node 0 already"]);
    spoilt(
        |d| d["nodes"] = json!([{ "children": [1, 1] }, { "mesh": 0 }]),
        &["is a child of node 0 already"],
    );
    spoilt(|d| d["scenes"][0]["nodes"] = json!([0, 0]), &["scene 0 lists it twice"]);
    let inner = |d: &mut Value| {
        d["nodes"] = json!([{ "children": [1] }, { "mesh": 0 }]);
        d["scenes"][0]["nodes"] = json!([1]);
    };
    spoilt(inner, &["node 1: scene 0 lists it, and it is a child of node 0"]);
}

#[test]
fn a_tree_too_deep() {
    let chain = |d: &mut Value| {
        let mut nodes: Vec<Value> = (1..200_000).map(|child| json!({ "children": [child] })).collect();
        nodes.push(json!({ "mesh": 0 }));
        d["nodes"] = json!(nodes);
    };
    spoilt(chain, &["node 1024: it has more than 1023 ancestors"]);
}

#[test]
fn instances_that_explode() {
    // A mesh of a thousand primitives under ten thousand nodes.
    let primitives = |d: &mut Value| {
        let primitive = d["meshes"][0]["primitives"][0].clone();
        d["meshes"][0]["primitives"] = json!(vec![primitive; 1000]);
        d["nodes"] = json!(vec![json!({ "mesh": 0 }); 10_000]);
        d["scenes"][0]["nodes"] = json!((0..10_000).collect::<Vec<_>>());
    };
    spoilt(primitives, &["nodes: 10000000 objects, expected at most 1048576"]);
    // One honest strip of 100,000 triangles under a thousand nodes.
    let triangles = |d: &mut Value| {
        let bytes = vec![0u8; 100_002];
        d["accessors"][2] =
            json!({ "bufferView": 2, "componentType": 5121, "count": bytes.len(), "type": "SCALAR" });
        d["bufferViews"][2] = json!({ "buffer": 1, "byteLength": bytes.len() });
        let own = d["buffers"][0].clone();
        d["buffers"] = json!([own, { "byteLength": bytes.len(), "uri": data_uri(&bytes) }]);
        d["meshes"][0]["primitives"][0]["mode"] = json!(5);
        d["nodes"] = json!(vec![json!({ "mesh": 0 }); 1000]);
        d["scenes"][0]["nodes"] = json!((0..1000).collect::<Vec<_>>());
    };
    spoilt(triangles, &["nodes: 100000000 triangles, expected at most 67108864"]);
}

#[test]
fn more_lights_than_the_limit() {
    let lights = |d: &mut Value| {
        d["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
        let light = json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } });
        d["nodes"] = json!(vec![light; 16_385]);
        d["scenes"][0]["nodes"] = json!((0..16_385).collect::<Vec<_>>());
    };
    spoilt(lights, &["node 16384: expected at most 16384 lights"]);
}

#[test]
fn lights_and_cameras_of_impossible_numbers() {
    let light = |light: Value| {
        move |d: &mut Value| {
            d["extensions"] = json!({ "KHR_lights_punctual": { "lights": [light] } });
            d["nodes"][0]["extensions"] = json!({ "KHR_lights_punctual": { "light": 0 } });
        }
    };
    spoilt(
        light(json!({ "type": "point", "intensity": -1 })),
        &["light 0: expected a colour and an intensity"],
    );
    spoilt(
        light(json!({ "type": "point", "intensity": 1e300 })),
        &["light 0: expected a colour and an intensity"],
    );
    spoilt(light(json!({ "type": "point", "range": 0 })), &["light 0: expected a range above 0"]);
    spoilt(light(json!({ "type": "lamp\n" })), &["found `lamp\\n`"]);
    let cone = |inner: f64, outer: f64| json!({ "type": "spot", "spot": { "innerConeAngle": inner, "outerConeAngle": outer } });
    for (inner, outer) in [(0.6, 0.5), (-0.1, 0.5), (0.0, 0.0), (0.0, 1.6), (-2.0, -1.0)] {
        let words = format!("innerConeAngle <= outerConeAngle <= pi/2, found {inner} and {outer}");
        spoilt(light(cone(inner, outer)), &["node 0 `corner`: light 0: expected 0 <= ", &words]);
    }
    for kind in ["spot", "directional"] {
        spoilt(light(json!({ "type": kind, "color": [1, -1, 0] })), &["expected a colour and an intensity"]);
        for scale in [0.0, 1e-60, 1e60] {
            let flat = |d: &mut Value| {
                light(json!({ "type": kind }))(d);
                d["nodes"][0]["scale"] = json!([1, 1, scale]);
            };
            spoilt(flat, &["light 0: its node's transform leaves no direction to shine in"]);
        }
    }
    spoilt(light(json!({ "type": "spot", "range": -1 })), &["light 0: expected a range above 0"]);
    let camera = |yfov: f64, scale: f64| {
        move |d: &mut Value| {
            d["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": yfov, "znear": 1 } }]);
            d["nodes"][0]["camera"] = json!(0);
            d["nodes"][0]["scale"] = json!([scale, scale, scale]);
        }
    };
    spoilt(camera(0.0, 1.0), &["node 0 `corner`: camera 0: yfov 0"]);
    spoilt(camera(4.0, 1.0), &["yfov 4"]);
    spoilt(camera(1.0, 0.0), &["no direction to look at"]);
}

#[test]
fn images_that_no_mask_needs_are_never_opened() {
    let folder = Folder::new();
    let mut document = triangle();
    let images: Vec<Value> =
        ["/dev/zero", "../../etc/passwd", "http://localhost/a.png", "%", "data:", ":", ""]
            .iter()
            .map(|uri| json!({ "uri": uri }))
            .chain([json!({ "bufferView": 99, "mimeType": "image/none" }), json!({})])
            .collect();
    document["textures"] = json!((0..images.len()).map(|i| json!({ "source": i })).collect::<Vec<_>>());
    document["images"] = json!(images);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 4 });
    let mut unused = document["materials"][0].clone();
    unused["alphaMode"] = json!("MASK");
    document["materials"].as_array_mut().unwrap().push(unused);
    let scene = formats::load(&folder.write("some.gltf", document.to_string())).unwrap();
    assert_eq!(scene.warnings, ["textures are not drawn (2 materials)"]);
}
