//! Plots: speed against error of everyone, and costs against what grows.

use super::document::{Document, GrowthReport, RowReport};
use super::pareto;
use crate::error::{Error, Result};
use crate::report::plot::{Axes, Corner, Drawn, Mark, Panel, Series, Stroke};
use plotters::prelude::*;

const PANEL: (u32, u32) = (620, 460);

const NATIVE: RGBColor = RGBColor(20, 90, 170);
const EMBREE: RGBColor = RGBColor(205, 95, 10);
const APPROXIMATE: RGBColor = RGBColor(120, 110, 100);

/// Of Embree there are sixty points and more, so it is drawn first.
const SIDES: [(&str, RGBColor, Mark); 3] = [
    ("embree", EMBREE, Mark::Triangle),
    ("approximate", APPROXIMATE, Mark::Cross),
    ("native", NATIVE, Mark::Disc),
];

/// The front stands out against all sides.
const FRONT: RGBColor = RGBColor(90, 90, 90);

/// A plot by the name of its file.
pub type Plot = (String, String);

/// All that there are.
///
/// # Errors
/// If one cannot be drawn, which would be a mistake here.
pub fn plots(document: &Document) -> Result<Vec<Plot>> {
    let mut plots = Vec::new();
    let groups = groups(&document.rows);
    if !groups.is_empty() {
        let panels = groups.iter().flat_map(|group| group_panels(group));
        plots.push(("speed-error.svg".into(), drawn("Speed against error", panels.collect())?));
    }
    for over in ["triangles", "lights", "pixels"] {
        let panels = growth_panels(document, over);
        if !panels.is_empty() {
            let title = format!("Costs against {over}");
            plots.push((format!("growth-{over}.svg"), drawn(&title, panels)?));
        }
    }
    Ok(plots)
}

/// Rows of one scene with as many lights and threads.
pub fn groups(rows: &[RowReport]) -> Vec<&[RowReport]> {
    let key = |row: &RowReport| (row.scene.clone(), row.lights, row.threads, row.width, row.height);
    rows.chunk_by(|one, other| key(one) == key(other)).collect()
}

/// Speed against error of one group, by both clocks.
pub fn group_panels(rows: &[RowReport]) -> Vec<Ranged> {
    [Clock::Queries, Clock::Frame].map(|clock| speed_against_error(rows, clock)).into()
}

/// Costs against what grows, a panel a scene and number of threads; none if nothing did.
pub fn growth_panels(document: &Document, over: &str) -> Vec<Ranged> {
    let series = |step: &GrowthReport| (step.row.scene.clone(), step.row.threads);
    let steps: Vec<GrowthReport> = document.growth.iter().filter(|step| step.over == over).cloned().collect();
    steps.chunk_by(|one, other| series(one) == series(other)).map(growth).collect()
}

/// A panel, and the range of its x axis.
pub type Ranged = (Panel, std::ops::Range<f64>);

/// Which time is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// Of all queries when all is built, a query.
    Queries,
    /// From triangles and points to answers.
    Frame,
}

impl Clock {
    /// In nanoseconds a query, or in milliseconds a frame.
    pub fn time(self, row: &RowReport) -> f64 {
        match self {
            Clock::Queries => row.ns_per_query,
            Clock::Frame => row.frame_seconds * 1e3,
        }
    }

    /// What it is called on an axis.
    pub fn label(self) -> &'static str {
        match self {
            Clock::Queries => "ns a query",
            Clock::Frame => "ms a frame",
        }
    }
}

/// The rows of a group that no other beats in both time and wrong answers, the fastest first.
pub fn front_of(rows: &[RowReport], clock: Clock) -> Vec<&RowReport> {
    let points: Vec<_> = rows.iter().map(|row| (clock.time(row), row.wrong as f64)).collect();
    pareto::front(&points).into_iter().map(|i| &rows[i]).collect()
}

fn speed_against_error(rows: &[RowReport], clock: Clock) -> Ranged {
    // Nothing wrong cannot be shown on a logarithmic axis: it is shown as half an answer.
    let point = |row: &RowReport| (clock.time(row), (row.wrong as f64).max(0.5));
    let front = front_of(rows, clock).into_iter().map(point).collect();
    let front = Series { name: "Pareto front".into(), colour: FRONT, stroke: Stroke::Steps, points: front };
    let sides = SIDES.iter().map(|&(side, colour, mark)| {
        let points = rows.iter().filter(|row| row.side == side).map(point).collect();
        Series { name: side.into(), colour, stroke: Stroke::Marks(mark), points }
    });
    let series = [front].into_iter().chain(sides).filter(|series| !series.points.is_empty()).collect();
    let panel = Panel {
        title: format!("{}, lights: {}, threads: {}", rows[0].scene, rows[0].lights, rows[0].threads),
        x: clock.label().into(),
        y: format!("wrong of {} (none: 0.5)", rows[0].wrong_checked),
        axes: Axes::Logarithmic,
        legend: Corner::UpperRight,
        series,
    };
    let range = range(&panel);
    (panel, range)
}

/// A time of a row.
type Time = fn(&RowReport) -> f64;

/// The fastest of each side at each step, for queries and for frames.
fn growth(steps: &[GrowthReport]) -> Ranged {
    let mut series = Vec::new();
    let times: [(&str, Stroke, Time); 2] = [
        ("frame", Stroke::Solid, |row| row.frame_seconds),
        ("queries", Stroke::Dotted, |row| row.query_seconds),
    ];
    for (what, stroke, time) in times {
        for (side, colour) in [("native", NATIVE), ("embree", EMBREE)] {
            let fastest = |step: &[GrowthReport]| {
                let of_side = step.iter().filter(|step| step.row.side == side && step.row.interleaved);
                let times = of_side.map(|step| time(&step.row));
                times.reduce(f64::min).map(|seconds| (step[0].at as f64, seconds * 1e3))
            };
            let points: Vec<_> =
                steps.chunk_by(|one, other| one.at == other.at).filter_map(fastest).collect();
            if !points.is_empty() {
                series.push(Series { name: format!("{side}, {what}"), colour, stroke, points });
            }
        }
    }
    let panel = Panel {
        title: format!("{}, threads: {}", steps[0].row.scene, steps[0].row.threads),
        x: steps[0].over.to_string(),
        y: "ms".into(),
        axes: Axes::Logarithmic,
        legend: Corner::UpperLeft,
        series,
    };
    let range = range(&panel);
    (panel, range)
}

/// The range of a panel's x axis.
pub fn range(panel: &Panel) -> std::ops::Range<f64> {
    let places = || panel.series.iter().flat_map(|series| &series.points).map(|point| point.0);
    let (low, high) = (places().fold(f64::MAX, f64::min), places().fold(0.0, f64::max));
    if low > high || low <= 0.0 { 0.1..10.0 } else { low / 1.3..high * 1.3 }
}

/// Panels side by side under a title, which may be empty.
///
/// # Errors
/// If it cannot be drawn, which would be a mistake here.
pub fn drawn(title: &str, panels: Vec<Ranged>) -> Result<String> {
    let mut svg = String::new();
    draw(title, &panels, &mut svg).map_err(|error| Error::Usage(format!("plots: {error}")))?;
    Ok(svg)
}

fn draw(title: &str, panels: &[Ranged], svg: &mut String) -> Drawn {
    let columns = panels.len().clamp(1, 2);
    let rows = panels.len().div_ceil(columns).max(1);
    let root =
        SVGBackend::with_string(svg, (PANEL.0 * columns as u32, PANEL.1 * rows as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    let below = if title.is_empty() { root.clone() } else { root.titled(title, ("sans-serif", 20))? };
    for (area, (panel, range)) in below.split_evenly((rows, columns)).iter().zip(panels) {
        panel.draw(area, range.clone())?;
    }
    root.present()
}
