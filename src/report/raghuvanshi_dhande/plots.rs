//! An SVG picture of each figure that has curves, a panel for each kind of objects.

use super::document::{Curve, Figure, FitReport};
use crate::error::{Error, Result};
use crate::report::plot::{Axes, Corner, Drawn, Panel, Series, Stroke};
use plotters::prelude::*;

const PANEL: (u32, u32) = (620, 460);

/// Of curves in the order of a figure.
const COLOURS: [RGBColor; 5] = [
    RGBColor(20, 90, 170),
    RGBColor(205, 95, 10),
    RGBColor(40, 130, 60),
    RGBColor(140, 60, 150),
    RGBColor(120, 110, 100),
];

/// The picture, as text.
///
/// # Errors
/// If it cannot be drawn, which would be a mistake here.
pub fn plot(figure: &Figure) -> Result<String> {
    let mut svg = String::new();
    draw(figure, &mut svg).map_err(|error| Error::Usage(format!("plots: {error}")))?;
    Ok(svg)
}

fn draw(figure: &Figure, svg: &mut String) -> Drawn {
    let groups: Vec<&[Curve]> = figure.curves.chunk_by(|one, other| one.kind == other.kind).collect();
    let columns = groups.len().max(1);
    let size = (PANEL.0 * columns as u32, PANEL.1);
    let root = SVGBackend::with_string(svg, size).into_drawing_area();
    root.fill(&WHITE)?;
    let below = root.titled(&format!("Figure {}: {}", figure.figure, figure.title), ("sans-serif", 20))?;
    for (area, group) in below.split_evenly((1, columns)).iter().zip(groups) {
        let places = group.iter().flat_map(|curve| &curve.points).map(|point| point[0]);
        let panel = panel(figure, group);
        panel.draw(area, 0.0..places.fold(1.0, f64::max) * 1.02)?;
    }
    root.present()
}

fn panel(figure: &Figure, group: &[Curve]) -> Panel {
    let [x, y] = figure.axes.unwrap_or_default().map(String::from);
    let mut series = Vec::new();
    for (curve, colour) in group.iter().zip(COLOURS.into_iter().cycle()) {
        let points: Vec<(f64, f64)> = curve.points.iter().map(|&[x, y]| (x, y)).collect();
        if let Some(fit) = &curve.fit {
            let name = format!("{}: fit, r^2 {:.4}", curve.name, fit.r_squared);
            series.push(Series { name, colour, stroke: Stroke::Dashed, points: fitted(fit, &points) });
        }
        series.push(Series { name: curve.name.clone(), colour, stroke: Stroke::Solid, points });
    }
    Panel {
        title: group[0].kind.unwrap_or_default().into(),
        x,
        y,
        axes: Axes::Linear,
        legend: if figure.figure == 18 { Corner::UpperRight } else { Corner::UpperLeft },
        series,
    }
}

/// Points of a fit, close enough for a parabola.
fn fitted(fit: &FitReport, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
    let at = |x: f64| fit.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient);
    let place = |i: u32| first.0 + (last.0 - first.0) * f64::from(i) / 60.0;
    (0..=60).map(place).map(|x| (x, at(x).max(0.0))).collect()
}
