//! An SVG picture of each environment: what its table says, against the resolution, ours beside the paper's.

use super::document::{ColumnReport, Environment};
use super::paper::RESOLUTIONS;
use super::quantity::Quantity;
use crate::error::{Error, Result};
use crate::report::plot::{Axes, Corner, Drawn, Panel, Series, Stroke};
use plotters::prelude::*;

const SIZE: (u32, u32) = (1120, 800);
const OURS: RGBColor = RGBColor(20, 90, 170);
const PAPER: RGBColor = RGBColor(205, 95, 10);

/// The picture, as text.
///
/// # Errors
/// If it cannot be drawn, which would be a mistake here.
pub fn plots(environment: &Environment) -> Result<String> {
    let mut svg = String::new();
    draw(environment, &mut svg).map_err(|error| Error::Usage(format!("plots: {error}")))?;
    Ok(svg)
}

fn draw(environment: &Environment, svg: &mut String) -> Drawn {
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!("Figure {}, {}", environment.figure, environment.title);
    let below = root.titled(&title, ("sans-serif", 22))?;
    let resolutions = environment.columns.iter().filter_map(|column| column.resolution).map(f64::from);
    let largest = resolutions.fold(f64::from(RESOLUTIONS[3]), f64::max);
    let panels = [tests(environment), times(environment), items(environment), non_empty(environment)];
    for (area, panel) in below.split_evenly((2, 2)).iter().zip(&panels) {
        panel.draw(area, 8.0..largest * 1.25)?;
    }
    root.present()
}

/// A panel over the resolution.
fn panel(title: &str, series: Vec<Series>) -> Panel {
    let (x, y) = ("cells along an edge, R".into(), String::new());
    Panel { title: title.into(), x, y, axes: Axes::Logarithmic, legend: Corner::UpperRight, series }
}

/// A row of the table, of the light buffers: ours and the paper's.
fn both(environment: &Environment, quantity: Quantity) -> Vec<Series> {
    let ours = points(environment, |column| quantity.measured(environment, column));
    let paper = printed(environment, quantity);
    vec![
        Series { name: "measured".into(), colour: OURS, stroke: Stroke::Solid, points: ours },
        Series { name: "1986".into(), colour: PAPER, stroke: Stroke::Solid, points: paper },
    ]
}

fn points(environment: &Environment, value: impl Fn(&ColumnReport) -> Option<f64>) -> Vec<(f64, f64)> {
    let point = |column: &ColumnReport| {
        let value = value(column).filter(|value| *value > 0.0)?;
        Some((f64::from(column.resolution?), value))
    };
    environment.columns.iter().filter_map(point).collect()
}

fn printed(environment: &Environment, quantity: Quantity) -> Vec<(f64, f64)> {
    let point = |resolution: u32| {
        let printed = quantity.printed(environment.table, Some(resolution))?;
        (printed.value > 0.0).then_some((f64::from(resolution), printed.value))
    };
    RESOLUTIONS.into_iter().filter_map(point).collect()
}

fn level(name: &'static str, colour: RGBColor, value: Option<f64>) -> Option<Series> {
    let value = value.filter(|value| *value > 0.0)?;
    Some(Series { name: name.into(), colour, stroke: Stroke::Level, points: vec![(1.0, value)] })
}

fn tests(environment: &Environment) -> Panel {
    let control = environment.columns.iter().find(|column| column.resolution.is_none());
    let mut series = both(environment, Quantity::TestsPerRay);
    let paper = environment.table.tests_per_ray.control;
    series.extend(level("measured, control", OURS, control.map(|column| column.tests_per_ray)));
    series.extend(level("1986, control", PAPER, paper));
    panel("Shadow tests per ray", series)
}

/// Times are shares of the control's, so that seconds and minutes of a VAX can stand side by side.
fn times(environment: &Environment) -> Panel {
    let control = environment.columns.iter().find(|column| column.resolution.is_none());
    let ours = control.map_or(1.0, |column| column.shadow_testing_seconds).max(f64::MIN_POSITIVE);
    let paper = environment.table.shadow_testing.control.unwrap_or(1.0);
    let share = |points: Vec<(f64, f64)>, whole: f64| -> Vec<(f64, f64)> {
        points.into_iter().map(|(x, y)| (x, y / whole)).collect()
    };
    let testing = points(environment, |column| Some(column.shadow_testing_seconds));
    let building = points(environment, |column| Some(column.preprocess_seconds));
    let series = |name: &str, colour, stroke, points| Series { name: name.into(), colour, stroke, points };
    panel(
        "Time, as a share of the control's shadow testing",
        vec![
            series("measured, shadow testing", OURS, Stroke::Solid, share(testing, ours)),
            series("measured, preprocess", OURS, Stroke::Dotted, share(building, ours)),
            series(
                "1986, shadow testing",
                PAPER,
                Stroke::Solid,
                share(printed(environment, Quantity::ShadowTesting), paper),
            ),
            series(
                "1986, preprocess",
                PAPER,
                Stroke::Dotted,
                share(printed(environment, Quantity::Preprocess), paper),
            ),
        ],
    )
}

fn items(environment: &Environment) -> Panel {
    panel("List items per square", both(environment, Quantity::ItemsPerSquare))
}

fn non_empty(environment: &Environment) -> Panel {
    panel("Non-empty squares, %", both(environment, Quantity::NonEmpty))
}
