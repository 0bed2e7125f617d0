//! `lightbuffer validate`: every tester against the truth.

use super::Outcome;
use super::hard_cases;
use super::options::{LightOptions, RunOptions, TreeOptions, ViewOptions};
use super::progress::{Bars, Messages, print_error};
use super::testers::{TesterOptions, expect_lights};
use super::view::{LookRules, Seen, View};
use super::{again, output, picture};
use crate::error::Result;
use crate::film::{BLOCK_ROWS, FileSet, add_exr, add_false_colour, unique_safe_names};
use crate::geometry::LightPosition;
use crate::measure::bench::Machine;
use crate::report::table::{statistics, verdict_table};
use crate::report::validation::{EmbreeFacts, LightReport, Skipped, Totals, Validation, WhySkipped};
use crate::scene::Scene;
use crate::shading::Textures;
use crate::shadow::Queries;
use crate::shadow::{BuildInput, TesterEntry, testers};
use crate::verdict::{EpsilonCounts, LightVerdict, Progress, check_arbiter, judge, sweep_epsilon};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Testers that would need more tests than this are skipped by name.
const MOST_TESTS: f64 = 2e11;

#[derive(Debug, clap::Args)]
#[command(after_long_help = CHANNELS)]
pub struct Args {
    #[command(flatten)]
    pub(super) view: ViewOptions,
    #[command(flatten)]
    pub(super) lights: LightOptions,
    #[command(flatten)]
    pub(super) trees: TreeOptions,
    /// Folder for validate.json, image.exr and the PNG maps; created if need be
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) testers: TesterOptions,
    /// Check the arbiter on N queries a light against all triangles in exact integers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) check_arbiter: usize,
    /// Ask Embree again with epsilons from 0 to 0.01: acne against leaks
    #[arg(long)]
    pub(super) sweep_epsilon: bool,
    /// Copy of validate.json; - is standard output instead of the table
    #[arg(long, value_name = "FILE")]
    pub(super) json: Option<PathBuf>,
    #[command(flatten)]
    pub(super) run: RunOptions,
}

impl Args {
    /// All files that may be written, for lights of these names.
    fn results(&self, lights: &[String]) -> Vec<PathBuf> {
        let maps = lights
            .iter()
            .flat_map(|light| ["difference", "verdict"].map(|kind| format!("{light}.{kind}.png")));
        let names = ["image.exr", "image.png", "validate.json"].map(str::to_owned).into_iter().chain(maps);
        names.map(|name| self.output.join(name)).chain(self.json.clone()).collect()
    }
}

/// The channels of image.exr, for `--help`.
pub const CHANNELS: &str = "\
Channels of the OpenEXR file beside R G B A, Z, P.*, N.*, albedo.* and id.object, for each light:
  shadow.LIGHT.TESTER      1 occluded, 0 lit, facing away or background
  shadow.LIGHT.difference  the tester of --shadow against Embree: +1 only the tester says occluded
                           (false shadow, were Embree right), -1 only Embree does (false light)
  shadow.LIGHT.verdict     against the truth: 0 background, 1 faces away, 2 lit, 3 occluded,
                           4 tester wrong, 5 Embree wrong, 6 both wrong, 7 outside the cone of a spot
                           light, 8 on an object that receives no shadows; plus 10 where the segment
                           touches; plus 100 where Embree is wrong by its epsilon, 200 by the
                           rounding of its input, 300 by its traversal";

pub fn run(args: &Args) -> Result<Outcome> {
    let messages = Messages::new(args.run.quiet);
    let entries = args.testers.choose(messages)?;
    args.run.pool()?.install(|| match hard_cases::are_meant(&args.view.scene) {
        true => hard_cases::validate(args, &entries, messages),
        false => validate(args, &entries, messages),
    })
}

fn validate(args: &Args, entries: &[&'static TesterEntry], messages: Messages) -> Result<Outcome> {
    output::expect_folder(&args.output)?;
    output::warn_of_remains(&args.output, messages);
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let view = View::load(&args.view, &args.lights, args.run.memory_limit(), messages)?;
    for entry in entries.iter().filter(|entry| args.testers.is_named(entry.name)) {
        expect_lights(entry, &view.scene.lights)?;
    }
    let limit = args.run.memory_limit();
    // A byte an answer until all testers of a light have been judged.
    let answers = view.size.pixels() as u64 * entries.len() as u64;
    let limit = limit.beside(format!("the answers of {} testers", entries.len()), answers)?;
    let seen = view.look(LookRules::usual(args.trees.depth), limit)?;
    // When all testers are gone; so it need not be added to what they need.
    seen.memory.check("pictures to compare", view.size.pixels() as u64 * picture::METRICS_BYTES)?;
    let index = args.run.index(&view.scene);
    let threads = rayon::current_num_threads();
    let names = unique_safe_names(&view.scene.lights.iter().map(|l| &l.name).collect::<Vec<_>>());
    output::expect_apart(&args.results(&names), &view.files)?;
    let mut report = Validation {
        scene: view.scene.name.clone(),
        width: view.size.width,
        height: view.size.height,
        version: env!("CARGO_PKG_VERSION"),
        threads,
        machine: Machine::here(),
        replay: again::replay(args, view.size),
        embree: embree_facts(threads, args.run.embree_epsilon, messages)?,
        skipped: Vec::new(),
        lights: Vec::new(),
        cases: Vec::new(),
        epsilon_sweep: Vec::new(),
        image_metrics: BTreeMap::new(),
        totals: Totals::default(),
    };
    let mut judged = Vec::new();
    for light in &view.scene.lights {
        let position = light.position();
        let queries = seen.queries(&view.scene, light, view.size.width * BLOCK_ROWS);
        let input = args.run.build_input(&view.scene, &index, position, seen.memory);
        let fitting = fitting(entries, position, &view.scene, &queries, &mut report.skipped);
        let bars = Bars::new(messages, &light.name, queries.points.len() as u64);
        let mut verdict = judge(&input, &queries, &fitting, &bars)?;
        let visible = &seen.forest.nodes;
        let mut entry = LightReport::new(&light.name, view.size.width, visible, &queries, &verdict);
        if args.check_arbiter > 0 {
            bars.stage("arbiter against integers");
            let most = args.check_arbiter;
            let advance = |n: u64| bars.advance(n);
            entry.arbiter_check =
                Some(check_arbiter(&view.scene, position, &queries, &verdict.truth, most, &advance));
        }
        if args.sweep_epsilon {
            bars.stage("epsilons");
            sweep(&fitting, &input, &queries, &verdict, &mut report.epsilon_sweep)?;
        }
        bars.finish();
        report.lights.push(entry);
        // What will be no channel has been counted, and sixty masks would be a lot to keep.
        verdict.testers.retain(|tester| args.testers.has_mask(tester.run.name));
        judged.push((queries, verdict));
    }
    report.totals = Totals::of(&report.lights);
    if seen.forest.nodes.points.is_empty() {
        messages.warn("the camera sees no surface: there is nothing to judge");
    } else if report.totals.queries == 0 {
        messages.warn("every visible point faces away from every light: there is nothing to judge");
    }
    report.image_metrics = picture::metrics(&view.shot(), &seen, &judged)?;
    write_all(args, &view, &seen, &names, &judged, &report)?;
    if args.run.stats {
        let runs = view.scene.lights.iter().zip(&judged).flat_map(|(light, (_, verdict))| {
            verdict.testers.iter().map(|tester| (light.name.as_str(), &tester.run))
        });
        print_error(&statistics(&seen.hits, &seen.forest.statistics, runs));
    }
    let arbiter_wrong = report.lights.iter().filter_map(|l| l.arbiter_check).any(|c| c.wrong > 0);
    Ok(if report.totals.native_wrong() > 0 || arbiter_wrong { Outcome::NativeWrong } else { Outcome::Right })
}

/// Asks those testers that trace float rays with other epsilons, and adds what they say to what they said of other
/// lights.
fn sweep(
    entries: &[&TesterEntry],
    input: &BuildInput,
    queries: &Queries,
    verdict: &LightVerdict,
    sums: &mut Vec<EpsilonCounts>,
) -> Result<()> {
    let traces = |name: &str| verdict.tester(name).is_some_and(|tester| tester.explained.is_some());
    for entry in entries.iter().filter(|entry| traces(entry.name)) {
        for counts in sweep_epsilon(entry, input, queries, &verdict.truth)? {
            let same =
                |sum: &&mut EpsilonCounts| (sum.tester, sum.epsilon) == (counts.tester, counts.epsilon);
            match sums.iter_mut().find(same) {
                Some(sum) => *sum += counts,
                None => sums.push(counts),
            }
        }
    }
    Ok(())
}

fn fitting<'e>(
    entries: &[&'e TesterEntry],
    light: LightPosition,
    scene: &Scene,
    queries: &Queries,
    skipped: &mut Vec<Skipped>,
) -> Vec<&'e TesterEntry> {
    let (casters, queries) = (f64::from(scene.primitive_count()), queries.points.len() as f64);
    let why_not = |entry: &TesterEntry| match entry.lights.has(light) {
        false => Some(WhySkipped::DirectionalLight),
        true if (entry.expected_tests)(casters, queries) > MOST_TESTS => Some(WhySkipped::TooManyTests),
        true => None,
    };
    let fits = |entry: &&&TesterEntry| {
        let why = why_not(entry);
        if let Some(skip) = why.map(|why| Skipped { name: entry.name, why })
            && !skipped.contains(&skip)
        {
            skipped.push(skip);
        }
        why.is_none()
    };
    entries.iter().filter(fits).copied().collect()
}

#[cfg(feature = "embree")]
pub fn embree_facts(threads: usize, epsilon: f32, _: Messages) -> Result<Option<EmbreeFacts>> {
    let device = crate::embree::Device::new(threads)?;
    Ok(Some(EmbreeFacts {
        version: device.version(),
        isa: device.instruction_set(),
        epsilon,
        streams: device.has_streams(),
        flushes_denormals: device.flushes_denormals(),
    }))
}

#[cfg(not(feature = "embree"))]
pub fn embree_facts(_: usize, _: f32, messages: Messages) -> Result<Option<EmbreeFacts>> {
    messages.warn("built without the feature `embree`: no oracle and no difference maps");
    Ok(None)
}

fn write_all(
    args: &Args,
    view: &View,
    seen: &Seen,
    names: &[String],
    judged: &[(Queries, LightVerdict)],
    report: &Validation,
) -> Result<()> {
    let runs = picture::runs_of(judged, &args.testers.shadow)?;
    let lighting: Vec<_> = runs.iter().map(|&(queries, run)| (queries, run.into())).collect();
    let shot = view.shot();
    let mut planes = picture::shaded(&shot, seen, &lighting, Textures::On)?;
    let mut files = FileSet::new();
    files.folder(&args.output)?;
    let file = |name: &str| args.output.join(name);
    for (name, (queries, verdict)) in names.iter().zip(judged) {
        let visible = &seen.forest.nodes;
        for map in picture::add_light(&mut planes, name, visible, queries, verdict, &args.testers.shadow)? {
            add_false_colour(&mut files, &file(&format!("{name}.{}.png", map.kind)), &map.colours)?;
        }
    }
    // One that is skipped at some lights has channels of the others.
    let has_mask = |name: &str| judged.iter().any(|(_, verdict)| verdict.tester(name).is_some());
    let testers: Vec<_> = testers().map(|entry| entry.name).filter(|name| has_mask(name)).collect();
    let settings = args.run.shadow_buffer();
    let (tester, embree) = (Some(args.testers.shadow.as_str()), report.embree.as_ref());
    picture::add_attributes(&mut planes, &shot, &testers, tester, embree, &settings)?;
    add_exr(&mut files, &file("image.exr"), &planes)?;
    output::add_preview(&mut files, &file("image.png"), &planes, view.scene.background, args.run.exposure)?;
    output::add_json(&mut files, &file("validate.json"), report)?;
    let shown = output::add_copy(&mut files, args.json.as_deref(), report, || verdict_table(report))?;
    output::finish(files, &shown)
}
