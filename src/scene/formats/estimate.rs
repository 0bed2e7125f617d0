//! How much memory a scene will take, from counts alone, so that it can be refused before it is made.
//!
//! These are the most that was found, with vectors that have just grown; most scenes take less.

use crate::memory::MemoryLimit;

/// What a scene is about to become.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Estimate {
    /// Objects, each once for every time that it is shown.
    pub(super) objects: u64,
    /// Triangles, likewise.
    pub(super) triangles: u64,
    /// Curved surfaces, likewise.
    pub(super) curved: u64,
    /// Lights and cameras, likewise.
    pub(super) named: u64,
    /// Triangles of the largest thing that is read at once.
    pub(super) at_once: u64,
}

/// With a name of 120 characters, the transform of its instance, and vectors of three primitives at least.
const OBJECT: u64 = 1200;

/// Three corners with normals and texture coordinates.
const TRIANGLE: u64 = 256;

/// Beside that, while its object is read and placed in f64.
const TRIANGLE_AT_ONCE: u64 = 512;

const CURVED: u64 = 512;

/// With its name, and that of it which keeps names apart.
const NAMED: u64 = 800;

impl Estimate {
    fn bytes(&self) -> u64 {
        let parts = [
            (self.objects, OBJECT),
            (self.triangles, TRIANGLE),
            (self.curved, CURVED),
            (self.named, NAMED),
            (self.at_once, TRIANGLE_AT_ONCE),
        ];
        parts.iter().fold(0, |sum, &(count, bytes)| count.saturating_mul(bytes).saturating_add(sum))
    }

    /// # Errors
    /// A line if that is more than the limit.
    pub(super) fn check(&self, limit: MemoryLimit) -> Result<(), String> {
        let what = format!("{} triangles in {} objects", self.triangles, self.objects);
        limit.check(what, self.bytes()).map_err(|error| error.to_string())
    }
}
