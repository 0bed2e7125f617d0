//! The columns of the 1986 paper's tables: how a tester is set up for each, and what it did.

use crate::error::Result;
use crate::memory::MemoryLimit;
use crate::shadow::light_buffer::{LightBuffer, Occupancy};
use crate::shadow::{
    BuildInput, Counters, Culling, ObjectCoherence, Resolution, ShadowTester, VolumeThreshold,
    bounding_volumes,
};

/// Polygons of one object in a square that the paper leaves without a bounding volume.
const VOLUME_THRESHOLD: u32 = 6;

/// A column of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// Bounding volumes around objects, clustered.
    Control,
    /// A light buffer of so many squares along an edge.
    Buffer(u32),
}

impl Column {
    /// `control`, or `R = 100`.
    pub fn name(self) -> String {
        match self {
            Column::Control => "control".into(),
            Column::Buffer(resolution) => format!("R = {resolution}"),
        }
    }

    /// Squares along an edge, if it has some.
    pub fn resolution(self) -> Option<u32> {
        match self {
            Column::Control => None,
            Column::Buffer(resolution) => Some(resolution),
        }
    }

    /// Whether the headers of a buffer, opaque and transparent, fit into memory beside as many records.
    pub(super) fn fits(self, memory: MemoryLimit) -> bool {
        const BYTES_A_SQUARE: u64 = 40;
        let squares = 6 * u64::from(self.resolution().unwrap_or(0)).pow(2);
        memory.check("a light buffer", squares * BYTES_A_SQUARE).is_ok()
    }

    /// Builds the tester of one light, with the paper's settings.
    pub(super) fn build<'a>(self, usual: &BuildInput<'a>) -> Result<Built<'a>> {
        match self {
            Column::Control => Ok(Built::Control((bounding_volumes::ENTRY.build)(usual)?)),
            Column::Buffer(resolution) => Ok(Built::Buffer(Box::new(LightBuffer::new(&BuildInput {
                resolution: Resolution::Cells(resolution),
                culling: Culling::ClosedSolids,
                bounding_volumes: VolumeThreshold::MoreThan(VOLUME_THRESHOLD),
                object_coherence: ObjectCoherence::Off,
                ..*usual
            })?))),
        }
    }
}

/// The tester of a column at one light.
pub(super) enum Built<'a> {
    Control(Box<dyn ShadowTester + 'a>),
    Buffer(Box<LightBuffer<'a>>),
}

impl<'a> Built<'a> {
    pub fn tester(&self) -> &(dyn ShadowTester + 'a) {
        match self {
            Built::Control(tester) => tester.as_ref(),
            Built::Buffer(buffer) => buffer.as_ref(),
        }
    }

    pub fn occupancy(&self) -> Option<Occupancy> {
        match self {
            Built::Control(_) => None,
            Built::Buffer(buffer) => Some(buffer.occupancy()),
        }
    }
}

/// What a column's testers did at all lights of a scene, for one view of it.
#[derive(Debug, Clone)]
pub struct MeasuredColumn {
    /// Which column.
    pub column: Column,
    /// Seconds to build: for each light the median of some repetitions. 0 for a view whose buffers were there
    /// already.
    pub build_seconds: f64,
    /// Seconds to answer all queries, likewise.
    pub query_seconds: f64,
    /// The work of one repetition.
    pub counters: Counters,
    /// Memory of all lights' testers together.
    pub bytes: u64,
    /// What was built, if these are light buffers.
    pub lists: Option<Lists>,
    /// Sampled answers that are not the arbiter's.
    pub wrong: u64,
    /// Answers of all that are not the control's.
    pub unlike_control: u64,
}

impl MeasuredColumn {
    pub(super) fn new(column: Column) -> MeasuredColumn {
        MeasuredColumn {
            column,
            build_seconds: 0.0,
            query_seconds: 0.0,
            counters: Counters::default(),
            bytes: 0,
            lists: None,
            wrong: 0,
            unlike_control: 0,
        }
    }
}

/// The lists of the light buffers of all lights.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Lists {
    /// Sums over the lights, but for the longest list: that of all.
    pub all: Occupancy,
    /// The lights.
    pub lights: u64,
    /// Sum of the items of each light's longest list.
    pub longest_lists: u64,
}

impl Lists {
    pub(super) fn add(&mut self, of_light: Occupancy) {
        self.lights += 1;
        self.longest_lists += of_light.longest;
        self.all.squares += of_light.squares;
        self.all.opaque += of_light.opaque;
        self.all.transparent += of_light.transparent;
        self.all.bounding_volumes += of_light.bounding_volumes;
        self.all.full_occlusions += of_light.full_occlusions;
        self.all.non_empty += of_light.non_empty;
        self.all.longest = self.all.longest.max(of_light.longest);
    }

    /// The paper's number of list items per square.
    pub fn items_per_square(&self) -> f64 {
        self.all.items() as f64 / self.all.squares as f64
    }

    /// The paper's nonzero grid squares percentage.
    pub fn non_empty_percent(&self) -> f64 {
        100.0 * self.all.non_empty as f64 / self.all.squares as f64
    }

    /// The paper's average maximum of list items.
    pub fn average_maximum(&self) -> f64 {
        self.longest_lists as f64 / self.lights as f64
    }
}
