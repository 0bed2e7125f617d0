//! The shadow-buffer of Raghuvanshi and Dhande (2004): a t-buffer around the light, on a sphere.
//!
//! Each cell knows what the ray through its centre hits first, exactly. A point is lit if the cell of its direction
//! holds its own object. That is an approximation, because a cell is asked about directions beside its centre: its
//! errors lie within a cell of the edges of shadows and silhouettes, and where an object that is not convex shadows
//! itself. They are measured against the truth ([`Basis::Measured`]).

mod file;
mod fill;
mod footprint;
mod settings;
pub mod sphere;
#[cfg(test)]
mod tests;

pub use settings::{BufferFile, DepthBias, FilterWidth, Lookup, ShadowBufferSettings};

use super::precise::crossed_by_points;
use super::{
    Basis, BuildInput, Counters, Crossings, Lights, Receivers, SceneIndex, ShadowTester, TesterEntry,
};
use crate::error::{Error, Result};
use crate::float_environment::StandardFloats;
use crate::geometry::{LightPosition, LightSpace};
use crate::scene::{Object, Scene};
use crate::visibility::SurfacePoint;
use file::{Cells, Kept, Subject};
use glam::Vec3;
use sphere::{Cell, MOST_CELLS, Sphere};
use std::path::Path;

/// `shadow-buffer` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "shadow-buffer",
    basis: Basis::Measured,
    lights: Lights::AtPoints,
    build: &|input| Ok(Box::new(from_file_or_filled(input)?)),
    of_scene: None,
    expected_tests: |_, queries| queries,
};

fn from_file_or_filled<'a>(input: &BuildInput<'a>) -> Result<ShadowBuffer<'a>> {
    match input.shadow_buffer_file {
        BufferFile::Unused => ShadowBuffer::new(input),
        BufferFile::Load(path) => ShadowBuffer::load(input, path),
        BufferFile::Save(path) => {
            let buffer = ShadowBuffer::new(input)?;
            buffer.save(path)?;
            Ok(buffer)
        }
    }
}

/// The shadow-buffer of one light, good for every view of its scene.
pub struct ShadowBuffer<'a> {
    scene: &'a Scene,
    index: &'a SceneIndex,
    receivers: Receivers,
    space: LightSpace,
    subject: Subject,
    lookup: Lookup,
    filter: FilterWidth,
    /// The share of its distance that something must be nearer than a point to shadow it.
    bias: f64,
    cells: Cells,
    filled: Option<FillCounts>,
}

/// What filling took, and how much it found.
#[derive(Debug, Clone, Copy)]
struct FillCounts {
    tests: u64,
    hit_cells: u64,
}

/// What is compared with what a cell holds.
#[derive(Debug, Clone, Copy)]
enum Asked {
    /// Its object must be this.
    Object(u32),
    /// It must not be nearer than this.
    Distance(f64),
}

impl<'a> ShadowBuffer<'a> {
    /// Fills the buffer of one light.
    ///
    /// # Errors
    /// [`Error::Usage`] for a light infinitely far away, sizes or a bias out of range, or more memory than allowed.
    pub fn new(input: &BuildInput<'a>) -> Result<ShadowBuffer<'a>> {
        let _floats = StandardFloats::new();
        let subject = subject(input)?;
        expect_memory(input, &subject, fill::CELL_BYTES + subject.kept.cell_bytes())?;
        let (scene, Subject { sphere, light, kept, .. }) = (input.scene, &subject);
        let filled = fill::fill(scene, sphere, *light);
        let counts = FillCounts { tests: filled.tests, hit_cells: filled.hit_cells() };
        let cells = Cells {
            objects: if kept.has_objects() { filled.objects(scene) } else { Vec::new() },
            distances: if kept.has_distances() {
                filled.distances(scene, sphere, *light)
            } else {
                Vec::new()
            },
        };
        Ok(ShadowBuffer::of(input, subject, cells, Some(counts)))
    }

    /// Loads the buffer that [`new`](ShadowBuffer::new) would fill, for the same scene, light and size.
    ///
    /// # Errors
    /// As there, or if the file is damaged or holds another buffer.
    pub fn load(input: &BuildInput<'a>, path: &Path) -> Result<ShadowBuffer<'a>> {
        let _floats = StandardFloats::new();
        let subject = subject(input)?;
        // The file's bytes and the cells are there at once.
        expect_memory(input, &subject, 2 * subject.kept.cell_bytes())?;
        let cells = file::load(path, &subject)?;
        Ok(ShadowBuffer::of(input, subject, cells, None))
    }

    /// Saves the buffer, whole or not at all.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        file::save(path, &self.subject, &self.cells)
    }

    fn of(
        input: &BuildInput<'a>,
        subject: Subject,
        cells: Cells,
        filled: Option<FillCounts>,
    ) -> ShadowBuffer<'a> {
        let settings = &input.shadow_buffer;
        ShadowBuffer {
            scene: input.scene,
            index: input.index,
            receivers: input.receivers,
            space: LightSpace::from(subject.light),
            lookup: settings.lookup,
            filter: settings.filter,
            bias: settings.bias.share(&subject.sphere, settings.filter),
            subject,
            cells,
            filled,
        }
    }

    /// The share of the cells around a point's direction that call it lit.
    fn share(&self, point: &SurfacePoint, counters: &mut Counters) -> Result<f32> {
        let direction = point.position - self.subject.light.as_dvec3();
        if direction == glam::DVec3::ZERO {
            // The open segment between a point and itself is empty.
            return Ok(1.0);
        }
        let asked = self.asked(point, direction.length())?;
        let sphere = &self.subject.sphere;
        let cell = sphere.cell(direction);
        let reach = i64::from(self.filter.cells() / 2);
        let around = (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |column| (row, column)));
        let lit =
            around.filter(|&(row, column)| self.is_lit(sphere.neighbour(cell, row, column), asked)).count();
        let looked_at = self.filter.cells().pow(2);
        counters.cells += u64::from(looked_at);
        Ok(lit as f32 / looked_at as f32)
    }

    fn asked(&self, point: &SurfacePoint, distance: f64) -> Result<Asked> {
        let object = point.primitive().map(|p| self.scene.object_index(p));
        match (self.lookup, object) {
            (_, None) if self.receivers == Receivers::Surfaces => Err(Error::Usage(
                "shadow-buffer: built for points on surfaces; build it with Receivers::Anywhere".into(),
            )),
            (Lookup::Identity, Some(object))
                if is_in_buffer(self.scene, &self.scene.objects[object as usize]) =>
            {
                Ok(Asked::Object(object))
            }
            _ => Ok(Asked::Distance(distance * (1.0 - self.bias))),
        }
    }

    fn is_lit(&self, cell: Cell, asked: Asked) -> bool {
        let index = self.subject.sphere.index(cell);
        match asked {
            Asked::Object(object) => self.cells.objects[index] == object,
            Asked::Distance(least) => f64::from(self.cells.distances[index]) >= least,
        }
    }
}

/// Whether an object can be what a cell holds.
fn is_in_buffer(scene: &Scene, object: &Object) -> bool {
    object.shadowing.casts && scene.materials[object.material as usize].transmission.is_none()
}

/// What is kept: distances only where something is looked up by them.
fn kept(input: &BuildInput) -> Kept {
    let scene = input.scene;
    let needs_distance = |object: &Object| {
        object.count + object.curved_count > 0 && object.shadowing.receives && !is_in_buffer(scene, object)
    };
    match input.shadow_buffer.lookup {
        Lookup::Depth => Kept::Distances,
        Lookup::Identity if input.receivers == Receivers::Anywhere => Kept::Both,
        Lookup::Identity if scene.objects.iter().any(needs_distance) => Kept::Both,
        Lookup::Identity => Kept::Objects,
    }
}

/// What the buffer is to be of.
fn subject(input: &BuildInput) -> Result<Subject> {
    let LightPosition::At(light) = input.light else {
        return Err(Error::Usage(
            "shadow-buffer: a light infinitely far away has no sphere of directions around it; ask another tester"
                .into(),
        ));
    };
    let settings = &input.shadow_buffer;
    let sphere = Sphere::new(settings.rows, settings.columns).ok_or_else(|| {
        let (rows, columns) = (settings.rows, settings.columns);
        Error::Usage(format!("shadow-buffer: {rows}x{columns} cells; expected 1 to {MOST_CELLS} each"))
    })?;
    if let DepthBias::Share(share) = settings.bias
        && !(0.0..1.0).contains(&share)
    {
        return Err(Error::Usage(format!("shadow-buffer: a bias of {share}; expected 0 to below 1")));
    }
    Ok(Subject { scene_hash: input.scene.hash(), light, sphere, kept: kept(input) })
}

fn expect_memory(input: &BuildInput, subject: &Subject, cell_bytes: u64) -> Result<()> {
    let sphere = &subject.sphere;
    let what = format!("a shadow-buffer of {}x{} cells", sphere.rows(), sphere.columns());
    input.memory.check(what, sphere.cells() * cell_bytes)
}

impl ShadowTester for ShadowBuffer<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let _floats = StandardFloats::new();
        let mut counters = Counters::default();
        for (point, answer) in points.iter().zip(answers) {
            // The number of cells is odd: there is no tie.
            *answer = self.share(point, &mut counters)? < 0.5;
        }
        Ok(counters)
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        let _floats = StandardFloats::new();
        Ok(crossed_by_points(self.scene, self.index, &self.space, points, crossings))
    }

    fn lit_share(&self, points: &[SurfacePoint], shares: &mut [f32]) -> Result<Option<Counters>> {
        let _floats = StandardFloats::new();
        if self.filter == FilterWidth::OFF {
            return Ok(None);
        }
        let mut counters = Counters::default();
        for (point, share) in points.iter().zip(shares) {
            *share = self.share(point, &mut counters)?;
        }
        Ok(Some(counters))
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.cells.objects[..]) + size_of_val(&self.cells.distances[..])
    }

    fn statistics(&self) -> Vec<(&'static str, String)> {
        let sphere = &self.subject.sphere;
        let lookup = match self.lookup {
            Lookup::Identity => "by identity".into(),
            Lookup::Depth => format!("by depth with a bias of {:.3e}", self.bias),
        };
        let mut lines = vec![
            ("cells", format!("{} x {}", sphere.rows(), sphere.columns())),
            ("look-up", lookup),
            ("filter", format!("{0} x {0}", self.filter.cells())),
        ];
        match self.filled {
            None => lines.push(("filled", "no, loaded".into())),
            Some(FillCounts { tests, hit_cells }) => {
                let share = 100.0 * hit_cells as f64 / sphere.cells() as f64;
                lines.push(("rays tested to fill it", tests.to_string()));
                lines.push(("cells that hold something", format!("{share:.1} %")));
            }
        }
        lines
    }
}

impl ShadowBuffer<'_> {
    /// The light that it is of.
    pub fn light(&self) -> Vec3 {
        self.subject.light
    }

    /// How its directions are divided.
    pub fn sphere(&self) -> Sphere {
        self.subject.sphere
    }
}
