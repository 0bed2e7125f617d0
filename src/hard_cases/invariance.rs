//! Cases of transparent layers, and of orders that must not matter.

use super::parts::{
    Corners, STILL_LIGHT, bare, soup, square, steps, still_life, still_points, v, with_glass,
};
use super::{Expected, HardCase, Situation};
use glam::Vec3;

pub(super) const CASES: &[HardCase] = &[
    HardCase::new(45, "64 layers that let 0.9 of the light through", layers),
    HardCase::new(46, "something opaque behind transparent layers", opaque_behind),
    HardCase::new(47, "triangles and corners in other orders", orders),
];

/// Where the layers' light is.
const LAMP: Vec3 = v(0.0, 128.0, 0.0);

/// Squares above each other, each of two triangles with a common diagonal.
fn stack(count: usize) -> Vec<Vec<Corners>> {
    (1..=count).map(|i| square(4.0, i as f32)).collect()
}

/// Points below the middle, the shared diagonal among them.
fn below() -> impl Iterator<Item = Vec3> {
    steps(-6, 6).flat_map(|x| steps(-6, 6).map(move |z| v(0.25 * x, 0.0, 0.25 * z)))
}

fn layers() -> Vec<Situation> {
    let stack = stack(64);
    let reversed: Vec<_> = stack.iter().rev().cloned().collect();
    let shuffled: Vec<_> = (0..64).map(|i| stack[i * 27 % 64].clone()).collect();
    let turned: Vec<_> =
        stack.iter().map(|layer| layer.iter().rev().map(|&[a, b, c]| [b, c, a]).collect()).collect();
    let situation = |name: &str, layers: &[Vec<Corners>]| {
        let points = bare(below());
        let times = vec![64; points.len()];
        Situation::new(name, with_glass(layers, 0.9, &[]), LAMP, points, Expected::AllLit).crossing(times)
    };
    let beside = bare([v(40.0, 0.0, 0.0), v(0.0, 0.0, -50.0), v(0.0, 64.5, 0.0), v(0.0, 60.5, 0.25)]);
    vec![
        situation("from below upwards", &stack),
        situation("from above downwards", &reversed),
        situation("shuffled", &shuffled),
        situation("their triangles turned", &turned),
        Situation::new(
            "beside and between them",
            with_glass(&stack, 0.9, &[]),
            LAMP,
            beside,
            Expected::AllLit,
        )
        .crossing(vec![0, 0, 0, 4]),
    ]
}

fn opaque_behind() -> Vec<Situation> {
    let stack = stack(8);
    let covered = |y: f32| with_glass(&stack, 0.9, &square(4.0, y));
    let none = |situation: Situation| {
        let times = vec![0; situation.points.len()];
        situation.crossing(times)
    };
    let mut situations: Vec<_> =
        [("below them", 0.5), ("between them", 4.5), ("above them", 9.0), ("in the place of one", 4.0)]
            .map(|(name, y)| none(Situation::new(name, covered(y), LAMP, bare(below()), Expected::AllDark)))
            .into();
    let aside = bare([v(0.0, 0.75, 0.0), v(0.25, 0.75, -0.5)]);
    situations.push(
        Situation::new("behind the point", covered(0.5), LAMP, aside, Expected::AllLit).crossing(vec![8; 2]),
    );
    situations
}

fn orders() -> Vec<Situation> {
    let whole = still_life();
    let rotated: Vec<Vec<Corners>> =
        whole.iter().map(|part| part.iter().map(|&[a, b, c]| [b, c, a]).collect()).collect();
    let reversed: Vec<Vec<Corners>> =
        whole.iter().rev().map(|part| part.iter().rev().copied().collect()).collect();
    let shuffled: Vec<Vec<Corners>> = whole
        .iter()
        .map(|part| {
            let mut order: Vec<usize> = (0..part.len()).collect();
            order.sort_by_key(|i| (i * 7919) % 101);
            order.into_iter().map(|i| part[i]).collect()
        })
        .collect();
    let joined: Vec<Vec<Corners>> = vec![whole.iter().flatten().copied().collect()];
    let single: Vec<Vec<Corners>> = whole.iter().flatten().map(|&corners| vec![corners]).collect();
    let orders = [
        ("as it is", whole),
        ("corners rotated", rotated),
        ("objects and triangles reversed", reversed),
        ("triangles shuffled", shuffled),
        ("one object", joined),
        ("an object a triangle", single),
    ];
    let situation = |(i, (name, parts)): (usize, (&str, Vec<Vec<Corners>>))| {
        let expected = if i == 0 { Expected::AsTruth } else { Expected::SameAs(0) };
        Situation::new(name, soup(&parts), STILL_LIGHT, bare(still_points()), expected)
    };
    orders.into_iter().enumerate().map(situation).collect()
}
