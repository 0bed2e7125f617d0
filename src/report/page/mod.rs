//! One page of everything that `validate`, `bench` and `reproduce` left in a folder: maps to look into, tables to
//! sort, plots of time against error. It is a single file that needs no network and opens from the disk.
//!
//! Templates are askama's: they are checked when the program is compiled, so that no key can be missing when a person
//! waits for the page, and what comes from a file is escaped unless the template says otherwise. Plots are `plotters`'
//! SVG within the page, where its style sheet gives them the colours of day and night. What the browser does itself,
//! maps and sorting, is in `assets/`, without a library.

mod bench;
mod documents;
mod fields;
mod found;
mod picture;
mod planes;
mod plots;
mod reproduction;
mod table;
mod validation;
mod viewer;

use crate::error::{Error, Result};
use askama::Template;
use bench::BenchPart;
use found::Found;
use reproduction::ReproductionPart;
use std::path::Path;
use table::Table;
use validation::ValidationPart;

const STYLE: &str = include_str!("assets/page.css");

/// In the order in which they need each other.
const SCRIPTS: [&str; 5] = [
    include_str!("assets/decode.js"),
    include_str!("assets/maps.js"),
    include_str!("assets/viewer.js"),
    include_str!("assets/tables.js"),
    include_str!("assets/page.js"),
];

/// A page, and what is in it.
#[derive(Debug)]
pub struct Page {
    /// The whole file.
    pub html: String,
    /// Documents of `validate`, `bench` and `reproduce`.
    pub documents: [usize; 3],
}

#[derive(Template)]
#[template(path = "page.html")]
struct PageTemplate<'a> {
    version: &'static str,
    style: &'static str,
    script: String,
    summary: String,
    overview: Option<Table>,
    validations: &'a [ValidationPart],
    benches: &'a [BenchPart],
    reproductions: &'a [ReproductionPart],
}

/// The page of a folder: of every `validate.json`, `bench.json` and `reproduce.json` in it and in folders in it, with the
/// images beside them. `say` is told what is being read.
///
/// # Errors
/// [`Error::Usage`] if the folder has no such file; otherwise in one line what cannot be read, or is not what such a
/// file holds, and where.
pub fn page(folder: &Path, say: &dyn Fn(&str)) -> Result<Page> {
    let found = Found::in_folder(folder)?;
    let name = |path: &Path| found::name_of(folder, path);
    let mut validations = Vec::new();
    for (number, path) in found.validations.iter().enumerate() {
        say(&format!("reading {}", path.display()));
        validations.push(ValidationPart::read(number, &name(path), path)?);
    }
    let mut benches = Vec::new();
    for (number, path) in found.benches.iter().enumerate() {
        say(&format!("reading {}", path.display()));
        benches.push(BenchPart::read(number, &name(path), path)?);
    }
    let mut reproductions = Vec::new();
    for (number, path) in found.reproductions.iter().enumerate() {
        say(&format!("reading {}", path.display()));
        reproductions.push(ReproductionPart::read(number, &name(path), path)?);
    }
    let template = PageTemplate {
        version: env!("CARGO_PKG_VERSION"),
        style: STYLE,
        script: SCRIPTS.concat(),
        summary: validation::summary(&validations),
        overview: validation::overview(&validations),
        validations: &validations,
        benches: &benches,
        reproductions: &reproductions,
    };
    let html = template.render().map_err(|error| Error::Usage(format!("the page: {error}")))?;
    Ok(Page { html, documents: [validations.len(), benches.len(), reproductions.len()] })
}
