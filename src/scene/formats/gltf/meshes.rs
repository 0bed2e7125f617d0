//! Meshes as nodes show them: read once, posed and placed for each node and instance.

use super::accessors::Accessors;
use super::alpha::{Masking, Presence};
use super::extras::Extras;
use super::findings::Findings;
use super::nodes::{self, Placed};
use super::primitives::{self, Geometry, Mode, Shape};
use super::schema::{Document, Mesh, Primitive};
use super::skins::{self, Skins};
use super::totals::{ElementError, describe_primitive, mesh_at};
use super::{instancing, morphs};
use crate::scene::animation::rig::JointNumber;
use crate::scene::animation::{Hold, MovingObject, MovingPart, Placeable};
use crate::scene::formats::limits::MAX_MOVES;
use crate::scene::formats::text::printable;
use crate::scene::{ObjectInput, SceneBuilder, TextureCoordinates};
use glam::DAffine3;
use std::sync::Arc;

/// Meshes, each read when a node first shows it.
pub(super) struct Meshes<'a> {
    document: &'a Document,
    accessors: &'a Accessors<'a>,
    /// Where the surfaces of each material are there.
    presences: Vec<Presence>,
    skins: Skins<'a>,
    read: Vec<Option<Vec<Option<Arc<Geometry>>>>>,
    /// How often morph targets and joints have moved a vertex.
    moves: u64,
}

/// Where a node shows its mesh.
struct Instance {
    /// From the mesh to the world.
    world: DAffine3,
    /// From the mesh to the node, if they differ.
    offset: Option<DAffine3>,
}

/// A primitive in the pose that a node gives it.
struct Posed {
    geometry: Arc<Geometry>,
    /// Its shape, if that is another than that of the geometry.
    shape: Option<Shape>,
    on_texture: Option<Vec<[f32; 2]>>,
}

impl Posed {
    fn shape(&self) -> &Shape {
        self.shape.as_ref().unwrap_or(&self.geometry.shape)
    }

    /// The object without name and material, and how many corners had normals that were of no use.
    fn place(&self, world: &DAffine3) -> (ObjectInput, usize) {
        let instance = self.shape().place(&self.geometry.triangles, world);
        let texture_coordinates = self.on_texture.as_ref().map(|coordinates| TextureCoordinates {
            coordinates: coordinates.clone(),
            corners: instance.triangles.clone(),
        });
        let input = ObjectInput {
            normals: instance.normals,
            texture_coordinates,
            ..ObjectInput::new("", instance.positions, instance.triangles)
        };
        (input, instance.normals_replaced)
    }
}

impl Placeable for Posed {
    fn placed(&self, transform: Option<&DAffine3>) -> crate::error::Result<ObjectInput> {
        Ok(self.place(transform.unwrap_or(&DAffine3::IDENTITY)).0)
    }

    fn check(&self, _: &DAffine3) -> crate::error::Result<()> {
        Ok(())
    }
}

impl<'a> Meshes<'a> {
    pub(super) fn new(
        document: &'a Document,
        accessors: &'a Accessors<'a>,
        presences: Vec<Presence>,
        placed: &[Placed],
    ) -> Meshes<'a> {
        let read = document.meshes.iter().map(|_| None).collect();
        let skins = Skins::new(document, accessors, placed);
        Meshes { document, accessors, presences, skins, read, moves: 0 }
    }

    /// Adds the objects of a mesh as a node shows it, and returns those that move with the node's joint.
    ///
    /// # Errors
    /// An element and a line for whatever cannot be read as geometry.
    pub(super) fn show(
        &mut self,
        place: &Placed,
        index: u64,
        joint: Option<JointNumber>,
        builder: &mut SceneBuilder,
        findings: &mut Findings,
    ) -> Result<Vec<MovingObject>, ElementError> {
        let node = |why: String| (nodes::describe(self.document, place.index), why);
        let (position, mesh) = mesh_at(self.document, index).map_err(node)?;
        let instances = self.instances(place, findings).map_err(node)?;
        // Taken out while it is used, so that skins can be computed meanwhile.
        let read = match self.read[position].take() {
            Some(read) => read,
            None => self.read_mesh(position, mesh, findings)?,
        };
        let all_posed = self.pose_all(place, (position, mesh), &read)?;
        let given = place.node.name.as_deref().or(mesh.name.as_deref());
        let name = given.map_or_else(|| format!("node {}", place.index), printable);
        let shadowing = Extras::shadowing(place.node.extras, mesh.extras);
        // A skin leads to the world, wherever the node is.
        let joint = joint.filter(|_| place.node.skin.is_none());
        let mut moving = Vec::new();
        for (count, Instance { world, offset }) in instances.iter().enumerate() {
            for (number, posed) in &all_posed {
                let material = mesh.primitives[*number].material;
                if self.presence(material) == &Presence::Absent {
                    findings.absent += posed.geometry.triangles.len();
                    continue;
                }
                let (object, normals_replaced) = posed.place(world);
                findings.normals_replaced += normals_replaced;
                let input = ObjectInput {
                    name: match place.node.extensions.instancing {
                        Some(_) => format!("{name}-{}", count + 1),
                        None => name.clone(),
                    },
                    // The scene's material 0 is the default, the document's own come after it.
                    material: material.map_or(0, |material| material as u32 + 1),
                    shadowing,
                    ..object
                };
                if joint.is_some() {
                    let hold = Hold { joint, offset: *offset };
                    let parts = vec![MovingPart { geometry: posed.clone(), hold }];
                    moving.push(MovingObject { index: builder.object_count(), parts });
                }
                builder
                    .add_object(input)
                    .map_err(|error| (describe_primitive(position, *number), error.to_string()))?;
            }
        }
        self.read[position] = Some(read);
        Ok(moving)
    }

    fn presence(&self, material: Option<u64>) -> &Presence {
        material.map_or(&Presence::Solid, |material| &self.presences[material as usize])
    }

    fn masking(&self, primitive: &Primitive) -> Option<&Masking> {
        match self.presence(primitive.material) {
            Presence::Masked(masking) => Some(masking),
            _ => None,
        }
    }

    /// From the mesh to the world, once for each time that the node shows it.
    fn instances(&self, place: &Placed, findings: &mut Findings) -> Result<Vec<Instance>, String> {
        let at = |world: DAffine3| vec![Instance { world, offset: None }];
        let skinned = place.node.skin.is_some();
        let Some(instancing) = &place.node.extensions.instancing else {
            // A skin leads to the world already.
            return Ok(at(if skinned { DAffine3::IDENTITY } else { place.world }));
        };
        if skinned {
            let which = nodes::describe(self.document, place.index);
            findings.not_drawn("instances of skinned meshes", which);
            return Ok(at(DAffine3::IDENTITY));
        }
        let transforms = instancing::transforms(self.document, self.accessors, place.node, instancing)?;
        let instance = |(number, transform): (usize, DAffine3)| {
            let world = place.world * transform;
            match world.is_finite() {
                true => Ok(Instance { world, offset: Some(transform) }),
                false => Err(format!("the transform of instance {number} in the world is not finite")),
            }
        };
        transforms.into_iter().enumerate().map(instance).collect()
    }

    fn read_mesh(
        &self,
        position: usize,
        mesh: &Mesh,
        findings: &mut Findings,
    ) -> Result<Vec<Option<Arc<Geometry>>>, ElementError> {
        let mut all = Vec::new();
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let element = |why| (describe_primitive(position, number), why);
            all.push(self.read_primitive(primitive, findings).map_err(element)?.map(Arc::new));
        }
        Ok(all)
    }

    /// `None` for points and lines.
    fn read_primitive(
        &self,
        primitive: &Primitive,
        findings: &mut Findings,
    ) -> Result<Option<Geometry>, String> {
        if primitives::mode(primitive)? == Mode::Thin {
            findings.thin += 1;
            return Ok(None);
        }
        findings.coloured += usize::from(primitive.attributes.contains_key("COLOR_0"));
        let geometry = primitives::read(self.document, self.accessors, primitive, self.masking(primitive))?;
        findings.left_over += geometry.left_over;
        Ok(Some(geometry))
    }

    /// By their numbers in the mesh.
    fn pose_all(
        &mut self,
        place: &Placed,
        (position, mesh): (usize, &Mesh),
        read: &[Option<Arc<Geometry>>],
    ) -> Result<Vec<(usize, Arc<Posed>)>, ElementError> {
        let mut posed = Vec::new();
        for (number, (geometry, primitive)) in read.iter().zip(&mesh.primitives).enumerate() {
            let Some(geometry) = geometry else { continue };
            let at = |why| (describe_primitive(position, number), why);
            let shape = self.pose(place, mesh, primitive, geometry).map_err(at)?;
            let mut in_pose = Posed { geometry: geometry.clone(), shape, on_texture: None };
            if let Some(masking) = self.masking(primitive) {
                in_pose.on_texture = in_pose.shape().on_texture(&masking.placement).map_err(at)?;
            }
            posed.push((number, Arc::new(in_pose)));
        }
        Ok(posed)
    }

    /// The shape of a primitive with the node's morph targets and skin, if there are such.
    fn pose(
        &mut self,
        place: &Placed,
        mesh: &Mesh,
        primitive: &Primitive,
        geometry: &Geometry,
    ) -> Result<Option<Shape>, String> {
        let mut shape = None;
        let weights = morphs::weights(place.node, mesh, primitive)?;
        self.spend(weights.len() as u64)?;
        let vertices = geometry.used.len() as u64;
        let targets = weights.iter().filter(|weight| **weight != 0.0).count() as u64;
        if targets > 0 {
            self.spend(targets.saturating_mul(vertices))?;
            let placement = self.masking(primitive).map(|masking| &masking.placement);
            let displaced = morphs::displaced(geometry, self.accessors, primitive, placement, weights)?;
            shape = Some(displaced);
        }
        if let Some(skin) = place.node.skin {
            let sets = skins::influences(self.accessors, primitive, geometry.vertices)?;
            self.spend((4 * sets.len() as u64).saturating_mul(vertices.max(1)))?;
            let matrices = self.skins.matrices(skin)?;
            let own = shape.unwrap_or_else(|| geometry.shape.clone());
            shape = Some(skins::skinned(geometry, own, &sets, matrices)?);
        }
        Ok(shape)
    }

    /// Bounds the work: a target or a set of joints need not have a byte in the file.
    fn spend(&mut self, moves: u64) -> Result<(), String> {
        self.moves = self.moves.saturating_add(moves);
        match self.moves <= MAX_MOVES {
            true => Ok(()),
            false => Err(format!("morph targets and joints move vertices more than {MAX_MOVES} times")),
        }
    }
}
