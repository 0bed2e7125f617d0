//! `reproduce.json`: the figures of the t-buffer paper as measured here. Its keys are a contract; new ones may be
//! added.

use super::paper;
use crate::measure::Errors;
use crate::measure::fit::Fit;
use crate::measure::raghuvanshi_dhande::{MeasuredFrame, MeasuredHits, MeasuredTester, Plan, Series};
use crate::scene::ImageSize;
use crate::verdict::EdgeCounts;
use serde::Serialize;

/// The whole document.
#[derive(Debug, Clone, Serialize)]
pub struct Document {
    /// Whose figures these are.
    pub paper: &'static str,
    /// Version of this program.
    pub version: &'static str,
    /// Threads that the times were taken with.
    pub threads: usize,
    /// The most times that anything was done to time it.
    pub repetitions: u32,
    /// One entry a figure, in the paper's order.
    pub figures: Vec<Figure>,
    /// What figures 13 to 16 are made of.
    pub series: Vec<SeriesReport>,
    /// Wrong answers of what must be exact.
    pub native_wrong: u64,
}

/// One figure.
#[derive(Debug, Clone, Serialize)]
pub struct Figure {
    /// Its number in the paper.
    pub figure: u32,
    /// What it shows.
    pub title: &'static str,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// What was drawn.
    pub pictures: Vec<Picture>,
    /// The file of its plot, if it has curves.
    pub plot: Option<String>,
    /// What its curves run over, and what they say.
    pub axes: Option<[&'static str; 2]>,
    /// What was measured.
    pub curves: Vec<Curve>,
    /// What the figure comes to, beside what the paper says of it.
    pub facts: Vec<Fact>,
}

/// A picture, by the switches of REALITY.
#[derive(Debug, Clone, Serialize)]
pub struct Picture {
    /// Its file for people.
    pub png: String,
    /// Its file with all channels.
    pub exr: String,
    /// The scene.
    pub scene: String,
    /// Objects in it.
    pub objects: u32,
    /// What is off.
    pub left_out: Vec<&'static str>,
    /// Who answers shadow rays.
    pub shadow: String,
    /// Shadow rays, of all levels of the ray trees.
    pub queries: u64,
    /// Those of them that are occluded, by that tester.
    pub shadowed: u64,
    /// Against the arbiter, if it was asked.
    pub errors: Option<ErrorReport>,
    /// Where the wrong ones are that the camera sees, if that was looked for.
    pub edges: Option<EdgeReport>,
    /// Pixels at which the classical tracer sees something else, if it was asked.
    pub unlike_classical: Option<u64>,
}

/// Wrong answers.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct ErrorReport {
    /// Each way round.
    #[serde(flatten)]
    pub errors: Errors,
    /// Both.
    pub wrong: u64,
    /// Of all shadow rays.
    pub wrong_share: f64,
}

impl ErrorReport {
    /// Of so many answers.
    pub fn new(errors: Errors, queries: u64) -> ErrorReport {
        let wrong = errors.wrong();
        ErrorReport { errors, wrong, wrong_share: wrong as f64 / queries.max(1) as f64 }
    }
}

/// Where a shadow-buffer is wrong, among the pixels of the image.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct EdgeReport {
    /// Pixels with a wrong answer.
    pub wrong: u64,
    /// Those of them within a cell's width, seen from the light, of the edge of a shadow or of a silhouette.
    pub within_a_cell: u64,
    /// Their share of the wrong ones; 1 if none is.
    pub share: f64,
}

impl From<EdgeCounts> for EdgeReport {
    fn from(EdgeCounts { wrong, near_an_edge }: EdgeCounts) -> EdgeReport {
        let share = if wrong == 0 { 1.0 } else { near_an_edge as f64 / wrong as f64 };
        EdgeReport { wrong, within_a_cell: near_an_edge, share }
    }
}

/// Points of a plot.
#[derive(Debug, Clone, Serialize)]
pub struct Curve {
    /// What it is.
    pub name: String,
    /// The kind of objects, if the figure has several.
    pub kind: Option<&'static str>,
    /// Places and values.
    pub points: Vec<[f64; 2]>,
    /// The polynomial that the paper compares it with.
    pub fit: Option<FitReport>,
}

/// A polynomial through the points.
#[derive(Debug, Clone, Serialize)]
pub struct FitReport {
    /// Of 1, x and perhaps x^2.
    pub coefficients: Vec<f64>,
    /// Explained share of the variance.
    pub r_squared: f64,
    /// Its root.
    pub correlation: f64,
}

impl From<&Fit> for FitReport {
    fn from(fit: &Fit) -> FitReport {
        let (coefficients, r_squared) = (fit.coefficients.clone(), fit.r_squared);
        FitReport { coefficients, r_squared, correlation: fit.correlation() }
    }
}

/// A number that the figure comes to.
#[derive(Debug, Clone, Serialize)]
pub struct Fact {
    /// What it is.
    pub what: String,
    /// Here.
    pub measured: f64,
    /// In the paper, if its text has the number.
    pub paper: Option<f64>,
    /// Its words, if they say something about it.
    pub paper_says: Option<&'static str>,
}

impl Fact {
    /// A number that the paper does not speak of.
    pub fn new(what: impl Into<String>, measured: f64) -> Fact {
        Fact { what: what.into(), measured, paper: None, paper_says: None }
    }

    /// With the paper's number.
    pub fn beside(self, paper: f64) -> Fact {
        Fact { paper: Some(paper), ..self }
    }

    /// With the paper's words.
    pub fn said(self, words: &'static str) -> Fact {
        Fact { paper_says: Some(words), ..self }
    }
}

/// Stacks of one kind of objects.
#[derive(Debug, Clone, Serialize)]
pub struct SeriesReport {
    /// The kind.
    pub kind: &'static str,
    /// By rising number of objects.
    pub frames: Vec<FrameReport>,
}

/// One stack.
#[derive(Debug, Clone, Serialize)]
pub struct FrameReport {
    /// Objects.
    pub objects: u32,
    /// Pixels of the image.
    pub pixels: u64,
    /// Pixels that see something.
    pub covered: u64,
    /// Points that face away from the light.
    pub facing_away: u64,
    /// Shadow rays.
    pub queries: u64,
    /// Those of them that reach the light.
    pub lit: u64,
    /// First hits by testing everything.
    pub classical: HitsReport,
    /// First hits by the t-buffer.
    pub t_buffer: HitsReport,
    /// Seconds of what both do alike.
    pub shared_seconds: f64,
    /// Share of the classical tracer's tests that shadow rays make.
    pub shadow_test_share: f64,
    /// Gain of the t-buffer alone that the tests predict.
    pub predicted_gain: f64,
    /// And the most that it can be.
    pub gain_limit: f64,
    /// By their names.
    pub testers: Vec<TesterReport>,
    /// Wrong answers of what must be exact.
    pub native_wrong: u64,
}

/// First hits.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct HitsReport {
    /// Seconds.
    pub seconds: f64,
    /// Ray/object tests.
    pub tests: u64,
    /// Nanoseconds a test, on all threads.
    pub ns_per_test: f64,
}

/// One tester.
#[derive(Debug, Clone, Serialize)]
pub struct TesterReport {
    /// Its name, with its size.
    pub name: String,
    /// Seconds to build or fill it.
    pub build_seconds: f64,
    /// Seconds to answer all shadow rays.
    pub query_seconds: f64,
    /// Ray/object tests that the answers took.
    pub tests: u64,
    /// Nanoseconds a test, on all threads; 0 without tests.
    pub ns_per_test: f64,
    /// Memory.
    pub bytes: u64,
    /// Answers against those of brute force.
    pub errors: ErrorReport,
    /// How many times longer the classical tracer takes than the t-buffer with this, for rays alone.
    pub gain: f64,
    /// The same for the whole picture.
    pub frame_gain: f64,
}

impl Document {
    /// A document without figures.
    pub fn new(plan: &Plan, threads: usize) -> Document {
        Document {
            paper: "Raghuvanshi and Dhande, Raytraced rendering using t-buffer and shadow-buffer, 2004",
            version: env!("CARGO_PKG_VERSION"),
            threads,
            repetitions: plan.repetitions,
            figures: Vec::new(),
            series: Vec::new(),
            native_wrong: 0,
        }
    }
}

impl Figure {
    /// A figure of the paper, of images of a size.
    pub fn new(figure: u32, size: ImageSize) -> Figure {
        Figure {
            figure,
            title: paper::title(figure),
            width: size.width,
            height: size.height,
            pictures: Vec::new(),
            plot: None,
            axes: None,
            curves: Vec::new(),
            facts: Vec::new(),
        }
    }

    /// The same with curves, over and of something.
    pub fn with_curves(self, axes: [&'static str; 2], curves: Vec<Curve>, facts: Vec<Fact>) -> Figure {
        let plot = Some(format!("figure-{}.svg", self.figure));
        Figure { plot, axes: Some(axes), curves, facts, ..self }
    }
}

impl HitsReport {
    fn new(hits: MeasuredHits) -> HitsReport {
        HitsReport { seconds: hits.seconds, tests: hits.tests, ns_per_test: per(hits.seconds, hits.tests) }
    }
}

fn per(seconds: f64, tests: u64) -> f64 {
    if tests == 0 { 0.0 } else { seconds * 1e9 / tests as f64 }
}

impl SeriesReport {
    /// What was measured.
    pub fn new(series: &Series) -> SeriesReport {
        SeriesReport {
            kind: series.kind.name(),
            frames: series.frames.iter().map(FrameReport::new).collect(),
        }
    }
}

impl FrameReport {
    fn new(frame: &MeasuredFrame) -> FrameReport {
        let tester = |tester: &MeasuredTester| TesterReport {
            name: tester.contender.name(),
            build_seconds: tester.build_seconds,
            query_seconds: tester.query_seconds,
            tests: tester.tests,
            ns_per_test: per(tester.query_seconds, tester.tests),
            bytes: tester.bytes,
            errors: ErrorReport::new(tester.errors, frame.queries),
            gain: frame.gain(tester),
            frame_gain: frame.frame_gain(tester),
        };
        FrameReport {
            objects: frame.objects,
            pixels: frame.pixels,
            covered: frame.covered,
            facing_away: frame.facing_away,
            queries: frame.queries,
            lit: frame.lit,
            classical: HitsReport::new(frame.classical),
            t_buffer: HitsReport::new(frame.t_buffer),
            shared_seconds: frame.shared_seconds,
            shadow_test_share: frame.shadow_test_share(),
            predicted_gain: frame.predicted_gain(),
            gain_limit: frame.gain_limit(),
            testers: frame.testers.iter().map(tester).collect(),
            native_wrong: frame.native_wrong(),
        }
    }
}
