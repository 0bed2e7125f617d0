//! One scene put into another, as often as wanted.
//!
//! What an object refers to by number is adopted first, once for each scene: materials, alpha masks and
//! textures. Then
//! objects are placed one by one. An object that is not moved keeps its numbers bit by bit; one that is has
//! each coordinate computed in f64 and rounded once.

use super::formats::shading_normals;
use super::{Coverage, Material, Object, ObjectInput, Scene, SceneBuilder, Shadowing};
use super::{SmoothNormals, TextureCoordinates};
use crate::error::{Error, Result};
use glam::{DAffine3, Vec3};
use std::collections::BTreeMap;

/// How an object of one scene stands in another.
#[derive(Debug, Clone, Copy, Default)]
pub struct Placement {
    /// From its scene's space to the world; `None` leaves its numbers as they are.
    pub transform: Option<DAffine3>,
    /// Whether it blocks light, in place of what its scene says.
    pub casts: Option<bool>,
    /// Whether light that reaches it can be blocked, in place of what its scene says.
    pub receives: Option<bool>,
    /// A material of the builder in place of its own; holes stay where they are.
    pub material: Option<u32>,
}

/// What a scene's numbers have become in a builder.
#[derive(Debug)]
pub struct Adopted {
    /// By the scene's material, the builder's.
    materials: Vec<u32>,
    /// The builder's number of the scene's first alpha mask.
    first_mask: u32,
    /// By material and mask, both the builder's: the one with the holes of the other.
    with_holes: BTreeMap<(u32, u32), u32>,
}

impl Adopted {
    /// The builder's number of a material of the scene.
    pub fn material(&self, index: u32) -> u32 {
        self.materials[index as usize]
    }
}

impl SceneBuilder {
    /// Adds the materials, alpha masks and textures of a scene. Its default material is the builder's. Textures
    /// lie where they lie in the scene, wherever its objects go.
    pub fn adopt(&mut self, scene: &Scene) -> Adopted {
        let masks: Vec<u32> =
            scene.alpha_masks.iter().map(|mask| self.add_alpha_mask(mask.clone())).collect();
        let first_mask = masks.first().copied().unwrap_or_default();
        let first_texture = self.adopt_textures(&scene.textures);
        let painted = |material: &Material| Material {
            texture: material.texture.map(|texture| first_texture + texture),
            ..material.clone()
        };
        let adopt = |material: &Material| match material.coverage {
            Coverage::Solid if *material == Material::default() => 0,
            Coverage::Solid => self.add_material(painted(material)),
            Coverage::Masked(mask) => {
                let coverage = Coverage::Masked(first_mask + mask);
                self.add_material(Material { coverage, ..painted(material) })
            }
        };
        let materials = scene.materials.iter().map(adopt).collect();
        Adopted { materials, first_mask, with_holes: BTreeMap::new() }
    }

    /// Adds an object of a scene whose materials were adopted. Triangles that the transform leaves without
    /// area or finite corners are dropped and counted; normals that it leaves without a direction are
    /// replaced by the face's.
    ///
    /// # Errors
    /// [`Error::Usage`] if the placement's material does not exist, a curved surface would not keep its kind
    /// ([`Shape::transformed`](crate::geometry::curved::Shape::transformed)), or the scene grows past 2^28
    /// elements.
    ///
    /// # Panics
    /// If the object is not one of the scene's.
    pub fn place(
        &mut self,
        scene: &Scene,
        object: &Object,
        adopted: &mut Adopted,
        placement: &Placement,
    ) -> Result<()> {
        let input = self.placed(scene, object, adopted, placement)?;
        self.add_object(input)
    }

    /// What [`SceneBuilder::place`] adds.
    pub(super) fn placed(
        &mut self,
        scene: &Scene,
        object: &Object,
        adopted: &mut Adopted,
        placement: &Placement,
    ) -> Result<ObjectInput> {
        let own = scene.materials[object.material as usize].coverage;
        let material = match (placement.material, own) {
            (None, _) => adopted.material(object.material),
            (Some(material), Coverage::Solid) => material,
            (Some(material), Coverage::Masked(mask)) => {
                let mask = adopted.first_mask + mask;
                match adopted.with_holes.get(&(material, mask)) {
                    Some(&known) => known,
                    None => {
                        let made = self.add_material_with_holes(material, mask)?;
                        adopted.with_holes.insert((material, mask), made);
                        made
                    }
                }
            }
        };
        let shadowing = Shadowing {
            casts: placement.casts.unwrap_or(object.shadowing.casts),
            receives: placement.receives.unwrap_or(object.shadowing.receives),
        };
        let mut input = ObjectInput { material, shadowing, ..copy(scene, object) };
        if let Some(transform) = &placement.transform {
            input.transform(transform)?;
        }
        Ok(input)
    }
}

/// The object by itself, with nothing that its triangles do not use.
fn copy(scene: &Scene, object: &Object) -> ObjectInput {
    let range = object.first as usize..(object.first + object.count) as usize;
    let corners: Vec<[u32; 3]> = scene.triangles[range].iter().map(|triangle| triangle.vertices).collect();
    let (positions, triangles) = compact(&scene.vertices, &corners);
    let normals = object.normals.as_ref().map(|given| {
        let (normals, corners) = compact(&given.normals, &given.corners);
        SmoothNormals { normals, corners }
    });
    let texture_coordinates = object.texture_coordinates.as_ref().map(|given| {
        let (coordinates, corners) = compact(&given.coordinates, &given.corners);
        TextureCoordinates { coordinates, corners }
    });
    let curved = object.first_curved as usize..(object.first_curved + object.curved_count) as usize;
    ObjectInput {
        polygons: Some(object.polygons),
        curved: scene.curved[curved].iter().map(|primitive| primitive.shape).collect(),
        normals,
        texture_coordinates,
        ..ObjectInput::new(&object.name, positions, triangles)
    }
}

/// The elements that corners refer to, in their order, and the corners with the new numbers.
fn compact<T: Copy>(elements: &[T], corners: &[[u32; 3]]) -> (Vec<T>, Vec<[u32; 3]>) {
    let mut used = corners.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    let (first, last) = (used.first().copied().unwrap_or(0), used.last().copied().unwrap_or(0));
    let is_run = used.len() as u64 == u64::from(last - first) + 1;
    let renumber = |old: u32| match is_run {
        true => old - first,
        false => used.partition_point(|&other| other < old) as u32,
    };
    let corners = corners.iter().map(|corners| corners.map(renumber)).collect();
    (used.iter().map(|&index| elements[index as usize]).collect(), corners)
}

impl ObjectInput {
    /// Moves it, each coordinate computed in f64 and rounded once.
    ///
    /// # Errors
    /// [`Error::Usage`] if a curved surface would not keep its kind.
    pub(super) fn transform(&mut self, transform: &DAffine3) -> Result<()> {
        transform_object(self, transform)
    }

    /// Finds out whether it can be moved so.
    ///
    /// # Errors
    /// As [`transform`](ObjectInput::transform).
    pub(super) fn check_transform(&self, transform: &DAffine3) -> Result<()> {
        for shape in &self.curved {
            let placed = shape.transformed(transform);
            placed.map_err(|why| Error::Usage(format!("object {}: {why}", self.name)))?;
        }
        Ok(())
    }
}

fn transform_object(input: &mut ObjectInput, transform: &DAffine3) -> Result<()> {
    for shape in &mut input.curved {
        let placed = shape.transformed(transform);
        *shape = placed.map_err(|why| Error::Usage(format!("object {}: {why}", input.name)))?;
    }
    for position in &mut input.positions {
        *position = transform.transform_point3(position.as_dvec3()).as_vec3();
    }
    // A mirrored solid would be inside out.
    if transform.matrix3.determinant() < 0.0 {
        let normals = input.normals.iter_mut().flat_map(|normals| &mut normals.corners);
        let texture = input.texture_coordinates.iter_mut().flat_map(|texture| &mut texture.corners);
        input.triangles.iter_mut().chain(normals).chain(texture).for_each(|corners| corners.swap(1, 2));
    }
    if let Some(normals) = &mut input.normals {
        let matrix = shading_normals::matrix(&transform.matrix3);
        for normal in &mut normals.normals {
            *normal = shading_normals::unit(matrix * normal.as_dvec3()).unwrap_or(Vec3::ZERO);
        }
        shading_normals::repair(normals, &input.positions, &input.triangles);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{AlphaMask, Wrap};
    use glam::{DMat3, DVec3};

    /// A triangle with normals and holes that uses the last three of four vertices, and one without.
    fn scene() -> Scene {
        let mut builder = SceneBuilder::new("leaf");
        let mask = builder.add_alpha_mask(AlphaMask::new(2, 1, [Wrap::Repeat; 2], |column, _| column == 0));
        let coverage = Coverage::Masked(mask);
        let material = builder.add_material(Material { name: "net".into(), coverage, ..Material::default() });
        let corners = vec![[3, 1, 2]];
        let positions = [[9.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-0.0, 0.0, 0.1]].map(Vec3::from);
        let diagonal = Vec3::ONE.normalize();
        builder
            .add_object(ObjectInput {
                material,
                normals: Some(SmoothNormals { normals: vec![diagonal; 4], corners: corners.clone() }),
                texture_coordinates: Some(TextureCoordinates {
                    coordinates: vec![[7.0; 2], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]],
                    corners: corners.clone(),
                }),
                shadowing: Shadowing { casts: false, receives: true },
                ..ObjectInput::new("net", positions.to_vec(), corners.clone())
            })
            .unwrap();
        builder.add_object(ObjectInput::new("plain", positions.to_vec(), corners)).unwrap();
        builder.finish()
    }

    fn placed(placement: &Placement) -> Scene {
        let mut builder = SceneBuilder::new("whole");
        builder.add_material(Material { name: "first".into(), ..Material::default() });
        builder.add_alpha_mask(AlphaMask::new(1, 1, [Wrap::Repeat; 2], |_, _| true));
        let scene = scene();
        let mut adopted = builder.adopt(&scene);
        for object in &scene.objects {
            builder.place(&scene, object, &mut adopted, placement).unwrap();
        }
        builder.finish()
    }

    #[test]
    fn what_is_not_moved_keeps_its_bits_and_brings_what_it_needs() {
        let (from, to) = (scene(), placed(&Placement::default()));
        let bits = |scene: &Scene| scene.corners(0).map(|p| p.to_array().map(f32::to_bits));
        assert_eq!(bits(&from), bits(&to));
        assert_eq!(to.vertices.len(), 6);
        assert_eq!(to.alpha_masks[1], from.alpha_masks[0]);
        assert_eq!(to.material(0).coverage, Coverage::Masked(1));
        assert_eq!((to.material(0).name.as_str(), to.objects[1].material), ("net", 0));
        assert_eq!(to.masked(0).unwrap().coordinates, from.masked(0).unwrap().coordinates);
        assert_eq!(to.objects[0].shadowing, from.objects[0].shadowing);
        assert_eq!(to.objects[0].normals.as_ref().unwrap().normals, [Vec3::ONE.normalize(); 3]);
    }

    #[test]
    fn a_mirror_turns_triangles_round_and_stretching_turns_normals_the_other_way() {
        let transform =
            DAffine3 { matrix3: DMat3::from_diagonal(DVec3::new(-2.0, 1.0, 1.0)), translation: DVec3::Y };
        let to = placed(&Placement { transform: Some(transform), ..Placement::default() });
        let corners = to.corners(0).map(|p| p.to_array());
        assert_eq!(corners, [[0.0, 1.0, 0.1], [0.0, 2.0, 0.0], [-2.0, 1.0, 0.0]]);
        let coordinates = to.masked(0).unwrap().coordinates;
        assert_eq!(coordinates, [[3.0, 0.0], [2.0, 0.0], [1.0, 0.0]]);
        let normals = to.objects[0].normals.as_ref().unwrap();
        let expected = DVec3::new(-0.5, 1.0, 1.0).normalize().as_vec3();
        assert!(normals.normals.iter().all(|n| n.abs_diff_eq(expected, 1e-7)), "{:?}", normals.normals);
    }

    #[test]
    fn another_material_leaves_the_holes_and_overrides_say_who_has_part_in_shadows() {
        let placement =
            Placement { casts: Some(true), receives: Some(false), material: Some(1), ..Placement::default() };
        let to = placed(&placement);
        assert_eq!((to.material(0).name.as_str(), to.material(0).coverage), ("first", Coverage::Masked(1)));
        assert_eq!((to.material(1).name.as_str(), to.material(1).coverage), ("first", Coverage::Solid));
        assert!(to.objects.iter().all(|o| o.shadowing == Shadowing { casts: true, receives: false }));
        let missing = Placement { material: Some(99), ..Placement::default() };
        let (scene, mut builder) = (scene(), SceneBuilder::new("whole"));
        let mut adopted = builder.adopt(&scene);
        for object in &scene.objects {
            assert!(builder.place(&scene, object, &mut adopted, &missing).is_err());
        }
    }

    #[test]
    fn corners_without_a_run_of_vertices_are_renumbered() {
        let (elements, corners) = compact(&[0, 10, 20, 30, 40], &[[4, 1, 3], [1, 4, 4]]);
        assert_eq!((elements, corners), (vec![10, 30, 40], vec![[2, 0, 1], [0, 2, 2]]));
        assert_eq!(compact::<u8>(&[], &[]), (vec![], vec![]));
    }
}
