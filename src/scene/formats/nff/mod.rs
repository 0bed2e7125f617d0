//! NFF, the Neutral File Format of the Standard Procedural Databases.
//!
//! An entity is a word at the beginning of a line and its numbers, which may go on in further lines; `#`
//! begins a remark, and blank lines mean nothing. Coordinates are right-handed and taken as they are.
//!
//! - **`v`** becomes a camera that brings its own image size. `hither` has no effect: surfaces nearer to the
//!   eye are seen as well. Where width and height differ, `angle` is the vertical field, for pixels are
//!   square.
//! - **`b`** is the scene's background, which rays that leave the scene see, the last one if there are
//!   several. Where a camera sees nothing, images are 0 with an alpha of 0.
//! - **`l`** becomes a point light that does not thin out with distance. Of n lights each has the usual
//!   intensity `sqrt(n) / (2 n)` in NFF's units, where a surface that faces it has the radiance colour x Kd x
//!   intensity. Shading divides irradiance by pi, so that is `pi sqrt(n) / (2 n)`, times the light's colour.
//! - **`f`** becomes a material: diffuse colour x Kd; Ks, white, as the weight of a highlight with the exponent
//!   `shine` of at least 1 and as what a mirror reflects; `T`, for all colours alike, as what passes through,
//!   bent by the index of refraction `ior`, which must be above 0 if T is and means nothing otherwise. Kd and
//!   Ks that are no shares are cut to 0 and 1, a T that is none is an error.
//! - **`p` and `pp`** are cut into triangles, see [`polygon`](super::polygon). All that share an `f` line are
//!   one object, `fill-3` after the third: the file does not say which primitives belong to one thing. So two
//!   solids under one `f` are not recognised as convex, which costs speed and no answers. The file's
//!   sidedness decides what a camera sees of a surface, and is ignored: both sides of everything are drawn.
//! - **`s` and `c`** become spheres and the walls of cylinders and cones, without caps. Negative radii ask for
//!   the inside to be seen in place of the outside; since both are, the sign goes. A cone of one radius above
//!   and one below 0 is an error. What has no area is dropped and counted.

mod curved;
mod fills;
mod viewpoint;
mod words;

use self::fills::{Corners, Fills};
use self::viewpoint::Viewpoint;
use self::words::{Complaint, Words, shown};
use super::limits::MAX_LIGHTS;
use super::text::counted;
use super::{confined, scene_name};
use crate::error::{Error, Place, Result};
use crate::scene::{Camera, Falloff, Light, PointLight, Scene, SceneBuilder};
use glam::Vec3;
use std::path::Path;

/// Reads an NFF file.
///
/// # Errors
/// One line with file and line for whatever cannot be read.
pub(super) fn load(path: &Path) -> Result<Scene> {
    let text = confined::read_scene(path)?;
    let mut builder = SceneBuilder::new(scene_name(path));
    read(&text, &mut builder).map_err(|(line, why)| Error::input(path, Place::Line(line), why))?;
    Ok(builder.finish())
}

fn read(text: &[u8], builder: &mut SceneBuilder) -> std::result::Result<(), Complaint> {
    let mut words = Words::new(text);
    let mut fills = Fills::default();
    let mut lamps = Vec::new();
    let (mut cameras, mut oblong) = (0, 0);
    while let Some(keyword) = words.entity()? {
        match keyword {
            b"v" => {
                let Viewpoint { camera, oblong: is_oblong } = viewpoint::read(&mut words)?;
                cameras += 1;
                oblong += usize::from(is_oblong);
                let name =
                    if cameras == 1 { camera.name.clone() } else { format!("{}-{cameras}", camera.name) };
                builder.add_camera(Camera { name, ..camera });
            }
            b"b" => {
                let colour = words.finite()?;
                check_colour(&colour).map_err(|why| (words.line(), why))?;
                builder.set_background(colour);
            }
            b"l" => {
                lamps.push(Lamp::read(&mut words)?);
                if lamps.len() > MAX_LIGHTS {
                    return Err((words.line(), format!("expected at most {MAX_LIGHTS} lights")));
                }
            }
            b"f" => fills.begin(&mut words, builder)?,
            b"p" => fills.polygon(Corners::Flat, &mut words, builder)?,
            b"pp" => fills.polygon(Corners::Smooth, &mut words, builder)?,
            b"s" => {
                let sphere = curved::sphere(&mut words)?;
                fills.curved(sphere, &words, builder)?;
            }
            b"c" => {
                let cone = curved::cone(&mut words)?;
                fills.curved(cone, &words, builder)?;
            }
            other => {
                let why = format!("expected one of v, b, l, f, p, pp, s and c, found `{}`", shown(other));
                return Err((words.line(), why));
            }
        }
    }
    fills.finish_object(builder).map_err(|why| (words.line(), why))?;
    let share = share(lamps.len());
    for (index, lamp) in lamps.iter().enumerate() {
        builder.add_light(lamp.light(index, share));
    }
    fills.warn(builder);
    if oblong > 0 {
        let count = counted(oblong, "viewpoint");
        builder.warn(format!("pixels are square, so that `angle` is the vertical field alone ({count})"));
    }
    Ok(())
}

/// The intensity of each of so many lights, where its colour is 1.
pub(super) fn share(lights: usize) -> f64 {
    std::f64::consts::PI * (lights as f64).sqrt() / (2.0 * lights as f64)
}

/// The most that a channel of a light's colour may be, so that all that is computed from it is finite.
pub(super) const BRIGHTEST: f32 = 1e30;

/// Whether all channels are in range.
fn check_colour(channels: &[f32]) -> std::result::Result<(), String> {
    match channels.iter().find(|channel| !(0.0..=BRIGHTEST).contains(*channel)) {
        Some(channel) => Err(format!("expected a colour from 0 to {BRIGHTEST:e}, found {channel}")),
        None => Ok(()),
    }
}

/// An `l` line.
struct Lamp {
    position: Vec3,
    colour: [f32; 3],
}

impl Lamp {
    /// Reads what follows `l`: three coordinates, and perhaps a colour in the same line.
    fn read(words: &mut Words) -> std::result::Result<Lamp, Complaint> {
        let position = words.finite()?.into();
        let mut given = Vec::new();
        while given.len() < 3
            && let Some(word) = words.rest_of_line()
        {
            given.push(words::parse(word, "a number").map_err(|why| (words.line(), why))?);
            check_colour(&given).map_err(|why| (words.line(), why))?;
        }
        let colour = match given[..] {
            [] => [1.0; 3],
            [r, g, b] => [r, g, b],
            _ => {
                let why =
                    format!("expected three numbers or none as a light's colour, found {}", given.len());
                return Err((words.line(), why));
            }
        };
        Ok(Lamp { position, colour })
    }

    fn light(&self, index: usize, share: f64) -> Light {
        let intensity = self.colour.map(|channel| (f64::from(channel) * share) as f32);
        let point = PointLight { position: self.position, intensity, falloff: Falloff::Constant };
        Light::point(format!("light-{}", index + 1), point)
    }
}
