//! Asks testers about a case.

use crate::cases::Case;
use lightbuffer::geometry::LightPosition;
use lightbuffer::measure::{Question, answer, answer_view};
use lightbuffer::scene::{Light, PrimitiveIndex};
use lightbuffer::shading::{RayForest, TreeRules};
use lightbuffer::shadow::Queries;
use lightbuffer::shadow::exact::Occlusion;
use lightbuffer::shadow::exact::plain::PlainTest;
use lightbuffer::shadow::light_buffer::LightBuffer;
use lightbuffer::shadow::{
    BuildInput, Culling, EmbreeSettings, ObjectCoherence, Resolution, SceneIndex, TesterEntry,
    VolumeThreshold,
};
use lightbuffer::visibility::{Points, RoundedPoint, VisibleSurfaces, t_buffer};

/// Checksum of the masks of all cases, the same in every build profile.
pub const RECORDED_CHECKSUM: u64 = 11_373_790_335_096_143_609;

/// The share of a segment that Embree leaves out at both ends.
pub const EMBREE_EPSILON: f32 = 1e-4;

/// How a tester is built and run.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    pub resolution: Resolution,
    pub culling: Culling,
    pub bounding_volumes: VolumeThreshold,
    pub object_coherence: ObjectCoherence,
    pub threads: usize,
}

impl Setting {
    /// A resolution, everything else as usual, in two threads.
    pub const fn of(resolution: Resolution) -> Setting {
        Setting {
            resolution,
            culling: Culling::Off,
            bounding_volumes: VolumeThreshold::Off,
            object_coherence: ObjectCoherence::Off,
            threads: 2,
        }
    }
}

/// A case with its queries: what its camera sees, light by light.
pub struct Asked<'a> {
    case: &'a Case,
    index: SceneIndex,
    lights: Vec<(LightPosition, Queries)>,
}

impl<'a> Asked<'a> {
    /// What the camera sees, and what it sees in mirrors and behind glass by at most so many rays.
    pub fn with_trees(case: &'a Case, depth: u32) -> Asked<'a> {
        let hits = t_buffer::first_hits(&case.scene, &case.camera, case.size);
        let visible = VisibleSurfaces::new(&case.scene, &case.camera, &hits);
        let forest =
            RayForest::grow(&case.scene, visible, case.size.pixels() as u64, TreeRules::of_depth(depth));
        let queries = |light: &Light| (light.position(), Queries::new(&case.scene, &forest.nodes, light));
        Asked { case, index: SceneIndex::new(&case.scene), lights: case.lights.iter().map(queries).collect() }
    }

    pub fn of(case: &'a Case) -> Asked<'a> {
        let hits = t_buffer::first_hits(&case.scene, &case.camera, case.size);
        let visible = VisibleSurfaces::new(&case.scene, &case.camera, &hits);
        let queries = |light: &Light| (light.position(), Queries::new(&case.scene, &visible, light));
        Asked { case, index: SceneIndex::new(&case.scene), lights: case.lights.iter().map(queries).collect() }
    }

    fn input(&self, light: LightPosition, setting: Setting) -> BuildInput<'_> {
        BuildInput {
            resolution: setting.resolution,
            culling: setting.culling,
            bounding_volumes: setting.bounding_volumes,
            object_coherence: setting.object_coherence,
            embree: EmbreeSettings { epsilon: EMBREE_EPSILON, threads: setting.threads },
            ..BuildInput::new(&self.case.scene, &self.index, light)
        }
    }

    /// The scene of the case.
    #[cfg(feature = "embree")]
    pub fn scene(&self) -> &lightbuffer::Scene {
        &self.case.scene
    }

    /// All queries with their lights, in the order of answers.
    #[cfg(feature = "embree")]
    pub fn queries(&self) -> impl Iterator<Item = (LightPosition, &lightbuffer::SurfacePoint)> {
        self.lights.iter().flat_map(|(light, queries)| queries.points.iter().map(|point| (*light, point)))
    }

    /// The definition: all triangles, all queries, in integers.
    pub fn plain_truth(&self) -> Vec<bool> {
        self.lights
            .iter()
            .flat_map(|(light, queries)| {
                let plain = PlainTest::new(&self.case.scene, *light, &queries.points);
                queries.points.iter().map(|p| plain.decide(p) == Occlusion::Occluded).collect::<Vec<_>>()
            })
            .collect()
    }

    /// The same, with what the segments of those that are not occluded cross.
    pub fn plain_truth_all(&self) -> Vec<Answer> {
        let decide = |(light, queries): &(LightPosition, Queries)| {
            let plain = PlainTest::new(&self.case.scene, *light, &queries.points);
            let one = |point| match plain.decide(point) {
                Occlusion::Occluded => (true, Vec::new()),
                Occlusion::Lit => (false, plain.crossed(point)),
            };
            queries.points.iter().map(one).collect::<Vec<_>>()
        };
        self.lights.iter().flat_map(decide).collect()
    }

    /// Fails with the first query, in bits, that is answered differently.
    pub fn assert_equal(&self, answers: &[bool], truth: &[bool], who: &str) {
        assert_eq!(answers.len(), truth.len());
        let Some(wrong) = answers.iter().zip(truth).position(|(a, t)| a != t) else { return };
        let count = answers.iter().zip(truth).filter(|(a, t)| a != t).count();
        let (light, point) = self
            .lights
            .iter()
            .flat_map(|(light, queries)| queries.points.iter().map(move |point| (light, point)))
            .nth(wrong)
            .expect("a query");
        panic!(
            "{}: {who} wrong in {count} queries, first {point:?} from {light:?}, truth {}",
            self.case.name, truth[wrong]
        );
    }

    /// Answers with the pixel and light they belong to, in an order that no index decides.
    pub fn by_pixel(&self, answers: &[bool]) -> Vec<(usize, u32, bool)> {
        let keys =
            self.lights.iter().enumerate().flat_map(|(l, (_, q))| q.nodes.iter().map(move |&node| (l, node)));
        keys.zip(answers).map(|((light, pixel), &answer)| (light, pixel, answer)).collect()
    }

    /// The light buffers' own invariants.
    pub fn audit(&self, setting: Setting) {
        for (light, _) in &self.lights {
            let buffer = LightBuffer::new(&self.input(*light, setting)).unwrap();
            let audit = buffer.validate().unwrap_or_else(|e| panic!("{}: {e}", self.case.name));
            assert!(audit.cells > 0 && audit.directions > 0);
        }
    }

    /// Bounding-volume records of the light buffers, light by light.
    pub fn bounding_volumes(&self, setting: Setting) -> Vec<u64> {
        let count = |(light, _): &(LightPosition, Queries)| {
            LightBuffer::new(&self.input(*light, setting)).unwrap().counts().bounding_volumes
        };
        self.lights.iter().map(count).collect()
    }

    /// Queries of all lights that the last occluder answers.
    pub fn coherence_hits(&self, setting: Setting) -> u64 {
        let hits = |(light, queries): &(LightPosition, Queries)| {
            let buffer = LightBuffer::new(&self.input(*light, setting)).unwrap();
            answer(&buffer, &queries.points, Question::Occlusion, &|_| {}).unwrap().counters.coherence_hits
        };
        self.lights.iter().map(hits).sum()
    }

    /// Triangles that are culled, light by light.
    pub fn culled(&self) -> Vec<u64> {
        let setting = Setting { culling: Culling::ClosedSolids, ..Setting::of(Resolution::Cells(1)) };
        let culled = |(light, _): &(LightPosition, Queries)| {
            LightBuffer::new(&self.input(*light, setting)).unwrap().counts().culled
        };
        self.lights.iter().map(culled).collect()
    }
}

/// A tester's answers to all queries of a case.
pub fn ask(entry: &TesterEntry, asked: &Asked, setting: Setting) -> Vec<bool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(setting.threads).build().unwrap();
    let one_light = |(light, queries): &(LightPosition, Queries)| {
        let tester = (entry.build)(&asked.input(*light, setting)).unwrap();
        let occluded =
            answer(tester.as_ref(), &queries.points, Question::Occlusion, &|_| {}).unwrap().occluded;
        // A tester that picks another way for its second view may be asked twice as well.
        let rounded = RoundedPoint::all(&queries.points);
        let at = answer_view(tester.as_ref(), Points::new(&rounded, &queries.points)).unwrap().occluded;
        assert!(occluded == at, "{}: points that are rounded already have other answers", entry.name);
        occluded
    };
    pool.install(|| asked.lights.iter().flat_map(one_light).collect())
}

/// Whether a point is occluded, and if not, what its segment crosses.
pub type Answer = (bool, Vec<PrimitiveIndex>);

/// A tester's answers to all queries of a case.
pub fn ask_all(entry: &TesterEntry, asked: &Asked, setting: Setting) -> Vec<Answer> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(setting.threads).build().unwrap();
    let one_light = |(light, queries): &(LightPosition, Queries)| {
        let tester = (entry.build)(&asked.input(*light, setting)).unwrap();
        let question = Question::of(&asked.case.scene);
        let answers = answer(tester.as_ref(), &queries.points, question, &|_| {}).unwrap();
        let crossed = |i: usize| answers.crossings.as_ref().map_or(Vec::new(), |c| c.of(i).to_vec());
        answers.occluded.iter().enumerate().map(|(i, &o)| (o, crossed(i))).collect::<Vec<_>>()
    };
    pool.install(|| asked.lights.iter().flat_map(one_light).collect())
}

/// FNV-1a over the answers.
pub fn checksum(answers: &[bool]) -> u64 {
    answers.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &answer| {
        (hash ^ u64::from(answer)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
