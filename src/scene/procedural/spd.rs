//! The Standard Procedural Databases of "A Proposal for Standard Graphics Environments" (Haines, 1987), by the
//! geometry that it describes. Each grows with a size factor; z is up.

mod balls;
mod gears;
mod mountain;
mod rings;
mod teapot;
mod tetra;
mod tree;

use super::studio::Studio;
use crate::scene::{Camera, ImageSize, Material, ObjectInput, Transmission};
use glam::Vec3;

pub(super) use balls::{build as balls, directions as ball_directions, turn_to};
pub(super) use gears::build as gears;
pub(super) use mountain::build as mount;
pub(super) use rings::build as rings;
pub(super) use teapot::build as teapot;
pub(super) use tetra::build as tetra;
pub(super) use tree::build as tree;

/// Exponent of a highlight that nobody sees.
const NO_SHINE: f32 = 100_000.0;

/// Where it is looked at from, and what is looked at.
struct Viewpoint {
    from: [f32; 3],
    at: [f32; 3],
    up: [f32; 3],
}

/// Seen from `from`, z up.
const fn upright(from: [f32; 3], at: [f32; 3]) -> Viewpoint {
    Viewpoint { from, at, up: [0.0, 0.0, 1.0] }
}

/// An empty scene with camera and lights. The field of view is 45 degrees from the centre of the first row to
/// that of the last; n lights have the intensity `sqrt(n) / (2 n)` each, at any distance.
fn studio(name: &str, view: &Viewpoint, lights: &[[f32; 3]]) -> Studio {
    const SIZE: ImageSize = ImageSize { width: 512, height: 512 };
    let mut studio = Studio::new(name);
    let Viewpoint { from, at, up } = view;
    let camera = Camera::look_at("view", Vec3::from(*from), Vec3::from(*at), Vec3::from(*up), 45.0);
    let rows = f64::from(SIZE.height);
    let tan_half_height = camera.tan_half_height * rows / (rows - 1.0);
    studio.add_camera(Camera { tan_half_height, size: Some(SIZE), ..camera });
    studio.background([0.078, 0.361, 0.753]);
    let share = (lights.len() as f64).sqrt() / (2.0 * lights.len() as f64);
    for (number, &place) in lights.iter().enumerate() {
        studio.lamp(&format!("light-{}", number + 1), place, [share as f32; 3]);
    }
    studio
}

/// What an `f` line of the Neutral File Format says: a colour, its diffuse share, the share of highlight and
/// mirror, and the exponent of the highlight.
fn surface(name: &str, colour: [f32; 3], [diffuse, specular, shininess]: [f32; 3]) -> Material {
    Material {
        name: name.into(),
        diffuse: colour.map(|channel| channel * diffuse),
        specular: [specular; 3],
        shininess,
        mirror: [specular; 3],
        ..Material::default()
    }
}

/// A material that also lets this share of light pass.
fn transparent(material: Material, transmittance: f32, refractive_index: f32) -> Material {
    let transmission = Some(Transmission { transmittance: [transmittance; 3], refractive_index });
    Material { transmission, ..material }
}

/// A polygon of four corners by itself.
fn quadrangle(name: &str, material: u32, corners: [[f32; 3]; 4]) -> ObjectInput {
    let positions = corners.map(Vec3::from).to_vec();
    let input = ObjectInput::new(name, positions, vec![[0, 1, 2], [0, 2, 3]]);
    ObjectInput { material, polygons: Some(1), ..input }
}

/// A level square around the z axis.
fn level_square(name: &str, material: u32, half: f32, height: f32) -> ObjectInput {
    let corners = [[half, half], [-half, half], [-half, -half], [half, -half]];
    quadrangle(name, material, corners.map(|[x, y]| [x, y, height]))
}
