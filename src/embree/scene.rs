//! One triangle mesh, built by Embree.

use std::ptr::{self, NonNull};

use super::{Device, Holes, call, ffi};
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

/// What becomes of the triangle that a ray names as [`ShadowRay::excluded`](super::ShadowRay::excluded).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Receiver {
    /// It blocks as any other: the field is not read.
    Included,
    /// It never blocks that ray. Registers a filter function, which slows every query of the scene.
    Excluded,
}

/// How a scene is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SceneOptions {
    /// How rays meet it.
    pub robustness: Robustness,
    /// How well its tree is built.
    pub quality: BuildQuality,
    /// Whether rays may exclude a triangle.
    pub receiver: Receiver,
}

/// A triangle mesh that Embree has built and that any number of threads may query at once.
#[derive(Debug)]
pub struct TriangleScene {
    scene: NonNull<ffi::LbScene>,
    /// Three floats a vertex and one that is padding: Embree reads 16 bytes at the last vertex. Embree refers to
    /// these buffers, so they live, unchanged, until the scene is freed.
    vertices: Vec<f32>,
    triangles: Vec<[u32; 3]>,
    /// What the filter looks at; Embree refers to it too.
    _holes: Option<Holes>,
    receiver: Receiver,
    /// What the device's memory grew by.
    embree_bytes: usize,
    device: Device,
}

// SAFETY: a committed scene is only read; Embree allows that from any thread, and freeing it on another than its own.
unsafe impl Send for TriangleScene {}
// SAFETY: as above; nothing in it changes behind a shared reference.
unsafe impl Sync for TriangleScene {}

impl TriangleScene {
    /// Builds the triangles `triangles`, whose corners are indices into `vertices`, in world space. Both are copied.
    /// A triangle's number is its index; winding plays no part. No triangles at all is a scene that blocks nothing.
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
    ) -> Result<TriangleScene> {
        TriangleScene::with_holes(device, vertices, triangles, None, options)
    }

    /// As [`new`](TriangleScene::new), with triangles that rays pass through where they have holes. Holes register
    /// a filter function, which slows every query of the scene.
    ///
    /// # Errors
    ///
    /// As there, and holes of another number of triangles.
    pub fn with_holes(
        device: &Device,
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
        holes: Option<Holes>,
        options: SceneOptions,
    ) -> Result<TriangleScene> {
        check_mesh(vertices, triangles)?;
        if let Some(holes) = holes.as_ref().filter(|holes| holes.triangles() != triangles.len()) {
            let (have, want) = (holes.triangles(), triangles.len());
            return Err(Error::Embree(format!("holes of {have} triangles for {want}")));
        }
        let mut padded = Vec::with_capacity(3 * vertices.len() + 1);
        padded.extend_from_slice(vertices.as_flattened());
        padded.push(0.0);
        let (vertices, triangles) = (padded, triangles.to_vec());

        let memory = device.lock_memory();
        let before = device.bytes()?;
        let view = holes.as_ref().map(Holes::as_ffi);
        let mut scene = ptr::null_mut();
        // SAFETY: the device lives; the buffers hold as many elements as said, padding included, all indices are in
        // range, and they move into the scene beside the handle that refers to their heap memory, as the holes do, which
        // are checked; the two pointers to be filled are valid for writes.
        call(|error| unsafe {
            ffi::lb_scene_new(
                device.as_ptr(),
                vertices.as_ptr(),
                vertices.len() / 3,
                triangles.as_flattened().as_ptr(),
                triangles.len(),
                view.as_ref().map_or(ptr::null(), ptr::from_ref),
                options.quality.code(),
                options.flags(),
                &mut scene,
                error,
            )
        })?;
        let scene = NonNull::new(scene).expect("a scene that was made is not null");
        let embree_bytes = device.bytes().map_or(0, |after| usize::try_from(after - before).unwrap_or(0));
        drop(memory);
        Ok(TriangleScene {
            scene,
            vertices,
            triangles,
            _holes: holes,
            receiver: options.receiver,
            embree_bytes,
            device: device.clone(),
        })
    }

    /// Memory in bytes: what Embree allocated to build the scene and still holds, and the buffers it refers to.
    pub fn bytes(&self) -> usize {
        self.embree_bytes + size_of_val(&self.vertices[..]) + size_of_val(&self.triangles[..])
    }

    /// How many triangles there are, so that a ray's excluded triangle can be checked; `None` if none is excluded.
    pub(super) fn excludable(&self) -> Option<usize> {
        (self.receiver == Receiver::Excluded).then_some(self.triangles.len())
    }

    pub(super) fn as_ptr(&self) -> *const ffi::LbScene {
        self.scene.as_ptr()
    }
}

impl Drop for TriangleScene {
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

/// Everything that Embree would read out of bounds or leave out silently.
fn check_mesh(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<()> {
    // Written so that NaN fails.
    let fits = |coordinate: &f32| coordinate.abs() < LARGEST_COORDINATE;
    if let Some(vertex) = vertices.iter().position(|vertex| !vertex.iter().all(fits)) {
        return Err(Error::Embree(format!(
            "vertex {vertex} is {:?}; Embree needs finite coordinates below 1.844e18",
            vertices[vertex]
        )));
    }
    // `u32::MAX` is how a ray excludes no triangle.
    if triangles.len() > u32::MAX as usize {
        return Err(Error::Embree(format!("{} triangles are too many", triangles.len())));
    }
    let in_range = |&index: &u32| (index as usize) < vertices.len();
    if let Some(triangle) = triangles.iter().position(|triangle| !triangle.iter().all(in_range)) {
        return Err(Error::Embree(format!(
            "triangle {triangle} is {:?}, but there are {} vertices",
            triangles[triangle],
            vertices.len()
        )));
    }
    Ok(())
}
