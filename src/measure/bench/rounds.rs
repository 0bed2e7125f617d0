//! The quick round, who is best in it, and the rounds of the best.

use super::run::{Passes, Table, Turn};
use super::truths::{Differences, Truths, Wrong};
use super::{Choice, Contender, Plan, Side, Skipped, Stage, candidates};
use crate::error::{Error, Result};
use crate::measure::Repeated;

/// What was measured with some number of threads.
pub struct Measured {
    /// Everyone who took part, in the order of the registry; the best have taken part in the rounds.
    pub rows: Vec<Row>,
    /// Those who did not, and why.
    pub skipped: Vec<Skipped>,
    /// Embree over native; `None` unless there is one of each, the native one without a wrong answer.
    pub query: Option<Ratio>,
    /// The same of frames.
    pub frame: Option<Ratio>,
}

/// The fastest of Embree's over the fastest native one, by numbers of rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// Seconds over seconds.
    pub ratio: f64,
    /// The row of Embree's.
    pub embree: usize,
    /// The native one.
    pub native: usize,
}

/// One contender.
#[derive(Clone)]
pub struct Row {
    /// Who.
    pub contender: Contender,
    /// Seconds to build all, one entry a turn.
    pub build: Repeated,
    /// Seconds for all queries.
    pub query: Repeated,
    /// Seconds from triangles and points to answers.
    pub frame: Repeated,
    /// Memory.
    pub bytes: u64,
    /// Answers that are not true.
    pub wrong: Wrong,
    /// Whether it took part in the rounds; its times are then those of the rounds alone.
    pub in_rounds: bool,
    differences: Differences,
}

/// What is compared.
type Time = fn(&Row) -> &Repeated;

const TIMES: [Time; 2] = [|row| &row.query, |row| &row.frame];

/// Measures a stage with the threads of the pool that this is called in. `say` is told what is going on.
///
/// # Errors
/// If Embree cannot be asked, or answers are not the same each time.
pub fn measure(
    stage: &Stage,
    choice: &Choice,
    plan: &Plan,
    truths: &mut Truths,
    say: &dyn Fn(&str),
) -> Result<Measured> {
    let (contenders, mut skipped) = candidates(choice, stage)?;
    let table = Table::new(stage)?;
    say(&format!("a quick round of {}", contenders.len()));
    let mut rows = quick(&contenders, stage, &table, truths, &mut skipped)?;
    let others = other_epsilons(&rows, choice);
    rows.extend(quick(&others, stage, &table, truths, &mut skipped)?);
    say("asking the arbiter where answers differ");
    let is_suspicious = |row: &&Row| row.contender.side() != Side::Approximate;
    let suspicious: Vec<&Differences> =
        rows.iter().filter(is_suspicious).map(|row| &row.differences).collect();
    if !rows.is_empty() {
        truths.decide(stage, &suspicious, plan);
    }
    rows.iter_mut().for_each(|row| row.wrong = truths.wrong(&row.differences));
    let finalists = finalists(&rows, plan.finalists);
    say(&format!("{} rounds of {}", plan.rounds, finalists.len()));
    for &finalist in &finalists {
        let row = &mut rows[finalist];
        row.in_rounds = true;
        for times in [&mut row.build, &mut row.query, &mut row.frame] {
            *times = Repeated::default();
        }
    }
    for round in 0..plan.rounds as usize {
        for turn in 0..finalists.len() {
            let row = &mut rows[finalists[(turn + round) % finalists.len()]];
            let turn = table.turns(std::slice::from_ref(&row.contender), stage, Passes::Two)?;
            let turn = turn.into_iter().next().expect("a turn for each");
            if truths.differences(&turn.answers) != row.differences {
                let who = row.contender.entry.name;
                return Err(Error::Usage(format!(
                    "{who}: its answers are not the same each time it is asked"
                )));
            }
            row.add(&turn);
        }
    }
    let [query, frame] = TIMES.map(|time| ratio(&rows, time));
    Ok(Measured { rows, skipped, query, frame })
}

impl Row {
    fn new(contender: &Contender, turn: &Turn, truths: &mut Truths) -> Row {
        let mut row = Row {
            contender: contender.clone(),
            build: Repeated::default(),
            query: Repeated::default(),
            frame: Repeated::default(),
            bytes: turn.bytes,
            wrong: Wrong::default(),
            in_rounds: false,
            differences: truths.differences(&turn.answers),
        };
        row.add(turn);
        row
    }

    fn add(&mut self, turn: &Turn) {
        self.build.push(turn.build);
        self.query.push(turn.query);
        self.frame.push(turn.frame());
    }

    /// Whether it may be the fastest of its side.
    fn counts_for(&self, side: Side) -> bool {
        self.contender.side() == side && (side != Side::Native || self.wrong.wrong() == 0)
    }
}

/// Everyone once; what can share what is built does. Who needs more than there is, is skipped.
fn quick(
    contenders: &[Contender],
    stage: &Stage,
    table: &Table,
    truths: &mut Truths,
    skipped: &mut Vec<Skipped>,
) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for group in contenders.chunk_by(Contender::shares_build) {
        match table.turns(group, stage, Passes::One) {
            Ok(turns) => {
                let pairs = group.iter().zip(&turns);
                rows.extend(pairs.map(|(contender, turn)| Row::new(contender, turn, truths)));
            }
            Err(Error::Usage(why)) => skipped.push(Skipped { tester: group[0].entry.name.into(), why }),
            Err(error) => return Err(error),
        }
    }
    Ok(rows)
}

/// The mode of Embree that is fastest for queries, with the other epsilons.
fn other_epsilons(rows: &[Row], choice: &Choice) -> Vec<Contender> {
    let best = best(rows, Side::Embree, TIMES[0], 1);
    let with = |&epsilon: &f32| Contender { epsilon: Some(epsilon), ..rows[best[0]].contender.clone() };
    let others = choice.epsilons.iter().skip(1);
    if best.is_empty() { Vec::new() } else { others.map(with).collect() }
}

/// Numbers of the best rows of a side, so many at most.
fn best(rows: &[Row], side: Side, time: Time, most: usize) -> Vec<usize> {
    let of_side = rows.iter().enumerate().filter(|(_, row)| row.counts_for(side));
    Repeated::fastest(of_side.map(|(number, row)| (number, time(row))), most)
}

/// Those who take part in the rounds: of each side the best for queries and for frames.
fn finalists(rows: &[Row], most: usize) -> Vec<usize> {
    let sides = [Side::Native, Side::Embree];
    let pairs = sides.iter().flat_map(|&side| TIMES.map(|time| (side, time)));
    let mut numbers: Vec<usize> = pairs.flat_map(|(side, time)| best(rows, side, time, most)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

fn ratio(rows: &[Row], time: Time) -> Option<Ratio> {
    let fastest = |side: Side| {
        let in_rounds = (0..rows.len()).filter(|&n| rows[n].in_rounds && rows[n].counts_for(side));
        in_rounds.min_by(|&a, &b| time(&rows[a]).median().total_cmp(&time(&rows[b]).median()))
    };
    let (embree, native) = (fastest(Side::Embree)?, fastest(Side::Native)?);
    let [over, under] = [embree, native].map(|number| time(&rows[number]).median());
    (under > 0.0).then(|| Ratio { ratio: over / under, embree, native })
}
