//! The tables as comma-separated values: a line a figure.

use super::document::{Environment, Reproduction};
use super::quantity::Quantity;
use std::fmt::Write;

/// The whole document: of each environment first what no column changes, then every row of every column. Times
/// are seconds here and minutes in the paper.
pub fn csv(document: &Reproduction) -> String {
    let mut text =
        String::from("environment,figure,column,resolution,quantity,unit,measured,paper,best_reading\n");
    for environment in &document.environments {
        captions(&mut text, environment);
        columns(&mut text, environment);
    }
    text
}

fn captions(text: &mut String, environment: &Environment) {
    let (ours, paper) = (environment.counts, environment.paper_counts);
    let counts = [
        ("objects", ours.objects, paper.objects),
        ("polygons", ours.polygons, paper.polygons),
        ("spheres", ours.spheres, paper.spheres),
        ("cylinders", ours.cylinders, paper.cylinders),
        ("quadrics", ours.quadrics, paper.quadrics),
        ("lights", ours.lights, paper.lights),
    ];
    let start = format!("{},{},,", environment.name, environment.figure);
    for (name, ours, paper) in counts {
        let _ = writeln!(text, "{start},{name},,{ours},{paper},no");
    }
    let (ours, paper) = (environment.average_tree_size, environment.paper_average_tree_size);
    let _ = writeln!(text, "{start},average_tree_size,,{ours},{paper},no");
    let _ = writeln!(text, "{start},triangles,,{},,", environment.triangles);
    let _ = writeln!(text, "{start},queries,,{},,", environment.queries);
}

fn columns(text: &mut String, environment: &Environment) {
    for column in &environment.columns {
        let resolution = column.resolution.map_or(String::new(), |r| r.to_string());
        let start = format!("{},{},{},{resolution}", environment.name, environment.figure, column.name);
        for quantity in Quantity::ALL {
            let printed = quantity.printed(environment.table, column.resolution);
            let measured = quantity.measured(environment, column);
            if measured.is_none() && printed.is_none() {
                continue;
            }
            let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let best_reading = match printed {
                Some(printed) if printed.best_reading => "yes",
                Some(_) => "no",
                None => "",
            };
            let unit = if quantity.is_time() { "s (paper: min)" } else { "" };
            let _ = writeln!(
                text,
                "{start},{},{unit},{},{},{best_reading}",
                quantity.key(),
                number(measured),
                number(printed.map(|printed| printed.value)),
            );
        }
        let more = [
            ("ns_per_query", column.ns_per_query),
            ("control_over_this", column.control_over_this),
            ("control_total_over_this", column.control_total_over_this),
            ("volume_tests_per_ray", column.volume_tests_per_ray),
            ("bytes", column.bytes as f64),
            ("wrong", column.wrong as f64),
            ("unlike_control", column.unlike_control as f64),
        ];
        for (key, value) in more {
            let _ = writeln!(text, "{start},{key},,{value},,");
        }
    }
}
