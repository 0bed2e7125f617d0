//! Testers that are kept from frame to frame, beside those that are built for the frame.

use lightbuffer::Scene;
use lightbuffer::geometry::LightPosition;
use lightbuffer::memory::MemoryLimit;
use lightbuffer::scene::animation::{Animation, Moment};
use lightbuffer::scene::{ImageSize, formats};
use lightbuffer::shadow::{
    Basis, BuildInput, Fresh, Keeper, Origin, Queries, SceneIndex, TesterEntry, TesterSource, find, testers,
};
use lightbuffer::visibility::{FirstHitMethod, VisibleSurfaces};
use std::collections::BTreeMap;

/// Two blocks over a floor under two lights. One light moves straight up and down; the other one stands still; one block moves
/// from frame 4 to 6 alone, the camera moves always.
const SCENE: &str = r#"
version = 1

[[mesh]]
name = "floor"
vertices = [[-6, 0, -6], [-6, 0, 6], [6, 0, 6], [6, 0, -6]]
faces = [[0, 1, 2, 3]]

[[mesh]]
name = "still block"
vertices = [[1, 0.5, -0.5], [2, 0.5, -0.5], [2, 0.5, 0.5], [1, 0.5, 0.5], [1.5, 1.5, 0]]
faces = [[0, 1, 2, 3], [0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]]

[[mesh]]
name = "moving block"
vertices = [[-2, 0.5, -0.5], [-1, 0.5, -0.5], [-1, 0.5, 0.5], [-2, 0.5, 0.5], [-1.5, 1.5, 0]]
faces = [[0, 1, 2, 3], [0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]]
keyframes = [
    { frame = 4, translate = [0, 0, 0] },
    { frame = 6, translate = [0.75, 0.25, 0.5] },
]

[[sphere]]
name = "ball"
centre = [0, 1, -2]
radius = 0.75

[[light]]
name = "moving"
type = "point"
position = [0.5, 5, 0.25]
keyframes = [
    { frame = 1, position = [0.5, 5, 0.25] },
    { frame = 3, position = [0.5, 3, 0.25] },
    { frame = 8, position = [0.5, 3, 0.25], interpolation = "step" },
    { frame = 9, position = [0.5, 4, 0.25] },
]

[[light]]
name = "still"
type = "point"
position = [3, 4, 2]

[[light]]
name = "sun"
type = "directional"
direction = [0.3, -1, -0.2]

[[camera]]
position = [0, 5, 8]
target = [0, 0.5, 0]
keyframes = [
    { frame = 1, position = [0, 5, 8] },
    { frame = 9, position = [4, 5, 6] },
]
"#;

const FRAMES: std::ops::RangeInclusive<u32> = 1..=9;
const SIZE: ImageSize = ImageSize { width: 48, height: 32 };

fn animation() -> Animation {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, SCENE).unwrap();
    formats::load_animation(&path, MemoryLimit::NONE).unwrap()
}

fn moments() -> impl Iterator<Item = Moment> {
    FRAMES.map(|frame| Moment { frame, time: f64::from(frame) / 24.0 })
}

/// Every tester whose answers may not be others because it was kept.
fn compared() -> Vec<&'static TesterEntry> {
    let embree = ["embree", "embree-fast"].iter().filter_map(|name| find(name).ok());
    testers().filter(|entry| entry.basis != Basis::Measured).chain(embree).collect()
}

fn answers<'a>(
    source: &mut dyn TesterSource<'a>,
    entry: &TesterEntry,
    input: &BuildInput<'a>,
    queries: &Queries,
) -> (Vec<bool>, Origin) {
    let supplied = source.tester(entry, input).unwrap();
    let mut occluded = vec![false; queries.points.len()];
    supplied.tester.occluded(&queries.points, &mut occluded).unwrap();
    (occluded, supplied.origin)
}

fn visible(scene: &Scene) -> VisibleSurfaces {
    let camera = &scene.cameras[0];
    VisibleSurfaces::new(scene, camera, &FirstHitMethod::TBuffer.first_hits(scene, camera, SIZE))
}

/// What was built when, by tester and light, and how many queries had another answer than in the frame before at the same
/// light.
fn run() -> BTreeMap<(&'static str, String), Vec<Origin>> {
    let animation = animation();
    let mut origins: BTreeMap<_, Vec<Origin>> = BTreeMap::new();
    let mut seen = BTreeMap::new();
    for still in animation.stills(moments()) {
        let still = still.unwrap();
        let index = SceneIndex::new(&still.scene);
        let settings = BuildInput::new(&still.scene, &index, LightPosition::At(glam::Vec3::ZERO));
        let mut keeper = Keeper::new(settings);
        for moment in &still.moments {
            keeper.begin(moment.frame);
            let scene = animation.scene_at(moment.time).unwrap();
            let fresh_index = SceneIndex::new(&scene);
            let visible = visible(&scene);
            let lights = animation.sights(*moment).unwrap().lights;
            assert_eq!(lights, scene.lights);
            for light in &lights {
                let queries = Queries::new(&scene, &visible, light);
                let fresh = BuildInput::new(&scene, &fresh_index, light.position());
                let kept = BuildInput { light: light.position(), ..settings };
                let (truth, _) = answers(&mut Fresh, find("exact").unwrap(), &fresh, &queries);
                assert!(truth.contains(&true) && truth.contains(&false), "nothing to tell apart");
                seen.insert((moment.frame, light.name.clone()), truth.iter().filter(|&&o| o).count());
                for entry in compared() {
                    let what = || format!("{} of {} in frame {}", entry.name, light.name, moment.frame);
                    let (expected, _) = answers(&mut Fresh, entry, &fresh, &queries);
                    let (found, origin) = answers(&mut keeper, entry, &kept, &queries);
                    let wrong = expected.iter().zip(&found).filter(|(one, other)| one != other).count();
                    assert_eq!(wrong, 0, "{}: kept answers differ from those of one built afresh", what());
                    if entry.basis != Basis::Measured {
                        assert_eq!(found, truth, "{}", what());
                    }
                    origins.entry((entry.name, light.name.clone())).or_default().push(origin);
                }
                let arbiter = keeper.arbiter(&kept).unwrap().tester;
                let mut decided = vec![false; queries.points.len()];
                lightbuffer::ShadowTester::occluded(arbiter.as_ref(), &queries.points, &mut decided).unwrap();
                assert_eq!(decided, truth, "the kept arbiter of {} in frame {}", light.name, moment.frame);
            }
        }
    }
    // What moves changes answers, so that whoever is stale is wrong.
    let count = |light: &str, frame| seen[&(frame, light.to_owned())];
    for (light, pairs) in
        [("moving", &[(1, 2), (2, 3), (4, 5), (5, 6), (8, 9)][..]), ("still", &[(4, 5), (5, 6)])]
    {
        for &(before, after) in pairs {
            assert_ne!(count(light, before), count(light, after), "{light} in frames {before} and {after}");
        }
    }
    origins
}

#[test]
fn kept_testers_answer_as_those_that_are_built_for_the_frame() {
    let origins = run();
    use Origin::{Built, Kept};
    let since = |since: u32| Kept { since };
    // Objects stand still in frames 1 to 4, move in 5, and stand still again from 6 on.
    let still = [Built, since(1), since(1), since(1), Built, Built, since(6), since(6), since(6)];
    let moving = [Built, Built, Built, since(3), Built, Built, since(6), since(6), Built];
    for entry in compared().into_iter().filter(|entry| entry.of_scene.is_none()) {
        for (light, expected) in [("still", still), ("sun", still), ("moving", moving)] {
            assert_eq!(origins[&(entry.name, light.to_owned())], expected, "{} of {light}", entry.name);
        }
    }
    for entry in compared().into_iter().filter(|entry| entry.of_scene.is_some()) {
        // The first light of a frame builds the scene that all lights are asked in, wherever they go.
        let others = [1, 1, 1, 1, 5, 6, 6, 6, 6].map(since);
        assert_eq!(origins[&(entry.name, "moving".to_owned())], still, "{}", entry.name);
        assert_eq!(origins[&(entry.name, "still".to_owned())], others, "{}", entry.name);
    }
}

#[test]
fn what_no_frame_asks_for_goes_and_too_little_memory_is_no_failure() {
    let animation = animation();
    let scene = &animation.rest;
    let index = SceneIndex::new(scene);
    let entry = find("light-buffer").unwrap();
    let light = |number: usize| scene.lights[number].position();
    let settings = BuildInput::new(scene, &index, light(0));
    let mut keeper = Keeper::new(settings);
    keeper.begin(1);
    keeper.tester(entry, &settings).unwrap();
    let one = keeper.bytes();
    keeper.tester(entry, &BuildInput { light: light(1), ..settings }).unwrap();
    assert!(keeper.bytes() > one);
    keeper.begin(2);
    assert_eq!(keeper.tester(entry, &settings).unwrap().origin, Origin::Kept { since: 1 });
    keeper.begin(3);
    assert_eq!(keeper.bytes(), one);
    keeper.begin(4);
    assert_eq!(keeper.bytes(), 0);
    // Room for one and not for two: the other one goes, and the answer is there.
    let memory = MemoryLimit::bytes(u64::MAX);
    keeper.tester(entry, &BuildInput { memory, ..settings }).unwrap();
    let memory = MemoryLimit::bytes((one as u64).saturating_sub(1));
    let tight = keeper.tester(find("exact").unwrap(), &BuildInput { memory, light: light(1), ..settings });
    assert_eq!(tight.unwrap().origin, Origin::Built);
    assert_eq!(keeper.tester(entry, &settings).unwrap().origin, Origin::Built, "it was let go");
}

/// Answers to the queries of a light in one frame, by a tester that was built for the objects and the light of another one.
fn stale(entry: &TesterEntry, light: &str, built: u32, asked: u32) -> (Vec<bool>, Vec<bool>) {
    let animation = animation();
    let [built, asked] = [built, asked].map(|frame| animation.scene_at(f64::from(frame) / 24.0).unwrap());
    let of = |scene: &Scene| scene.lights.iter().find(|found| found.name == light).unwrap().clone();
    let queries = Queries::new(&asked, &visible(&asked), &of(&asked));
    let [old_index, index] = [&built, &asked].map(SceneIndex::new);
    let old = BuildInput::new(&built, &old_index, of(&built).position());
    let new = BuildInput::new(&asked, &index, of(&asked).position());
    (answers(&mut Fresh, entry, &old, &queries).0, answers(&mut Fresh, entry, &new, &queries).0)
}

#[test]
fn a_tester_that_outlived_a_motion_would_be_noticed() {
    for entry in compared() {
        // The block moves between these frames, and the light between those.
        for (light, built, asked) in [("still", 4, 5), ("still", 5, 6), ("sun", 4, 6), ("moving", 1, 2)] {
            let (old, new) = stale(entry, light, built, asked);
            let differ = old.iter().zip(&new).filter(|(old, new)| old != new).count();
            assert!(differ > 0, "{} of {light}, of frame {built} in frame {asked}", entry.name);
        }
        let (old, new) = stale(entry, "still", 1, 4);
        assert_eq!(old, new, "{}: nothing that matters has moved", entry.name);
    }
}
