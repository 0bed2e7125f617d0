//! All the ways in which testers can be set.

use lightbuffer::geometry::batch::InstructionSet;
use lightbuffer::hard_cases::Situation;
use lightbuffer::measure::{Question, answer};
use lightbuffer::scene::PrimitiveIndex;
use lightbuffer::shadow::bounding_volumes::BoundingVolumes;
use lightbuffer::shadow::brute_force::BruteForce;
use lightbuffer::shadow::exact::plain::PlainTest;
use lightbuffer::shadow::exact::{Arbiter, Occlusion};
use lightbuffer::shadow::light_buffer::LightBuffer;
use lightbuffer::shadow::{
    Basis, BuildInput, Culling, ObjectCoherence, Receivers, Resolution, SceneIndex, ShadowTester,
    TesterEntry, VolumeThreshold, testers,
};
use std::fmt;
use std::sync::LazyLock;

/// Whether a point is occluded, and if not, what its segment crosses.
pub type Answer = (bool, Vec<PrimitiveIndex>);

/// Who is asked.
#[derive(Clone, Copy)]
pub enum Who {
    Arbiter,
    BruteForce(InstructionSet),
    BoundingVolumes(InstructionSet),
    LightBuffer,
    /// A native tester that is known here by its name alone, on some instructions.
    Other(&'static TesterEntry, InstructionSet),
}

/// A tester and how it is set.
#[derive(Clone, Copy)]
pub struct Way {
    pub who: Who,
    pub receivers: Receivers,
    pub resolution: Resolution,
    pub culling: Culling,
    pub volumes: VolumeThreshold,
    pub coherence: ObjectCoherence,
    pub threads: usize,
}

impl Way {
    pub const fn of(who: Who) -> Way {
        Way {
            who,
            receivers: Receivers::Anywhere,
            resolution: Resolution::Cells(64),
            culling: Culling::Off,
            volumes: VolumeThreshold::Off,
            coherence: ObjectCoherence::Off,
            threads: 1,
        }
    }

    pub const fn arbiter() -> Way {
        Way::of(Who::Arbiter)
    }

    /// A light buffer of so many cells.
    pub const fn light_buffer(resolution: u32) -> Way {
        Way { resolution: Resolution::Cells(resolution), ..Way::of(Who::LightBuffer) }
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.who {
            Who::Arbiter => write!(f, "exact")?,
            Who::BruteForce(set) => write!(f, "brute-force, {set:?}")?,
            Who::BoundingVolumes(set) => write!(f, "bounding-volumes, {set:?}")?,
            Who::Other(entry, set) => write!(f, "{}, {set:?}, at R = {:?}", entry.name, self.resolution)?,
            Who::LightBuffer => write!(
                f,
                "light buffer of 1986 at R = {:?}, culling {:?}, volumes {:?}, coherence {:?}",
                self.resolution, self.culling, self.volumes, self.coherence
            )?,
        }
        write!(f, ", receivers {:?}, {} threads", self.receivers, self.threads)
    }
}

/// All ways for a situation. The finest resolution costs most, so that it is tried once, unless all are asked for.
pub fn ways(situation: &Situation) -> Vec<Way> {
    let mut ways = Vec::new();
    let places: &[Receivers] = match situation.receivers() {
        Receivers::Surfaces => &[Receivers::Surfaces, Receivers::Anywhere],
        Receivers::Anywhere => &[Receivers::Anywhere],
    };
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        ways.extend([Way::of(Who::BruteForce(set)), Way::of(Who::BoundingVolumes(set))]);
    }
    ways.push(Way { threads: 2, ..Way::of(Who::BruteForce(InstructionSet::best())) });
    for entry in others() {
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let resolutions = [1, 7, 64].into_iter().chain(situation.resolution);
            let resolutions = resolutions.map(Resolution::Cells).chain([Resolution::Auto]);
            ways.extend(resolutions.map(|resolution| Way { resolution, ..Way::of(Who::Other(entry, set)) }));
        }
        let best = Who::Other(entry, InstructionSet::best());
        for resolution in [Resolution::Cells(300), Resolution::Auto] {
            ways.push(Way { resolution, threads: 2, ..Way::of(best) });
        }
    }
    for &receivers in places {
        let buffer = |resolution| Way { receivers, ..Way::light_buffer(resolution) };
        let solids = |way| Way { culling: Culling::ClosedSolids, ..way };
        let grouped = |most, way| Way { volumes: VolumeThreshold::MoreThan(most), ..way };
        let coherent = |way| Way { coherence: ObjectCoherence::LastOccluder, ..way };
        for resolution in [1, 3, 64].into_iter().chain(situation.resolution) {
            ways.extend([buffer(resolution), solids(buffer(resolution))]);
        }
        ways.extend([
            grouped(6, buffer(1)),
            grouped(0, buffer(7)),
            coherent(buffer(3)),
            coherent(grouped(0, solids(buffer(16)))),
            Way { threads: 2, ..buffer(64) },
        ]);
    }
    let receivers = situation.receivers();
    if every_resolution() {
        let powers = (0..=11).map(|n| 1 << n);
        for resolution in powers.chain([3, 7, 100, 1000, 2047]) {
            let buffer = Way { receivers, ..Way::light_buffer(resolution) };
            ways.extend([buffer, Way { threads: 2, ..buffer }]);
            // Two threads on the best instructions alone: the buffers of 1986 in them take most of the time, and know none.
            for entry in others() {
                let cells = Resolution::Cells(resolution);
                let way = |set| Way { resolution: cells, ..Way::of(Who::Other(entry, set)) };
                ways.extend(InstructionSet::ALL.into_iter().filter(|set| set.is_available()).map(way));
                ways.push(Way { threads: 2, ..way(InstructionSet::best()) });
            }
        }
    } else {
        ways.push(Way { receivers, threads: 2, ..Way::light_buffer(512) });
    }
    ways
}

/// Native testers beside those of which all settings are gone through.
pub fn others() -> impl Iterator<Item = &'static TesterEntry> {
    let known = ["brute-force", "bounding-volumes"];
    testers().filter(move |entry| entry.basis == Basis::Exact && !known.contains(&entry.name))
}

/// Whether the long run was asked for: `make hard-cases`.
fn every_resolution() -> bool {
    std::env::var_os("HARD_CASES_EVERY_RESOLUTION").is_some_and(|value| value == "1")
}

fn input<'a>(way: &Way, situation: &'a Situation, index: &'a SceneIndex) -> BuildInput<'a> {
    BuildInput {
        resolution: way.resolution,
        receivers: way.receivers,
        culling: way.culling,
        bounding_volumes: way.volumes,
        object_coherence: way.coherence,
        ..BuildInput::new(&situation.scene, index, situation.light)
    }
}

/// A pool of one and one of two threads.
static POOLS: LazyLock<[rayon::ThreadPool; 2]> = LazyLock::new(|| {
    [1, 2].map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads"))
});

/// A tester's answers to a situation.
pub fn ask(way: &Way, situation: &Situation) -> Vec<Answer> {
    let index = SceneIndex::new(&situation.scene);
    POOLS[way.threads - 1].install(|| ask_here(way, situation, &index))
}

/// The same in this thread.
pub fn ask_here(way: &Way, situation: &Situation, index: &SceneIndex) -> Vec<Answer> {
    let input = input(way, situation, index);
    let tester: Box<dyn ShadowTester + '_> = match way.who {
        Who::Arbiter => Box::new(Arbiter::new(&input)),
        Who::BruteForce(set) => Box::new(BruteForce::new(&input, set)),
        Who::BoundingVolumes(set) => Box::new(BoundingVolumes::new(&input, set)),
        Who::LightBuffer => Box::new(LightBuffer::new(&input).unwrap()),
        Who::Other(entry, instruction_set) => {
            (entry.build)(&BuildInput { instruction_set, ..input }).unwrap()
        }
    };
    let question = Question::of(&situation.scene);
    let answers = answer(tester.as_ref(), &situation.points, question, &|_| {}).unwrap();
    let crossed = |i: usize| answers.crossings.as_ref().map_or(Vec::new(), |c| c.of(i).to_vec());
    answers.occluded.iter().enumerate().map(|(i, &occluded)| (occluded, crossed(i))).collect()
}

/// A light buffer of so many cells for a situation, and what is to be known of it.
pub fn with_buffer<T>(situation: &Situation, cells: u32, look: impl FnOnce(&LightBuffer) -> T) -> T {
    let index = SceneIndex::new(&situation.scene);
    let way = Way { receivers: situation.receivers(), ..Way::light_buffer(cells) };
    look(&LightBuffer::new(&input(&way, situation, &index)).unwrap())
}

/// Tests of the definition that are not too many.
const MOST_PLAIN_TESTS: usize = 400_000;

/// The answers of the definition in integers, of all primitives, unless that takes too long.
pub fn plain(situation: &Situation) -> Option<Vec<Answer>> {
    let tests = situation.scene.primitive_count() as usize * situation.points.len();
    if tests > MOST_PLAIN_TESTS {
        return None;
    }
    let plain = PlainTest::new(&situation.scene, situation.light, &situation.points);
    let answer = |point| {
        let occluded = plain.decide(point) == Occlusion::Occluded;
        (occluded, if occluded { Vec::new() } else { plain.crossed(point) })
    };
    Some(situation.points.iter().map(answer).collect())
}
