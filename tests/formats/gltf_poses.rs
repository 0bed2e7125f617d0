//! What nodes do to a glTF mesh: morph targets, skins, instances, and its part in shadows.

use crate::fixtures::{Folder, floats, triangle};
use crate::gltf_parts::{accessor, attributes, float_accessor, normalized, replace};
use crate::{corners, warned};
use lightbuffer::scene::{Scene, Shadowing, formats};
use serde_json::{Value, json};
use std::f64::consts::FRAC_1_SQRT_2;

fn load(document: &Value) -> Scene {
    let folder = Folder::new();
    formats::load(&folder.write("test.gltf", document.to_string())).unwrap()
}

fn clean(document: &Value) -> Scene {
    let scene = load(document);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene
}

/// The triangle with two morph targets: one moves the third corner and turns all normals to x, the other is
/// sparse, has no view of its own, and moves the first corner.
fn morphed() -> Value {
    let mut document = triangle();
    let moved = float_accessor(&mut document, "VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]);
    let turned = float_accessor(&mut document, "VEC3", &[2.0, 0.0, -2.0].repeat(3));
    let zeros = document["accessors"].as_array().unwrap().len();
    document["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "componentType": 5126, "type": "VEC3", "count": 3 }));
    replace(&mut document, zeros, &[0], &floats(&[-1.0, -1.0, 0.0]));
    document["meshes"][0]["primitives"][0]["targets"] =
        json!([{ "POSITION": moved, "NORMAL": turned, "TANGENT": 99 }, { "POSITION": zeros }]);
    document
}

#[test]
fn morph_targets_are_added_by_their_weights() {
    let mut document = morphed();
    // No weights at all: the mesh as it is, and no target is even read.
    assert_eq!(corners(&clean(&document)), corners(&clean(&triangle())));
    document["meshes"][0]["weights"] = json!([0.5, 0]);
    let scene = clean(&document);
    assert_eq!(corners(&scene), [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 2.0]]]);
    let normals = scene.objects[0].normals.as_ref().unwrap();
    assert_eq!(normals.normals[0].to_array(), [1.0, 0.0, 0.0]);
    // The node's weights come first, and its transform after them.
    document["nodes"] =
        json!([{ "mesh": 0, "weights": [0.25, 2], "translation": [10, 0, 0] }, { "mesh": 0 }]);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    let scene = clean(&document);
    let moved = [[8.0, -2.0, 0.0], [11.0, 0.0, 0.0], [10.0, 1.0, 1.0]];
    assert_eq!(corners(&scene), [moved, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 2.0]]]);
}

#[test]
fn quantised_morph_targets() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    let target = normalized(&mut document, &[0, 0, 0, 0, 0, 0, 0, 0, 0x81], (5120, "VEC3"), 3);
    document["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    document["nodes"][0]["weights"] = json!([0.1]);
    // A tenth in f64, rounded once.
    assert_eq!(clean(&document).corners(0)[2].to_array(), [0.0, 1.0, -0.1]);
}

/// The triangle under a skin of two joints. The first corner follows the first joint, the second corner the
/// second, and the third both.
fn skinned() -> Value {
    let mut document = triangle();
    let joints = accessor(&mut document, &[0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0], (5121, "VEC4"), 3);
    let weights = float_accessor(
        &mut document,
        "VEC4",
        &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.25, 0.75, 0.0, 0.0],
    );
    attributes(&mut document)["JOINTS_0"] = json!(joints);
    attributes(&mut document)["WEIGHTS_0"] = json!(weights);
    let mut matrices = [0.0f32; 32];
    for matrix in 0..2 {
        (0..4).for_each(|i| matrices[16 * matrix + 5 * i] = 1.0);
    }
    // The second joint was bound at (1, 0, 0).
    matrices[16 + 12] = -1.0;
    let inverses = float_accessor(&mut document, "MAT4", &matrices);
    document["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": inverses }]);
    document["nodes"] = json!([
        { "name": "skin", "mesh": 0, "skin": 0, "translation": [100, 100, 100] },
        { "translation": [0, 0, 8], "children": [2] },
        { "translation": [1, 0, 0], "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2], "scale": [2, 2, 2] },
    ]);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    document
}

#[test]
fn skins_take_the_pose_of_their_joints() {
    let scene = clean(&skinned());
    // Joint 0 moves by (0, 0, 8). Joint 1 takes p to (1, 0, 8) + 2 * quarter turn of (p - (1, 0, 0)).
    let by_each = [[0.0, 1.0, 8.0], [-1.0, -2.0, 8.0]];
    let third = [0, 1, 2].map(|axis| 0.25 * by_each[0][axis] + 0.75 * by_each[1][axis]);
    for (found, expected) in corners(&scene)[0].iter().zip([[0.0, 0.0, 8.0], [1.0, 0.0, 8.0], third]) {
        for (a, b) in found.iter().zip(expected) {
            approx::assert_abs_diff_eq!(*a, b, epsilon = 1e-6);
        }
    }
    let normals = scene.objects[0].normals.as_ref().unwrap();
    for normal in &normals.normals {
        assert!((*normal - glam::Vec3::Z).length() < 1e-6);
    }
    // Without inverse bind matrices every joint was bound where the mesh is.
    let mut document = skinned();
    document["skins"][0].as_object_mut().unwrap().remove("inverseBindMatrices");
    document["nodes"][2] = json!({ "translation": [0.5, 0, 0] });
    assert_eq!(corners(&clean(&document)), [[[0.0, 0.0, 8.0], [1.5, 0.0, 8.0], [0.375, 1.0, 8.0]]]);
}

#[test]
fn all_sets_of_joints_count_and_weights_need_not_be_one() {
    let mut document = skinned();
    document["nodes"][2] = json!({ "translation": [1.5, 0, 0] });
    // Set 1 as bytes and shorts. It adds to each corner as much of the second joint as set 0 has of both.
    let joints: Vec<u8> = [1u16, 0, 0, 0].repeat(3).iter().flat_map(|j| j.to_le_bytes()).collect();
    let joints = accessor(&mut document, &joints, (5123, "VEC4"), 3);
    let weights = normalized(&mut document, &[255, 0, 0, 0].repeat(3), (5121, "VEC4"), 3);
    attributes(&mut document)["JOINTS_1"] = json!(joints);
    attributes(&mut document)["WEIGHTS_1"] = json!(weights);
    // Joint 1 moves by (0.5, 0, 8).
    assert_eq!(corners(&clean(&document)), [[[0.25, 0.0, 8.0], [1.5, 0.0, 8.0], [0.4375, 1.0, 8.0]]]);
}

#[test]
fn morph_targets_come_before_skins() {
    let mut document = skinned();
    let target = float_accessor(&mut document, "VEC3", &[0.0, 0.0, 1.0].repeat(3));
    document["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    document["nodes"][0]["weights"] = json!([3]);
    let scene = clean(&document);
    // The second joint doubles.
    assert_eq!(scene.corners(0).map(|p| p.z), [11.0, 14.0, 0.25 * 11.0 + 0.75 * 14.0]);
}

#[test]
fn instances_are_placed_by_their_attributes() {
    let mut document = triangle();
    let moves = float_accessor(&mut document, "VEC3", &[1.0, 0.0, 0.0, 0.0, 5.0, 0.0]);
    // A half turn about z in bytes, of which 127 are one; and none.
    let turns = normalized(&mut document, &[0, 0, 127, 0, 0, 0, 0, 127], (5120, "VEC4"), 2);
    let scales = float_accessor(&mut document, "VEC3", &[2.0, 2.0, 2.0, 1.0, 3.0, -1.0]);
    document["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let child = json!({ "name": "child", "mesh": 0 });
    document["nodes"] = json!([{ "name": "leaf", "mesh": 0, "translation": [0, 0, 7], "children": [1],
        "extensions": { "EXT_mesh_gpu_instancing": { "attributes":
            { "TRANSLATION": moves, "ROTATION": turns, "SCALE": scales, "_ID": moves } } } }, child]);
    let scene = clean(&document);
    let names: Vec<_> = scene.objects.iter().map(|o| o.name.as_str()).collect();
    // What hangs below an instanced node is there once.
    assert_eq!(names, ["leaf-1", "leaf-2", "child"]);
    let found = corners(&scene);
    assert_eq!(found[0], [[1.0, 0.0, 7.0], [-1.0, 0.0, 7.0], [1.0, -2.0, 7.0]]);
    // The second is mirrored, so its triangle is turned round.
    assert_eq!(found[1], [[0.0, 5.0, 7.0], [0.0, 8.0, 7.0], [1.0, 5.0, 7.0]]);
    assert_eq!(found[2][0], [0.0, 0.0, 7.0]);
}

#[test]
fn instances_of_skinned_meshes_are_drawn_once() {
    let mut document = skinned();
    let moves = float_accessor(&mut document, "VEC3", &[1.0, 0.0, 0.0, 0.0, 5.0, 0.0]);
    document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = json!(moves);
    let scene = load(&document);
    assert_eq!(corners(&scene), corners(&clean(&skinned())));
    warned(&scene, "instances of skinned meshes are not supported yet (node 0 `skin`)");
}

#[test]
fn extras_switch_an_objects_part_in_shadows() {
    let mut document = triangle();
    document["meshes"][0]["extras"] = json!({ "castShadow": false, "targetNames": ["a"] });
    document["nodes"] = json!([
        { "mesh": 0 },
        { "mesh": 0, "extras": { "castShadow": true, "receiveShadow": false } },
        { "mesh": 0, "extras": [1, "castShadow"] },
    ]);
    document["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let found: Vec<_> = clean(&document).objects.iter().map(|object| object.shadowing).collect();
    let none = Shadowing { casts: false, receives: true };
    assert_eq!(found, [none, Shadowing { casts: true, receives: false }, none]);
}
