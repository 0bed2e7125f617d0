//! Cases of meshes that are not what a mesh should be.

use super::parts::{
    Corners, STILL_LIGHT, bare, behind, inverted, neighbours, soup, square, steps, still_life, still_points,
    triangles, v,
};
use super::{Expected, HardCase, Situation};
use glam::Vec3;

pub(super) const CASES: &[HardCase] = &[
    HardCase::new(38, "inverted winding", inverted_winding),
    HardCase::new(39, "an edge of three and more faces, and single sheets", many_faces),
    HardCase::new(40, "a T-junction with a gap", t_junction),
];

fn inverted_winding() -> Vec<Situation> {
    let whole = still_life();
    let all: Vec<_> = whole.iter().map(|part| inverted(part)).collect();
    let every_other = |part: &Vec<Corners>| {
        let turn = |(i, &[a, b, c]): (usize, &Corners)| if i % 2 == 0 { [a, c, b] } else { [a, b, c] };
        part.iter().enumerate().map(turn).collect::<Vec<_>>()
    };
    let half: Vec<_> = whole.iter().map(every_other).collect();
    let points = || bare(still_points());
    vec![
        Situation::new("as it is", soup(&whole), STILL_LIGHT, points(), Expected::AsTruth),
        Situation::new("all the other way round", soup(&all), STILL_LIGHT, points(), Expected::SameAs(0)),
        Situation::new("every other one", soup(&half), STILL_LIGHT, points(), Expected::SameAs(0)),
    ]
}

fn many_faces() -> Vec<Situation> {
    let (a, b) = (v(0.0, 2.0, -4.0), v(0.0, 2.0, 4.0));
    let light = v(0.0, 6.0, 0.25);
    let mut situations = Vec::new();
    let pages = [v(-3.0, 2.0, 0.0), v(3.0, 1.0, 0.0), v(3.0, 3.0, 0.0), v(-3.0, 4.0, 1.0), v(2.0, 0.0, 0.0)];
    for count in [3, 4, 5] {
        let book: Vec<Corners> = pages[..count].iter().map(|&page| [a, b, page]).collect();
        // Through the spine and, one ulp off, through the pages on both sides of it.
        let spine = steps(-15, 15).map(|i| behind(v(0.0, 2.0, 0.25 * i), light)).flat_map(neighbours);
        let name = format!("an edge of {count} faces");
        situations.push(Situation::new(name, triangles(&book), light, bare(spine), Expected::AllDark));
    }
    let sheet = || triangles(&square(1.0, 0.0));
    let places = |y: f32| steps(-4, 4).flat_map(move |x| steps(-4, 4).map(move |z| v(0.25 * x, y, 0.25 * z)));
    for (name, up) in [("from above", 1.0), ("from below", -1.0)] {
        let light = v(0.25, 3.0 * up, 0.125);
        let beyond = bare(places(-0.5 * up).map(|p| v(0.75 * p.x, p.y, 0.75 * p.z)));
        situations.push(Situation::new(format!("a sheet {name}"), sheet(), light, beyond, Expected::AllDark));
        let before = bare(places(0.5 * up));
        situations.push(Situation::new(
            format!("before a sheet, {name}"),
            sheet(),
            light,
            before,
            Expected::AllLit,
        ));
    }
    situations
}

fn t_junction() -> Vec<Situation> {
    let (a, b) = (v(0.0, 1.0, -1.0), v(0.0, 1.0, 1.0));
    let light = v(0.0, 2.0, 0.0);
    let mut situations = Vec::new();
    for gap in [1e-3f32, 1e-6, 1e-20, f32::from_bits(2), -1e-6, 0.0] {
        let middle = v(gap, 1.0, 0.0);
        let right = [[a, middle, v(2.0, 1.0, 0.0)], [middle, b, v(2.0, 1.0, 0.0)]];
        let scene = triangles(&[[a, b, v(-2.0, 1.0, 0.0)], right[0], right[1]]);
        let (mut points, mut dark) = (Vec::new(), Vec::new());
        for x in [-0.5, -gap.abs(), 0.0, 0.5 * gap, gap, 2.0 * gap.abs(), 0.5] {
            points.push(behind(v(x, 1.0, 0.0), light));
            dark.push(x <= 0.0 || x >= gap);
        }
        let name = format!("a gap of {gap:e}");
        situations.push(Situation::new(name, scene.clone(), light, bare(points), Expected::Known(dark)));
        // At its ends the gap is closed.
        let ends: [Vec3; 2] = [a, b].map(|p| behind(p, light));
        situations.push(Situation::new(
            format!("ends of a gap of {gap:e}"),
            scene,
            light,
            bare(ends),
            Expected::AllDark,
        ));
    }
    situations
}
