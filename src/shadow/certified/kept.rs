//! Cells of all that a light sees, kept for whatever is asked later: the light buffer.

use super::answer::{Answering, Asked, QUERIES, sum};
use super::automatic;
use super::bins::{Budget, touched};
use super::by_triangle::{ByTriangle, States};
use super::layers::is_crowded;
use super::levels::{FINER, Levels};
use super::making::Lists;
use super::projection::{Projected, Projector};
use super::receivers::Horizon;
use super::selected::{CHUNK, Selected};
use super::stored::{Header, Record, Run};
use super::survey::Cast;
use super::tiles::{AREA, TileGrid};
use super::windows::Windows;
use super::{BuildQuality, Certified, Counters, MOST_BYTES, MOST_CELLS, Work};
use crate::error::Result;
use crate::float_environment::StandardFloats;
use crate::geometry::LightSpace;
use crate::memory::MemoryLimit;
use crate::visibility::{Points, RoundedPoint};
use rayon::prelude::*;

/// The resolution at which is looked where triangles lie.
const FEW_CELLS: u32 = 256;

/// Levels of cells where nobody says how many cells there are to be.
const LEVELS: usize = 2;

/// Resolutions are looked at in these steps.
const STEP: u32 = 64;

/// Fewer than this save no memory that would be worth it.
const LEAST_CELLS: u32 = 32;

/// More cells on a side than so many for each triangle are of no use: small scenes are as fast with few.
const MOST_A_TRIANGLE: u64 = 64;

/// Headers and lists of all cells that a light's triangles lie in.
pub struct Kept<'a> {
    certified: Certified<'a>,
    space: LightSpace,
    cast: Cast,
    /// No coordinate of a triangle is larger.
    size: f32,
    levels: Levels,
    /// The scene's vertices, on the finest cells.
    projected: Vec<Projected>,
    lists: Lists,
    /// Of high quality.
    by_triangle: Option<ByTriangle>,
    work: Work,
}

/// What needs memory, in words.
fn what(resolution: u32) -> String {
    format!("a light buffer of {resolution} cells along an edge")
}

impl<'a> Certified<'a> {
    /// Makes cells that are good for any query. With fewer than asked for where their lists would be longer than lists are made, whatever
    /// memory there is: thousands of triangles before one another that fill every cell. [`Kept::work`] says how many there are.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::error::Error::Usage) for a resolution outside 1 to 4096, 2^28 triangles and more, or more memory than there may be.
    pub fn keep(self, resolution: u32, quality: BuildQuality) -> Result<Kept<'a>> {
        let _floats = StandardFloats::new();
        let memory = self.checked(resolution, 0)?;
        self.keep_at_most(resolution, 1, quality, memory)
    }

    /// The same with as many cells as are of use and need no more than so many bytes, if that can be: large ones, and small ones
    /// where many triangles lie.
    ///
    /// # Errors
    /// As [`keep`](Certified::keep), if the fewest cells need too much.
    pub fn keep_within(self, bytes: u64, quality: BuildQuality) -> Result<Kept<'a>> {
        let _floats = StandardFloats::new();
        let memory = self.checked(1, 0)?;
        let mut resolution = self.resolution_within(bytes, memory);
        loop {
            let kept = self.keep_at_most(resolution, LEVELS, quality, memory);
            let is_small = kept.as_ref().is_ok_and(|kept| kept.bytes() as u64 <= bytes);
            if is_small || resolution <= LEAST_CELLS {
                return kept;
            }
            // What cells need grows with their number.
            let share = kept.map_or(0.5, |kept| (bytes as f64 / kept.bytes() as f64).sqrt().clamp(0.25, 1.0));
            resolution = (f64::from(resolution) * share * 0.95) as u32;
        }
    }

    /// The most cells for which so many bytes are to be expected: what a few cells show of the part of the directions in which triangles
    /// lie, and many of them, a header each, records of triangles in so many cells as they are wide and high, and vertices.
    fn resolution_within(&self, bytes: u64, memory: MemoryLimit) -> u32 {
        let projector = Projector::new(self.light, FEW_CELLS);
        let grid = TileGrid::new(FEW_CELLS);
        let (projected, horizon) = (self.projected(&projector), Horizon::endless(&grid));
        let windows = Windows::whole(&grid);
        let mut survey = self.survey(projector, windows, &horizon, &projected);
        let budget = Budget::new(memory.left().min(MOST_BYTES) as usize);
        let Some(bins) = self.bins(&mut survey, &budget) else { return LEAST_CELLS };
        // Of small cells the crowded tiles have as many as all would, if the others had them.
        let tiles = touched(&bins, &windows).map(|tile| match is_crowded(&bins, tile) {
            true => f64::from(FINER * FINER),
            false => 1.0,
        });
        let tiles: f64 = tiles.sum();
        let triangles = self.scene.triangles.len() as u64;
        let a_cell = (size_of::<Header>() + size_of::<Run>() + size_of::<Record>()) as f64;
        let size = self.size_of_triangles();
        let expected = |resolution: u32| {
            let large = f64::from(resolution) / f64::from(FINER * FEW_CELLS);
            let across = size * f64::from(resolution) / f64::from(automatic::CELLS);
            let of_records = triangles as f64 * (2.0 + across) * size_of::<Record>() as f64;
            (tiles * f64::from(AREA) * large * large * a_cell + of_records) as u64 + self.fixed_bytes() as u64
        };
        let is_enough = |resolution: &u32| {
            expected(*resolution) <= bytes && u64::from(*resolution).pow(2) <= MOST_A_TRIANGLE * triangles
        };
        let steps = (FEW_CELLS / STEP..=MOST_CELLS / STEP).map(|step| step * STEP);
        steps.rev().find(is_enough).unwrap_or(FEW_CELLS)
    }

    /// A limit that somebody set is kept by refusing, and that of all lists by taking fewer cells.
    fn keep_at_most(
        &self,
        resolution: u32,
        levels: usize,
        quality: BuildQuality,
        memory: MemoryLimit,
    ) -> Result<Kept<'a>> {
        self.with_fewer_cells(resolution, |cells| match self.keep_at(cells, levels, quality, memory)? {
            None if memory.left() <= MOST_BYTES => Err(memory.exceeded(what(cells))),
            kept => Ok(kept),
        })
    }

    /// `None` if lists are too long.
    fn keep_at(
        &self,
        resolution: u32,
        levels: usize,
        quality: BuildQuality,
        memory: MemoryLimit,
    ) -> Result<Option<Kept<'a>>> {
        let resolution = resolution.next_multiple_of(Levels::unit(levels));
        // Projections of all but one level are needed while lists are made.
        let of_levels = (levels - 1) * self.scene.vertices.len() * size_of::<Projected>()
            + TileGrid::new(resolution).count() * (size_of::<u32>() + size_of::<u64>())
            + if quality == BuildQuality::High { self.scene.triangles.len() } else { 0 };
        let memory = memory.beside(what(resolution), of_levels as u64)?;
        let budget = Budget::new(memory.left().min(MOST_BYTES) as usize);
        let Some(layers) = self.layers(resolution, levels, &budget) else { return Ok(None) };
        let (bin_bytes, cast) = (layers.bin_bytes(), layers.cast);
        let needed = layers.cell_bytes() + bin_bytes;
        let left = memory.beside(what(resolution), needed as u64)?.left();
        let states = (quality == BuildQuality::High).then(|| States::new(self.scene.triangles.len()));
        let Some(lists) =
            self.lists_of(&layers, states.as_ref(), &Budget::new(left.min(MOST_BYTES) as usize))
        else {
            return Ok(None);
        };
        let (levels, projected) = layers.into_finest();
        let by_triangle = states.map(States::finish);
        let bytes_by_triangle = by_triangle.as_ref().map_or(0, ByTriangle::bytes);
        let kept = levels.bytes() + size_of_val(&projected[..]) + lists.bytes() + bytes_by_triangle;
        let work = Work { bytes: (kept + bin_bytes) as u64, ..lists.work(levels.projector.resolution) };
        let (certified, space, size) = (*self, LightSpace::from(self.light), self.size());
        Ok(Some(Kept { certified, space, cast, size, levels, projected, lists, by_triangle, work }))
    }
}

impl Kept<'_> {
    /// Sets `occluded[i]` to whether one of the triangles blocks the open segment between point i and the light.
    pub fn occluded(&self, points: Points<'_>, occluded: &mut [bool]) -> Counters {
        (points.par_chunks(QUERIES), occluded.par_chunks_mut(QUERIES))
            .into_par_iter()
            .map(|(points, occluded)| self.some(points, occluded))
            .reduce(Counters::default, sum)
    }

    /// How many triangles are lit as a whole, and dark, if somebody looked.
    pub fn whole_triangles(&self) -> Option<[u64; 2]> {
        self.by_triangle.as_ref().map(ByTriangle::counts)
    }

    /// What making it took.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.levels.bytes()
            + size_of_val(&self.projected[..])
            + self.lists.bytes()
            + self.by_triangle.as_ref().map_or(0, ByTriangle::bytes)
    }

    fn some(&self, points: Points<'_>, occluded: &mut [bool]) -> Counters {
        let _floats = StandardFloats::new();
        let Certified { scene, set, .. } = self.certified;
        let asked = Asked {
            certified: self.certified,
            cast: self.cast,
            projector: &self.levels.projector,
            space: &self.space,
            size: self.size,
            projected: &self.projected,
            lists: &self.lists,
            has_verdicts: self.by_triangle.is_some(),
        };
        let mut answering = Answering::new(&asked);
        let (mut cells, mut depths) = ([0; CHUNK], [0.0; CHUNK]);
        let open_of_chunk = if self.by_triangle.is_some() { CHUNK } else { 0 };
        let (mut numbers, mut rounded) =
            (vec![0; open_of_chunk], vec![RoundedPoint::default(); open_of_chunk]);
        for (i, chunk) in points.chunks(CHUNK).enumerate() {
            let first = i * CHUNK;
            let occluded = &mut occluded[first..first + chunk.len()];
            let mut open = Selected::all(chunk);
            if let Some(by_triangle) =
                self.by_triangle.as_ref().filter(|of| of.is_worth_asking(chunk.rounded()))
            {
                let count = by_triangle.answer(set, chunk.rounded(), occluded, &mut numbers, &mut rounded);
                open = Selected::new(&rounded[..count], &numbers[..count], chunk.exact());
            }
            let (cells, depths) = (&mut cells[..open.len()], &mut depths[..open.len()]);
            self.levels.find(set, scene, open, cells, depths);
            answering.add(first, open, cells, depths, occluded);
        }
        answering.finish(points, occluded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::batch::InstructionSet;
    use crate::geometry::occlusion::PreciseQuery;
    use crate::geometry::planes;
    use crate::memory::MemoryLimit;
    use crate::scene::{ObjectInput, Scene, SceneBuilder};
    use crate::shadow::precise;
    use crate::visibility::SurfacePoint;
    use glam::Vec3;
    use proptest::prelude::*;

    /// Before a light in the origin, with few bits: many of them are on a plane or a line.
    fn corner() -> impl Strategy<Value = Vec3> {
        (-6i8..7, -6i8..7, 8i8..20).prop_map(|(x, y, z)| Vec3::new(x.into(), y.into(), z.into()) * 0.125)
    }

    /// A sheet of a grid's triangles behind loose ones of few vertices, as meshes with shared and with own vertices.
    fn scene() -> impl Strategy<Value = Scene> {
        let triangle = prop::sample::subsequence((0u32..10).collect::<Vec<_>>(), 3).prop_shuffle();
        let loose = (prop::collection::vec(corner(), 10), prop::collection::vec(triangle, 1..12));
        let heights = prop::collection::vec(0i8..6, 25);
        (loose, heights, 1i8..12, any::<bool>()).prop_map(
            |((vertices, triangles), heights, depth, is_shared)| {
                let mut builder = SceneBuilder::new("kept");
                let triangles: Vec<[u32; 3]> = triangles.iter().map(|of| [of[0], of[1], of[2]]).collect();
                builder.add_object(ObjectInput::new("loose", vertices, triangles)).expect("in range");
                let at = |i: usize| {
                    let (x, y) = ((i % 5) as f32 - 2.0, (i / 5) as f32 - 2.0);
                    Vec3::new(
                        0.5 * x,
                        0.5 * y,
                        1.0 + 0.125 * f32::from(depth) + 0.0625 * f32::from(heights[i]),
                    )
                };
                let quads = (0..16u32).map(|i| i / 4 * 5 + i % 4);
                let triangles =
                    quads.flat_map(|i| [[i, i + 1, i + 6], [i, i + 6, i + 5]]).collect::<Vec<_>>();
                let grid: Vec<_> = (0..25).map(at).collect();
                let sheet = match is_shared {
                    true => ObjectInput::new("sheet", grid, triangles),
                    false => {
                        let own = triangles.iter().flatten().map(|&i| grid[i as usize]).collect();
                        let count = triangles.len() as u32;
                        ObjectInput::new(
                            "sheet",
                            own,
                            (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
                        )
                    }
                };
                builder.add_object(sheet).expect("in range");
                builder.finish()
            },
        )
    }

    /// Points of all triangles, on corners and edges too, each seen from the light: whether anything is before it or not.
    fn points(scene: &Scene) -> Vec<SurfacePoint> {
        let mut points = Vec::new();
        for triangle in 0..scene.triangles.len() as u32 {
            let corners @ [a, b, c] = scene.corners(triangle);
            if planes::oriented(Vec3::ZERO, corners).is_none() {
                continue;
            }
            for (s, t) in (0..=4).flat_map(|i| (0..=4 - i).map(move |j| (i as f32 / 4.0, j as f32 / 4.0))) {
                let at = a + s * (b - a) + t * (c - a);
                points.push(SurfacePoint::on_ray(scene, Vec3::ZERO, at, triangle));
            }
        }
        points
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]
        #[test]
        fn every_point_of_every_triangle_gets_the_exact_answer(
            scene in scene(),
            resolution in prop::sample::select(vec![None, Some(1u32), Some(2), Some(8), Some(9), Some(64)]),
            quality in prop::sample::select(vec![BuildQuality::Medium, BuildQuality::High, BuildQuality::High]),
        ) {
            let light = Vec3::ZERO;
            let exact = points(&scene);
            let rounded = RoundedPoint::all(&exact);
            let space = LightSpace::from(light);
            let mut expected = Vec::new();
            for point in &exact {
                let query = PreciseQuery::new(&space, point.position, || point.exact(&scene));
                let mut counters = Counters::default();
                let mut blocks = |triangle| precise::blocks(&scene, triangle, point.primitive(), &query, &mut counters);
                expected.push((0..scene.triangles.len() as u32).any(&mut blocks));
            }
            for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
                let certified = Certified { scene: &scene, light, set, memory: MemoryLimit::of_this_machine() };
                let kept = match resolution {
                    Some(resolution) => certified.keep(resolution, quality),
                    None => certified.keep_within(1 << 20, quality),
                };
                let kept = kept.expect("enough memory");
                let mut found = vec![false; exact.len()];
                kept.occluded(Points::new(&rounded, &exact), &mut found);
                for ((point, found), expected) in exact.iter().zip(&found).zip(&expected) {
                    prop_assert_eq!(found, expected, "{:?} at {:?}", point, kept.work().resolution);
                }
            }
        }
    }
}
