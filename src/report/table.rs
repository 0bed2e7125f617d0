//! Verdict tables for people.

use super::validation::{TesterReport, Totals, Validation, WhySkipped, WrongPixel};
use crate::film::grouped;
use crate::shading::TreeStatistics;
use crate::shadow::{Counters, testers};
use crate::verdict::{Cause, EpsilonCounts, TesterRun};
use crate::visibility::FirstHits;
use std::fmt::Write;

/// The verdict table: speed beside error, a block a light and the sums if there are several lights.
pub fn verdict_table(report: &Validation) -> String {
    let mut text = String::new();
    for light in &report.lights {
        let _ = write!(
            text,
            "light {}: {} queries, {} points face away, ",
            light.name,
            grouped(light.queries),
            grouped(light.facing_away)
        );
        for (count, what) in
            [(light.outside_cone, "outside the cone"), (light.not_receiving, "on objects without shadows")]
        {
            if count > 0 {
                let _ = write!(text, "{} {what}, ", grouped(count));
            }
        }
        let _ = writeln!(text, "{} touching", grouped(light.verdicts.touching));
        rows(&mut text, &|name| light.testers.get(name));
        if let Some(check) = light.arbiter_check {
            let _ = writeln!(
                text,
                "  arbiter against all triangles in integers: {} wrong of {}",
                check.wrong,
                grouped(check.queries)
            );
        }
    }
    if report.lights.len() > 1 {
        let _ = writeln!(text, "all lights: {} queries", grouped(report.totals.queries));
        rows(&mut text, &|name| report.totals.testers.get(name));
    }
    text.push_str(&summary(&report.totals));
    text.push_str(&causes(&report.totals));
    text.push_str(&epsilons(&report.epsilon_sweep));
    let first = |pixels: &'_ [WrongPixel]| pixels.first().filter(|pixel| !pixel.is_expected()).cloned();
    let wrong = report.lights.iter().find_map(|light| Some((light, first(&light.wrong_pixels)?)));
    if let Some((light, WrongPixel { pixel: [x, y], .. })) = wrong {
        let _ = writeln!(
            text,
            "to see why: replay with --size {}x{} --pixel {x},{y} --light {}",
            report.width, report.height, light.name
        );
    }
    for skipped in &report.skipped {
        let why = match skipped.why {
            WhySkipped::TooManyTests => "would need more than 2e11 tests",
            WhySkipped::DirectionalLight => "has no answer for lights infinitely far away",
        };
        let _ = writeln!(text, "skipped: {} {why}", skipped.name);
    }
    text
}

fn rows<'a>(text: &mut String, report: &dyn Fn(&str) -> Option<&'a TesterReport>) {
    let rows: Vec<_> = testers().filter_map(|entry| Some((entry.name, report(entry.name)?))).collect();
    // Modes of Embree have long names; a table without them is as wide as ever.
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0).max(14);
    let _ = writeln!(
        text,
        "  {:<width$} {:>9} {:>9} {:>10} {:>11} {:>9} {:>7} {:>9}",
        "tester", "build ms", "ns/query", "memory", "false shadow", "false light", "wrong", "undecided"
    );
    for (name, t) in rows {
        let _ = writeln!(
            text,
            "  {name:<width$} {:>9.1} {:>9.1} {:>10} {:>12} {:>11} {:>7} {:>9}",
            t.build_seconds * 1e3,
            t.ns_per_query,
            bytes(t.bytes),
            grouped(t.counts.false_shadow),
            grouped(t.counts.false_light),
            grouped(t.counts.wrong),
            grouped(t.counts.undecided),
        );
    }
}

fn summary(totals: &Totals) -> String {
    let native = format!(
        "{} of {} native answers wrong",
        grouped(totals.native_wrong()),
        grouped(totals.native_answers())
    );
    match totals.testers.get("embree") {
        Some(embree) => format!(
            "{native}, {} of {} of Embree's ({} false shadow, {} false light)\n",
            grouped(embree.counts.wrong),
            grouped(totals.queries),
            grouped(embree.counts.false_shadow),
            grouped(embree.counts.false_light)
        ),
        None => format!("{native}; Embree was not asked\n"),
    }
}

/// What wrong answers are put down to: a line for all testers of which the same can be said, in the order of the
/// first.
fn causes(totals: &Totals) -> String {
    let mut said: Vec<(String, Vec<&str>)> = Vec::new();
    for entry in testers() {
        let Some(causes) = totals.testers.get(entry.name).and_then(causes_of) else { continue };
        match said.iter_mut().find(|(same, _)| *same == causes) {
            Some((_, names)) => names.push(entry.name),
            None => said.push((causes, vec![entry.name])),
        }
    }
    let line = |(causes, names): (String, Vec<&str>)| match names[..] {
        [name] => format!("{name} is wrong {causes}\n"),
        [first, second] => format!("{first} and {second} are wrong {causes} each\n"),
        _ => format!("{} and {} other testers are wrong {causes} each\n", names[0], names.len() - 1),
    };
    said.into_iter().map(line).collect()
}

/// Errors against epsilon, testers side by side.
fn epsilons(sweep: &[EpsilonCounts]) -> String {
    let Some(first) = sweep.first() else { return String::new() };
    let columns: Vec<&str> = sweep.iter().filter(|c| c.epsilon == first.epsilon).map(|c| c.tester).collect();
    let mut text = String::from(
        "epsilon: share of a segment left out at both ends; false shadow (acne) + false light (leaks)\n",
    );
    let width = columns.iter().map(|name| name.len()).max().unwrap_or(0).max(18);
    let _ = write!(text, "  {:>8}", "epsilon");
    columns.iter().for_each(|name| {
        let _ = write!(text, " {name:>width$}");
    });
    text.push('\n');
    for row in sweep.iter().filter(|c| c.tester == first.tester) {
        let epsilon = if row.epsilon == 0.0 { "0".into() } else { format!("{:e}", row.epsilon) };
        let _ = write!(text, "  {epsilon:>8}");
        for cell in sweep.iter().filter(|c| c.epsilon == row.epsilon) {
            let both = format!("{} + {}", grouped(cell.false_shadow), grouped(cell.false_light));
            let _ = write!(text, " {both:>width$}");
        }
        text.push('\n');
    }
    text
}

fn causes_of(tester: &TesterReport) -> Option<String> {
    let causes = tester.causes.filter(|_| tester.counts.wrong > 0)?;
    let parts = [
        (causes.epsilon, Cause::Epsilon),
        (causes.input_rounding, Cause::InputRounding),
        (causes.traversal, Cause::Traversal),
    ];
    let parts = parts.into_iter().filter(|part| part.0 > 0);
    let parts: Vec<_> =
        parts.map(|(count, cause)| format!("{} by {}", grouped(count), cause.name())).collect();
    Some(parts.join(", "))
}

/// What was built and what every tester did, for `--stats`: runs with the name of their light.
pub fn statistics<'a>(
    hits: &FirstHits,
    trees: &TreeStatistics,
    runs: impl Iterator<Item = (&'a str, &'a TesterRun)>,
) -> String {
    let mut text = String::new();
    let rays = hits.size.pixels() as u64;
    let _ = writeln!(text, "t-buffer: {} rays, {} ray-primitive tests", grouped(rays), grouped(hits.tests));
    let _ = writeln!(
        text,
        "ray trees: {} of {} eye rays hit, {} reflection and {} refraction rays, {} dropped, {:.2} nodes a tree",
        grouped(trees.eye_hits),
        grouped(trees.eye_rays),
        grouped(trees.reflection_rays),
        grouped(trees.refraction_rays),
        grouped(trees.dropped),
        trees.average_tree(),
    );
    for (light, run) in runs {
        let a_query = |count: u64| count as f64 / run.occluded.len().max(1) as f64;
        let c = &run.counters;
        // The arbiter and Embree do not count.
        if *c == Counters::default() {
            continue;
        }
        let _ = write!(
            text,
            "{light} {}: {:.2} tests, {:.2} lists entered, {:.4} full occlusions, {:.5} undecided, \
             {:.6} exact a query",
            run.name,
            a_query(c.tests),
            a_query(c.lists),
            a_query(c.full_occlusions),
            a_query(c.undecided),
            a_query(c.exact),
        );
        if c.volume_tests > 0 {
            let _ = write!(text, "; {:.2} bounding volumes", a_query(c.volume_tests));
        }
        if c.coherence_hits > 0 {
            let _ = write!(text, "; {:.4} by the last occluder", a_query(c.coherence_hits));
        }
        text.push('\n');
        for (name, value) in &run.statistics {
            let _ = writeln!(text, "  {name}: {value}");
        }
    }
    text
}

/// Bytes in a unit that reads well.
pub fn bytes(value: usize) -> String {
    match value {
        0..10_240 => format!("{value} B"),
        10_240..10_485_760 => format!("{} KiB", value / 1024),
        _ => format!("{} MiB", value / 1_048_576),
    }
}
