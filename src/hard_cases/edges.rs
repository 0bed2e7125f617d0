//! Cases of edges, vertices and slivers.

use super::parts::{Corners, bare, behind, grid, neighbours, square, steps, triangles, v};
use super::{Expected, HardCase, Situation};
use crate::geometry::LightPosition;
use glam::Vec3;

pub(super) const CASES: &[HardCase] = &[
    HardCase::new(24, "rays through the edges of an integer grid", integer_grid),
    HardCase::new(25, "rays through vertices of valence 3 to 1000", valences),
    HardCase::new(26, "touching a silhouette edge or vertex", silhouettes),
    HardCase::new(27, "a sliver almost in the ray's direction, after Embree's issue 387", grazed_sliver),
    HardCase::new(28, "a sliver far from the segment, after Embree's issue 423", missed_sliver),
    HardCase::new(29, "a needle of 1 to 1e7", needle),
    HardCase::new(30, "zero-area triangles", zero_area),
];

fn integer_grid() -> Vec<Situation> {
    let flat = |x: i32, z: i32| v(x as f32, 4.0, z as f32);
    let bumpy = |x: i32, z: i32| v(x as f32, 4.0 + 0.25 * ((x * 7 + z * 5) % 3) as f32, z as f32);
    let light = v(3.0, 16.0, 5.0);
    let mut situations = Vec::new();
    for (name, mesh) in [("flat", grid(8, flat)), ("bumpy", grid(8, bumpy))] {
        // Corners, middles and quarters of all edges: each is on two triangles or more.
        let on_edges = mesh.iter().flat_map(|&[a, b, c]| {
            [(a, b), (b, c), (c, a)]
                .into_iter()
                .flat_map(|(a, b)| [a, 0.5 * (a + b), 0.75 * a + 0.25 * b].map(|p| behind(p, light)))
        });
        let scene = triangles(&mesh);
        let points = bare(on_edges);
        situations.push(Situation::new(
            format!("{name}, on the edges"),
            scene.clone(),
            light,
            points,
            Expected::AllDark,
        ));
        // Within the grid one ulp off an edge is on its other side.
        let inside = mesh.iter().map(|&[a, b, _]| 0.5 * (a + b));
        let inside = inside.filter(|p| p.x > 0.0 && p.x < 8.0 && p.z > 0.0 && p.z < 8.0);
        let off = inside.flat_map(|p| neighbours(behind(p, light)));
        situations.push(Situation::new(
            format!("{name}, one ulp off"),
            scene,
            light,
            bare(off),
            Expected::AllDark,
        ));
    }
    situations
}

/// A cone of triangles around its tip.
fn fan(tip: Vec3, valence: u32) -> Vec<Corners> {
    let rim = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i % valence) / f64::from(valence);
        tip + v(2.0 * libm::cos(angle) as f32, -0.5, 2.0 * libm::sin(angle) as f32)
    };
    (0..valence).map(|i| [tip, rim(i), rim(i + 1)]).collect()
}

fn valences() -> Vec<Situation> {
    let (tip, light) = (v(0.0, 1.0, 0.0), v(0.25, 3.0, 0.125));
    let mut situations = Vec::new();
    for valence in [3, 4, 7, 64, 100, 1000] {
        let mesh = fan(tip, valence);
        let scene = triangles(&mesh);
        let at_tip = neighbours(behind(tip, light)).chain([0.5 * (tip + behind(tip, light))]);
        let name = format!("valence {valence}");
        situations.push(Situation::new(name.clone(), scene.clone(), light, bare(at_tip), Expected::AllDark));
        // Along the edges from the tip to the rim, and at its corners, where coordinates are rounded.
        let some = mesh.iter().step_by(1 + valence as usize / 16);
        let along = some
            .flat_map(|&[tip, b, c]| [b, 0.5 * (tip + b), 0.5 * (b + c)])
            .flat_map(|p| neighbours(behind(p, light)).step_by(2));
        situations.push(Situation::new(
            format!("{name}, its edges"),
            scene,
            light,
            bare(along),
            Expected::AsTruth,
        ));
    }
    situations
}

fn silhouettes() -> Vec<Situation> {
    let sheet = || triangles(&square(1.0, 2.0));
    let edge = [2.0f32.next_down(), 2.0, 2.0f32.next_up(), 1.0, 0.0];
    let signed = edge.into_iter().flat_map(|x| [x, -x]).collect::<Vec<_>>();
    let places = || signed.iter().flat_map(|&x| signed.iter().map(move |&z| v(x, 0.0, z)));
    let dark =
        |reach: f32| Expected::Known(places().map(|p| p.x.abs() <= reach && p.z.abs() <= reach).collect());
    let halved = places().map(|p| v(0.5 * p.x, 0.0, 0.5 * p.z));
    let sun = LightPosition::Towards(Vec3::Y);
    let aslant = LightPosition::Towards(v(1.0, 2.0, -1.0));
    // Under the slanting sun the shadow is moved by (-1, 1); whole and half steps stay exact.
    let moved: Vec<_> =
        steps(-8, 8).flat_map(|x| steps(-8, 8).map(move |z| v(0.25 * x, 0.0, 0.25 * z))).collect();
    let in_moved = moved.iter().map(|p| (p.x + 1.0).abs() <= 1.0 && (p.z - 1.0).abs() <= 1.0).collect();
    vec![
        Situation::new("a lamp above it", sheet(), v(0.0, 4.0, 0.0), bare(places()), dark(2.0)),
        Situation::new("a sun above it", sheet(), sun, bare(halved), dark(2.0)),
        Situation::new("a sun aslant", sheet(), aslant, bare(moved), Expected::Known(in_moved)),
    ]
}

/// Triangles with edges of 11.2, 9.7 and 1.4 and rays at half a degree to their planes: the numbers of the issue,
/// whose very coordinates are not ours to copy.
fn grazed_sliver() -> Vec<Situation> {
    let mut situations = Vec::new();
    for turn in 0..6 {
        let angle = f64::from(turn) * 0.7;
        let (sin, cos) = (libm::sin(angle) as f32, libm::cos(angle) as f32);
        let place = |p: Vec3| v(cos * p.x - sin * p.z + 217.3, p.y + 91.7, sin * p.x + cos * p.z - 130.9);
        let sliver = [v(0.0, 0.0, 0.0), v(11.2, 0.3, 0.0), v(9.68, 0.28, 0.33)].map(place);
        let scene = triangles(&[sliver]);
        let light = place(v(-540.0, 4.9 - 14.4, 3.1));
        let near = steps(-6, 6)
            .flat_map(|i| steps(-6, 6).map(move |k| v(320.0 + i, 5.5 + 0.1 * k, 0.02 * i * k - 1.7)));
        let beyond = steps(-20, 20).map(|i| v(14.0 + 0.01 * i, 0.02 * i, 0.013 * i));
        let points = bare(near.chain(beyond).map(place));
        situations.push(Situation::new(
            format!("turned {turn} times"),
            scene.clone(),
            light,
            points,
            Expected::AsTruth,
        ));
        // Nothing of it reaches so far to the side.
        let aside = steps(1, 12).flat_map(|i| [v(300.0, 7.0, 40.0 * i), v(300.0, 7.0, -40.0 * i)]);
        let lit = bare(aside.map(place));
        situations.push(Situation::new(
            format!("turned {turn} times, aside"),
            scene,
            light,
            lit,
            Expected::AllLit,
        ));
    }
    situations
}

fn missed_sliver() -> Vec<Situation> {
    let mut situations = Vec::new();
    // Edges of one mesh as segments against a sliver of another, as in a test for collisions.
    let (a, b) = (v(0.228_68, 1.352_685, -0.4), v(0.231_07, 1.352_691, -0.381_3));
    for width in [1e-3f32, 1e-5, 1e-7] {
        let scene = triangles(&[[a, b, 0.5 * (a + b) + v(0.0, width, 0.0)]]);
        let along = b - a;
        let light = b + 3.0 * along;
        let (mut far, mut near) = (Vec::new(), Vec::new());
        for i in steps(-10, 10) {
            // Beside it, beyond its end, and through its plane.
            far.push(light + along * 0.25 * i.abs() + v(0.0, 1e-4 * i, 0.0));
            near.push(a - 2.0 * along + v(0.0, width * 0.05 * i, 1e-9 * i));
            near.push(a + 0.1 * i * along + v(1e-8 * i, width, 0.0));
        }
        situations.push(Situation::new(
            format!("{width:e} wide, beyond it"),
            scene.clone(),
            light,
            bare(far),
            Expected::AllLit,
        ));
        situations.push(Situation::new(
            format!("{width:e} wide, along it"),
            scene,
            light,
            bare(near),
            Expected::AsTruth,
        ));
    }
    situations
}

fn needle() -> Vec<Situation> {
    let width = 1e-7f32;
    let light = v(0.5, 2.0, 0.0);
    let scene = triangles(&[[v(0.0, 1.0, 0.0), v(1.0, 1.0, 0.0), v(0.5, 1.0, width)]]);
    let (mut points, mut dark) = (Vec::new(), Vec::new());
    // How far the needle reaches across at each place along it.
    for (x, reach) in [(0.0, 0.0), (0.25, 0.5 * width), (0.5, width), (0.75, 0.5 * width), (1.0, 0.0)] {
        let outside = [-1e-3, -width, 0.0f32.next_down(), reach.next_up(), 2.0 * width, 1e-6];
        let across =
            outside.map(|z| (z, false)).into_iter().chain([(0.0, true), (reach, true), (0.5 * reach, true)]);
        for (z, inside) in across {
            points.push(behind(v(x, 1.0, z), light));
            dark.push(inside);
        }
    }
    let side = v(-1.5, 1.25, 0.25);
    let around =
        steps(-9, 9).flat_map(|i| [0.0, width, 3.0 * width].map(|z| behind(v(0.1 * i, 1.0, z), side)));
    vec![
        Situation::new("straight above", scene.clone(), light, bare(points), Expected::Known(dark)),
        Situation::new("from its end", scene, side, bare(around), Expected::AsTruth),
    ]
}

fn zero_area() -> Vec<Situation> {
    let [a, b, c, d] = [v(-1.0, 1.0, -1.0), v(-1.0, 1.0, 1.0), v(1.0, 1.0, 1.0), v(1.0, 1.0, -1.0)];
    let middle = 0.5 * (a + c);
    let none = [[a, middle, c], [a, a, c], [middle, middle, middle], [c, middle, a]];
    // One half is cut at the middle of the diagonal, the other is not; what has no area lies between.
    let halves = [[a, b, middle], [middle, b, c], [a, c, d]];
    let sealed: Vec<Corners> = none.into_iter().chain(halves).collect();
    let light = v(0.0, 3.0, 0.0);
    let diagonal = steps(-15, 15).map(|i| v(0.0625 * i, 1.0, 0.0625 * i));
    let through = || diagonal.clone().map(|p| 1.5 * p - 0.5 * light).flat_map(neighbours);
    let alone = triangles(&none);
    vec![
        Situation::new("alone", alone, light, bare(through()), Expected::AllLit),
        Situation::new(
            "between halves of a square",
            triangles(&sealed),
            light,
            bare(through()),
            Expected::AllDark,
        ),
    ]
}
