//! PLY in text and in binary.

use crate::fixtures::Folder;
use crate::ply_writer::encoded;
use crate::{corners, warned};
use lightbuffer::scene::{Scene, formats};

const ENCODINGS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

fn load(bytes: impl AsRef<[u8]>) -> Scene {
    let folder = Folder::new();
    formats::load(&folder.write("test.ply", bytes)).unwrap()
}

/// Loads a file in all three encodings, demands that they are one scene, and returns it.
fn load_all(text: &str) -> Scene {
    let [text, little, big] = ENCODINGS.map(|encoding| load(encoded(text, encoding)));
    for other in [&little, &big] {
        assert_eq!(bits(&text), bits(other));
        assert_eq!(text.warnings, other.warnings);
    }
    text
}

fn bits(scene: &Scene) -> Vec<u32> {
    corners(scene).into_iter().flatten().flatten().map(f32::to_bits).collect()
}

/// A header and a body of a square in the plane z = 0 and what follows it.
fn square(vertex_properties: &str, face_properties: &str, faces: &str) -> String {
    let count = faces.lines().count();
    format!(
        "ply\nformat ascii 1.0\ncomment ours\nobj_info none\nelement vertex 4\n{vertex_properties}\
         element face {count}\n{face_properties}end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n{faces}"
    )
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const LIST: &str = "property list uchar int vertex_indices\n";
const A: [f32; 3] = [0.0, 0.0, 0.0];
const B: [f32; 3] = [1.0, 0.0, 0.0];
const C: [f32; 3] = [1.0, 1.0, 0.0];
const D: [f32; 3] = [0.0, 1.0, 0.0];

#[test]
fn a_square_is_two_triangles_in_every_encoding() {
    let scene = load_all(&square(XYZ, LIST, "4 0 1 2 3\n"));
    assert_eq!(corners(&scene), [[A, B, C], [A, C, D]]);
    assert_eq!((scene.vertices.len(), scene.objects.len()), (4, 1));
    assert_eq!((scene.name.as_str(), scene.objects[0].name.as_str()), ("test.ply", "test"));
    assert!(scene.objects[0].normals.is_none() && scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert!(scene.lights.is_empty() && scene.cameras.is_empty());
}

#[test]
fn every_type_of_coordinates_and_lists_is_read() {
    for scalar in [
        "char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8", "int16",
        "uint16", "int32", "uint32", "float32", "float64",
    ] {
        let xyz = XYZ.replace("float", scalar);
        assert_eq!(corners(&load_all(&square(&xyz, LIST, "3 0 1 2\n"))), [[A, B, C]], "{scalar}");
        if !scalar.starts_with("float") && scalar != "double" {
            let list = LIST.replace("uchar", scalar).replace("int vertex", &format!("{scalar} vertex"));
            assert_eq!(corners(&load_all(&square(XYZ, &list, "3 0 1 2\n"))), [[A, B, C]], "{scalar}");
        }
    }
}

#[test]
fn numbers_are_rounded_once() {
    // Halfway between two floats but for the last digit: through f64 the text would be rounded twice.
    let text = square(XYZ, LIST, "3 0 1 2\n").replace("1 0 0", "1.00000005960464477539063 0 0");
    assert_eq!(load(&text).vertices[1].x, 1.0f32.next_up());
    let double = text.replace("property float x", "property double x");
    assert_eq!(load(encoded(&double, "binary_little_endian")).vertices[1].x, 1.0);
    assert_eq!(load(&double).vertices[1].x, 1.0f32.next_up());
    let whole = square(&XYZ.replace("float", "int"), LIST, "3 0 1 2\n").replace("1 1 0", "16777219 1 0");
    assert_eq!(load_all(&whole).vertices[2].x, 16777220.0);
}

#[test]
fn a_list_of_corners_has_either_name_and_any_neighbours() {
    let list = "property uchar flags\nproperty list uchar double texcoord\nproperty list ushort uint vertex_index\n\
                property list char short other\nproperty double last\n";
    let scene = load_all(&square(XYZ, list, "7 2 0.5 1e300 3 3 2 1 1 -9 0.25\n8 0 3 0 1 2 0 1\n"));
    assert_eq!(corners(&scene), [[D, C, B], [A, B, C]]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn a_concave_polygon_is_filled_and_no_more() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 6\n{XYZ}element face 1\n{LIST}end_header\n\
         2 1 1\n2 1 2\n2 0 2\n2 0 0\n2 2 0\n2 2 1\n6 0 1 2 3 4 5\n"
    );
    let scene = load_all(&text);
    let area: f32 = (0..scene.triangles.len() as u32)
        .map(|t| {
            let [a, b, c] = scene.corners(t);
            ((b - a).cross(c - a).x * 0.5).abs()
        })
        .sum();
    assert_eq!((scene.triangles.len(), area), (4, 3.0));
}

#[test]
fn normals_of_vertices_are_kept_with_unit_length() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float nx\nproperty float x\nproperty float y\n\
         property float ny\nproperty float z\nproperty double nz\nelement face 2\n{LIST}end_header\n\
         0 0 0 0 0 2\n3 1 0 4 0 0\n0 0 1 0 0 1e-30\n0 1 1 0 0 0\n3 0 1 2\n3 1 3 2\n"
    );
    let scene = load_all(&text);
    let normals = scene.objects[0].normals.as_ref().unwrap();
    let of = |t: usize| normals.corners[t].map(|corner| normals.normals[corner as usize].to_array());
    assert_eq!(of(0), [[0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(of(1), [[0.6, 0.8, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    assert_eq!(warned(&scene, "normals of zero or infinite length are replaced by the face's (1 corner)"), 1);
}

#[test]
fn two_components_of_a_normal_are_none() {
    let properties = format!("{XYZ}property float nx\nproperty float ny\n");
    let text = square(&properties, LIST, "3 0 1 2\n").replace(" 0\n", " 0 1 1\n");
    assert!(load(text).objects[0].normals.is_none());
}

#[test]
fn strips_are_wound_alternately_and_begin_anew_at_minus_one() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 4\n{XYZ}element tristrips 1\n\
         property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n\
         11 0 1 3 2 -1 1 2 3 -1 0 1\n"
    );
    assert_eq!(corners(&load_all(&text)), [[A, B, D], [D, B, C], [B, C, D]]);
}

#[test]
fn faces_may_come_before_their_vertices_and_beside_other_elements() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement face 2\n{LIST}element edge 2\nproperty int vertex1\n\
         property list uchar float more\nelement nothing 1000000000000\nelement vertex 4\n{XYZ}\
         element material 1\nproperty uchar red\nend_header\n\
         3 0 1 2\n3 0 2 3\n5 2 0 0\n6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n255\n"
    );
    let scene = load_all(&text);
    assert_eq!(corners(&scene), [[A, B, C], [A, C, D]]);
    warned(&scene, "elements `edge` are not drawn (2 elements)");
    warned(&scene, "elements `nothing` are not drawn (1000000000000 elements)");
    assert_eq!(warned(&scene, "elements `material` are not drawn (1 element)"), 3);
}

#[test]
fn what_is_not_drawn_is_said_once() {
    let coloured = format!("{XYZ}property uchar red\nproperty uchar green\nproperty uchar blue\n");
    let face = format!("{LIST}property uchar red\n");
    let text = square(&coloured, &face, "3 0 1 2 9\n2 0 1 9\n0 9\n4 0 2 1 3 9\n");
    let text = text.replace(" 0\n", " 0 255 0 0\n").replace("comment ours", "comment TextureFile a.png");
    let text = text.replace("3 0 1 2 9", "\n3 0 1 2 9\n") + "\n3 0 1 2\n";
    let scene = load(&text);
    assert_eq!(scene.triangles.len(), 3);
    warned(&scene, "vertex colours are not drawn (1 file)");
    warned(&scene, "face colours are not drawn (1 file)");
    warned(&scene, "textures are not drawn (1 file)");
    warned(&scene, "faces of fewer than three corners are not drawn (2 faces)");
    warned(&scene, "outlines that cross themselves are cut into triangles as far as possible (1 polygon)");
    assert_eq!(warned(&scene, "what follows the last element is not read (all from line 27 on)"), 6);
    let scene = load([encoded(&square(XYZ, LIST, "3 0 1 2\n"), "binary_big_endian"), vec![0; 7]].concat());
    assert_eq!(warned(&scene, "what follows the last element is not read (7 bytes)"), 1);
}

#[test]
fn triangles_with_bad_numbers_are_dropped_and_counted() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty float y\nproperty float z\n\
         element face 4\n{LIST}end_header\n0 0 0\n1 0 0\n0 1 0\n1e99 0 0\n0 nan 0\n2 0 0\n\
         3 0 1 2\n3 0 1 3\n4 0 1 2 4\n3 0 1 5\n"
    );
    let scene = load_all(&text);
    assert_eq!(corners(&scene), [[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]]);
    assert_eq!((scene.dropped.non_finite, scene.dropped.degenerate), (3, 1));
}

#[test]
fn lines_may_end_in_every_usual_way() {
    let text = square(XYZ, LIST, "3 0 1 2\n");
    for end in ["\r\n", "\r"] {
        assert_eq!(corners(&load(text.replace('\n', end))), [[A, B, C]]);
        let binary = encoded(&text, "binary_little_endian");
        let body = binary.len() - (4 * 12 + 13);
        let header = String::from_utf8(binary[..body].to_vec()).unwrap().replace('\n', end);
        let file = [header.as_bytes(), &binary[body..]].concat();
        assert_eq!(corners(&load(file)), [[A, B, C]]);
    }
}
