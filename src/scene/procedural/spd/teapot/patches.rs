//! The control points of the teapot (Newell, 1975): what is round by its profile, handle and spout by one half.

use glam::DVec3;

/// Four rows of four control points.
pub(super) struct Patch {
    pub points: [[DVec3; 4]; 4],
}

/// Radius and height of four control points.
type Profile = [[f64; 2]; 4];

const RIM: Profile = [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]];
const BODY: [Profile; 2] = [
    [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]],
];
const LID: [Profile; 2] =
    [[[0.0, 3.15], [0.8, 3.15], [0.0, 2.85], [0.2, 2.7]], [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]]];
const BOTTOM: Profile = [[0.0, 0.0], [1.425, 0.0], [1.5, 0.075], [1.5, 0.15]];

/// Rows of a patch that reaches from the plane y = 0 to y = 0: x and z of the inner and the outer edge, and
/// how wide the row is.
type Half = [([f64; 2], [f64; 2], f64); 4];

const HANDLE: [Half; 2] = [
    [
        ([-1.6, 2.025], [-1.5, 2.25], 0.3),
        ([-2.3, 2.025], [-2.5, 2.25], 0.3),
        ([-2.7, 2.025], [-3.0, 2.25], 0.3),
        ([-2.7, 1.8], [-3.0, 1.8], 0.3),
    ],
    [
        ([-2.7, 1.8], [-3.0, 1.8], 0.3),
        ([-2.7, 1.575], [-3.0, 1.35], 0.3),
        ([-2.5, 1.125], [-2.65, 0.9375], 0.3),
        ([-2.0, 0.9], [-1.9, 0.6], 0.3),
    ],
];

const SPOUT: [Half; 2] = [
    [
        ([1.7, 1.425], [1.7, 0.6], 0.66),
        ([2.6, 1.425], [3.1, 0.825], 0.66),
        ([2.3, 2.1], [2.4, 2.025], 0.25),
        ([2.7, 2.4], [3.3, 2.4], 0.25),
    ],
    [
        ([2.7, 2.4], [3.3, 2.4], 0.25),
        ([2.8, 2.475], [3.525, 2.49375], 0.25),
        ([2.9, 2.475], [3.45, 2.5125], 0.15),
        ([2.8, 2.4], [3.2, 2.4], 0.15),
    ],
];

/// All 32 patches by the parts of the pot.
pub(super) fn patches() -> [(&'static str, Vec<Patch>); 6] {
    let around =
        |profiles: &[Profile]| profiles.iter().flat_map(|p| (0..4).map(move |q| quarter(p, q))).collect();
    let both = |halves: &[Half]| halves.iter().flat_map(|h| [-1.0, 1.0].map(|side| half(h, side))).collect();
    [
        ("rim", around(&[RIM])),
        ("body", around(&BODY)),
        ("lid", around(&LID)),
        ("bottom", around(&[BOTTOM])),
        ("handle", both(&HANDLE)),
        ("spout", both(&SPOUT)),
    ]
}

/// A profile turned by a quarter: nearly round, for a cubic's inner points stand off by 0.56 of the radius.
fn quarter(profile: &Profile, number: usize) -> Patch {
    let points = profile.map(|[radius, height]| {
        // Of the lid's knob one number was published rounded.
        let off = if radius == 0.8 { 0.45 } else { 0.56 * radius };
        [[radius, 0.0], [radius, -off], [off, -radius], [0.0, -radius]].map(|[x, y]| {
            let [x, y] = [[x, y], [y, -x], [-x, -y], [-y, x]][number];
            DVec3::new(x, y, height)
        })
    });
    Patch { points }
}

/// One side of the handle or of the spout.
fn half(rows: &Half, side: f64) -> Patch {
    let points = rows.map(|([x0, z0], [x1, z1], wide)| {
        let y = side * wide;
        [DVec3::new(x0, 0.0, z0), DVec3::new(x0, y, z0), DVec3::new(x1, y, z1), DVec3::new(x1, 0.0, z1)]
    });
    Patch { points }
}
