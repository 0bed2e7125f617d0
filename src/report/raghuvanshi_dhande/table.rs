//! The figures for people: curves as columns, and what they come to beside what the paper says.

use super::document::{Curve, Document, Fact, Figure, Picture};
use crate::film::grouped;
use std::fmt::Write;

/// What has to be known to read the figures.
const NOTES: &str = "\
- Times are wall-clock seconds on all threads, medians of a few interleaved repetitions; what takes a second is done
  once. Classical is every object for every ray from the eye and every shadow ray (brute-force); the t-buffer alone
  tests rays from the eye where an object can be, and shadow rays as before. A shadow ray ends at the first object
  that occludes it, and a surface that faces away from the light needs none.
- Gain is the classical time over that of the t-buffer with a tester: first hits, filling or building it, and asking
  it. Shading, which both do alike, is left out unless a line says so; reflections and textures are off.
- Predicted is the same ratio of counted ray/object tests: it would be the gain if each test took equally long. Its
  limit is what shadow rays leave when first hits cost nothing. The measured gain is more where a shadow test is
  cheaper than a test from the eye: brute-force tests a triangle against sixteen points at once.
- light-buffer and embree-fast, which the paper has not, stand in for the shadow-buffer.
- The paper's curves are drawn and not printed as numbers: beside ours stands what its text says.
";

/// All figures.
pub fn tables(document: &Document) -> String {
    let mut text = format!(
        "{}\n{} threads, at most {} repetitions\n\n{NOTES}\n",
        document.paper, document.threads, document.repetitions
    );
    for figure in &document.figures {
        let _ =
            writeln!(text, "Figure {}: {}, {}x{}", figure.figure, figure.title, figure.width, figure.height);
        for picture in &figure.pictures {
            picture_line(&mut text, picture);
        }
        curves(&mut text, figure);
        for fact in &figure.facts {
            fact_line(&mut text, fact);
        }
        text.push('\n');
    }
    let _ = writeln!(text, "{} wrong answers of what must be exact", grouped(document.native_wrong));
    text
}

fn picture_line(text: &mut String, picture: &Picture) {
    let _ = write!(
        text,
        "  {:<28} {} objects, shadows by {}, {} of {} shadow rays occluded",
        picture.png,
        grouped(u64::from(picture.objects)),
        picture.shadow,
        grouped(picture.shadowed),
        grouped(picture.queries)
    );
    if !picture.left_out.is_empty() {
        let _ = write!(text, ", without {}", picture.left_out.join(" and "));
    }
    if let Some(errors) = &picture.errors {
        let _ = write!(
            text,
            "; wrong {:.3} %: {} false shadow, {} false light",
            100.0 * errors.wrong_share,
            grouped(errors.errors.false_shadow),
            grouped(errors.errors.false_light)
        );
    }
    if let Some(edges) = &picture.edges {
        let _ = write!(
            text,
            "; {} of the {} that the camera sees within a cell of an edge",
            grouped(edges.within_a_cell),
            grouped(edges.wrong)
        );
    }
    if let Some(unlike) = picture.unlike_classical {
        let _ = write!(text, "; {} pixels unlike the classical tracer", grouped(unlike));
    }
    text.push('\n');
}

/// A table for each kind of objects: a row a place, a column a curve.
fn curves(text: &mut String, figure: &Figure) {
    let [over, quantity] = figure.axes.unwrap_or_default();
    for group in figure.curves.chunk_by(|one, other| one.kind == other.kind) {
        let kind = group[0].kind.map_or(String::new(), |kind| format!(" of {kind}"));
        let _ = writeln!(text, "  {quantity}{kind}");
        let widths: Vec<usize> = group.iter().map(|curve| curve.name.len().max(10)).collect();
        let _ = write!(text, "  {over:>8}");
        for (curve, width) in group.iter().zip(&widths) {
            let _ = write!(text, "  {:>width$}", curve.name);
        }
        text.push('\n');
        for [x, _] in &group[0].points {
            let _ = write!(text, "  {x:>8}");
            for (curve, width) in group.iter().zip(&widths) {
                let found = curve.points.iter().find(|point| point[0] == *x);
                let value = found.map_or("-".into(), |point| number(point[1]));
                let _ = write!(text, "  {value:>width$}");
            }
            text.push('\n');
        }
        for curve in group {
            fit_line(text, curve);
        }
    }
}

fn fit_line(text: &mut String, curve: &Curve) {
    let Some(fit) = &curve.fit else { return };
    let term = |(power, coefficient): (usize, &f64)| match power {
        0 => format!("{coefficient:.4e}"),
        1 => format!("{coefficient:.4e} x"),
        _ => format!("{coefficient:.4e} x^{power}"),
    };
    let terms: Vec<String> = fit.coefficients.iter().enumerate().map(term).collect();
    let _ = writeln!(
        text,
        "  {}: {}, r^2 {:.5}, correlation {:.5}",
        curve.name,
        terms.join(" + "),
        fit.r_squared,
        fit.correlation
    );
}

fn fact_line(text: &mut String, fact: &Fact) {
    let _ = write!(text, "  {}: {}", fact.what, number(fact.measured));
    let paper = match (fact.paper, fact.paper_says) {
        (Some(paper), Some(words)) => format!(" | paper: {paper}, \"{words}\""),
        (Some(paper), None) => format!(" | paper: {paper}"),
        (None, Some(words)) => format!(" | paper: \"{words}\""),
        (None, None) => String::new(),
    };
    let _ = writeln!(text, "{paper}");
}

/// Four digits or so.
fn number(value: f64) -> String {
    match value.abs() {
        1000.0.. => format!("{value:.0}"),
        10.0.. => format!("{value:.2}"),
        0.1.. => format!("{value:.4}"),
        _ => format!("{value:.6}"),
    }
}
