//! What is said of the hard cases: an entry a case in `validate.json`, and a row a case in the table.

use super::validation::{LightReport, TesterReport, Totals, Validation};
use crate::film::grouped;
use crate::hard_cases::{HardCase, SituationVerdict};
use crate::shadow::{Basis, testers};
use crate::verdict::VerdictCounts;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// One numbered case.
#[derive(Debug, Clone, Serialize)]
pub struct CaseReport {
    /// From 1.
    pub number: u32,
    /// What is hard about it.
    pub name: &'static str,
    /// Points asked about in all its situations.
    pub queries: u64,
    /// Testers by name, the arbiter among them: it too is held against what is known.
    pub testers: BTreeMap<&'static str, CaseTester>,
    /// Who is right where.
    pub verdicts: VerdictCounts,
}

/// One tester in one case.
#[derive(Debug, Clone, Default, Serialize)]
pub struct CaseTester {
    /// Right and wrong in those situations that it has answers for, if there are such.
    #[serde(flatten)]
    pub answers: Option<TesterReport>,
    /// Why it has none in the others, if there are others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
}

impl CaseReport {
    /// Sums over the situations of a case.
    pub fn new(case: &HardCase, situations: &[SituationVerdict]) -> CaseReport {
        let totals = Totals::of(&reports(situations));
        let mut testers: BTreeMap<&'static str, CaseTester> = BTreeMap::new();
        for (name, report) in totals.testers {
            testers.entry(name).or_default().answers = Some(report);
        }
        for refusal in situations.iter().flat_map(|situation| &situation.refused) {
            testers.entry(refusal.name).or_default().refused.get_or_insert_with(|| refusal.why.clone());
        }
        CaseReport {
            number: case.number,
            name: case.name,
            queries: totals.queries,
            testers,
            verdicts: totals.verdicts,
        }
    }
}

/// Each situation as if it were a light of an image that has no pixels.
pub fn reports(situations: &[SituationVerdict]) -> Vec<LightReport> {
    situations.iter().map(|situation| LightReport::without_image("situation", &situation.verdict)).collect()
}

/// Wrong answers of the arbiter: where it contradicts what is known.
pub fn arbiter_wrong(report: &Validation) -> u64 {
    let truth = testers().filter(|entry| entry.basis == Basis::Truth);
    truth.filter_map(|entry| report.totals.testers.get(entry.name)).map(|t| t.counts.wrong).sum()
}

/// A row a case: its number, wrong answers of each tester, and its name.
pub fn case_table(report: &Validation) -> String {
    let asked = |name: &str| report.cases.iter().any(|case| case.testers.contains_key(name));
    let names: Vec<&'static str> = testers().map(|entry| entry.name).filter(|name| asked(name)).collect();
    let mut text = format!("{:>4} {:>8}", "case", "queries");
    for name in &names {
        let _ = write!(text, "  {name:>7}");
    }
    text.push('\n');
    for case in &report.cases {
        let _ = write!(text, "{:>4} {:>8}", case.number, grouped(case.queries));
        for name in &names {
            let width = name.len().max(7);
            let tester = case.testers.get(name).cloned().unwrap_or_default();
            let _ = write!(text, "  {:>width$}", in_cell(&tester));
        }
        let _ = writeln!(text, "  {}", case.name);
    }
    let _ = write!(text, "{:>4} {:>8}", "all", grouped(report.totals.queries));
    for name in &names {
        let width = name.len().max(7);
        let wrong = report.totals.testers.get(name).map_or("-".into(), |t| grouped(t.counts.wrong));
        let _ = write!(text, "  {wrong:>width$}");
    }
    text.push_str("  wrong answers\n");
    refusals(&mut text, report, &names);
    summary(&mut text, report, &names);
    text
}

/// Wrong answers; a star where some situations were refused, a dash where all were.
fn in_cell(tester: &CaseTester) -> String {
    match (&tester.answers, &tester.refused) {
        (None, _) => "-".into(),
        (Some(answers), None) => grouped(answers.counts.wrong),
        (Some(answers), Some(_)) => format!("{}*", grouped(answers.counts.wrong)),
    }
}

/// A line for each reason that a tester gives for having no answer.
fn refusals(text: &mut String, report: &Validation, names: &[&'static str]) {
    for name in names {
        let refused = |case: &CaseReport| {
            let why = case.testers.get(name)?.refused.clone()?;
            Some((case.number, why))
        };
        let reasons: Vec<_> = report.cases.iter().filter_map(refused).collect();
        let different: BTreeSet<&String> = reasons.iter().map(|(_, why)| why).collect();
        for why in different {
            let cases =
                reasons.iter().filter(|(_, other)| other == why).map(|(number, _)| number.to_string());
            let _ = writeln!(text, "{name} refused {}: {why}", cases.collect::<Vec<_>>().join(", "));
        }
    }
}

fn summary(text: &mut String, report: &Validation, names: &[&'static str]) {
    let wrong = arbiter_wrong(report);
    if wrong > 0 {
        let _ = writeln!(text, "the arbiter contradicts what is known of {} answers", grouped(wrong));
    }
    let totals = &report.totals;
    let (native, answers) = (grouped(totals.native_wrong()), grouped(totals.native_answers()));
    let _ = write!(text, "{native} of {answers} native answers wrong");
    let measured = testers().filter(|entry| entry.basis == Basis::Measured && names.contains(&entry.name));
    for (i, entry) in measured.enumerate() {
        let wrong_in = |case: &&CaseReport| {
            let answers = case.testers.get(entry.name).and_then(|tester| tester.answers.as_ref());
            answers.is_some_and(|answers| answers.counts.wrong > 0)
        };
        let cases = report.cases.iter().filter(wrong_in).count();
        let wrong = totals.testers.get(entry.name).map_or(0, |t| t.counts.wrong);
        let mark = if i == 0 { ';' } else { ',' };
        let _ = write!(text, "{mark} {} {} in {cases} cases", entry.name, grouped(wrong));
    }
    text.push('\n');
}
