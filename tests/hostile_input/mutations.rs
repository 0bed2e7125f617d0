//! Valid files with bytes flipped, cut off, doubled or replaced: they load, or they are refused in one line.

use crate::assert_one_line;
use crate::fixtures::{Folder, data_uri, triangle, triangle_glb};
use crate::gltf_parts::{accessor, attributes, float_accessor, normalized, paint, png, replace};
use crate::ply_writer::encoded;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lightbuffer::scene::formats;
use proptest::prelude::*;
use serde_json::{Value, json};

/// One change of a file; places count in 65536ths of its length.
#[derive(Debug, Clone)]
enum Change {
    Flip { place: u16, mask: u8 },
    Put { place: u16, byte: u8 },
    Cut { place: u16 },
    Double { place: u16, length: u8 },
    Remove { place: u16, length: u8 },
}

fn change() -> impl Strategy<Value = Change> {
    // Bytes that mean something in the formats are put more often.
    let telling = prop::sample::select(b"0123456789-+.eE/\\\"{}[],: \n\tvfnN#\0\x7f\xff".to_vec());
    prop_oneof![
        (any::<u16>(), 1u8..).prop_map(|(place, mask)| Change::Flip { place, mask }),
        (any::<u16>(), telling).prop_map(|(place, byte)| Change::Put { place, byte }),
        any::<u16>().prop_map(|place| Change::Cut { place }),
        (any::<u16>(), any::<u8>()).prop_map(|(place, length)| Change::Double { place, length }),
        (any::<u16>(), any::<u8>()).prop_map(|(place, length)| Change::Remove { place, length }),
    ]
}

impl Change {
    fn apply(&self, file: &mut Vec<u8>) {
        let at = |place: u16| usize::from(place) * file.len() / 65536;
        if file.is_empty() {
            return;
        }
        match *self {
            Change::Flip { place, mask } => {
                let at = at(place);
                file[at] ^= mask;
            }
            Change::Put { place, byte } => {
                let at = at(place);
                file[at] = byte;
            }
            Change::Cut { place } => file.truncate(at(place)),
            Change::Double { place, length } => {
                let start = at(place);
                let end = (start + usize::from(length)).min(file.len());
                let copy = file[start..end].to_vec();
                file.splice(start..start, copy);
            }
            Change::Remove { place, length } => {
                let start = at(place);
                file.drain(start..(start + usize::from(length)).min(file.len()));
            }
        }
    }
}

/// Loads a changed file; the result may be either, but must be clean.
fn check(name: &str, mut file: Vec<u8>, changes: &[Change], mend: impl Fn(&mut Vec<u8>)) {
    changes.iter().for_each(|change| change.apply(&mut file));
    mend(&mut file);
    let folder = Folder::new();
    folder.write("paint.mtl", PAINT);
    folder.write("part.obj", OBJ);
    let path = folder.write(name, &file);
    match formats::load(&path) {
        Ok(scene) => {
            assert!(
                (0..scene.triangles.len() as u32).all(|t| scene.corners(t).iter().all(|p| p.is_finite()))
            );
            for object in &scene.objects {
                let mask = scene.materials[object.material as usize].coverage.mask();
                assert!(mask.is_none_or(|mask| (mask as usize) < scene.alpha_masks.len()));
                assert_eq!(object.texture_coordinates.is_some(), mask.is_some());
            }
            for text in scene.warnings.iter().chain(scene.objects.iter().map(|o| &o.name)) {
                assert!(!text.chars().any(char::is_control), "{text:?}");
            }
        }
        Err(error) => assert_one_line(&path, &error.to_string()),
    }
}

const PAINT: &str =
    "newmtl red\nKd 1 0.5 0\nKs 1 1 1\nNs 20\nd 0.5\nillum 2\nmap_Kd a.png\nnewmtl blue\nKd 0 0 1\n";

const OBJ: &str = "# remark\nmtllib paint.mtl\no first\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0\nv 0.5 0.2 0\nvt 0 0\nvn 0 0 1\n\
    usemtl red\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -5//-1 -4//-1 -1//-1 \\\n -2//1\ng second\nusemtl blue\nf 1 2 3\nl 1 2\n";

const PLY: &str = "ply\nformat ascii 1.0\ncomment ours\nelement vertex 5\nproperty float x\nproperty double y\nproperty short z\n\
    property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nelement edge 1\nproperty list int float of\n\
    element face 3\nproperty list uchar int vertex_indices\nproperty char flag\nelement tristrips 1\n\
    property list uint int vertex_index\nend_header\n0 0 0 0 0 1 9\n1 0 0 0 0 1 9\n1 1 0 0 0 1 9\n0 1 0 0 0 1 9\n0.5 0.2 0 0 1 0 9\n\
    2 0.5 1.5\n4 0 1 2 3 7\n5 0 1 4 2 3 7\n3 0 1 2 7\n7 0 1 2 -1 1 2 3\n";

const NFF: &str = "# remark\nb 0 0 0\nv\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 45\nhither 1\nresolution 9 9\nl 4 3 2\n\
    l 1 -4 4 1 0.5 0\nf 1 0.5 0 0.8 0.2 10 0 1\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\nf 0 1 0 1 0 1 0.5 1.3\npp 4\n0 0 0 0 0 1\n\
    1 0 0 0 0 1\n0.5 0.2 0 0 1 0\n0 1 0 0 0 1\np 3\n0 0 1\n1 0 1\n0 1 1\ns 1 2 3 0.5\nc 0 0 0 1\n0 0 1 -0\n";

const TOML: &str = "version = 1\n[[include]]\npath = 'part.obj'\nmaterial = 'red'\ncast_shadows = false\nlights = true\n\
    transform = { scale = [1, -2, 1], rotate = { axis = [0, 1, 0], degrees = 30 }, translate = [0, 0.5, 0] }\n\
    [[include]]\npath = 'part.obj'\n[include.transform]\nmatrix = [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n\
    [[material]]\nname = 'red'\ndiffuse = [1, 0.5, 0]\nspecular = 0.5\nshininess = 20\n[[mesh]]\nmaterial = 'red'\n\
    vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.2, 0]]\nfaces = [[0, 1, 2, 3], [0, 1, 4, 2]]\n\
    normals = [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 1, 0], [0, 0, 1]]\nreceive_shadows = false\n[[light]]\ntype = 'spot'\n\
    position = [1, 9, 1]\ntarget = [0, 0, 0]\ninner_degrees = 10\nouter_degrees = 20\nrange = 50\n[[light]]\n\
    type = 'directional'\ntowards = [0, 1, 0]\nirradiance = 2\n[[camera]]\nposition = [0, 1, 5]\ntarget = [0, 0, 0]\n\
    up = [0, 1, 0]\nvertical_degrees = 50\nsize = [8, 8]\n[[material]]\nname = 'glass'\ntransmittance = 0.5\nmirror = 0.1\n\
    texture = { checker = 1, size = 0.5 }\n[[sphere]]\nobject = 'a'\nmaterial = 'glass'\ncentre = [0, 1, 0]\nradius = 2\n\
    [[quadric]]\nsquares = [1, 0, -1]\nlow = [-1, -1, -1]\nhigh = [1, 1, 1]\n[[cone]]\nobject = 'a'\nbase = [0, 0, 0]\n\
    base_radius = 1\napex = [0, 1, 0]\ntransform = { scale = 2 }\n";

/// A document with everything that is read.
fn document() -> Value {
    let mut document = triangle();
    document["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } }]);
    document["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point", "range": 9 },
        { "type": "spot", "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.75 } }, { "type": "directional" }] } });
    let light = |index: u32| json!({ "KHR_lights_punctual": { "light": index } });
    let nodes = document["nodes"].as_array_mut().unwrap();
    nodes[0]["children"] = json!([1, 2, 3]);
    nodes[0]["matrix"] = json!([2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1]);
    nodes.push(json!({ "camera": 0, "rotation": [0, 0, 0, 1], "scale": [1, 2, 1], "extensions": light(1) }));
    nodes.push(json!({ "mesh": 0, "extensions": light(0), "translation": [0, 5, 0] }));
    nodes.push(json!({ "extensions": light(2), "extras": { "castShadow": false } }));
    document
}

/// A document of two skinned, morphed and masked triangles and two instances of them, in quantised and
/// sparse accessors.
fn posed() -> Value {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    document["materials"][0]["alphaMode"] = json!("MASK");
    paint(
        &mut document,
        json!({ "uri": data_uri(&png(2, &[0, 255])) }),
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
    );
    document["textures"][0]["sampler"] = json!(0);
    document["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648 }]);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": { "offset": [0.5, 0], "rotation": 0.5, "scale": [2, 2] } });
    let positions = accessor(&mut document, &[0, 0, 0, 9, 0, 0, 0, 9, 0], (5120, "VEC3"), 3);
    replace(&mut document, positions, &[0, 2], &[1, 0, 0, 0, 7, 0]);
    let target = float_accessor(&mut document, "VEC3", &[0.0, 0.0, 1.0].repeat(3));
    let joints = accessor(&mut document, &[0, 1, 0, 0].repeat(3), (5121, "VEC4"), 3);
    let weights = normalized(&mut document, &[155, 100, 0, 0].repeat(3), (5121, "VEC4"), 3);
    let moves = float_accessor(&mut document, "VEC3", &[1.0, 0.0, 0.0, 0.0, 5.0, 0.0]);
    for (name, index) in [("POSITION", positions), ("JOINTS_0", joints), ("WEIGHTS_0", weights)] {
        attributes(&mut document)[name] = json!(index);
    }
    document["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    document["meshes"][0]["weights"] = json!([0.5]);
    document["skins"] = json!([{ "joints": [0, 1] }]);
    document["nodes"] = json!([
        { "mesh": 0, "skin": 0, "extras": { "receiveShadow": false } },
        { "mesh": 0, "weights": [2], "translation": [0, 0, 1],
          "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": moves } } } },
    ]);
    document["scenes"][0]["nodes"] = json!([0, 1]);
    document
}

#[test]
fn what_is_changed_is_valid_before() {
    let folder = Folder::new();
    for (document, triangles) in [(document(), 2), (posed(), 3)] {
        let scene = formats::load(&folder.write("some.gltf", document.to_string())).unwrap();
        assert_eq!(scene.triangles.len(), triangles);
    }
    folder.write("paint.mtl", PAINT);
    folder.write("part.obj", OBJ);
    assert_eq!(formats::load(&folder.write("some.toml", TOML)).unwrap().triangles.len(), 14);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn of_obj(changes in prop::collection::vec(change(), 1..6)) {
        check("some.obj", OBJ.into(), &changes, |_| ());
    }

    #[test]
    fn of_gltf(changes in prop::collection::vec(change(), 1..6)) {
        check("some.gltf", document().to_string().into(), &changes, |_| ());
    }

    #[test]
    fn of_gltf_in_poses(changes in prop::collection::vec(change(), 1..6)) {
        check("some.gltf", posed().to_string().into(), &changes, |_| ());
    }

    /// Changes in the numbers and not in the words around them; the image is the third part of them.
    #[test]
    fn of_what_gltf_buffers_hold(changes in prop::collection::vec(change(), 1..4), buffer in any::<usize>()) {
        let mut document = posed();
        let buffers = document["buffers"].as_array().unwrap().len();
        let place = match buffer % (buffers + buffers / 2) {
            buffer if buffer < buffers => &mut document["buffers"][buffer],
            _ => &mut document["images"][0],
        };
        let uri = place["uri"].as_str().unwrap();
        let mut bytes = STANDARD.decode(uri.split_once(',').unwrap().1).unwrap();
        changes.iter().for_each(|change| change.apply(&mut bytes));
        place["uri"] = json!(data_uri(&bytes));
        check("some.gltf", document.to_string().into(), &[], |_| ());
    }

    #[test]
    fn of_glb(changes in prop::collection::vec(change(), 1..6)) {
        check("some.glb", triangle_glb(), &changes, |_| ());
    }

    /// With the length in the header put right, so that more than the header is read.
    #[test]
    fn of_glb_of_honest_length(changes in prop::collection::vec(change(), 1..6)) {
        check("some.glb", triangle_glb(), &changes, |file| {
            let length = (file.len() as u32).to_le_bytes();
            if let Some(declared) = file.get_mut(8..12) {
                declared.copy_from_slice(&length);
            }
        });
    }

    #[test]
    fn of_ply(changes in prop::collection::vec(change(), 1..6)) {
        check("some.ply", PLY.into(), &changes, |_| ());
    }

    /// With the header as it was, so that more than the header is read.
    #[test]
    fn of_the_body_of_binary_ply(changes in prop::collection::vec(change(), 1..6), big in any::<bool>()) {
        let encoding = if big { "binary_big_endian" } else { "binary_little_endian" };
        let file = encoded(PLY, encoding);
        let body = file.windows(11).position(|bytes| bytes == b"end_header\n").unwrap() + 11;
        let (header, body) = file.split_at(body);
        check("some.ply", body.to_vec(), &changes, |body| {
            body.splice(0..0, header.iter().copied());
        });
        check("some.ply", file.clone(), &changes, |_| ());
    }

    #[test]
    fn of_nff(changes in prop::collection::vec(change(), 1..6)) {
        check("some.nff", NFF.into(), &changes, |_| ());
    }

    #[test]
    fn of_toml(changes in prop::collection::vec(change(), 1..6)) {
        check("some.toml", TOML.into(), &changes, |_| ());
    }

    #[test]
    fn of_material_libraries(changes in prop::collection::vec(change(), 1..6)) {
        let mut library = PAINT.as_bytes().to_vec();
        changes.iter().for_each(|change| change.apply(&mut library));
        let folder = Folder::new();
        folder.write("other.mtl", &library);
        let path = folder.write("some.obj", OBJ.replace("paint", "other"));
        if let Err(error) = formats::load(&path) {
            assert_one_line(&path, &error.to_string());
        }
    }

    #[test]
    fn of_nothing(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        for name in ["some.obj", "some.ply", "some.gltf", "some.glb", "some.nff", "some.toml"] {
            check(name, bytes.clone(), &[], |_| ());
        }
    }
}
