//! All rows as comma-separated values: those of the table first, then those of what grows.

use super::document::{Document, RowReport};
use std::fmt::Write;

/// The whole document.
pub fn csv(document: &Document) -> String {
    let mut text = String::from(
        "over,at,scene,primitives,lights,width,height,tester,side,parameter,threads,queries,build_seconds,\
         query_seconds,frame_seconds,ns_per_query,rounds,interleaved,query_shortest,query_longest,frame_shortest,\
         frame_longest,wrong,false_shadow,false_light,wrong_checked,bytes\n",
    );
    for row in &document.rows {
        line(&mut text, ",", row);
    }
    for step in &document.growth {
        line(&mut text, &format!("{},{}", step.over, step.at), &step.row);
    }
    text
}

fn line(text: &mut String, start: &str, row: &RowReport) {
    let words = [&*row.scene, &*row.tester, &*row.side, &*row.parameter].map(quoted);
    let [scene, tester, side, parameter] = words;
    let _ = write!(text, "{start},{scene},{},{},{},{},", row.primitives, row.lights, row.width, row.height);
    let _ = write!(text, "{tester},{side},{parameter},{},{},", row.threads, row.queries);
    let [query_shortest, query_longest] = row.query_spread;
    let [frame_shortest, frame_longest] = row.frame_spread;
    let _ = write!(
        text,
        "{},{},{},{},{},{},{query_shortest},{query_longest},{frame_shortest},{frame_longest},",
        row.build_seconds,
        row.query_seconds,
        row.frame_seconds,
        row.ns_per_query,
        row.rounds,
        row.interleaved,
    );
    let _ = writeln!(
        text,
        "{},{},{},{},{}",
        row.wrong, row.false_shadow, row.false_light, row.wrong_checked, row.bytes
    );
}

/// In quotes if need be: names of files may hold anything.
fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_commas_are_one_field() {
        assert_eq!(quoted("a b"), "a b");
        assert_eq!(quoted("a,\"b\""), "\"a,\"\"b\"\"\"");
    }
}
