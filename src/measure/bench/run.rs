//! One turn of a contender: everything is built, and asked once or twice.

use super::{Contender, Side, Stage};
use crate::error::Result;
use crate::measure::{answer_view, timed};
use crate::shadow::{BuildInput, EmbreeSettings, Resolution, SceneIndex, ShadowTester};

/// How often a tester is asked in a turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passes {
    /// Once.
    One,
    /// Once for the frame, and once more when it is there already.
    Two,
}

/// What a turn took.
#[derive(Debug, Clone)]
pub struct Turn {
    /// Seconds for all that is built, for all lights.
    pub build: f64,
    /// Seconds for all answers, for the first time.
    pub first: f64,
    /// Seconds for all answers when the tester was there already; those of the first time if it was asked once.
    pub query: f64,
    /// What the testers of all lights keep.
    pub bytes: u64,
    /// The answers of each light, in rows.
    pub answers: Vec<Vec<bool>>,
}

impl Turn {
    /// From triangles and points to answers.
    pub fn frame(&self) -> f64 {
        self.build + self.first
    }

    fn new() -> Turn {
        Turn { build: 0.0, first: 0.0, query: 0.0, bytes: 0, answers: Vec::new() }
    }

    /// Asks the tester of the next light.
    fn ask(
        &mut self,
        tester: &dyn ShadowTester,
        who: &Contender,
        stage: &Stage,
        passes: Passes,
    ) -> Result<()> {
        let light = &stage.lights[self.answers.len()];
        let points = light.points(who.order);
        let first = answer_view(tester, points)?;
        self.first += first.seconds;
        self.query += match passes {
            Passes::One => first.seconds,
            Passes::Two => answer_view(tester, points)?.seconds,
        };
        self.answers.push(light.in_rows(who.order, first.occluded));
        Ok(())
    }
}

/// What Embree has before the clock starts: its device, and what it reads.
pub struct Table {
    #[cfg(feature = "embree")]
    device: crate::embree::Device,
    #[cfg(feature = "embree")]
    prepared: crate::shadow::embree::Prepared,
}

impl Table {
    /// For as many threads as the pool has that this is called in.
    ///
    /// # Errors
    /// What Embree reports.
    #[cfg_attr(not(feature = "embree"), expect(unused_variables))]
    pub fn new(stage: &Stage) -> Result<Table> {
        Ok(Table {
            #[cfg(feature = "embree")]
            device: crate::embree::Device::new(rayon::current_num_threads())?,
            #[cfg(feature = "embree")]
            prepared: crate::shadow::embree::Prepared::new(stage.scene)?,
        })
    }

    /// Turns of contenders that can share what is built, which is done once; or of one alone.
    ///
    /// # Errors
    /// What the tester reports.
    pub fn turns(&self, group: &[Contender], stage: &Stage, passes: Passes) -> Result<Vec<Turn>> {
        match group[0].side() {
            Side::Embree => self.embree(group, stage, passes),
            _ => native(group, stage, passes),
        }
    }

    #[cfg(feature = "embree")]
    fn embree(&self, group: &[Contender], stage: &Stage, passes: Passes) -> Result<Vec<Turn>> {
        use crate::embree::EmbreeMode;
        use crate::shadow::embree::{Hierarchy, USUAL_EPSILON};
        let mode = |who: &Contender| who.mode().unwrap_or(EmbreeMode::RIVAL);
        let built = timed(|| Hierarchy::new(&self.device, &self.prepared, mode(&group[0])));
        let hierarchy = built.value?;
        let turn = |who: &Contender| {
            let mut turn = Turn { build: built.seconds, bytes: hierarchy.bytes() as u64, ..Turn::new() };
            for light in &stage.lights {
                let epsilon = who.epsilon.unwrap_or(USUAL_EPSILON);
                let tester = hierarchy.at(light.light, epsilon, mode(who).query);
                turn.ask(&tester, who, stage, passes)?;
            }
            Ok(turn)
        };
        group.iter().map(turn).collect()
    }

    #[cfg(not(feature = "embree"))]
    fn embree(&self, _: &[Contender], _: &Stage, _: Passes) -> Result<Vec<Turn>> {
        Ok(Vec::new())
    }
}

/// One light after the other, so that only one tester is in memory.
fn native(group: &[Contender], stage: &Stage, passes: Passes) -> Result<Vec<Turn>> {
    let index = timed(|| SceneIndex::new(stage.scene));
    let mut turns = vec![Turn { build: index.seconds, ..Turn::new() }; group.len()];
    for light in &stage.lights {
        let input = BuildInput {
            resolution: group[0].resolution.unwrap_or(Resolution::Auto),
            memory: stage.memory,
            instruction_set: stage.instruction_set,
            embree: EmbreeSettings { threads: rayon::current_num_threads(), ..EmbreeSettings::default() },
            ..BuildInput::new(stage.scene, &index.value, light.light)
        };
        let built = timed(|| (group[0].entry.build)(&input));
        let tester = built.value?;
        for (turn, who) in turns.iter_mut().zip(group) {
            turn.build += built.seconds;
            turn.bytes += tester.bytes() as u64;
            turn.ask(tester.as_ref(), who, stage, passes)?;
        }
    }
    Ok(turns)
}
