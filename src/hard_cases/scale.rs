//! Cases of scale: far away, huge, tiny, and numbers that are none.

use super::parts::{
    Corners, STILL_LIGHT, TINY, ball, bare, behind, cuboid, grid, lid, moved, seen, soup, steps, still_life,
    still_points, triangles, v,
};
use super::{Expected, HardCase, Situation};
use crate::geometry::curved::Shape;
use crate::scene::{ObjectInput, Scene, SceneBuilder, procedural};
use crate::visibility::{PointSource, SurfacePoint};
use glam::Vec3;

pub(super) const CASES: &[HardCase] = &[
    HardCase::new(31, "a sphere of radius 2 and a plane at (148376, 1234, -223423)", far_away),
    HardCase::new(32, "the scene times 2^40 and 2^-40", powers_of_two),
    HardCase::new(33, "an offset of 1e6, a scale of 1e-6", offset_and_scale),
    HardCase::new(34, "a teapot in a stadium of 1e5", teapot_in_a_stadium),
    HardCase::new(35, "a box of 5.89e11 by 1.2e5", huge_and_flat),
    HardCase::new(36, "denormal vertices", denormal_vertices),
    HardCase::new(37, "vertices that are NaN or infinite", not_finite),
];

fn far_away() -> Vec<Situation> {
    let place = v(148_376.0, 1234.0, -223_423.0);
    let sphere = ball(place.as_dvec3(), 2.0, 16);
    let plane = moved(&grid(12, |x, z| v(x as f32 - 6.0, 0.0, z as f32 - 6.0)), |p| p + place);
    let corners = |mesh: &[Corners]| {
        mesh.iter().flat_map(|&[a, b, c]| [a, 0.5 * (b + c)]).step_by(3).collect::<Vec<_>>()
    };
    let around = corners(&sphere).into_iter().map(|p| behind(p, place)).collect::<Vec<_>>();
    let above = place + v(0.25, 4.0, 0.5);
    let below = corners(&plane).into_iter().filter(|p| (*p - place).abs().max_element() < 6.0);
    let below: Vec<_> = below.map(|p| behind(p, above)).collect();
    let both = soup(&[sphere.clone(), moved(&plane, |p| p - v(0.0, 3.0, 0.0))]);
    let on_plane =
        steps(-10, 10).flat_map(|x| steps(-10, 10).map(move |z| place + v(0.5 * x, -3.0, 0.5 * z)));
    let on_plane = seen(&both, place + v(3.0, 9.0, 4.0), on_plane);
    let lamp = place + v(0.0, 8.0, 0.0);
    vec![
        Situation::new("from inside the sphere", triangles(&sphere), place, bare(around), Expected::AllDark),
        Situation::new("through the plane's edges", triangles(&plane), above, bare(below), Expected::AllDark),
        Situation::new("both", both, lamp, on_plane, Expected::AsTruth),
    ]
}

/// A surface point where a factor that changes no digit takes it.
fn scaled(scene: &Scene, point: &SurfacePoint, factor: f32) -> SurfacePoint {
    match point.source {
        PointSource::Ray { origin, direction, primitive } => {
            SurfacePoint::on_ray(scene, factor * origin, direction, primitive)
        }
        _ => *point,
    }
}

fn powers_of_two() -> Vec<Situation> {
    let parts = still_life();
    let scene = soup(&parts);
    let surface = seen(&scene, v(2.3, 2.7, 4.1), still_points());
    let up = 2f32.powi(40);
    let mut situations = vec![
        Situation::new("as it is", scene.clone(), STILL_LIGHT, surface.clone(), Expected::AsTruth),
        Situation::new("bare points", scene, STILL_LIGHT, bare(still_points()), Expected::AsTruth),
    ];
    for (name, factor) in [("2^40", up), ("2^-40", 1.0 / up)] {
        let scene = soup(&parts.iter().map(|part| moved(part, |p| factor * p)).collect::<Vec<_>>());
        let points = surface.iter().map(|point| scaled(&scene, point, factor)).collect();
        let light = factor * STILL_LIGHT;
        situations.push(Situation::new(name, scene.clone(), light, points, Expected::SameAs(0)));
        let points = bare(still_points().into_iter().map(|p| factor * p));
        situations.push(Situation::new(
            format!("bare points, {name}"),
            scene,
            light,
            points,
            Expected::SameAs(1),
        ));
    }
    situations
}

fn offset_and_scale() -> Vec<Situation> {
    let situation = |name: &str, place: &dyn Fn(Vec3) -> Vec3, expected: Expected| {
        let scene = soup(&still_life().iter().map(|part| moved(part, place)).collect::<Vec<_>>());
        let points = bare(still_points().into_iter().map(place));
        Situation::new(name, scene, place(STILL_LIGHT), points, expected)
    };
    vec![
        situation("offset", &|p| p + Vec3::splat(1e6), Expected::AsTruth),
        situation("scale", &|p| 1e-6 * p, Expected::AsTruth),
        situation("scale around 1", &|p| 1e-6 * p + Vec3::ONE, Expected::AsTruth),
        // All that is left is one point: no triangle has an area.
        situation("both", &|p| 1e-6 * p + Vec3::splat(1e6), Expected::AllLit),
    ]
}

fn teapot_in_a_stadium() -> Vec<Situation> {
    let teapot =
        procedural::find("teapot").and_then(|builtin| builtin.build(Some(4))).expect("a built-in scene");
    let mut builder = SceneBuilder::extend(teapot);
    let stand = |low: Vec3, high: Vec3| {
        let triangles = cuboid(low, high);
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        ObjectInput::new("stand", triangles.iter().flatten().copied().collect(), indices)
    };
    let field = stand(v(-1e5, -1e5, -20.0), v(1e5, 1e5, -10.0));
    let north = stand(v(-1e5, 9e4, -10.0), v(1e5, 1e5, 2e4));
    let east = stand(v(9e4, -9e4, -10.0), v(1e5, 9e4, 2e4));
    [field, north, east].into_iter().for_each(|input| builder.add_object(input).expect("indices in range"));
    let scene = builder.into_scene();
    let places = steps(-12, 12).flat_map(|x| steps(-12, 12).map(move |y| v(0.3 * x, 0.3 * y, 0.4)));
    let points = seen(&scene, v(4.86, 7.2, 5.4), places);
    let lights = [
        ("a lamp near it", v(-3.1, 9.8, 12.1)),
        ("a lamp over the stand", v(4e4, 9.5e4, 3e4)),
        ("a lamp beyond", v(2e5, 3e5, 4e4)),
    ];
    let situation = |(name, light): (&str, Vec3)| {
        Situation::new(name, scene.clone(), light, points.clone(), Expected::AsTruth)
    };
    lights.into_iter().map(situation).collect()
}

fn huge_and_flat() -> Vec<Situation> {
    let half = 2.945e11;
    let scene = triangles(&cuboid(v(-half, -half, 0.0), v(half, half, 1.2e5)));
    let places = || [0.0, 1.0, -6e4, 1e10, -2.9e11, 2.944e11].into_iter();
    let at = |z: f32| places().flat_map(move |x| places().map(move |y| v(x, y, z)));
    let middle = v(3.0, -2.0, 6e4);
    let above = v(10.0, 20.0, 2.4e5);
    let outside = at(-1.0).chain(at(1.3e5)).chain(at(-1e11)).chain(at(4e9));
    let walls = steps(-5, 5).flat_map(|i| [v(3e11, 1e10 * i, 6e4 + i), v(1e10 * i, -3e11, 6e4 - i)]);
    vec![
        Situation::new(
            "inside it, outside",
            scene.clone(),
            middle,
            bare(outside.chain(walls)),
            Expected::AllDark,
        ),
        Situation::new(
            "inside it, inside",
            scene.clone(),
            middle,
            bare(at(1.0).chain(at(1.1e5))),
            Expected::AllLit,
        ),
        Situation::new(
            "above it, below",
            scene.clone(),
            above,
            bare(at(-1.0).chain(at(-3e5))),
            Expected::AllDark,
        ),
        Situation::new(
            "above it, above",
            scene,
            above,
            bare(at(1.2e5f32.next_up()).chain(at(1e9))),
            Expected::AllLit,
        ),
    ]
}

fn denormal_vertices() -> Vec<Situation> {
    // Whole numbers, so that every power of two leaves them as they are.
    let parts = [
        lid(40.0, 0.0),
        cuboid(v(-8.0, 0.0, -8.0), v(0.0, 8.0, 0.0)),
        cuboid(v(4.0, 2.0, -4.0), v(12.0, 4.0, 4.0)),
        grid(4, |x, z| v(4.0 * x as f32 - 8.0, (16 + (x * 5 + z * 3) % 4) as f32, 4.0 * z as f32)),
    ];
    let light = v(-16.0, 64.0, 12.0);
    let points = || steps(-20, 20).flat_map(|x| steps(-20, 20).map(move |z| v(x, 0.0, z))).step_by(3);
    let situation = |(i, &(name, factor)): (usize, &(&str, f32))| {
        let scene = soup(&parts.iter().map(|part| moved(part, |p| factor * p)).collect::<Vec<_>>());
        let expected = if i == 0 { Expected::AsTruth } else { Expected::SameAs(0) };
        Situation::new(name, scene, factor * light, bare(points().map(|p| factor * p)), expected)
    };
    let factors = [
        ("usual", 1.0),
        ("denormal", TINY),
        ("half of them denormal", TINY * 2f32.powi(19)),
        ("near the least", f32::MIN_POSITIVE),
    ];
    factors.iter().enumerate().map(situation).collect()
}

fn not_finite() -> Vec<Situation> {
    let whole = still_life();
    let mut broken = vec![vec![]; 1];
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in 0..3 {
            let mut corners = [v(-9.0, 3.0, -9.0), v(9.0, 3.0, -9.0), v(0.0, 3.0, 9.0)];
            corners[axis][axis] = bad;
            broken[0].push(corners);
        }
    }
    broken.extend(whole.iter().cloned());
    let points = bare(still_points().into_iter().flat_map(|p| [p, p + v(0.0, 0.125, 0.0)]));
    let shapes = [
        Shape::sphere(v(0.0, 3.0, 0.0), f32::NAN),
        Shape::sphere(v(f32::INFINITY, 3.0, 0.0), 1.0),
        Shape::sphere(v(0.0, 3.0, 0.0), f32::INFINITY),
    ];
    let mut builder = SceneBuilder::extend(soup(&broken));
    let input = ObjectInput { curved: shapes.to_vec(), ..ObjectInput::new("curved", Vec::new(), Vec::new()) };
    builder.add_object(input).expect("no index");
    vec![
        Situation::new("without them", soup(&whole), STILL_LIGHT, points.clone(), Expected::AsTruth),
        Situation::new("with them", builder.finish(), STILL_LIGHT, points, Expected::SameAs(0)),
    ]
}
