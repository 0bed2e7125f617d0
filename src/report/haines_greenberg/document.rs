//! `reproduce.json`: the tables of the 1986 paper as measured here, beside what it printed. Its keys are a
//! contract; new ones may be added.

use super::check::Check;
use super::paper::Table;
use super::quantity::Quantity;
use crate::measure::haines_greenberg::{Column, Lists, MeasuredColumn, MeasuredView, Plan};
use crate::scene::Scene;
use crate::shading::TreeStatistics;
use serde::Serialize;
use std::collections::BTreeMap;

/// The whole document.
#[derive(Debug, Clone, Serialize)]
pub struct Reproduction {
    /// Whose figures these are.
    pub paper: &'static str,
    /// Version of this program.
    pub version: &'static str,
    /// Threads that the times were taken with.
    pub threads: usize,
    /// The most times that anything was done to time it.
    pub repetitions: u32,
    /// Queries of an environment that the arbiter was asked about; 0 for all.
    pub truth_samples: usize,
    /// One entry a figure, in the paper's order.
    pub environments: Vec<Environment>,
}

/// One environment.
#[derive(Debug, Clone, Serialize)]
pub struct Environment {
    /// The built-in scene.
    pub name: &'static str,
    /// The figure of the paper.
    pub figure: u32,
    /// Its title there.
    pub title: &'static str,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// What the scene holds.
    pub counts: Counts,
    /// Triangles that its polygons were cut into.
    pub triangles: u32,
    /// What the paper says that it holds.
    pub paper_counts: Counts,
    /// Intersections a ray from the eye.
    pub average_tree_size: f64,
    /// The paper's.
    pub paper_average_tree_size: f64,
    /// What grew in all ray trees.
    pub trees: TreeStatistics,
    /// Shadow rays.
    pub queries: u64,
    /// Whose light buffers these are, if another environment of the run built them.
    pub buffers_of: Option<&'static str>,
    /// Seconds to find first hits and to grow the ray trees.
    pub tree_seconds: f64,
    /// Seconds to shade the picture.
    pub colour_seconds: f64,
    /// Seconds to make the scene, what its lights share, and to choose who is asked.
    pub miscellaneous_seconds: f64,
    /// The control and the light buffers.
    pub columns: Vec<ColumnReport>,
    /// Columns that did not fit into memory.
    pub skipped: Vec<String>,
    /// Answers against the arbiter.
    pub truth: TruthReport,
    /// Whether shadow tests per ray fall as the paper's do.
    pub check: Check,
    /// What the paper printed.
    #[serde(skip)]
    pub table: &'static Table,
}

/// What a scene holds, by the kinds of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Objects.
    pub objects: u32,
    /// Polygons, before they were cut into triangles.
    pub polygons: u32,
    /// Spheres.
    pub spheres: u32,
    /// Cylinders.
    pub cylinders: u32,
    /// Other curved surfaces.
    pub quadrics: u32,
    /// Lights.
    pub lights: u32,
}

/// One column of a table.
#[derive(Debug, Clone, Serialize)]
pub struct ColumnReport {
    /// `control` or `R = 10`.
    pub name: String,
    /// Squares along an edge; null for the control.
    pub resolution: Option<u32>,
    /// Seconds.
    pub shadow_testing_seconds: f64,
    /// Seconds to build the testers of all lights.
    pub preprocess_seconds: f64,
    /// Seconds, with the tree generation, colours and what is miscellaneous.
    pub total_seconds: f64,
    /// Wall-clock nanoseconds of shadow testing a shadow ray.
    pub ns_per_query: f64,
    /// How many times longer the control's shadow testing takes.
    pub control_over_this: f64,
    /// How many times longer the control takes in all.
    pub control_total_over_this: f64,
    /// Surfaces tested a shadow ray.
    pub tests_per_ray: f64,
    /// Bounding volumes tested a shadow ray.
    pub volume_tests_per_ray: f64,
    /// Share of the shadow rays that a full-occlusion record answers.
    pub full_occlusions_per_ray: f64,
    /// What was built, if these are light buffers.
    pub lists: Option<ListReport>,
    /// Memory of the testers of all lights.
    pub bytes: u64,
    /// Sampled answers that are not the arbiter's.
    pub wrong: u64,
    /// Answers to any query that are not the control's.
    pub unlike_control: u64,
    /// What the paper printed, by the row's key; null for a column that it has not.
    pub paper: Option<BTreeMap<&'static str, PaperFigure>>,
}

/// Lists of the light buffers of all lights.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ListReport {
    /// Items of all kinds.
    pub items: u64,
    /// Of them records of opaque surfaces.
    pub opaque: u64,
    /// Of them records of transparent surfaces.
    pub transparent: u64,
    /// Of them bounding-volume records.
    pub bounding_volumes: u64,
    /// Of them full-occlusion records.
    pub full_occlusions: u64,
    /// Items a square, of all squares.
    pub items_per_square: f64,
    /// Per cent of the squares whose list holds a surface.
    pub non_empty_percent: f64,
    /// Items in each light's longest list, the mean over the lights.
    pub average_maximum: f64,
}

/// A figure of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PaperFigure {
    /// Times in minutes.
    pub value: f64,
    /// Whether the print is damaged there.
    pub best_reading: bool,
}

/// Sampled queries and how many answers to them were wrong.
#[derive(Debug, Clone, Serialize)]
pub struct TruthReport {
    /// Queries that the arbiter was asked about.
    pub queries: u64,
    /// Of them occluded.
    pub occluded: u64,
    /// Of them on the very edge between light and shadow.
    pub touching: u64,
    /// Wrong answers of every exact native tester as it is set up unless something else is asked for.
    pub testers: BTreeMap<&'static str, u64>,
    /// Wrong answers of these and of all columns, and answers of columns that are not the control's.
    pub wrong: u64,
}

impl Environment {
    /// From what was measured.
    pub fn new(
        table: &'static Table,
        scene: &Scene,
        measured: &MeasuredView,
        buffers_of: Option<&'static str>,
    ) -> Environment {
        let control = measured.column(Column::Control).expect("the control fits into any memory");
        let others = measured.tree_seconds + measured.colour_seconds + measured.miscellaneous_seconds;
        let column = |column: &MeasuredColumn| {
            // What a view does not build costs it nothing, the control least of all.
            let total = |of: &MeasuredColumn| of.query_seconds + of.build_seconds + others;
            let a_ray = |count: u64| count as f64 / measured.queries.max(1) as f64;
            let mut report = ColumnReport {
                name: column.column.name(),
                resolution: column.column.resolution(),
                shadow_testing_seconds: column.query_seconds,
                preprocess_seconds: column.build_seconds,
                total_seconds: total(column),
                ns_per_query: column.query_seconds * 1e9 / measured.queries.max(1) as f64,
                control_over_this: ratio(control.query_seconds, column.query_seconds),
                control_total_over_this: ratio(total(control), total(column)),
                tests_per_ray: a_ray(column.counters.tests),
                volume_tests_per_ray: a_ray(column.counters.volume_tests),
                full_occlusions_per_ray: a_ray(column.counters.full_occlusions),
                lists: column.lists.as_ref().map(ListReport::new),
                bytes: column.bytes,
                wrong: column.wrong,
                unlike_control: column.unlike_control,
                paper: None,
            };
            report.paper = printed(table, report.resolution);
            report
        };
        let columns: Vec<ColumnReport> = measured.columns.iter().map(column).collect();
        let truth = &measured.truth;
        Environment {
            name: table.name,
            figure: table.figure,
            title: table.title,
            width: measured.size.width,
            height: measured.size.height,
            counts: Counts::of(scene),
            triangles: scene.triangles.len() as u32,
            paper_counts: Counts::printed(table),
            average_tree_size: measured.trees.average_tree(),
            paper_average_tree_size: table.average_tree_size,
            trees: measured.trees,
            queries: measured.queries,
            buffers_of,
            tree_seconds: measured.tree_seconds,
            colour_seconds: measured.colour_seconds,
            miscellaneous_seconds: measured.miscellaneous_seconds,
            check: Check::new(table, &columns),
            columns,
            skipped: measured.skipped.iter().map(|column| column.name()).collect(),
            truth: TruthReport {
                queries: truth.queries,
                occluded: truth.occluded,
                touching: truth.touching,
                testers: truth.testers.iter().copied().collect(),
                wrong: measured.native_wrong(),
            },
            table,
        }
    }
}

/// A ratio that is a number even where nothing was asked.
fn ratio(one: f64, other: f64) -> f64 {
    if other > 0.0 { one / other } else { 0.0 }
}

/// The paper's column, if it has one of this resolution.
fn printed(table: &Table, resolution: Option<u32>) -> Option<BTreeMap<&'static str, PaperFigure>> {
    let figure = |quantity: Quantity| {
        let printed = quantity.printed(table, resolution)?;
        Some((quantity.key(), PaperFigure { value: printed.value, best_reading: printed.best_reading }))
    };
    table.shadow_testing.at(resolution)?;
    Some(Quantity::ALL.into_iter().filter_map(figure).collect())
}

impl Counts {
    /// Those of a scene.
    pub fn of(scene: &Scene) -> Counts {
        let kind = |wanted: &[&str]| {
            scene.curved.iter().filter(|curved| wanted.contains(&curved.shape.kind())).count() as u32
        };
        let (spheres, cylinders) = (kind(&["sphere"]), kind(&["cylinder"]));
        Counts {
            objects: scene.objects.len() as u32,
            polygons: scene.objects.iter().map(|object| object.polygons).sum(),
            spheres,
            cylinders,
            quadrics: scene.curved.len() as u32 - spheres - cylinders,
            lights: scene.lights.len() as u32,
        }
    }

    fn printed(table: &Table) -> Counts {
        let [objects, polygons, spheres, cylinders, quadrics, lights] = table.counts;
        Counts { objects, polygons, spheres, cylinders, quadrics, lights }
    }
}

impl ListReport {
    fn new(lists: &Lists) -> ListReport {
        ListReport {
            items: lists.all.items(),
            opaque: lists.all.opaque,
            transparent: lists.all.transparent,
            bounding_volumes: lists.all.bounding_volumes,
            full_occlusions: lists.all.full_occlusions,
            items_per_square: lists.items_per_square(),
            non_empty_percent: lists.non_empty_percent(),
            average_maximum: lists.average_maximum(),
        }
    }
}

impl Reproduction {
    /// A document without environments.
    pub fn new(plan: &Plan, threads: usize) -> Reproduction {
        Reproduction {
            paper: "Haines and Greenberg, The Light Buffer: A Shadow-Testing Accelerator, 1986",
            version: env!("CARGO_PKG_VERSION"),
            threads,
            repetitions: plan.repetitions,
            truth_samples: plan.truth_samples,
            environments: Vec::new(),
        }
    }

    /// Wrong answers of exact native testers.
    pub fn native_wrong(&self) -> u64 {
        self.environments.iter().map(|environment| environment.truth.wrong).sum()
    }
}
