//! What of a scene Embree is given, and the numbers that it has there.

use crate::embree::{HoleMask, HoleWrap, Holes, SceneBuffers, SceneParts, ShadowRay};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::scene::{AlphaMask, PrimitiveIndex, Scene, Triangle, Wrap};

/// Numbers of the primitives that cast: Embree has these alone, in the order of the scene.
pub(super) struct Casters {
    /// Those that cast, if not all do.
    casting: Option<Vec<PrimitiveIndex>>,
    /// For each primitive of the scene its place among them; [`ShadowRay::NO_PRIMITIVE`] for the others.
    indices: Vec<u32>,
}

impl Casters {
    pub(super) fn new(scene: &Scene) -> Casters {
        if scene.objects.iter().all(|object| object.shadowing.casts) {
            return Casters { casting: None, indices: Vec::new() };
        }
        let casts = |p: &PrimitiveIndex| scene.object(*p).shadowing.casts;
        let casting: Vec<_> = (0..scene.primitive_count()).filter(casts).collect();
        let mut indices = vec![ShadowRay::NO_PRIMITIVE; scene.primitive_count() as usize];
        for (index, &primitive) in casting.iter().enumerate() {
            indices[primitive as usize] = index as u32;
        }
        Casters { casting: Some(casting), indices }
    }

    /// Embree's number of a primitive of the scene.
    pub(super) fn index_of(&self, primitive: PrimitiveIndex) -> u32 {
        if self.casting.is_none() { primitive } else { self.indices[primitive as usize] }
    }

    /// The scene's number of a primitive that Embree has.
    pub(super) fn primitive(&self, index: u32) -> PrimitiveIndex {
        self.casting.as_ref().map_or(index, |casting| casting[index as usize])
    }
}

/// Everything that casts, as Embree reads it.
pub(super) fn buffers(scene: &Scene) -> Result<SceneBuffers> {
    let casts = |object: u32| scene.objects[object as usize].shadowing.casts;
    let vertices: Vec<[f32; 3]> = scene.vertices.iter().map(|v| v.to_array()).collect();
    let casting = |t: &&Triangle| casts(t.object);
    let triangles: Vec<[u32; 3]> = scene.triangles.iter().filter(casting).map(|t| t.vertices).collect();
    let curved: Vec<Shape> = scene.curved.iter().filter(|c| casts(c.object)).map(|c| c.shape).collect();
    let transparent: Vec<bool> = if scene.has_transparent_casters() {
        let casting = (0..scene.primitive_count()).filter(|&p| scene.object(p).shadowing.casts);
        casting.map(|p| scene.is_transparent(p)).collect()
    } else {
        Vec::new()
    };
    let parts = SceneParts {
        vertices: &vertices,
        triangles: &triangles,
        holes: holes(scene)?,
        curved: &curved,
        transparent: &transparent,
    };
    SceneBuffers::new(parts)
}

/// The holes of all triangles that cast, if there are any.
fn holes(scene: &Scene) -> Result<Option<Holes>> {
    if scene.alpha_masks.is_empty() {
        return Ok(None);
    }
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => HoleWrap::Repeat,
        Wrap::MirroredRepeat => HoleWrap::MirroredRepeat,
        Wrap::ClampToEdge => HoleWrap::ClampToEdge,
    };
    let mask = |mask: &AlphaMask| HoleMask {
        size: [mask.width, mask.height],
        wrap: mask.wrap.map(wrap),
        there: mask.words().to_vec(),
    };
    let casting = (0..scene.triangles.len() as u32).filter(|&t| scene.object(t).shadowing.casts);
    let (mask_of, coordinates) = casting
        .map(|t| {
            let mask = scene.material(t).coverage.mask().unwrap_or(Holes::NONE);
            (mask, scene.masked(t).map_or([[0.0; 2]; 3], |masked| masked.coordinates))
        })
        .unzip();
    Holes::new(mask_of, coordinates, scene.alpha_masks.iter().map(mask).collect()).map(Some)
}
