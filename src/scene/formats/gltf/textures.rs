//! Where on a texture a surface lies: texture coordinates, `KHR_texture_transform`, and wrapping.

use super::schema::{Document, TextureEntry, TextureReference};
use crate::scene::Wrap;
use glam::DVec2;

/// Finds a texture.
pub(super) fn find(document: &Document, index: u64) -> Result<&TextureEntry, String> {
    let texture = usize::try_from(index).ok().and_then(|i| document.textures.get(i));
    texture.ok_or_else(|| format!("texture {index} of {}", document.textures.len()))
}

/// How the image of a texture goes on beyond its sides.
///
/// # Errors
/// A line if there is no such sampler or it names another way.
pub(super) fn wrap(document: &Document, texture: &TextureEntry) -> Result<[Wrap; 2], String> {
    let Some(index) = texture.sampler else { return Ok([Wrap::Repeat; 2]) };
    let sampler = usize::try_from(index).ok().and_then(|i| document.samplers.get(i));
    let sampler = sampler.ok_or_else(|| format!("sampler {index} of {}", document.samplers.len()))?;
    let wrap = |code: Option<u64>| match code.unwrap_or(10497) {
        33071 => Ok(Wrap::ClampToEdge),
        33648 => Ok(Wrap::MirroredRepeat),
        10497 => Ok(Wrap::Repeat),
        other => Err(format!("sampler {index}: expected to wrap by 33071, 33648 or 10497, found {other}")),
    };
    Ok([wrap(sampler.wrap_s)?, wrap(sampler.wrap_t)?])
}

/// Which texture coordinates of a mesh are taken, and where they come to lie on the texture.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Placement {
    /// The n of `TEXCOORD_n`.
    pub(super) set: u64,
    offset: DVec2,
    /// Sine and cosine.
    rotation: (f64, f64),
    scale: DVec2,
}

impl Placement {
    /// As a material says.
    pub(super) fn of(reference: &TextureReference) -> Placement {
        let transform = reference.extensions.transform.as_ref();
        Placement {
            set: transform.and_then(|t| t.tex_coord).unwrap_or(reference.tex_coord),
            offset: transform.and_then(|t| t.offset).map_or(DVec2::ZERO, DVec2::from),
            rotation: libm::sincos(transform.and_then(|t| t.rotation).unwrap_or(0.0)),
            scale: transform.and_then(|t| t.scale).map_or(DVec2::ONE, DVec2::from),
        }
    }

    /// `TEXCOORD_n`.
    pub(super) fn attribute(&self) -> String {
        format!("TEXCOORD_{}", self.set)
    }

    /// Scales, then rotates, then moves; rounded once to f32.
    ///
    /// Rotation is counter-clockwise as one sees it on the image, whose v points down. (The matrix that the
    /// extension prints turns the other way round, against its own text and example.)
    pub(super) fn apply(&self, coordinate: DVec2) -> [f32; 2] {
        let (sin, cos) = self.rotation;
        let scaled = self.scale * coordinate;
        let turned = DVec2::new(cos * scaled.x + sin * scaled.y, cos * scaled.y - sin * scaled.x);
        (turned + self.offset).as_vec2().to_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extensions_example_is_the_lower_left_quadrant() {
        let json = r#"{"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform":
            {"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5], "texCoord": 3}}}"#;
        let placement = Placement::of(&serde_json::from_str(json).unwrap());
        assert_eq!(placement.set, 3);
        for (from, to) in [([0.0, 0.0], [0.0, 1.0]), ([1.0, 0.0], [0.0, 0.5]), ([0.0, 1.0], [0.5, 1.0])] {
            let found = placement.apply(DVec2::from(from));
            assert!((0..2).all(|i| (found[i] - to[i]).abs() < 1e-6), "{from:?} came to {found:?}");
        }
    }

    #[test]
    fn scale_comes_before_rotation() {
        let json = r#"{"index": 0, "extensions": {"KHR_texture_transform":
            {"offset": [0.25, 0], "rotation": -1.5707963267948966, "scale": [3, 1]}}}"#;
        let found = Placement::of(&serde_json::from_str(json).unwrap()).apply(DVec2::new(1.0, 0.0));
        assert_eq!(found, [0.25, 3.0]);
        let plain = Placement::of(&serde_json::from_str(r#"{"index": 0, "texCoord": 2}"#).unwrap());
        assert_eq!((plain.set, plain.apply(DVec2::new(0.1, -7.5))), (2, [0.1, -7.5]));
    }
}
