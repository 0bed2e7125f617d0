//! From what loaders read to a checked [`Scene`].

use super::{AlphaMask, Camera, Coverage, Light, Material, Object, Scene, Shadowing};
use super::{CurvedPrimitive, Mapping, Texture, TextureCoordinates, Triangle};
use crate::error::{Error, Result};
use crate::float_environment::StandardFloats;
use crate::geometry::curved::Shape;
use glam::Vec3;
use std::collections::HashMap;

/// Primitives that a scene leaves out because they can neither be seen nor block.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Triangles of zero area, decided exactly.
    pub degenerate: usize,
    /// Triangles with a NaN or infinite coordinate.
    pub non_finite: usize,
    /// Curved surfaces without area, or with a number that is outside its range, NaN or infinite.
    pub curved: usize,
}

/// Shading normals of one object.
#[derive(Debug, Clone)]
pub struct SmoothNormals {
    /// Normals in world space, not necessarily of unit length.
    pub normals: Vec<Vec3>,
    /// Three indices into `normals` for each triangle of the object.
    pub corners: Vec<[u32; 3]>,
}

/// One object as a loader delivers it; indices count from 0 within the object.
#[derive(Debug, Clone)]
pub struct ObjectInput {
    /// The object's name.
    pub name: String,
    /// What [`SceneBuilder::add_material`] returned.
    pub material: u32,
    /// World-space positions.
    pub positions: Vec<Vec3>,
    /// Three indices into `positions` each.
    pub triangles: Vec<[u32; 3]>,
    /// Polygons that the triangles were cut from, if they were.
    pub polygons: Option<u32>,
    /// Curved surfaces, in world space.
    pub curved: Vec<Shape>,
    /// Shading normals, if the file has them.
    pub normals: Option<SmoothNormals>,
    /// Where the corners lie in the material's alpha mask or texture; must be there if it has a mask.
    pub texture_coordinates: Option<TextureCoordinates>,
    /// Its part in shadows.
    pub shadowing: Shadowing,
}

impl ObjectInput {
    /// Triangles of the default material, without shading normals and texture coordinates, that cast and
    /// receive shadows.
    pub fn new(name: impl Into<String>, positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> ObjectInput {
        ObjectInput {
            name: name.into(),
            material: 0,
            positions,
            triangles,
            polygons: None,
            curved: Vec::new(),
            normals: None,
            texture_coordinates: None,
            shadowing: Shadowing::default(),
        }
    }
}

/// Collects objects, materials, lights and cameras, and checks them.
pub struct SceneBuilder {
    scene: Scene,
    light_names: Names,
    camera_names: Names,
    /// What was dropped in scenes that were put into this one; they have said so themselves.
    already_said: Dropped,
}

/// Names that are taken, each with the number that its next namesake tries first.
#[derive(Default)]
pub(super) struct Names(HashMap<String, u32>);

impl Names {
    fn of<'a>(taken: impl Iterator<Item = &'a String>) -> Names {
        Names(taken.map(|name| (name.clone(), 2)).collect())
    }

    /// The name, with a number if it is taken.
    pub(super) fn take(&mut self, wanted: String) -> String {
        let mut name = wanted.clone();
        if let Some(&first) = self.0.get(&wanted) {
            let mut number = first;
            while self.0.contains_key(&name) {
                name = format!("{wanted}-{number}");
                number += 1;
            }
            self.0.insert(wanted, number);
        }
        self.0.insert(name.clone(), 2);
        name
    }
}

impl SceneBuilder {
    /// The most vertices or triangles a scene may have: indices are 32 bits, and `object_id` channels hold
    /// them in floats only as far as 2^24 objects go; triangles may be more.
    pub const MAX_ELEMENTS: usize = 1 << 28;

    /// An empty scene with one default material (index 0).
    pub fn new(name: impl Into<String>) -> SceneBuilder {
        SceneBuilder::extend(Scene::empty(name))
    }

    /// Continues a scene that is already there.
    pub fn extend(scene: Scene) -> SceneBuilder {
        let light_names = Names::of(scene.lights.iter().map(|light| &light.name));
        let camera_names = Names::of(scene.cameras.iter().map(|camera| &camera.name));
        SceneBuilder { scene, light_names, camera_names, already_said: Dropped::default() }
    }

    /// Adds a material and returns its index. Shares of minus zero become zero, which is what they mean.
    pub fn add_material(&mut self, mut material: Material) -> u32 {
        let transmittance =
            material.transmission.as_mut().map(|transmission| &mut transmission.transmittance);
        let shares = [&mut material.diffuse, &mut material.specular, &mut material.mirror].into_iter();
        // Minus zero and zero are zero.
        shares.chain(transmittance).flatten().for_each(|share| *share += 0.0);
        self.scene.materials.push(material);
        self.scene.materials.len() as u32 - 1
    }

    /// Adds a material that has already been added once more, with the holes of an alpha mask.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no such material.
    pub(super) fn add_material_with_holes(&mut self, material: u32, mask: u32) -> Result<u32> {
        let found = self.scene.materials.get(material as usize);
        let found = found.ok_or_else(|| Error::Usage(format!("no material {material}")))?;
        let coverage = Coverage::Masked(mask);
        let painted = Material { coverage, ..found.clone() };
        Ok(self.add_material(painted))
    }

    /// Counts what a scene that is put into this one has dropped, and has said among its warnings.
    pub(super) fn count_dropped(&mut self, dropped: Dropped) {
        for total in [&mut self.scene.dropped, &mut self.already_said] {
            total.degenerate = total.degenerate.saturating_add(dropped.degenerate);
            total.non_finite = total.non_finite.saturating_add(dropped.non_finite);
            total.curved = total.curved.saturating_add(dropped.curved);
        }
    }

    /// Adds an alpha mask and returns its index, for [`Coverage::Masked`].
    pub fn add_alpha_mask(&mut self, mask: AlphaMask) -> u32 {
        self.scene.alpha_masks.push(mask);
        self.scene.alpha_masks.len() as u32 - 1
    }

    /// Adds a texture and returns its index, for [`Material::texture`].
    ///
    /// # Errors
    /// [`Error::Usage`] if it has a [defect](Texture::defect).
    pub fn add_texture(&mut self, texture: Texture) -> Result<u32> {
        if let Some(why) = texture.defect() {
            return Err(Error::Usage(format!("texture {}: {why}", self.scene.textures.len())));
        }
        self.scene.textures.push(texture);
        Ok(self.scene.textures.len() as u32 - 1)
    }

    /// Adds textures that are without defects already, and returns the index of the first.
    pub(super) fn adopt_textures(&mut self, textures: &[Texture]) -> u32 {
        let first = self.scene.textures.len() as u32;
        self.scene.textures.extend_from_slice(textures);
        first
    }

    /// Adds a light; a name that is taken gets a number.
    pub fn add_light(&mut self, light: Light) {
        let name = self.light_names.take(light.name);
        self.scene.lights.push(Light { name, ..light });
    }

    /// Adds a camera; a name that is taken gets a number.
    pub fn add_camera(&mut self, camera: Camera) {
        let name = self.camera_names.take(camera.name);
        self.scene.cameras.push(Camera { name, ..camera });
    }

    /// Notes something that the file asks for and that is not drawn; the same line is kept once.
    pub fn warn(&mut self, warning: impl Into<String>) {
        let warning = warning.into();
        if !self.scene.warnings.contains(&warning) {
            self.scene.warnings.push(warning);
        }
    }

    /// Triangles so far; loaders check it before they expand instances.
    pub fn triangle_count(&self) -> usize {
        self.scene.triangles.len()
    }

    /// Vertices so far.
    pub fn vertex_count(&self) -> usize {
        self.scene.vertices.len()
    }

    /// Curved surfaces so far.
    pub fn curved_count(&self) -> usize {
        self.scene.curved.len()
    }

    /// Says what rays that leave the scene see: linear Rec. 709, from 0.
    pub fn set_background(&mut self, colour: [f32; 3]) {
        self.scene.background = colour;
    }

    /// Adds an object. Triangles with non-finite corners or of zero area are dropped and counted, and curved
    /// surfaces with a defect.
    ///
    /// # Errors
    /// [`Error::Usage`] if an index is out of range, the material has an alpha mask and the object no texture
    /// coordinates for it, one of those that it needs is not finite, or the scene grows past 2^28 elements.
    pub fn add_object(&mut self, input: ObjectInput) -> Result<()> {
        let _floats = StandardFloats::new();
        let scene = &mut self.scene;
        let total = |have: usize, more: usize| have.saturating_add(more) > Self::MAX_ELEMENTS;
        if total(scene.vertices.len(), input.positions.len())
            || total(scene.triangles.len() + scene.curved.len(), input.triangles.len() + input.curved.len())
        {
            return Err(Error::Usage(format!("more than {} vertices or primitives", Self::MAX_ELEMENTS)));
        }
        let Some(material) = scene.materials.get(input.material as usize) else {
            return Err(Error::Usage(format!("object {}: no material {}", input.name, input.material)));
        };
        let keeps_coordinates = needs_coordinates(&input, material, scene)?;
        check_indices(&input)?;
        let base = scene.vertices.len() as u32;
        let object = scene.objects.len() as u32;
        let first = scene.triangles.len() as u32;
        let (mut normal_corners, mut texture_corners) = (Vec::new(), Vec::new());
        let texture_coordinates = input.texture_coordinates.filter(|_| keeps_coordinates);
        for (index, triangle) in input.triangles.iter().enumerate() {
            let points = triangle.map(|v| input.positions[v as usize]);
            if !points.iter().all(|p| p.is_finite()) {
                scene.dropped.non_finite += 1;
            } else if is_degenerate(points) {
                scene.dropped.degenerate += 1;
            } else {
                scene.triangles.push(Triangle { vertices: triangle.map(|v| base + v), object });
                if let Some(normals) = &input.normals {
                    normal_corners.push(normals.corners[index]);
                }
                if let Some(coordinates) = &texture_coordinates {
                    texture_corners.push(coordinates.corners[index]);
                }
            }
        }
        // Vertices that no kept triangle uses may be anything; a finite stand-in keeps later code simple.
        scene.vertices.extend(input.positions.iter().map(|&p| if p.is_finite() { p } else { Vec3::ZERO }));
        let first_curved = scene.curved.len() as u32;
        let sound = |shape: &Shape| shape.defect().is_none();
        let curved = input.curved.iter().filter(|shape| sound(shape));
        scene.curved.extend(curved.map(|&shape| CurvedPrimitive { shape, object }));
        let curved_count = scene.curved.len() as u32 - first_curved;
        scene.dropped.curved += input.curved.len() - curved_count as usize;
        let count = scene.triangles.len() as u32 - first;
        scene.objects.push(Object {
            name: input.name,
            material: input.material,
            first,
            count,
            first_curved,
            curved_count,
            polygons: input.polygons.unwrap_or(count),
            normals: input.normals.map(|n| SmoothNormals { corners: normal_corners, ..n }),
            texture_coordinates: texture_coordinates
                .map(|t| TextureCoordinates { corners: texture_corners, ..t }),
            shadowing: input.shadowing,
        });
        Ok(())
    }

    /// Adds an object of a scene bit by bit. The builder must have the scene's materials, alpha masks and textures under the
    /// same numbers.
    pub(super) fn take_over(&mut self, from: &Scene, object: &Object) {
        let scene = &mut self.scene;
        let triangles = &from.triangles[object.first as usize..(object.first + object.count) as usize];
        let corners = || triangles.iter().flat_map(|triangle| triangle.vertices);
        let number = scene.objects.len() as u32;
        let (first, first_curved) = (scene.triangles.len() as u32, scene.curved.len() as u32);
        if let (Some(low), Some(high)) = (corners().min(), corners().max()) {
            let base = scene.vertices.len() as u32;
            scene.vertices.extend_from_slice(&from.vertices[low as usize..=high as usize]);
            let moved = triangles.iter().map(|triangle| Triangle {
                vertices: triangle.vertices.map(|vertex| vertex - low + base),
                object: number,
            });
            scene.triangles.extend(moved);
        }
        let curved = object.first_curved as usize..(object.first_curved + object.curved_count) as usize;
        let curved = from.curved[curved].iter();
        scene.curved.extend(curved.map(|primitive| CurvedPrimitive { object: number, ..*primitive }));
        scene.objects.push(Object { first, first_curved, ..object.clone() });
    }

    /// How many objects there are so far.
    pub(super) fn object_count(&self) -> usize {
        self.scene.objects.len()
    }

    /// How many lights there are so far.
    pub(super) fn light_count(&self) -> usize {
        self.scene.lights.len()
    }

    /// How many cameras there are so far.
    pub(super) fn camera_count(&self) -> usize {
        self.scene.cameras.len()
    }

    /// The scene as it stands.
    pub fn into_scene(self) -> Scene {
        self.scene
    }

    /// The finished scene. What was dropped is said among its warnings.
    pub fn finish(mut self) -> Scene {
        let degenerate = self.scene.dropped.degenerate - self.already_said.degenerate;
        let non_finite = self.scene.dropped.non_finite - self.already_said.non_finite;
        let curved = self.scene.dropped.curved - self.already_said.curved;
        if degenerate > 0 {
            self.warn(format!("dropped {degenerate} triangles of zero area"));
        }
        if non_finite > 0 {
            self.warn(format!("dropped {non_finite} triangles with NaN or infinite coordinates"));
        }
        if curved > 0 {
            self.warn(format!("dropped {curved} curved surfaces without area or with numbers out of range"));
        }
        self.scene
    }
}

/// Whether a material looks at an object's texture coordinates, which then are what they must be.
fn needs_coordinates(input: &ObjectInput, material: &Material, scene: &Scene) -> Result<bool> {
    let wrong = |what: String| Err(Error::Usage(format!("object {}: {what}", input.name)));
    let mut needed = false;
    if let Some(texture) = material.texture {
        let Some(texture) = scene.textures.get(texture as usize) else {
            return wrong(format!("no texture {texture}"));
        };
        needed = texture.mapping == Mapping::Coordinates;
    }
    if let Coverage::Masked(mask) = material.coverage {
        if mask as usize >= scene.alpha_masks.len() {
            return wrong(format!("no alpha mask {mask}"));
        }
        if input.texture_coordinates.is_none() {
            return wrong("no texture coordinates for its alpha mask".into());
        }
        needed = true;
    }
    let given = input.texture_coordinates.iter().filter(|_| needed);
    let mut numbers = given.flat_map(|given| given.coordinates.iter().flatten());
    match numbers.all(|coordinate| coordinate.is_finite()) {
        true => Ok(needed),
        false => wrong("texture coordinates that are not finite".into()),
    }
}

fn check_indices(input: &ObjectInput) -> Result<()> {
    let out_of_range = |what: &str, index: u32, count: usize| {
        Error::Usage(format!("object {}: {what} {index} of {count}", input.name))
    };
    for &index in input.triangles.iter().flatten() {
        if index as usize >= input.positions.len() {
            return Err(out_of_range("vertex", index, input.positions.len()));
        }
    }
    let normals = input.normals.as_ref().map(|n| ("normal", &n.corners, n.normals.len()));
    let coordinates = input.texture_coordinates.as_ref();
    let coordinates = coordinates.map(|t| ("texture coordinate", &t.corners, t.coordinates.len()));
    for (what, corners, count) in normals.into_iter().chain(coordinates) {
        if corners.len() != input.triangles.len() {
            return Err(Error::Usage(format!("object {}: {what}s for other triangles", input.name)));
        }
        for &index in corners.iter().flatten() {
            if index as usize >= count {
                return Err(out_of_range(what, index, count));
            }
        }
    }
    Ok(())
}

/// Whether three finite points lie on one line, exactly: all three axis projections have zero area.
fn is_degenerate(points: [Vec3; 3]) -> bool {
    let flat = |u: fn(Vec3) -> f32, v: fn(Vec3) -> f32| {
        let [a, b, c] = points.map(|p| robust::Coord { x: f64::from(u(p)), y: f64::from(v(p)) });
        robust::orient2d(a, b, c) == 0.0
    };
    flat(|p| p.x, |p| p.y) && flat(|p| p.y, |p| p.z) && flat(|p| p.z, |p| p.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Falloff, PointLight, Wrap};

    fn object(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> ObjectInput {
        ObjectInput::new("test", positions.iter().map(|&p| Vec3::from(p)).collect(), triangles.to_vec())
    }

    #[test]
    fn bad_triangles_are_dropped_and_counted_and_the_rest_is_unchanged() {
        let mut builder = SceneBuilder::new("test");
        let positions =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [f32::NAN, 0.0, 0.0]];
        builder.add_object(object(&positions, &[[0, 1, 3], [0, 1, 2], [0, 1, 4], [2, 2, 1]])).unwrap();
        let scene = builder.finish();
        assert_eq!(scene.dropped, Dropped { degenerate: 2, non_finite: 1, curved: 0 });
        assert_eq!(scene.triangles.len(), 1);
        assert_eq!(scene.corners(0)[1], Vec3::X);
        assert_eq!(scene.warnings.len(), 2);
    }

    #[test]
    fn lights_of_one_name_are_numbered_in_order() {
        let mut builder = SceneBuilder::new("test");
        let light = |name: &str| {
            Light::point(
                name,
                PointLight { position: Vec3::ZERO, intensity: [1.0; 3], falloff: Falloff::InverseSquare },
            )
        };
        for name in ["a", "a-2", "a", "a", "b"] {
            builder.add_light(light(name));
        }
        let mut builder = SceneBuilder::extend(builder.into_scene());
        builder.add_light(light("a"));
        builder.add_light(light("a-2"));
        let scene = builder.finish();
        let names: Vec<_> = scene.lights.iter().map(|l| l.name.as_str()).collect();
        assert_eq!(names, ["a", "a-2", "a-3", "a-4", "b", "a-5", "a-2-2"]);
    }

    #[test]
    fn an_index_out_of_range_is_an_error() {
        let mut builder = SceneBuilder::new("test");
        let error = builder.add_object(object(&[[0.0; 3]], &[[0, 0, 1]])).unwrap_err();
        assert_eq!(error.to_string(), "object test: vertex 1 of 1");
    }

    #[test]
    fn masked_objects_need_finite_texture_coordinates_and_no_others_keep_them() {
        let mut builder = SceneBuilder::new("test");
        let wrap = [Wrap::Repeat; 2];
        let mask = builder.add_alpha_mask(AlphaMask::new(2, 1, wrap, |column, _| column == 0));
        let coverage = Coverage::Masked(mask);
        let masked = builder.add_material(Material { coverage, ..Material::default() });
        let coverage = Coverage::Masked(9);
        let broken = builder.add_material(Material { coverage, ..Material::default() });
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        // The first triangle goes, and its coordinates with it.
        let input = |material: u32, v: f32, corner: u32| {
            let coordinates = vec![[0.0, v], [2.0, 0.5]];
            let corners = vec![[0; 3], [0, 1, corner]];
            let texture_coordinates = Some(TextureCoordinates { coordinates, corners });
            ObjectInput { material, texture_coordinates, ..object(&positions, &[[0, 0, 1], [0, 1, 2]]) }
        };
        for (input, words) in [
            (
                ObjectInput { texture_coordinates: None, ..input(masked, 0.0, 0) },
                "no texture coordinates for",
            ),
            (input(masked, f32::INFINITY, 0), "texture coordinates that are not finite"),
            (input(masked, 0.0, 2), "texture coordinate 2 of 2"),
            (input(broken, 0.0, 0), "no alpha mask 9"),
        ] {
            assert!(builder.add_object(input).unwrap_err().to_string().contains(words), "{words}");
        }
        builder.add_object(input(masked, 0.0, 1)).unwrap();
        builder.add_object(input(0, 0.0, 1)).unwrap();
        let scene = builder.finish();
        let kept = scene.objects[0].texture_coordinates.as_ref().unwrap();
        assert_eq!((kept.coordinates[1], kept.corners.as_slice()), ([2.0, 0.5], &[[0, 1, 1]][..]));
        assert!(scene.objects[1].texture_coordinates.is_none());
    }

    #[test]
    fn a_needle_of_one_ulp_is_not_degenerate() {
        let above = 1.0f32.next_up();
        assert!(!is_degenerate([Vec3::ZERO, Vec3::ONE, Vec3::new(1.0, 1.0, above)]));
        assert!(is_degenerate([Vec3::ZERO, Vec3::ONE, Vec3::splat(above)]));
    }
}
