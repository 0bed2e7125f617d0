//! Triangles of random scenes: much that coincides, meets or nearly does.

use super::super::aimed::nudged;
use super::super::parts::{Corners, ball, both_sides, cuboid, grid, inverted};
use super::place::{Place, direction};
use super::recipe::Part;
use crate::random::Random;
use glam::{DVec3, Vec3};

/// Makes one kind of part.
pub type Make = fn(&Place, &mut Random) -> Part;

/// All kinds; those that stand here twice are made twice as often.
pub const KINDS: &[Make] = &[
    soup, soup, sheet, sheet, coplanar, coplanar, boxes, boxes, boxes, tetrahedra, bodies, slivers, fan,
    panes, scattered,
];

/// Triangles over a few points of the lattice: shared corners and edges of any number of triangles.
fn soup(place: &Place, random: &mut Random) -> Part {
    let pool: Vec<Vec3> = (0..4 + random.below(6)).map(|_| place.lattice_point(random)).collect();
    let count = 2 + random.below(10);
    Part::flat((0..count).map(|_| std::array::from_fn(|_| *random.pick(&pool))).collect())
}

/// A sheet of squares, flat or not, and beside it one of half the width: T-junctions.
fn sheet(place: &Place, random: &mut Random) -> Part {
    let n = 1 + random.below(3) as i32;
    let heights: Vec<f64> = match random.below(3) {
        0 => vec![0.0; 64],
        _ => (0..64).map(|_| *random.pick(&[0.0, 0.0, 0.5, -0.5, 1.0])).collect(),
    };
    let (turn, at) = (random.below(3), place.lattice(random));
    let point = |x: f64, height: f64, z: f64| {
        let mut turned = [x, height, z];
        turned.rotate_left(turn);
        place.of(at + DVec3::from_array(turned))
    };
    let height = |x: i32, z: i32| heights[(8 * x + z) as usize];
    let mut triangles = grid(n, |x, z| point(f64::from(x), height(x, z), f64::from(z)));
    if random.chance(0.5) {
        let beside = |x: i32, z: i32| point(0.5 * f64::from(x) - 1.0, 0.0, 0.5 * f64::from(z));
        triangles.extend(grid(2, beside));
    }
    Part::flat(triangles)
}

/// Triangles that overlap in one plane, some of them both ways round.
fn coplanar(place: &Place, random: &mut Random) -> Part {
    let (at, u, v) = (place.lattice(random), direction(random), direction(random));
    let corner = |random: &mut Random| {
        let mut along = || random.below(5) as f64 - 2.0;
        place.of(at + u * along() * 0.5 + v * along() * 0.5)
    };
    let one: Vec<Corners> =
        (0..2 + random.below(6)).map(|_| std::array::from_fn(|_| corner(random))).collect();
    Part::flat(if random.chance(0.3) { both_sides(&one) } else { one })
}

/// A box in a box, perhaps in another; they may share faces, and any may be turned inside out.
fn boxes(place: &Place, random: &mut Random) -> Part {
    let (mut low, mut high) = (place.lattice(random), place.lattice(random));
    (low, high) = (low.min(high) - place.way(random).abs() * 0.5, low.max(high) + 0.5);
    let mut triangles = Vec::new();
    for _ in 0..1 + random.below(3) {
        let faces = cuboid(place.of(low), place.of(high));
        triangles.extend(if random.chance(0.2) { inverted(&faces) } else { faces });
        let mut inwards = || *random.pick(&[0.0, 0.125, 0.25]) * (high - low).min_element();
        (low, high) = (low + DVec3::splat(inwards()), high - DVec3::new(inwards(), inwards(), inwards()));
    }
    Part::flat(triangles)
}

/// Tetrahedra over the lattice; the next stands on a face of the one before.
fn tetrahedra(place: &Place, random: &mut Random) -> Part {
    let mut corners: [Vec3; 4] = std::array::from_fn(|_| place.lattice_point(random));
    let mut triangles = Vec::new();
    for _ in 0..1 + random.below(3) {
        let [a, b, c, d] = corners;
        let faces = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
        let is_inside_out = (b - a).cross(c - a).dot(d - a) > 0.0;
        triangles.extend(if is_inside_out { inverted(&faces) } else { faces.to_vec() });
        let corner = random.below(4);
        corners[corner] = place.lattice_point(random);
    }
    Part::flat(triangles)
}

/// A closed body of many sides, perhaps with another inside.
fn bodies(place: &Place, random: &mut Random) -> Part {
    let centre = place.exact(place.lattice(random));
    let radius = *random.pick(&[0.5, 1.0, 2.0]) * place.size();
    let mut triangles = ball(centre, radius, 3);
    if random.chance(0.4) {
        triangles.extend(ball(centre, radius * random.pick(&[0.5, 0.999_999, 1.0]), 3));
    }
    Part::flat(triangles)
}

/// Long needles, and triangles with two corners an ulp or so apart.
fn slivers(place: &Place, random: &mut Random) -> Part {
    let count = 1 + random.below(6);
    let sliver = |_| {
        let (a, b) = (place.lattice(random), place.lattice(random));
        let beside = match random.below(3) {
            0 => a,
            1 => (a + b) * 0.5,
            _ => a.lerp(b, random.unit()),
        };
        let third = nudged(place.exact(beside), random);
        [place.of(a), place.of(b), third]
    };
    Part::flat((0..count).map(sliver).collect())
}

/// Triangles around a point, flat or a cone, closed or not.
fn fan(place: &Place, random: &mut Random) -> Part {
    let (middle, tip) = (place.lattice(random), direction(random) * *random.pick(&[0.0, 0.5, 1.0]));
    let rim = [
        (2.0, 0.0),
        (1.0, 1.0),
        (0.0, 2.0),
        (-1.0, 1.0),
        (-2.0, 0.0),
        (-1.0, -1.0),
        (0.0, -2.0),
        (1.0, -1.0),
    ];
    let turn = random.below(3);
    let corner = |i: usize| {
        let (x, z) = rim[i % rim.len()];
        let mut turned = [x, 0.0, z];
        turned.rotate_left(turn);
        place.of(middle + DVec3::from_array(turned))
    };
    let sides = if random.chance(0.6) { rim.len() } else { 2 + random.below(5) };
    Part::flat((0..sides).map(|i| [place.of(middle + tip), corner(i), corner(i + 1)]).collect())
}

/// Glass, layer behind layer, of squares that share edges.
fn panes(place: &Place, random: &mut Random) -> Part {
    let (at, turn) = (place.lattice(random), random.below(3));
    let pane = |layer: usize| {
        grid(1 + (layer as i32) % 2, move |x, z| {
            let mut turned = [2.0 * f64::from(x) - 1.0, 0.5 * layer as f64, 2.0 * f64::from(z) - 1.0];
            turned.rotate_left(turn);
            place.of(at + DVec3::from_array(turned))
        })
    };
    Part::flat((0..1 + random.below(4)).flat_map(pane).collect()).of_glass()
}

/// Triangles on no lattice.
fn scattered(place: &Place, random: &mut Random) -> Part {
    let count = 1 + random.below(8);
    Part::flat((0..count).map(|_| std::array::from_fn(|_| place.of(place.anywhere(random)))).collect())
}

/// A floor that shadows fall on.
pub fn floor(place: &Place, random: &mut Random) -> Part {
    let (axis, down) = (random.below(3), *random.pick(&[-4.0, 4.0, -2.0]));
    let corner = |x: f64, z: f64| {
        let mut turned = [16.0 * x, down, 16.0 * z];
        turned.rotate_left(axis);
        place.of(DVec3::from_array(turned))
    };
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    Part::flat(vec![[a, b, c], [a, c, d]])
}

/// Some triangles of a part again, the other way round or with their corners in another order.
pub fn doubled(part: &Part, random: &mut Random) -> Vec<Corners> {
    let count = (1 + random.below(4)).min(part.triangles.len());
    let again = |_| {
        let mut corners = *random.pick(&part.triangles);
        corners.rotate_left(random.below(3));
        if random.chance(0.5) {
            corners.swap(0, 1);
        }
        corners
    };
    (0..count).map(again).collect()
}
