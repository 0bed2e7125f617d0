//! Textures: colours that vary over a surface. Shadows never depend on them.

use super::Wrap;
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// A pattern, and how it lies on the surfaces that have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// What is to be seen.
    pub pattern: Pattern,
    /// Where.
    pub mapping: Mapping,
}

/// What a texture does to the diffuse colour of a material.
#[derive(Debug, Clone, PartialEq)]
pub enum Pattern {
    /// Cells of edge 1 that have the material's colour and another in turn, as on a chessboard. The cell that
    /// begins at the origin has the material's.
    Checker {
        /// The other colour, linear Rec. 709, each channel in [0, 1].
        other: [f32; 3],
    },
    /// A picture, times the material's colour.
    Image {
        /// Shared, since it may be large.
        image: Arc<Image>,
        /// How it goes on beyond its sides, along u and along v.
        wrap: [Wrap; 2],
    },
}

/// How points get the coordinates (u, v, w) that a pattern is looked up by. A picture fills u and v from 0 to
/// 1, v upwards, and goes on along w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mapping {
    /// x, y and z of the world: the surface is cut from a solid block.
    Solid {
        /// Where all are 0.
        origin: Vec3,
        /// The length of 1, above 0.
        size: f32,
    },
    /// Along two vectors of the world; what is above or below their plane is as what is in it.
    Planar {
        /// Where both are 0.
        origin: Vec3,
        /// From there to u = 1.
        u: Vec3,
        /// From there to v = 1, not parallel to `u`.
        v: Vec3,
    },
    /// The texture coordinates of the mesh, which count v downwards. What has none keeps its material's
    /// colour.
    Coordinates,
}

/// A picture; rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Texels in a row; at least 1.
    pub width: u32,
    /// Rows; at least 1.
    pub height: u32,
    /// Row by row from the top, `width * height` of them.
    pub texels: Texels,
}

/// The colours of a picture.
#[derive(Debug, Clone, PartialEq)]
pub enum Texels {
    /// Linear Rec. 709.
    Linear(Vec<[f32; 3]>),
    /// In 8 bits, as sRGB encodes them.
    Srgb(Vec<[u8; 3]>),
}

impl Texels {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Texels::Linear(texels) => texels.len(),
            Texels::Srgb(texels) => texels.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl Texture {
    /// What keeps it from being one, in words.
    pub fn defect(&self) -> Option<&'static str> {
        match &self.pattern {
            Pattern::Checker { other } if !other.iter().all(|c| (0.0..=1.0).contains(c)) => {
                return Some("expected a colour from 0 to 1");
            }
            Pattern::Image { image, .. } => {
                let count = u64::from(image.width) * u64::from(image.height);
                if count == 0 || image.texels.len() as u64 != count {
                    return Some("expected as many texels as width times height, and at least one");
                }
                let finite = |texels: &[[f32; 3]]| texels.iter().flatten().all(|c| c.is_finite());
                if matches!(&image.texels, Texels::Linear(texels) if !finite(texels)) {
                    return Some("expected texels of finite numbers");
                }
            }
            Pattern::Checker { .. } => {}
        }
        self.mapping.defect()
    }
}

impl Mapping {
    fn defect(&self) -> Option<&'static str> {
        match self {
            Mapping::Solid { origin, size } => {
                let sound = origin.is_finite() && *size > 0.0 && size.is_finite();
                (!sound).then_some("expected a finite origin and a size above 0")
            }
            Mapping::Planar { origin, u, v } => {
                let sound = origin.is_finite() && u.is_finite() && v.is_finite();
                let sound = sound && dual(*u, *v).is_some();
                (!sound).then_some("expected `u` and `v` to be finite and not along one line")
            }
            Mapping::Coordinates => None,
        }
    }
}

/// Two vectors whose products with a place in the plane of `u` and `v` are its coordinates along these.
pub(crate) fn dual(u: Vec3, v: Vec3) -> Option<[DVec3; 2]> {
    let (u, v) = (u.as_dvec3(), v.as_dvec3());
    let normal = u.cross(v);
    let area = normal.length_squared();
    let found = [v.cross(normal) / area, normal.cross(u) / area];
    let steep = area > 1e-12 * u.length_squared() * v.length_squared();
    (steep && found.iter().all(|vector| vector.is_finite())).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_along_slanted_vectors() {
        let (u, v) = (Vec3::new(2.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 4.0));
        let [along_u, along_v] = dual(u, v).unwrap();
        let place = (u * 0.25 + v * 0.5 + Vec3::Y * 7.0).as_dvec3();
        assert!((along_u.dot(place) - 0.25).abs() < 1e-12 && (along_v.dot(place) - 0.5).abs() < 1e-12);
        assert_eq!(dual(u, -u), None);
        assert_eq!(dual(u, Vec3::ZERO), None);
        assert_eq!(dual(u, Vec3::splat(f32::NAN)), None);
    }

    #[test]
    fn textures_that_are_none() {
        let checker = |other: f32, mapping: Mapping| {
            Texture { pattern: Pattern::Checker { other: [other; 3] }, mapping }.defect()
        };
        let solid = |size: f32| Mapping::Solid { origin: Vec3::ZERO, size };
        assert_eq!(checker(0.5, solid(1.0)), None);
        assert_eq!(checker(0.5, Mapping::Coordinates), None);
        for size in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(checker(0.5, solid(size)).is_some(), "{size}");
        }
        assert!(checker(1.5, solid(1.0)).is_some() && checker(f32::NAN, solid(1.0)).is_some());
        let image = |width: u32, height: u32, texels: Texels| {
            let image = Arc::new(Image { width, height, texels });
            let pattern = Pattern::Image { image, wrap: [Wrap::Repeat; 2] };
            Texture { pattern, mapping: Mapping::Coordinates }.defect()
        };
        assert_eq!(image(2, 1, Texels::Srgb(vec![[0; 3]; 2])), None);
        assert!(image(2, 2, Texels::Srgb(vec![[0; 3]; 2])).is_some());
        assert!(image(0, 0, Texels::Srgb(vec![])).is_some());
        assert!(image(1, 1, Texels::Linear(vec![[0.0, f32::NAN, 0.0]])).is_some());
    }
}
