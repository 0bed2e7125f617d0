//! A round courtyard: fluted columns and arches around a bronze knot, urns and balls on the steps.

use super::glb::Writer;
use super::solid::{Point, Profile, Solid, smooth};
use std::f64::consts::{PI, TAU};

/// Columns, and arches between them.
const COLUMNS: usize = 16;
/// Where their axes stand.
const COLUMN_RADIUS: f64 = 9.2;
/// The floor of the walk behind the columns.
const WALK: f64 = 0.45;
/// Where arches spring from the capitals.
const SPRING: f64 = WALK + 4.5;

pub fn glb() -> Vec<u8> {
    let mut writer = Writer::default();
    add_building(&mut writer);
    add_colonnade(&mut writer);
    add_pavement(&mut writer);
    add_ornaments(&mut writer);
    writer.camera("view", [0.35, 3.5, 8.3], [0.0, 1.95, 0.0], 46.0 * PI / 180.0);
    writer.light("key", [-4.4, 6.1, 0.9], [1.0, 0.85, 0.66], 190.0);
    writer.light("fill", [4.6, 3.4, 5.2], [0.62, 0.76, 1.0], 48.0);
    writer.finish("The lightbuffer authors, MIT OR Apache-2.0")
}

/// The point at an angle and a radius around the centre. Nodes turned by `-angle` face outwards there.
fn around(angle: f64, radius: f64, height: f64) -> Point {
    let (sin, cos) = libm::sincos(angle);
    [radius * cos, height, radius * sin]
}

/// The angle of place `index` of `count`, so that nothing stands right in front of the camera.
fn place(index: usize, count: usize) -> f64 {
    TAU * (index as f64 + 0.5) / count as f64
}

const UNSCALED: Point = [1.0; 3];

fn add_building(writer: &mut Writer) {
    let ground = writer.material("ground", [0.23, 0.21, 0.19], 0.0, 1.0);
    let limestone = writer.material("limestone", [0.73, 0.66, 0.54], 0.0, 0.8);
    let plaster = writer.material("plaster", [0.70, 0.52, 0.38], 0.0, 1.0);
    let oak = writer.material("oak", [0.34, 0.21, 0.12], 0.0, 0.7);
    let ring = |profile: &[[f64; 2]]| Solid::turned(profile, Profile::Loop, 64);

    let bed = [[0.0, -0.5], [12.4, -0.5], [12.4, -0.04], [0.0, -0.04]];
    let bed = Solid::turned(&bed, Profile::AxisToAxis, 64);
    let steps = ring(&[
        [7.15, -0.3],
        [7.15, 0.15],
        [7.5, 0.15],
        [7.5, 0.3],
        [7.85, 0.3],
        [7.85, WALK],
        [12.2, WALK],
        [12.2, -0.3],
    ]);
    let wall =
        ring(&[[11.5, WALK - 0.1], [11.5, 6.9], [11.38, 7.0], [11.38, 7.3], [12.1, 7.3], [12.1, WALK - 0.1]]);
    let beam = ring(&[
        [8.85, 6.7],
        [8.85, 7.0],
        [8.78, 7.0],
        [8.78, 7.2],
        [8.66, 7.32],
        [9.74, 7.32],
        [9.62, 7.2],
        [9.62, 7.0],
        [9.55, 7.0],
        [9.55, 6.7],
    ]);
    for (name, solid, material) in [
        ("bed", bed, ground),
        ("steps", steps, limestone),
        ("wall", wall, plaster),
        ("beam", beam, limestone),
    ] {
        let mesh = writer.mesh(name, &[(&solid, material)]);
        writer.show(name, mesh);
    }
    // Rafters lie on the beam and on the wall, and are let into both a little.
    let rafter = Solid::cuboid([8.4, 7.29, -0.07], [12.0, 7.5, 0.07]);
    let mesh = writer.mesh("rafter", &[(&rafter, oak)]);
    for index in 0..72 {
        writer.show_at(&format!("rafter {}", index + 1), mesh, -place(index, 72), UNSCALED, [0.0; 3]);
    }
}

fn add_colonnade(writer: &mut Writer) {
    let marble = writer.material("marble", [0.84, 0.81, 0.75], 0.0, 0.5);
    let sandstone = writer.material("sandstone", [0.74, 0.60, 0.43], 0.0, 0.9);
    let column = writer.mesh("column", &[(&column(), marble)]);
    let arch = writer.mesh("arch", &[(&arch(), sandstone)]);
    for index in 0..COLUMNS {
        let angle = place(index, COLUMNS);
        let foot = around(angle, COLUMN_RADIUS, WALK);
        writer.show_at(&format!("column {}", index + 1), column, -angle, UNSCALED, foot);
        // The arch stands on the chord to the next column.
        let middle = angle + PI / COLUMNS as f64;
        let chord = COLUMN_RADIUS * libm::cos(PI / COLUMNS as f64);
        let spring = around(middle, chord, SPRING);
        writer.show_at(&format!("arch {}", index + 1), arch, -middle, UNSCALED, spring);
    }
}

/// A column of 4.5 metres: plinth, base, fluted shaft, capital and abacus, each let into the next.
fn column() -> Solid {
    let base = smooth(
        &[
            [0.44, 0.14],
            [0.47, 0.19],
            [0.43, 0.25],
            [0.38, 0.28],
            [0.37, 0.33],
            [0.41, 0.37],
            [0.39, 0.42],
            [0.35, 0.46],
        ],
        2,
    );
    let capital = smooth(
        &[[0.29, 4.0], [0.31, 4.03], [0.3, 4.07], [0.32, 4.14], [0.38, 4.23], [0.42, 4.3], [0.41, 4.39]],
        2,
    );
    let turned = |mut profile: Vec<[f64; 2]>| {
        let (first, last) = (profile[0][1], profile[profile.len() - 1][1]);
        profile.insert(0, [0.0, first]);
        profile.push([0.0, last]);
        Solid::turned(&profile, Profile::AxisToAxis, 36)
    };
    Solid::cuboid([-0.48, -0.02, -0.48], [0.48, 0.15, 0.48])
        .with(&turned(base))
        .with(&shaft())
        .with(&turned(capital))
        .with(&Solid::cuboid([-0.45, 4.37, -0.45], [0.45, 4.51, 0.45]))
}

/// Twenty flutes on a shaft that swells a little before it tapers.
fn shaft() -> Solid {
    const FLUTES: usize = 20;
    const FACETS: usize = 5;
    const RINGS: usize = 11;
    let mut profile = vec![[0.0, 0.44]];
    for ring in 0..=RINGS {
        let t = ring as f64 / RINGS as f64;
        profile.push([0.345 - 0.035 * t * t - 0.02 * t * t * t, 0.44 + 3.58 * t]);
    }
    profile.push([0.0, 4.02]);
    Solid::turned_with(&profile, Profile::AxisToAxis, FLUTES * FACETS, |step, radius| {
        let across = (step % FACETS) as f64 / FACETS as f64;
        radius * (1.0 - 0.075 * libm::sin(PI * across))
    })
}

/// Half a ring that spans two columns along z, its springing line through the origin.
fn arch() -> Solid {
    const VOUSSOIRS: usize = 28;
    let section = [[1.34, -0.3], [1.34, 0.3], [1.788, 0.3], [1.788, -0.3]];
    let mut solid = Solid::default();
    for step in 0..=VOUSSOIRS {
        let (sin, cos) = libm::sincos(PI * step as f64 / VOUSSOIRS as f64);
        // The feet are let into the abacus.
        let sunk = if step == 0 || step == VOUSSOIRS { 0.03 } else { 0.0 };
        solid.points.extend(section.map(|[radius, depth]| [depth, radius * sin - sunk, radius * cos]));
    }
    let mut quad = |[a, b, c, d]: [usize; 4]| solid.triangles.extend([[a, b, c], [a, c, d]]);
    for step in 0..VOUSSOIRS {
        for side in 0..4 {
            let (near, far) = (step * 4 + side, step * 4 + (side + 1) % 4);
            quad([near, far, far + 4, near + 4]);
        }
    }
    let end = VOUSSOIRS * 4;
    quad([3, 2, 1, 0]);
    quad([end, end + 1, end + 2, end + 3]);
    solid.outward()
}

fn add_pavement(writer: &mut Writer) {
    const SECTORS: usize = 40;
    let pale = writer.material("pale paving", [0.62, 0.56, 0.46], 0.0, 0.8);
    let dark = writer.material("dark paving", [0.30, 0.32, 0.34], 0.0, 0.6);
    let (mut even, mut odd) = (Solid::default(), Solid::default());
    for ring in 0..10 {
        let inner = 1.75 + 0.535 * ring as f64;
        let slab = slab(inner + 0.012, inner + 0.523, PI / SECTORS as f64);
        if ring % 3 == 1 {
            odd = odd.with(&slab);
        } else {
            even = even.with(&slab);
        }
    }
    let mesh = writer.mesh("paving", &[(&even, pale), (&odd, dark)]);
    for index in 0..SECTORS {
        writer.show_at(&format!("paving {}", index + 1), mesh, -place(index, SECTORS), UNSCALED, [0.0; 3]);
    }
}

/// A paving stone between two radii and two angles, with bevelled upper edges and its top at height 0.
fn slab(inner: f64, outer: f64, half_angle: f64) -> Solid {
    let tangent = libm::tan(half_angle);
    let outline = |inset: f64, height: f64| {
        let (low, high) = (inner + inset, outer - inset);
        let half = |radius: f64| radius * tangent - 0.012 - inset;
        [
            [low, height, -half(low)],
            [high, height, -half(high)],
            [high, height, half(high)],
            [low, height, half(low)],
        ]
    };
    let levels = [outline(0.0, -0.12), outline(0.0, -0.018), outline(0.018, 0.0)];
    let mut solid =
        Solid { points: levels.concat(), triangles: vec![[0, 1, 2], [0, 2, 3], [8, 10, 9], [8, 11, 10]] };
    for level in [0, 4] {
        for side in 0..4 {
            let (near, far) = (level + side, level + (side + 1) % 4);
            solid.triangles.extend([[near, near + 4, far + 4], [near, far + 4, far]]);
        }
    }
    solid.outward()
}

fn add_ornaments(writer: &mut Writer) {
    let granite = writer.material("granite", [0.47, 0.44, 0.42], 0.0, 0.55);
    let bronze = writer.material("bronze", [0.64, 0.40, 0.18], 0.9, 0.42);
    let terracotta = writer.material("terracotta", [0.62, 0.28, 0.16], 0.0, 0.75);
    let glaze = writer.material("glaze", [0.06, 0.27, 0.30], 0.0, 0.28);

    let pedestal = [
        [0.0, -0.1],
        [1.5, -0.1],
        [1.5, 0.16],
        [1.2, 0.16],
        [1.2, 0.32],
        [0.82, 0.36],
        [0.72, 0.46],
        [0.68, 1.2],
        [0.76, 1.26],
        [0.86, 1.3],
        [0.86, 1.42],
        [0.0, 1.42],
    ];
    let pedestal = writer.mesh("pedestal", &[(&Solid::turned(&pedestal, Profile::AxisToAxis, 48), granite)]);
    writer.show("pedestal", pedestal);
    let knot = writer.mesh("knot", &[(&knot(), bronze)]);
    writer.show_at("knot", knot, 0.5, UNSCALED, [0.0, 2.78, 0.0]);

    let block = Solid::cuboid([-0.34, -0.3, -0.34], [0.34, 0.62, 0.34]);
    let block = writer.mesh("block", &[(&block, granite)]);
    let urn = writer.mesh("urn", &[(&urn(), terracotta)]);
    let ball = writer.mesh("ball", &[(&Solid::ball(16, 28), glaze)]);
    for index in 0..16 {
        let angle = TAU * index as f64 / 16.0;
        // The camera looks in between two of them.
        if index == 4 {
            continue;
        }
        let name = |what: &str| format!("{what} {}", index + 1);
        let foot = around(angle, 6.55, 0.0);
        writer.show_at(&name("block"), block, -angle, UNSCALED, foot);
        if index % 2 == 1 {
            let size = if index % 4 == 1 { 1.0 } else { 0.86 };
            writer.show_at(&name("urn"), urn, -angle, [size; 3], [foot[0], 0.6, foot[2]]);
        } else {
            let size = if index % 4 == 0 { 0.4 } else { 0.31 };
            writer.show_at(&name("ball"), ball, -angle, [size; 3], [foot[0], 0.6 + size, foot[2]]);
        }
    }
}

/// A trefoil about 2.4 metres across, standing upright.
fn knot() -> Solid {
    let curve = |t: f64| {
        let (sin_long, cos_long) = libm::sincos(2.0 * TAU * t);
        let (sin_short, cos_short) = libm::sincos(3.0 * TAU * t);
        let radius = 0.78 + 0.32 * cos_short;
        [radius * cos_long, radius * sin_long, 0.36 * sin_short]
    };
    Solid::tube(curve, 0.17, 14, 136)
}

/// An urn 1.1 metres high with a hollow mouth.
fn urn() -> Solid {
    let outline = [
        [0.23, 0.0],
        [0.24, 0.06],
        [0.13, 0.12],
        [0.11, 0.18],
        [0.2, 0.28],
        [0.34, 0.48],
        [0.39, 0.68],
        [0.33, 0.86],
        [0.22, 0.95],
        [0.24, 1.03],
        [0.32, 1.08],
        [0.29, 1.1],
        [0.2, 1.0],
        [0.19, 0.92],
        [0.29, 0.78],
        [0.31, 0.62],
        [0.12, 0.4],
    ];
    let mut profile = smooth(&outline, 2);
    profile.insert(0, [0.0, 0.0]);
    profile.push([0.0, 0.38]);
    Solid::turned(&profile, Profile::AxisToAxis, 28)
}
