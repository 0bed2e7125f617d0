//! An SVG picture of each environment: what its table says, against the resolution, ours beside the paper's.

use super::document::{ColumnReport, Environment};
use super::paper::RESOLUTIONS;
use super::quantity::Quantity;
use crate::error::{Error, Result};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::ops::Range;

const SIZE: (u32, u32) = (1120, 800);
const OURS: RGBColor = RGBColor(20, 90, 170);
const PAPER: RGBColor = RGBColor(205, 95, 10);

/// Points of one kind, joined by a line.
struct Series {
    name: &'static str,
    colour: RGBColor,
    stroke: Stroke,
    /// Resolution and value; what is 0 cannot be shown on a logarithmic axis.
    points: Vec<(f64, f64)>,
}

/// How points are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stroke {
    /// A light buffer: with a mark at each resolution.
    Solid,
    /// Another thing of the light buffers.
    Dotted,
    /// The control, which has no resolution.
    Level,
}

struct Panel {
    title: &'static str,
    series: Vec<Series>,
}

/// The picture, as text.
///
/// # Errors
/// If it cannot be drawn, which would be a mistake here.
pub fn plots(environment: &Environment) -> Result<String> {
    let mut svg = String::new();
    draw(environment, &mut svg).map_err(|error| Error::Usage(format!("plots: {error}")))?;
    Ok(svg)
}

type Drawn = std::result::Result<(), DrawingAreaErrorKind<std::io::Error>>;

fn draw(environment: &Environment, svg: &mut String) -> Drawn {
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let title = format!("Figure {}, {}", environment.figure, environment.title);
    let below = root.titled(&title, ("sans-serif", 22))?;
    let resolutions = environment.columns.iter().filter_map(|column| column.resolution).map(f64::from);
    let largest = resolutions.fold(f64::from(RESOLUTIONS[3]), f64::max);
    let panels = [tests(environment), times(environment), items(environment), non_empty(environment)];
    for (area, panel) in below.split_evenly((2, 2)).iter().zip(&panels) {
        draw_panel(area, panel, 8.0..largest * 1.25)?;
    }
    root.present()
}

fn draw_panel(area: &DrawingArea<SVGBackend, Shift>, panel: &Panel, x: Range<f64>) -> Drawn {
    let values = || panel.series.iter().flat_map(|series| &series.points).map(|&(_, y)| y);
    let (low, high) = (values().fold(f64::MAX, f64::min), values().fold(0.0, f64::max));
    // Room above for the legend, in proportion to the decades shown.
    let y = if low > high { 0.1..10.0 } else { low / 1.5..high * 1.5 * (high / low).powf(0.35) };
    let mut chart = ChartBuilder::on(area)
        .caption(panel.title, ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(58)
        .build_cartesian_2d((x.start..x.end).log_scale(), y.log_scale())?;
    chart
        .configure_mesh()
        .x_desc("cells along an edge, R")
        .x_label_formatter(&|x| label(*x))
        .y_label_formatter(&|y| label(*y))
        .max_light_lines(3)
        .light_line_style(RGBColor(238, 238, 238))
        .bold_line_style(RGBColor(214, 214, 214))
        .label_style(("sans-serif", 13))
        .draw()?;
    for series in &panel.series {
        let colour = series.colour;
        let line = |points: Vec<(f64, f64)>| LineSeries::new(points, colour.stroke_width(2));
        let drawn = match series.stroke {
            Stroke::Solid => {
                let marks = series.points.iter().map(|&point| Circle::new(point, 3, colour.filled()));
                chart.draw_series(marks)?;
                chart.draw_series(line(series.points.clone()))?
            }
            Stroke::Dotted => {
                let marks = series.points.iter().map(|&point| TriangleMarker::new(point, 5, colour));
                chart.draw_series(marks)?;
                let thin = colour.mix(0.7).stroke_width(1);
                chart.draw_series(DashedLineSeries::new(series.points.clone(), 3, 4, thin))?
            }
            Stroke::Level => {
                let ends: Vec<_> =
                    series.points.iter().flat_map(|&(_, y)| [(x.start, y), (x.end, y)]).collect();
                chart.draw_series(DashedLineSeries::new(ends, 8, 5, colour.stroke_width(1)))?
            }
        };
        let stroke = series.stroke;
        drawn.label(series.name).legend(move |(x, y)| {
            let width = if stroke == Stroke::Solid { 3 } else { 1 };
            let end = if stroke == Stroke::Dotted { x + 10 } else { x + 18 };
            PathElement::new([(x, y), (end, y)], colour.stroke_width(width))
        });
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.85))
        .label_font(("sans-serif", 12))
        .draw()
}

/// A number on an axis.
fn label(value: f64) -> String {
    if value >= 1.0 { format!("{value:.0}") } else { format!("{}", (value * 1e6).round() / 1e6) }
}

/// A row of the table, of the light buffers: ours and the paper's.
fn both(environment: &Environment, quantity: Quantity) -> Vec<Series> {
    let ours = points(environment, |column| quantity.measured(environment, column));
    let paper = printed(environment, quantity);
    vec![
        Series { name: "measured", colour: OURS, stroke: Stroke::Solid, points: ours },
        Series { name: "1986", colour: PAPER, stroke: Stroke::Solid, points: paper },
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
    Some(Series { name, colour, stroke: Stroke::Level, points: vec![(1.0, value)] })
}

fn tests(environment: &Environment) -> Panel {
    let control = environment.columns.iter().find(|column| column.resolution.is_none());
    let mut series = both(environment, Quantity::TestsPerRay);
    let paper = environment.table.tests_per_ray.control;
    series.extend(level("measured, control", OURS, control.map(|column| column.tests_per_ray)));
    series.extend(level("1986, control", PAPER, paper));
    Panel { title: "Shadow tests per ray", series }
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
    let series = |name, colour, stroke, points| Series { name, colour, stroke, points };
    Panel {
        title: "Time, as a share of the control's shadow testing",
        series: vec![
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
    }
}

fn items(environment: &Environment) -> Panel {
    Panel { title: "List items per square", series: both(environment, Quantity::ItemsPerSquare) }
}

fn non_empty(environment: &Environment) -> Panel {
    Panel { title: "Non-empty squares, %", series: both(environment, Quantity::NonEmpty) }
}
