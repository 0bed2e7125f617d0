//! Triangles and curved surfaces, built by Embree.

use std::ptr::{self, NonNull};
use std::sync::Arc;

use super::curved::CurvedSurfaces;
use super::{Device, Holes, call, ffi};
use crate::geometry::curved::Shape;
use crate::{Error, Result};

/// Embree leaves out, and says nothing of, triangles with a coordinate of this magnitude or more.
pub(super) const LARGEST_COORDINATE: f32 = 1.844e18;

/// How Embree traverses and intersects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Robustness {
    /// As fast as it can: rays may slip through shared edges.
    Fast,
    /// Watertight along shared edges, up to the rounding of ray and vertices.
    Robust,
}

/// How much work goes into the tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BuildQuality {
    /// Morton order: built two to three times faster, queried half as fast again slower.
    Low,
    /// Binned surface area heuristic.
    Medium,
    /// With spatial splits. In a robust scene Embree 3 builds the same as for medium quality.
    High,
}

/// What becomes of the primitive that a ray names as [`ShadowRay::excluded`](super::ShadowRay::excluded).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Receiver {
    /// It blocks as any other: the field is not read.
    Included,
    /// That ray leaves it behind: a flat one never blocks it, another where it is met once more. For triangles a
    /// filter function is registered, which slows every query of the scene.
    Excluded,
}

/// How a scene is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SceneOptions {
    /// How rays meet it.
    pub robustness: Robustness,
    /// How well its tree is built.
    pub quality: BuildQuality,
    /// Whether rays may exclude a primitive.
    pub receiver: Receiver,
}

/// What a scene is made of: all of it is copied. Primitives are numbered, first all triangles, then all curved
/// surfaces.
#[derive(Debug, Default)]
pub struct SceneParts<'a> {
    /// Corners of triangles, in world space.
    pub vertices: &'a [[f32; 3]],
    /// Indices into `vertices`; winding plays no part.
    pub triangles: &'a [[u32; 3]],
    /// Where rays pass through the triangles. Holes register a filter function, which slows every query.
    pub holes: Option<Holes>,
    /// Surfaces without defects.
    pub curved: &'a [Shape],
    /// Whether light passes through each primitive, which then blocks no ray and is found by
    /// [`EmbreeScene::crossed`]; empty if it passes through none. Transparent triangles register a filter function,
    /// which slows every query.
    pub transparent: &'a [bool],
}

/// What scenes are made of, checked and as Embree reads it: any number of scenes may refer to it.
#[derive(Debug)]
pub struct SceneBuffers {
    /// Three floats a vertex and one that is padding: Embree reads 16 bytes at the last vertex.
    vertices: Vec<f32>,
    triangles: Vec<[u32; 3]>,
    /// What the filter looks at.
    holes: Option<Holes>,
    /// For each triangle whether light passes through it, if it passes through any: the filter looks at this too.
    transparent: Option<Vec<bool>>,
    /// What the callbacks look at.
    curved: CurvedSurfaces,
}

impl SceneBuffers {
    /// Copies what is given.
    ///
    /// # Errors
    ///
    /// As [`EmbreeScene::of_parts`], but for what Embree reports.
    pub fn new(parts: SceneParts<'_>) -> Result<SceneBuffers> {
        check(&parts)?;
        let SceneParts { vertices, triangles, holes, curved, transparent } = parts;
        let mut padded = Vec::with_capacity(3 * vertices.len() + 1);
        padded.extend_from_slice(vertices.as_flattened());
        padded.push(0.0);
        let (flat, round) = transparent.split_at(transparent.len().min(triangles.len()));
        let curved = CurvedSurfaces::new(curved, round)?;
        // A filter that never rejects anything would cost time all the same.
        let transparent = flat.contains(&true).then(|| flat.to_vec());
        Ok(SceneBuffers { vertices: padded, triangles: triangles.to_vec(), holes, transparent, curved })
    }
}

/// Primitives that Embree has built and that any number of threads may query at once.
#[derive(Debug)]
pub struct EmbreeScene {
    scene: NonNull<ffi::LbScene>,
    /// Embree refers to these, so they live, unchanged, until the scene is freed.
    buffers: Arc<SceneBuffers>,
    receiver: Receiver,
    /// What the device's memory grew by.
    embree_bytes: usize,
    device: Device,
}

// SAFETY: a committed scene is only read; Embree allows that from any thread, and freeing it on another than its own.
unsafe impl Send for EmbreeScene {}
// SAFETY: as above; nothing in it changes behind a shared reference.
unsafe impl Sync for EmbreeScene {}

impl EmbreeScene {
    /// Builds the triangles `triangles`, whose corners are indices into `vertices`, in world space. Both are copied.
    /// A triangle's number is its index; winding plays no part. Nothing at all is a scene that blocks nothing.
    ///
    /// # Errors
    ///
    /// A vertex with a coordinate that is not finite or is 1.844e18 or more (Embree would leave its triangles out),
    /// an index past the last vertex, or whatever Embree reports, with lack of memory in the first place.
    pub fn new(
        device: &Device,
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
        options: SceneOptions,
    ) -> Result<EmbreeScene> {
        EmbreeScene::of_parts(device, SceneParts { vertices, triangles, ..SceneParts::default() }, options)
    }

    /// As [`new`](EmbreeScene::new), of everything that there can be.
    ///
    /// # Errors
    ///
    /// As there; holes or transparency of another number of primitives, a curved surface beyond Embree's range, or
    /// an Embree that cannot have curved ones.
    pub fn of_parts(device: &Device, parts: SceneParts<'_>, options: SceneOptions) -> Result<EmbreeScene> {
        EmbreeScene::of_buffers(device, &Arc::new(SceneBuffers::new(parts)?), options)
    }

    /// Builds what has been checked and copied before.
    ///
    /// # Errors
    ///
    /// Whatever Embree reports, or that it cannot have curved surfaces.
    pub fn of_buffers(
        device: &Device,
        buffers: &Arc<SceneBuffers>,
        options: SceneOptions,
    ) -> Result<EmbreeScene> {
        let SceneBuffers { vertices, triangles, holes, transparent, curved } = &**buffers;
        let memory = device.lock_memory();
        let before = device.bytes()?;
        let hole_view = holes.as_ref().map(Holes::as_ffi);
        let view = ffi::LbParts {
            vertices: vertices.as_ptr(),
            vertex_count: vertices.len() / 3,
            triangles: triangles.as_flattened().as_ptr(),
            triangle_count: triangles.len(),
            holes: hole_view.as_ref().map_or(ptr::null(), ptr::from_ref),
            transparent: transparent.as_ref().map_or(ptr::null(), |bools| bools.as_ptr().cast()),
            curved: curved.as_slice().as_ptr(),
            curved_count: curved.as_slice().len(),
        };
        let mut scene = ptr::null_mut();
        // SAFETY: the device lives; the buffers hold as many elements as said, padding included, all indices are in
        // range, a `bool` is a byte that is 0 or 1, curved surfaces are of known kinds, and the
        // scene holds on to all of them beside the handle that refers to them, as to the holes, which are checked; the two
        // pointers to be filled are valid for writes.
        call(|error| unsafe {
            ffi::lb_scene_new(
                device.as_ptr(),
                &view,
                options.quality.code(),
                options.flags(),
                &mut scene,
                error,
            )
        })?;
        let scene = NonNull::new(scene).expect("a scene that was made is not null");
        let embree_bytes = device.bytes().map_or(0, |after| usize::try_from(after - before).unwrap_or(0));
        drop(memory);
        Ok(EmbreeScene {
            scene,
            buffers: buffers.clone(),
            receiver: options.receiver,
            embree_bytes,
            device: device.clone(),
        })
    }

    /// Memory in bytes: what Embree allocated to build the scene and still holds, and the buffers it refers to.
    pub fn bytes(&self) -> usize {
        self.embree_bytes
            + size_of_val(&self.buffers.vertices[..])
            + size_of_val(&self.buffers.triangles[..])
            + size_of_val(self.buffers.curved.as_slice())
    }

    /// How many primitives there are, so that the one that a ray excludes can be checked; `None` if none is excluded.
    pub(super) fn excludable(&self) -> Option<usize> {
        let count = self.buffers.triangles.len() + self.buffers.curved.as_slice().len();
        (self.receiver == Receiver::Excluded).then_some(count)
    }

    /// Whether there is nothing but triangles without holes.
    pub(super) fn is_of_whole_triangles(&self) -> bool {
        self.buffers.holes.is_none() && self.buffers.curved.as_slice().is_empty()
    }

    pub(super) fn as_ptr(&self) -> *const ffi::LbScene {
        self.scene.as_ptr()
    }
}

impl Drop for EmbreeScene {
    fn drop(&mut self) {
        let _memory = self.device.lock_memory();
        // SAFETY: made by `lb_scene_new` and freed only here; buffers and device are dropped after this.
        let freed = call(|error| unsafe { ffi::lb_scene_free(self.scene.as_ptr(), error) });
        debug_assert!(freed.is_ok(), "{freed:?}");
    }
}

impl BuildQuality {
    fn code(self) -> u32 {
        match self {
            BuildQuality::Low => ffi::LB_BUILD_LOW,
            BuildQuality::Medium => ffi::LB_BUILD_MEDIUM,
            BuildQuality::High => ffi::LB_BUILD_HIGH,
        }
    }
}

impl SceneOptions {
    fn flags(self) -> u32 {
        let robust = match self.robustness {
            Robustness::Fast => 0,
            Robustness::Robust => ffi::LB_SCENE_ROBUST,
        };
        let filtered = match self.receiver {
            Receiver::Included => 0,
            Receiver::Excluded => ffi::LB_SCENE_FILTERED,
        };
        robust | filtered
    }
}

/// Everything that Embree would read out of bounds or leave out silently, but for curved surfaces, which are checked
/// where they are copied.
fn check(parts: &SceneParts<'_>) -> Result<()> {
    let SceneParts { vertices, triangles, holes, curved, transparent } = parts;
    // Written so that NaN fails.
    let fits = |coordinate: &f32| coordinate.abs() < LARGEST_COORDINATE;
    if let Some(vertex) = vertices.iter().position(|vertex| !vertex.iter().all(fits)) {
        return Err(Error::Embree(format!(
            "vertex {vertex} is {:?}; Embree needs finite coordinates below 1.844e18",
            vertices[vertex]
        )));
    }
    let primitives = triangles.len() + curved.len();
    // `u32::MAX` is how a ray excludes no primitive.
    if primitives > u32::MAX as usize {
        return Err(Error::Embree(format!("{primitives} primitives are too many")));
    }
    let in_range = |&index: &u32| (index as usize) < vertices.len();
    if let Some(triangle) = triangles.iter().position(|triangle| !triangle.iter().all(in_range)) {
        return Err(Error::Embree(format!(
            "triangle {triangle} is {:?}, but there are {} vertices",
            triangles[triangle],
            vertices.len()
        )));
    }
    if let Some(holes) = holes.as_ref().filter(|holes| holes.triangles() != triangles.len()) {
        let (have, want) = (holes.triangles(), triangles.len());
        return Err(Error::Embree(format!("holes of {have} triangles for {want}")));
    }
    if !transparent.is_empty() && transparent.len() != primitives {
        let have = transparent.len();
        return Err(Error::Embree(format!("transparency of {have} primitives for {primitives}")));
    }
    Ok(())
}
