//! `lightbuffer render`: a scene becomes an OpenEXR picture.

use super::options::{LightOptions, RunOptions, Shadows, Switches, TreeOptions, ViewOptions};
use super::picture::Lighting;
use super::progress::{Bars, Messages, print_error};
use super::testers::{expect_available, expect_lights};
use super::view::{Seen, View};
use super::{Outcome, output, picture, validate};
use crate::atomic::folder_of;
use crate::error::{Error, Result};
use crate::film::{FileSet, add_exr, subdivided, unique_safe_names};
use crate::report::table::statistics;
use crate::report::validation::EmbreeFacts;
use crate::scene::Light;
use crate::shadow::Queries;
use crate::shadow::shadow_buffer::{self, BufferFile};
use crate::shadow::{Basis, BuildInput, TesterEntry, find};
use crate::verdict::{LightVerdict, TesterRun, judge, run_tester};
use serde::Serialize;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
#[command(after_long_help = validate::CHANNELS)]
pub struct Args {
    #[command(flatten)]
    view: ViewOptions,
    #[command(flatten)]
    lights: LightOptions,
    #[command(flatten)]
    trees: TreeOptions,
    #[command(flatten)]
    switches: Switches,
    /// OpenEXR file to write; a PNG preview is written beside it
    #[arg(short, long, value_name = "OUT.exr", value_parser = parse_output)]
    output: PathBuf,
    /// Tester of the shadows
    #[arg(long, value_name = "TESTER", default_value = "light-buffer")]
    shadow: String,
    /// Leave out the difference and verdict channels, and the time that Embree and the truth take
    #[arg(long)]
    no_verdict: bool,
    /// Samples a pixel along each side, without difference and verdict channels: 3 is nine a pixel
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    subdivide: u32,
    /// Facts of the run as JSON; - is standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Save the shadow-buffer of each light in this folder, as LIGHT.shadow-buffer, for other views of the scene;
    /// with --shadow shadow-buffer
    #[arg(long, value_name = "DIR", conflicts_with = "no_shadows")]
    save_shadow_buffers: Option<PathBuf>,
    /// Load the shadow-buffer of each light from a folder where they were saved, in place of filling it: those of
    /// another scene, light or size are refused; with --shadow shadow-buffer
    #[arg(long, value_name = "DIR", conflicts_with_all = ["save_shadow_buffers", "no_shadows"])]
    load_shadow_buffers: Option<PathBuf>,
    #[command(flatten)]
    run: RunOptions,
}

/// The preview takes the name with `.png`, which must not be that of the picture itself.
fn parse_output(text: &str) -> std::result::Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("exr") => Ok(path),
        _ => Err("expected a name that ends in .exr".into()),
    }
}

#[derive(Debug, Serialize)]
struct Facts {
    scene: String,
    width: u32,
    height: u32,
    /// Null without shadows.
    shadow: Option<String>,
    first_hits: &'static str,
    left_out: Vec<&'static str>,
    lights: Vec<LightFacts>,
}

#[derive(Debug, Serialize)]
struct LightFacts {
    name: String,
    /// Those that were asked: none without shadows.
    queries: u64,
    facing_away: u64,
    outside_cone: u64,
    not_receiving: u64,
    /// This and what follows is null without shadows.
    shadowed: Option<u64>,
    build_seconds: Option<f64>,
    ns_per_query: Option<f64>,
    bytes: Option<usize>,
}

impl Args {
    /// Codes of a verdict have no mean, and without shadows there is nothing to judge.
    fn without_verdict(&self) -> bool {
        self.no_verdict || self.subdivide > 1 || self.switches.shadows() == Shadows::Off
    }

    /// The PNG beside the picture.
    fn preview(&self) -> PathBuf {
        self.output.with_extension("png")
    }

    /// Whose shadows the picture has.
    fn tester(&self) -> Option<&str> {
        (self.switches.shadows() == Shadows::On).then_some(self.shadow.as_str())
    }

    /// Only the shadow-buffer has files, and the folder for them must be one.
    fn expect_shadow_buffer(&self, tester: &TesterEntry) -> Result<()> {
        let folders = [
            ("--save-shadow-buffers", &self.save_shadow_buffers),
            ("--load-shadow-buffers", &self.load_shadow_buffers),
        ];
        for (option, _) in folders.iter().filter(|(_, folder)| folder.is_some()) {
            if tester.name != shadow_buffer::ENTRY.name {
                return Err(Error::Usage(format!("{option}: only with --shadow shadow-buffer")));
            }
        }
        self.save_shadow_buffers.as_deref().map_or(Ok(()), output::expect_folder)
    }

    /// Where the buffer of each light is saved or loaded.
    fn shadow_buffer_files(&self, lights: &[Light]) -> Vec<Option<PathBuf>> {
        let folder = self.save_shadow_buffers.as_ref().or(self.load_shadow_buffers.as_ref());
        let names = unique_safe_names(&lights.iter().map(|light| &light.name).collect::<Vec<_>>());
        let file = |name| Some(folder?.join(format!("{name}.shadow-buffer")));
        names.into_iter().map(file).collect()
    }
}

pub fn run(args: &Args) -> Result<Outcome> {
    let messages = Messages::new(args.run.quiet);
    args.run.pool()?.install(|| render(args, messages))
}

fn render(args: &Args, messages: Messages) -> Result<Outcome> {
    let tester = args.tester().map(find).transpose()?;
    if let Some(tester) = tester {
        expect_available(tester)?;
        args.expect_shadow_buffer(tester)?;
    }
    output::expect_writable(&args.output)?;
    output::expect_writable(&args.preview())?;
    output::warn_of_remains(folder_of(&args.output), messages);
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let mut view = View::load(&args.view, &args.lights, args.run.memory_limit(), messages)?;
    let results = [args.output.clone(), args.preview()].into_iter().chain(args.json.clone());
    output::expect_apart(&results.collect::<Vec<_>>(), &view.files)?;
    tester.map_or(Ok(()), |tester| expect_lights(tester, &view.scene.lights))?;
    view.subdivide(args.subdivide)?;
    let seen = view.look(args.switches.look(args.trees.depth), args.run.memory_limit())?;
    let index = args.run.index(&view.scene);
    let threads = rayon::current_num_threads();
    let embree = if args.without_verdict() {
        None
    } else {
        validate::embree_facts(threads, args.run.embree_epsilon, messages)?
    };
    let mut entries: Vec<_> = tester.into_iter().collect();
    if embree.is_some() && args.shadow != "embree" {
        entries.push(find("embree")?);
    }
    let mut lights = Vec::new();
    let mut folders = FileSet::new();
    if let Some(folder) = &args.save_shadow_buffers {
        folders.folder(folder)?;
    }
    let files = args.shadow_buffer_files(&view.scene.lights);
    for (light, file) in view.scene.lights.iter().zip(&files) {
        let position = light.position();
        let queries = Queries::new(&view.scene, &seen.forest.nodes, light);
        let shadow_buffer_file = match file {
            None => BufferFile::Unused,
            Some(file) if args.load_shadow_buffers.is_some() => BufferFile::Load(file),
            Some(file) => BufferFile::Save(file),
        };
        let input = BuildInput {
            shadow_buffer_file,
            ..args.run.build_input(&view.scene, &index, position, seen.memory)
        };
        let bars = Bars::new(messages, &light.name, queries.points.len() as u64);
        let shadow = match tester {
            None => Shadow::Off,
            Some(tester) if args.without_verdict() => {
                Shadow::Alone(run_tester(tester, &input, &queries, &bars)?)
            }
            Some(_) => Shadow::Judged(judge(&input, &queries, &entries, &bars)?),
        };
        bars.finish();
        lights.push((queries, shadow));
    }
    write(args, &view, &seen, &lights, &entries, embree.as_ref())?;
    folders.publish()?;
    if args.run.stats {
        let lights = view.scene.lights.iter().zip(&lights);
        let runs = lights.filter_map(|(light, (_, shadow))| Some((light.name.as_str(), shadow.run()?)));
        print_error(&statistics(&seen.hits, &seen.forest.statistics, runs));
    }
    messages.say(&format!("wrote {}", args.output.display()));
    let wrong = lights.iter().any(|(_, shadow)| shadow.is_native_wrong());
    Ok(if wrong { Outcome::NativeWrong } else { Outcome::Right })
}

/// The shadows of one light: none, or the tester's answers, with or without a verdict on them.
enum Shadow {
    Off,
    Alone(TesterRun),
    Judged(LightVerdict),
}

impl Shadow {
    fn run(&self) -> Option<&TesterRun> {
        match self {
            Shadow::Off => None,
            Shadow::Alone(run) => Some(run),
            // The tester of the picture is the first that is judged.
            Shadow::Judged(verdict) => Some(&verdict.testers[0].run),
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

fn write(
    args: &Args,
    view: &View,
    seen: &Seen,
    lights: &[(Queries, Shadow)],
    entries: &[&TesterEntry],
    embree: Option<&EmbreeFacts>,
) -> Result<()> {
    let lighting: Vec<_> = lights
        .iter()
        .map(|(queries, shadow)| (queries, shadow.run().map_or(Lighting::Unshadowed, Lighting::from)))
        .collect();
    let mut planes = picture::shaded(view, seen, &lighting, args.switches.textures())?;
    let names = unique_safe_names(&view.scene.lights.iter().map(|l| &l.name).collect::<Vec<_>>());
    let visible = &seen.forest.nodes;
    for (name, (queries, shadow)) in names.iter().zip(lights) {
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
    let testers: Vec<_> = entries.iter().map(|entry| entry.name).collect();
    let settings = args.run.shadow_buffer();
    picture::add_attributes(&mut planes, view, &testers, args.tester(), embree, &settings)?;
    let left_out = args.switches.left_out();
    picture::add_left_out(&mut planes, &left_out)?;
    let planes = if args.subdivide > 1 { subdivided(&planes, args.subdivide)? } else { planes };
    let mut files = FileSet::new();
    add_exr(&mut files, &args.output, &planes)?;
    let background = view.scene.background;
    output::add_preview(&mut files, &args.preview(), &planes, background, args.run.exposure)?;
    let light_facts = |(light, (queries, shadow)): (&Light, &(Queries, Shadow))| LightFacts {
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
    let facts = Facts {
        scene: view.scene.name.clone(),
        width: view.size.width / args.subdivide,
        height: view.size.height / args.subdivide,
        shadow: args.tester().map(str::to_owned),
        first_hits: args.switches.look(args.trees.depth).first_hits.name(),
        left_out,
        lights: view.scene.lights.iter().zip(lights).map(light_facts).collect(),
    };
    let shown = output::add_copy(&mut files, args.json.as_deref(), &facts, String::new)?;
    output::finish(files, &shown)
}
