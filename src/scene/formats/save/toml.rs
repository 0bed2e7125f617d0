//! Scenes as TOML.

use super::numbers::{colour, double, single, vector};
use super::textures::Files;
use super::{Complaint, cameras, light, object};
use crate::geometry::curved::Shape;
use crate::scene::builder::Names;
use crate::scene::formats::limits::{MAX_CAMERAS, MAX_LIGHTS, MAX_OBJECTS, MAX_TOML_BYTES};
use crate::scene::formats::text::printable;
use crate::scene::formats::toml::{BRIGHTEST, cosine_of_degrees};
use crate::scene::{Cone, Coverage, Emitter, Falloff, Light, Mapping, Material, Object, Pattern, PointLight};
use crate::scene::{Scene, Shadowing, Texture, Wrap};
use std::collections::HashMap;
use std::fmt::Write;

/// The file of a scene.
///
/// # Errors
/// The first element that TOML scenes cannot say, and a text that would be too long to be read.
pub(super) fn text(scene: &Scene, pictures: &Files) -> Result<String, Complaint> {
    let mut writer = Writer { scene, pictures, text: String::new(), materials: Vec::new() };
    let _ = writeln!(writer.text, "version = 1\nname = {}", quoted(&scene.name));
    if scene.background != [0.0; 3] {
        let background = strength(scene.background).map_err(|why| ("background".into(), why))?;
        let _ = writeln!(writer.text, "background = {background}");
    }
    writer.add_materials()?;
    for (count, most, what) in [
        (scene.objects.len() as u64, MAX_OBJECTS, "objects"),
        (scene.lights.len() as u64, MAX_LIGHTS as u64, "lights"),
        (scene.cameras.len() as u64, MAX_CAMERAS, "cameras"),
    ] {
        if count > most {
            return Err((String::new(), format!("{count} {what}, expected at most {most}")));
        }
    }
    let mut keys = Names::default();
    for one in &scene.objects {
        writer.add_object(one, &mut keys).map_err(|why| (object(scene, one), why))?;
    }
    for one in &scene.lights {
        let keys = light_keys(one).map_err(|why| (light(one), why))?;
        let _ = write!(writer.text, "\n[[light]]\nname = {}\n{keys}", quoted(&one.name));
    }
    for camera in &scene.cameras {
        let keys = cameras::toml(camera);
        let keys = keys.map_err(|why| (format!("camera `{}`", printable(&camera.name)), why))?;
        let _ = write!(writer.text, "\n[[camera]]\nname = {}\n{keys}", quoted(&camera.name));
    }
    match writer.text.len() as u64 {
        bytes if bytes > MAX_TOML_BYTES => {
            Err((String::new(), format!("{bytes} bytes of TOML, expected at most {MAX_TOML_BYTES}")))
        }
        _ => Ok(writer.text),
    }
}

/// Text in quotation marks.
fn quoted(text: &str) -> String {
    ::toml::Value::from(text).to_string()
}

struct Writer<'a> {
    scene: &'a Scene,
    pictures: &'a Files<'a>,
    text: String,
    /// What each material is called, `None` if it need not be said.
    materials: Vec<Option<String>>,
}

impl Writer<'_> {
    fn add_materials(&mut self) -> Result<(), Complaint> {
        let mut keys = Names::default();
        for (index, material) in self.scene.materials.iter().enumerate() {
            if index == 0 && *material == Material::default() {
                self.materials.push(None);
                continue;
            }
            let complaint = |why: String| (format!("material `{}`", printable(&material.name)), why);
            let name = keys.take(printable(&material.name));
            let lines = self.material_keys(material).map_err(complaint)?;
            let _ = write!(self.text, "\n[[material]]\nname = {}\n{lines}", quoted(&name));
            self.materials.push(Some(name));
        }
        Ok(())
    }

    fn material_keys(&self, material: &Material) -> Result<String, String> {
        let Material { diffuse, specular, shininess, mirror, transmission, .. } = *material;
        if material.coverage != Coverage::Solid {
            return Err("TOML scenes have no alpha masks".into());
        }
        if !(shininess >= 1.0 && shininess.is_finite()) {
            return Err(format!("expected a shininess of at least 1, found {shininess}"));
        }
        let mut text = format!("diffuse = {}\n", share(diffuse)?);
        for (key, colour) in [("specular", specular), ("mirror", mirror)] {
            if colour != [0.0; 3] {
                let _ = writeln!(text, "{key} = {}", share(colour)?);
            }
        }
        if shininess != 1.0 {
            let _ = writeln!(text, "shininess = {}", single(shininess));
        }
        if let Some(passing) = transmission {
            let index = passing.refractive_index;
            if !(index > 0.0 && index.is_finite()) {
                return Err(format!("expected a refractive index above 0, found {index}"));
            }
            let _ = writeln!(text, "transmittance = {}", share(passing.transmittance)?);
            let _ = writeln!(text, "refractive_index = {}", single(index));
        }
        if let Some(texture) = material.texture {
            let _ =
                writeln!(text, "texture = {{ {} }}", self.texture(&self.scene.textures[texture as usize])?);
        }
        Ok(text)
    }

    fn texture(&self, texture: &Texture) -> Result<String, String> {
        let pattern = match &texture.pattern {
            Pattern::Checker { other } => format!("checker = {}", share(*other)?),
            Pattern::Image { image, wrap } => {
                let [across, down] = wrap.map(|wrap| match wrap {
                    Wrap::Repeat => "repeat",
                    Wrap::MirroredRepeat => "mirror",
                    Wrap::ClampToEdge => "clamp",
                });
                let name = quoted(&self.pictures.name(image));
                format!("image = {name}, wrap_u = \"{across}\", wrap_v = \"{down}\"")
            }
        };
        let mapping = match texture.mapping {
            Mapping::Solid { origin, size } => {
                format!("origin = {}, size = {}", vector(origin), single(size))
            }
            Mapping::Planar { origin, u, v } => {
                format!("origin = {}, u = {}, v = {}", vector(origin), vector(u), vector(v))
            }
            Mapping::Coordinates => "coordinates = true".into(),
        };
        Ok(format!("{pattern}, {mapping}"))
    }

    /// An object as its parts: a mesh of all its triangles, then its curved surfaces.
    fn add_object(&mut self, object: &Object, keys: &mut Names) -> Result<(), String> {
        let material = &self.scene.materials[object.material as usize];
        let texture = material.texture.map(|texture| self.scene.textures[texture as usize].mapping);
        let lies_nowhere = object.texture_coordinates.is_none() || object.curved_count > 0;
        if texture == Some(Mapping::Coordinates) && lies_nowhere {
            return Err("not all of it has texture coordinates for its texture".into());
        }
        // What is nothing but the number of polygons that were dropped is a mesh as well.
        let has_mesh = object.count > 0 || object.polygons > 0 || object.curved_count == 0;
        let is_alone = u32::from(has_mesh) + object.curved_count == 1;
        let (mut about, mut later) = (String::new(), String::new());
        let name = quoted(&object.name);
        if is_alone {
            let _ = writeln!(about, "name = {name}");
        } else {
            let key = quoted(&keys.take(object.name.clone()));
            let _ = writeln!(about, "object = {key}");
            later.clone_from(&about);
            if key != name {
                let _ = writeln!(about, "name = {name}");
            }
        }
        if let Some(material) = &self.materials[object.material as usize] {
            let _ = writeln!(about, "material = {}", quoted(material));
        }
        let Shadowing { casts, receives } = object.shadowing;
        for (key, is_so) in [("cast_shadows", casts), ("receive_shadows", receives)] {
            if !is_so {
                let _ = writeln!(about, "{key} = false");
            }
        }
        if has_mesh {
            let mesh = mesh(self.scene, object)?;
            let _ = write!(self.text, "\n[[mesh]]\n{about}{mesh}");
            about.clone_from(&later);
        }
        let curved = object.first_curved as usize..(object.first_curved + object.curved_count) as usize;
        for primitive in &self.scene.curved[curved] {
            let shape = &primitive.shape;
            let _ = write!(self.text, "\n[[{}]]\n{about}{}", shape.kind(), shape_keys(shape));
            about.clone_from(&later);
        }
        Ok(())
    }
}

/// Colours that are shares.
fn share(channels: [f32; 3]) -> Result<String, String> {
    match channels.iter().find(|channel| !(0.0..=1.0).contains(*channel)) {
        Some(channel) => Err(format!("expected a colour from 0 to 1, found {channel}")),
        None => Ok(colour(channels)),
    }
}

/// Colours of light.
fn strength(channels: [f32; 3]) -> Result<String, String> {
    match channels.iter().find(|channel| !(0.0..=BRIGHTEST).contains(&f64::from(**channel))) {
        Some(channel) => Err(format!("expected a colour from 0 to {BRIGHTEST:e}, found {channel:e}")),
        None => Ok(colour(channels)),
    }
}

/// How many list elements stand in a line.
const IN_A_LINE: usize = 8;

fn list(key: &str, elements: &[String]) -> String {
    let lines: Vec<String> = elements.chunks(IN_A_LINE).map(|chunk| chunk.join(", ")).collect();
    match &lines[..] {
        [] => format!("{key} = []\n"),
        [line] => format!("{key} = [{line}]\n"),
        lines => format!("{key} = [\n{},\n]\n", lines.join(",\n")),
    }
}

fn mesh(scene: &Scene, object: &Object) -> Result<String, String> {
    let range = object.first as usize..(object.first + object.count) as usize;
    let (mut numbers, mut corners) = (HashMap::new(), Vec::new());
    let mut faces = Vec::with_capacity(range.len());
    for (index, triangle) in scene.triangles[range].iter().enumerate() {
        let face: [String; 3] = std::array::from_fn(|i| {
            let normal = object.normals.as_ref().map(|given| given.corners[index][i]);
            let place = object.texture_coordinates.as_ref().map(|given| given.corners[index][i]);
            let corner = (triangle.vertices[i], normal, place);
            let number = *numbers.entry(corner).or_insert_with(|| {
                corners.push(corner);
                corners.len() - 1
            });
            number.to_string()
        });
        faces.push(format!("[{}]", face.join(", ")));
    }
    let vertices: Vec<String> =
        corners.iter().map(|&(vertex, ..)| vector(scene.vertices[vertex as usize])).collect();
    let mut text = list("vertices", &vertices) + &list("faces", &faces);
    if let Some(given) = &object.normals {
        let normals: Vec<_> =
            corners.iter().map(|corner| given.normals[corner.1.unwrap_or_default() as usize]).collect();
        if !normals.iter().all(|normal| normal.is_finite() && *normal != glam::Vec3::ZERO) {
            return Err("a normal that is no direction".into());
        }
        text += &list("normals", &normals.into_iter().map(vector).collect::<Vec<_>>());
    }
    if let Some(given) = &object.texture_coordinates {
        let place = |&(.., place): &(u32, Option<u32>, Option<u32>)| {
            super::numbers::array(&given.coordinates[place.unwrap_or_default() as usize])
        };
        text += &list("texture_coordinates", &corners.iter().map(place).collect::<Vec<_>>());
    }
    if object.polygons != object.count {
        let _ = writeln!(text, "polygons = {}", object.polygons);
    }
    Ok(text)
}

fn shape_keys(shape: &Shape) -> String {
    match shape {
        Shape::Sphere(s) => format!("centre = {}\nradius = {}\n", vector(s.centre), single(s.radius)),
        Shape::Ellipsoid(e) => {
            format!("centre = {}\naxes = [{}]\n", vector(e.centre), e.axes.map(vector).join(", "))
        }
        Shape::Cone(c) if shape.kind() == "cylinder" => {
            format!(
                "base = {}\napex = {}\nradius = {}\n",
                vector(c.base),
                vector(c.apex),
                single(c.base_radius)
            )
        }
        Shape::Cone(c) => format!(
            "base = {}\nbase_radius = {}\napex = {}\napex_radius = {}\n",
            vector(c.base),
            single(c.base_radius),
            vector(c.apex),
            single(c.apex_radius)
        ),
        Shape::Disc(d) => format!(
            "centre = {}\nnormal = {}\nradius = {}\n",
            vector(d.centre),
            vector(d.normal),
            single(d.radius)
        ),
        Shape::Plane(p) => format!("point = {}\nnormal = {}\n", vector(p.point), vector(p.normal)),
        Shape::Quadric(q) => {
            let [xx, yy, zz, xy, yz, zx] = q.second;
            let three = |numbers: [f32; 3]| super::numbers::array(&numbers);
            format!(
                "centre = {}\nsquares = {}\nmixed = {}\nlinear = {}\nconstant = {}\nlow = {}\nhigh = {}\n",
                vector(q.reference),
                three([xx, yy, zz]),
                three([xy, yz, zx]),
                vector(q.first),
                single(q.constant),
                vector(q.low),
                vector(q.high)
            )
        }
    }
}

fn light_keys(light: &Light) -> Result<String, String> {
    let place = |point: &PointLight| {
        let falloff = match point.falloff {
            Falloff::InverseSquare => String::new(),
            Falloff::Range(range) => format!("range = {}\n", single(range)),
            Falloff::Constant => "falloff = \"none\"\n".into(),
        };
        let strength = strength(point.intensity)?;
        Ok::<_, String>(format!("position = {}\nintensity = {strength}\n{falloff}", vector(point.position)))
    };
    Ok(match &light.emitter {
        Emitter::Point(point) => format!("type = \"point\"\n{}", place(point)?),
        Emitter::Spot(spot) => {
            let [inner, outer] = degrees(&spot.cone).ok_or("its cone cannot be said in degrees")?;
            format!(
                "type = \"spot\"\n{}direction = {}\ninner_degrees = {}\nouter_degrees = {}\n",
                place(&spot.point)?,
                vector(spot.cone.axis),
                double(inner),
                double(outer)
            )
        }
        Emitter::Directional(sun) => format!(
            "type = \"directional\"\ntowards = {}\nirradiance = {}\n",
            vector(sun.towards),
            strength(sun.irradiance)?
        ),
    })
}

/// The inner and the outer angle whose cosines are those of a cone, bit by bit.
fn degrees(cone: &Cone) -> Option<[f64; 2]> {
    let angle = |cosine: f32| libm::acos(f64::from(cosine)).to_degrees();
    let outer = angle(cone.cos_outer);
    // Where both angles are one, the inner cosine is the next above.
    [outer, angle(cone.cos_inner)].into_iter().filter(|inner| *inner <= outer).find_map(|inner| {
        let made = Cone::new(cone.axis, cosine_of_degrees(inner), cosine_of_degrees(outer));
        (made == *cone && outer > 0.0).then_some([inner, outer])
    })
}
