//! Plots within the page, and what is drawn for it alone: costs against the resolution of the light buffer.

use crate::error::Result;
use crate::report::bench::plots::{Ranged, drawn, range};
use crate::report::plot::{Axes, Corner, Panel, Series, Stroke};
use askama::Template;
use plotters::style::RGBColor;

const QUERIES: RGBColor = RGBColor(20, 90, 170);
const BUILDING: RGBColor = RGBColor(205, 95, 10);

/// SVG pictures and what they say in words.
#[derive(Debug, Clone, Template)]
#[template(path = "plot.html")]
pub(super) struct Plot {
    pub(super) title: String,
    /// A picture a panel, so that a narrow page has them below each other.
    pub(super) panels: Vec<String>,
    /// For those who do not see it.
    pub(super) words: String,
}

impl Plot {
    /// Of panels, each drawn by itself.
    ///
    /// # Errors
    /// If one cannot be drawn.
    pub(super) fn new(
        title: impl Into<String>,
        panels: Vec<Ranged>,
        words: impl Into<String>,
    ) -> Result<Plot> {
        let panels = panels.into_iter().map(|panel| drawn("", vec![panel])).collect::<Result<_>>()?;
        Ok(Plot { title: title.into(), panels, words: words.into() })
    }
}

/// Light buffers of a resolution.
#[derive(Debug, Clone, Copy)]
pub(super) struct AtResolution {
    /// Cells along an edge.
    pub(super) cells: u32,
    pub(super) query_seconds: f64,
    pub(super) build_seconds: f64,
    pub(super) bytes: u64,
    pub(super) wrong: u64,
}

/// Time, error and memory against R; none of fewer than two resolutions.
///
/// # Errors
/// If it cannot be drawn.
pub(super) fn resolution(title: &str, steps: &[AtResolution]) -> Result<Option<Plot>> {
    let mut steps = steps.to_vec();
    steps.sort_by_key(|step| step.cells);
    if steps.first().map(|step| step.cells) == steps.last().map(|step| step.cells) {
        return Ok(None);
    }
    let series = |name: &str, colour, stroke, value: fn(&AtResolution) -> f64| {
        let points =
            steps.iter().map(|step| (f64::from(step.cells), value(step))).filter(|point| point.1 > 0.0);
        Series { name: name.into(), colour, stroke, points: points.collect() }
    };
    let times = vec![
        series("queries", QUERIES, Stroke::Solid, |step| step.query_seconds * 1e3),
        series("building", BUILDING, Stroke::Dotted, |step| step.build_seconds * 1e3),
    ];
    let wrong = vec![series("wrong", QUERIES, Stroke::Solid, |step| (step.wrong as f64).max(0.5))];
    let memory =
        vec![series("memory", QUERIES, Stroke::Solid, |step| step.bytes as f64 / f64::from(1 << 20))];
    let panels = [
        panel("Time against R", "ms", times),
        panel("Error against R", "wrong answers (none: 0.5)", wrong),
        panel("Memory against R", "MiB", memory),
    ];
    let say = |step: &AtResolution| {
        format!(
            "R {}: {:.1} ms for queries, {:.1} ms to build, {} wrong, {:.1} MiB",
            step.cells,
            step.query_seconds * 1e3,
            step.build_seconds * 1e3,
            step.wrong,
            step.bytes as f64 / f64::from(1 << 20)
        )
    };
    let words = steps.iter().map(say).collect::<Vec<_>>().join("; ");
    Plot::new(title, panels.into(), words).map(Some)
}

fn panel(title: &str, y: &str, series: Vec<Series>) -> Ranged {
    let series = series.into_iter().filter(|series| !series.points.is_empty()).collect();
    let panel = Panel {
        title: title.into(),
        x: "cells along an edge, R".into(),
        y: y.into(),
        axes: Axes::Logarithmic,
        legend: Corner::UpperLeft,
        series,
    };
    let range = range(&panel);
    (panel, range)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_resolution_is_no_plot_and_two_are() {
        let step =
            |cells| AtResolution { cells, query_seconds: 1.0, build_seconds: 0.0, bytes: 1 << 20, wrong: 0 };
        assert!(resolution("t", &[]).unwrap().is_none());
        assert!(resolution("t", &[step(8), step(8)]).unwrap().is_none());
        let plot = resolution("t", &[step(64), step(8)]).unwrap().unwrap();
        assert!(plot.words.starts_with("R 8: 1000.0 ms for queries") && plot.words.contains("1.0 MiB"));
        let html = plot.render().unwrap();
        assert!(html.contains("<svg") && html.contains("Memory against R"), "{html}");
    }
}
