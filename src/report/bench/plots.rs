//! Plots: speed against error of everyone, and costs against what grows.

use super::document::{Document, GrowthReport, RowReport};
use crate::error::{Error, Result};
use crate::report::plot::{Axes, Corner, Drawn, Panel, Series, Stroke};
use plotters::prelude::*;

const PANEL: (u32, u32) = (620, 460);

const NATIVE: RGBColor = RGBColor(20, 90, 170);
const EMBREE: RGBColor = RGBColor(205, 95, 10);
const APPROXIMATE: RGBColor = RGBColor(120, 110, 100);

const SIDES: [(&str, RGBColor); 3] = [("native", NATIVE), ("embree", EMBREE), ("approximate", APPROXIMATE)];

/// A plot by the name of its file.
pub type Plot = (String, String);

/// All that there are.
///
/// # Errors
/// If one cannot be drawn, which would be a mistake here.
pub fn plots(document: &Document) -> Result<Vec<Plot>> {
    let key = |row: &RowReport| (row.scene.clone(), row.lights, row.threads);
    let groups: Vec<&[RowReport]> = document.rows.chunk_by(|one, other| key(one) == key(other)).collect();
    let mut plots = Vec::new();
    if !groups.is_empty() {
        let panels = groups.iter().map(|group| speed_against_error(group)).collect();
        plots.push(("speed-error.svg".into(), drawn("Speed against error", panels)?));
    }
    let series = |step: &GrowthReport| (step.over, step.row.scene.clone(), step.row.threads);
    for over in ["triangles", "lights", "pixels"] {
        let steps: Vec<GrowthReport> =
            document.growth.iter().filter(|step| step.over == over).cloned().collect();
        let groups: Vec<&[GrowthReport]> =
            steps.chunk_by(|one, other| series(one) == series(other)).collect();
        if !groups.is_empty() {
            let panels = groups.iter().map(|group| growth(group)).collect();
            plots.push((format!("growth-{over}.svg"), drawn(&format!("Costs against {over}"), panels)?));
        }
    }
    Ok(plots)
}

/// A panel, and the range of its x axis.
type Ranged = (Panel, std::ops::Range<f64>);

fn speed_against_error(rows: &[RowReport]) -> Ranged {
    // Nothing wrong cannot be shown on a logarithmic axis: it is shown as half an answer.
    let series = SIDES.iter().map(|&(side, colour)| {
        let of_side = rows.iter().filter(|row| row.side == side);
        let points = of_side.map(|row| (row.ns_per_query, (row.wrong as f64).max(0.5))).collect();
        Series { name: side.into(), colour, stroke: Stroke::Marks, points }
    });
    let series: Vec<Series> = series.filter(|series| !series.points.is_empty()).collect();
    let panel = Panel {
        title: format!("{}, lights: {}, threads: {}", rows[0].scene, rows[0].lights, rows[0].threads),
        x: "ns a query".into(),
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
        x: steps[0].over.into(),
        y: "ms".into(),
        axes: Axes::Logarithmic,
        legend: Corner::UpperLeft,
        series,
    };
    let range = range(&panel);
    (panel, range)
}

fn range(panel: &Panel) -> std::ops::Range<f64> {
    let places = || panel.series.iter().flat_map(|series| &series.points).map(|point| point.0);
    let (low, high) = (places().fold(f64::MAX, f64::min), places().fold(0.0, f64::max));
    if low > high || low <= 0.0 { 0.1..10.0 } else { low / 1.3..high * 1.3 }
}

fn drawn(title: &str, panels: Vec<Ranged>) -> Result<String> {
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
    let below = root.titled(title, ("sans-serif", 20))?;
    for (area, (panel, range)) in below.split_evenly((rows, columns)).iter().zip(panels) {
        panel.draw(area, range.clone())?;
    }
    root.present()
}
