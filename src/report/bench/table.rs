//! The table that a person reads: who took part in the rounds, and all but Embree of those who did not.

use super::document::{Document, FirstHitsReport, RatioReport, RowReport};
use crate::film::grouped;
use std::fmt::Write;

/// The whole document.
pub fn table(document: &Document) -> String {
    let mut text = String::new();
    let machine = &document.machine;
    let embree = machine.embree.as_ref().map_or("no Embree".into(), |version| format!("Embree {version}"));
    let _ = writeln!(text, "{}, {} cores, {}, {embree}", machine.cpu, machine.cores, machine.os);
    let key = |row: &RowReport| (row.scene.clone(), row.lights, row.threads);
    for group in document.rows.chunk_by(|one, other| key(one) == key(other)) {
        heading(&mut text, &group[0]);
        let shown = |row: &&RowReport| row.interleaved || row.side != "embree";
        group.iter().filter(shown).for_each(|row| line(&mut text, row));
        let key = key(&group[0]);
        for ratio in &document.ratios {
            if (&ratio.scene, ratio.lights, ratio.threads) == (&key.0, key.1, key.2) {
                ratios(&mut text, ratio);
                break;
            }
        }
    }
    document.first_hits.iter().for_each(|report| first_hits(&mut text, report));
    for skipped in &document.skipped {
        let _ = writeln!(
            text,
            "skipped in {} with {}: {}: {}",
            skipped.scene,
            lights(skipped.lights),
            skipped.skipped.tester,
            skipped.skipped.why
        );
    }
    for group in document.growth.chunk_by(|one, other| (&one.over, one.at) == (&other.over, other.at)) {
        let _ = writeln!(text, "\n{} {}", grouped(group[0].at), group[0].over);
        heading(&mut text, &group[0].row);
        let shown = |row: &&RowReport| row.interleaved;
        group.iter().map(|step| &step.row).filter(shown).for_each(|row| line(&mut text, row));
    }
    text
}

fn first_hits(text: &mut String, report: &FirstHitsReport) {
    let _ = writeln!(
        text,
        "\n{}: first hits of {} primitives, {} x {}, {}",
        report.scene,
        grouped(report.primitives),
        report.width,
        report.height,
        threads(report.threads),
    );
    let _ = writeln!(
        text,
        "  {:<36}{:<10}{:>10}{:>10}{:>10}{:>8}{:>10}",
        "method", "order", "build ms", "rays ms", "frame ms", "+-%", "differ"
    );
    for row in report.rows.iter().filter(|row| row.interleaved) {
        let [shortest, longest] = row.frame_spread;
        let _ = writeln!(
            text,
            "  {:<36}{:<10}{:>10.1}{:>10.1}{:>10.1}{:>8.0}{:>10}",
            row.method,
            row.order.as_deref().unwrap_or("-"),
            row.build_seconds * 1e3,
            row.query_seconds * 1e3,
            row.frame_seconds * 1e3,
            50.0 * (longest - shortest) / row.frame_seconds.max(1e-9),
            grouped(row.differ),
        );
    }
    if let Some(why) = &report.skipped {
        let _ = writeln!(text, "  Embree: {why}");
    }
    if let Some((query, frame)) = report.query.zip(report.frame) {
        let _ = writeln!(text, "  Embree over t-buffer: rays {query:.2}, frame {frame:.2}");
    }
}

fn threads(count: u64) -> String {
    if count == 1 { "a thread".into() } else { format!("{} threads", count) }
}

fn lights(count: u64) -> String {
    if count == 1 { "a light".into() } else { format!("{} lights", grouped(count)) }
}

fn heading(text: &mut String, row: &RowReport) {
    let _ = writeln!(
        text,
        "\n{}: {} primitives, {}, {} x {}, {} queries, {}",
        row.scene,
        grouped(row.primitives),
        lights(row.lights),
        row.width,
        row.height,
        grouped(row.queries),
        threads(row.threads),
    );
    let _ = writeln!(
        text,
        "  {:<36}{:<28}{:>10}{:>10}{:>8}{:>10}{:>11}{:>7}",
        "tester", "parameter", "build ms", "ns/query", "+-%", "frame ms", "memory", "wrong"
    );
}

fn line(text: &mut String, row: &RowReport) {
    let [shortest, longest] = row.query_spread;
    let spread = match row.query_seconds > 0.0 && row.rounds > 1 {
        true => format!("{:.0}", 50.0 * (longest - shortest) / row.query_seconds),
        false => "-".into(),
    };
    let _ = writeln!(
        text,
        "  {:<36}{:<28}{:>10.1}{:>10.2}{spread:>8}{:>10.1}{:>7} MiB{:>7}",
        row.tester,
        row.parameter,
        row.build_seconds * 1e3,
        row.ns_per_query,
        row.frame_seconds * 1e3,
        grouped(row.bytes.div_ceil(1 << 20)),
        grouped(row.wrong),
    );
}

fn ratios(text: &mut String, ratio: &RatioReport) {
    for (what, value, between) in
        [("query", ratio.query, &ratio.query_between), ("frame", ratio.frame, &ratio.frame_between)]
    {
        if let (Some(value), Some([embree, native])) = (value, between) {
            let _ = writeln!(text, "  {what}: {value:.2} = {embree} over {native}");
        }
    }
}
