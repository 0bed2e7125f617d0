//! The light buffer as it is for speed: [certified cells](super::certified) of all that a light sees, kept for every view.
//!
//! It answers what the [light buffer of 1986](super::light_buffer) does, whose options choose that one.

use super::certified::{BuildQuality, Certified, Kept, usual_bytes};
use super::light_buffer::LightBuffer;
use super::rest::Rest;
use super::{
    Basis, Batching, BuildInput, Counters, Crossings, Culling, Lights, ObjectCoherence, Resolution,
    ShadowTester, TesterEntry, VolumeThreshold,
};
use crate::error::Result;
use crate::geometry::LightPosition;
use crate::visibility::{Points, RoundedPoint, SurfacePoint};
use glam::Vec3;

/// `light-buffer` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "light-buffer",
    basis: Basis::Exact,
    lights: Lights::All,
    build: &|input| build(input, BuildQuality::Medium),
    of_scene: None,
    expected_tests: |_, queries| 10.0 * queries,
};

/// `light-buffer-high`: the same built for many views, as hierarchies of high quality are, with a verdict on every triangle.
pub const HIGH: TesterEntry =
    TesterEntry { name: "light-buffer-high", build: &|input| build(input, BuildQuality::High), ..ENTRY };

/// Certified cells know lights at points, and none of the options of 1986.
fn build<'a>(input: &BuildInput<'a>, quality: BuildQuality) -> Result<Box<dyn ShadowTester + 'a>> {
    let is_plain = input.culling == Culling::Off
        && input.bounding_volumes == VolumeThreshold::Off
        && input.object_coherence == ObjectCoherence::Off;
    match input.light {
        LightPosition::At(light) if is_plain => Ok(Box::new(KeptLightBuffer::new(input, light, quality)?)),
        _ => Ok(Box::new(LightBuffer::new(input)?)),
    }
}

/// Cells of one light at a point, good for every view of its scene.
pub struct KeptLightBuffer<'a> {
    whole: Kept<'a>,
    rest: Rest<'a>,
}

impl<'a> KeptLightBuffer<'a> {
    /// Makes all cells.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::error::Error::Usage) for a resolution outside 1 to 4096, or too little memory; those of a light buffer, where one is needed
    /// beside.
    pub fn new(input: &BuildInput<'a>, light: Vec3, quality: BuildQuality) -> Result<KeptLightBuffer<'a>> {
        let certified =
            Certified { scene: input.scene, light, set: input.instruction_set, memory: input.memory };
        let whole = match input.resolution {
            Resolution::Auto => certified.keep_within(usual_bytes(input.scene), quality)?,
            Resolution::Cells(cells) => certified.keep(cells, quality)?,
        };
        Ok(KeptLightBuffer { whole, rest: Rest::new(input)? })
    }
}

impl ShadowTester for KeptLightBuffer<'_> {
    fn batching(&self) -> Batching {
        match self.rest.is_empty() {
            true => Batching::Whole,
            false => Batching::Chunks,
        }
    }

    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        self.occluded_at(Points::new(&RoundedPoint::all(points), points), answers)
    }

    fn occluded_at(&self, points: Points<'_>, answers: &mut [bool]) -> Result<Counters> {
        let mut counters = self.whole.occluded(points, answers);
        counters += self.rest.add_occluded(points.exact(), answers)?;
        Ok(counters)
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        self.rest.crossed(points, crossings)
    }

    fn bytes(&self) -> usize {
        self.whole.bytes() + self.rest.bytes()
    }

    fn statistics(&self) -> Vec<(&'static str, String)> {
        let work = self.whole.work();
        let share = |part: u64| format!("{:.1} %", 100.0 * part as f64 / work.cells.max(1) as f64);
        let mut statistics = vec![
            ("resolution", work.resolution.to_string()),
            ("cells built", work.cells.to_string()),
            ("non-empty cells", share(work.touched)),
            ("cells covered once by their nearest surface", share(work.once)),
            ("cells covered by another", share(work.covered)),
            ("triangles in cells", work.entries.to_string()),
        ];
        if let Some([lit, dark]) = self.whole.whole_triangles() {
            statistics.push(("triangles lit as a whole", lit.to_string()));
            statistics.push(("triangles dark as a whole", dark.to_string()));
        }
        statistics
    }
}
