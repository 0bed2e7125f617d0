//! A child's blocks: a stack, an arch, steps, an octahedron on its tip, and a railing of thin slats. Faces
//! are polygons as a modeller leaves them, some of them concave.

use std::f64::consts::PI;
use std::fmt::Write;

/// The material library, `blocks.mtl`.
pub const MATERIALS: &str = "\
# The lightbuffer authors, MIT OR Apache-2.0
newmtl red
Kd 0.62 0.13 0.10
Ks 0.20 0.20 0.20
Ns 40
newmtl blue
Kd 0.11 0.24 0.52
Ks 0.20 0.20 0.20
Ns 40
newmtl yellow
Kd 0.78 0.58 0.12
Ks 0.20 0.20 0.20
Ns 40
newmtl green
Kd 0.16 0.42 0.20
Ks 0.20 0.20 0.20
Ns 40
newmtl wood
Kd 0.55 0.38 0.22
Ks 0.05 0.05 0.05
Ns 10
newmtl glass
Kd 0.30 0.55 0.58
Ks 0.80 0.80 0.80
Ns 200
";

/// The scene, `blocks.obj`.
pub fn obj() -> String {
    let mut file = Obj::default();
    file.text.push_str("# The lightbuffer authors, MIT OR Apache-2.0\nmtllib blocks.mtl\n");

    for (row, (count, colour)) in
        [(4, "red"), (3, "yellow"), (2, "blue"), (1, "green")].into_iter().enumerate()
    {
        for index in 0..count {
            let x = -2.4 + 1.12 * (index as f64 - 0.5 * (count as f64 - 1.0));
            let turn = 0.11 * (index * 7 + row * 5 + 3) as f64 % 0.5 - 0.25;
            file.object(&format!("block-{}-{}", row + 1, index + 1), colour);
            let square = [[-0.45, -0.45], [0.45, -0.45], [0.45, 0.45], [-0.45, 0.45]];
            let base = 0.9 * row as f64;
            file.prism(&square, base, base + 0.9, |[u, h, v]| turned([u, h, v], turn, [x, 0.0, -0.6]));
        }
    }

    // The outline of an arch, drawn upright and then given its depth.
    file.object("arch", "wood");
    let mut outline = vec![[1.5, 0.0], [1.5, 1.4]];
    outline.extend((1..24).map(|i| half_circle(1.5, PI * f64::from(i) / 24.0)));
    outline.extend([[-1.5, 1.4], [-1.5, 0.0], [-0.9, 0.0], [-0.9, 1.4]]);
    outline.extend((1..24).map(|i| half_circle(0.9, PI - PI * f64::from(i) / 24.0)));
    outline.extend([[0.9, 1.4], [0.9, 0.0]]);
    file.prism(&outline, -0.35, 0.35, |[u, h, v]| turned([u, v, h], 0.35, [1.9, 0.0, -1.2]));

    file.object("steps", "blue");
    let steps = [
        [0.0, 0.0],
        [1.6, 0.0],
        [1.6, 0.4],
        [1.2, 0.4],
        [1.2, 0.8],
        [0.8, 0.8],
        [0.8, 1.2],
        [0.4, 1.2],
        [0.4, 1.6],
        [0.0, 1.6],
    ];
    file.prism(&steps, 0.0, 1.1, |[u, h, v]| turned([u, v, h], -0.4, [3.2, 0.0, 0.6]));

    file.object("cross", "yellow");
    let cross = [
        [0.25, 0.75],
        [0.25, 0.25],
        [0.75, 0.25],
        [0.75, -0.25],
        [0.25, -0.25],
        [0.25, -0.75],
        [-0.25, -0.75],
        [-0.25, -0.25],
        [-0.75, -0.25],
        [-0.75, 0.25],
        [-0.25, 0.25],
        [-0.25, 0.75],
    ];
    file.prism(&cross, 0.0, 0.4, |p| turned(p, 0.2, [0.4, 0.0, 1.4]));

    file.object("octahedron", "glass");
    let tips = [
        [0.7, 0.0, 0.0],
        [0.0, 0.0, 0.7],
        [-0.7, 0.0, 0.0],
        [0.0, 0.0, -0.7],
        [0.0, 0.95, 0.0],
        [0.0, -0.95, 0.0],
    ];
    let first = file.points(tips.iter().map(|&p| turned(p, 0.6, [0.4, 1.35, 1.4])));
    for side in 0..4 {
        let next = (side + 1) % 4;
        file.face([first + 4, first + next, first + side]);
        file.face([first + 5, first + side, first + next]);
    }

    file.object("railing", "wood");
    let mut rail = |low: [f64; 2], high: [f64; 2], bottom: f64, top: f64| {
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
        file.prism(&corners, bottom, top, |p| turned(p, 0.15, [-1.6, 0.0, 1.9]));
    };
    rail([-1.75, -0.06], [-1.63, 0.06], 0.0, 1.25);
    rail([1.63, -0.06], [1.75, 0.06], 0.0, 1.25);
    rail([-1.7, -0.04], [1.7, 0.04], 0.16, 0.24);
    rail([-1.7, -0.04], [1.7, 0.04], 1.06, 1.14);
    for slat in 0..22 {
        let x = -1.55 + 3.1 * f64::from(slat) / 21.0;
        rail([x - 0.014, -0.02], [x + 0.014, 0.02], 0.2, 1.1);
    }
    file.text
}

fn half_circle(radius: f64, angle: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(angle);
    [radius * cos, 1.4 + radius * sin]
}

/// Turns about y, then moves.
fn turned([x, y, z]: [f64; 3], angle: f64, by: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = libm::sincos(angle);
    [x * cos + z * sin + by[0], y + by[1], z * cos - x * sin + by[2]]
}

/// OBJ text that grows.
#[derive(Default)]
struct Obj {
    text: String,
    count: usize,
}

impl Obj {
    fn object(&mut self, name: &str, material: &str) {
        self.text.push_str(&format!("o {name}\nusemtl {material}\n"));
    }

    /// Writes points and returns the number of the first.
    fn points(&mut self, points: impl Iterator<Item = [f64; 3]>) -> usize {
        let first = self.count + 1;
        for [x, y, z] in points {
            writeln!(self.text, "v {x:.5} {y:.5} {z:.5}").expect("a string takes everything");
            self.count += 1;
        }
        first
    }

    fn face(&mut self, corners: impl IntoIterator<Item = usize>) {
        self.text.push('f');
        corners.into_iter().for_each(|corner| self.text.push_str(&format!(" {corner}")));
        self.text.push('\n');
    }

    /// An outline in (u, v) between two heights h; `place` puts (u, h, v) into the world.
    fn prism(&mut self, outline: &[[f64; 2]], low: f64, high: f64, place: impl Fn([f64; 3]) -> [f64; 3]) {
        let count = outline.len();
        let level = |h: f64| outline.iter().map(move |&[u, v]| [u, h, v]);
        let points: Vec<[f64; 3]> = level(low).chain(level(high)).map(place).collect();
        let first = self.points(points.iter().copied());
        // Outwards whichever way round the outline is drawn and the placement turns it.
        let side = |i: usize| [i, (i + 1) % count, (i + 1) % count + count, i + count];
        let mut faces: Vec<Vec<usize>> = (0..count).map(|i| side(i).to_vec()).collect();
        faces.push((0..count).rev().collect());
        faces.push((count..2 * count).collect());
        let inside_out = volume(&points, &faces) < 0.0;
        for mut corners in faces {
            if inside_out {
                corners.reverse();
            }
            self.face(corners.into_iter().map(|corner| first + corner));
        }
    }
}

/// Six times the volume that polygons enclose.
fn volume(points: &[[f64; 3]], faces: &[Vec<usize>]) -> f64 {
    use super::solid::{cross, dot};
    let fan = |face: &Vec<usize>| -> f64 {
        (1..face.len() - 1).map(|i| dot(points[face[0]], cross(points[face[i]], points[face[i + 1]]))).sum()
    };
    faces.iter().map(fan).sum()
}
