//! One picture: what its camera sees, who is in shadow, and its files.

use super::super::output;
use super::super::picture::{self, Lighting};
use super::super::progress::{Bars, Messages, print_error};
use super::super::settings::Settings;
use super::super::view::{self, Seen, Shot};
use super::facts::{LightFacts, TesterFacts};
use super::shard::{Rows, Shard};
use super::{Args, preview};
use crate::error::Result;
use crate::film::{BLOCK_ROWS, FileSet, add_exr, subdivided, unique_safe_names};
use crate::memory::MemoryLimit;
use crate::report::table::statistics;
use crate::report::validation::EmbreeFacts;
use crate::scene::{Camera, FrameRate, ImageSize, Light, Scene, Window};
use crate::shadow::shadow_buffer::BufferFile;
use crate::shadow::{Basis, BuildInput, Queries, SceneIndex, TesterEntry, TesterSource};
use crate::verdict::{LightVerdict, TesterRun, judge_from, run_tester_from};
use std::path::{Path, PathBuf};

/// The attribute of a part that says which it is. The whole has none of it.
pub const SHARD_ATTRIBUTE: &str = "shard";

/// The attribute of a part with what all parts have in common. The whole has none of it.
pub const SETTINGS_ATTRIBUTE: &str = "shardSettings";

/// What all pictures of a run share.
pub struct Painter<'r> {
    pub args: &'r Args,
    /// Whose shadows the pictures have; none without shadows.
    pub tester: Option<&'static TesterEntry>,
    /// That, and who is held against it.
    pub entries: Vec<&'static TesterEntry>,
    pub embree: Option<EmbreeFacts>,
    pub messages: Messages,
    /// What parts of one result have in common; nothing if the run is no part and records nothing.
    pub settings: Settings,
    /// Which part this run draws, if that is a strip of each picture.
    pub tile: Option<Shard>,
}

/// Which frame of how many a second a picture is.
#[derive(Debug, Clone, Copy)]
pub struct FrameOf {
    pub number: u32,
    pub rate: FrameRate,
}

/// A picture before it is files.
pub struct Drawn {
    seen: Seen,
    lights: Vec<(Queries, Shadow)>,
}

impl Painter<'_> {
    /// The rows that this run draws of a picture of this size.
    pub fn rows(&self, size: ImageSize) -> Rows {
        self.tile.map_or(Rows { first: 0, count: size.height }, |tile| tile.rows(size.height))
    }

    /// What is drawn of a picture of this size: its rows, with so many samples a pixel as were asked for. There must be
    /// such rows.
    ///
    /// # Errors
    /// If the whole picture would have more samples than one may have.
    pub fn shot<'s>(
        &self,
        scene: &'s Scene,
        lights: Vec<Light>,
        camera: Camera,
        size: ImageSize,
    ) -> Result<Shot<'s>> {
        let (samples, rows) = (self.args.subdivide, self.rows(size));
        let of = view::subdivided(size, samples)?;
        let window = self.tile.map(|_| Window { of, first_row: rows.first * samples });
        let size = ImageSize { height: rows.count * samples, ..of };
        Ok(Shot { scene, lights, camera: Camera { window, ..camera }, size })
    }

    /// Finds what the camera sees and which of it is in shadow, by testers of a source. `buffers` are the files for
    /// shadow-buffers, by light; none are used where there are fewer of them.
    ///
    /// # Errors
    /// Too little memory, and whatever a tester reports.
    pub fn draw<'s>(
        &self,
        shot: &Shot<'s>,
        index: &'s SceneIndex,
        source: &mut dyn TesterSource<'s>,
        buffers: &'s [Option<PathBuf>],
        limit: MemoryLimit,
    ) -> Result<Drawn> {
        let args = self.args;
        let seen = shot.look(args.switches.look(args.trees.depth), limit)?;
        let mut lights = Vec::new();
        for (number, light) in shot.lights.iter().enumerate() {
            let block = shot.size.width * BLOCK_ROWS * args.subdivide;
            let queries = seen.queries(shot.scene, light, block);
            let shadow_buffer_file = match buffers.get(number).and_then(Option::as_deref) {
                None => BufferFile::Unused,
                Some(file) if args.load_shadow_buffers.is_some() => BufferFile::Load(file),
                Some(file) => BufferFile::Save(file),
            };
            let input = BuildInput {
                shadow_buffer_file,
                ..args.run.build_input(shot.scene, index, light.position(), seen.memory)
            };
            let bars = Bars::new(self.messages, &light.name, queries.points.len() as u64);
            let shadow = match self.tester {
                None => Shadow::Off,
                Some(tester) if args.without_verdict() => {
                    Shadow::Alone(run_tester_from(source, tester, &input, &queries, &bars)?)
                }
                Some(_) => Shadow::Judged(judge_from(source, &input, &queries, &self.entries, &bars)?),
            };
            bars.finish();
            lights.push((queries, shadow));
        }
        Ok(Drawn { seen, lights })
    }

    /// Adds the picture and its preview to files.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn add(
        &self,
        files: &mut FileSet,
        path: &Path,
        shot: &Shot,
        drawn: &Drawn,
        frame: Option<FrameOf>,
    ) -> Result<()> {
        let (args, seen) = (self.args, &drawn.seen);
        let lighting: Vec<_> = drawn
            .lights
            .iter()
            .map(|(queries, shadow)| (queries, shadow.run().map_or(Lighting::Unshadowed, Lighting::from)))
            .collect();
        let mut planes = picture::shaded(shot, seen, &lighting, args.switches.textures())?;
        let names = unique_safe_names(&shot.lights.iter().map(|l| &l.name).collect::<Vec<_>>());
        let visible = &seen.forest.nodes;
        for (name, (queries, shadow)) in names.iter().zip(&drawn.lights) {
            match shadow {
                Shadow::Off => {}
                Shadow::Alone(run) => {
                    picture::add_mask(&mut planes, name, visible, queries, run.name, &run.occluded)?
                }
                Shadow::Judged(verdict) => {
                    picture::add_light(&mut planes, name, visible, queries, verdict, &args.shadow)?;
                }
            }
        }
        let testers: Vec<_> = self.entries.iter().map(|entry| entry.name).collect();
        let settings = args.run.shadow_buffer();
        picture::add_attributes(&mut planes, shot, &testers, args.tester(), self.embree.as_ref(), &settings)?;
        picture::add_left_out(&mut planes, &args.switches.left_out())?;
        if let Some(FrameOf { number, rate }) = frame {
            picture::add_frame(&mut planes, number, rate)?;
        }
        let mut planes = if args.subdivide > 1 { subdivided(&planes, args.subdivide)? } else { planes };
        if let (Some(tile), Some(window)) = (self.tile, shot.camera.window) {
            let side = |samples: u32| samples / args.subdivide;
            let of = ImageSize { width: side(window.of.width), height: side(window.of.height) };
            planes.set_window(Window { of, first_row: side(window.first_row) })?;
            planes.add_attribute(SHARD_ATTRIBUTE, tile.to_string())?;
            planes.add_attribute(SETTINGS_ATTRIBUTE, self.settings.to_json()?)?;
        }
        add_exr(files, path, &planes)?;
        output::add_preview(files, &preview(path), &planes, shot.scene.background, args.run.exposure)
    }

    /// Prints the statistics, if they were asked for.
    pub fn tell(&self, shot: &Shot, drawn: &Drawn, frame: Option<u32>) {
        if !self.args.run.stats {
            return;
        }
        if let Some(frame) = frame {
            print_error(&format!("frame {frame}\n"));
        }
        let lights = shot.lights.iter().zip(&drawn.lights);
        let runs = lights.filter_map(|(light, (_, shadow))| Some((light.name.as_str(), shadow.run()?)));
        print_error(&statistics(&drawn.seen.hits, &drawn.seen.forest.statistics, runs));
    }
}

impl Drawn {
    /// Whether a tester that claims to be exact has been found wrong.
    pub fn is_native_wrong(&self) -> bool {
        self.lights.iter().any(|(_, shadow)| shadow.is_native_wrong())
    }

    /// What is said about each light.
    pub fn light_facts(&self, shot: &Shot) -> Vec<LightFacts> {
        let facts = |(light, (queries, shadow)): (&Light, &(Queries, Shadow))| LightFacts {
            name: light.name.clone(),
            queries: shadow.run().map_or(0, |run| run.occluded.len() as u64),
            facing_away: queries.facing_away.len() as u64,
            outside_cone: queries.outside_cone.len() as u64,
            not_receiving: queries.not_receiving.len() as u64,
            shadowed: shadow.run().map(|run| run.occluded.iter().filter(|&&o| o).count() as u64),
            build_seconds: shadow.run().map(|run| run.build_seconds),
            ns_per_query: shadow.run().map(|run| run.ns_per_query),
            bytes: shadow.run().map(|run| run.bytes),
        };
        shot.lights.iter().zip(&self.lights).map(facts).collect()
    }

    /// Whether each tester of each light was built in this frame.
    pub fn tester_facts(&self, frame: u32) -> Vec<Vec<TesterFacts>> {
        let of_light = |(_, shadow): &(Queries, Shadow)| {
            shadow.runs().into_iter().map(|run| TesterFacts::of(run, frame)).collect()
        };
        self.lights.iter().map(of_light).collect()
    }
}

/// The shadows of one light: none, or the tester's answers, with or without a verdict on them.
enum Shadow {
    Off,
    Alone(TesterRun),
    Judged(LightVerdict),
}

impl Shadow {
    fn run(&self) -> Option<&TesterRun> {
        self.runs().first().copied()
    }

    /// All that were asked, the tester of the picture first.
    fn runs(&self) -> Vec<&TesterRun> {
        match self {
            Shadow::Off => Vec::new(),
            Shadow::Alone(run) => vec![run],
            Shadow::Judged(verdict) => verdict.testers.iter().map(|tester| &tester.run).collect(),
        }
    }

    fn is_native_wrong(&self) -> bool {
        match self {
            Shadow::Off | Shadow::Alone(_) => false,
            Shadow::Judged(verdict) => {
                verdict.testers.iter().any(|t| t.run.basis == Basis::Exact && t.counts.wrong > 0)
            }
        }
    }
}
