//! Figure 5, "Chessboard": 132 objects of 4944 polygons under four lights.
//!
//! The Giuoco Pianissimo after four moves, when all men are still there. 64 squares, 32 men and as many felts
//! under them, and a board with its frame, an inlay of brass and the table.

mod men;

use self::men::Man;
use super::shapes::{Mesh, circle};
use super::shapes::{cuboid, mitred_frame, moved, prism, turned_y};
use super::studio::{PAPER_SIZE, Studio, glossy, matt, metal};
use crate::error::Result;
use crate::scene::Scene;
use std::f64::consts::PI;

/// Ranks from the eighth to the first; capitals are white.
const POSITION: [&str; 8] =
    ["r.bqk..r", "pppp.ppp", "..n..n..", "..b.p...", "..B.P...", "...P.N..", "PPP..PPP", "RNBQK..R"];

/// Upper side of the felts.
const FELT: f64 = 0.04;

pub(super) fn build() -> Result<Scene> {
    let mut studio = Studio::new("chessboard");
    add_board(&mut studio)?;
    add_men(&mut studio)?;
    studio.lamp("window", [-6.2, 8.2, 2.8], [0.62, 0.6, 0.56]);
    studio.lamp("ceiling", [1.8, 10.4, -2.2], [0.3, 0.29, 0.27]);
    studio.lamp("desk lamp", [6.2, 4.4, 5.0], [0.34, 0.29, 0.21]);
    studio.lamp("far lamp", [-3.6, 4.2, -7.6], [0.16, 0.18, 0.22]);
    studio.camera([4.4, 8.6, 11.2], [-0.1, -0.1, 0.35], 39.0, PAPER_SIZE);
    Ok(studio.finish())
}

fn add_board(studio: &mut Studio) -> Result<()> {
    let light = studio.material(glossy("maple", [0.72, 0.56, 0.36], 0.25, 40.0));
    let dark = studio.material(glossy("walnut", [0.2, 0.095, 0.045], 0.25, 40.0));
    let rosewood = studio.material(glossy("rosewood", [0.26, 0.09, 0.05], 0.3, 50.0));
    let brass = studio.material(metal("brass", [0.4, 0.28, 0.09], [0.5, 0.38, 0.16]));
    let table = studio.material(glossy("green baize", [0.07, 0.17, 0.12], 0.0, 1.0));
    for rank in 0..8 {
        for file in 0..8 {
            let (low, high) = (place(file, 8 - rank), place(file + 1, 7 - rank));
            let square = cuboid([low[0], -0.2, low[1]], [high[0], 0.0, high[1]]);
            let name = format!("square {}{}", char::from(b'a' + file as u8), rank + 1);
            studio.add(name, if (file + rank) % 2 == 0 { dark } else { light }, square)?;
        }
    }
    let inlay = [[0.003, -0.2], [0.1, -0.2], [0.1, 0.01], [0.003, 0.01]];
    studio.add("inlay", brass, mitred_frame([4.0; 2], &inlay))?;
    let frame = [
        [0.103, -0.36],
        [0.9, -0.36],
        [0.96, -0.3],
        [0.96, -0.12],
        [0.9, -0.06],
        [0.78, -0.06],
        [0.7, 0.03],
        [0.103, 0.03],
    ];
    studio.add("frame", rosewood, mitred_frame([4.0; 2], &frame))?;
    studio.add("board", rosewood, cuboid([-4.1, -0.36, -4.1], [4.1, -0.202, 4.1]))?;
    studio.add("table", table, cuboid([-30.0, -0.9, -34.0], [30.0, -0.362, 18.0]))
}

/// Where lines of the board lie: x by file and z by rows from the far side.
fn place(file: usize, row: usize) -> [f64; 2] {
    [file as f64 - 4.0, row as f64 - 4.0]
}

fn add_men(studio: &mut Studio) -> Result<()> {
    let white = studio.material(glossy("boxwood", [0.82, 0.68, 0.44], 0.35, 35.0));
    let black = studio.material(glossy("ebony", [0.075, 0.055, 0.05], 0.45, 35.0));
    let felt = studio.material(matt("felt", [0.1, 0.22, 0.14]));
    for (row, line) in POSITION.iter().enumerate() {
        for (file, letter) in line.chars().enumerate() {
            let Some(man) = Man::of(letter) else { continue };
            let is_white = letter.is_ascii_uppercase();
            let [x, z] = place(file, row).map(|edge| edge + 0.5);
            // Nobody sets men down quite straight.
            let slant = 0.12 * ((file * 5 + row * 3) % 7) as f64 - 0.36;
            // Knights look at the other side, and a little inwards.
            let turn = slant + if is_white { 0.5 * PI } else { -0.5 * PI };
            let at = moved(x, 0.0, z) * turned_y(turn);
            let colour = if is_white { "white" } else { "black" };
            let name = format!("{colour} {} {}{}", man.name(), char::from(b'a' + file as u8), 8 - row);
            studio.add(name.clone(), if is_white { white } else { black }, man.body().placed(&at))?;
            let base = man.base_radius() - 0.02;
            studio.add(format!("felt of {name}"), felt, felt_under(base).placed(&at))?;
        }
    }
    Ok(())
}

fn felt_under(radius: f64) -> Mesh {
    prism(&circle(radius, 12, 0.0), 0.001, FELT)
}
