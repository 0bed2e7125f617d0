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
    pub(super) background: Option<Strength>,
    pub(super) fps: Option<Spanned<Number>>,
    #[serde(default, rename = "include")]
    pub(super) includes: Vec<Spanned<IncludeEntry>>,
    #[serde(default, rename = "material")]
    pub(super) materials: Vec<Spanned<MaterialEntry>>,
    #[serde(default, rename = "mesh")]
    pub(super) meshes: Vec<Spanned<MeshEntry>>,
    #[serde(default, rename = "sphere")]
    pub(super) spheres: Vec<Spanned<SphereEntry>>,
    #[serde(default, rename = "ellipsoid")]
    pub(super) ellipsoids: Vec<Spanned<EllipsoidEntry>>,
    #[serde(default, rename = "cylinder")]
    pub(super) cylinders: Vec<Spanned<CylinderEntry>>,
    #[serde(default, rename = "cone")]
    pub(super) cones: Vec<Spanned<ConeEntry>>,
    #[serde(default, rename = "disc")]
    pub(super) discs: Vec<Spanned<DiscEntry>>,
    #[serde(default, rename = "plane")]
    pub(super) planes: Vec<Spanned<PlaneEntry>>,
    #[serde(default, rename = "quadric")]
    pub(super) quadrics: Vec<Spanned<QuadricEntry>>,
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
    pub(super) keyframes: Option<Spanned<Vec<Spanned<TransformKey>>>>,
    pub(super) cast_shadows: Option<bool>,
    pub(super) receive_shadows: Option<bool>,
    pub(super) lights: Option<bool>,
    pub(super) cameras: Option<bool>,
    pub(super) material: Option<Spanned<String>>,
}

/// Where something goes.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TransformEntry {
    pub(super) matrix: Option<Exactly<Exactly<Number, 4>, 4>>,
    pub(super) scale: Option<OneOrThree>,
    pub(super) rotate: Option<RotationEntry>,
    pub(super) translate: Option<Exactly<Number, 3>>,
}

/// A turn around an axis.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RotationEntry {
    pub(super) axis: Exactly<Number, 3>,
    pub(super) degrees: Number,
}

/// How something goes from one keyframe to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum InterpolationName {
    Linear,
    Step,
}

/// Where something is at a frame.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TransformKey {
    pub(super) frame: Number,
    pub(super) interpolation: Option<InterpolationName>,
    pub(super) scale: Option<OneOrThree>,
    pub(super) rotate: Option<RotationEntry>,
    pub(super) translate: Option<Exactly<Number, 3>>,
}

/// A light at a frame.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightKey {
    pub(super) frame: Number,
    pub(super) interpolation: Option<InterpolationName>,
    pub(super) position: Option<Point>,
    pub(super) target: Option<Point>,
    pub(super) direction: Option<Direction>,
    pub(super) towards: Option<Direction>,
    pub(super) intensity: Option<Strength>,
    pub(super) irradiance: Option<Strength>,
    pub(super) rotate: Option<RotationEntry>,
    pub(super) translate: Option<Exactly<Number, 3>>,
}

/// A camera at a frame.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraKey {
    pub(super) frame: Number,
    pub(super) interpolation: Option<InterpolationName>,
    pub(super) position: Option<Point>,
    pub(super) target: Option<Point>,
    pub(super) up: Option<Direction>,
    pub(super) vertical_degrees: Option<Number>,
    pub(super) half_height: Option<Number>,
    pub(super) rotate: Option<RotationEntry>,
    pub(super) translate: Option<Exactly<Number, 3>>,
}

/// How a surface reflects light.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialEntry {
    pub(super) name: String,
    pub(super) diffuse: Option<Share>,
    pub(super) specular: Option<Share>,
    pub(super) shininess: Option<Number>,
    pub(super) mirror: Option<Share>,
    pub(super) transmittance: Option<Share>,
    pub(super) refractive_index: Option<Number>,
    pub(super) texture: Option<Spanned<TextureEntry>>,
}

/// A pattern, and how it lies; which keys go together is checked afterwards.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TextureEntry {
    pub(super) checker: Option<Share>,
    pub(super) image: Option<String>,
    pub(super) wrap_u: Option<WrapName>,
    pub(super) wrap_v: Option<WrapName>,
    pub(super) origin: Option<Point>,
    pub(super) size: Option<Number>,
    pub(super) u: Option<Direction>,
    pub(super) v: Option<Direction>,
    pub(super) coordinates: Option<bool>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum WrapName {
    Repeat,
    Mirror,
    Clamp,
}

/// The keys that all parts of objects have.
#[derive(Clone, Copy)]
pub(super) struct About<'a> {
    pub(super) name: Option<&'a str>,
    pub(super) object: Option<&'a str>,
    pub(super) material: Option<&'a Spanned<String>>,
    pub(super) transform: Option<&'a Spanned<TransformEntry>>,
    pub(super) keyframes: Option<&'a Spanned<Vec<Spanned<TransformKey>>>>,
    pub(super) cast_shadows: Option<bool>,
    pub(super) receive_shadows: Option<bool>,
}

/// A mesh or a curved surface: its own keys, and those that all have.
macro_rules! part {
    ($(#[$doc:meta])* $entry:ident { $(pub(super) $key:ident: $kind:ty,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $entry {
            $(pub(super) $key: $kind,)*
            name: Option<String>,
            object: Option<String>,
            material: Option<Spanned<String>>,
            transform: Option<Spanned<TransformEntry>>,
            keyframes: Option<Spanned<Vec<Spanned<TransformKey>>>>,
            cast_shadows: Option<bool>,
            receive_shadows: Option<bool>,
        }

        impl $entry {
            pub(super) fn about(&self) -> About<'_> {
                About {
                    name: self.name.as_deref(),
                    object: self.object.as_deref(),
                    material: self.material.as_ref(),
                    transform: self.transform.as_ref(),
                    keyframes: self.keyframes.as_ref(),
                    cast_shadows: self.cast_shadows,
                    receive_shadows: self.receive_shadows,
                }
            }
        }
    };
}

part! {
    /// Polygons.
    MeshEntry {
        pub(super) vertices: Vec<Point>,
        pub(super) faces: Vec<Spanned<Vec<u32>>>,
        pub(super) normals: Option<Vec<Point>>,
        pub(super) texture_coordinates: Option<Vec<Exactly<Number, 2>>>,
        pub(super) polygons: Option<u32>,
    }
}

part! {
    SphereEntry {
        pub(super) centre: Point,
        pub(super) radius: Number,
    }
}

part! {
    EllipsoidEntry {
        pub(super) centre: Point,
        pub(super) radii: Option<Point>,
        pub(super) axes: Option<Exactly<Point, 3>>,
    }
}

part! {
    CylinderEntry {
        pub(super) base: Point,
        pub(super) apex: Point,
        pub(super) radius: Number,
    }
}

part! {
    ConeEntry {
        pub(super) base: Point,
        pub(super) base_radius: Number,
        pub(super) apex: Point,
        pub(super) apex_radius: Option<Number>,
    }
}

part! {
    DiscEntry {
        pub(super) centre: Point,
        pub(super) normal: Direction,
        pub(super) radius: Number,
    }
}

part! {
    PlaneEntry {
        pub(super) point: Point,
        pub(super) normal: Direction,
    }
}

part! {
    QuadricEntry {
        pub(super) centre: Option<Point>,
        pub(super) squares: Option<Point>,
        pub(super) mixed: Option<Point>,
        pub(super) linear: Option<Point>,
        pub(super) constant: Option<Number>,
        pub(super) low: Point,
        pub(super) high: Point,
    }
}

/// A light of any kind; which keys a kind has is checked afterwards.
#[derive(Debug, Clone, Deserialize)]
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
    pub(super) keyframes: Option<Spanned<Vec<Spanned<LightKey>>>>,
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
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraEntry {
    pub(super) name: Option<String>,
    pub(super) position: Option<Point>,
    pub(super) target: Option<Point>,
    pub(super) up: Option<Direction>,
    pub(super) axes: Option<Exactly<Point, 3>>,
    pub(super) vertical_degrees: Option<Number>,
    pub(super) half_height: Option<Number>,
    pub(super) size: Option<Exactly<u32, 2>>,
    pub(super) keyframes: Option<Spanned<Vec<Spanned<CameraKey>>>>,
}
