//! The six kinds of men, turned in twelve steps and standing on their felts.

use super::FELT;
use crate::scene::procedural::shapes::{Caps, Mesh, bevelled_prism, cuboid, lathe, moved, prism};
use crate::scene::procedural::shapes::{turned_x, turned_y};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A kind of man.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Man {
    King,
    Queen,
    Rook,
    Bishop,
    Knight,
    Pawn,
}

const STEPS: usize = 12;

const PAWN: [[f64; 2]; 10] = [
    [0.34, FELT],
    [0.34, 0.12],
    [0.28, 0.19],
    [0.16, 0.32],
    [0.11, 0.54],
    [0.21, 0.585],
    [0.12, 0.64],
    [0.2, 0.74],
    [0.19, 0.86],
    [0.08, 0.95],
];

const ROOK: [[f64; 2]; 9] = [
    [0.36, FELT],
    [0.36, 0.14],
    [0.31, 0.18],
    [0.3, 0.24],
    [0.22, 0.36],
    [0.19, 0.82],
    [0.29, 0.9],
    [0.29, 1.03],
    [0.2, 1.02],
];

/// The knight's foot; the head stands on it.
const KNIGHT: [[f64; 2]; 6] =
    [[0.36, FELT], [0.36, 0.14], [0.31, 0.18], [0.3, 0.24], [0.26, 0.31], [0.23, 0.36]];

const BISHOP: [[f64; 2]; 12] = [
    [0.36, FELT],
    [0.36, 0.13],
    [0.3, 0.2],
    [0.18, 0.33],
    [0.12, 0.74],
    [0.23, 0.79],
    [0.13, 0.85],
    [0.2, 0.98],
    [0.18, 1.12],
    [0.055, 1.29],
    [0.085, 1.34],
    [0.04, 1.41],
];

const QUEEN: [[f64; 2]; 13] = [
    [0.38, FELT],
    [0.38, 0.14],
    [0.33, 0.21],
    [0.21, 0.38],
    [0.13, 0.94],
    [0.25, 1.0],
    [0.15, 1.06],
    [0.15, 1.14],
    [0.26, 1.42],
    [0.19, 1.43],
    [0.07, 1.49],
    [0.095, 1.55],
    [0.045, 1.61],
];

const KING: [[f64; 2]; 13] = [
    [0.39, FELT],
    [0.39, 0.14],
    [0.34, 0.21],
    [0.22, 0.4],
    [0.14, 1.02],
    [0.26, 1.08],
    [0.16, 1.14],
    [0.16, 1.24],
    [0.25, 1.5],
    [0.22, 1.53],
    [0.12, 1.58],
    [0.09, 1.6],
    [0.06, 1.64],
];

/// The knight's head from the side, looking to the right.
const HEAD: [[f64; 2]; 24] = [
    [0.2, 0.34],
    [0.24, 0.48],
    [0.2, 0.62],
    [0.12, 0.76],
    [0.21, 0.75],
    [0.32, 0.68],
    [0.4, 0.69],
    [0.44, 0.77],
    [0.41, 0.87],
    [0.3, 0.99],
    [0.21, 1.1],
    [0.16, 1.2],
    [0.13, 1.35],
    [0.05, 1.23],
    [-0.05, 1.24],
    [-0.14, 1.17],
    [-0.21, 1.05],
    [-0.26, 0.91],
    [-0.28, 0.77],
    [-0.27, 0.63],
    [-0.24, 0.51],
    [-0.22, 0.42],
    [-0.21, 0.34],
    [0.0, 0.33],
];

/// The king's cross from the front.
const CROSS: [[f64; 2]; 12] = [
    [-0.05, 1.63],
    [0.05, 1.63],
    [0.035, 1.75],
    [0.12, 1.74],
    [0.12, 1.83],
    [0.035, 1.82],
    [0.05, 1.92],
    [-0.05, 1.92],
    [-0.035, 1.82],
    [-0.12, 1.83],
    [-0.12, 1.74],
    [-0.035, 1.75],
];

impl Man {
    /// The man of a letter of English notation, in either case.
    pub fn of(letter: char) -> Option<Man> {
        Some(match letter.to_ascii_lowercase() {
            'k' => Man::King,
            'q' => Man::Queen,
            'r' => Man::Rook,
            'b' => Man::Bishop,
            'n' => Man::Knight,
            'p' => Man::Pawn,
            _ => return None,
        })
    }

    pub fn name(self) -> &'static str {
        match self {
            Man::King => "king",
            Man::Queen => "queen",
            Man::Rook => "rook",
            Man::Bishop => "bishop",
            Man::Knight => "knight",
            Man::Pawn => "pawn",
        }
    }

    fn profile(self) -> &'static [[f64; 2]] {
        match self {
            Man::King => &KING,
            Man::Queen => &QUEEN,
            Man::Rook => &ROOK,
            Man::Bishop => &BISHOP,
            Man::Knight => &KNIGHT,
            Man::Pawn => &PAWN,
        }
    }

    pub fn base_radius(self) -> f64 {
        self.profile()[0][0]
    }

    /// The whole man, looking along x.
    pub fn body(self) -> Mesh {
        let turned = lathe(self.profile(), STEPS, Caps::Flat).smooth_up_to(58.0);
        match self {
            Man::King => turned.with(&upright(prism(&CROSS, -0.035, 0.035))),
            Man::Queen => (0..8).fold(turned, |queen, point| queen.with(&crown_point(point))),
            Man::Rook => (0..6).fold(turned, |rook, number| rook.with(&merlon(number))),
            Man::Knight => turned.with(&head()),
            Man::Bishop | Man::Pawn => turned,
        }
    }
}

/// What lies on its back, stood up: its outline faces along z.
fn upright(mesh: Mesh) -> Mesh {
    mesh.placed(&turned_x(FRAC_PI_2))
}

/// The head, thinner towards its flanks; scaled about its middle so that every slice of it is an outline that
/// does not cross itself.
fn head() -> Mesh {
    const MIDDLE: [f64; 2] = [0.02, 0.74];
    let outline = HEAD.map(|[x, y]| [x - MIDDLE[0], y - MIDDLE[1]]);
    let levels = [[-0.14, 0.82], [-0.075, 1.0], [0.075, 1.0], [0.14, 0.82]];
    upright(bevelled_prism(&outline, &levels)).placed(&moved(MIDDLE[0], MIDDLE[1], 0.0))
}

/// One of the queen's eight points: a tetrahedron.
fn crown_point(number: usize) -> Mesh {
    let corners = [[0.17, 1.4, -0.07], [0.17, 1.4, 0.07], [0.27, 1.41, 0.0], [0.29, 1.56, 0.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    Mesh::new(corners.map(DVec3::from).to_vec(), faces.map(|face| face.to_vec()).to_vec())
        .inside_out()
        .placed(&turned_y(TAU * number as f64 / 8.0))
}

/// One of the six stones of the rook's battlement.
fn merlon(number: usize) -> Mesh {
    cuboid([0.19, 1.0, -0.085], [0.285, 1.15, 0.085]).placed(&turned_y(TAU * number as f64 / 6.0))
}
