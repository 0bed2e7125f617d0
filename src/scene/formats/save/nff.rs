//! Scenes as NFF.

use super::numbers::{joined, single};
use super::{Complaint, cameras, light, object};
use crate::geometry::curved::Shape;
use crate::scene::formats::limits::{MAX_FILLS, MAX_LIGHTS};
use crate::scene::formats::nff::{BRIGHTEST, share};
use crate::scene::formats::text::printable;
use crate::scene::{Coverage, Emitter, Falloff, Light, Material, Object, PointLight, Scene, Shadowing};
use std::fmt::Write;

/// The file of a scene.
///
/// # Errors
/// The first element that NFF cannot say.
pub(super) fn text(scene: &Scene) -> Result<String, Complaint> {
    let mut text = format!("# {}\n", printable(&scene.name));
    if !scene.background.iter().all(|channel| (0.0..=BRIGHTEST).contains(channel)) {
        return Err(("background".into(), format!("expected a colour from 0 to {BRIGHTEST:e}")));
    }
    let _ = writeln!(text, "b {}", joined(&scene.background, " "));
    for camera in &scene.cameras {
        let lines = cameras::nff(camera);
        text += &lines.map_err(|why| (format!("camera `{}`", printable(&camera.name)), why))?;
    }
    if scene.lights.len() > MAX_LIGHTS {
        return Err((String::new(), format!("expected at most {MAX_LIGHTS} lights")));
    }
    for lamp in &scene.lights {
        text += &light_line(lamp, share(scene.lights.len())).map_err(|why| (light(lamp), why.into()))?;
    }
    if scene.objects.len() > MAX_FILLS {
        return Err((String::new(), format!("expected at most {MAX_FILLS} objects")));
    }
    for one in &scene.objects {
        add_object(scene, one, &mut text).map_err(|why| (object(scene, one), why))?;
    }
    Ok(text)
}

fn light_line(light: &Light, share: f64) -> Result<String, &'static str> {
    let Emitter::Point(PointLight { position, intensity, falloff: Falloff::Constant }) = &light.emitter
    else {
        return Err("NFF has point lights alone, which do not thin out with distance");
    };
    let colour = intensity.map(|intensity| {
        // Of the neighbours of the quotient the one that is read back as the same intensity.
        let near = (f64::from(intensity) / share) as f32;
        let same = |&colour: &f32| (f64::from(colour) * share) as f32 == intensity;
        [near, near.next_up(), near.next_down()].into_iter().find(same).unwrap_or(near)
    });
    if !colour.iter().all(|channel| (0.0..=BRIGHTEST).contains(channel)) {
        return Err("it is too bright for NFF");
    }
    let position = joined(&position.to_array(), " ");
    Ok(match colour == [1.0; 3] {
        true => format!("l {position}\n"),
        false => format!("l {position} {}\n", joined(&colour, " ")),
    })
}

fn add_object(scene: &Scene, object: &Object, text: &mut String) -> Result<(), String> {
    if object.shadowing != Shadowing::default() {
        return Err("in NFF everything casts and receives shadows".into());
    }
    let _ = writeln!(text, "# {}", printable(&object.name));
    let _ = writeln!(text, "{}", fill(&scene.materials[object.material as usize])?);
    for index in 0..object.count {
        let corners = scene.corners(object.first + index);
        let keyword = if object.normals.is_some() { "pp" } else { "p" };
        let _ = writeln!(text, "{keyword} 3");
        for (i, corner) in corners.iter().enumerate() {
            let _ = write!(text, "{}", joined(&corner.to_array(), " "));
            if let Some(normals) = &object.normals {
                let normal = normals.normals[normals.corners[index as usize][i] as usize];
                let _ = write!(text, " {}", joined(&normal.to_array(), " "));
            }
            text.push('\n');
        }
    }
    let curved = object.first_curved as usize..(object.first_curved + object.curved_count) as usize;
    for primitive in &scene.curved[curved] {
        let _ = writeln!(text, "{}", curved_line(&primitive.shape)?);
    }
    Ok(())
}

/// `f r g b Kd Ks shine T ior`
fn fill(material: &Material) -> Result<String, String> {
    let about = |why: &str| Err(format!("its material `{}`: {why}", printable(&material.name)));
    let Material { diffuse, specular, shininess, mirror, .. } = material;
    if material.coverage != Coverage::Solid || material.texture.is_some() {
        return about("NFF has neither holes nor textures");
    }
    let is_share = |colour: &[f32; 3]| colour.iter().all(|channel| (0.0..=1.0).contains(channel));
    if !(is_share(diffuse) && is_share(specular) && *shininess >= 1.0 && shininess.is_finite()) {
        return about("expected colours from 0 to 1 and a shininess of at least 1");
    }
    if mirror != specular || *specular != [specular[0]; 3] {
        return about("NFF has one white share for highlight and mirror");
    }
    let (transmittance, index) = match material.transmission {
        None => (0.0, 0.0),
        Some(passing) if passing.transmittance == [passing.transmittance[0]; 3] => {
            (passing.transmittance[0], passing.refractive_index)
        }
        Some(_) => return about("in NFF as much passes of every colour"),
    };
    let rest = [1.0, specular[0], *shininess, transmittance, index];
    Ok(format!("f {} {}", joined(diffuse, " "), joined(&rest, " ")))
}

fn curved_line(shape: &Shape) -> Result<String, String> {
    match shape {
        Shape::Sphere(sphere) => {
            Ok(format!("s {} {}", joined(&sphere.centre.to_array(), " "), single(sphere.radius)))
        }
        Shape::Cone(cone) => {
            let end = |point: glam::Vec3, radius: f32| {
                format!("{} {}", joined(&point.to_array(), " "), single(radius))
            };
            Ok(format!("c {} {}", end(cone.base, cone.base_radius), end(cone.apex, cone.apex_radius)))
        }
        other => Err(format!("NFF has no {}", other.kind())),
    }
}
