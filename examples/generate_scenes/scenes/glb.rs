//! A small writer of GLB files.

use super::solid::{Point, Shaded, Solid, cross, scale, sub, unit};
use serde_json::{Value, json};

/// A document that grows.
#[derive(Default)]
pub struct Writer {
    materials: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    lights: Vec<Value>,
    cameras: Vec<Value>,
    accessors: Vec<Value>,
    vectors: Vec<u8>,
    indices: Vec<u8>,
}

/// Which buffer view a vertex attribute and an index list live in.
const VECTORS: usize = 0;
const INDICES: usize = 1;

impl Writer {
    /// A material; returns its index.
    pub fn material(&mut self, name: &str, colour: [f64; 3], metallic: f64, roughness: f64) -> usize {
        let [r, g, b] = colour;
        self.materials.push(json!({
            "name": name,
            "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0],
                "metallicFactor": metallic,
                "roughnessFactor": roughness,
            },
        }));
        self.materials.len() - 1
    }

    /// A mesh of solids with their materials; returns its index.
    pub fn mesh(&mut self, name: &str, parts: &[(&Solid, usize)]) -> usize {
        let primitives: Vec<Value> = parts
            .iter()
            .map(|(solid, material)| {
                let Shaded { positions, normals, triangles } = solid.shaded();
                let position = self.vector_accessor(&positions);
                let normal = self.vector_accessor(&normals);
                let indices = self.index_accessor(&triangles);
                json!({
                    "attributes": { "POSITION": position, "NORMAL": normal },
                    "indices": indices,
                    "material": material,
                })
            })
            .collect();
        self.meshes.push(json!({ "name": name, "primitives": primitives }));
        self.meshes.len() - 1
    }

    fn vector_accessor(&mut self, vectors: &[[f32; 3]]) -> usize {
        let offset = self.vectors.len();
        self.vectors.extend(vectors.iter().flatten().flat_map(|v| v.to_le_bytes()));
        let bound = |pick: fn(f32, f32) -> f32| {
            [0, 1, 2].map(|k| vectors.iter().map(|v| v[k]).reduce(pick).unwrap_or(0.0))
        };
        self.accessors.push(json!({
            "bufferView": VECTORS,
            "byteOffset": offset,
            "componentType": 5126,
            "count": vectors.len(),
            "type": "VEC3",
            "min": bound(f32::min),
            "max": bound(f32::max),
        }));
        self.accessors.len() - 1
    }

    fn index_accessor(&mut self, triangles: &[[u16; 3]]) -> usize {
        let offset = self.indices.len();
        self.indices.extend(triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
        self.accessors.push(json!({
            "bufferView": INDICES,
            "byteOffset": offset,
            "componentType": 5123,
            "count": triangles.len() * 3,
            "type": "SCALAR",
        }));
        self.accessors.len() - 1
    }

    /// Shows a mesh as it is.
    pub fn show(&mut self, name: &str, mesh: usize) {
        self.nodes.push(json!({ "name": name, "mesh": mesh }));
    }

    /// Shows a mesh turned about the y axis, then scaled and moved.
    pub fn show_at(&mut self, name: &str, mesh: usize, turn: f64, size: Point, position: Point) {
        let (sin, cos) = libm::sincos(turn * 0.5);
        self.nodes.push(json!({
            "name": name,
            "mesh": mesh,
            "rotation": [0.0, micro(sin), 0.0, micro(cos)],
            "scale": size,
            "translation": position.map(micro),
        }));
    }

    /// A point light.
    pub fn light(&mut self, name: &str, position: Point, colour: [f64; 3], candela: f64) {
        self.lights.push(json!({ "name": name, "type": "point", "color": colour, "intensity": candela }));
        self.nodes.push(json!({
            "name": name,
            "translation": position,
            "extensions": { "KHR_lights_punctual": { "light": self.lights.len() - 1 } },
        }));
    }

    /// A perspective camera with a vertical field of view in radians.
    pub fn camera(&mut self, name: &str, eye: Point, target: Point, yfov: f64) {
        let back = unit(sub(eye, target));
        let right = unit(cross([0.0, 1.0, 0.0], back));
        let up = cross(back, right);
        let perspective = json!({ "aspectRatio": 16.0 / 9.0, "yfov": yfov, "znear": 0.01 });
        self.cameras.push(json!({ "name": name, "type": "perspective", "perspective": perspective }));
        let column = |v: Point, w: f64| [v[0], v[1], v[2], w];
        let columns = [column(right, 0.0), column(up, 0.0), column(scale(back, 1.0), 0.0), column(eye, 1.0)];
        let matrix: Vec<f64> = columns.iter().flatten().copied().collect();
        self.nodes.push(json!({ "name": name, "camera": self.cameras.len() - 1, "matrix": matrix }));
    }

    /// The finished file.
    pub fn finish(mut self, copyright: &str) -> Vec<u8> {
        let vectors = self.vectors.len();
        let indices = self.indices.len();
        let roots: Vec<usize> = (0..self.nodes.len()).collect();
        let document = json!({
            "asset": { "version": "2.0", "generator": "lightbuffer generate_scenes", "copyright": copyright },
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": { "KHR_lights_punctual": { "lights": self.lights } },
            "scene": 0,
            "scenes": [{ "nodes": roots }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "cameras": self.cameras,
            "accessors": self.accessors,
            "bufferViews": [
                { "buffer": 0, "byteLength": vectors, "byteStride": 12, "target": 34962 },
                { "buffer": 0, "byteOffset": vectors, "byteLength": indices, "target": 34963 },
            ],
            "buffers": [{ "byteLength": vectors + indices }],
        });
        let mut json = document.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut binary = std::mem::take(&mut self.vectors);
        binary.append(&mut self.indices);
        binary.resize(binary.len().next_multiple_of(4), 0);

        let size = |bytes: usize| u32::try_from(bytes).expect("a small file").to_le_bytes();
        let mut file = Vec::new();
        file.extend(b"glTF");
        file.extend(2u32.to_le_bytes());
        file.extend(size(12 + 8 + json.len() + 8 + binary.len()));
        for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
            file.extend(size(chunk.len()));
            file.extend(kind);
            file.extend(chunk);
        }
        file
    }
}

/// Rounded to millionths: a third of the digits, and nothing that an eye could see.
fn micro(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
