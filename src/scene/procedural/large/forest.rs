//! A forest: trees with leaves and trees with needles, each leaf and each needle by itself. Shadows are of many small
//! parts everywhere, and no cell of a light buffer is filled by one of them.

mod trees;

use super::relief::Relief;
use super::skin::Skin;
use super::{SIZE, studio};
use crate::error::Result;
use crate::random::Random;
use crate::scene::Scene;
use crate::scene::procedural::shapes::{moved, turned_y};
use crate::scene::procedural::studio::matt;
use glam::{DAffine3, DVec2, DVec3};
use trees::{Kind, Tree};

/// Cells along each side of the ground.
const GROUND: u32 = 96;

const HILLS: Relief = Relief { frequency: 1.1, octaves: 5, gain: 0.45, seed: 7 };

/// Different trees of each kind.
const MODELS: u64 = 3;

/// So many trees along each side. Each kind stands on every other place.
pub(in crate::scene::procedural) fn build(trees: u32) -> Result<Scene> {
    let mut studio = studio("forest", [0.6, 0.7, 0.8], [-2.0, 2.1, 1.1]);
    let soil = studio.material(matt("soil", [0.42, 0.36, 0.26]));
    studio.add_input(ground().into_object("ground", soil))?;
    let bark = studio.material(matt("bark", [0.36, 0.28, 0.22]));
    let leaf = studio.material(matt("leaf", [0.3, 0.46, 0.16]));
    let needle = studio.material(matt("needle", [0.16, 0.34, 0.2]));
    let kinds = [(Kind::Broadleaf, leaf), (Kind::Conifer, needle)];
    let models = kinds.map(|(kind, green)| {
        let models: Vec<Tree> = (0..MODELS).map(|seed| Tree::new(kind, seed)).collect();
        (models, green)
    });
    // What is small is not blown up.
    let spacing = 2.0 / f64::from(trees.max(4));
    let mut random = Random::new(10);
    for number in 0..trees * trees {
        let [column, row] = [number % trees, number / trees];
        let middle = |place: u32| f64::from(place) - 0.5 * f64::from(trees - 1);
        let off = DVec2::new(random.signed(), random.signed()) * 0.3;
        let place = spacing * (DVec2::new(middle(column), middle(row)) + off);
        let (models, green) = &models[((column + row) % 2) as usize];
        let tree = random.pick(models);
        let size = spacing * (0.85 + 0.4 * random.unit());
        let turn = turned_y(std::f64::consts::TAU * random.unit());
        // A little way into the ground.
        let foot = moved(place.x, height(place) - 0.02 * spacing, place.y);
        let transform = foot * turn * DAffine3::from_scale(DVec3::splat(size));
        for (part, skin, material) in [("wood", &tree.wood, bark), ("foliage", &tree.foliage, *green)] {
            let mut placed = Skin::default();
            placed.add(skin, &transform);
            studio.add_input(placed.into_object(format!("tree {} {part}", number + 1), material))?;
        }
    }
    studio.camera([0.45, 0.5, 1.75], [0.0, 0.02, 0.2], 40.0, SIZE);
    Ok(studio.finish())
}

fn height(place: DVec2) -> f64 {
    0.09 * HILLS.rolling(place)
}

/// Over the square from -3 to 3.
fn ground() -> Skin {
    let row = GROUND + 1;
    let coordinate = |number: u32| -3.0 + 6.0 * f64::from(number) / f64::from(GROUND);
    let corner = |i: u32| {
        let place = DVec2::new(coordinate(i % row), coordinate(i / row));
        DVec3::new(place.x, height(place), place.y)
    };
    let mut skin = Skin { points: (0..row * row).map(corner).collect(), ..Skin::default() };
    for i in 0..GROUND * GROUND {
        let first = i / GROUND * row + i % GROUND;
        skin.quadrangle([first, first + row, first + row + 1, first + 1]);
    }
    skin
}

/// Triangles of the whole of it.
#[cfg(test)]
pub(in crate::scene::procedural) fn triangles(trees: u32) -> u64 {
    let all = u64::from(trees).pow(2);
    let conifers = all / 2;
    2 * u64::from(GROUND).pow(2) + (all - conifers) * trees::BROADLEAF + conifers * trees::CONIFER
}
