//! The measurements behind the figures of the t-buffer paper: the classical tracer against the t-buffer, and brute
//! force against the shadow-buffer, over scenes of more and more objects.
//!
//! Both tracers share every routine but the one that is compared, as in REALITY (section V of the paper), and run on
//! the same threads. Reflections and textures play no part in the times, as there.

mod contender;
mod frame;
mod quality;

pub use contender::{Contender, buffer_of_rows};
pub use frame::{MeasuredFrame, MeasuredHits, MeasuredTester, measure};
pub use quality::{Judged, JudgedTester, answers_of, judged};

use crate::error::Result;
use crate::memory::MemoryLimit;
use crate::scene::procedural::find;
use crate::scene::{ImageSize, Scene};

/// How thoroughly things are timed.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    /// The size of the images.
    pub size: ImageSize,
    /// The most times that anything is done to time it.
    pub repetitions: u32,
    /// The most that a buffer may need.
    pub memory: MemoryLimit,
}

/// What a stack is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectKind {
    /// The paper's choice for its figures.
    Spheres,
    /// The other kind that it names.
    Triangles,
}

impl ObjectKind {
    /// Both.
    pub const ALL: [ObjectKind; 2] = [ObjectKind::Spheres, ObjectKind::Triangles];

    /// In reports and file names.
    pub fn name(self) -> &'static str {
        match self {
            ObjectKind::Spheres => "spheres",
            ObjectKind::Triangles => "triangles",
        }
    }

    /// So many of them, stacked.
    ///
    /// # Errors
    /// If the built-in scene cannot hold so many.
    pub fn stacked(self, objects: u32) -> Result<Scene> {
        find(&format!("stacked-{}", self.name()))?.build(Some(objects))
    }
}

/// Stacks of more and more objects of a kind.
#[derive(Debug, Clone)]
pub struct Series {
    /// Of what.
    pub kind: ObjectKind,
    /// In ascending order of their numbers of objects.
    pub frames: Vec<MeasuredFrame>,
}
