//! What `reproduce` measured again of a paper: its tables, plots and pictures.

use super::documents::{self, Environment, Figure, Reproduction};
use super::fields::Fields;
use super::picture;
use super::plots::{self, AtResolution, Plot};
use super::table::{Cell, Column, Table};
use crate::error::Result;
use crate::film::grouped;
use std::path::Path;

/// One document.
#[derive(Debug)]
pub(super) struct ReproductionPart {
    pub(super) id: String,
    pub(super) paper: String,
    /// For a list of contents.
    pub(super) short: String,
    pub(super) folder: String,
    pub(super) plots: Vec<Plot>,
    pub(super) figures: Vec<FigurePart>,
    pub(super) fields: Fields,
}

/// One figure or environment.
#[derive(Debug)]
pub(super) struct FigurePart {
    pub(super) title: String,
    pub(super) images: Vec<Image>,
    pub(super) table: Option<Table>,
}

#[derive(Debug)]
pub(super) struct Image {
    pub(super) address: String,
    pub(super) caption: String,
    /// `plot` or `picture`.
    pub(super) class: &'static str,
}

impl ReproductionPart {
    /// From the document and the images beside it.
    ///
    /// # Errors
    /// If something cannot be read.
    pub(super) fn read(number: usize, folder: &str, path: &Path) -> Result<ReproductionPart> {
        let document: Reproduction = documents::read(path)?;
        let mut plots = Vec::new();
        let mut figures = Vec::new();
        for environment in &document.environments {
            let title = format!("Resolution: {}", environment.title);
            plots.extend(plots::resolution(&title, &resolutions(environment))?);
            figures.push(environment_part(path, environment)?);
        }
        for figure in &document.figures {
            figures.push(figure_part(path, figure)?);
        }
        let mut fields = Fields::default();
        fields.add("lightbuffer", &document.version).add("threads", grouped(document.threads));
        fields.add("most repetitions", grouped(document.repetitions));
        let short = document.paper.split(", ").next().unwrap_or(&document.paper).to_string();
        Ok(ReproductionPart {
            id: format!("paper-{}", number + 1),
            short,
            paper: document.paper,
            folder: folder.into(),
            plots,
            figures,
            fields,
        })
    }
}

fn resolutions(environment: &Environment) -> Vec<AtResolution> {
    let step = |column: &documents::Column| {
        Some(AtResolution {
            cells: column.resolution?,
            query_seconds: column.shadow_testing_seconds,
            build_seconds: column.preprocess_seconds,
            bytes: column.bytes,
            wrong: column.wrong,
        })
    };
    environment.columns.iter().filter_map(step).collect()
}

fn environment_part(document: &Path, environment: &Environment) -> Result<FigurePart> {
    let plot = picture::beside(document, &format!("{}.svg", environment.name))?;
    let title = format!("Figure {}: {}", environment.figure, environment.title);
    let image = Image {
        address: picture::svg(&plot)?,
        caption: format!("{}, measured here beside what was printed in 1986", environment.title),
        class: "plot",
    };
    let row = |column: &documents::Column| {
        vec![
            Cell { sort: column.resolution.map(f64::from), ..Cell::words(&column.name) },
            Cell::number(column.shadow_testing_seconds * 1e3, 1),
            Cell::number(column.preprocess_seconds * 1e3, 1),
            Cell::number(column.total_seconds * 1e3, 1),
            Cell::number(column.ns_per_query, 1),
            Cell::number(column.tests_per_ray, 2),
            Cell::bytes(column.bytes),
            Cell::wrong(column.wrong),
        ]
    };
    let table = Table {
        caption: format!(
            "{}: {} × {}, {} shadow rays",
            environment.title,
            environment.width,
            environment.height,
            grouped(environment.queries)
        ),
        columns: vec![
            Column::words("column"),
            Column::numbers("shadow testing ms"),
            Column::numbers("preprocess ms"),
            Column::numbers("total ms"),
            Column::numbers("ns/query"),
            Column::numbers("tests a ray"),
            Column::numbers("memory"),
            Column::numbers("wrong"),
        ],
        rows: environment.columns.iter().map(row).collect(),
    };
    Ok(FigurePart { title, images: vec![image], table: Some(table) })
}

fn figure_part(document: &Path, figure: &Figure) -> Result<FigurePart> {
    let mut images = Vec::new();
    if let Some(plot) = &figure.plot {
        let address = picture::svg(&picture::beside(document, plot)?)?;
        images.push(Image { address, caption: figure.title.clone(), class: "plot" });
    }
    for drawn in &figure.pictures {
        let embedded = picture::png(&picture::beside(document, &drawn.png)?)?;
        let wrong = match &drawn.errors {
            Some(errors) => format!(", {} of {} wrong", grouped(errors.wrong), grouped(drawn.queries)),
            None => String::new(),
        };
        let caption = format!("{}, shadows by {}{wrong}", drawn.scene, drawn.shadow);
        images.push(Image { address: embedded.address, caption, class: "picture" });
    }
    let row = |fact: &documents::Fact| {
        let paper = fact.paper.map_or_else(Cell::none, |paper| Cell::number(paper, 2));
        let says = Cell::words(fact.paper_says.clone().unwrap_or_default());
        vec![Cell::words(&fact.what), Cell::number(fact.measured, 3), paper, says]
    };
    let table = (!figure.facts.is_empty()).then(|| Table {
        caption: format!("What figure {} comes to", figure.figure),
        columns: vec![
            Column::words("what"),
            Column::numbers("measured"),
            Column::numbers("in the paper"),
            Column::words("the paper says"),
        ],
        rows: figure.facts.iter().map(row).collect(),
    });
    Ok(FigurePart { title: format!("Figure {}: {}", figure.figure, figure.title), images, table })
}
