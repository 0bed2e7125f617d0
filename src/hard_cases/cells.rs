//! Cases of cell look-up and lists: directions on the borders of cells and faces.

use super::parts::{
    STILL_LIGHT, TINY, bare, lid, neighbours, seen, soup, square, steps, still_life, still_points, triangles,
    v,
};
use super::{Expected, HardCase, Situation};
use glam::Vec3;

pub(super) const CASES: &[HardCase] = &[
    HardCase::new(1, "the borders of two faces", two_faces),
    HardCase::new(2, "the corners of three faces", three_faces),
    HardCase::new(3, "the borders of cells, and one ulp off", cell_borders),
    HardCase::new(4, "axes with zeros of both signs", axes),
    HardCase::new(5, "a triangle over three faces, 1e-6 from the light", grazed_light),
    HardCase::new(6, "a triangle seen edge-on, one inside a cell", edge_on_and_small),
    HardCase::new(7, "10,000 duplicates of one triangle", duplicates),
    HardCase::new(8, "a long slope with its nearest end before the point", long_slope),
    HardCase::new(9, "R = 1 to 2048", resolutions),
];

/// A sheet across a direction, on one side of a plane through the light.
struct HalfSheet {
    corners: [Vec3; 3],
    /// The plane's normal; the sheet lies where a point relative to the light has a product from 0 up with it.
    inwards: Vec3,
}

/// Half sheets at a distance of 1 from the light along some directions, and points behind each: on the border,
/// and one step off it.
fn behind_half_sheets(name: &str, light: Vec3, sheets: &[(Vec3, HalfSheet)]) -> Situation {
    let corners: Vec<_> = sheets.iter().map(|(_, sheet)| sheet.corners.map(|p| light + p)).collect();
    let (mut points, mut dark) = (Vec::new(), Vec::new());
    for (direction, sheet) in sheets {
        for far in [1.5f32, 2.0, 2.75, 100.0] {
            for point in neighbours(light + far * *direction) {
                let relative = point.as_dvec3() - light.as_dvec3();
                points.push(point);
                dark.push(relative.dot(sheet.inwards.as_dvec3()) >= 0.0);
            }
        }
    }
    Situation::new(name, triangles(&corners), light, bare(points), Expected::Known(dark))
}

/// The twelve directions (1, 1, 0) with their two components and the third axis.
fn twelve() -> impl Iterator<Item = (Vec3, Vec3, Vec3)> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    (0..3).flat_map(move |k| signs.map(|(s, t)| (s * axes[k], t * axes[(k + 1) % 3], axes[(k + 2) % 3])))
}

fn two_faces() -> Vec<Situation> {
    let sheet = |tip: Vec3, along: Vec3, direction: Vec3| HalfSheet {
        corners: [direction + 0.25 * along, direction - 0.25 * along, direction + 0.25 * tip],
        inwards: tip,
    };
    // The sheet ends at the border of the faces itself, or across it.
    let across: Vec<_> = twelve().map(|(a, b, third)| (a + b, sheet(-third, a - b, a + b))).collect();
    let along: Vec<_> = twelve().map(|(a, b, third)| (a + b, sheet(a - b, third, a + b))).collect();
    let before = twelve().flat_map(|(a, b, _)| neighbours(0.5 * (a + b))).collect::<Vec<_>>();
    let lit =
        Situation { points: bare(before), ..behind_half_sheets("before the sheets", Vec3::ZERO, &across) };
    let off = v(0.5, -0.25, 0.125);
    vec![
        behind_half_sheets("sheets that end across the border", Vec3::ZERO, &across),
        behind_half_sheets("sheets that end on the border", Vec3::ZERO, &along),
        behind_half_sheets("across, off the origin", off, &across),
        behind_half_sheets("on the border, off the origin", off, &along),
        Situation { expected: Expected::AllLit, ..lit },
    ]
}

/// The eight corners of the cube.
fn eight() -> impl Iterator<Item = Vec3> {
    (0..8).map(|i| Vec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { -1.0 } else { 1.0 })))
}

fn three_faces() -> Vec<Situation> {
    let half = |corner: Vec3, turn: usize| {
        // In the corner's own signs the sheet lies where the first coordinate is not below the second.
        let turned = |p: [f32; 3]| corner * v(p[turn % 3], p[(turn + 1) % 3], p[(turn + 2) % 3]);
        let (edge, tip) = (turned([0.125, 0.125, -0.25]), turned([0.25, -0.25, 0.0]));
        let corners = [corner + edge, corner - edge, corner + tip];
        (corner, HalfSheet { corners, inwards: turned([1.0, -1.0, 0.0]) })
    };
    let sheets = |turn: usize| eight().map(|corner| half(corner, turn)).collect::<Vec<_>>();
    let whole = |corner: Vec3| {
        let [a, b, c] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| corner * (0.5 * Vec3::ONE + 1.5 * axis));
        [a, b, c]
    };
    let closed: Vec<_> = eight().map(whole).collect();
    let far = eight().flat_map(|corner| [2.0, 3.0, 77.0].map(|far| far * corner)).flat_map(neighbours);
    let mut situations: Vec<_> =
        (0..3).map(|turn| behind_half_sheets("half sheets", Vec3::ZERO, &sheets(turn))).collect();
    situations.push(Situation::new(
        "behind whole sheets",
        triangles(&closed),
        Vec3::ZERO,
        bare(far),
        Expected::AllDark,
    ));
    situations
}

fn cell_borders() -> Vec<Situation> {
    let borders =
        [(1, vec![-1, 1]), (3, vec![-3, -1, 1]), (512, vec![-512, 0, 2, 510]), (4096, vec![-4096, 0, 4094])];
    borders.into_iter().flat_map(|(r, borders)| borders.into_iter().map(move |k| cell_border(r, k))).collect()
}

/// Sheets that end on the border x / z = k / R of cells, on all six faces.
fn cell_border(resolution: u32, border: i32) -> Situation {
    let (r, k) = (resolution as f32, border as f32);
    let (high, wide) = (0.25 * r.min(4.0), (0.25 * r).min(8.0));
    let face = |p: Vec3, turn: usize, side: f32| {
        let p = v(p.x, p.y, p.z * side);
        [p, v(p.z, p.x, p.y), v(p.y, p.z, p.x)][turn]
    };
    let (mut sheets, mut points, mut dark) = (Vec::new(), Vec::new(), Vec::new());
    for (turn, side) in (0..3).flat_map(|turn| [(turn, 1.0), (turn, -1.0)]) {
        let corners = [v(k, -high, r), v(k, high, r), v(k - wide, 0.0, r)];
        sheets.push(corners.map(|p| face(p, turn, side)));
        for (y, far) in [(0.0, 2.0), (0.5 * high, 2.0), (-0.5 * high, 4.0), (0.25 * high, 1.5)] {
            for x in [(k * far).next_down(), k * far, (k * far).next_up()] {
                points.push(face(v(x, y * far, r * far), turn, side));
                // Products of 24 bits each are exact.
                let (x, z) = (f64::from(x), f64::from(r * far));
                dark.push(x * f64::from(r) <= f64::from(k) * z);
            }
        }
    }
    let name = format!("x / z = {border} / {resolution}");
    Situation::new(name, triangles(&sheets), Vec3::ZERO, bare(points), Expected::Known(dark))
        .at_resolution(resolution)
}

fn axes() -> Vec<Situation> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let six = || (0..3).flat_map(|k| [(k, 1.0), (k, -1.0)]);
    let zeros = [0.0f32, -0.0, TINY, -TINY];
    let off_axis = move || zeros.into_iter().flat_map(move |a| zeros.map(|b| (a, b)));
    let point = |k: usize, along: f32, (a, b): (f32, f32)| {
        let mut p = Vec3::ZERO;
        (p[k], p[(k + 1) % 3], p[(k + 2) % 3]) = (along, a, b);
        p
    };
    // Four triangles that meet on the axis.
    let fan = |(k, side): (usize, f32)| {
        let (u, w, tip) = (0.25 * axes[(k + 1) % 3], 0.25 * axes[(k + 2) % 3], side * axes[k]);
        [[tip, tip + u, tip + w], [tip, tip + w, tip - u], [tip, tip - u, tip - w], [tip, tip - w, tip + u]]
    };
    let points = || six().flat_map(move |(k, side)| off_axis().map(move |off| point(k, 2.5 * side, off)));
    let half = |(k, side): (usize, f32)| {
        let (u, w, tip) = (0.25 * axes[(k + 1) % 3], 0.25 * axes[(k + 2) % 3], side * axes[k]);
        [tip + w, tip - w, tip - u]
    };
    let dark = six().flat_map(|_| off_axis().map(|(a, _)| a <= 0.0)).collect();
    let fans = triangles(&six().flat_map(fan).collect::<Vec<_>>());
    let halves = triangles(&six().map(half).collect::<Vec<_>>());
    vec![
        Situation::new(
            "four triangles that meet there",
            fans.clone(),
            Vec3::ZERO,
            bare(points()),
            Expected::AllDark,
        ),
        Situation::new(
            "the light at minus zero",
            fans,
            v(-0.0, 0.0, -0.0),
            bare(points()),
            Expected::AllDark,
        ),
        Situation::new("a sheet that ends there", halves, Vec3::ZERO, bare(points()), Expected::Known(dark)),
    ]
}

fn grazed_light() -> Vec<Situation> {
    let height = -1e-6f32;
    let sheet = triangles(&[[v(-100.0, height, -100.0), v(100.0, height, -100.0), v(0.0, height, 200.0)]]);
    let heights = [-2.0, -0.5, -1e-5, height.next_down(), height, height.next_up(), 0.0, 1e-6, 3.0];
    let (mut points, mut dark) = (Vec::new(), Vec::new());
    for (x, z) in steps(-4, 4).flat_map(|x| steps(-4, 4).map(move |z| (x, z))) {
        for y in heights {
            points.push(v(x, y, z));
            dark.push(y < height);
        }
    }
    vec![Situation::new("a sheet below the light", sheet, Vec3::ZERO, bare(points), Expected::Known(dark))]
}

fn edge_on_and_small() -> Vec<Situation> {
    let edge_on = [
        [v(1.0, 0.0, -1.0), v(1.0, 0.0, 1.0), v(3.0, 0.0, 0.0)],
        [v(0.0, 1.0, 1.0), v(0.0, 2.0, 2.0), v(0.0, 3.0, 1.0)],
    ];
    let around = || steps(-6, 6).flat_map(|x| steps(-6, 6).map(move |z| v(x, 0.0, 0.5 * z)));
    let across = || around().map(|p| v(p.y, 0.75 * p.x, 0.75 * p.x + 0.25 * p.z));
    let points = bare(around().chain(across()).flat_map(|p| [p, p + v(TINY, TINY, 0.0)]));
    let small = |at: Vec3| [at, at + v(1e-4, 0.0, 0.0), at + v(0.0, 0.0, 1e-4)];
    let at = v(0.3, -1.0, 0.2);
    let (mut below, mut dark) = (Vec::new(), Vec::new());
    for (x, z, inside) in [
        (2.5e-5, 2.5e-5, true),
        (5e-5, 2.5e-5, true),
        (-1e-5, 2.5e-5, false),
        (8e-5, 8e-5, false),
        (5e-5, -1e-5, false),
        (1e-2, 0.0, false),
    ] {
        below.push(3.0 * (at + v(x, 0.0, z)));
        dark.push(inside);
    }
    vec![
        Situation::new(
            "planes that hold the light",
            triangles(&edge_on),
            Vec3::ZERO,
            points,
            Expected::AllLit,
        ),
        Situation::new("1e-4 wide", triangles(&[small(at)]), Vec3::ZERO, bare(below), Expected::Known(dark)),
    ]
}

fn duplicates() -> Vec<Situation> {
    let [a, b, c] = [v(-1.0, 1.0, -1.0), v(1.0, 1.0, -1.0), v(0.0, 1.0, 1.0)];
    let orders = [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]];
    let all: Vec<_> = (0..10_000).map(|i| orders[i % 6]).collect();
    let grid = || steps(-3, 3).flat_map(|x| steps(-3, 3).map(move |z| v(x, 0.0, z)));
    // The shadow is the triangle twice as large: its sides run from (+-2, -2) to (0, 2).
    let dark = grid().map(|p| p.z >= -2.0 && p.z <= 2.0 - 2.0 * p.x.abs()).collect();
    let light = v(0.0, 2.0, 0.0);
    let dark = Expected::Known(dark);
    vec![Situation::new("one shadow", triangles(&all), light, bare(grid()), dark)]
}

fn long_slope() -> Vec<Situation> {
    let slope = triangles(&[[v(-4.0, 9.0, -3.0), v(-4.0, 9.0, 3.0), v(12.0, -15.0, 0.0)]]);
    let plane = |x: f32| 3.0 - 1.5 * x;
    let (mut points, mut dark) = (Vec::new(), Vec::new());
    for x in [0.0, 1.0, 2.0, 4.0, 8.0, 10.0] {
        let on = plane(x);
        let around = [on - 2.0, on - 0.01, on.next_down(), on, on.next_up(), on + 0.01, on + 0.5];
        for y in around {
            points.push(v(x, y, 0.0));
            dark.push(y < on);
        }
    }
    vec![Situation::new("both sides of it", slope, v(0.0, 10.0, 0.0), bare(points), Expected::Known(dark))]
}

/// The same picture from many resolutions.
fn resolutions() -> Vec<Situation> {
    const CELLS: [u32; 12] = [1, 2, 3, 5, 10, 32, 100, 127, 256, 512, 1000, 2048];
    let scene = soup(&still_life());
    let eye = v(2.3, 2.7, 4.1);
    let points = seen(&scene, eye, still_points());
    let at = |(i, &cells): (usize, &u32)| {
        let expected = if i == 0 { Expected::AsTruth } else { Expected::SameAs(0) };
        // High above, so that the scene takes part of one face.
        let light = STILL_LIGHT * 4.0;
        let name = format!("R = {cells}");
        Situation::new(name, scene.clone(), light, points.clone(), expected).at_resolution(cells)
    };
    let mut situations: Vec<_> = CELLS.iter().enumerate().map(at).collect();
    // Below a lid, and below the corner that four cells share.
    let lidded = soup(&[lid(1.0, 1.0), square(3.0, 0.0)]);
    let under = bare(steps(-4, 4).flat_map(|x| steps(-4, 4).map(move |z| v(x, 0.0, z) * 0.125)));
    situations.extend([1, 2, 64, 2048].map(|cells| {
        Situation::new("under a lid", lidded.clone(), v(0.0, 2.0, 0.0), under.clone(), Expected::AllDark)
            .at_resolution(cells)
    }));
    situations
}
