//! What `--json` says about a run.

use super::super::settings::Settings;
use super::drawing::Painter;
use super::shard::{Rows, Shard, ShardBy};
use crate::scene::ImageSize;
use crate::shadow::Origin;
use crate::verdict::TesterRun;
use serde::{Deserialize, Serialize};

/// What is the same for all pictures of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Common {
    pub scene: String,
    pub width: u32,
    pub height: u32,
    /// Null without shadows.
    pub shadow: Option<String>,
    pub first_hits: String,
    pub left_out: Vec<String>,
}

impl Common {
    /// Of pictures of this size.
    pub fn new(painter: &Painter, scene: &str, size: ImageSize) -> Common {
        let args = painter.args;
        Common {
            scene: scene.to_owned(),
            width: size.width,
            height: size.height,
            shadow: args.tester().map(str::to_owned),
            first_hits: args.switches.look(args.trees.depth).first_hits.name().to_owned(),
            left_out: args.switches.left_out().into_iter().map(str::to_owned).collect(),
        }
    }
}

/// Which part of a run it was.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShardFacts {
    /// From 1.
    pub index: u32,
    pub of: u32,
    pub by: ShardBy,
    /// Of each picture, if it is a part by tiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<Rows>,
    /// What drawing and writing took, all told.
    pub seconds: f64,
    /// What parts of one result have in common; not in what is made of several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<Settings>,
}

impl ShardFacts {
    /// Of a run that has drawn for so long.
    pub fn new(painter: &Painter, shard: Shard, size: ImageSize, seconds: f64) -> ShardFacts {
        let (index, of) = shard.numbers();
        let (by, rows) = match painter.tile {
            Some(tile) => (ShardBy::Tiles, Some(tile.rows(size.height))),
            None => (ShardBy::Frames, None),
        };
        ShardFacts { index, of, by, rows, seconds, settings: Some(painter.settings.clone()) }
    }
}

/// Of one picture.
#[derive(Debug, Serialize, Deserialize)]
pub struct Facts {
    #[serde(flatten)]
    pub common: Common,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<ShardFacts>,
    /// Parts that it is made of.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shards: Vec<ShardFacts>,
    pub lights: Vec<LightFacts>,
}

impl Facts {
    pub fn new(common: Common, shard: Option<ShardFacts>, lights: Vec<LightFacts>) -> Facts {
        Facts { common, shard, shards: Vec::new(), lights }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Serialize, Deserialize)]
pub struct FramesFacts {
    #[serde(flatten)]
    pub common: Common,
    pub frames_per_second: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<ShardFacts>,
    /// Parts that it is made of.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shards: Vec<ShardFacts>,
    pub frames: Vec<FrameFacts>,
    totals: Totals,
}

/// Of one of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrameLightFacts {
    #[serde(flatten)]
    pub light: LightFacts,
    /// The tester of the picture first.
    pub testers: Vec<TesterFacts>,
}

/// Whether a tester was built.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TesterFacts {
    pub name: String,
    build: Build,
    /// The frame in which it was, or all of it that takes time.
    built_in_frame: u32,
    /// What that took in this frame.
    pub build_seconds: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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
        TesterFacts { name: run.name.to_owned(), build, built_in_frame, build_seconds: run.build_seconds }
    }
}

/// Sums over frames and lights, for the tester of the pictures.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Totals {
    built: u64,
    kept: u64,
    build_seconds: f64,
    seconds: f64,
}

impl FramesFacts {
    pub fn new(common: Common, frames_per_second: String) -> FramesFacts {
        let (frames, totals) = (Vec::new(), Totals::default());
        FramesFacts { common, frames_per_second, shard: None, shards: Vec::new(), frames, totals }
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

    /// Seconds of all frames.
    pub fn seconds(&self) -> f64 {
        self.totals.seconds
    }

    /// A line about what was built and kept.
    pub fn summary(&self) -> String {
        let Totals { built, kept, build_seconds, .. } = &self.totals;
        format!("{built} buffers built in {build_seconds:.3} s, {kept} kept")
    }
}
