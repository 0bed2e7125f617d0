//! One view of the scene: what is seen, who is asked, and what it looks like.

use super::{Column, MeasuredColumn, MeasuredView, Plan, TruthCounts};
use crate::measure::{Answers, Repeated, timed};
use crate::scene::{Camera, ImageSize, Light, Scene};
use crate::shading::{RayForest, Textures, TreeRules, shade_picture};
use crate::shadow::Queries;
use crate::visibility::{VisibleSurfaces, t_buffer};

/// A camera at a scene.
#[derive(Debug, Clone)]
pub struct ViewOfScene {
    /// The camera.
    pub camera: Camera,
    /// The size of the image.
    pub size: ImageSize,
    /// Seconds that making the scene for this view took.
    pub scene_seconds: f64,
}

/// A view while its lights are measured.
pub(super) struct Look {
    camera: Camera,
    forest: RayForest,
    /// For each light the share that arrives at each node of the forest.
    arriving: Vec<Vec<[f32; 3]>>,
    pub measured: MeasuredView,
}

impl Look {
    /// Finds first hits and grows the ray trees.
    pub fn new(scene: &Scene, view: &ViewOfScene, plan: &Plan) -> Look {
        let mut times = Repeated::default();
        let mut grow = || {
            let grown = timed(|| {
                let hits = t_buffer::first_hits(scene, &view.camera, view.size);
                let visible = VisibleSurfaces::new(scene, &view.camera, &hits);
                RayForest::grow(scene, visible, view.size.pixels() as u64, TreeRules::of_depth(plan.depth))
            });
            times.push(grown.seconds);
            (grown.value, times.clone())
        };
        let (mut forest, mut spent) = grow();
        while spent.is_worth_another(plan.repetitions) {
            (forest, spent) = grow();
        }
        let columns =
            [Column::Control].into_iter().chain(plan.resolutions.iter().map(|&r| Column::Buffer(r)));
        let (fitting, skipped) = columns.partition::<Vec<_>, _>(|column| column.fits(plan.memory));
        let measured = MeasuredView {
            size: view.size,
            trees: forest.statistics,
            queries: 0,
            tree_seconds: spent.median(),
            colour_seconds: 0.0,
            miscellaneous_seconds: view.scene_seconds,
            columns: fitting.into_iter().map(MeasuredColumn::new).collect(),
            skipped,
            truth: TruthCounts::default(),
        };
        Look { camera: view.camera.clone(), forest, arriving: Vec::new(), measured }
    }

    /// The queries of a light.
    pub fn queries(&mut self, scene: &Scene, light: &Light) -> Queries {
        let chosen = timed(|| Queries::new(scene, &self.forest.nodes, light));
        self.measured.miscellaneous_seconds += chosen.seconds;
        self.measured.queries += chosen.value.points.len() as u64;
        chosen.value
    }

    /// What is summed up for a column.
    pub fn column(&mut self, column: Column) -> &mut MeasuredColumn {
        let mut columns = self.measured.columns.iter_mut();
        columns.find(|measured| measured.column == column).expect("a column of the plan that fits")
    }

    /// Takes note of the answers at the next light.
    pub fn light_arrives(&mut self, scene: &Scene, queries: &Queries, answers: &Answers) {
        let points = self.forest.nodes.points.len();
        let crossings = answers.crossings.as_ref();
        self.arriving.push(queries.arriving(scene, points, &answers.occluded, crossings));
    }

    /// Shades the picture when all lights have been asked about.
    pub fn finish(self, scene: &Scene, plan: &Plan) -> MeasuredView {
        let mut times = Repeated::default();
        while times.is_worth_another(plan.repetitions) {
            let shaded = timed(|| {
                let (forest, arriving) = (&self.forest, &self.arriving);
                shade_picture(scene, &self.camera, &scene.lights, forest, arriving, Textures::On)
            });
            times.push(shaded.seconds);
        }
        MeasuredView { colour_seconds: times.median(), ..self.measured }
    }
}
