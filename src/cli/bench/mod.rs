//! `lightbuffer bench`: speed against error, Embree at its best beside the native testers.

mod growth;

use super::options::{
    LightOptions, ViewOptions, parse_epsilon, parse_instruction_set, parse_resolution, parse_size,
    thread_pool,
};
use super::progress::Messages;
use super::view::{LookRules, Seen, View};
use super::{Outcome, output};
use crate::error::{Error, Result};
use crate::film::FileSet;
use crate::geometry::batch::InstructionSet;
use crate::measure::bench::{Choice, Order, Plan, Stage, Truths, measure};
use crate::measure::first_hits::{self, Look};
use crate::memory::{self, MemoryLimit};
use crate::report::bench::document::{Document, FirstHitsReport, Heading, Part};
use crate::report::bench::{csv, plots, table};
use crate::scene::ImageSize;
use crate::shadow::Resolution;
use clap::value_parser;
use growth::Growth;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The image unless another is asked for: cameras of scenes that are small do not decide.
const USUAL_SIZE: ImageSize = ImageSize { width: 1920, height: 1080 };

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene files or builtin:NAME, as for `validate`
    #[arg(value_name = "SCENE", required = true)]
    scenes: Vec<PathBuf>,
    /// Folder for bench.json, bench.csv and plots; created if need be
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Image size in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "1920x1080")]
    size: ImageSize,
    /// Camera by name [default: the scene's first]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// No floor under a mesh that comes without lights
    #[arg(long)]
    no_floor: bool,
    #[command(flatten)]
    lights: LightOptions,
    /// Testers by name, Embree's modes among them [default: every exact native one that is not too slow, the
    /// shadow-buffer, and every mode of Embree that is for speed]
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    testers: Vec<String>,
    /// Resolutions of the light buffer: from 1 to 4096, or auto
    #[arg(long, value_name = "R,R", value_delimiter = ',', default_value = "auto", value_parser = parse_resolution)]
    resolution: Vec<Resolution>,
    /// Instructions that native testers run on: portable, avx2 or avx512 [default: the widest that this machine has]
    #[arg(long, value_name = "SET", value_parser = parse_instruction_set)]
    isa: Option<InstructionSet>,
    /// Shares of a segment that Embree leaves out at both ends, in [0, 0.5): every mode is asked with the first, and
    /// the fastest with the others too
    #[arg(long, value_name = "E,E", value_delimiter = ',', default_value = "1e-4", value_parser = parse_epsilon)]
    epsilon: Vec<f32>,
    /// Numbers of threads to measure with, one after the other [default: all]
    #[arg(short, long, value_name = "N,N", value_delimiter = ',', value_parser = value_parser!(u16).range(1..=1024))]
    threads: Vec<u16>,
    /// Rounds in which the best have a turn each; medians over them count
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = value_parser!(u32).range(1..=1000))]
    repeats: u32,
    /// Of each side so many that were best for queries in the quick round, and as many that were for frames, take part
    /// in the rounds
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = value_parser!(u16).range(1..=1000))]
    finalists: u16,
    /// Queries of a scene that the arbiter is asked about beside those at which testers differ
    #[arg(long, value_name = "N", default_value_t = 20_000)]
    truth_samples: usize,
    /// Also who finds what the camera sees fastest: the t-buffer, or Embree with rays from the camera
    #[arg(long, conflicts_with = "growth")]
    first_hits: bool,
    /// How costs grow with triangles (built-in scenes with a size factor), with lights from 1 to 64 or with pixels
    /// from 0.25 to 8 million, in place of the table
    #[arg(long, value_name = "WHAT")]
    growth: Option<Growth>,
    /// The most memory that a run may need, such as 16G [default: what the machine has free]
    #[arg(long, value_name = "BYTES", value_parser = memory::parse)]
    memory_limit: Option<MemoryLimit>,
    /// Copy of bench.json; - is standard output instead of the table
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// No messages but errors
    #[arg(short, long)]
    quiet: bool,
}

/// Measures, writes, and says whether a native answer was wrong.
pub fn run(args: &Args) -> Result<Outcome> {
    let messages = Messages::new(args.quiet);
    args.choice(&Order::ALL).check()?;
    output::expect_folder(&args.output)?;
    output::warn_of_remains(&args.output, messages);
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let mut files = FileSet::new();
    files.folder(&args.output)?;
    let mut document = Document::new(&args.plan());
    // Fewest threads first, over all scenes: a pool of Embree's that has grown need not shrink.
    let threads = args.thread_counts();
    let mut fewest_first: Vec<usize> = (0..threads.len()).collect();
    fewest_first.sort_by_key(|&i| threads[i]);
    let mut parts: Vec<Vec<Part>> = vec![Vec::new(); threads.len()];
    for i in fewest_first {
        for scene in &args.scenes {
            match args.growth {
                Some(growth) => growth.measure(args, scene, threads[i], &mut document, messages)?,
                None => {
                    let view = args.view(scene, messages)?;
                    output::expect_apart(&args.results(), &view.files)?;
                    parts[i].push(part(args, &view, threads[i], &Order::ALL, messages)?);
                    if args.first_hits {
                        document.first_hits.push(first_hits(args, &view, threads[i], messages)?);
                    }
                }
            }
        }
    }
    let mut parts: Vec<_> = parts.into_iter().map(Vec::into_iter).collect();
    for _ in &args.scenes {
        parts.iter_mut().filter_map(Iterator::next).for_each(|part| document.add(part));
    }
    for (name, svg) in plots::plots(&document)? {
        files.write(&args.output.join(name), |file| file.write_all(svg.as_bytes()))?;
    }
    files.write(&args.output.join("bench.csv"), |file| file.write_all(csv::csv(&document).as_bytes()))?;
    output::add_json(&mut files, &args.output.join("bench.json"), &document)?;
    let shown = output::add_copy(&mut files, args.json.as_deref(), &document, || table::table(&document))?;
    output::finish(files, &shown)?;
    Ok(if document.native_wrong() > 0 { Outcome::NativeWrong } else { Outcome::Right })
}

impl Args {
    fn plan(&self) -> Plan {
        Plan {
            rounds: self.repeats,
            sample: self.truth_samples,
            finalists: self.finalists.into(),
            ..Plan::default()
        }
    }

    fn choice(&self, orders: &[Order]) -> Choice {
        Choice {
            testers: self.testers.clone(),
            resolutions: self.resolution.clone(),
            epsilons: self.epsilon.clone(),
            orders: orders.to_vec(),
            robust: self.growth.is_none(),
        }
    }

    /// Numbers of threads in the order given; `None` for all.
    fn thread_counts(&self) -> Vec<Option<u16>> {
        match self.threads.is_empty() {
            true => vec![None],
            false => self.threads.iter().map(|&threads| Some(threads)).collect(),
        }
    }

    fn memory_limit(&self) -> MemoryLimit {
        self.memory_limit.unwrap_or_else(MemoryLimit::of_this_machine)
    }

    fn view_options(&self, scene: &Path) -> ViewOptions {
        ViewOptions {
            scene: scene.into(),
            size: Some(self.size),
            corner_rays: false,
            camera: self.camera.clone(),
            no_floor: self.no_floor,
            strict: false,
        }
    }

    fn view(&self, scene: &Path, messages: Messages) -> Result<View> {
        let view = View::load(&self.view_options(scene), &self.lights, self.memory_limit(), messages)?;
        expect_lights(&view)?;
        Ok(view)
    }

    /// All files that a run may write.
    fn results(&self) -> Vec<PathBuf> {
        let names = ["bench.json", "bench.csv", "speed-error.svg"].map(|name| self.output.join(name));
        let growth = Growth::FILES.map(|name| self.output.join(name));
        names.into_iter().chain(growth).chain(self.json.clone()).collect()
    }
}

/// Without lights there is nothing to ask.
fn expect_lights(view: &View) -> Result<()> {
    match view.scene.lights.is_empty() {
        true => Err(Error::Usage(format!("{}: the scene has no lights", view.scene.name))),
        false => Ok(()),
    }
}

/// Who finds what the camera of a view sees, with a number of threads.
fn first_hits(args: &Args, view: &View, threads: Option<u16>, messages: Messages) -> Result<FirstHitsReport> {
    messages.say(&format!("{}: first hits", view.scene.name));
    let look = Look { scene: &view.scene, camera: &view.camera, size: view.size };
    thread_pool(threads)?.install(|| {
        let measured = first_hits::measure(look, args.repeats, args.finalists.into())?;
        Ok(FirstHitsReport::new(look, &measured))
    })
}

/// A view with a number of threads.
fn part(
    args: &Args,
    view: &View,
    threads: Option<u16>,
    orders: &[Order],
    messages: Messages,
) -> Result<Part> {
    // What is seen is found with all threads, and not timed.
    let all = thread_pool(None)?;
    let Seen { forest, memory, .. } = all.install(|| view.look(LookRules::usual(1), args.memory_limit()))?;
    let stage = all.install(|| Stage::new(&view.scene, &forest.nodes, view.size, orders, memory))?;
    let instruction_set = args.isa.unwrap_or(stage.instruction_set);
    let stage = Stage { instruction_set, ..stage };
    drop(all);
    let name = &view.scene.name;
    let say = |text: &str| {
        let threads = threads.map_or(String::new(), |n| format!(", threads: {n}"));
        messages.say(&format!("{name}{threads}: {text}"));
    };
    thread_pool(threads)?.install(|| {
        let mut truths = Truths::default();
        let measured = measure(&stage, &args.choice(orders), &args.plan(), &mut truths, &say)?;
        Ok(Part::new(&Heading::new(&stage), &measured))
    })
}
