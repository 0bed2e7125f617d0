//! Lights of random scenes, and what is hard because of where they are.

use super::super::aimed::nudged;
use super::super::parts::Corners;
use super::place::{Place, direction};
use super::recipe::Part;
use crate::geometry::LightPosition;
use crate::random::Random;
use glam::{DVec3, Vec3};

/// A light: on the lattice, on what is there or an ulp off, in its planes, inside, far or infinitely far away.
pub fn light(triangles: &[Corners], place: &Place, random: &mut Random) -> LightPosition {
    let far = |random: &mut Random| {
        let away = 2f64.powi(*random.pick(&[4, 12, 24, 40, 59]));
        (direction(random) * (away * place.size())).as_vec3()
    };
    let light = match random.below(16) {
        0..=4 => LightPosition::At(place.lattice_point(random)),
        5..=6 => LightPosition::At(place.of(place.anywhere(random))),
        7..=8 => LightPosition::At(place.of(place.lattice(random) * 2.0)),
        9 | 10 if !triangles.is_empty() => LightPosition::At(beside(random.pick(triangles), random)),
        11 => LightPosition::At(far(random)),
        12..=14 => LightPosition::Towards(towards(triangles, random)),
        _ => LightPosition::At(nudged(place.exact(place.lattice(random)), random)),
    };
    match light {
        LightPosition::At(point) if point.is_finite() => light,
        LightPosition::Towards(way) if way.is_finite() && way != Vec3::ZERO => light,
        _ => LightPosition::At(place.of(DVec3::new(0.5, 5.0, 0.25))),
    }
}

/// On a corner, an edge or in the plane of a triangle, exactly or nearly.
fn beside(triangle: &Corners, random: &mut Random) -> Vec3 {
    let [a, b, c] = triangle.map(|corner| corner.as_dvec3());
    let weights = *random.pick(&[
        [1.0, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.5, 0.25, 0.25],
        [2.0, -1.0, 0.0],
        [1.0, 1.0, -1.0],
        [3.0, -1.0, -1.0],
    ]);
    let point = a * weights[0] + b * weights[1] + c * weights[2];
    if random.chance(0.5) { point.as_vec3() } else { nudged(point, random) }
}

/// A direction: of whole numbers, an ulp off such, along an edge, or any length at all.
fn towards(triangles: &[Corners], random: &mut Random) -> Vec3 {
    let whole = direction(random);
    match random.below(6) {
        0 => nudged(whole, random),
        1 if !triangles.is_empty() => {
            let [a, b, _] = *random.pick(triangles);
            b - a
        }
        2 => DVec3::new(random.signed(), random.signed(), random.signed()).as_vec3(),
        3 => (whole * 2f64.powi(*random.pick(&[-140, -60, 40, 120]))).as_vec3(),
        _ => whole.as_vec3(),
    }
}

/// Triangles that are hard as this light sees them.
pub fn seen_badly(light: LightPosition, place: &Place, random: &mut Random) -> Part {
    let (size, count) = (place.size(), 1 + random.below(4));
    let triangle = |_| -> Corners {
        match light {
            LightPosition::At(at) => {
                let from = at.as_dvec3();
                match random.below(4) {
                    0 => edge_on(from, size, random),
                    1 => across_seams(from, size, random),
                    2 => around(from, size, random),
                    _ => near_the_border_of_cells(from, size, random),
                }
            }
            LightPosition::Towards(way) => {
                let (a, b) = (place.exact(place.lattice(random)), place.exact(place.lattice(random)));
                let along = way.as_dvec3() / f64::from(way.abs().max_element());
                [a, a + along * (size * *random.pick(&[1.0, 2.0, 7.0])), b].map(|corner| corner.as_vec3())
            }
        }
    };
    Part::flat((0..count).map(triangle).collect())
}

/// In a plane through the light, before rounding.
fn edge_on(from: DVec3, size: f64, random: &mut Random) -> Corners {
    let (u, v) = (direction(random) * size, direction(random) * size);
    std::array::from_fn(|_| {
        let mut along = || random.below(9) as f64 - 4.0;
        (from + u * along() * 0.5 + v * along() * 0.5).as_vec3()
    })
}

/// A spike over edges and corners of the cube around the light.
fn across_seams(from: DVec3, size: f64, random: &mut Random) -> Corners {
    std::array::from_fn(|_| {
        let mut sign = || if random.chance(0.5) { -1.0 } else { 1.0 };
        let mut corner = [sign(), sign(), sign()];
        if random.chance(0.4) {
            corner[random.below(3)] = random.signed();
        }
        let corner = from + DVec3::from_array(corner) * (size * *random.pick(&[0.5, 1.0, 2.0, 3.0]));
        if random.chance(0.5) { corner.as_vec3() } else { nudged(corner, random) }
    })
}

/// Wide, and almost through the light: it reaches over several faces of the cube.
fn around(from: DVec3, size: f64, random: &mut Random) -> Corners {
    let near = *random.pick(&[0.0, 1e-6, 1e-3, 0.25]) * size;
    let turn = random.below(3);
    [(-3.0, -2.0), (3.0, -2.0), (0.0, 4.0)].map(|(x, z)| {
        let mut turned = [x * size, near, z * size];
        turned.rotate_left(turn);
        nudged(from + DVec3::from_array(turned), random)
    })
}

/// Corners in directions on the borders of cells that a power of two or a multiple of 3 or 5 makes.
fn near_the_border_of_cells(from: DVec3, size: f64, random: &mut Random) -> Corners {
    let cells = *random.pick(&[2.0, 3.0, 5.0, 16.0, 64.0]);
    let turn = random.below(3);
    let depth = *random.pick(&[1.0, 2.0, -1.0, -4.0]);
    std::array::from_fn(|_| {
        let mut border = || 2.0 * random.below(cells as usize + 1) as f64 / cells - 1.0;
        let mut turned = [border(), border(), 1.0];
        turned.rotate_left(turn);
        let corner = from + DVec3::from_array(turned) * (depth * size);
        if random.chance(0.5) { corner.as_vec3() } else { nudged(corner, random) }
    })
}
