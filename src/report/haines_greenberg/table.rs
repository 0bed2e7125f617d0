//! The tables for people: each figure measured here, and the paper's beside it.

use super::document::{ColumnReport, Counts, Environment, Reproduction};
use super::paper::{Printed, RESOLUTIONS};
use super::quantity::Quantity;
use crate::film::grouped;
use crate::report::table::bytes;
use std::fmt::Write;

/// What has to be known to read the tables.
const NOTES: &str = "\
Each column: measured here | printed in the paper; ? marks a best reading of damaged print.
- Times are wall-clock seconds here, medians of a few interleaved repetitions, and minutes of a VAX 11/780 there.
- A polygon of n corners is n - 2 triangles here, and each of them is one to test and one to list: a test of a
  quadrilateral counts as two, for the control and for the light buffers alike. The captions say how many triangles a
  polygon has. Volumes that are tested are not counted, as in the paper.
- List items are all that a list holds: records of opaque and of transparent surfaces, bounding-volume records and
  full-occlusion records. A square is non-empty if its list holds a surface.
- Light buffers cull the far sides of closed solids, put more than six triangles of an object in a square behind a
  bounding volume, and use no object coherence, as in the paper. The control is the tester bounding-volumes.
- Miscellaneous is making the scene, what its lights share (convexity, closed solids), and choosing who is asked.
";

/// All tables, and the check.
pub fn tables(document: &Reproduction) -> String {
    let mut text = format!(
        "{}\n{} threads, at most {} repetitions\n\n{NOTES}\n",
        document.paper, document.threads, document.repetitions
    );
    for environment in &document.environments {
        caption(&mut text, environment);
        paper_table(&mut text, environment);
        resolutions(&mut text, environment);
        truth(&mut text, environment);
        text.push('\n');
    }
    checks(&mut text, document);
    let _ = writeln!(text, "{} wrong answers of exact native testers", grouped(document.native_wrong()));
    text
}

fn caption(text: &mut String, environment: &Environment) {
    let _ = writeln!(
        text,
        "Figure {}, {} (builtin:{}), {}x{}",
        environment.figure, environment.title, environment.name, environment.width, environment.height
    );
    let _ = writeln!(text, "  here:  {}", contents(environment.counts, environment.average_tree_size));
    let a_polygon = f64::from(environment.triangles) / f64::from(environment.counts.polygons.max(1));
    let triangles = grouped(u64::from(environment.triangles));
    let _ = writeln!(text, "         {triangles} triangles, {a_polygon:.2} a polygon");
    let _ = writeln!(
        text,
        "  paper: {}",
        contents(environment.paper_counts, environment.paper_average_tree_size)
    );
    if let Some(other) = environment.buffers_of {
        let _ = writeln!(text, "  The light buffers are those of {other}, from another view: no preprocess.");
    }
}

fn contents(counts: Counts, tree: f64) -> String {
    let count = |count: u32| grouped(u64::from(count));
    format!(
        "{} objects, {} polygons, {} spheres, {} cylinders, {} quadrics, {} lights, average tree {tree:.2}",
        count(counts.objects),
        count(counts.polygons),
        count(counts.spheres),
        count(counts.cylinders),
        count(counts.quadrics),
        count(counts.lights),
    )
}

/// The paper's table: its rows and columns.
fn paper_table(text: &mut String, environment: &Environment) {
    let is_paper = |column: &&ColumnReport| column.resolution.is_none_or(|r| RESOLUTIONS.contains(&r));
    let columns: Vec<&ColumnReport> = environment.columns.iter().filter(is_paper).collect();
    let _ = write!(text, "  {:<24}", "");
    for column in &columns {
        let _ = write!(text, " {:>19}", column.name);
    }
    text.push('\n');
    for quantity in Quantity::ALL {
        let _ = write!(text, "  {:<24}", quantity.label());
        for column in &columns {
            let printed = quantity.printed(environment.table, column.resolution);
            let measured = quantity.measured(environment, column);
            let ours = measured.map_or("-".into(), |value| measured_text(quantity, value));
            let theirs = printed.map_or("-".into(), |value| printed_text(quantity, value));
            let _ = write!(text, " {ours:>9} |{theirs:>8}");
        }
        text.push('\n');
    }
    if environment.table.colour.is_none() {
        let _ = writeln!(
            text,
            "  The paper's colour calculation and miscellaneous are {} minutes together.",
            environment.table.colour_and_miscellaneous
        );
    }
}

fn measured_text(quantity: Quantity, value: f64) -> String {
    match quantity {
        Quantity::Items => grouped(value as u64),
        Quantity::NonEmpty | Quantity::AverageMaximum => format!("{value:.1}"),
        Quantity::ItemsPerSquare => decimals(value),
        Quantity::TestsPerRay => decimals(value),
        _ => format!("{value:.4}"),
    }
}

fn printed_text(quantity: Quantity, Printed { value, best_reading }: Printed) -> String {
    let mark = if best_reading { "?" } else { "" };
    match quantity {
        Quantity::Items => format!("{}{mark}", grouped(value as u64)),
        Quantity::ItemsPerSquare => format!("{value:.2}{mark}"),
        _ => format!("{value}{mark}"),
    }
}

/// Two decimals, or three digits of what is less.
fn decimals(value: f64) -> String {
    match value {
        100.0.. => format!("{value:.1}"),
        0.1.. => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}

/// What each resolution is worth, finer ones than the paper's among them.
fn resolutions(text: &mut String, environment: &Environment) {
    let _ = writeln!(
        text,
        "  {:<9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} {:>9} {:>12} {:>10} {:>6} {:>7}",
        "",
        "build s",
        "query s",
        "ns/query",
        "control/",
        "tests/ray",
        "volumes",
        "full occ.",
        "items",
        "memory",
        "wrong",
        "unlike"
    );
    for column in &environment.columns {
        let items = column.lists.map_or("-".into(), |lists| grouped(lists.items));
        let _ = writeln!(
            text,
            "  {:<9} {:>9.4} {:>9.4} {:>9.1} {:>9.2} {:>9} {:>10} {:>9.3} {:>12} {:>10} {:>6} {:>7}",
            column.name,
            column.preprocess_seconds,
            column.shadow_testing_seconds,
            column.ns_per_query,
            column.control_over_this,
            decimals(column.tests_per_ray),
            decimals(column.volume_tests_per_ray),
            column.full_occlusions_per_ray,
            items,
            bytes(column.bytes as usize),
            column.wrong,
            column.unlike_control,
        );
    }
    if !environment.skipped.is_empty() {
        let _ = writeln!(text, "  skipped for want of memory: {}", environment.skipped.join(", "));
    }
}

fn truth(text: &mut String, environment: &Environment) {
    let truth = &environment.truth;
    let testers: Vec<String> =
        truth.testers.iter().map(|(name, wrong)| format!("{name} {}", grouped(*wrong))).collect();
    let _ = writeln!(
        text,
        "  {} shadow rays, {} of them decided by the arbiter ({} occluded, {} touching); wrong there, set up as usual: {}",
        grouped(environment.queries),
        grouped(truth.queries),
        grouped(truth.occluded),
        grouped(truth.touching),
        testers.join(", ")
    );
}

/// The claim about shadow tests per ray.
fn checks(text: &mut String, document: &Reproduction) {
    let _ = writeln!(
        text,
        "Shadow tests per ray: do they fall with R, and how far below the control's?\n  {:<18} {:>6} {:>22} {:>10} {:>22} {:>10}   as far as in the paper?",
        "", "falls?", "control / R = 100", "as far?", "R = 10 / R = 100", "control /"
    );
    let answer = |holds: bool| if holds { "yes" } else { "no" };
    for environment in &document.environments {
        let check = &environment.check;
        let paper = check.paper_control_over_finest.map_or("-".into(), |ratio| format!("{ratio:.1}"));
        let unprinted = match check.paper_control_over_finest {
            Some(_) => "",
            None => ", from R = 10: the paper prints no control",
        };
        let _ = writeln!(
            text,
            "  {:<18} {:>6} {:>12.1} |{:>8} {:>10} {:>12.1} |{:>8.1} {:>10.1}   {} at R = {}{}",
            environment.name,
            answer(check.falls),
            check.control_over_finest,
            paper,
            answer(check.as_far_at_finest),
            check.coarsest_over_finest,
            check.paper_coarsest_over_finest,
            check.control_over_last,
            answer(check.ends_as_far),
            check.last,
            unprinted,
        );
    }
    let holds = document.environments.iter().filter(|environment| environment.check.holds()).count();
    let _ = writeln!(
        text,
        "  falls, and ends as far down as in the paper, in {holds} of {}",
        document.environments.len()
    );
}
