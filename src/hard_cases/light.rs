//! Cases of the light: on surfaces, inside of them, at points, very near and very far.

use super::parts::{
    Corners, TINY, ball, bare, behind, cuboid, neighbours, soup, square, steps, triangles, v, with_curved,
};
use super::{Expected, HardCase, Situation};
use crate::geometry::curved::Shape;
use glam::{DVec3, Vec3};

pub(super) const CASES: &[HardCase] = &[
    HardCase::new(10, "the light in a triangle's plane", in_a_plane),
    HardCase::new(11, "the light on a vertex, an edge and a face", on_a_surface),
    HardCase::new(12, "the light inside a closed mesh", inside),
    HardCase::new(13, "the light one ulp off a wall at 148376", one_ulp_off_a_wall),
    HardCase::new(14, "the point in the light", point_in_the_light),
    HardCase::new(15, "a denormal distance", denormal_distance),
    HardCase::new(16, "the light at 1e18, 2e18 and 3e38", very_far),
];

fn around(height: f32) -> impl Iterator<Item = Vec3> {
    steps(-8, 8).flat_map(move |x| steps(-8, 8).map(move |z| v(0.5 * x, height, 0.5 * z)))
}

fn in_a_plane() -> Vec<Situation> {
    let sheet = triangles(&square(1.0, 1.0));
    let cube = triangles(&cuboid(v(-1.0, 0.0, -1.0), v(0.0, 1.0, 0.0)));
    let light = v(-3.0, 1.0, 2.0);
    let heights = [0.0, 0.5, 1.0f32.next_down(), 1.0, 1.0f32.next_up(), 1.5];
    let points = || bare(heights.into_iter().flat_map(around));
    let above = bare([1.0f32.next_up(), 1.25, 3.0].into_iter().flat_map(around));
    let straight = v(-1.0, 4.0, -1.0);
    vec![
        Situation::new("a sheet's", sheet, light, points(), Expected::AllLit),
        Situation::new("the top of a box", cube.clone(), light, points(), Expected::AsTruth),
        Situation::new("above the top of a box", cube.clone(), light, above, Expected::AllLit),
        Situation::new("two sides of a box", cube, straight, points(), Expected::AsTruth),
    ]
}

fn on_a_surface() -> Vec<Situation> {
    let sheet = triangles(&square(1.0, 1.0));
    let heights = [-1.0, 0.5, 1.0f32.next_down(), 1.0f32.next_up(), 2.0];
    let places = [
        ("a vertex", 1.0, 1.0),
        ("an edge", 1.0, 0.25),
        ("the diagonal", 0.5, 0.5),
        ("a face", 0.25, -0.125),
    ];
    let mut situations = Vec::new();
    for (name, x, z) in places {
        let (light, points) = (v(x, 1.0, z), bare(heights.into_iter().flat_map(around)));
        // A light on a sheet lights both sides of it.
        let on_sheet =
            Situation::new(format!("{name} of a sheet"), sheet.clone(), light, points, Expected::AllLit);
        situations.push(on_sheet);
        let cube = triangles(&cuboid(v(-1.0, 0.0, -1.0), v(1.0, 1.0, 1.0)));
        let above = bare([1.0f32.next_up(), 1.5, 9.0].into_iter().flat_map(around));
        situations.push(Situation::new(
            format!("{name}, above a box"),
            cube.clone(),
            light,
            above,
            Expected::AllLit,
        ));
        let below = bare(around(-0.5).filter(|p| p.x.abs() < 1.0 && p.z.abs() < 1.0));
        situations.push(Situation::new(
            format!("{name}, below a box"),
            cube,
            light,
            below,
            Expected::AllDark,
        ));
    }
    situations
}

fn inside() -> Vec<Situation> {
    let mesh = ball(DVec3::ZERO, 2.0, 12);
    let mut situations = Vec::new();
    for (name, light) in [
        ("in the middle", Vec3::ZERO),
        ("near the wall", v(0.0, 1.875, 0.0)),
        ("anywhere", v(0.3, -0.7, 0.9)),
    ] {
        let corners = || mesh.iter().flat_map(|&[a, b, c]| [a, 0.5 * (a + b), (a + b + c) / 3.0]);
        let outside = corners().map(|p| light + 1.5 * (p - light)).filter(|p| p.length() > 2.125);
        let far = corners().map(|p| 1e6 * p);
        let within = corners().map(|p| 0.5 * p);
        let scene = triangles(&mesh);
        let outside = bare(outside.chain(far).step_by(3));
        situations.push(Situation::new(
            format!("{name}, outside"),
            scene.clone(),
            light,
            outside,
            Expected::AllDark,
        ));
        let within = bare(within.step_by(5));
        situations.push(Situation::new(format!("{name}, inside"), scene, light, within, Expected::AllLit));
    }
    let cube = triangles(&cuboid(Vec3::NEG_ONE, Vec3::ONE));
    // Through the corners, the edges and the diagonals of the sides.
    let through =
        steps(-2, 2).flat_map(|x| steps(-2, 2).flat_map(move |y| steps(-2, 2).map(move |z| v(x, y, z))));
    let outside = through.filter(|p| p.abs().max_element() == 2.0).flat_map(|p| [p, 1.5 * p, 1e9 * p]);
    situations.push(Situation::new("a box, outside", cube, Vec3::ZERO, bare(outside), Expected::AllDark));
    situations
}

fn one_ulp_off_a_wall() -> Vec<Situation> {
    const WALL: f32 = 148_376.0;
    let at = |y: f32, z: f32| v(WALL, 1234.0 + y, z);
    let wall = triangles(&[[at(-900.0, -900.0), at(900.0, -900.0), at(0.0, 900.0)]]);
    let across = [-1e4, -3.0, 0.0, 4.0, 1e5];
    let ulps =
        [WALL.next_down().next_down(), WALL.next_down(), WALL, WALL.next_up(), WALL.next_up().next_up()];
    let xs: Vec<f32> = across.iter().map(|x| WALL + x).chain(ulps).collect();
    let lights = [WALL.next_up(), WALL.next_down()];
    let situation = |x: f32| {
        let (mut points, mut dark) = (Vec::new(), Vec::new());
        for &px in &xs {
            for (y, z) in [(0.0, 0.0), (50.0, 20.0), (-100.0, 70.0), (-1.0, -100.0)] {
                points.push(v(px, 1234.0 + y, z));
                dark.push((f64::from(px) - f64::from(WALL)) * (f64::from(x) - f64::from(WALL)) < 0.0);
            }
        }
        let name = if x > WALL { "before it" } else { "behind it" };
        Situation::new(name, wall.clone(), v(x, 1234.0, 0.0), bare(points), Expected::Known(dark))
    };
    lights.into_iter().map(situation).collect()
}

fn point_in_the_light() -> Vec<Situation> {
    let flat = square(1.0, 1.0);
    let spheres = [Shape::sphere(v(0.0, 3.0, 0.0), 1.0), Shape::sphere(v(3.0, 1.0, 0.0), 1.0)];
    let places = [
        ("on a face", v(0.25, 1.0, 0.0)),
        ("on a vertex", v(1.0, 1.0, 1.0)),
        ("on two spheres' line", v(0.0, 2.0, 0.0)),
        ("inside a sphere", v(3.0, 1.25, 0.25)),
        ("in the void", v(0.0, -2.0, 0.0)),
    ];
    let mut situations = Vec::new();
    for (name, light) in places {
        let scene = with_curved(&flat, &spheres);
        let alone = Situation::new(name, scene.clone(), light, bare([light]), Expected::AllLit);
        situations.push(alone);
        let near = bare(neighbours(light));
        situations.push(Situation::new(
            format!("one ulp off, {name}"),
            scene,
            light,
            near,
            Expected::AsTruth,
        ));
    }
    situations
}

fn denormal_distance() -> Vec<Situation> {
    let wide = |half: f32| {
        let y = 4.0 * TINY;
        triangles(&[[v(-half, y, -half), v(half, y, -half), v(0.0, y, half)]])
    };
    let (mut points, mut dark) = (Vec::new(), Vec::new());
    for (x, z) in steps(-2, 2).flat_map(|x| steps(-2, 2).map(move |z| (x * TINY, z * TINY))) {
        for y in [-5.0, 0.0, 3.0, 4.0, 5.0, 8.0, 1e3, 1e6] {
            points.push(v(x, y * TINY, z));
            dark.push(y > 4.0);
        }
    }
    let situation = |name: &str, half: f32| {
        Situation::new(name, wide(half), Vec3::ZERO, bare(points.clone()), Expected::Known(dark.clone()))
    };
    vec![
        situation("denormal corners", 100.0 * TINY),
        situation("usual corners", 1.0),
        situation("huge corners", 1e30),
    ]
}

fn very_far() -> Vec<Situation> {
    let mut situations = Vec::new();
    for height in [1e18f32, 2e18, 3e38] {
        let sheet = triangles(&square(1.0, 1.0));
        let edge = [
            -1.5,
            -1.0f32.next_up(),
            -1.0,
            -1.0f32.next_down(),
            0.0,
            0.5,
            1.0f32.next_down(),
            1.0,
            1.0f32.next_up(),
            7.0,
        ];
        let (mut points, mut dark) = (Vec::new(), Vec::new());
        for (x, z) in edge.into_iter().flat_map(|x| edge.map(|z| (x, z))) {
            points.push(v(x, 0.0, z));
            // The light is so far away that its ray through a point of the edge meets the floor less than one ulp off.
            dark.push(x.abs() <= 1.0 && z.abs() <= 1.0);
        }
        let name = format!("{height:e} above a sheet");
        situations.push(Situation::new(
            name,
            sheet,
            v(0.0, height, 0.0),
            bare(points),
            Expected::Known(dark),
        ));
        let cube = soup(&[cuboid(v(-1.0, 0.0, -1.0), v(1.0, 2.0, 1.0)), square(9.0, -1.0)]);
        let aslant = v(-0.5, 0.75, 0.25) * height;
        let points = bare(around(-0.5).chain(around(3.0)));
        situations.push(Situation::new(
            format!("{height:e} aslant"),
            cube,
            aslant,
            points,
            Expected::AsTruth,
        ));
    }
    let far: Corners = [v(-1e37, 1e37, -1e37), v(1e37, 1e37, -1e37), v(0.0, 1e37, 1e37)];
    let light = v(0.0, 3e38, 0.0);
    let through = [v(0.0, 1e37, 0.0), v(1e36, 1e37, 2e36), v(-1e36, 1e37, -2e36)];
    // Their doubles stay in the range of floats.
    let points = bare(through.map(|p| behind(p, v(0.0, 1.5e37, 0.0))));
    situations.push(Situation::new("a sheet of 1e37", triangles(&[far]), light, points, Expected::AllDark));
    situations
}
