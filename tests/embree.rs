//! Embree's answers, ray by ray, on scenes where the right one is known without it.
#![cfg(feature = "embree")]

use lightbuffer::Error;
use lightbuffer::embree::{
    BuildQuality, CheckedRays, Denormals, Device, EmbreeMode, EmbreeScene, Grouping, QueryOptions, Receiver,
    Robustness, SceneOptions, ShadowRay,
};

use std::sync::LazyLock;

#[path = "embree/curved.rs"]
mod curved;
#[path = "embree/meshes.rs"]
mod meshes;
#[path = "embree/shapes.rs"]
mod shapes;
#[path = "embree/transparent.rs"]
mod transparent;
use meshes::{bumpy_ball, segment, soup};

/// The usual way to ask.
const QUERY: QueryOptions = EmbreeMode::ORACLE.query;

/// Every way to build a scene.
fn all_options() -> Vec<SceneOptions> {
    let all: Vec<_> = EmbreeMode::all().filter(|mode| mode.query == QUERY).map(|mode| mode.scene).collect();
    assert_eq!(all.len(), 2 * 3 * 2);
    all
}

/// Every way to ask a scene that this Embree has.
static QUERIES: LazyLock<Vec<QueryOptions>> = LazyLock::new(|| {
    let device = Device::new(1).unwrap();
    let usual = |mode: &EmbreeMode| mode.scene == EmbreeMode::ORACLE.scene && mode.expect_in(&device).is_ok();
    let all: Vec<_> = EmbreeMode::all().filter(usual).map(|mode| mode.query).collect();
    assert_eq!(all.len(), (4 + usize::from(device.has_streams())) * 2 * 2);
    all
});

fn options(receiver: Receiver) -> SceneOptions {
    SceneOptions { robustness: Robustness::Robust, quality: BuildQuality::Medium, receiver }
}

fn ask(scene: &EmbreeScene, rays: &[ShadowRay], query: QueryOptions) -> Vec<bool> {
    // Right answers are written over what is already there: start from every other one.
    let mut answers: Vec<bool> = (0..rays.len()).map(|i| i % 2 == 0).collect();
    scene.occluded(rays, query, &mut answers).unwrap();
    answers
}

/// Every ray must get its expected answer in every way to ask.
fn assert_answers(scene: &EmbreeScene, rays: &[ShadowRay], expected: &[bool], what: &str) {
    assert_eq!(rays.len(), expected.len());
    for query in QUERIES.iter().copied() {
        for (i, answer) in ask(scene, rays, query).into_iter().enumerate() {
            let ray = rays[i];
            assert_eq!(answer, expected[i], "{what}, {query:?}: ray {i} of {}: {ray:?}", rays.len());
        }
    }
}

/// Right angle at the origin, legs of length 2 along x and y.
const CORNER: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];

#[test]
fn one_triangle_blocks_what_crosses_it_in_either_winding() {
    let device = Device::new(1).unwrap();
    let cases = [
        (segment([0.5, 0.5, 1.0], [0.5, 0.5, -1.0]), true),
        (segment([0.5, 0.5, -1.0], [0.5, 0.5, 1.0]), true),
        (segment([3.0, 3.0, 3.0], [-2.0, -2.0, -3.0]), true),
        // Beside each of the three edges.
        (segment([-0.25, 0.5, 1.0], [-0.25, 0.5, -1.0]), false),
        (segment([0.5, -0.25, 1.0], [0.5, -0.25, -1.0]), false),
        (segment([1.25, 1.25, 1.0], [1.25, 1.25, -1.0]), false),
        // Ends before the plane, begins behind it, runs beside it.
        (segment([0.5, 0.5, 1.0], [0.5, 0.5, 0.125]), false),
        (segment([0.5, 0.5, -0.125], [0.5, 0.5, -1.0]), false),
        (segment([-1.0, 0.5, 0.125], [3.0, 0.5, 0.125]), false),
    ];
    let (rays, expected): (Vec<_>, Vec<_>) = cases.into_iter().unzip();
    for options in all_options() {
        for winding in [[0, 1, 2], [0, 2, 1]] {
            let scene = EmbreeScene::new(&device, &CORNER, &[winding], options).unwrap();
            assert_answers(&scene, &rays, &expected, &format!("{options:?}, {winding:?}"));
        }
    }
}

#[test]
fn both_ends_of_the_segment_count() {
    let device = Device::new(1).unwrap();
    // Meets the triangle at exactly t = 0.5.
    let ray = |t_near, t_far| ShadowRay { t_near, t_far, ..segment([0.5, 0.5, 1.0], [0.5, 0.5, -1.0]) };
    let cases = [
        (ray(0.0, f32::INFINITY), true),
        (ray(0.0, 0.49), false),
        (ray(0.0, 0.51), true),
        // The far end belongs to it.
        (ray(0.0, 0.5), true),
        (ray(0.49, 1.0), true),
        (ray(0.51, 1.0), false),
        (ray(0.51, f32::INFINITY), false),
        // Nothing lies between the ends if they are in the wrong order.
        (ray(0.75, 0.25), false),
        (ray(0.0, 0.0), false),
    ];
    let (rays, expected): (Vec<_>, Vec<_>) = cases.into_iter().unzip();
    for options in all_options() {
        let scene = EmbreeScene::new(&device, &CORNER, &[[0, 1, 2]], options).unwrap();
        assert_answers(&scene, &rays, &expected, &format!("{options:?}"));
    }
}

#[test]
fn only_a_scene_that_excludes_receivers_reads_the_excluded_triangle() {
    let device = Device::new(1).unwrap();
    // Three triangles above each other, at z = 0, -1 and -2.
    let vertices: Vec<[f32; 3]> =
        (0..3).flat_map(|layer| CORNER.map(|[x, y, _]| [x, y, -(layer as f32)])).collect();
    let triangles = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
    let down = |bottom, excluded| ShadowRay { excluded, ..segment([0.5, 0.5, 1.0], [0.5, 0.5, bottom]) };
    // Ray, answer if it is read.
    let cases = [
        (down(-0.5, 0), false),
        (down(-0.5, 1), true),
        (down(-0.5, ShadowRay::NO_PRIMITIVE), true),
        (down(-1.5, 0), true),
        (down(-1.5, 1), true),
        (down(-2.5, 2), true),
    ];
    let (rays, expected): (Vec<_>, Vec<_>) = cases.into_iter().unzip();
    for options in all_options() {
        let scene = EmbreeScene::new(&device, &vertices, &triangles, options).unwrap();
        let what = format!("{options:?}");
        match options.receiver {
            Receiver::Excluded => assert_answers(&scene, &rays, &expected, &what),
            Receiver::Included => assert_answers(&scene, &rays, &vec![true; rays.len()], &what),
        }
    }
}

/// What oracle runs need: with no epsilon, a robust scene has the receiver itself block.
#[test]
fn a_ray_that_starts_on_its_excluded_receiver_leaves_it() {
    let device = Device::new(1).unwrap();
    let away = ShadowRay { excluded: 0, ..segment([0.5, 0.5, 0.0], [0.5, 0.75, 1.0]) };
    for options in all_options() {
        let scene = EmbreeScene::new(&device, &CORNER, &[[0, 1, 2]], options).unwrap();
        let blocked = options.receiver == Receiver::Included && options.robustness == Robustness::Robust;
        assert_answers(&scene, &[away; 18], &[blocked; 18], &format!("{options:?}"));
    }
}

/// Ray i crosses triangle i alone, so that the exclusion of another lane would be seen.
#[test]
fn each_lane_of_a_packet_has_its_own_excluded_triangle() {
    let device = Device::new(1).unwrap();
    let count: u32 = 40;
    let shift = |i: u32, [x, y, z]: [f32; 3]| [x + 4.0 * i as f32, y, z];
    let vertices: Vec<[f32; 3]> = (0..count).flat_map(|i| CORNER.map(|corner| shift(i, corner))).collect();
    let triangles: Vec<[u32; 3]> = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    for stride in [2, 3, 5] {
        let excludes_its_own = |i: u32| i.is_multiple_of(stride);
        let rays: Vec<ShadowRay> = (0..count)
            .map(|i| ShadowRay {
                excluded: if excludes_its_own(i) { i } else { (i + 1) % count },
                ..segment(shift(i, [0.5, 0.5, 1.0]), shift(i, [0.5, 0.5, -1.0]))
            })
            .collect();
        let expected: Vec<bool> = (0..count).map(|i| !excludes_its_own(i)).collect();
        for options in all_options().into_iter().filter(|options| options.receiver == Receiver::Excluded) {
            let scene = EmbreeScene::new(&device, &vertices, &triangles, options).unwrap();
            assert_answers(&scene, &rays, &expected, &format!("{options:?}, stride {stride}"));
        }
    }
}

#[test]
fn every_mode_answers_as_arithmetic_does_with_any_tail() {
    let device = Device::new(2).unwrap();
    let soup = soup(60, 700);
    let differing = soup.blocked.iter().zip(&soup.blocked_without_excluded).filter(|(a, b)| a != b).count();
    let blocked = soup.blocked.iter().filter(|&&blocked| blocked).count();
    assert!((100..600).contains(&blocked) && differing > 20, "{blocked} blocked, {differing} differing");
    for options in all_options() {
        let scene = EmbreeScene::new(&device, &soup.vertices, &soup.triangles, options).unwrap();
        let expected = match options.receiver {
            Receiver::Included => &soup.blocked,
            Receiver::Excluded => &soup.blocked_without_excluded,
        };
        // Streams are cut at 256.
        for count in [0, 1, 3, 4, 5, 7, 8, 9, 15, 16, 17, 33, 255, 256, 257, 700] {
            for first in [0, 1, 7, 100].into_iter().filter(|first| first + count <= 700) {
                let part = first..first + count;
                assert_answers(&scene, &soup.rays[part.clone()], &expected[part], &format!("{options:?}"));
            }
        }
    }
}

/// A closed surface seen from inside blocks every ray through its edges, if the scene is robust. That a fast scene
/// leaks shows that these rays would find a hole. (Rays through a vertex are no part of Embree's promise: of those,
/// one in a hundred slips through the robust scene as well.)
#[test]
fn robust_scenes_have_no_holes_along_edges() {
    let device = Device::new(2).unwrap();
    let (vertices, triangles) = bumpy_ball(24);
    let aim = |from: [f32; 3]| {
        let vertices = &vertices;
        triangles.iter().flat_map(move |triangle| {
            let corners = triangle.map(|i| vertices[i as usize]);
            (0..3).flat_map(move |k| {
                [0.25, 0.5, 0.7].map(|t| {
                    let (a, b) = (corners[k], corners[(k + 1) % 3]);
                    let to = [0, 1, 2].map(|axis| a[axis] + t * (b[axis] - a[axis]));
                    ShadowRay { t_far: f32::INFINITY, ..segment(from, to) }
                })
            })
        })
    };
    let rays: Vec<ShadowRay> = aim([0.0; 3]).chain(aim([0.1, 0.23, -0.37])).collect();
    for options in all_options() {
        let scene = EmbreeScene::new(&device, &vertices, &triangles, options).unwrap();
        match options.robustness {
            Robustness::Robust => {
                assert_answers(&scene, &rays, &vec![true; rays.len()], &format!("{options:?}"));
            }
            Robustness::Fast => {
                let answers = ask(&scene, &rays, QUERY);
                assert!(answers.contains(&false), "{options:?}");
            }
        }
    }
}

#[test]
fn many_threads_ask_one_scene_at_once() {
    let device = Device::new(2).unwrap();
    let soup = soup(60, 320);
    let scene =
        EmbreeScene::new(&device, &soup.vertices, &soup.triangles, options(Receiver::Excluded)).unwrap();
    // The scene keeps the device.
    drop(device);
    std::thread::scope(|threads| {
        for part in 0..8 {
            let (scene, soup) = (&scene, &soup);
            threads.spawn(move || {
                let part = part * 40..(part + 1) * 40;
                for _ in 0..50 {
                    let expected = &soup.blocked_without_excluded[part.clone()];
                    assert_answers(scene, &soup.rays[part.clone()], expected, "a thread");
                }
            });
        }
    });
}

#[test]
fn scenes_are_built_on_one_device_by_several_threads() {
    let device = Device::new(2).unwrap();
    let soup = soup(60, 40);
    let sizes: Vec<usize> = std::thread::scope(|threads| {
        let builders: Vec<_> = (0..4)
            .map(|_| {
                threads.spawn(|| {
                    let options = options(Receiver::Included);
                    let scene = EmbreeScene::new(&device, &soup.vertices, &soup.triangles, options).unwrap();
                    assert_answers(&scene, &soup.rays, &soup.blocked, "built by a thread");
                    scene.bytes()
                })
            })
            .collect();
        builders.into_iter().map(|builder| builder.join().unwrap()).collect()
    });
    let buffers = size_of_val(&soup.vertices[..]) + size_of_val(&soup.triangles[..]);
    assert!(sizes.iter().all(|&bytes| bytes > buffers), "{sizes:?} of {buffers}");
}

#[test]
fn a_scene_without_triangles_blocks_nothing() {
    let device = Device::new(1).unwrap();
    let rays = [segment([0.5, 0.5, 1.0], [0.5, 0.5, -1.0]); 17];
    for options in all_options() {
        let scene = EmbreeScene::new(&device, &[], &[], options).unwrap();
        assert_answers(&scene, &rays, &[false; 17], "empty");
    }
}

#[test]
fn nothing_blocks_an_empty_segment() {
    let device = Device::new(1).unwrap();
    // Around its origin and across its line, all the way past both of its ends.
    let vertices = [[-1.0, -1.0, -1.0], [2.0, -1.0, 0.0], [-1.0, 2.0, 2.0]];
    let crossing = segment([0.0; 3], [0.0, 0.0, 2.0]);
    for options in all_options() {
        let scene = EmbreeScene::new(&device, &vertices, &[[0, 1, 2]], options).unwrap();
        let rays: Vec<_> = (0..37).map(|i| [crossing, ShadowRay::EMPTY][i % 2]).collect();
        let expected: Vec<_> = (0..37).map(|i| i % 2 == 0).collect();
        assert_answers(&scene, &rays, &expected, &format!("{options:?}"));
    }
}

#[test]
fn memory_grows_with_the_scene() {
    let device = Device::new(2).unwrap();
    let bytes = |count| {
        let soup = soup(count, 0);
        let scene =
            EmbreeScene::new(&device, &soup.vertices, &soup.triangles, options(Receiver::Included)).unwrap();
        let buffers = size_of_val(&soup.vertices[..]) + size_of_val(&soup.triangles[..]);
        // Embree's leaves alone take more than an index a triangle.
        assert!(scene.bytes() > buffers + 4 * count as usize, "{} for {count} triangles", scene.bytes());
        scene.bytes()
    };
    let (small, large) = (bytes(10_000), bytes(100_000));
    assert!(large > 5 * small && large < 20 * small, "{small} and {large}");
}

/// Each quality has a tree of its own kind, and so of its own size.
#[test]
fn build_quality_reaches_embree() {
    let device = Device::new(1).unwrap();
    let (vertices, triangles) = bumpy_ball(100);
    let [low, medium, high] = [BuildQuality::Low, BuildQuality::Medium, BuildQuality::High].map(|quality| {
        let options = SceneOptions { robustness: Robustness::Fast, quality, receiver: Receiver::Included };
        EmbreeScene::new(&device, &vertices, &triangles, options).unwrap().bytes()
    });
    assert!(low > medium && medium != high && high != low, "{low}, {medium}, {high}");
}

#[test]
fn what_embree_would_misread_is_refused() {
    fn refused<T>(result: lightbuffer::Result<T>, with: &str) {
        match result {
            Err(error @ Error::Embree(_)) => {
                let text = error.to_string();
                assert!(
                    text.starts_with("Embree: ") && text.contains(with) && !text.contains('\n'),
                    "{text}"
                );
            }
            Err(other) => panic!("{other}"),
            Ok(_) => panic!("not refused, though {with}"),
        }
    }
    let device = Device::new(1).unwrap();
    let build = |vertices: &[[f32; 3]], triangles: &[[u32; 3]]| {
        EmbreeScene::new(&device, vertices, triangles, options(Receiver::Excluded))
    };
    refused(build(&CORNER, &[[0, 1, 2], [0, 1, 3]]), "triangle 1 is [0, 1, 3], but there are 3 vertices");
    refused(build(&[], &[[0, 0, 0]]), "triangle 0");
    for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY, 1.844e18, -3e38] {
        refused(build(&[[0.0; 3], [0.0, bad, 0.0], [0.0; 3]], &[[0, 1, 2]]), "vertex 1");
    }

    let scene = build(&CORNER, &[[0, 1, 2]]).unwrap();
    let good = segment([0.5, 0.5, 1.0], [0.5, 0.5, -1.0]);
    for bad in [
        ShadowRay { origin: [f32::NAN, 0.0, 0.0], ..good },
        ShadowRay { origin: [0.0, 0.0, f32::INFINITY], ..good },
        ShadowRay { direction: [0.0, f32::NEG_INFINITY, 1.0], ..good },
        ShadowRay { direction: [0.0, -0.0, 0.0], ..good },
        ShadowRay { t_near: f32::NAN, ..good },
        ShadowRay { t_near: -1.0, ..good },
        ShadowRay { t_near: f32::INFINITY, ..good },
        ShadowRay { t_far: f32::NAN, ..good },
        ShadowRay { t_far: -1.0, ..good },
        ShadowRay { excluded: 1, ..good },
    ] {
        for query in QUERIES.iter().copied() {
            let mut answers = [false; 20];
            let mut rays = [good; 20];
            rays[18] = bad;
            refused(scene.occluded(&rays, query, &mut answers), "ray 18");
            // Which triangles there are is for the scene to say; everything else is seen before.
            if bad.excluded == ShadowRay::NO_PRIMITIVE {
                refused(CheckedRays::new(&rays), "ray 18");
            }
        }
    }
    refused(scene.occluded(&[good], QUERY, &mut []), "1 rays have 0 answers");
    refused(Device::new(1_000_000), "1000000 threads");
    // None of it has broken the scene.
    assert_answers(&scene, &[good], &[true], "after errors");
}

/// Where there are no streams, asking for them is an error, and nothing else is done instead.
#[test]
fn streams_are_there_or_refused() {
    let device = Device::new(1).unwrap();
    let scene = EmbreeScene::new(&device, &CORNER, &[[0, 1, 2]], options(Receiver::Included)).unwrap();
    let rays = [segment([0.5, 0.5, 1.0], [0.5, 0.5, -1.0]); 5];
    let mode =
        EmbreeMode { query: QueryOptions { grouping: Grouping::Stream, ..QUERY }, ..EmbreeMode::RIVAL };
    let mut answers = [false; 5];
    let asked = scene.occluded(&rays, mode.query, &mut answers);
    if device.has_streams() {
        asked.unwrap();
        mode.expect_in(&device).unwrap();
        assert_eq!(answers, [true; 5]);
        assert!(device.version().starts_with("3."), "{}", device.version());
    } else {
        for error in [asked.unwrap_err(), mode.expect_in(&device).unwrap_err()] {
            assert!(error.to_string().contains("no ray streams"), "{error}");
        }
        assert_eq!(answers, [false; 5], "answers of a mode that is not there");
    }
    let packets = EmbreeMode::all().filter(|mode| mode.query.grouping != Grouping::Stream);
    packets.for_each(|mode| mode.expect_in(&device).unwrap());
}

/// The way from 1e-39 above a triangle to it is a denormal: with denormals flushed, the ray begins in its plane, and
/// a fast scene does not count what it meets at exactly `t_near`.
#[test]
fn flushing_denormals_reaches_embree_in_every_grouping() {
    let device = Device::new(1).unwrap();
    assert_eq!(device.flushes_denormals(), cfg!(target_arch = "x86_64"));
    let above = segment([0.5, 0.5, 1e-39], [0.5, 0.5, -1.0]);
    assert!(above.origin[2].is_subnormal());
    for quality in [BuildQuality::Low, BuildQuality::Medium, BuildQuality::High] {
        let options = SceneOptions { quality, ..EmbreeMode::RIVAL.scene };
        let scene = EmbreeScene::new(&device, &CORNER, &[[0, 1, 2]], options).unwrap();
        for query in QUERIES.iter().copied() {
            let expected = query.denormals == Denormals::Kept || !device.flushes_denormals();
            assert_eq!(ask(&scene, &[above; 21], query), [expected; 21], "{query:?}");
        }
    }
}

/// Coordinates just inside the bound must not be left out, as Embree does with those outside.
#[test]
fn the_largest_coordinates_still_block() {
    let device = Device::new(1).unwrap();
    let far = 1.8e18;
    let vertices = [[-far, -far, 0.0], [far, -far, 0.0], [0.0, far, 0.0]];
    let scene = EmbreeScene::new(&device, &vertices, &[[0, 1, 2]], options(Receiver::Included)).unwrap();
    assert_answers(&scene, &[segment([0.0, 0.0, 1.0], [0.0, 0.0, -1.0])], &[true], "far corners");
}

#[test]
fn version_and_instruction_set_are_those_of_the_library() {
    let device = Device::new(0).unwrap();
    let numbers: Vec<u32> = device.version().split('.').map(|part| part.parse().unwrap()).collect();
    assert_eq!(numbers.len(), 3);
    assert!([3, 4].contains(&numbers[0]), "{}", device.version());
    let known = ["AVX-512", "AVX2", "AVX", "SSE4.2", "SSE2", "NEON"];
    assert!(known.contains(&device.instruction_set().as_str()), "{}", device.instruction_set());
    #[cfg(target_arch = "x86_64")]
    if device.instruction_set().starts_with("AVX") {
        assert!(std::arch::is_x86_feature_detected!("avx"));
    }
}
