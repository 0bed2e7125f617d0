//! The world before anybody looks at it: objects made of triangles and curved surfaces, materials, lights and
//! cameras.
//!
//! Everything is in world space, in f32, after one rounding of the transforms; from then on those numbers
//! are the scene, exactly. Objects are numbered as in the 1986 paper: object m, surface n, both from 1
//! when they are printed.

mod alpha;
pub mod animation;
mod builder;
mod camera;
pub mod formats;
mod framing;
mod join;
mod light;
mod material;
mod merge;
mod primitive;
pub mod procedural;
mod texture;

pub use alpha::{AlphaMask, MaskedTriangle, TextureCoordinates, Wrap};
pub use animation::{Animation, FrameRate};
pub use builder::{Dropped, ObjectInput, SceneBuilder, SmoothNormals};
pub use camera::{Camera, ImageSize, Raster, Window};
pub use framing::{Framing, frame};
pub use light::{Cone, DirectionalLight, Emitter, Falloff, Light, PointLight, SpotLight};
pub use material::{Coverage, Material, Transmission};
pub use merge::{Adopted, Placement};
pub use primitive::{CurvedPrimitive, Primitive, PrimitiveIndex};
pub(crate) use texture::dual;
pub use texture::{Image, Mapping, Pattern, Texels, Texture};

use glam::Vec3;

/// A triangle of a [`Scene`]: three indices into [`Scene::vertices`], and the object it belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Triangle {
    /// Indices into [`Scene::vertices`].
    pub vertices: [u32; 3],
    /// Index into [`Scene::objects`].
    pub object: u32,
}

/// Primitives that share a name and a material: object m of the 1986 paper.
#[derive(Debug, Clone)]
pub struct Object {
    /// The name that the scene file gives it.
    pub name: String,
    /// Index into [`Scene::materials`].
    pub material: u32,
    /// First triangle in [`Scene::triangles`].
    pub first: PrimitiveIndex,
    /// Number of triangles.
    pub count: u32,
    /// First curved surface in [`Scene::curved`].
    pub first_curved: u32,
    /// Number of curved surfaces.
    pub curved_count: u32,
    /// Polygons that its triangles were cut from, as the scene file has them.
    pub polygons: u32,
    /// Normals for shading alone; they never decide who sees a light.
    pub normals: Option<SmoothNormals>,
    /// Where its corners lie in the alpha mask or texture of its material; there if it is
    /// [`Coverage::Masked`], and otherwise at most if its texture lies by [`Mapping::Coordinates`].
    pub texture_coordinates: Option<TextureCoordinates>,
    /// Its part in shadows.
    pub shadowing: Shadowing,
}

/// An object's part in shadows. Both are so unless the scene file says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shadowing {
    /// Whether it blocks light.
    pub casts: bool,
    /// Whether light that reaches it can be blocked: if not, what faces a light is lit by it.
    pub receives: bool,
}

impl Default for Shadowing {
    fn default() -> Shadowing {
        Shadowing { casts: true, receives: true }
    }
}

/// A scene, complete and checked: every index is in range, every number finite, no primitive degenerate.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The name it is reported under: the file's name, or `builtin:NAME`.
    pub name: String,
    /// Positions in world space.
    pub vertices: Vec<Vec3>,
    /// All triangles, object by object.
    pub triangles: Vec<Triangle>,
    /// All curved surfaces, object by object.
    pub curved: Vec<CurvedPrimitive>,
    /// Objects, in the order of the file.
    pub objects: Vec<Object>,
    /// Materials, at least one.
    pub materials: Vec<Material>,
    /// Where masked materials are holes. Each has both opaque texels and holes when it comes from a file.
    pub alpha_masks: Vec<AlphaMask>,
    /// What materials refer to by [`Material::texture`]; without defects.
    pub textures: Vec<Texture>,
    /// Lights, in the order of the file; may be empty before [`frame`].
    pub lights: Vec<Light>,
    /// Cameras, in the order of the file; may be empty before [`frame`].
    pub cameras: Vec<Camera>,
    /// What rays that leave the scene see, linear Rec. 709, each channel from 0. In a picture, where the camera
    /// sees nothing, alpha is 0 and so is the colour.
    pub background: [f32; 3],
    /// Primitives that were left out, and why.
    pub dropped: Dropped,
    /// What the file asks for and is not drawn, a line each.
    pub warnings: Vec<String>,
}

impl Scene {
    /// A scene with nothing in it but the default material.
    pub fn empty(name: impl Into<String>) -> Scene {
        Scene {
            name: name.into(),
            vertices: Vec::new(),
            triangles: Vec::new(),
            curved: Vec::new(),
            objects: Vec::new(),
            materials: vec![Material::default()],
            alpha_masks: Vec::new(),
            textures: Vec::new(),
            lights: Vec::new(),
            cameras: Vec::new(),
            background: [0.0; 3],
            dropped: Dropped::default(),
            warnings: Vec::new(),
        }
    }

    /// The three corners of a triangle, in world space.
    pub fn corners(&self, primitive: PrimitiveIndex) -> [Vec3; 3] {
        self.triangles[primitive as usize].vertices.map(|v| self.vertices[v as usize])
    }

    /// The object that a primitive belongs to.
    pub fn object(&self, primitive: PrimitiveIndex) -> &Object {
        &self.objects[self.object_index(primitive) as usize]
    }

    /// The material of a primitive.
    pub fn material(&self, primitive: PrimitiveIndex) -> &Material {
        &self.materials[self.object(primitive).material as usize]
    }

    /// The mask of a triangle that has holes.
    pub fn masked(&self, primitive: PrimitiveIndex) -> Option<MaskedTriangle<'_>> {
        if self.alpha_masks.is_empty() || self.is_curved(primitive) {
            return None;
        }
        let object = self.object(primitive);
        let Coverage::Masked(mask) = self.materials[object.material as usize].coverage else { return None };
        let texture = object.texture_coordinates.as_ref().expect("checked when the object was added");
        let corners = texture.corners[(primitive - object.first) as usize];
        let coordinates = corners.map(|corner| texture.coordinates[corner as usize]);
        Some(MaskedTriangle { mask: &self.alpha_masks[mask as usize], coordinates })
    }

    /// A hash of everything that shadows depend on: corners of all triangles and numbers of all curved surfaces,
    /// object by object, positions and cones of lights, holes, transmittances, and parts in shadows. FNV-1a in 64 bits, the same on every platform.
    pub fn hash(&self) -> u64 {
        self.hash_under(&self.lights)
    }

    /// The same under other lights than its own.
    pub fn hash_under(&self, lights: &[Light]) -> u64 {
        let corners = self.triangles.iter().flat_map(|t| {
            let corners = t.vertices.map(|v| self.vertices[v as usize].to_array());
            corners.into_iter().flatten().map(f32::to_bits).chain([t.object])
        });
        // A point light's w is not fed, as it never was: its hash is that of its coordinates.
        let lights = lights.iter().flat_map(|light| {
            let (xyz, w) = light.position().homogeneous();
            let cone = light.cone().map(|cone| [cone.axis.x, cone.axis.y, cone.axis.z, cone.cos_outer]);
            let rest = (w == 0.0).then_some(w).into_iter().chain(cone.into_iter().flatten());
            xyz.to_array().into_iter().chain(rest).map(f32::to_bits).collect::<Vec<_>>()
        });
        let holes = (0..self.triangles.len() as u32).filter_map(|t| Some((t, self.masked(t)?)));
        let places = holes.flat_map(|(t, masked)| {
            let mask = self.material(t).coverage.mask().unwrap_or_default();
            masked.coordinates.into_iter().flatten().map(f32::to_bits).chain([mask])
        });
        let holes = self.alpha_masks.iter().map(|mask| mask.hash() as u32).chain(places);
        let apart = |(number, object): (usize, &Object)| {
            let Shadowing { casts, receives } = object.shadowing;
            (!(casts && receives)).then_some([number as u32, u32::from(casts), u32::from(receives)])
        };
        let parts = self.objects.iter().enumerate().filter_map(apart).flatten();
        let curved = self.curved.iter().flat_map(|c| {
            let numbers = c.shape.numbers().into_iter().map(f32::to_bits);
            numbers.chain([c.object]).collect::<Vec<_>>()
        });
        let transparent = self.objects.iter().enumerate().filter_map(|(number, object)| {
            let transmission = self.materials[object.material as usize].transmission?;
            Some([number as u32].into_iter().chain(transmission.transmittance.map(f32::to_bits)))
        });
        corners
            .chain(curved)
            .chain(transparent.flatten())
            .chain(lights)
            .chain(holes)
            .chain(parts)
            .flat_map(u32::to_le_bytes)
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
            })
    }

    /// A box along the axes around everything that has an end, or `None` if nothing has: the smallest around
    /// triangles, and around boxes that hold the curved surfaces.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let triangles = (0..self.triangles.len() as u32).flat_map(|t| self.corners(t));
        let curved = self.curved.iter().filter_map(|c| c.shape.bounds());
        let mut corners = triangles.chain(curved.flat_map(|(low, high)| [low, high]));
        let first = corners.next()?;
        Some(corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
    }
}
