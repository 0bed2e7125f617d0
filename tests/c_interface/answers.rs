//! A million queries through the C interface, answer by answer against the library in Rust and against the program.

use crate::{Linking, compiled, done, root, scratch};
use glam::Vec3;
use lightbuffer::SurfacePoint;
use lightbuffer::c_interface::{FACES_AWAY, LIT, NO_SURFACE, NO_TRIANGLE, OCCLUDED};
use lightbuffer::film::read_exr;
use lightbuffer::geometry::LightPosition;
use lightbuffer::measure::{Question, answer};
use lightbuffer::scene::{ImageSize, Scene, formats};
use lightbuffer::shadow::{BuildInput, Queries, Receivers, SceneIndex, find};
use lightbuffer::visibility::{FirstHits, VisibleSurfaces, t_buffer};
use std::process::Command;

const SCENE: &str = "scenes/courtyard.glb";
const LIGHT: &str = "key";
const SIZE: ImageSize = ImageSize { width: 1280, height: 900 };
const POINTS: u32 = 200_000;

/// Points all over a scene, the same each time.
fn points_in_space(scene: &Scene) -> Vec<Vec3> {
    let (low, high) = scene.bounds().unwrap();
    // The low bits of multiples of odd numbers: as good as random, and spread evenly.
    let share = |i: u32, odd: u32| (i.wrapping_mul(odd) >> 8) as f32 / (1 << 24) as f32;
    let point = |i| Vec3::new(share(i, 0x9e37_79b1), share(i, 0x85eb_ca77), share(i, 0xc2b2_ae3d));
    (0..POINTS).map(|i| low + (high - low) * point(i)).collect()
}

/// What the C program reads, and its rays' first hits as the program finds them.
fn input(scene: &Scene, light: Vec3, points: &[Vec3]) -> (Vec<u8>, FirstHits) {
    let camera = &scene.cameras[0];
    let raster = camera.raster(SIZE);
    let rays = (0..SIZE.pixels() as u32).map(|pixel| {
        let direction = camera.direction(&raster, pixel % SIZE.width, pixel / SIZE.width);
        [camera.origin, direction]
    });
    let mut bytes = Vec::new();
    for count in [scene.vertices.len(), scene.triangles.len(), SIZE.pixels(), points.len()] {
        bytes.extend((count as u64).to_ne_bytes());
    }
    let floats = |v: Vec3| v.to_array().into_iter().flat_map(f32::to_ne_bytes);
    bytes.extend(floats(light));
    bytes.extend(scene.vertices.iter().copied().flat_map(floats));
    bytes.extend(scene.triangles.iter().flat_map(|t| t.vertices).flat_map(u32::to_ne_bytes));
    bytes.extend(rays.flatten().flat_map(floats));
    bytes.extend(points.iter().copied().flat_map(floats));
    (bytes, t_buffer::first_hits(scene, camera, SIZE))
}

/// The library's answers to points that face the light.
fn asked(
    tester: &str,
    scene: &Scene,
    light: LightPosition,
    receivers: Receivers,
    points: &[SurfacePoint],
) -> Vec<u8> {
    let index = SceneIndex::new(scene);
    let input = BuildInput { receivers, ..BuildInput::new(scene, &index, light) };
    let tester = (find(tester).unwrap().build)(&input).unwrap();
    let answers = answer(tester.as_ref(), points, Question::Occlusion, &|_| {}).unwrap();
    answers.occluded.into_iter().map(|occluded| if occluded { OCCLUDED } else { LIT }).collect()
}

/// The places where two lists differ.
fn differences<T: PartialEq>(found: &[T], expected: &[T]) -> Vec<usize> {
    assert_eq!(found.len(), expected.len());
    (0..found.len()).filter(|&i| found[i] != expected[i]).collect()
}

#[test]
fn a_million_queries_are_answered_as_the_library_and_the_program_do() {
    let scene = formats::load(&root().join(SCENE)).unwrap();
    let is_plain =
        scene.curved.is_empty() && scene.alpha_masks.is_empty() && !scene.has_transparent_casters();
    assert!(is_plain, "C has triangles alone");
    let light = scene.lights.iter().find(|light| light.name == LIGHT).unwrap();
    let LightPosition::At(position) = light.position() else { panic!("a light at a point") };
    assert!(light.lit_cone().is_none());
    let points = points_in_space(&scene);
    let (bytes, hits) = input(&scene, position, &points);
    let visible = VisibleSurfaces::new(&scene, &scene.cameras[0], &hits);
    let queries = Queries::new(&scene, &visible, light);
    assert!(queries.points.len() >= 1_000_000, "only {} queries", queries.points.len());

    let folder = scratch("million");
    let (given, image) = (folder.join("input"), folder.join("image.exr"));
    std::fs::write(&given, bytes).unwrap();
    let size = format!("{}x{}", SIZE.width, SIZE.height);
    let mut render = Command::new(env!("CARGO_BIN_EXE_lightbuffer"));
    render.args(["render", "-q", SCENE, "--size", &size, "--shadow", "light-buffer", "-o"]).arg(&image);
    done(render.current_dir(root()), "");
    let image = read_exr(&image).unwrap();
    let mask = image.channel(&format!("shadow.{LIGHT}.light-buffer")).unwrap();

    let mut expected = vec![NO_SURFACE; SIZE.pixels()];
    for &node in &queries.facing_away {
        expected[visible.pixels[node as usize] as usize] = FACES_AWAY;
    }
    let answers = asked("light-buffer", &scene, position.into(), Receivers::Surfaces, &queries.points);
    for (&node, &answer) in queries.nodes.iter().zip(&answers) {
        expected[visible.pixels[node as usize] as usize] = answer;
    }
    let expected_hits: Vec<u32> = hits.primitives.iter().map(|hit| hit.unwrap_or(NO_TRIANGLE)).collect();
    let bare: Vec<SurfacePoint> = points.iter().map(|&p| SurfacePoint::bare(p).unwrap()).collect();
    let expected_at = asked("light-buffer", &scene, position.into(), Receivers::Anywhere, &bare);
    // And some of them by the arbiter, so that not both are wrong.
    let some = |points: &[SurfacePoint]| points.iter().copied().step_by(997).collect::<Vec<_>>();
    let truth = asked("exact", &scene, position.into(), Receivers::Surfaces, &some(&queries.points));
    assert!(answers.iter().step_by(997).eq(&truth));
    let truth = asked("exact", &scene, position.into(), Receivers::Anywhere, &some(&bare));
    assert!(expected_at.iter().step_by(997).eq(&truth));
    for answers in [&answers, &expected_at] {
        assert!(answers.contains(&LIT) && answers.contains(&OCCLUDED));
    }

    for (linking, tester) in [(Linking::Static, "light-buffer"), (Linking::Shared, "auto")] {
        let program = compiled(&root().join("tests/c_interface/million.c"), linking, &["-std=c99"]);
        let answers = folder.join(format!("output-{tester}"));
        done(Command::new(program).arg(&given).arg(&answers).arg(tester), "");
        let answers = std::fs::read(answers).unwrap();
        let (found_hits, rest) = answers.split_at(4 * SIZE.pixels());
        let found_hits: Vec<u32> =
            found_hits.chunks(4).map(|b| u32::from_ne_bytes(b.try_into().unwrap())).collect();
        let (found, rest) = rest.split_at(SIZE.pixels());
        let (found_by_threads, found_at) = rest.split_at(SIZE.pixels());
        let none = Vec::<usize>::new();
        assert_eq!(differences(&found_hits, &expected_hits), none, "{tester}: first hits");
        assert_eq!(differences(found, &expected), none, "{tester}: the library");
        assert_eq!(differences(found_by_threads, &expected), none, "{tester}: the library, by threads");
        assert_eq!(differences(found_at, &expected_at), none, "{tester}: points in space");
        let found_mask: Vec<f32> = found.iter().map(|&a| if a == OCCLUDED { 1.0 } else { 0.0 }).collect();
        assert_eq!(differences(&found_mask, mask), none, "{tester}: the program");
    }
    println!("{} queries on surfaces and {POINTS} in space, none differs", queries.points.len());
}
