//! glTF beyond plain triangles: sparse and quantised accessors, instances, poses.

use crate::fixtures::{Folder, floats, triangle};
use crate::gltf_parts::{accessor, attributes, float_accessor, normalized, replace, view};
use crate::refused;
use serde_json::{Value, json};

/// Asserts that a document is refused with a message that holds the words.
#[track_caller]
fn document_refused(document: &Value, words: &[&str]) {
    let folder = Folder::new();
    refused(&folder.write("bad.gltf", document.to_string()), words);
}

/// Asserts that the valid triangle is refused once it is spoilt.
#[track_caller]
fn spoilt(spoil: impl FnOnce(&mut Value), words: &[&str]) {
    let mut document = triangle();
    spoil(&mut document);
    document_refused(&document, words);
}

/// What is wrong with the positions of the triangle.
const POSITIONS: &str = "bad.gltf: mesh 0, primitive 0: POSITION: accessor 0: ";

#[test]
fn sparse_indices_that_lead_astray() {
    let sparse = |indices: &'static [u16]| {
        move |d: &mut Value| replace(d, 0, indices, &floats(&[0.0; 12])[..12 * indices.len()])
    };
    spoilt(sparse(&[0, 3]), &[POSITIONS, "sparse: indices: element 1 is 3 of 3"]);
    spoilt(sparse(&[65535]), &["sparse: indices: element 0 is 65535 of 3"]);
    spoilt(sparse(&[1, 1]), &["sparse: indices: element 1 is 1, expected at least 2"]);
    spoilt(sparse(&[2, 0, 1]), &["sparse: indices: element 1 is 0, expected at least 3"]);
}

#[test]
fn sparse_sizes_without_bytes_behind_them() {
    let sparse = |path: &'static str, value: Value| {
        move |d: &mut Value| {
            replace(d, 0, &[1], &floats(&[0.0; 3]));
            let entry = path.split('.').fold(&mut d["accessors"][0]["sparse"], |entry, key| &mut entry[key]);
            *entry = value;
        }
    };
    spoilt(sparse("count", json!(2)), &[POSITIONS, "sparse: indices: 2 elements of 2 bytes", "exceed the 2"]);
    spoilt(sparse("count", json!(u64::MAX)), &["sparse: indices: 18446744073709551615 elements"]);
    spoilt(sparse("indices.byteOffset", json!(u64::MAX)), &["sparse: indices: 1 elements", "exceed"]);
    spoilt(sparse("values.byteOffset", json!(1)), &["sparse: values: 1 elements of 12 bytes", "exceed"]);
    spoilt(sparse("indices.bufferView", json!(77)), &["sparse: indices: bufferView 77 of 5"]);
    spoilt(sparse("values.bufferView", json!(1u64 << 32)), &["sparse: values: bufferView 4294967296 of 5"]);
    for kind in [5120u64, 5122, 5126, 7, 5123 + (1 << 32)] {
        let words = format!("UNSIGNED_SHORT or UNSIGNED_INT, found componentType {kind}");
        spoilt(sparse("indices.componentType", json!(kind)), &["sparse: indices: expected", &words]);
    }
    let strided = |d: &mut Value| {
        replace(d, 0, &[1], &floats(&[0.0; 3]));
        d["bufferViews"][4]["byteStride"] = json!(16);
    };
    spoilt(strided, &["sparse: values: bufferView 4: expected no byteStride, found 16"]);
}

#[test]
fn zeros_that_no_byte_stands_for() {
    // Few enough triangles, were there bytes for them.
    let zeros = |d: &mut Value| {
        d["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": 0 } });
        d["accessors"][0] = json!({ "componentType": 5126, "count": 100_000_000, "type": "VEC3" });
        replace(d, 0, &[0], &floats(&[1.0; 3]));
    };
    spoilt(zeros, &[POSITIONS, "100000000 elements without a bufferView, expected at most 4194304"]);
    let few = |d: &mut Value| {
        d["accessors"][0] = json!({ "componentType": 5126, "count": 3, "type": "VEC3" });
    };
    spoilt(few, &["found 1 of zero area"]);
}

#[test]
fn quantised_attributes_without_the_extension_or_beyond_it() {
    let bytes = |d: &mut Value| {
        let positions = accessor(d, &[0; 9], (5120, "VEC3"), 3);
        attributes(d)["POSITION"] = json!(positions);
    };
    spoilt(bytes, &["POSITION: accessor 3: expected VEC3 of FLOAT, found VEC3 of BYTE"]);
    let quantised = |name: &'static str, kind: u32, is_normalized: bool| {
        move |d: &mut Value| {
            d["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
            let index = accessor(d, &[0; 36], (kind, "VEC3"), 3);
            d["accessors"][index]["normalized"] = json!(is_normalized);
            attributes(d)[name] = json!(index);
        }
    };
    spoilt(
        quantised("POSITION", 5125, false),
        &["FLOAT or integers of 8 or 16 bits, found VEC3 of UNSIGNED_INT"],
    );
    spoilt(
        quantised("NORMAL", 5120, false),
        &["expected VEC3 of FLOAT or normalized BYTE or SHORT, found VEC3 of BYTE"],
    );
    spoilt(quantised("NORMAL", 5121, true), &["found VEC3 of normalized UNSIGNED_BYTE"]);
}

fn instanced(attributes: impl FnOnce(&mut Value) -> Value) -> impl FnOnce(&mut Value) {
    move |d: &mut Value| {
        let attributes = attributes(d);
        d["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } });
    }
}

#[test]
fn instances_of_impossible_numbers() {
    let node = "bad.gltf: node 0 `corner`: EXT_mesh_gpu_instancing: ";
    spoilt(instanced(|_| json!({})), &[node, "expected an attribute"]);
    spoilt(instanced(|_| json!({ "SCALE": 9 })), &[node, "SCALE: accessor 9 of 3"]);
    spoilt(instanced(|_| json!({ "_X\n": 9 })), &[node, "_X\\n: accessor 9 of 3"]);
    let vectors = |count: usize| move |d: &mut Value| float_accessor(d, "VEC3", &vec![1.0; 3 * count]);
    spoilt(
        instanced(|d| json!({ "SCALE": vectors(2)(d), "TRANSLATION": vectors(3)(d) })),
        &[node, "TRANSLATION: 3 elements, and SCALE has 2"],
    );
    spoilt(
        instanced(|d| json!({ "TRANSLATION": accessor(d, &[0; 9], (5120, "VEC3"), 3) })),
        &["TRANSLATION: accessor 3: expected VEC3 of FLOAT, found VEC3 of BYTE"],
    );
    spoilt(
        instanced(|d| json!({ "ROTATION": accessor(d, &[0; 4], (5120, "VEC4"), 1) })),
        &["ROTATION: accessor 3: expected VEC4 of FLOAT or normalized BYTE or SHORT, found VEC4 of BYTE"],
    );
    spoilt(
        instanced(|d| json!({ "ROTATION": normalized(d, &[0, 0, 0, 127, 0, 0, 0, 0], (5120, "VEC4"), 2) })),
        &["ROTATION: element 1: expected a unit quaternion"],
    );
    let overflow = |d: &mut Value| {
        instanced(|d| json!({ "SCALE": float_accessor(d, "VEC3", &[f32::INFINITY, 1.0, 1.0]) }))(d);
    };
    spoilt(overflow, &["node 0 `corner`: the transform of instance 0 in the world is not finite"]);
}

#[test]
fn instances_that_explode_by_a_count_alone() {
    let zeros = |count: u64| {
        move |d: &mut Value| {
            let accessors = d["accessors"].as_array_mut().unwrap();
            accessors.push(json!({ "componentType": 5126, "count": count, "type": "VEC3" }));
            json!({ "TRANSLATION": accessors.len() - 1 })
        }
    };
    spoilt(instanced(zeros(2_000_000)), &["nodes: 2000000 objects, expected at most 1048576"]);
    spoilt(instanced(zeros(u64::MAX)), &["nodes: 18446744073709551615 objects"]);
    let nothing = |d: &mut Value| {
        instanced(zeros(4_000_000))(d);
        d["meshes"][0]["primitives"] = json!([]);
    };
    spoilt(nothing, &["nodes: 4000000 objects, expected at most 1048576"]);
    let triangles = |d: &mut Value| {
        instanced(zeros(1_000_000))(d);
        d["accessors"][2]["count"] = json!(300);
    };
    spoilt(triangles, &["nodes: 100000000 triangles, expected at most 67108864"]);
}

fn morphed(target: impl FnOnce(&mut Value) -> Value, weights: Value) -> impl FnOnce(&mut Value) {
    move |d: &mut Value| {
        let target = target(d);
        d["meshes"][0]["primitives"][0]["targets"] = json!([target]);
        d["nodes"][0]["weights"] = weights;
    }
}

#[test]
fn morph_targets_that_do_not_fit() {
    let primitive = "bad.gltf: mesh 0, primitive 0: ";
    spoilt(morphed(|_| json!({}), json!([1, 2])), &[primitive, "2 weights, and it has 1 targets"]);
    spoilt(|d| d["meshes"][0]["weights"] = json!([1]), &[primitive, "1 weights, and it has 0 targets"]);
    spoilt(
        morphed(|_| json!({ "POSITION": 9 }), json!([1])),
        &[primitive, "target 0: POSITION: accessor 9 of 3"],
    );
    spoilt(
        morphed(|d| json!({ "NORMAL": float_accessor(d, "VEC3", &[0.0; 6]) }), json!([1])),
        &[primitive, "target 0: NORMAL: 2 elements, and POSITION has 3"],
    );
    spoilt(
        morphed(|d| json!({ "POSITION": accessor(d, &[0; 9], (5121, "VEC3"), 3) }), json!([1])),
        &[primitive, "target 0: POSITION: accessor 3: expected VEC3 of FLOAT, found VEC3 of UNSIGNED_BYTE"],
    );
    spoilt(
        morphed(|_| json!({ "POSITION": 0 }), json!([1e300])),
        &["found 1 of zero area or with numbers that are not finite"],
    );
}

#[test]
fn morph_targets_that_cost_the_file_nothing() {
    let many = |d: &mut Value| {
        // Ten thousand targets without a byte, on a strip of thirty thousand corners of one byte each.
        let zeros = json!({ "componentType": 5126, "count": 30_000, "type": "VEC3" });
        let corners: Vec<u8> = (0..30_000u16).flat_map(|i| i.to_le_bytes()).collect();
        let corners = accessor(d, &corners, (5123, "SCALAR"), 30_000);
        d["accessors"][0] = zeros;
        d["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": 0 }, "indices": corners,
            "targets": vec![json!({ "POSITION": 0 }); 10_000] });
        d["nodes"][0]["weights"] = json!(vec![1; 10_000]);
    };
    spoilt(many, &["mesh 0, primitive 0: morph targets and joints move vertices more than 268435456 times"]);
}

/// The triangle under a skin of one joint.
fn skinned() -> Value {
    let mut document = triangle();
    let joints = accessor(&mut document, &[0; 12], (5121, "VEC4"), 3);
    let weights = float_accessor(&mut document, "VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    attributes(&mut document)["JOINTS_0"] = json!(joints);
    attributes(&mut document)["WEIGHTS_0"] = json!(weights);
    document["skins"] = json!([{ "joints": [1] }]);
    document["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}]);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    document
}

#[test]
fn skins_that_do_not_fit() {
    let spoilt = |spoil: &dyn Fn(&mut Value), words: &str| {
        let mut document = skinned();
        spoil(&mut document);
        document_refused(&document, &["bad.gltf: mesh 0, primitive 0: ", words]);
    };
    let set = |name: &str, index: usize, d: &mut Value| attributes(d)[name] = json!(index);
    spoilt(&|d| d["nodes"][0]["skin"] = json!(5), "skin 5 of 1");
    spoilt(&|d| d["nodes"][0]["skin"] = json!(u64::MAX), "skin 18446744073709551615 of 1");
    spoilt(&|d| d["skins"][0]["joints"] = json!([7]), "skin 0: joint 0: node 7 is not part of the scene");
    spoilt(&|d| d["scenes"][0]["nodes"] = json!([0]), "skin 0: joint 0: node 1 is not part of the scene");
    spoilt(&|d| d["skins"][0]["joints"] = json!([1, 1]), "skin 0: joint 1: node 1 is a joint already");
    spoilt(&|d| d["skins"][0]["joints"] = json!([]), "JOINTS_0: element 0 names joint 0 of 0");
    spoilt(
        &|d| {
            let joints = accessor(d, &[0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0], (5121, "VEC4"), 3);
            set("JOINTS_0", joints, d);
        },
        "JOINTS_0: element 1 names joint 3 of 1",
    );
    for (weight, words) in [
        (f32::NAN, "WEIGHTS_0: element 0 has the weight NaN"),
        (f32::INFINITY, "WEIGHTS_0: element 0 has the weight inf"),
        (-1.0, "WEIGHTS_0: element 0 has the weight -1"),
        (0.0, "WEIGHTS_0: the weights of element 0 are all 0"),
    ] {
        let spoil = |d: &mut Value| {
            let weights = float_accessor(d, "VEC4", &[weight, 0.0, 0.0, 0.0].repeat(3));
            set("WEIGHTS_0", weights, d);
        };
        spoilt(&spoil, words);
    }
    let forget =
        |name: &'static str| move |d: &mut Value| _ = attributes(d).as_object_mut().unwrap().remove(name);
    spoilt(&forget("JOINTS_0"), "expected attributes JOINTS_0 and WEIGHTS_0");
    spoilt(&forget("WEIGHTS_0"), "expected attributes JOINTS_0 and WEIGHTS_0");
    spoilt(&|d| set("JOINTS_1", 3, d), "expected attributes JOINTS_1 and WEIGHTS_1");
    spoilt(
        &|d| {
            let joints = accessor(d, &[0; 8], (5121, "VEC4"), 2);
            set("JOINTS_0", joints, d);
        },
        "JOINTS_0: 2 elements, and POSITION has 3",
    );
    spoilt(
        &|d| set("JOINTS_0", 4, d),
        "JOINTS_0: accessor 4: expected VEC4 of UNSIGNED_BYTE or UNSIGNED_SHORT",
    );
    spoilt(&|d| set("WEIGHTS_0", 3, d), "WEIGHTS_0: accessor 3: expected VEC4 of FLOAT or normalized");
}

#[test]
fn inverse_bind_matrices_that_do_not_fit() {
    let identity = |wrong: &[(usize, f32)]| {
        let mut matrix: [f32; 16] = std::array::from_fn(|i| f32::from(i % 5 == 0));
        wrong.iter().for_each(|&(at, value)| matrix[at] = value);
        matrix
    };
    for (matrices, words) in [
        (vec![], "inverseBindMatrices: 0 elements, and there are 1 joints"),
        (identity(&[(3, 0.5)]).to_vec(), "inverseBindMatrices: element 0 is not finite, or its last row not"),
        (identity(&[(15, f32::NAN)]).to_vec(), "inverseBindMatrices: element 0 is not finite"),
        (identity(&[(1, f32::NAN)]).to_vec(), "inverseBindMatrices: element 0 is not finite"),
    ] {
        let mut document = skinned();
        let inverses = float_accessor(&mut document, "MAT4", &matrices);
        document["skins"][0]["inverseBindMatrices"] = json!(inverses);
        document_refused(&document, &["skin 0: ", words]);
    }
    let mut document = skinned();
    document["skins"][0]["inverseBindMatrices"] = json!(0);
    document_refused(
        &document,
        &["inverseBindMatrices: accessor 0: expected MAT4 of FLOAT, found VEC3 of FLOAT"],
    );
}

#[test]
fn switches_that_are_no_booleans() {
    for value in [json!(1), json!("true"), json!(null), json!([true]), json!({})] {
        spoilt(|d| d["nodes"][0]["extras"] = json!({ "castShadow": value }), &["bad.gltf:1: ", "a boolean"]);
        let on_mesh = |d: &mut Value| d["meshes"][0]["extras"] = json!({ "receiveShadow": value });
        spoilt(on_mesh, &["bad.gltf:1: ", "a boolean"]);
    }
}

#[test]
fn compressed_geometry_without_a_plain_copy() {
    let draco = |d: &mut Value| {
        d["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
        d["meshes"][0]["primitives"][0]["extensions"] = json!({ "KHR_draco_mesh_compression": {} });
        d["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    };
    spoilt(draco, &["mesh 0, primitive 0: it is compressed by `KHR_draco_mesh_compression`"]);
}

#[test]
fn views_that_no_accessor_takes_are_not_read_either() {
    let folder = Folder::new();
    let mut document = triangle();
    view(&mut document, b"some bytes");
    document["bufferViews"][3]["byteLength"] = json!(u64::MAX);
    assert!(lightbuffer::scene::formats::load(&folder.write("some.gltf", document.to_string())).is_ok());
}
