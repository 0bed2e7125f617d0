//! `lightbuffer reproduce`: the tables of a paper, measured again.

use super::options::{parse_size, thread_pool};
use super::progress::Messages;
use super::{Outcome, output};
use crate::error::{Error, Result};
use crate::film::write_atomically;
use crate::measure::reproduction::{Plan, ViewOfScene, measure};
use crate::measure::timed;
use crate::memory::{self, MemoryLimit};
use crate::report::reproduction::paper::{RESOLUTIONS, TABLES, Table};
use crate::report::reproduction::{Environment, Reproduction, csv, plots, table};
use crate::scene::procedural::find;
use crate::scene::{ImageSize, Scene};
use crate::shading::USUAL_DEPTH;
use crate::shadow::light_buffer::MOST_CELLS;
use clap::ValueEnum;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Resolutions beyond the paper's.
const FINER: [u32; 4] = [200, 500, 1000, 2048];

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Whose results
    #[arg(value_name = "PAPER")]
    paper: Paper,
    /// Folder for reproduce.json, reproduce.csv, reproduce.txt and a plot of each environment; created if need be
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Environments by name, separated by commas [default: all seven]
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = parse_environment)]
    environments: Vec<&'static Table>,
    /// Image size in pixels [default: the paper's, 512x480, and 436x479 for the kitchen]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<ImageSize>,
    /// Light buffers beyond the paper's 10, 20, 50 and 100 have 200, 500, 1000 and 2048 cells along an edge, or
    /// as many of these as are not more than R
    #[arg(long, value_name = "R", default_value_t = FINER[3],
          value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_CELLS)))]
    largest_resolution: u32,
    /// Queries of an environment, of all its lights together, that the arbiter decides; 0 for all
    #[arg(long, value_name = "N", default_value_t = 20_000)]
    truth_samples: usize,
    /// The most times that anything is done to time it; what takes a second is done once
    #[arg(long, value_name = "N", default_value_t = 3,
          value_parser = clap::value_parser!(u32).range(1..=100))]
    repetitions: u32,
    /// Copy of reproduce.json; - is standard output instead of the tables
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Threads [default: all]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// The most memory that a light buffer may need, such as 16G; others are skipped [default: what the machine
    /// has free]
    #[arg(long, value_name = "BYTES", value_parser = memory::parse)]
    memory_limit: Option<MemoryLimit>,
    /// No progress and no messages but errors
    #[arg(short, long)]
    quiet: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Paper {
    /// The seven timing tests of The Light Buffer, 1986
    HainesGreenberg,
}

fn parse_environment(text: &str) -> std::result::Result<&'static Table, String> {
    TABLES.iter().find(|table| table.name == text).ok_or_else(|| {
        let names: Vec<_> = TABLES.iter().map(|table| table.name).collect();
        format!("expected {}", names.join(", "))
    })
}

pub fn run(args: &Args) -> Result<Outcome> {
    let messages = Messages::new(args.quiet);
    match args.paper {
        Paper::HainesGreenberg => thread_pool(args.threads)?.install(|| haines_greenberg(args, messages)),
    }
}

fn haines_greenberg(args: &Args, messages: Messages) -> Result<Outcome> {
    output::expect_folder(&args.output)?;
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let finer = FINER.into_iter().filter(|&resolution| resolution <= args.largest_resolution);
    let plan = Plan {
        resolutions: RESOLUTIONS.into_iter().chain(finer).collect(),
        repetitions: args.repetitions,
        truth_samples: args.truth_samples,
        depth: USUAL_DEPTH,
        memory: args.memory_limit.unwrap_or_else(MemoryLimit::of_this_machine),
    };
    let mut document = Reproduction::new(&plan, rayon::current_num_threads());
    let wanted = TABLES.iter().filter(|table| is_wanted(args, table));
    for group in groups(wanted, args.size)? {
        let names: Vec<_> = group.tables.iter().map(|table| table.name).collect();
        messages.say(&format!("measuring {}", names.join(" and ")));
        let measured =
            measure(&group.scene, &group.views, &plan, &|what| messages.say(&format!("  {what}")))?;
        let builder = group.tables[0].name;
        for (i, (table, measured)) in group.tables.iter().zip(&measured).enumerate() {
            let buffers_of = (i > 0).then_some(builder);
            document.environments.push(Environment::new(table, &group.scene, measured, buffers_of));
        }
    }
    write_all(args, &document)?;
    Ok(if document.native_wrong() > 0 { Outcome::NativeWrong } else { Outcome::Right })
}

fn is_wanted(args: &Args, table: &Table) -> bool {
    args.environments.is_empty() || args.environments.iter().any(|wanted| wanted.name == table.name)
}

/// Environments that are one scene from several places: they share their light buffers.
struct Group {
    scene: Scene,
    tables: Vec<&'static Table>,
    views: Vec<ViewOfScene>,
}

fn groups(tables: impl Iterator<Item = &'static Table>, size: Option<ImageSize>) -> Result<Vec<Group>> {
    let mut groups: Vec<Group> = Vec::new();
    for table in tables {
        let made = timed(|| find(table.name)?.build(None));
        let scene = made.value?;
        let no_camera = || Error::Usage(format!("builtin:{} has no camera of a size", table.name));
        let camera = scene.cameras.first().cloned().ok_or_else(no_camera)?;
        let size = size.or(camera.size).ok_or_else(no_camera)?;
        let view = ViewOfScene { camera, size, scene_seconds: made.seconds };
        match groups.iter_mut().find(|group| is_same_but_for_the_view(&group.scene, &scene)) {
            Some(group) => {
                group.tables.push(table);
                group.views.push(view);
            }
            None => groups.push(Group { scene, tables: vec![table], views: vec![view] }),
        }
    }
    Ok(groups)
}

fn is_same_but_for_the_view(one: &Scene, other: &Scene) -> bool {
    one.hash() == other.hash() && one.lights == other.lights && one.materials == other.materials
}

fn write_all(args: &Args, document: &Reproduction) -> Result<()> {
    output::folder(&args.output)?;
    let write = |name: &str, text: &str| {
        write_atomically(&args.output.join(name), |file| file.write_all(text.as_bytes()))
    };
    let text = table::tables(document);
    for environment in &document.environments {
        write(&format!("{}.svg", environment.name), &plots::plots(environment)?)?;
    }
    write("reproduce.csv", &csv::csv(document))?;
    write("reproduce.txt", &text)?;
    output::write_json(&args.output.join("reproduce.json"), document)?;
    if let Some(path) = &args.json {
        output::write_json(path, document)?;
    }
    if args.json.as_deref() == Some(Path::new("-")) {
        return Ok(());
    }
    output::print(&text)
}
