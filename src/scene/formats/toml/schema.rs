//! The elements of a TOML scene, key by key. `docs/SCENE-FORMAT.md` explains each; a test holds the two
//! against each other.

use super::values::{Direction, Exactly, Number, OneOrThree, Point, Share, Strength};
use serde::Deserialize;
use toml::Spanned;

/// A file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Document {
    /// Checked before anything else is read.
    #[serde(rename = "version")]
    pub(super) _version: i64,
    pub(super) name: Option<String>,
    #[serde(default, rename = "include")]
    pub(super) includes: Vec<Spanned<IncludeEntry>>,
    #[serde(default, rename = "material")]
    pub(super) materials: Vec<Spanned<MaterialEntry>>,
    #[serde(default, rename = "mesh")]
    pub(super) meshes: Vec<Spanned<MeshEntry>>,
    #[serde(default, rename = "light")]
    pub(super) lights: Vec<Spanned<LightEntry>>,
    #[serde(default, rename = "camera")]
    pub(super) cameras: Vec<Spanned<CameraEntry>>,
}

/// Another scene file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct IncludeEntry {
    pub(super) path: String,
    pub(super) transform: Option<Spanned<TransformEntry>>,
    pub(super) cast_shadows: Option<bool>,
    pub(super) receive_shadows: Option<bool>,
    pub(super) lights: Option<bool>,
    pub(super) cameras: Option<bool>,
    pub(super) material: Option<Spanned<String>>,
}

/// Where something goes.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TransformEntry {
    pub(super) matrix: Option<Exactly<Exactly<Number, 4>, 4>>,
    pub(super) scale: Option<OneOrThree>,
    pub(super) rotate: Option<RotationEntry>,
    pub(super) translate: Option<Exactly<Number, 3>>,
}

/// A turn around an axis.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RotationEntry {
    pub(super) axis: Exactly<Number, 3>,
    pub(super) degrees: Number,
}

/// How a surface reflects light.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialEntry {
    pub(super) name: String,
    pub(super) diffuse: Option<Share>,
    pub(super) specular: Option<Share>,
    pub(super) shininess: Option<Number>,
}

/// Polygons.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshEntry {
    pub(super) name: Option<String>,
    pub(super) material: Option<Spanned<String>>,
    pub(super) vertices: Vec<Point>,
    pub(super) faces: Vec<Spanned<Vec<u32>>>,
    pub(super) normals: Option<Vec<Point>>,
    pub(super) transform: Option<Spanned<TransformEntry>>,
    pub(super) cast_shadows: Option<bool>,
    pub(super) receive_shadows: Option<bool>,
}

/// A light of any kind; which keys a kind has is checked afterwards.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightEntry {
    pub(super) name: Option<String>,
    #[serde(rename = "type")]
    pub(super) kind: LightKind,
    pub(super) position: Option<Point>,
    pub(super) intensity: Option<Strength>,
    pub(super) falloff: Option<FalloffName>,
    pub(super) range: Option<Number>,
    pub(super) direction: Option<Direction>,
    pub(super) target: Option<Point>,
    pub(super) inner_degrees: Option<Number>,
    pub(super) outer_degrees: Option<Number>,
    pub(super) towards: Option<Direction>,
    pub(super) irradiance: Option<Strength>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum LightKind {
    Point,
    Spot,
    Directional,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FalloffName {
    InverseSquare,
    None,
}

/// A camera.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraEntry {
    pub(super) name: Option<String>,
    pub(super) position: Point,
    pub(super) target: Point,
    pub(super) up: Option<Direction>,
    pub(super) vertical_degrees: Option<Number>,
    pub(super) size: Option<Exactly<u32, 2>>,
}
