//! What `bench` measured: plots, and a table of all rows.

use super::documents;
use super::fields::Fields;
use super::plots::{self, AtResolution, Plot};
use super::table::{Cell, Column, Table};
use crate::error::Result;
use crate::film::grouped;
use crate::report::bench::document::{Document, RatioReport, RowReport};
use crate::report::bench::plots::{Clock, front_of, group_panels, groups, growth_panels};
use std::path::Path;

/// One document.
#[derive(Debug)]
pub(super) struct BenchPart {
    pub(super) id: String,
    pub(super) folder: String,
    pub(super) plots: Vec<Plot>,
    /// Sentences on plots that there is no data for.
    pub(super) absent: Vec<String>,
    pub(super) tables: Vec<Table>,
    pub(super) fields: Fields,
}

impl BenchPart {
    /// From the document.
    ///
    /// # Errors
    /// If it cannot be read, or a plot cannot be drawn.
    pub(super) fn read(number: usize, folder: &str, path: &Path) -> Result<BenchPart> {
        let document: Document = documents::read(path)?;
        let mut plots = Vec::new();
        let mut absent = Vec::new();
        for group in groups(&document.rows) {
            let title = format!("Time against error: {}", group_name(&group[0]));
            let words = [Clock::Queries, Clock::Frame].map(|clock| front_in_words(group, clock)).join(" ");
            plots.push(Plot::new(title, group_panels(group), words)?);
        }
        if document.rows.is_empty() {
            absent.push("Time against error is not drawn: no rows were measured, only what grows.".into());
        }
        let mut any_resolution = false;
        for group in groups(&document.rows) {
            let title = format!("Resolution: {}", group_name(&group[0]));
            if let Some(plot) = plots::resolution(&title, &resolutions(group))? {
                plots.push(plot);
                any_resolution = true;
            }
        }
        if !any_resolution {
            absent.push(
                "R against time, error and memory is not drawn: it takes several resolutions, as by \
                 `bench --resolution 64,128,256,512`."
                    .into(),
            );
        }
        for over in ["triangles", "lights", "pixels"] {
            let panels = growth_panels(&document, over);
            if panels.is_empty() {
                absent.push(format!(
                    "Time against {over} is not drawn: this run has none; `bench --growth {over}` measures it."
                ));
            } else {
                let words = "The fastest of each side at each step, for frames and for queries.";
                plots.push(Plot::new(format!("Time against {over}"), panels, words)?);
            }
        }
        let mut tables = Vec::new();
        if !document.ratios.is_empty() {
            tables.push(ratios(&document.ratios));
        }
        tables.extend(groups(&document.rows).into_iter().map(rows));
        if !document.growth.is_empty() {
            tables.push(growth(&document));
        }
        if !document.skipped.is_empty() {
            tables.push(skipped(&document));
        }
        let mut fields = Fields::default();
        fields.add("lightbuffer", document.machine.version.to_string());
        fields.machine(&document.machine);
        if let (Some(version), Some(isa)) = (&document.machine.embree, &document.machine.embree_isa) {
            fields.add("Embree", format!("{version}, {isa}"));
        }
        fields.add("rounds", grouped(document.repeats.into()));
        Ok(BenchPart {
            id: format!("bench-{}", number + 1),
            folder: folder.into(),
            plots,
            absent,
            tables,
            fields,
        })
    }
}

fn group_name(row: &RowReport) -> String {
    let lights = if row.lights == 1 { "1 light".into() } else { format!("{} lights", row.lights) };
    format!("{}, {lights}, {} × {}, threads: {}", row.scene, row.width, row.height, row.threads)
}

fn front_in_words(rows: &[RowReport], clock: Clock) -> String {
    let say = |row: &RowReport| {
        format!("{} {} ({:.1}, {} wrong)", row.tester, row.parameter, clock.time(row), grouped(row.wrong))
    };
    let mut front: Vec<String> = front_of(rows, clock).into_iter().map(say).collect();
    front.dedup();
    format!("Pareto front by {}: {}.", clock.label(), front.join("; "))
}

/// The light buffers of a group whose resolution was set, in the order of queries that comes first for each.
fn resolutions(rows: &[RowReport]) -> Vec<AtResolution> {
    let mut steps: Vec<AtResolution> = Vec::new();
    let order = rows.iter().rev().find(|row| cells(row).is_some()).map(|row| row.order.clone());
    for row in rows.iter().filter(|row| Some(&row.order) == order.as_ref()) {
        if let Some(cells) = cells(row) {
            steps.push(AtResolution {
                cells,
                query_seconds: row.query_seconds,
                build_seconds: row.build_seconds,
                bytes: row.bytes,
                wrong: row.wrong,
            });
        }
    }
    steps
}

/// `R=256` among the words of a parameter.
fn cells(row: &RowReport) -> Option<u32> {
    row.parameter.split(' ').find_map(|word| word.strip_prefix("R=")?.parse().ok())
}

fn ratios(ratios: &[RatioReport]) -> Table {
    let ratio = |value: Option<f64>| value.map_or_else(Cell::none, |value| Cell::number(value, 2));
    let between = |names: &Option<[String; 2]>| {
        Cell::words(
            names.as_ref().map_or(String::new(), |[embree, native]| format!("{embree} over {native}")),
        )
    };
    let row = |entry: &RatioReport| {
        vec![
            Cell::words(&entry.scene),
            Cell::count(entry.lights),
            Cell::count(entry.threads),
            ratio(entry.query),
            between(&entry.query_between),
            ratio(entry.frame),
            between(&entry.frame_between),
        ]
    };
    Table {
        caption:
            "Ratios: Embree’s fastest over the fastest exact native tester; above 1 the native one is faster"
                .into(),
        columns: vec![
            Column::words("scene"),
            Column::numbers("lights"),
            Column::numbers("threads"),
            Column::numbers("queries"),
            Column::words("between"),
            Column::numbers("frames"),
            Column::words("between"),
        ],
        rows: ratios.iter().map(row).collect(),
    }
}

const COLUMNS: [&str; 9] =
    ["ns/query", "± %", "frame ms", "build ms", "memory", "false shadow", "false light", "wrong", "checked"];

fn columns(first: Vec<Column>) -> Vec<Column> {
    let hint = |title: &'static str| match title {
        "± %" => "half of the range of its times over their median; – for a single turn",
        "frame ms" => "from indexed triangles and surface points to the answers",
        "checked" => "answers that were held against the truth",
        _ => "",
    };
    let numbers = COLUMNS.into_iter().map(|title| Column::numbers(title).hint(hint(title)));
    first.into_iter().chain(numbers).collect()
}

fn cells_of(row: &RowReport) -> Vec<Cell> {
    let [shortest, longest] = row.query_spread;
    let spread = 50.0 * (longest - shortest) / row.query_seconds.max(f64::MIN_POSITIVE);
    let wrong = if row.side == "native" { Cell::wrong } else { Cell::count };
    vec![
        Cell::number(row.ns_per_query, 2),
        if row.rounds > 1 { Cell::number(spread, 0) } else { Cell::none() },
        Cell::number(row.frame_seconds * 1e3, 1),
        Cell::number(row.build_seconds * 1e3, 1),
        Cell::bytes(row.bytes),
        Cell::count(row.false_shadow),
        Cell::count(row.false_light),
        wrong(row.wrong),
        Cell::count(row.wrong_checked),
    ]
}

fn names(row: &RowReport) -> Vec<Cell> {
    vec![Cell::words(&*row.tester), Cell::words(&*row.side), Cell::words(&row.parameter)]
}

fn rows(group: &[RowReport]) -> Table {
    let caption = format!(
        "{}: {} primitives, {} queries",
        group_name(&group[0]),
        grouped(group[0].primitives),
        grouped(group[0].queries)
    );
    let first = vec![Column::words("tester"), Column::words("side"), Column::words("parameter")];
    let rows = group.iter().map(|row| names(row).into_iter().chain(cells_of(row)).collect());
    Table { caption, columns: columns(first), rows: rows.collect() }
}

fn growth(document: &Document) -> Table {
    let first = vec![
        Column::words("tester"),
        Column::words("side"),
        Column::words("parameter"),
        Column::words("over"),
        Column::numbers("at"),
        Column::words("scene"),
        Column::numbers("threads"),
    ];
    let taken = document.growth.iter().filter(|step| step.row.interleaved);
    let rows = taken.map(|step| {
        let place = [
            Cell::words(&*step.over),
            Cell::count(step.at),
            Cell::words(&step.row.scene),
            Cell::count(step.row.threads),
        ];
        names(&step.row).into_iter().chain(place).chain(cells_of(&step.row)).collect()
    });
    let rows = rows.collect();
    Table { caption: "What grows: those that took part in the rounds".into(), columns: columns(first), rows }
}

fn skipped(document: &Document) -> Table {
    let row = |entry: &crate::report::bench::document::SkippedReport| {
        vec![
            Cell::words(&entry.skipped.tester),
            Cell::words(&entry.scene),
            Cell::count(entry.lights),
            Cell::words(&entry.skipped.why),
        ]
    };
    Table {
        caption: "Who did not take part, and why".into(),
        columns: vec![
            Column::words("tester"),
            Column::words("scene"),
            Column::numbers("lights"),
            Column::words("why"),
        ],
        rows: document.skipped.iter().map(row).collect(),
    }
}
