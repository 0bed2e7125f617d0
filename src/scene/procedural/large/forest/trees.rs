//! Trees of a height of about 1.6: a trunk and branches, each a closed tube that ends in a point, and what is green.

use crate::random::Random;
use crate::scene::procedural::large::skin::Skin;
use glam::DVec3;
use std::f64::consts::TAU;

/// What hangs on the branches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Leaves of two triangles each.
    Broadleaf,
    /// Needles of one triangle each.
    Conifer,
}

/// A tree that stands on the origin.
pub(super) struct Tree {
    /// Trunk and branches.
    pub wood: Skin,
    /// Leaves or needles.
    pub foliage: Skin,
}

/// Triangles of a tree: its trunk, its branches, and what hangs on them.
#[cfg(test)]
pub(super) const BROADLEAF: u64 = 126 + 56 * (22 + 100 * 2);
#[cfg(test)]
pub(super) const CONIFER: u64 = 126 + 112 * (16 + 96);

/// Turn from one branch to the next, as a share of the circle: they stand as far apart as they can.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// From its foot along the way, each place with its radius.
type Stem = Vec<(DVec3, f64)>;

impl Tree {
    pub(super) fn new(kind: Kind, seed: u64) -> Tree {
        let mut random = Random::new(seed);
        let mut tree = Tree { wood: Skin::default(), foliage: Skin::default() };
        let height = if kind == Kind::Broadleaf { 1.1 } else { 1.6 };
        let trunk: Stem = (0..=8)
            .map(|i| {
                let up = f64::from(i) / 8.0;
                let sway = 0.03 * up * DVec3::new(random.signed(), 0.0, random.signed());
                (DVec3::new(0.0, height * up, 0.0) + sway, 0.05 * (1.0 - 0.9 * up))
            })
            .collect();
        tube(&mut tree.wood, &trunk, 8);
        let branches = if kind == Kind::Broadleaf { 56 } else { 112 };
        for number in 0..branches {
            let share = (f64::from(number) + 0.5) / f64::from(branches);
            let azimuth = f64::from(number) * GOLDEN + 0.05 * random.signed();
            let branch = match kind {
                Kind::Broadleaf => bough(&mut random, share, azimuth, height),
                Kind::Conifer => twig(&mut random, share, azimuth, height),
            };
            tube(&mut tree.wood, &branch, 3);
            match kind {
                Kind::Broadleaf => (0..100).for_each(|_| leaf(&mut tree.foliage, &mut random, &branch)),
                Kind::Conifer => (0..96).for_each(|_| needle(&mut tree.foliage, &mut random, &branch)),
            }
        }
        tree
    }
}

/// Level, by a share of the circle.
fn direction(azimuth: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(TAU * azimuth);
    DVec3::new(cos, 0.0, sin)
}

/// Upwards out of the trunk and round: with the others the crown of a tree with leaves.
fn bough(random: &mut Random, share: f64, azimuth: f64, height: f64) -> Stem {
    let foot = height * (0.35 + 0.6 * share);
    let length = 0.46 * (1.0 - 0.55 * share) * (0.8 + 0.4 * random.unit());
    let rise = 0.35 + 0.9 * share;
    let way = (direction(azimuth) + rise * DVec3::Y).normalize();
    (0..=4)
        .map(|i| {
            let along = f64::from(i) / 4.0;
            let bend = 0.12 * along * along * DVec3::Y;
            (
                DVec3::new(0.0, foot, 0.0) + length * (along * way + bend),
                0.018 * (1.0 - along) * (1.2 - share),
            )
        })
        .collect()
}

/// Outwards and a little down: with the others the cone of a tree with needles.
fn twig(random: &mut Random, share: f64, azimuth: f64, height: f64) -> Stem {
    let foot = height * (0.1 + 0.86 * share);
    let length = (0.42 * (1.0 - share) + 0.04) * (0.85 + 0.3 * random.unit());
    let way = direction(azimuth);
    (0..=3)
        .map(|i| {
            let along = f64::from(i) / 3.0;
            let sag = (0.12 - 0.35 * along * (1.0 - along)) * DVec3::NEG_Y;
            (
                DVec3::new(0.0, foot, 0.0) + length * (along * (way + sag)),
                0.009 * (1.0 - along) * (1.2 - share),
            )
        })
        .collect()
}

/// A closed tube along a stem, which ends in a point.
fn tube(skin: &mut Skin, stem: &Stem, sides: usize) {
    let (tip, rest) = stem.split_last().expect("a stem has an end");
    let axis = (tip.0 - stem[0].0).normalize();
    let across = axis.any_orthonormal_vector();
    let up = axis.cross(across);
    let ring = |&(centre, radius): &(DVec3, f64)| {
        let corner = |side: usize| {
            let (sin, cos) = libm::sincos(TAU * side as f64 / sides as f64);
            centre + radius * (cos * across + sin * up)
        };
        (0..sides).map(corner).collect()
    };
    let rings: Vec<Vec<DVec3>> = rest.iter().map(ring).collect();
    skin.spike(&rings, tip.0);
}

/// A place along a stem, from 0 to 1.
fn place(stem: &Stem, along: f64) -> DVec3 {
    let last = stem.len() - 1;
    let piece = ((along * last as f64) as usize).min(last - 1);
    stem[piece].0.lerp(stem[piece + 1].0, along * last as f64 - piece as f64)
}

fn any(random: &mut Random) -> DVec3 {
    DVec3::new(random.signed(), random.signed(), random.signed())
}

/// Four corners, folded along the middle.
fn leaf(skin: &mut Skin, random: &mut Random, bough: &Stem) {
    let foot = place(bough, 0.3 + 0.7 * random.unit()) + 0.09 * any(random);
    let way = (any(random) + 0.3 * DVec3::NEG_Y).normalize_or(DVec3::X);
    let side = way.any_orthonormal_vector();
    let fold = 0.3 * way.cross(side);
    let length = 0.045 + 0.02 * random.unit();
    let middle = foot + 0.45 * length * way;
    let corners = [
        foot,
        middle + 0.27 * length * (side + fold),
        foot + length * way,
        middle - 0.27 * length * (side - fold),
    ];
    let corners = corners.map(|corner| skin.point(corner));
    skin.quadrangle(corners);
}

fn needle(skin: &mut Skin, random: &mut Random, twig: &Stem) {
    let (foot, end) = (place(twig, 0.12 + 0.88 * random.unit()), twig[twig.len() - 1].0);
    let along = (end - twig[0].0).normalize();
    let way = (0.6 * along + any(random)).normalize_or(DVec3::Y);
    let side = 0.004 * way.any_orthonormal_vector();
    let length = 0.05 + 0.025 * random.unit();
    let corners = [foot - side, foot + side, foot + length * way].map(|corner| skin.point(corner));
    skin.triangle(corners[0], corners[1], corners[2]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wood_is_closed_and_leaves_are_by_themselves() {
        for (kind, triangles, open) in
            [(Kind::Broadleaf, BROADLEAF, 4 * 56 * 100), (Kind::Conifer, CONIFER, 3 * 112 * 96)]
        {
            let tree = Tree::new(kind, 1);
            assert_eq!(tree.wood.open_edges(), 0);
            assert!(tree.wood.volume() > 0.0);
            assert_eq!(tree.foliage.open_edges(), open);
            let found = tree.wood.triangles.len() + tree.foliage.triangles.len();
            assert_eq!(found as u64, triangles);
        }
    }
}
