//! glTF and GLB.

use crate::fixtures::{Folder, data_uri, floats, triangle, triangle_bytes, triangle_glb};
use crate::{corners, warned};
use lightbuffer::scene::{Scene, Transmission, formats};
use serde_json::{Value, json};

const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fn load(document: &Value) -> Scene {
    let folder = Folder::new();
    formats::load(&folder.write("test.gltf", document.to_string())).unwrap()
}

#[test]
fn data_uris_files_and_binary_chunks_hold_the_same() {
    let folder = Folder::new();
    let mut external = triangle();
    external["buffers"][0]["uri"] = json!("data%20of/mesh.bin");
    folder.write("data of/mesh.bin", triangle_bytes());
    let files = [
        folder.write("inside.gltf", triangle().to_string()),
        folder.write("outside.gltf", external.to_string()),
        folder.write("binary.glb", triangle_glb()),
        folder.write("misnamed.gltf", triangle_glb()),
    ];
    for path in files {
        let scene = formats::load(&path).unwrap();
        assert_eq!(corners(&scene), [CORNERS], "{}", path.display());
        assert_eq!(scene.objects[0].name, "corner");
        assert_eq!(scene.material(0).name, "paint");
        let normals = scene.objects[0].normals.as_ref().unwrap();
        assert_eq!(normals.normals[normals.corners[0][2] as usize].to_array(), [0.0, 0.0, 1.0]);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
}

#[test]
fn transforms_multiply_down_the_tree_and_meshes_are_shared() {
    let mut document = triangle();
    document["scenes"][0]["nodes"] = json!([0, 2]);
    document["nodes"] = json!([
        { "translation": [10, 0, 0], "children": [1] },
        { "mesh": 0, "name": "turned", "scale": [2, 2, 2],
          "rotation": [0, 0, std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2] },
        { "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.1, 0, 5, 1] },
    ]);
    let scene = load(&document);
    assert_eq!(scene.objects.len(), 2);
    assert_eq!(scene.objects[1].name, "node 2");
    let found = corners(&scene);
    for (corner, expected) in found[0].iter().zip([[10.0, 0.0, 0.0], [10.0, 2.0, 0.0], [8.0, 0.0, 0.0]]) {
        for (a, b) in corner.iter().zip(expected) {
            approx::assert_abs_diff_eq!(*a, b, epsilon = 1e-6);
        }
    }
    assert_eq!(found[1], [[0.1, 0.0, 5.0], [1.1, 0.0, 5.0], [0.1, 1.0, 5.0]]);
    assert_eq!(scene.object_and_surface(1), (2, 1));
}

#[test]
fn world_coordinates_are_rounded_once() {
    let mut document = triangle();
    // In f32 the small translation would vanish on its way to the large one and back.
    document["nodes"] = json!([
        { "translation": [1e9, 0, 0], "children": [1] },
        { "translation": [0.3, 0, 0], "children": [2] },
        { "translation": [-1e9, 0, 0], "mesh": 0 },
    ]);
    let scene = load(&document);
    approx::assert_abs_diff_eq!(scene.corners(0)[0].x, 0.3, epsilon = 1e-6);
}

#[test]
fn mirrored_nodes_keep_their_outside_out() {
    let mut document = triangle();
    document["nodes"][0]["scale"] = json!([-1, 1, 3]);
    let scene = load(&document);
    assert_eq!(corners(&scene), [[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]]);
    let normals = scene.objects[0].normals.as_ref().unwrap();
    assert_eq!(normals.normals[0].to_array(), [0.0, 0.0, 1.0]);
}

#[test]
fn normals_stay_perpendicular_under_uneven_scale() {
    let mut document = triangle();
    let mut bytes = floats(&[0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0]);
    bytes.extend(floats(&[1.0, 0.0, 1.0].repeat(3)));
    bytes.extend([0, 0, 1, 0, 2, 0]);
    document["buffers"][0]["uri"] = json!(data_uri(&bytes));
    document["nodes"][0]["scale"] = json!([4, 1, 1]);
    let scene = load(&document);
    let normals = scene.objects[0].normals.as_ref().unwrap();
    let [a, b, _] = scene.corners(0);
    approx::assert_abs_diff_eq!(normals.normals[0].dot(b - a), 0.0, epsilon = 1e-6);
}

/// A document of five points on a zigzag, drawn in some mode.
fn zigzag(mode: u32, indexed: bool) -> Value {
    let points = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [2.0, 0.0]];
    let mut bytes: Vec<u8> = points.iter().flat_map(|&[x, y]| floats(&[x, y, 0.0])).collect();
    bytes.extend([0, 1, 2, 3, 4]);
    let mut document = triangle();
    document["meshes"][0]["primitives"] = json!([{ "attributes": { "POSITION": 0 }, "mode": mode }]);
    if indexed {
        document["meshes"][0]["primitives"][0]["indices"] = json!(1);
    }
    document["accessors"] = json!([
        { "bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3" },
        { "bufferView": 0, "byteOffset": 60, "componentType": 5121, "count": 5, "type": "SCALAR" },
    ]);
    document["bufferViews"] = json!([{ "buffer": 0, "byteLength": 65 }]);
    document["buffers"] = json!([{ "byteLength": 65, "uri": data_uri(&bytes) }]);
    document
}

#[test]
fn strips_and_fans_become_triangles_of_one_winding() {
    for indexed in [false, true] {
        let strip = load(&zigzag(5, indexed));
        assert_eq!(strip.triangles.len(), 3);
        for t in 0..3 {
            let [a, b, c] = strip.corners(t);
            assert!((b - a).cross(c - a).z < 0.0);
        }
        let fan = load(&zigzag(6, indexed));
        let indices: Vec<_> = fan.triangles.iter().map(|t| t.vertices).collect();
        assert_eq!(indices, [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        let list = load(&zigzag(4, indexed));
        assert_eq!(list.triangles.len(), 1);
        // Only the vertices that are used are kept.
        assert_eq!(list.vertices.len(), 3);
        warned(&list, "corners after the last whole triangle are not drawn (2 corners)");
    }
}

#[test]
fn points_and_lines_are_left_out_with_a_warning() {
    let mut document = triangle();
    let primitives = document["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.push(json!({ "attributes": { "POSITION": 0 }, "mode": 1 }));
    let scene = load(&document);
    assert_eq!(scene.objects.len(), 1);
    warned(&scene, "points and lines are not drawn (1 primitive)");
}

#[test]
fn interleaved_attributes_are_read_by_their_stride() {
    let mut document = triangle();
    let mut bytes = Vec::new();
    for corner in CORNERS {
        bytes.extend(floats(&corner));
        bytes.extend(floats(&[0.0, 0.0, 1.0]));
    }
    document["accessors"][1] =
        json!({ "bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 3, "type": "VEC3" });
    document["bufferViews"][0] = json!({ "buffer": 0, "byteLength": 72, "byteStride": 24 });
    bytes.extend([0, 0, 1, 0, 2, 0]);
    document["buffers"][0]["uri"] = json!(data_uri(&bytes));
    let scene = load(&document);
    assert_eq!(corners(&scene), [CORNERS]);
    assert_eq!(scene.objects[0].normals.as_ref().unwrap().normals[1].to_array(), [0.0, 0.0, 1.0]);
}

#[test]
fn cameras_look_along_minus_z_of_their_node() {
    let mut document = triangle();
    document["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1, "aspectRatio": 2.0 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "znear": 0, "zfar": 1 } },
    ]);
    document["nodes"] = json!([
        { "mesh": 0 },
        // A quarter turn about y looks along -x; scale changes nothing.
        { "name": "side", "camera": 0, "translation": [5, 1, 0], "scale": [3, 3, 3],
          "rotation": [0, std::f64::consts::FRAC_1_SQRT_2, 0, std::f64::consts::FRAC_1_SQRT_2] },
        { "name": "plan", "camera": 1 },
    ]);
    document["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let scene = load(&document);
    let camera = &scene.cameras[0];
    assert_eq!((scene.cameras.len(), camera.name.as_str()), (1, "side"));
    assert_eq!(camera.origin.to_array(), [5.0, 1.0, 0.0]);
    for (vector, expected) in
        [(camera.forward, [-1.0, 0.0, 0.0]), (camera.right, [0.0, 0.0, -1.0]), (camera.up, [0.0, 1.0, 0.0])]
    {
        assert!((vector - glam::Vec3::from(expected)).length() < 1e-6, "{vector}");
    }
    assert_eq!(camera.tan_half_height, libm::tan(0.5));
    warned(&scene, "orthographic cameras are not supported yet (node 2 `plan`)");
}

#[test]
fn material_features_that_are_not_drawn_are_one_warning_each() {
    let mut document = triangle();
    document["materials"] = json!([
        { "pbrMetallicRoughness": { "baseColorFactor": [0.25, 0.5, 1, 0.5], "metallicFactor": 0,
          "roughnessFactor": 0.5 }, "alphaMode": "BLEND" },
        { "normalTexture": { "index": 7 }, "alphaMode": "MASK" },
        { "emissiveFactor": [1, 1, 1], "extensions": { "KHR_materials_unlit": {} } },
    ]);
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(99);
    document["extensionsUsed"] = json!(["KHR_materials_unlit", "KHR_texture_transform", "EXT_other"]);
    document["extensionsRequired"] = json!(["KHR_materials_unlit"]);
    let scene = load(&document);
    assert_eq!(scene.material(0).diffuse, [0.125, 0.25, 0.5]);
    let transmission = Transmission { transmittance: [0.5; 3], refractive_index: 1.0 };
    assert_eq!(scene.material(0).transmission, Some(transmission));
    assert_eq!(scene.material(0).shininess, 30.0);
    warned(&scene, "textures are not drawn (1 material)");
    warned(&scene, "vertex colours are not drawn, and their alpha is not looked at (1 primitive)");
    warned(&scene, "extensions that are not supported are passed over (KHR_materials_unlit and 1 more)");
    assert_eq!(warned(&scene, "surfaces that glow give no light"), 4);
}

#[test]
fn other_scenes_are_named() {
    let mut document = triangle();
    document["scenes"] = json!([{ "nodes": [0] }, { "nodes": [] }]);
    let scene = load(&document);
    assert_eq!(warned(&scene, "scenes other than the default are not drawn (1 scene)"), 1);
}

#[test]
fn the_default_scene_else_the_first_else_all_roots_are_drawn() {
    let mut document = triangle();
    document["nodes"] = json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "b" }]);
    document["scenes"] = json!([{ "nodes": [0] }, { "nodes": [1] }]);
    let names =
        |document: &Value| -> Vec<String> { load(document).objects.into_iter().map(|o| o.name).collect() };
    document["scene"] = json!(1);
    assert_eq!(names(&document), ["b"]);
    document.as_object_mut().unwrap().remove("scene");
    assert_eq!(names(&document), ["a"]);
    document.as_object_mut().unwrap().remove("scenes");
    assert_eq!(names(&document), ["a", "b"]);
}

#[test]
fn bad_positions_are_dropped_and_bad_normals_mended() {
    let mut document = zigzag(5, false);
    let mut bytes = floats(&[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, f32::NAN, 0.0, 0.0]);
    bytes.extend(floats(&[
        0.0,
        0.0,
        -2.0,
        0.0,
        0.0,
        -1.0,
        f32::NAN,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.0,
    ]));
    document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(1);
    document["accessors"][1] =
        json!({ "bufferView": 0, "byteOffset": 60, "componentType": 5126, "count": 5, "type": "VEC3" });
    document["bufferViews"][0]["byteLength"] = json!(120);
    document["buffers"] = json!([{ "byteLength": 120, "uri": data_uri(&bytes) }]);
    let scene = load(&document);
    assert_eq!((scene.triangles.len(), scene.dropped.non_finite), (2, 1));
    let normals = scene.objects[0].normals.as_ref().unwrap();
    for corner in normals.corners.iter().flatten() {
        assert_eq!(normals.normals[*corner as usize].to_array(), [0.0, 0.0, -1.0]);
    }
    warned(&scene, "normals of zero or infinite length");
}
