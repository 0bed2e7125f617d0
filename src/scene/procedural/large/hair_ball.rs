//! A ball of hair: strands as ribbons that end in a point, each of fifteen thin triangles, over a ball. Hardly a cell of
//! a light buffer is without borders of triangles. After the "hairball" of Laine and Karras (2010), of our own design.

use super::skin::Skin;
use super::sphereflake::ball;
use super::{SIZE, studio};
use crate::error::Result;
use crate::random::Random;
use crate::scene::Scene;
use crate::scene::procedural::studio::{glossy, matt};
use glam::{DAffine3, DVec3};
use std::f64::consts::TAU;

/// Pieces of a strand: two triangles each, and one at the tip.
const PIECES: usize = 8;

/// Strands of size 1, which with the ball inside are about two thousand triangles.
const STRANDS: u32 = 64;

const BALL: f64 = 0.55;

/// Strands are thinner the more there are, so that they hide as much of each other.
const WIDTH: f64 = 1.6;

pub(in crate::scene::procedural) fn build(size: u32) -> Result<Scene> {
    let mut studio = studio("hair-ball", [0.4, 0.45, 0.5], [1.9, 3.1, 2.2]);
    let ground = studio.material(matt("ground", [0.5, 0.5, 0.52]));
    let mut floor = Skin::default();
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
    let corners = corners.map(|[x, z]| floor.point(DVec3::new(8.0 * x, -1.2, 8.0 * z)));
    floor.quadrangle(corners);
    studio.add_input(floor.into_object("ground", ground))?;
    let skin = studio.material(matt("skin", [0.45, 0.3, 0.25]));
    let mut core = Skin::default();
    core.add(&ball(), &DAffine3::from_scale(DVec3::splat(BALL)));
    studio.add_input(core.into_object("ball", skin))?;
    let hair = studio.material(glossy("hair", [0.55, 0.32, 0.16], 0.3, 30.0));
    studio.add_input(strands(size * STRANDS).into_object("hair", hair))?;
    studio.camera([0.6, 0.75, 3.5], [0.0, -0.12, 0.0], 42.0, SIZE);
    Ok(studio.finish())
}

fn strands(count: u32) -> Skin {
    let mut skin = Skin::default();
    let mut random = Random::new(1_000_000);
    let width = WIDTH / f64::from(count).sqrt();
    for number in 0..count {
        strand(&mut skin, &mut random, root(number, count), width);
    }
    skin
}

/// Points spread evenly over the ball: along a spiral from pole to pole, each a golden angle from the one before.
fn root(number: u32, count: u32) -> DVec3 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let y = 1.0 - 2.0 * (f64::from(number) + 0.5) / f64::from(count);
    let turn = f64::from(number) * GOLDEN;
    let (sin, cos) = libm::sincos(TAU * (turn - turn.floor()));
    let radius = (1.0 - y * y).sqrt();
    DVec3::new(radius * sin, y, radius * cos)
}

/// Out of the ball, then to the side and down, in a curl.
fn strand(skin: &mut Skin, random: &mut Random, root: DVec3, width: f64) {
    let length = 0.45 + 0.2 * random.unit();
    let step = length / PIECES as f64;
    let any = DVec3::new(random.signed(), random.signed(), random.signed());
    let mut across = root.cross(any + 1e-3 * root.any_orthonormal_vector()).normalize();
    let (mut direction, mut place) = ((root + 0.25 * any).normalize(), root * (BALL - 0.01));
    let bend = 0.2 * any - 0.12 * DVec3::Y;
    let mut edge: Option<[u32; 2]> = None;
    for piece in 0..PIECES {
        let half = 0.5 * width * (1.0 - 0.6 * piece as f64 / PIECES as f64);
        let next = [skin.point(place - half * across), skin.point(place + half * across)];
        if let Some([left, right]) = edge {
            skin.quadrangle([left, right, next[1], next[0]]);
        }
        edge = Some(next);
        place += step * direction;
        let side = direction.cross(across);
        direction = (direction + bend + 0.35 * random.signed() * side).normalize();
        // A little twisted.
        across = (across + 0.3 * side).reject_from(direction).normalize();
    }
    let tip = skin.point(place);
    if let Some([left, right]) = edge {
        skin.triangle(left, right, tip);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strands_have_fifteen_triangles_and_share_corners() {
        let skin = strands(100);
        assert_eq!((skin.triangles.len(), skin.points.len()), (1500, 1700));
        // Its two sides, its root and its tip.
        assert_eq!(skin.open_edges(), 100 * (2 * PIECES + 1));
    }

    #[test]
    fn triangles_are_thin_and_strands_stay_near_the_ball() {
        let skin = strands(66_560);
        assert!(skin.points.iter().all(|p| (0.4..1.25).contains(&p.length())));
        let longest_over_shortest = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| skin.points[i as usize]);
            let lengths = [a.distance(b), b.distance(c), c.distance(a)];
            lengths.iter().fold(0.0, |m: f64, &l| m.max(l)) / lengths.iter().fold(f64::MAX, |m, &l| m.min(l))
        };
        let thin = skin.triangles.iter().filter(|t| longest_over_shortest(t) > 5.0).count();
        assert!(thin * 10 > skin.triangles.len() * 9, "{thin}");
    }
}
