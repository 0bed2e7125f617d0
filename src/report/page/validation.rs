//! What `validate` found of one scene: its maps, its tables and what it was found with.

use super::documents::{self, Causes, Epsilon, Light, Metrics, Tester, Validation};
use super::fields::Fields;
use super::table::{Cell, Column, Place, Table};
use super::viewer::Viewer;
use crate::error::Result;
use crate::film::grouped;
use crate::shadow::{Basis, find};
use std::collections::BTreeMap;
use std::path::Path;

/// One document.
#[derive(Debug)]
pub(super) struct ValidationPart {
    pub(super) id: String,
    pub(super) scene: String,
    pub(super) folder: String,
    pub(super) verdict: String,
    pub(super) fields: Fields,
    pub(super) tables: Vec<Table>,
    /// None for the hard cases, which have no image, and where the image is not there.
    pub(super) viewer: Option<Viewer>,
    /// Why there are no maps.
    pub(super) absent: Option<String>,
    counts: Counts,
    size: String,
    lights: u64,
}

#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    queries: u64,
    native_wrong: u64,
    native_answers: u64,
    embree_wrong: Option<u64>,
    touching: u64,
}

impl ValidationPart {
    /// From the document and the images beside it.
    ///
    /// # Errors
    /// If something cannot be read, or is not of one run.
    pub(super) fn read(number: usize, folder: &str, path: &Path) -> Result<ValidationPart> {
        let document: Validation = documents::read(path)?;
        let id = format!("scene-{}", number + 1);
        let is_there = path.with_file_name("image.exr").exists();
        let viewer = match document.cases.is_empty() && is_there {
            true => Some(Viewer::read(id.clone(), path, &document)?),
            false => None,
        };
        let absent = (document.cases.is_empty() && !is_there).then(|| {
            "The maps are not drawn: image.exr is not beside this validate.json; `validate -o DIR` writes both.".into()
        });
        let counts = counts(&document);
        Ok(ValidationPart {
            scene: document.scene.clone(),
            folder: folder.into(),
            verdict: verdict(&counts),
            fields: fields(&document, viewer.as_ref()),
            tables: tables(&id, &document, viewer.is_some()),
            viewer,
            absent,
            counts,
            size: match document.width {
                0 => "no image".into(),
                _ => format!("{} × {}", document.width, document.height),
            },
            lights: document.lights.len() as u64,
            id,
        })
    }
}

fn is_native(name: &str) -> bool {
    find(name).is_ok_and(|entry| entry.basis == Basis::Exact)
}

fn counts(document: &Validation) -> Counts {
    let natives = || document.totals.testers.iter().filter(|(name, _)| is_native(name));
    let asked = |name: &str| -> u64 {
        let lights = document.lights.iter().filter(|light| light.testers.contains_key(name));
        lights.map(|light| light.queries).sum()
    };
    Counts {
        queries: document.totals.queries,
        native_wrong: natives().map(|(_, tester)| tester.wrong).sum(),
        native_answers: match document.cases.is_empty() {
            true => natives().map(|(name, _)| asked(name)).sum(),
            false => document.totals.queries * natives().count() as u64,
        },
        embree_wrong: document.totals.testers.get("embree").map(|tester| tester.wrong),
        touching: document.totals.verdicts.touching,
    }
}

fn verdict(counts: &Counts) -> String {
    let native = format!(
        "{} of {} native answers wrong",
        grouped(counts.native_wrong),
        grouped(counts.native_answers)
    );
    match counts.embree_wrong {
        Some(wrong) => format!("{native}, {} of {} of Embree’s", grouped(wrong), grouped(counts.queries)),
        None => format!("{native}; Embree was not asked"),
    }
}

/// A sentence over all documents.
pub(super) fn summary(parts: &[ValidationPart]) -> String {
    let sum = |count: fn(&Counts) -> u64| parts.iter().map(|part| count(&part.counts)).sum();
    let all = Counts {
        queries: parts
            .iter()
            .filter(|part| part.counts.embree_wrong.is_some())
            .map(|p| p.counts.queries)
            .sum(),
        native_wrong: sum(|counts| counts.native_wrong),
        native_answers: sum(|counts| counts.native_answers),
        embree_wrong: parts.iter().filter_map(|part| part.counts.embree_wrong).reduce(|a, b| a + b),
        touching: 0,
    };
    match parts {
        [] => String::new(),
        [_] => format!("One scene held against exact truth: {}.", verdict(&all)),
        many => format!("{} scenes held against exact truth: {}.", many.len(), verdict(&all)),
    }
}

/// A row a scene, if there are several.
pub(super) fn overview(parts: &[ValidationPart]) -> Option<Table> {
    if parts.len() < 2 {
        return None;
    }
    let row = |part: &ValidationPart| {
        vec![
            Cell::words(&part.scene),
            Cell::words(&part.folder),
            Cell::words(&part.size),
            Cell::count(part.lights),
            Cell::count(part.counts.queries),
            Cell::wrong(part.counts.native_wrong),
            part.counts.embree_wrong.map_or_else(Cell::none, Cell::count),
            Cell::count(part.counts.touching),
        ]
    };
    Some(Table {
        caption: "Scenes".into(),
        columns: vec![
            Column::words("scene"),
            Column::words("folder"),
            Column::words("image"),
            Column::numbers("lights"),
            Column::numbers("queries"),
            Column::numbers("native wrong").hint("wrong answers of all testers that claim to be exact"),
            Column::numbers("Embree wrong"),
            Column::numbers("touching").hint("queries on the very edge between light and shadow"),
        ],
        rows: parts.iter().map(row).collect(),
    })
}

fn fields(document: &Validation, viewer: Option<&Viewer>) -> Fields {
    let mut fields = Fields::default();
    fields.add("lightbuffer", &document.version).add("threads", grouped(document.threads));
    if document.width > 0 {
        fields.add("image", format!("{} × {}", document.width, document.height));
    }
    if let Some(embree) = &document.embree {
        let epsilon = embree.epsilon as f32;
        fields.add("Embree", format!("{}, {}, epsilon {epsilon:e}", embree.version, embree.isa));
    }
    let attribute = |name: &str| {
        let attributes = viewer.map(|viewer| viewer.attributes.as_slice()).unwrap_or_default();
        attributes.iter().find(|(other, _)| other == name).map(|(_, text)| text.clone()).unwrap_or_default()
    };
    for (name, label) in [
        ("camera", "camera"),
        ("sceneHash", "hash of the scene"),
        ("shadow", "shadows in the picture by"),
        ("shadowBuffer", "shadow-buffer"),
        ("leftOut", "left out"),
    ] {
        fields.add(label, attribute(name));
    }
    fields.add("not asked", document.skipped.join(", "));
    if let Some(machine) = &document.machine {
        fields.machine(machine);
    }
    fields
}

fn tables(id: &str, document: &Validation, has_maps: bool) -> Vec<Table> {
    let mut tables = Vec::new();
    for light in &document.lights {
        tables.push(testers(&light_caption(light), &light.testers, &BTreeMap::new()));
    }
    let totals = &document.totals;
    if document.lights.len() != 1 {
        let caption = format!("All lights: {} queries", grouped(totals.queries));
        let caption = if document.cases.is_empty() { caption } else { "All cases".into() };
        tables.push(testers(&caption, &totals.testers, &document.image_metrics));
    } else if let Some(only) = tables.first_mut() {
        *only = testers(&only.caption, &totals.testers, &document.image_metrics);
    }
    if !document.cases.is_empty() {
        tables.push(cases(document));
    }
    if !document.epsilon_sweep.is_empty() {
        tables.push(epsilons(&document.epsilon_sweep));
    }
    if has_maps {
        tables.extend(wrong_pixels(id, &document.lights));
    }
    tables
}

fn light_caption(light: &Light) -> String {
    let mut caption = format!("Light {}: {} queries", light.name, grouped(light.queries));
    for (count, what) in [
        (light.facing_away, "points face away"),
        (light.outside_cone, "outside the cone"),
        (light.not_receiving, "on objects without shadows"),
        (light.verdicts.touching, "touching"),
        (light.verdicts.native_wrong, "where the native tester alone is wrong"),
        (light.verdicts.embree_wrong, "where Embree alone is wrong"),
        (light.verdicts.both_wrong, "where both are wrong"),
    ] {
        if count > 0 {
            caption += &format!(", {} {what}", grouped(count));
        }
    }
    caption
}

fn testers(caption: &str, testers: &BTreeMap<String, Tester>, metrics: &BTreeMap<String, Metrics>) -> Table {
    let mut columns = vec![
        Column::words("tester"),
        Column::numbers("build ms"),
        Column::numbers("ns/query").hint("wall-clock time on all threads divided by queries"),
        Column::numbers("memory"),
        Column::numbers("false shadow").hint("lit points that it calls occluded"),
        Column::numbers("false light").hint("occluded points that it calls lit"),
        Column::numbers("wrong"),
        Column::numbers("undecided").hint("tests left to more precise arithmetic"),
        Column::words("wrong by"),
    ];
    if !metrics.is_empty() {
        columns.extend([
            Column::numbers("MSE")
                .hint("mean squared error of the picture in linear light, against that of the truth"),
            Column::numbers("MRSE").hint("mean relative squared error, relMSE"),
            Column::numbers("PSNR dB").hint("of the mean squared error, for a peak of 1"),
            Column::numbers("SSIM")
                .hint("structural similarity of the luminances as seen, 1 for equal pictures"),
            Column::numbers("FLIP").hint("what an eye sees that flips between the pictures, mean"),
        ]);
    }
    let row = |(name, tester): (&String, &Tester)| {
        let wrong = if is_native(name) { Cell::wrong } else { Cell::count };
        let mut row = vec![
            Cell::words(name),
            Cell::number(tester.build_seconds * 1e3, 1),
            Cell::number(tester.ns_per_query, 1),
            Cell::bytes(tester.bytes),
            Cell::count(tester.false_shadow),
            Cell::count(tester.false_light),
            wrong(tester.wrong),
            Cell::count(tester.undecided),
            Cell::words(causes(tester)),
        ];
        if !metrics.is_empty() {
            row.extend(metrics.get(name).map_or_else(|| vec![Cell::none(); 5], picture_metrics));
        }
        row
    };
    let mut ordered: Vec<_> = testers.iter().collect();
    ordered.sort_by_key(|(name, _)| place(name));
    Table { caption: caption.into(), columns, rows: ordered.into_iter().map(row).collect() }
}

/// The arbiter first, then in the order of the registry.
fn place(name: &str) -> usize {
    crate::shadow::testers().position(|entry| entry.name == name).unwrap_or(usize::MAX)
}

/// Above any that there are: what has no difference is the best.
const INFINITE_DECIBELS: f64 = 1e6;

fn picture_metrics(metrics: &Metrics) -> Vec<Cell> {
    let psnr = match metrics.psnr {
        Some(psnr) => Cell::number(psnr, 1),
        None => Cell { sort: Some(INFINITE_DECIBELS), ..Cell::words("∞") },
    };
    vec![
        Cell::small(metrics.mse),
        Cell::small(metrics.mrse),
        psnr,
        metrics.ssim.map_or_else(Cell::none, |ssim| Cell::number(ssim, 6)),
        Cell::small(metrics.flip),
    ]
}

fn causes(tester: &Tester) -> String {
    let Causes { epsilon, input_rounding, traversal } = match tester.causes {
        Some(causes) if tester.wrong > 0 => causes,
        _ if tester.false_transmittance > 0 => {
            return format!("{} of what is crossed", grouped(tester.false_transmittance));
        }
        _ => return String::new(),
    };
    let parts = [(epsilon, "epsilon"), (input_rounding, "input rounding"), (traversal, "traversal")];
    let parts = parts.into_iter().filter(|part| part.0 > 0);
    parts.map(|(count, what)| format!("{what} {}", grouped(count))).collect::<Vec<_>>().join(", ")
}

fn cases(document: &Validation) -> Table {
    let names: Vec<&String> = document.totals.testers.keys().collect();
    let row = |case: &documents::Case| {
        let mut row = vec![
            Cell { sort: Some(case.number as f64), ..Cell::words(format!("{} {}", case.number, case.name)) },
            Cell::count(case.queries),
        ];
        let all: Vec<String> = names
            .iter()
            .filter_map(|name| {
                let tester = case.testers.get(*name)?;
                match (tester.wrong, &tester.refused) {
                    (Some(wrong), _) if wrong > 0 => Some(format!("{name} {}", grouped(wrong))),
                    (None, Some(_)) => Some(format!("{name} refused")),
                    _ => None,
                }
            })
            .collect();
        let of = |native: bool| {
            let testers =
                case.testers.iter().filter(|(name, _)| is_native(name) == native && *name != "exact");
            testers.filter_map(|(_, tester)| tester.wrong).sum::<u64>()
        };
        row.extend([Cell::wrong(of(true)), Cell::count(of(false)), Cell::words(all.join(", "))]);
        row
    };
    Table {
        caption: "Hard cases".into(),
        columns: vec![
            Column::words("case"),
            Column::numbers("queries"),
            Column::numbers("native wrong"),
            Column::numbers("others wrong"),
            Column::words("who"),
        ],
        rows: document.cases.iter().map(row).collect(),
    }
}

fn epsilons(sweep: &[Epsilon]) -> Table {
    let row = |step: &Epsilon| {
        vec![
            Cell::words(&step.tester),
            Cell { sort: Some(step.epsilon), ..Cell::words(format!("{:e}", step.epsilon as f32)) },
            Cell::count(step.false_shadow),
            Cell::count(step.false_light),
            Cell::count(step.false_shadow + step.false_light),
        ]
    };
    Table {
        caption: "Epsilons: shares of a segment left out at both ends".into(),
        columns: vec![
            Column::words("tester"),
            Column::numbers("epsilon"),
            Column::numbers("false shadow").hint("acne"),
            Column::numbers("false light").hint("leaks"),
            Column::numbers("wrong"),
        ],
        rows: sweep.iter().map(row).collect(),
    }
}

/// A row a pixel that is listed; none if there are none.
fn wrong_pixels(id: &str, lights: &[Light]) -> Option<Table> {
    let mut rows = Vec::new();
    for (number, light) in lights.iter().enumerate() {
        for wrong in &light.wrong_pixels {
            let place = Place { viewer: id.into(), light: number, pixel: wrong.pixel };
            let [x, y] = wrong.pixel;
            rows.push(vec![
                Cell { place: Some(place), ..Cell::words(format!("{x},{y}")) },
                Cell::words(&light.name),
                Cell::words(if wrong.truth { "occluded" } else { "lit" }),
                Cell::words(wrong.testers.join(", ")),
            ]);
        }
    }
    (!rows.is_empty()).then(|| Table {
        caption: "Wrong pixels, the first hundred of each light".into(),
        columns: vec![
            Column::words("pixel").hint("leads to the maps"),
            Column::words("light"),
            Column::words("truth"),
            Column::words("wrong"),
        ],
        rows,
    })
}
