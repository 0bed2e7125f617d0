//! The seven timing tests of Haines and Greenberg, The Light Buffer, 1986.

use super::super::Outcome;
use super::super::progress::Messages;
use super::Args;
use crate::error::{Error, Result};
use crate::film::FileSet;
use crate::measure::haines_greenberg::{Plan, ViewOfScene, measure};
use crate::measure::timed;
use crate::report::haines_greenberg::paper::{RESOLUTIONS, TABLES, Table};
use crate::report::haines_greenberg::{Environment, Reproduction, csv, plots, table};
use crate::scene::procedural::find;
use crate::scene::{ImageSize, Scene};
use crate::shading::USUAL_DEPTH;
use crate::shadow::light_buffer::MOST_CELLS;

/// Resolutions beyond the paper's.
const FINER: [u32; 4] = [200, 500, 1000, 2048];

/// What is for this paper alone.
#[derive(Debug, clap::Args)]
pub struct TableOptions {
    /// Environments by name, separated by commas [default: all seven]
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = parse_environment)]
    environments: Vec<&'static Table>,
    /// Light buffers beyond the paper's 10, 20, 50 and 100 have 200, 500, 1000 and 2048 cells along an edge, or
    /// as many of these as are not more than R [default: 2048]
    #[arg(long, value_name = "R", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_CELLS)))]
    largest_resolution: Option<u32>,
    /// Queries of an environment, of all its lights together, that the arbiter decides; 0 for all
    /// [default: 20000]
    #[arg(long, value_name = "N")]
    truth_samples: Option<usize>,
}

impl TableOptions {
    /// The first of these options that was given.
    pub fn given(&self) -> Option<&'static str> {
        [
            (!self.environments.is_empty(), "--environments"),
            (self.largest_resolution.is_some(), "--largest-resolution"),
            (self.truth_samples.is_some(), "--truth-samples"),
        ]
        .into_iter()
        .find_map(|(given, name)| given.then_some(name))
    }
}

fn parse_environment(text: &str) -> std::result::Result<&'static Table, String> {
    TABLES.iter().find(|table| table.name == text).ok_or_else(|| {
        let names: Vec<_> = TABLES.iter().map(|table| table.name).collect();
        format!("expected {}", names.join(", "))
    })
}

/// Measures the tables of the environments.
///
/// # Errors
/// Whatever a scene or a tester reports, or that a file cannot be written.
pub fn run(args: &Args, messages: Messages) -> Result<Outcome> {
    let options = &args.haines_greenberg;
    let largest = options.largest_resolution.unwrap_or(FINER[3]);
    let finer = FINER.into_iter().filter(|&resolution| resolution <= largest);
    let plan = Plan {
        resolutions: RESOLUTIONS.into_iter().chain(finer).collect(),
        repetitions: args.repetitions,
        truth_samples: options.truth_samples.unwrap_or(20_000),
        depth: USUAL_DEPTH,
        memory: args.memory_limit(),
    };
    let mut document = Reproduction::new(&plan, rayon::current_num_threads());
    let wanted = TABLES.iter().filter(|table| is_wanted(options, table));
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

fn is_wanted(options: &TableOptions, table: &Table) -> bool {
    options.environments.is_empty() || options.environments.iter().any(|wanted| wanted.name == table.name)
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
    let mut files = FileSet::new();
    files.folder(&args.output)?;
    for environment in &document.environments {
        args.write(&mut files, &format!("{}.svg", environment.name), &plots::plots(environment)?)?;
    }
    args.finish(files, document, &table::tables(document), &csv::csv(document))
}
