//! The figures as comma-separated values: a line a point of a curve, and a line a fact.

use super::document::{Curve, Document, Figure};
use std::fmt::Write;

/// The whole document.
pub fn csv(document: &Document) -> String {
    let mut text = String::from("figure,kind,name,over,at,quantity,measured,paper\n");
    for figure in &document.figures {
        for curve in &figure.curves {
            points(&mut text, figure, curve);
        }
        for fact in &figure.facts {
            let paper = fact.paper.map_or(String::new(), |paper| paper.to_string());
            let _ = writeln!(text, "{},fact,{},,,,{},{paper}", figure.figure, fact.what, fact.measured);
        }
    }
    text
}

fn points(text: &mut String, figure: &Figure, curve: &Curve) {
    let [over, quantity] = figure.axes.unwrap_or_default();
    let kind = curve.kind.unwrap_or("curve");
    for [x, y] in &curve.points {
        let _ = writeln!(text, "{},{kind},{},{over},{x},{quantity},{y},", figure.figure, curve.name);
    }
}
