//! `bench.json`: speed against error. Its keys are a contract; new ones may be added.

use crate::measure::bench::{Machine, Measured, Plan, Ratio, Row, Side, Skipped, Stage};
use crate::measure::first_hits::{self, Look};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The whole document.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Document {
    /// What it was measured on.
    pub machine: Machine,
    /// Rounds that medians are taken over.
    pub repeats: u32,
    /// One entry a tester, its parameters and the order of the queries.
    pub rows: Vec<RowReport>,
    /// One entry a scene, its lights and a number of threads, in the order given.
    pub ratios: Vec<RatioReport>,
    /// Who finds what the camera sees, if that was asked for: one entry a scene and a number of threads.
    #[serde(default)]
    pub first_hits: Vec<FirstHitsReport>,
    /// What did not take part.
    pub skipped: Vec<SkippedReport>,
    /// How costs grow, if that was asked for.
    pub growth: Vec<GrowthReport>,
}

/// A tester in a scene.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RowReport {
    /// The scene.
    pub scene: String,
    /// Its triangles and curved surfaces.
    pub primitives: u64,
    /// Lights of the view.
    pub lights: u64,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// Who.
    pub tester: Cow<'static, str>,
    /// `native`, `embree`, or `approximate`.
    pub side: Cow<'static, str>,
    /// What it was set to, in words.
    pub parameter: String,
    /// The order of the queries: `rows` or `tiles`.
    pub order: Cow<'static, str>,
    /// Embree's epsilon.
    pub epsilon: Option<f32>,
    /// Threads, of Embree's pool too.
    pub threads: u64,
    /// Shadow queries of all lights.
    pub queries: u64,
    /// To build all that is needed, for all lights.
    pub build_seconds: f64,
    /// To answer all queries when all is built.
    pub query_seconds: f64,
    /// From indexed triangles and surface points to the answers.
    pub frame_seconds: f64,
    /// Of `query_seconds`.
    pub ns_per_query: f64,
    /// Turns that these are medians of.
    pub rounds: u64,
    /// Whether it took part in the interleaved rounds; if not, these are times of a single turn.
    pub interleaved: bool,
    /// The shortest and the longest of `query_seconds`.
    pub query_spread: [f64; 2],
    /// The shortest and the longest of `frame_seconds`.
    pub frame_spread: [f64; 2],
    /// Wrong answers among those that were held against the arbiter.
    pub wrong: u64,
    /// Of them lit points that were called occluded.
    pub false_shadow: u64,
    /// Of them occluded points that were called lit.
    pub false_light: u64,
    /// Queries whose truth is known: a sample, and those at which two testers differ.
    pub wrong_checked: u64,
    /// Memory that it keeps, for all lights.
    pub bytes: u64,
}

/// Embree's fastest over the fastest native tester without a wrong answer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RatioReport {
    /// The scene.
    pub scene: String,
    /// Lights of the view.
    pub lights: u64,
    /// Threads.
    pub threads: u64,
    /// By `query_seconds`; `null` if one side is missing.
    pub query: Option<f64>,
    /// By `frame_seconds`, chosen separately.
    pub frame: Option<f64>,
    /// Who was fastest for queries: Embree's and the native one, with their parameters.
    pub query_between: Option<[String; 2]>,
    /// Who was for frames.
    pub frame_between: Option<[String; 2]>,
}

/// First hits of a view.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FirstHitsReport {
    /// The scene.
    pub scene: String,
    /// Its triangles and curved surfaces.
    pub primitives: u64,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// Threads, of Embree's pool too.
    pub threads: u64,
    /// The t-buffer first, then Embree's modes.
    pub rows: Vec<FirstHitRow>,
    /// Embree's fastest over the t-buffer by `query_seconds`; `null` without Embree.
    pub query: Option<f64>,
    /// By `frame_seconds`, chosen separately.
    pub frame: Option<f64>,
    /// Why Embree did not take part.
    pub skipped: Option<String>,
}

/// One that finds first hits.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FirstHitRow {
    /// `t-buffer`, or a mode of Embree.
    pub method: String,
    /// The order of Embree's rays: `rows` or `tiles`.
    pub order: Option<Cow<'static, str>>,
    /// To build; the t-buffer has nothing to build.
    pub build_seconds: f64,
    /// To find the first triangle of every pixel when all is built.
    pub query_seconds: f64,
    /// From indexed triangles to the first triangle of every pixel.
    pub frame_seconds: f64,
    /// Turns that these are medians of.
    pub rounds: u64,
    /// Whether it took part in the interleaved rounds.
    pub interleaved: bool,
    /// The shortest and the longest of `frame_seconds`.
    pub frame_spread: [f64; 2],
    /// Pixels at which it sees another triangle than the t-buffer.
    pub differ: u64,
}

impl FirstHitsReport {
    /// Measured with the threads of the pool that this is called in.
    pub fn new(look: Look, measured: &first_hits::Measured) -> FirstHitsReport {
        let row = |row: &first_hits::Row| FirstHitRow {
            method: row.method.clone(),
            order: row.order.map(Cow::Borrowed),
            build_seconds: row.build.median(),
            query_seconds: row.query.median(),
            frame_seconds: row.frame.median(),
            rounds: row.frame.count() as u64,
            interleaved: row.in_rounds,
            frame_spread: row.frame.spread(),
            differ: row.differ,
        };
        FirstHitsReport {
            scene: look.scene.name.clone(),
            primitives: u64::from(look.scene.primitive_count()),
            width: look.size.width,
            height: look.size.height,
            threads: rayon::current_num_threads() as u64,
            rows: measured.rows.iter().map(row).collect(),
            query: measured.query(),
            frame: measured.frame(),
            skipped: measured.skipped.clone(),
        }
    }
}

/// One that did not take part.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SkippedReport {
    /// The scene.
    pub scene: String,
    /// Lights of the view.
    pub lights: u64,
    /// Who and why.
    #[serde(flatten)]
    pub skipped: Skipped,
}

/// A tester at one size of something that grows.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct GrowthReport {
    /// What grows: `triangles`, `lights` or `pixels`.
    pub over: Cow<'static, str>,
    /// How much there is of it.
    pub at: u64,
    /// The rest.
    #[serde(flatten)]
    pub row: RowReport,
}

/// What is the same for all rows of a stage.
#[derive(Debug, Clone)]
pub struct Heading {
    scene: String,
    primitives: u64,
    lights: u64,
    width: u32,
    height: u32,
    threads: u64,
    queries: u64,
}

impl Heading {
    /// With the threads of the pool that this is called in.
    pub fn new(stage: &Stage) -> Heading {
        Heading {
            scene: stage.scene.name.clone(),
            primitives: u64::from(stage.scene.primitive_count()),
            lights: stage.lights.len() as u64,
            width: stage.size.width,
            height: stage.size.height,
            threads: rayon::current_num_threads() as u64,
            queries: stage.queries(),
        }
    }

    fn row(&self, row: &Row) -> RowReport {
        let query_seconds = row.query.median();
        RowReport {
            scene: self.scene.clone(),
            primitives: self.primitives,
            lights: self.lights,
            width: self.width,
            height: self.height,
            tester: row.contender.entry.name.into(),
            side: Cow::Borrowed(match row.contender.side() {
                Side::Native => "native",
                Side::Embree => "embree",
                Side::Approximate => "approximate",
            }),
            parameter: row.contender.parameter(),
            order: row.contender.order.name().into(),
            epsilon: row.contender.epsilon,
            threads: self.threads,
            queries: self.queries,
            build_seconds: row.build.median(),
            query_seconds,
            frame_seconds: row.frame.median(),
            ns_per_query: query_seconds * 1e9 / self.queries.max(1) as f64,
            rounds: row.query.count() as u64,
            interleaved: row.in_rounds,
            query_spread: row.query.spread(),
            frame_spread: row.frame.spread(),
            wrong: row.wrong.wrong(),
            false_shadow: row.wrong.false_shadow,
            false_light: row.wrong.false_light,
            wrong_checked: row.wrong.checked,
            bytes: row.bytes,
        }
    }

    fn ratio(&self, rows: &[RowReport], query: Option<Ratio>, frame: Option<Ratio>) -> RatioReport {
        let name = |number: usize| format!("{} {}", rows[number].tester, rows[number].parameter);
        let between = |ratio: Ratio| [ratio.embree, ratio.native].map(name);
        RatioReport {
            scene: self.scene.clone(),
            lights: self.lights,
            threads: self.threads,
            query: query.map(|ratio| ratio.ratio),
            frame: frame.map(|ratio| ratio.ratio),
            query_between: query.map(between),
            frame_between: frame.map(between),
        }
    }
}

/// What was measured of one stage with one number of threads.
#[derive(Debug, Clone)]
pub struct Part {
    rows: Vec<RowReport>,
    ratio: RatioReport,
    skipped: Vec<SkippedReport>,
}

impl Part {
    /// Its rows.
    pub fn new(heading: &Heading, measured: &Measured) -> Part {
        let rows: Vec<RowReport> = measured.rows.iter().map(|row| heading.row(row)).collect();
        let skipped = measured.skipped.iter().map(|skipped| SkippedReport {
            scene: heading.scene.clone(),
            lights: heading.lights,
            skipped: skipped.clone(),
        });
        let skipped = skipped.collect();
        Part { ratio: heading.ratio(&rows, measured.query, measured.frame), rows, skipped }
    }

    /// Its rows as a step of something that grows.
    pub fn growth(self, over: &'static str, at: u64) -> impl Iterator<Item = GrowthReport> {
        self.rows.into_iter().map(move |row| GrowthReport { over: over.into(), at, row })
    }
}

impl Document {
    /// Nothing measured yet, on this machine.
    pub fn new(plan: &Plan) -> Document {
        Document {
            machine: Machine::here(),
            repeats: plan.rounds,
            rows: Vec::new(),
            ratios: Vec::new(),
            first_hits: Vec::new(),
            skipped: Vec::new(),
            growth: Vec::new(),
        }
    }

    /// Adds a part.
    pub fn add(&mut self, part: Part) {
        self.rows.extend(part.rows);
        self.ratios.push(part.ratio);
        for skipped in part.skipped {
            let is_same = |other: &SkippedReport| {
                (&other.scene, other.lights, &other.skipped)
                    == (&skipped.scene, skipped.lights, &skipped.skipped)
            };
            if !self.skipped.iter().any(is_same) {
                self.skipped.push(skipped);
            }
        }
    }

    /// Wrong answers of testers that claim to be exact.
    pub fn native_wrong(&self) -> u64 {
        let rows = self.rows.iter().chain(self.growth.iter().map(|step| &step.row));
        rows.filter(|row| row.side == "native").map(|row| row.wrong).sum()
    }
}
