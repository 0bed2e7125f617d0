//! Cases of the two ends of the segment: contact, acne, and what lies just before or beyond the light.

use super::parts::{
    Corners, ball, bare, both_sides, cuboid, lid, rays, seen, soup, square, steps, triangles, v, with_curved,
};
use super::{Expected, HardCase, Situation};
use crate::geometry::curved::Shape;
use crate::scene::Scene;
use crate::visibility::SurfacePoint;
use glam::{DVec3, Vec3};

pub(super) const CASES: &[HardCase] = &[
    HardCase::new(17, "a box on a floor with gaps of 0, 1 ulp, 1e-6 and 1e-3", contact),
    HardCase::new(18, "a triangle 1e4 wide, grazed at 0.01 degrees", grazing),
    HardCase::new(19, "a neighbour across a convex edge of 1e-6 rad", convex_edge),
    HardCase::new(20, "nested spheres 4e-5 apart", nested_spheres),
    HardCase::new(21, "the receiver's face twice, both ways round", doubled_receiver),
    HardCase::new(22, "an occluder in the last 1e-5 before the light", just_before_the_light),
    HardCase::new(23, "an occluder one ulp beyond the light", just_beyond_the_light),
];

/// A floor in one triangle, which is the scene's first primitive.
fn floor(y: f32) -> Vec<Corners> {
    lid(100.0, y)
}

/// Points of the floor of [`floor`], whatever stands on it: the eye is straight above each, very near.
fn on_floor(scene: &Scene, y: f32, places: impl IntoIterator<Item = (f32, f32)>) -> Vec<SurfacePoint> {
    let point = |(x, z)| SurfacePoint::on_ray(scene, v(x, y + 1.0, z), Vec3::NEG_Y, 0);
    places.into_iter().map(point).collect()
}

fn contact() -> Vec<Situation> {
    let light = v(-3.0, 5.0, 0.5);
    let mut situations = Vec::new();
    for (name, low) in [("0", 1.0), ("1 ulp", 1.0f32.next_up()), ("1e-6", 1.0 + 1e-6), ("1e-3", 1.001)] {
        let scene = soup(&[floor(1.0), cuboid(v(0.0, low, 0.0), v(1.0, 2.0, 1.0))]);
        // Where the box stands, from where the widest gap lets no light in, and behind it without a gap.
        let depths =
            [0.01, 0.25, 0.5, 0.999, 1.0f32.next_down(), 1.0, 1.0f32.next_up(), 1.000_001, 1.0001, 1.25];
        let under = || depths.into_iter().flat_map(|x| [0.125, 0.25, 0.5, 0.75].map(|z| (x, z)));
        let dark = on_floor(&scene, 1.0, under());
        let title = |what: &str| format!("gap of {name}, {what}");
        situations.push(Situation::new(title("under it"), scene.clone(), light, dark, Expected::AllDark));
        let before = steps(-8, -1).flat_map(|x| steps(-3, 6).map(move |z| (0.125 * x, 0.25 * z)));
        let before = before.chain([(-1e-6, 0.5), (-f32::MIN_POSITIVE, 0.25), (0.0f32.next_down(), 0.75)]);
        let lit = on_floor(&scene, 1.0, before);
        situations.push(Situation::new(title("before it"), scene.clone(), light, lit, Expected::AllLit));
        // The walls that face the light, down to the contact line, and the top.
        let heights = [1.0011f32, 1.25, 1.5, 1.999];
        let wall =
            heights.into_iter().flat_map(|y| steps(0, 8).map(move |z| (v(-1.0, y, 0.125 * z), Vec3::X)));
        let top =
            steps(0, 8).flat_map(|x| steps(0, 8).map(move |z| (v(0.125 * x, 3.0, 0.125 * z), Vec3::NEG_Y)));
        let walls = rays(&scene, wall.chain(top).filter(|(origin, _)| origin.z > 0.0 && origin.z < 1.0));
        situations.push(Situation::new(title("on it"), scene, light, walls, Expected::AllLit));
    }
    situations
}

fn grazing() -> Vec<Situation> {
    let wide: Corners = [v(-5000.0, 0.0, -5000.0), v(5000.0, 0.0, -5000.0), v(0.0, 0.0, 5000.0)];
    let light = v(-5000.0, 0.872_664, -4000.0);
    let places =
        || steps(-40, 40).map(|i| (90.0 * i, 10.0 * i - 3000.0)).chain(steps(1, 9).map(|i| (0.1 * i, i)));
    let alone = triangles(&[wide]);
    let points = on_floor(&alone, 0.0, places());
    // A wall across the way, whose shadow ends where the ray over its top comes down.
    let wall = [v(0.0, 0.0, -200.0), v(0.0, 0.25, -200.0), v(0.0, 0.25, 200.0), v(0.0, 0.0, 200.0)];
    let walled = soup(&[vec![wide], vec![[wall[0], wall[1], wall[2]], [wall[0], wall[2], wall[3]]]]);
    let low = v(-4000.0, 0.75, 0.0);
    let behind = |far: &[f32]| on_floor(&walled, 0.0, far.iter().map(|&x| (x, 0.0)));
    // 0.75 high and 4000 before, 0.25 high and 2000 behind.
    let dark = behind(&[0.001, 1.0, 20.0, 555.5, 1999.0, 2000.0f32.next_down(), 2000.0]);
    let lit = behind(&[2000.0f32.next_up(), 2001.0, 2400.0]);
    vec![
        Situation::new("its own surface", alone, light, points, Expected::AllLit),
        Situation::new("behind a low wall", walled.clone(), low, dark, Expected::AllDark),
        Situation::new("beyond the wall's shadow", walled, low, lit, Expected::AllLit),
    ]
}

fn convex_edge() -> Vec<Situation> {
    let drop = -10.0 * 1e-6f32;
    let ridge = [v(0.0, 0.0, -10.0), v(0.0, 0.0, 10.0)];
    let roof = [[ridge[0], v(-10.0, drop, 0.0), ridge[1]], [ridge[0], ridge[1], v(10.0, drop, 0.0)]];
    let scene = triangles(&roof);
    let near = [1e-30f32, 1e-6, 1e-3, 0.1, 1.0, 4.0].into_iter().flat_map(|x| [x, -x]);
    let places = near.flat_map(|x| steps(-4, 4).map(move |z| v(x, 0.0, z)));
    let points = seen(&scene, v(0.5, 7.0, 0.25), places);
    let lights =
        [v(-5.0, 3.0, 0.2), v(-50.0, 1e-4, 0.0), v(-50.0, 6e-5, 3.0), v(0.0, 1e-7, 0.0), v(9.0, 1e5, -9.0)];
    let lit = |light: Vec3| {
        Situation::new(format!("from {light}"), scene.clone(), light, points.clone(), Expected::AllLit)
    };
    lights.into_iter().map(lit).collect()
}

fn nested_spheres() -> Vec<Situation> {
    let outer_radius = 1.0 + 4e-5;
    let inner = ball(DVec3::ZERO, 1.0, 10);
    let light = v(3.0, 5.0, 2.0);
    let directions = || {
        steps(-5, 5).flat_map(|x| steps(-5, 5).map(move |z| v(0.19 * x + 0.01, 0.07 * x * z * 0.2, 0.17 * z)))
    };
    let eye = v(2.0, 4.0, 1.0);
    // The inner one is the first object of both scenes, so that its primitives have the same numbers.
    let alone = triangles(&inner);
    let meshes = soup(&[inner, ball(DVec3::ZERO, outer_radius, 10)]);
    let on_inner = seen(&alone, eye, directions());
    let on_outer = seen(&meshes, eye, directions());
    let small = Shape::sphere(Vec3::ZERO, 1.0);
    let round_alone = with_curved(&[], &[small]);
    let round = with_curved(&[], &[small, Shape::sphere(Vec3::ZERO, outer_radius as f32)]);
    let on_small = seen(&round_alone, eye, directions());
    let on_large = seen(&round, eye, directions());
    vec![
        Situation::new("the inner mesh", meshes.clone(), light, on_inner, Expected::AllDark),
        Situation::new("the outer mesh", meshes, light, on_outer, Expected::AllLit),
        Situation::new("the inner sphere", round.clone(), light, on_small, Expected::AllDark),
        Situation::new("the outer sphere", round, light, on_large, Expected::AllLit),
    ]
}

fn doubled_receiver() -> Vec<Situation> {
    // Copies in other cuts lie in the same plane and do not block either.
    let cut = [
        [v(-2.0, 1.0, -2.0), v(2.0, 1.0, -2.0), v(0.5, 1.0, 2.0)],
        [v(-1.0, 1.0, 2.0), v(1.0, 1.0, 2.0), v(0.0, 1.0, -1.0)],
    ];
    let flat: Vec<Corners> = both_sides(&square(1.0, 1.0)).into_iter().chain(both_sides(&cut)).collect();
    let tilt = |p: Vec3| v(p.x, p.y + 0.3 * p.x - 0.7 * p.z, p.z);
    let tilted: Vec<Corners> = both_sides(&[square(1.0, 1.0)[0].map(tilt)]);
    let places = || steps(-4, 4).flat_map(|x| steps(-4, 4).map(move |z| v(0.25 * x, 1.0, 0.25 * z)));
    let eye = v(0.3, 4.0, 0.2);
    let mut situations = Vec::new();
    for (name, triangles) in [("in two cuts", flat), ("tilted", tilted)] {
        let scene = soup(&[triangles.clone(), triangles]);
        let points = seen(&scene, eye, places());
        for light in [v(-2.0, 4.0, 1.5), v(0.25, 30.0, 0.25)] {
            situations.push(Situation::new(name, scene.clone(), light, points.clone(), Expected::AllLit));
        }
        let straight = Vec3::NEG_Y;
        let from_below = rays(&scene, places().map(|p| (p - 5.0 * Vec3::Y, Vec3::Y)));
        let below = Situation::new(
            format!("{name}, from below"),
            scene,
            9.0 * straight,
            from_below,
            Expected::AllLit,
        );
        situations.push(below);
    }
    let exact = triangles(&both_sides(&square(1.0, 1.0)));
    situations.push(Situation::new(
        "bare points on it",
        exact,
        v(0.25, 3.0, 0.0),
        bare(places()),
        Expected::AllLit,
    ));
    situations
}

const LAMP: Vec3 = v(0.0, 10.0, 0.0);

/// A lid of some size under or over the lamp, and points of the floor.
fn lidded(height: f32, half: f32) -> (Scene, Vec<SurfacePoint>) {
    let scene = soup(&[floor(0.0), lid(half, height)]);
    let places = steps(-6, 6).flat_map(|x| steps(-6, 6).map(move |z| (0.75 * x, 0.75 * z)));
    let points = on_floor(&scene, 0.0, places);
    (scene, points)
}

fn just_before_the_light() -> Vec<Situation> {
    let heights = [("1e-5 of the way", 9.9999), ("1 ulp", 10.0f32.next_down()), ("1e-6 of the way", 9.99999)];
    let dark = |(name, height): (&str, f32)| {
        let (scene, points) = lidded(height, 1e-3);
        Situation::new(name, scene, LAMP, points, Expected::AllDark)
    };
    let mut situations: Vec<_> = heights.into_iter().map(dark).collect();
    let (scene, points) = lidded(10.0f32.next_down(), 1e-3);
    let bare_points = bare(points.iter().map(|p| p.position.as_vec3()));
    situations.push(Situation::new("bare points", scene, LAMP, bare_points, Expected::AllDark));
    situations
}

fn just_beyond_the_light() -> Vec<Situation> {
    let heights = [("1 ulp", 10.0f32.next_up()), ("the light on it", 10.0), ("1e-5 of the way", 10.0001)];
    let lit = |(name, height): (&str, f32)| {
        let (scene, points) = lidded(height, 1.0);
        Situation::new(name, scene, LAMP, points, Expected::AllLit)
    };
    heights.into_iter().map(lit).collect()
}
