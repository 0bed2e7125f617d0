//! A valid file of each format with everything in it that is read.

use crate::fixtures::{data_uri, triangle};
use crate::gltf_parts::{accessor, attributes, float_accessor, normalized, paint, png, replace};
use serde_json::{Value, json};

/// A material library for [`OBJ`].
pub const PAINT: &str =
    "newmtl red\nKd 1 0.5 0\nKs 1 1 1\nNs 20\nd 0.5\nillum 2\nmap_Kd a.png\nnewmtl blue\nKd 0 0 1\n";

pub const OBJ: &str = "# remark\nmtllib paint.mtl\no first\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0\nv 0.5 0.2 0\nvt 0 0\nvn 0 0 1\n\
    usemtl red\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -5//-1 -4//-1 -1//-1 \\\n -2//1\ng second\nusemtl blue\nf 1 2 3\nl 1 2\n";

pub const PLY: &str = "ply\nformat ascii 1.0\ncomment ours\nelement vertex 5\nproperty float x\nproperty double y\nproperty short z\n\
    property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nelement edge 1\nproperty list int float of\n\
    element face 3\nproperty list uchar int vertex_indices\nproperty char flag\nelement tristrips 1\n\
    property list uint int vertex_index\nend_header\n0 0 0 0 0 1 9\n1 0 0 0 0 1 9\n1 1 0 0 0 1 9\n0 1 0 0 0 1 9\n0.5 0.2 0 0 1 0 9\n\
    2 0.5 1.5\n4 0 1 2 3 7\n5 0 1 4 2 3 7\n3 0 1 2 7\n7 0 1 2 -1 1 2 3\n";

pub const NFF: &str = "# remark\nb 0 0 0\nv\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 45\nhither 1\nresolution 9 9\nl 4 3 2\n\
    l 1 -4 4 1 0.5 0\nf 1 0.5 0 0.8 0.2 10 0 1\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\nf 0 1 0 1 0 1 0.5 1.3\npp 4\n0 0 0 0 0 1\n\
    1 0 0 0 0 1\n0.5 0.2 0 0 1 0\n0 1 0 0 0 1\np 3\n0 0 1\n1 0 1\n0 1 1\ns 1 2 3 0.5\nc 0 0 0 1\n0 0 1 -0\n";

pub const TOML: &str = "version = 1\n[[include]]\npath = 'part.obj'\nmaterial = 'red'\ncast_shadows = false\nlights = true\n\
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
pub fn document() -> Value {
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
pub fn posed() -> Value {
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
