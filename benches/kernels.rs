//! The kernels, one by one and on every instruction set that this machine has: `cargo bench`.
//!
//! For comparing a change with what was there before. Who is faster than whom, and by how much, is what
//! `lightbuffer bench` measures, in interleaved runs.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use lightbuffer::geometry::batch::{InstructionSet, LANES, PointBatch};
use lightbuffer::geometry::ray_triangle::RayTriangle;
use lightbuffer::geometry::{LightPoint, LightPosition, LightSpace, LightTriangle};
use lightbuffer::memory::MemoryLimit;
use lightbuffer::scene::{Framing, ImageSize, Scene, formats, frame};
use lightbuffer::shadow::certified::{BuildQuality, Certified};
use lightbuffer::shadow::exact::Arbiter;
use lightbuffer::shadow::{BuildInput, Queries, SceneIndex};
use lightbuffer::visibility::{Points, RoundedPoint, SurfacePoint, VisibleSurfaces, t_buffer};
use std::hint::black_box;
use std::path::Path;

const SIZE: ImageSize = ImageSize { width: 480, height: 270 };

fn sets() -> impl Iterator<Item = InstructionSet> {
    InstructionSet::ALL.into_iter().filter(|set| set.is_available())
}

/// A scene, a light of it, and what the camera sees that faces that light.
struct View {
    scene: Scene,
    light: Vec3,
    points: Vec<SurfacePoint>,
    rounded: Vec<RoundedPoint>,
}

impl View {
    fn of(name: &str) -> View {
        let mut scene = formats::load(Path::new(name)).expect("a scene that is there");
        frame(&mut scene, Framing::WithFloor).expect("a mesh that can be framed");
        let hits = t_buffer::first_hits(&scene, &scene.cameras[0], SIZE);
        let visible = VisibleSurfaces::new(&scene, &scene.cameras[0], &hits);
        let points = Queries::new(&scene, &visible, &scene.lights[0]).points;
        let LightPosition::At(light) = scene.lights[0].position() else { panic!("a light at a point") };
        View { scene, light, rounded: RoundedPoint::all(&points), points }
    }

    fn points(&self) -> Points<'_> {
        Points::new(&self.rounded, &self.points)
    }

    fn certified(&self, set: InstructionSet) -> Certified<'_> {
        Certified { scene: &self.scene, light: self.light, set, memory: MemoryLimit::NONE }
    }
}

/// One thread: kernels and not their distribution.
fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread").install(work)
}

/// Sixteen points against triangle after triangle.
fn filter(criterion: &mut Criterion) {
    let view = View::of("scenes/courtyard.glb");
    let space = LightSpace::new(LightPosition::At(view.light), view.scene.bounds().expect("it has an end"));
    let triangles: Vec<LightTriangle> = (0..view.scene.triangles.len() as u32)
        .filter_map(|primitive| LightTriangle::new(&space, view.scene.corners(primitive)))
        .collect();
    let points: Vec<LightPoint> = view
        .points
        .iter()
        .step_by(97)
        .take(LANES)
        .map(|point| LightPoint::new(&space, point.position))
        .collect();
    let batch = PointBatch::new(&points);
    let mut group = criterion.benchmark_group("sixteen points against all triangles");
    group.throughput(Throughput::Elements((triangles.len() * LANES) as u64));
    for set in sets() {
        group.bench_function(BenchmarkId::from_parameter(set.name()), |bencher| {
            bencher.iter(|| {
                let (mut start, mut stops) = (0, 0);
                while let Some(stop) = batch.scan(set, black_box(&triangles), start, u16::MAX) {
                    start = stop.index + 1;
                    stops += 1;
                }
                stops
            });
        });
    }
}

/// How cells that are kept are built, in words.
const QUALITIES: [(&str, BuildQuality); 2] =
    [("", BuildQuality::Medium), (" of high quality", BuildQuality::High)];

/// Queries by cells that are there, and the cells.
fn cells(criterion: &mut Criterion) {
    let view = View::of("builtin:sphereflake");
    let mut group = criterion.benchmark_group("certified cells");
    group.sample_size(10).throughput(Throughput::Elements(view.points.len() as u64));
    let mut answers = vec![false; view.points.len()];
    for set in sets() {
        for (what, quality) in QUALITIES {
            let kept = alone(|| view.certified(set).keep(512, quality)).expect("room");
            let name = format!("queries by kept cells{what}");
            group.bench_function(BenchmarkId::new(name, set.name()), |bencher| {
                alone(|| bencher.iter(|| kept.occluded(black_box(view.points()), &mut answers)));
            });
        }
        group.bench_function(BenchmarkId::new("a view at once", set.name()), |bencher| {
            alone(|| {
                bencher.iter(|| view.certified(set).occluded(view.points(), 512, &mut answers).expect("room"))
            });
        });
        for (what, quality) in QUALITIES {
            group.bench_function(BenchmarkId::new(format!("keeping{what}"), set.name()), |bencher| {
                alone(|| bencher.iter(|| view.certified(set).keep(512, quality).expect("room").bytes()));
            });
        }
    }
}

/// What a camera sees.
fn first_hits(criterion: &mut Criterion) {
    let view = View::of("builtin:sphereflake");
    let mut group = criterion.benchmark_group("t-buffer");
    group.sample_size(10).throughput(Throughput::Elements(SIZE.pixels() as u64));
    for set in sets() {
        group.bench_function(BenchmarkId::from_parameter(set.name()), |bencher| {
            alone(|| {
                bencher
                    .iter(|| t_buffer::first_hits_on(set, &view.scene, &view.scene.cameras[0], SIZE).tests);
            });
        });
    }
}

/// One test, as far as it has to go.
fn predicates(criterion: &mut Criterion) {
    let corners = [Vec3::new(-1.0, -1.0, -2.0), Vec3::new(1.0, -1.0, -2.0), Vec3::new(0.0, 1.0, -3.0)];
    let triangle = RayTriangle::new(Vec3::ZERO, corners).expect("not edge-on");
    let mut group = criterion.benchmark_group("predicates");
    let inside = Vec3::new(0.1, 0.05, -1.0);
    group.bench_function("ray and triangle, decided by f64", |b| b.iter(|| triangle.hit(black_box(inside))));
    // Through a corner: two of the signs are zero.
    group.bench_function("ray and triangle, decided exactly", |b| {
        b.iter(|| triangle.hit(black_box(corners[0])))
    });
    let view = View::of("scenes/courtyard.glb");
    let index = SceneIndex::new(&view.scene);
    let arbiter = Arbiter::new(&BuildInput::new(&view.scene, &index, LightPosition::At(view.light)));
    let point = view.points[view.points.len() / 2];
    group
        .bench_function("the arbiter, one query", |b| b.iter(|| arbiter.decide(black_box(&point)).occlusion));
}

criterion_group!(kernels, filter, cells, first_hits, predicates);
criterion_main!(kernels);
