//! Every shadow tester there is. A tester that is not here is not cross-checked, and a test says so.

use super::shadow_buffer::{BufferFile, ShadowBufferSettings};
use super::{
    Culling, ObjectCoherence, Receivers, Resolution, SceneIndex, ShadowTester, VolumeThreshold, auto,
    bounding_volumes, brute_force, exact, irregular_z_buffer, kept_light_buffer, shadow_buffer,
};
use crate::error::{Error, Result};
use crate::geometry::LightPosition;
use crate::geometry::batch::InstructionSet;
use crate::memory::MemoryLimit;
use crate::scene::Scene;

/// What a tester's answers rest on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// Exact arithmetic that shares no predicate or culling with anything it judges.
    Truth,
    /// A native tester that claims to be exact: one wrong answer is a failure.
    Exact,
    /// Answers whose error is measured and reported.
    Measured,
}

/// Lights that a tester can be built for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lights {
    /// Any.
    All,
    /// Those at a point, and not infinitely far away.
    AtPoints,
}

impl Lights {
    /// Whether this is one of them.
    pub fn has(self, light: LightPosition) -> bool {
        self == Lights::All || matches!(light, LightPosition::At(_))
    }
}

/// All that building a tester for one light needs.
#[derive(Clone, Copy)]
pub struct BuildInput<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// What was made of the scene for all lights.
    pub index: &'a SceneIndex,
    /// Where the light is.
    pub light: LightPosition,
    /// Cells along a cube face, for testers that have such.
    pub resolution: Resolution,
    /// Where the queries come from.
    pub receivers: Receivers,
    /// What may be left out.
    pub culling: Culling,
    /// When lists of cells get bounding-volume records.
    pub bounding_volumes: VolumeThreshold,
    /// Whether the last occluder is tried first.
    pub object_coherence: ObjectCoherence,
    /// The shadow-buffer's settings.
    pub shadow_buffer: ShadowBufferSettings,
    /// Whether the shadow-buffer is saved, or loaded and not filled.
    pub shadow_buffer_file: BufferFile<'a>,
    /// Embree's settings.
    pub embree: EmbreeSettings,
    /// The most memory that it may need.
    pub memory: MemoryLimit,
    /// What kernels run on, one that this machine has. No answer depends on it.
    pub instruction_set: InstructionSet,
}

impl<'a> BuildInput<'a> {
    /// A light over the surfaces of a scene, everything else as usual: resolution `auto`, Embree with its
    /// usual epsilon, no limit on memory, the widest instructions.
    pub fn new(scene: &'a Scene, index: &'a SceneIndex, light: impl Into<LightPosition>) -> BuildInput<'a> {
        BuildInput {
            scene,
            index,
            light: light.into(),
            resolution: Resolution::Auto,
            receivers: Receivers::Surfaces,
            culling: Culling::Off,
            bounding_volumes: VolumeThreshold::Off,
            object_coherence: ObjectCoherence::Off,
            shadow_buffer: ShadowBufferSettings::default(),
            shadow_buffer_file: BufferFile::Unused,
            embree: EmbreeSettings::default(),
            memory: MemoryLimit::NONE,
            instruction_set: InstructionSet::best(),
        }
    }
}

/// How Embree is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EmbreeSettings {
    /// Rays run from `epsilon` to 1 - `epsilon` of the segment.
    pub epsilon: f32,
    /// Threads that Embree may build with; 0 means as many as the machine has.
    pub threads: usize,
}

impl Default for EmbreeSettings {
    /// All threads, and the epsilon that renderers usually give it, as a share of the segment (pbrt's shadow
    /// epsilon).
    fn default() -> EmbreeSettings {
        EmbreeSettings { epsilon: 1e-4, threads: 0 }
    }
}

/// How a tester is built: a closure, because testers that differ in a parameter share the code.
pub type Build = dyn for<'a> Fn(&BuildInput<'a>) -> Result<Box<dyn ShadowTester + 'a>> + Send + Sync;

/// What of a tester belongs to the scene and serves all its lights.
pub trait SceneTester: Send + Sync {
    /// The tester of a light, with the settings that this was built with. That takes no time to speak of.
    fn under(&self, light: LightPosition) -> Box<dyn ShadowTester>;

    /// Memory in bytes.
    fn bytes(&self) -> usize;
}

/// How that is built; the light of the input means nothing.
pub type BuildOfScene = dyn for<'a> Fn(&BuildInput<'a>) -> Result<Box<dyn SceneTester + 'a>> + Send + Sync;

/// A tester by name.
pub struct TesterEntry {
    /// The name on the command line and in reports.
    pub name: &'static str,
    /// What its answers rest on.
    pub basis: Basis,
    /// The lights that it can be built for.
    pub lights: Lights,
    /// Builds it for one light.
    pub build: &'static Build,
    /// How its part of the scene is built, if it has one that serves all lights: that is kept where a light moves and no object
    /// does.
    pub of_scene: Option<&'static BuildOfScene>,
    /// Expected number of triangle tests for a number of casters and queries.
    pub expected_tests: fn(casters: f64, queries: f64) -> f64,
}

/// Testers that are asked unless others are named; the first is the arbiter.
pub const REGISTRY: &[TesterEntry] = &[
    exact::ENTRY,
    brute_force::ENTRY,
    bounding_volumes::ENTRY,
    kept_light_buffer::ENTRY,
    irregular_z_buffer::ENTRY,
    shadow_buffer::ENTRY,
    #[cfg(feature = "embree")]
    super::embree::ROBUST,
    #[cfg(feature = "embree")]
    super::embree::FAST,
];

/// Testers that are asked if they are named: one that chooses among those of the registry, and one of them built for many views.
pub const BESIDE: [&TesterEntry; 2] = [&auto::ENTRY, &kept_light_buffer::HIGH];

/// What names beside those of the registry look like.
#[cfg(feature = "embree")]
const MODE_NAMES: Option<&str> = Some(crate::embree::EmbreeMode::GRAMMAR);
#[cfg(not(feature = "embree"))]
const MODE_NAMES: Option<&str> = None;

/// Every tester that has a name: those of [`REGISTRY`], after them `auto`, which chooses among them, and `light-buffer-high`, and then one for each
/// [`EmbreeMode`](crate::embree::EmbreeMode).
pub fn testers() -> impl Iterator<Item = &'static TesterEntry> {
    #[cfg(feature = "embree")]
    let modes = super::embree::MODES.iter();
    #[cfg(not(feature = "embree"))]
    let modes = std::iter::empty();
    REGISTRY.iter().chain(BESIDE).chain(modes)
}

/// The tester of a name.
///
/// # Errors
/// [`Error::Usage`] that lists the names there are.
pub fn find(name: &str) -> Result<&'static TesterEntry> {
    testers().find(|entry| entry.name == name).ok_or_else(|| {
        let names: Vec<_> = REGISTRY.iter().chain(BESIDE).map(|entry| entry.name).chain(MODE_NAMES).collect();
        let missing = if cfg!(feature = "embree") { "" } else { " (built without the feature `embree`)" };
        Error::Usage(format!("no shadow tester `{name}`{missing}; there are: {}", names.join(", ")))
    })
}
