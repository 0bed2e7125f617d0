//! The scenes of `bench`: large, each hard in its own way, and each from a thousand triangles to about ten million, so
//! that it can be seen how costs grow. All are triangles that share their corners, as a program that writes meshes
//! would give them; y is up, one light is a point.

mod city;
mod forest;
mod hair_ball;
mod relief;
mod skin;
mod sphereflake;
mod terrain;

use super::studio::Studio;
use crate::scene::ImageSize;

pub(super) use city::build as city;
#[cfg(test)]
pub(super) use city::triangles as city_triangles;
pub(super) use forest::build as forest;
#[cfg(test)]
pub(super) use forest::triangles as forest_triangles;
pub(super) use hair_ball::build as hair_ball;
pub(super) use sphereflake::build as sphereflake;
pub(super) use terrain::build as terrain;

/// What they are looked at in, unless another size is asked for.
const SIZE: ImageSize = ImageSize { width: 1920, height: 1080 };

/// A scene with its sky and its only light.
fn studio(name: &str, sky: [f32; 3], light: [f32; 3]) -> Studio {
    let mut studio = Studio::new(name);
    studio.background(sky);
    studio.lamp("key", light, [1.0, 0.96, 0.9]);
    studio
}
