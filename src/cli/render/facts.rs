//! What `--json` says about a run.

use super::super::view::Shot;
use super::drawing::Painter;
use crate::shadow::Origin;
use crate::verdict::TesterRun;
use serde::Serialize;

/// What is the same for all pictures of a run.
#[derive(Debug, Serialize)]
struct Common {
    scene: String,
    width: u32,
    height: u32,
    /// Null without shadows.
    shadow: Option<String>,
    first_hits: &'static str,
    left_out: Vec<&'static str>,
}

impl Common {
    fn new(painter: &Painter, shot: &Shot) -> Common {
        let args = painter.args;
        Common {
            scene: shot.scene.name.clone(),
            width: shot.size.width / args.subdivide,
            height: shot.size.height / args.subdivide,
            shadow: args.tester().map(str::to_owned),
            first_hits: args.switches.look(args.trees.depth).first_hits.name(),
            left_out: args.switches.left_out(),
        }
    }
}

/// Of one picture.
#[derive(Debug, Serialize)]
pub struct Facts {
    #[serde(flatten)]
    common: Common,
    lights: Vec<LightFacts>,
}

impl Facts {
    pub fn new(painter: &Painter, shot: &Shot, lights: Vec<LightFacts>) -> Facts {
        Facts { common: Common::new(painter, shot), lights }
    }
}

#[derive(Debug, Serialize)]
pub struct LightFacts {
    pub name: String,
    /// Those that were asked: none without shadows.
    pub queries: u64,
    pub facing_away: u64,
    pub outside_cone: u64,
    pub not_receiving: u64,
    /// This and what follows is null without shadows.
    pub shadowed: Option<u64>,
    pub build_seconds: Option<f64>,
    pub ns_per_query: Option<f64>,
    pub bytes: Option<usize>,
}

/// Of many frames.
#[derive(Debug, Serialize)]
pub struct FramesFacts {
    #[serde(flatten)]
    common: Common,
    frames_per_second: String,
    pub frames: Vec<FrameFacts>,
    totals: Totals,
}

/// Of one of them.
#[derive(Debug, Serialize)]
pub struct FrameFacts {
    pub frame: u32,
    /// Seconds from the beginning of the animation.
    pub time: f64,
    /// The OpenEXR file.
    pub file: String,
    /// What it took to draw and write it, all told.
    pub seconds: f64,
    pub lights: Vec<FrameLightFacts>,
}

#[derive(Debug, Serialize)]
pub struct FrameLightFacts {
    #[serde(flatten)]
    pub light: LightFacts,
    /// The tester of the picture first.
    pub testers: Vec<TesterFacts>,
}

/// Whether a tester was built.
#[derive(Debug, Serialize)]
pub struct TesterFacts {
    name: &'static str,
    build: Build,
    /// The frame in which it was, or all of it that takes time.
    built_in_frame: u32,
    /// What that took in this frame.
    build_seconds: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Build {
    Built,
    Kept,
}

impl TesterFacts {
    pub fn of(run: &TesterRun, frame: u32) -> TesterFacts {
        let (build, built_in_frame) = match run.origin {
            Origin::Built => (Build::Built, frame),
            Origin::Kept { since } => (Build::Kept, since),
        };
        TesterFacts { name: run.name, build, built_in_frame, build_seconds: run.build_seconds }
    }
}

/// Sums over frames and lights, for the tester of the pictures.
#[derive(Debug, Default, Serialize)]
struct Totals {
    built: u64,
    kept: u64,
    build_seconds: f64,
    seconds: f64,
}

impl FramesFacts {
    pub fn new(painter: &Painter, shot: &Shot, rate: String) -> FramesFacts {
        let (common, totals) = (Common::new(painter, shot), Totals::default());
        FramesFacts { common, frames_per_second: rate, frames: Vec::new(), totals }
    }

    /// Adds a frame.
    pub fn add(&mut self, frame: FrameFacts) {
        let testers = frame.lights.iter().filter_map(|light| light.testers.first());
        for tester in testers {
            match tester.build {
                Build::Built => self.totals.built += 1,
                Build::Kept => self.totals.kept += 1,
            }
            self.totals.build_seconds += tester.build_seconds;
        }
        self.totals.seconds += frame.seconds;
        self.frames.push(frame);
    }

    /// A line about what was built and kept.
    pub fn summary(&self) -> String {
        let Totals { built, kept, build_seconds, .. } = &self.totals;
        format!("{built} buffers built in {build_seconds:.3} s, {kept} kept")
    }
}
