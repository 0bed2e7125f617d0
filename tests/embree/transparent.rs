//! What light passes through: it blocks nothing, and is counted.

use super::shapes::{self, crossings};
use super::*;
use glam::Vec3;
use lightbuffer::SurfacePoint;
use lightbuffer::embree::{RayCrossing, SceneParts};
use lightbuffer::geometry::curved::{Crossing, Disc, Shape};
use lightbuffer::scene::{Material, ObjectInput, Scene, SceneBuilder, Shadowing, Transmission};
use lightbuffer::shadow::{BuildInput, Crossings, SceneIndex, ShadowTester, find};
use lightbuffer::visibility::PointSource;

fn crossed(scene: &EmbreeScene, rays: &[ShadowRay], query: QueryOptions) -> Vec<RayCrossing> {
    let mut found = vec![RayCrossing { ray: 99, primitive: 99, times: 99 }];
    scene.crossed(rays, query, &mut found).unwrap();
    found
}

/// What each ray crosses must be this, in every way to ask.
fn assert_crossed(scene: &EmbreeScene, rays: &[ShadowRay], expected: &[Vec<(u32, u32)>], what: &str) {
    let of_ray = |(ray, crossed): (usize, &Vec<(u32, u32)>)| {
        let crossing = |&(primitive, times): &(u32, u32)| RayCrossing { ray: ray as u32, primitive, times };
        crossed.iter().map(crossing).collect::<Vec<_>>()
    };
    let expected: Vec<_> = expected.iter().enumerate().flat_map(of_ray).collect();
    for query in QUERIES.iter().copied() {
        assert_eq!(crossed(scene, rays, query), expected, "{what}, {query:?}");
    }
}

/// `CORNER` at several heights.
fn sheets(heights: &[f32]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let corners = heights.iter().flat_map(|z| CORNER.map(|[x, y, _]| [x, y, *z])).collect();
    (corners, (0..heights.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

#[test]
fn sheets_and_a_sphere_of_glass_are_counted_and_block_nothing() {
    let device = Device::new(1).unwrap();
    let (vertices, triangles) = sheets(&[0.0, 1.0, 2.0, -9.0]);
    let curved =
        [Shape::sphere(Vec3::new(0.5, 0.5, 4.0), 0.5), Shape::sphere(Vec3::new(0.5, 0.5, -12.0), 0.5)];
    // The fourth sheet and the second sphere let nothing through.
    let transparent = [true, true, true, false, true, false];
    let down = |from: f32, to: f32| segment([0.5, 0.5, from], [0.5, 0.5, to]);
    // Segment, whether it is blocked, and what it crosses if it is not.
    let cases = [
        (down(5.0, -1.0), false, vec![(0, 1), (1, 1), (2, 1), (4, 2)]),
        (down(4.0, 0.5), false, vec![(1, 1), (2, 1), (4, 1)]),
        (down(3.0, 2.5), false, vec![]),
        (down(4.25, 3.75), false, vec![]),
        (down(0.5, -8.0), false, vec![(0, 1)]),
        (down(5.0, -10.0), true, vec![]),
        (down(0.5, -10.0), true, vec![]),
        (down(-10.0, -12.0), true, vec![]),
        (down(-10.0, -11.0), false, vec![]),
        // Beside everything.
        (segment([5.0, 5.0, 5.0], [5.0, 5.0, -10.0]), false, vec![]),
    ];
    let rays: Vec<ShadowRay> = cases.iter().map(|case| case.0).collect::<Vec<_>>().repeat(4);
    let blocked: Vec<bool> = cases.iter().map(|case| case.1).collect::<Vec<_>>().repeat(4);
    let met: Vec<_> = cases.iter().cycle().take(rays.len()).map(|case| case.2.clone()).collect();
    for options in all_options() {
        let parts = SceneParts {
            vertices: &vertices,
            triangles: &triangles,
            curved: &curved,
            transparent: &transparent,
            ..SceneParts::default()
        };
        let scene = EmbreeScene::of_parts(&device, parts, options).unwrap();
        let what = format!("{options:?}");
        assert_answers(&scene, &rays, &blocked, &what);
        assert_crossed(&scene, &rays, &met, &what);

        // From the glass itself: the sheet no more, and the sphere once.
        let from_sheet = ShadowRay { excluded: 2, ..down(2.0, 0.5) };
        let from_sphere = ShadowRay { excluded: 4, ..down(4.5, 3.0) };
        let away = ShadowRay { excluded: 4, ..segment([0.5, 0.5, 4.5], [0.5, 0.5, 9.0]) };
        if options.receiver == Receiver::Excluded {
            let rays = [from_sheet, from_sphere, away];
            assert_crossed(&scene, &rays, &[vec![(1, 1)], vec![(4, 1)], vec![]], &what);
        }
    }
}

/// More crossings than there are rays: the first room that is made for them does not do.
#[test]
fn a_ray_can_cross_any_number_of_sheets() {
    let device = Device::new(1).unwrap();
    let heights: Vec<f32> = (0..500).map(|i| i as f32).collect();
    let (vertices, triangles) = sheets(&heights);
    let transparent = vec![true; 500];
    for options in all_options() {
        let parts = SceneParts {
            vertices: &vertices,
            triangles: &triangles,
            transparent: &transparent,
            ..SceneParts::default()
        };
        let scene = EmbreeScene::of_parts(&device, parts, options).unwrap();
        let rays = [segment([0.5, 0.5, -1.0], [0.5, 0.5, 600.0]), segment([0.5, 0.5, 0.5], [0.5, 0.5, 9.5])];
        let all = |range: std::ops::Range<u32>| range.map(|i| (i, 1)).collect::<Vec<_>>();
        assert_crossed(&scene, &rays, &[all(0..500), all(1..10)], &format!("{options:?}"));
        assert_answers(&scene, &rays, &[false; 2], "glass");
    }
}

#[test]
fn every_mode_counts_each_primitive_as_arithmetic_does() {
    let soup = soup(60, 300);
    let shapes = shapes::random(18);
    let mut rays = Vec::new();
    let mut expected: Vec<Vec<(u32, u32)>> = Vec::new();
    for ray in &soup.rays {
        let to = [0, 1, 2].map(|k| ray.origin[k] + ray.direction[k]);
        let each = |i: usize| soup.crossed_one(i, ray.origin, to).map(usize::from);
        let all = (0..60).map(each).chain(shapes.iter().map(|shape| crossings(shape, ray.origin, to)));
        let Some(all) = all.collect::<Option<Vec<usize>>>() else { continue };
        rays.push(ShadowRay { excluded: ShadowRay::NO_PRIMITIVE, ..*ray });
        let met = all.into_iter().enumerate().filter(|(_, times)| *times > 0);
        expected.push(met.map(|(primitive, times)| (primitive as u32, times as u32)).collect());
    }
    let twice = expected.iter().flatten().filter(|(_, times)| *times == 2).count();
    assert!(rays.len() > 150 && twice > 10, "{} rays, {twice} shapes twice", rays.len());
    let device = Device::new(2).unwrap();
    let transparent = vec![true; 60 + shapes.len()];
    for options in all_options() {
        let parts = SceneParts {
            vertices: &soup.vertices,
            triangles: &soup.triangles,
            curved: &shapes,
            transparent: &transparent,
            ..SceneParts::default()
        };
        let scene = EmbreeScene::of_parts(&device, parts, options).unwrap();
        assert_answers(&scene, &rays, &vec![false; rays.len()], "glass");
        for count in [1, 5, 17, rays.len()] {
            assert_crossed(&scene, &rays[..count], &expected[..count], &format!("{options:?}"));
        }
    }
}

/// Triangles as large as the scene are cut by spatial splits, and a ray may meet their pieces in several leaves. In
/// packets Embree tells of a triangle more often still.
#[test]
fn a_triangle_in_several_leaves_is_counted_once() {
    let device = Device::new(1).unwrap();
    let ends = shapes::rays(3200);
    let vertices: Vec<[f32; 3]> = ends.iter().take(3000).flat_map(|(a, b)| [*a, *b]).collect();
    let triangles: Vec<[u32; 3]> = (0..2000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let rays: Vec<ShadowRay> = ends[3000..].iter().map(|(from, to)| segment(*from, *to)).collect();
    let [medium, high] = [BuildQuality::Medium, BuildQuality::High].map(|quality| {
        let parts = SceneParts {
            vertices: &vertices,
            triangles: &triangles,
            transparent: &[true; 2000],
            ..SceneParts::default()
        };
        let options = SceneOptions { quality, ..EmbreeMode::RIVAL.scene };
        let scene = EmbreeScene::of_parts(&device, parts, options).unwrap();
        QUERIES.iter().map(|query| crossed(&scene, &rays, *query)).collect::<Vec<_>>()
    });
    let once = &medium[0];
    assert!(once.len() > 10_000 && once.is_sorted_by(|a, b| (a.ray, a.primitive) < (b.ray, b.primitive)));
    for found in medium.iter().chain(&high) {
        assert!(found == once, "{} and {}", once.len(), found.len());
    }
}

#[test]
fn transparency_is_told_for_all_primitives_or_for_none() {
    let device = Device::new(1).unwrap();
    let (vertices, triangles) = sheets(&[0.0, 1.0]);
    let parts = |transparent| SceneParts {
        vertices: &vertices,
        triangles: &triangles,
        transparent,
        ..SceneParts::default()
    };
    let error = EmbreeScene::of_parts(&device, parts(&[true]), options(Receiver::Included));
    let text = error.unwrap_err().to_string();
    assert!(text.contains("transparency of 1 primitives for 2"), "{text}");
    // Where nothing is transparent, nothing is crossed.
    for transparent in [&[][..], &[false; 2]] {
        let scene = EmbreeScene::of_parts(&device, parts(transparent), options(Receiver::Included)).unwrap();
        let rays = [segment([0.5, 0.5, 3.0], [0.5, 0.5, -1.0]), segment([3.0, 3.0, 3.0], [3.0, 3.0, -1.0])];
        assert_answers(&scene, &rays, &[true, false], "opaque");
        assert_crossed(&scene, &rays, &[vec![], vec![]], "opaque");
    }
}

/// Two objects of glass, one that casts nothing before them, an opaque disc, and a light above.
fn glasshouse() -> Scene {
    let mut builder = SceneBuilder::new("glasshouse");
    let transmission = Some(Transmission { transmittance: [0.5; 3], refractive_index: 1.0 });
    let glass = builder.add_material(Material { transmission, ..Material::default() });
    let sheets = |name: &str, heights: &[f32]| {
        let (vertices, triangles) = sheets(heights);
        ObjectInput::new(name, vertices.into_iter().map(Vec3::from_array).collect(), triangles)
    };
    let ghost = Shadowing { casts: false, receives: true };
    let ball = vec![Shape::sphere(Vec3::new(0.5, 0.5, 5.0), 0.5)];
    let lid = vec![Shape::Disc(Disc { centre: Vec3::new(9.0, 9.0, 5.0), normal: Vec3::Z, radius: 2.0 })];
    let round = |name: &str, curved| ObjectInput { curved, ..ObjectInput::new(name, vec![], vec![]) };
    for object in [
        ObjectInput { shadowing: ghost, ..sheets("ghost", &[0.5]) },
        ObjectInput { material: glass, ..sheets("panes", &[1.0, 2.0, 3.0]) },
        ObjectInput { shadowing: ghost, ..round("ghost ball", ball.clone()) },
        ObjectInput { material: glass, ..round("ball", ball) },
        round("lid", lid),
    ] {
        builder.add_object(object).unwrap();
    }
    builder.finish()
}

/// Through the tester, with the numbers of the scene.
#[test]
fn testers_tell_what_points_see_the_light_through() {
    let scene = glasshouse();
    let index = SceneIndex::new(&scene);
    let light = Vec3::new(0.5, 0.5, 8.0);
    let bare = |x, y, z| SurfacePoint::bare(Vec3::new(x, y, z)).unwrap();
    let on_ball = |z: f32| {
        let source = PointSource::OnCurved {
            origin: light,
            direction: -Vec3::Z,
            primitive: 5,
            crossing: Crossing::Entering,
        };
        SurfacePoint { position: Vec3::new(0.5, 0.5, z).as_dvec3(), source }
    };
    let points = [
        bare(0.5, 0.5, 0.0),
        bare(0.5, 0.5, 2.5),
        bare(0.5, 0.5, 7.0),
        bare(0.5, 0.5, 5.0),
        // Under the lid.
        bare(17.5, 17.5, 2.0),
        on_ball(5.5),
        on_ball(4.5),
    ];
    let expected: [&[u32]; 7] = [&[1, 2, 3, 5, 5], &[3, 5, 5], &[], &[5], &[], &[], &[5]];
    let blocked = [false, false, false, false, true, false, false];
    for name in ["embree", "embree-fast", "embree-robust-packet1-high-excluded"] {
        let tester = match name.parse::<EmbreeMode>() {
            Ok(mode) => {
                let input = BuildInput::new(&scene, &index, light);
                Box::new(lightbuffer::shadow::embree::Embree::new(&input, mode).unwrap())
                    as Box<dyn ShadowTester>
            }
            Err(_) => (find(name).unwrap().build)(&BuildInput::new(&scene, &index, light)).unwrap(),
        };
        // More points than are asked at a time.
        let many = points.repeat(50);
        let mut answers = vec![true; many.len()];
        tester.occluded(&many, &mut answers).unwrap();
        assert_eq!(answers, blocked.repeat(50), "{name}");
        let mut crossings = Crossings::default();
        tester.crossed(&many, &mut crossings).unwrap();
        assert_eq!(crossings.len(), many.len(), "{name}");
        for point in 0..many.len() {
            assert_eq!(crossings.of(point), expected[point % 7], "{name}: point {point}");
        }
    }
}
