//! `lightbuffer validate builtin:hard-cases`: the numbered hard cases in place of a scene.

use super::progress::{Bars, Messages};
use super::validate::{Args, embree_facts};
use super::{Outcome, output};
use crate::error::{Error, Result};
use crate::film::FileSet;
use crate::hard_cases::{self, judge_situations};
use crate::measure::bench::Machine;
use crate::report::hard_case_picture::{most_telling, picture};
use crate::report::hard_cases::{CaseReport, arbiter_wrong, case_table, reports};
use crate::report::validation::{Totals, Validation};
use crate::scene::formats::BUILTIN_PREFIX;
use crate::scene::procedural::HARD_CASES;
use crate::shading::USUAL_DEPTH;
use crate::shadow::{TesterEntry, shadow_buffer};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// Whether this is their name.
pub fn are_meant(scene: &Path) -> bool {
    scene.to_str().and_then(|path| path.strip_prefix(BUILTIN_PREFIX)) == Some(HARD_CASES)
}

/// Holds the testers against every case, and writes `validate.json`.
pub fn validate(args: &Args, entries: &[&'static TesterEntry], messages: Messages) -> Result<Outcome> {
    if let Some(option) = senseless(args) {
        return Err(Error::Usage(format!(
            "{option}: {BUILTIN_PREFIX}{HARD_CASES} has no camera, lights or picture of its own to choose"
        )));
    }
    output::expect_folder(&args.output)?;
    output::warn_of_remains(&args.output, messages);
    args.json.as_deref().map_or(Ok(()), output::expect_writable)?;
    let threads = rayon::current_num_threads();
    // It compares all that lies at one distance in each of its cells, and 10,000 duplicates would take hours.
    let asked = |entry: &&&'static TesterEntry| {
        entry.name != shadow_buffer::ENTRY.name || args.testers.is_named(entry.name)
    };
    let entries: Vec<&'static TesterEntry> = entries.iter().filter(asked).copied().collect();
    let memory = args.run.memory_limit();
    let (mut cases, mut all, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
    for case in hard_cases::all() {
        let situations = case.situations();
        let most = situations.iter().map(|situation| situation.points.len()).max().unwrap_or(0);
        let bars = Bars::new(messages, &format!("case {}", case.number), most as u64);
        let inputs: &hard_cases::Inputs =
            &|scene, index, light| args.run.build_input(scene, index, light, memory);
        let verdicts = judge_situations(&situations, &entries, inputs, &bars)?;
        bars.finish();
        let shown = most_telling(&verdicts);
        pictures.push((case.number, picture(case, &situations[shown], &verdicts[shown])?));
        cases.push(CaseReport::new(case, &verdicts));
        all.extend(reports(&verdicts));
    }
    let report = Validation {
        epsilon_sweep: Vec::new(),
        image_metrics: BTreeMap::new(),
        machine: Machine::here(),
        replay: Vec::new(),
        scene: format!("{BUILTIN_PREFIX}{HARD_CASES}"),
        width: 0,
        height: 0,
        version: env!("CARGO_PKG_VERSION"),
        threads,
        embree: embree_facts(threads, args.run.embree_epsilon, messages)?,
        skipped: Vec::new(),
        lights: Vec::new(),
        cases,
        totals: Totals::of(&all),
    };
    let mut files = FileSet::new();
    files.folder(&args.output)?;
    for (number, svg) in pictures {
        files.write(&args.output.join(format!("case-{number:02}.svg")), |file| {
            file.write_all(svg.as_bytes())
        })?;
    }
    output::add_json(&mut files, &args.output.join("validate.json"), &report)?;
    let shown = output::add_copy(&mut files, args.json.as_deref(), &report, || case_table(&report))?;
    output::finish(files, &shown)?;
    let wrong = report.totals.native_wrong() + arbiter_wrong(&report);
    Ok(if wrong > 0 { Outcome::NativeWrong } else { Outcome::Right })
}

/// The first option that was given and is about a picture.
fn senseless(args: &Args) -> Option<&'static str> {
    let (view, run) = (&args.view, &args.run);
    let options = [
        ("--size", view.size.is_some()),
        ("--corner-rays", view.corner_rays),
        ("--camera", view.camera.is_some()),
        ("--no-floor", view.no_floor),
        ("--strict", view.strict),
        ("--light", !args.lights.lights.is_empty()),
        ("--lights", args.lights.rig.is_some()),
        ("--depth", args.trees.depth != USUAL_DEPTH),
        ("--shadow", args.testers.shadow != "light-buffer"),
        ("--check-arbiter", args.check_arbiter > 0),
        ("--sweep-epsilon", args.sweep_epsilon),
        ("--exposure", run.exposure != 0.0),
        ("--stats", run.stats),
    ];
    options.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name)
}
