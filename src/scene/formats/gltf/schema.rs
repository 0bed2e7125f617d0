//! The parts of glTF's JSON that are read here, as they stand in the file.
//!
//! `serde_json` reads them and names line and column of what does not fit. The `gltf` crate's own types are
//! not used: they cut indices to 32 bits, so that 4294967296 silently means 0, round transforms to f32, and
//! panic on a `POSITION` that does not exist while they validate. Nothing here has been checked beyond its
//! type.

use super::extras::Extras;
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;

/// A whole document.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    pub(super) asset: Asset,
    pub(super) scene: Option<u64>,
    #[serde(default)]
    pub(super) scenes: Vec<SceneEntry>,
    #[serde(default)]
    pub(super) nodes: Vec<Node>,
    #[serde(default)]
    pub(super) meshes: Vec<Mesh>,
    #[serde(default)]
    pub(super) accessors: Vec<Accessor>,
    #[serde(default)]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub(super) buffers: Vec<Buffer>,
    #[serde(default)]
    pub(super) materials: Vec<MaterialEntry>,
    #[serde(default)]
    pub(super) textures: Vec<TextureEntry>,
    #[serde(default)]
    pub(super) images: Vec<ImageEntry>,
    #[serde(default)]
    pub(super) samplers: Vec<SamplerEntry>,
    #[serde(default)]
    pub(super) skins: Vec<SkinEntry>,
    #[serde(default)]
    pub(super) cameras: Vec<CameraEntry>,
    #[serde(default)]
    pub(super) animations: Vec<AnimationEntry>,
    #[serde(default)]
    pub(super) extensions_used: Vec<String>,
    #[serde(default)]
    pub(super) extensions_required: Vec<String>,
    #[serde(default)]
    pub(super) extensions: DocumentExtensions,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Asset {
    pub(super) version: String,
    pub(super) min_version: Option<String>,
}

#[derive(Deserialize, Default)]
pub(super) struct DocumentExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) lights: Option<Lights>,
}

#[derive(Deserialize)]
pub(super) struct Lights {
    #[serde(default)]
    pub(super) lights: Vec<LightEntry>,
}

#[derive(Deserialize)]
pub(super) struct LightEntry {
    pub(super) name: Option<String>,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) color: Option<[f64; 3]>,
    pub(super) intensity: Option<f64>,
    pub(super) range: Option<f64>,
    #[serde(default)]
    pub(super) spot: SpotCone,
}

/// Half the opening angles of a spot light, in radians.
#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct SpotCone {
    pub(super) inner_cone_angle: Option<f64>,
    pub(super) outer_cone_angle: Option<f64>,
}

#[derive(Deserialize)]
pub(super) struct SceneEntry {
    #[serde(default)]
    pub(super) nodes: Vec<u64>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) children: Vec<u64>,
    pub(super) mesh: Option<u64>,
    pub(super) camera: Option<u64>,
    pub(super) skin: Option<u64>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    pub(super) weights: Option<Vec<f64>>,
    #[serde(default)]
    pub(super) extensions: NodeExtensions,
    #[serde(default)]
    pub(super) extras: Extras,
}

#[derive(Deserialize, Default)]
pub(super) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) light: Option<LightReference>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub(super) instancing: Option<Instancing>,
}

#[derive(Deserialize)]
pub(super) struct Instancing {
    #[serde(default)]
    pub(super) attributes: BTreeMap<String, u64>,
}

#[derive(Deserialize)]
pub(super) struct LightReference {
    pub(super) light: u64,
}

#[derive(Deserialize)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    pub(super) primitives: Vec<Primitive>,
    pub(super) weights: Option<Vec<f64>>,
    #[serde(default)]
    pub(super) extras: Extras,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    #[serde(default)]
    pub(super) attributes: BTreeMap<String, u64>,
    pub(super) indices: Option<u64>,
    pub(super) material: Option<u64>,
    pub(super) mode: Option<u64>,
    #[serde(default)]
    pub(super) targets: Vec<BTreeMap<String, u64>>,
    #[serde(default)]
    pub(super) extensions: PrimitiveExtensions,
}

#[derive(Deserialize, Default)]
pub(super) struct PrimitiveExtensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    pub(super) draco: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SkinEntry {
    pub(super) inverse_bind_matrices: Option<u64>,
    pub(super) joints: Vec<u64>,
}

#[derive(Deserialize)]
pub(super) struct AnimationEntry {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) channels: Vec<ChannelEntry>,
    #[serde(default)]
    pub(super) samplers: Vec<AnimationSampler>,
}

/// What of which node changes, and how.
#[derive(Deserialize)]
pub(super) struct ChannelEntry {
    pub(super) sampler: u64,
    pub(super) target: ChannelTarget,
}

#[derive(Deserialize)]
pub(super) struct ChannelTarget {
    pub(super) node: Option<u64>,
    pub(super) path: String,
}

/// Times and values.
#[derive(Deserialize)]
pub(super) struct AnimationSampler {
    pub(super) input: u64,
    pub(super) interpolation: Option<String>,
    pub(super) output: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<u64>,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u64,
    pub(super) count: u64,
    #[serde(rename = "type")]
    pub(super) shape: String,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) sparse: Option<SparseEntry>,
}

#[derive(Deserialize)]
pub(super) struct SparseEntry {
    pub(super) count: u64,
    pub(super) indices: SparseIndices,
    pub(super) values: SparseValues,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub(super) buffer_view: u64,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub(super) buffer_view: u64,
    #[serde(default)]
    pub(super) byte_offset: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: u64,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: u64,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct MaterialEntry {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) pbr_metallic_roughness: MetallicRoughness,
    pub(super) normal_texture: Option<IgnoredAny>,
    pub(super) occlusion_texture: Option<IgnoredAny>,
    pub(super) emissive_texture: Option<IgnoredAny>,
    pub(super) emissive_factor: Option<[f64; 3]>,
    pub(super) alpha_mode: Option<String>,
    pub(super) alpha_cutoff: Option<f64>,
    #[serde(default)]
    pub(super) extensions: MaterialExtensions,
}

#[derive(Deserialize, Default)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_transmission")]
    pub(super) transmission: Option<TransmissionEntry>,
    #[serde(rename = "KHR_materials_ior")]
    pub(super) ior: Option<IorEntry>,
}

/// How much light passes through a surface.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TransmissionEntry {
    pub(super) transmission_factor: Option<f64>,
    pub(super) transmission_texture: Option<IgnoredAny>,
}

/// How it is bent.
#[derive(Deserialize)]
pub(super) struct IorEntry {
    pub(super) ior: Option<f64>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct MetallicRoughness {
    pub(super) base_color_factor: Option<[f64; 4]>,
    pub(super) base_color_texture: Option<TextureReference>,
    pub(super) metallic_factor: Option<f64>,
    pub(super) roughness_factor: Option<f64>,
    pub(super) metallic_roughness_texture: Option<IgnoredAny>,
}

/// Where a material takes a texture from.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureReference {
    pub(super) index: u64,
    #[serde(default)]
    pub(super) tex_coord: u64,
    #[serde(default)]
    pub(super) extensions: TextureExtensions,
}

#[derive(Deserialize, Default)]
pub(super) struct TextureExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(super) transform: Option<TextureTransform>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureTransform {
    pub(super) offset: Option<[f64; 2]>,
    /// In radians.
    pub(super) rotation: Option<f64>,
    pub(super) scale: Option<[f64; 2]>,
    pub(super) tex_coord: Option<u64>,
}

#[derive(Deserialize)]
pub(super) struct TextureEntry {
    pub(super) source: Option<u64>,
    pub(super) sampler: Option<u64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ImageEntry {
    pub(super) uri: Option<String>,
    pub(super) buffer_view: Option<u64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SamplerEntry {
    pub(super) wrap_s: Option<u64>,
    pub(super) wrap_t: Option<u64>,
}

#[derive(Deserialize)]
pub(super) struct CameraEntry {
    pub(super) name: Option<String>,
    pub(super) perspective: Option<Perspective>,
}

#[derive(Deserialize)]
pub(super) struct Perspective {
    pub(super) yfov: f64,
}
