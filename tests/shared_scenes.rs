//! Scenes that are not part of this repository: a scanned mesh, a modelled one, a whole glTF scene, and the
//! Standard Procedural Databases.
//!
//! `make test-scenes SCENES=folder` runs these tests; the folder holds `meshes/stanford-bunny.obj`,
//! `meshes/teapot.obj`, `meshes/balloon/scene.gltf` and the seven of `spd/`. They compare answers query by query, never totals.

use lightbuffer::geometry::curved::Shape;
use lightbuffer::measure::{Question, answer, timed};
use lightbuffer::scene::{
    Camera, CurvedPrimitive, Dropped, Framing, ImageSize, Object, Scene, formats, frame,
};
use lightbuffer::shadow::Queries;
use lightbuffer::shadow::{BuildInput, Resolution, SceneIndex, find};
use lightbuffer::verdict::{LightVerdict, Progress, check_arbiter, judge};
use lightbuffer::visibility::{VisibleSurfaces, classical, t_buffer};
use std::path::PathBuf;

/// A scene of the folder, and how large a picture of it is judged.
struct Subject {
    name: &'static str,
    triangles: usize,
    size: ImageSize,
    /// Testers that are held against the arbiter in that picture.
    testers: &'static [&'static str],
    /// Queries that all triangles are tested for in integers.
    checked: usize,
}

const fn size(width: u32, height: u32) -> ImageSize {
    ImageSize { width, height }
}

const BUNNY: Subject = Subject {
    name: "meshes/stanford-bunny.obj",
    triangles: 69_451,
    size: size(1920, 1080),
    testers: &["light-buffer", "embree", "embree-fast"],
    checked: 10_000,
};

const TEAPOT: Subject = Subject {
    name: "meshes/teapot.obj",
    triangles: 6_320,
    size: size(640, 360),
    testers: &["brute-force", "light-buffer", "embree", "embree-fast"],
    checked: 10_000,
};

const BALLOON: Subject = Subject {
    name: "meshes/balloon/scene.gltf",
    triangles: 35_698,
    size: size(640, 360),
    testers: &["brute-force", "light-buffer", "embree", "embree-fast"],
    checked: 10_000,
};

const GEARS: Subject = Subject {
    name: "spd/gears.nff",
    triangles: 36_610,
    size: size(160, 160),
    testers: &["light-buffer", "embree", "embree-fast"],
    checked: 1_000,
};

const TETRA: Subject = Subject {
    name: "spd/tetra.nff",
    triangles: 4_096,
    size: size(512, 512),
    testers: &["brute-force", "light-buffer", "embree", "embree-fast"],
    checked: 2_000,
};

/// The path of a scene, or an instruction what to do.
fn path(name: &str) -> PathBuf {
    let help = "run: make test-scenes SCENES=folder";
    let folder = std::env::var_os("SCENES").unwrap_or_else(|| panic!("SCENES is not set; {help}"));
    let path = PathBuf::from(folder).join(name);
    assert!(path.is_file(), "there is no {}; {help}", path.display());
    path
}

/// A scene as `validate` sees it: framed, with what its camera sees.
struct View {
    scene: Scene,
    index: SceneIndex,
    camera: Camera,
}

impl View {
    fn of(subject: &Subject) -> View {
        let mut scene = formats::load(&path(subject.name)).unwrap();
        assert_eq!(scene.triangles.len(), subject.triangles, "{}", subject.name);
        frame(&mut scene, Framing::WithFloor).unwrap();
        View { index: SceneIndex::new(&scene), camera: scene.cameras[0].clone(), scene }
    }

    /// The queries of every light of the scene.
    fn queries(&self, size: ImageSize) -> Vec<Queries> {
        let hits = t_buffer::first_hits(&self.scene, &self.camera, size);
        let visible = VisibleSurfaces::new(&self.scene, &self.camera, &hits);
        let lights = self.scene.lights.iter();
        lights.map(|light| Queries::new(&self.scene, &visible, light)).collect()
    }

    fn input(&self, light: usize, resolution: Resolution) -> BuildInput<'_> {
        let light = self.scene.lights[light].position();
        BuildInput { resolution, ..BuildInput::new(&self.scene, &self.index, light) }
    }
}

struct Silent;

impl Progress for Silent {
    fn stage(&self, _: &str) {}
    fn advance(&self, _: u64) {}
}

/// Judges all queries of a scene, checks the arbiter, and prints the figures.
fn judge_every_query(subject: &Subject) {
    let view = View::of(subject);
    let asked = |name: &&str| cfg!(feature = "embree") || !name.starts_with("embree");
    let entries: Vec<_> = subject.testers.iter().filter(|n| asked(n)).map(|n| find(n).unwrap()).collect();
    let mut left = subject.checked;
    for (light, queries) in view.queries(subject.size).iter().enumerate() {
        let input = view.input(light, Resolution::Auto);
        let judged = timed(|| judge(&input, queries, &entries, &Silent).unwrap());
        let verdict = &judged.value;
        // Lights share the sample: all of it from the first, if that has enough queries.
        let checked =
            timed(|| check_arbiter(&view.scene, input.light, queries, &verdict.truth, left, &|_| ()));
        left -= checked.value.queries as usize;
        println!(
            "{} at {}x{}: {} queries judged in {:.1} s; arbiter {} wrong of {} in {:.1} s",
            subject.name,
            subject.size.width,
            subject.size.height,
            queries.points.len(),
            judged.seconds,
            checked.value.wrong,
            checked.value.queries,
            checked.seconds
        );
        print_testers(verdict);
        assert_eq!(checked.value.wrong, 0, "the arbiter is wrong");
        for tester in verdict.testers.iter().filter(|t| !t.run.name.starts_with("embree")) {
            assert_eq!(tester.run.occluded.len(), queries.points.len());
            let wrong =
                tester.run.occluded.iter().zip(&verdict.truth).position(|(answer, truth)| answer != truth);
            assert_eq!(wrong, None, "{}: query {wrong:?} and perhaps others", tester.run.name);
        }
        let counts = verdict.counts;
        assert_eq!((counts.native_wrong, counts.both_wrong), (0, 0));
        assert_eq!(counts.agree + counts.embree_wrong, queries.points.len() as u64);
        assert!(verdict.truth.contains(&true) && verdict.truth.contains(&false), "a picture without shadows");
    }
    assert_eq!(left, 0, "fewer than {} queries", subject.checked);
}

fn print_testers(verdict: &LightVerdict) {
    for tester in &verdict.testers {
        println!(
            "    {:<12} build {:>8.1} ms, {:>8.1} ns/query, {} wrong, {} undecided",
            tester.run.name,
            tester.run.build_seconds * 1e3,
            tester.run.ns_per_query,
            tester.counts.wrong,
            tester.counts.undecided
        );
    }
}

/// The masks of the light buffer for every resolution and number of threads, all equal to the first.
fn compare_masks(subject: &Subject) {
    let view = View::of(subject);
    let light_buffer = find("light-buffer").unwrap();
    let masks = |resolution: Resolution, threads: usize| -> Vec<Vec<bool>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let queries = view.queries(size(160, 90));
            let mask = |(light, queries): (usize, &Queries)| {
                let tester = (light_buffer.build)(&view.input(light, resolution)).unwrap();
                answer(tester.as_ref(), &queries.points, Question::Occlusion, &|_| ()).unwrap().occluded
            };
            queries.iter().enumerate().map(mask).collect()
        })
    };
    let reference = masks(Resolution::Auto, 2);
    assert!(reference.iter().all(|mask| mask.contains(&true) && mask.contains(&false)));
    for resolution in [1, 7, 64, 1000] {
        for threads in [1, 2] {
            let run = timed(|| masks(Resolution::Cells(resolution), threads));
            assert!(run.value == reference, "{}: R = {resolution} on {threads} threads", subject.name);
            println!(
                "{}: R = {resolution} on {threads} threads: same masks, {:.1} s",
                subject.name, run.seconds
            );
        }
    }
}

fn compare_first_hits(subject: &Subject) {
    let view = View::of(subject);
    let filled = t_buffer::first_hits(&view.scene, &view.camera, size(64, 36));
    let traced = timed(|| classical::first_hits(&view.scene, &view.camera, size(64, 36)));
    assert!(filled.primitives.iter().any(Option::is_some));
    assert_eq!(filled.primitives, traced.value.primitives);
    println!(
        "{} at 64x36: t-buffer as classical, {} tests against {}, {:.1} s",
        subject.name, filled.tests, traced.value.tests, traced.seconds
    );
}

#[test]
fn every_answer_on_the_bunny_is_true() {
    judge_every_query(&BUNNY);
}

#[test]
fn every_answer_on_the_teapot_is_true() {
    judge_every_query(&TEAPOT);
}

#[test]
fn every_answer_on_the_balloon_is_true() {
    judge_every_query(&BALLOON);
}

#[test]
fn every_answer_on_the_gears_is_true() {
    judge_every_query(&GEARS);
}

#[test]
fn every_answer_on_the_tetrahedra_is_true() {
    judge_every_query(&TETRA);
}

/// Primitives of a scene as published, lights, and what they become: a polygon of n corners n - 2 triangles.
fn compare_with_what_was_published(subject: &Subject, polygons: usize, lights: usize) {
    let text = std::fs::read_to_string(path(subject.name)).unwrap();
    let corners = |line: &str| line.strip_prefix("p ").map(|count| count.trim().parse::<usize>().unwrap());
    let corners: Vec<usize> = text.lines().filter_map(corners).collect();
    assert_eq!(corners.len(), polygons);
    let scene = formats::load(&path(subject.name)).unwrap();
    assert_eq!(scene.triangles.len(), corners.iter().map(|count| count - 2).sum::<usize>());
    assert_eq!(scene.triangles.len(), subject.triangles);
    assert_eq!((scene.dropped.degenerate, scene.dropped.non_finite), (0, 0));
    assert_eq!((scene.lights.len(), scene.cameras[0].size), (lights, Some(size(512, 512))));
    let crossed = scene.warnings.iter().any(|warning| warning.contains("cross themselves"));
    assert!(!crossed, "{:?}", scene.warnings);
}

#[test]
fn the_gears_and_the_tetrahedra_are_whole() {
    compare_with_what_was_published(&GEARS, 9345, 5);
    compare_with_what_was_published(&TETRA, 4096, 1);
}

#[test]
fn every_procedural_database_is_whole() {
    // Polygons, spheres, cylinders and cones as published; lights; and what is transparent.
    for (name, polygons, spheres, cones, lights, transparent) in [
        ("balls", 1, 7381, 0, 3, false),
        ("gears", 9345, 0, 0, 5, true),
        ("mount", 8192, 4, 0, 1, true),
        ("rings", 1, 4200, 4200, 3, false),
        ("teapot", 9264, 0, 0, 2, false),
        ("tetra", 4096, 0, 0, 1, false),
        ("tree", 1, 4095, 4095, 7, false),
    ] {
        let scene = formats::load(&path(&format!("spd/{name}.nff"))).unwrap();
        let is_sphere = |primitive: &&CurvedPrimitive| matches!(primitive.shape, Shape::Sphere(_));
        let found = scene.curved.iter().filter(is_sphere).count();
        let found_polygons: u32 = scene.objects.iter().map(|object| object.polygons).sum();
        assert_eq!((found_polygons, found, scene.curved.len() - found), (polygons, spheres, cones), "{name}");
        assert_eq!((scene.lights.len(), scene.cameras[0].size), (lights, Some(size(512, 512))), "{name}");
        assert_eq!(scene.has_transparent_casters(), transparent, "{name}");
        assert_eq!(scene.background, [0.078, 0.361, 0.753], "{name}");
        println!("{name}: {:?}, {:?}", scene.dropped, scene.warnings);
        assert_eq!(scene.dropped, Dropped::default(), "{name}");
        comes_back(&scene);
    }
}

/// Writes a scene in both formats that are written and compares what is read back.
fn comes_back(scene: &Scene) {
    let folder = tempfile::tempdir().unwrap();
    for format in ["toml", "nff"] {
        let path = folder.path().join(format!("again.{format}"));
        formats::save(scene, &path).unwrap();
        let again = formats::load(&path).unwrap();
        assert_eq!((scene.hash(), scene.objects.len()), (again.hash(), again.objects.len()), "{format}");
        assert_eq!((scene.curved == again.curved, scene.background), (true, again.background));
        let counts = |scene: &Scene| -> Vec<_> {
            let polygons = |polygons: u32, count: u32| if format == "nff" { count } else { polygons };
            let counts = |o: &Object| (o.count, polygons(o.polygons, o.count), o.curved_count);
            scene.objects.iter().map(counts).collect()
        };
        assert!(counts(scene) == counts(&again), "{} as {format}", scene.name);
        if format == "toml" {
            assert_eq!((&scene.cameras, &scene.materials), (&again.cameras, &again.materials));
        }
        assert_eq!(scene.lights, again.lights);
    }
}

#[test]
fn masks_do_not_depend_on_resolution_or_threads() {
    [BUNNY, TEAPOT, BALLOON].iter().for_each(compare_masks);
}

#[test]
fn the_t_buffer_sees_what_classical_ray_tracing_sees() {
    [BUNNY, TEAPOT, BALLOON, GEARS, TETRA].iter().for_each(compare_first_hits);
}
