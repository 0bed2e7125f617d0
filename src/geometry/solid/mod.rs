//! Closed solids, recognised and never declared (row 4 of the notes on the 1986 paper).
//!
//! A *part* of an object is what edges connect of its triangles; corners are the same if their positions
//! are. A part is a **solid** if
//!
//! - every edge belongs to exactly two triangles, which run through it in opposite directions, and
//! - no two triangles have a point in common but a shared corner or a shared edge.
//!
//! Such a part divides space into exactly two regions. Around the inside of an edge there is nothing but its
//! two triangles, so what lies before one of them there is connected with what lies before the other, and so
//! is what lies behind: all triangles have one region before them and one behind. Every region ends at some
//! triangle, so there are no more. Any closed path crosses the part as often one way as the other, because
//! the directions cancel at every edge, so the two are not one. The bounded one is the inside, and the sign
//! of the volume tells on which side of the triangles it is. Fans of triangles that touch in one corner
//! change nothing in this, and neither does what else there is: each part of an object stands for itself,
//! whether it lies beside the others, inside them, or crosses them.

mod common_points;
mod outside;
mod pairs;
#[cfg(test)]
mod tests;

use super::Sign;
use super::convexity::key;
use super::expansion::{self, Expansion};
use super::{LightPosition, ROUNDOFF};
use common_points::Facet;
use glam::Vec3;
use pairs::{Boxed, Search};
use std::collections::HashMap;

/// Parts with more triangles than this are not examined.
pub const MOST_TRIANGLES: usize = 1 << 20;

/// Boxes that may be looked at for each triangle of a part, on average, in search of triangles that cross. Only
/// where thousands of triangles meet in one place are there more.
const MOST_BOXES: u64 = 2000;

/// A closed solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    triangles: Vec<[Vec3; 3]>,
    bounds: (Vec3, Vec3),
    outer_side: Sign,
}

/// Why a part of an object is no solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Refusal {
    /// An edge belongs to one triangle or to more than two.
    Open,
    /// Two triangles run through their edge in the same direction.
    Turned,
    /// Two triangles have a point in common that is on no corner or edge that they share, or one has no
    /// area.
    Crossing,
    /// More than [`MOST_TRIANGLES`], or too crowded to be examined.
    TooLarge,
}

/// The parts of an object.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// For each triangle the index of its part.
    pub of: Vec<u32>,
    /// Each part, in the order of their first triangles.
    pub solids: Vec<Result<Solid, Refusal>>,
}

/// Divides an object into parts and tells which are solids, exactly.
pub fn recognise(triangles: &[[Vec3; 3]]) -> Parts {
    let facets = facets(triangles);
    let edges = edges(&facets);
    let of = parts(facets.len(), &edges);
    let count = of.iter().max().map_or(0, |&last| last as usize + 1);
    let mut refusals = vec![None; count];
    for edge in edges.chunk_by(|a, b| a.ends == b.ends) {
        let refusal = match edge {
            [one, other] if one.forwards != other.forwards => continue,
            [_, _] => Refusal::Turned,
            _ => Refusal::Open,
        };
        let of_part = &mut refusals[of[edge[0].triangle as usize] as usize];
        *of_part = Some(of_part.map_or(refusal, |before: Refusal| before.min(refusal)));
    }
    let mut members = vec![Vec::new(); count];
    for (&part, &facet) in of.iter().zip(&facets) {
        members[part as usize].push(facet);
    }
    let solids = members
        .into_iter()
        .zip(refusals)
        .map(|(facets, refusal)| refusal.map_or_else(|| Solid::of_closed(&facets), Err))
        .collect();
    Parts { of, solids }
}

impl Solid {
    /// A solid from triangles that are closed and run the same way round.
    fn of_closed(facets: &[Facet]) -> Result<Solid, Refusal> {
        if facets.len() > MOST_TRIANGLES {
            return Err(Refusal::TooLarge);
        }
        let triangles: Vec<_> = facets.iter().map(|facet| facet.corners).collect();
        let boxes: Vec<_> = triangles.iter().map(Boxed::around).collect();
        let is_crossing = |i: u32, j: u32| facets[i as usize].meets_beyond_shared(&facets[j as usize]);
        match pairs::any(&boxes, MOST_BOXES * boxes.len() as u64, is_crossing) {
            Search::Found => return Err(Refusal::Crossing),
            Search::GivenUp => return Err(Refusal::TooLarge),
            Search::Nothing => {}
        }
        let bounds = Boxed::around(triangles.as_flattened());
        // A triangle whose normal points away from a light has positive orientation: if normals point
        // outwards, the outer side is that of negative ones.
        let outer_side = -volume(&triangles);
        Ok(Solid { triangles, bounds: (bounds.low, bounds.high), outer_side })
    }

    /// The side of any of its triangles that is outside, never zero: what
    /// [`orientation`](super::planes::orientation) is for a light there.
    pub fn outer_side(&self) -> Sign {
        self.outer_side
    }

    /// Whether a light is certainly outside, neither inside nor on the surface. What is too entangled to be
    /// told counts as not outside; lights infinitely far away always are.
    pub fn is_outside(&self, light: LightPosition) -> bool {
        match light {
            LightPosition::Towards(_) => true,
            LightPosition::At(point) => {
                outside::is_outside(point, &self.triangles, self.bounds, self.outer_side)
            }
        }
    }
}

/// Triangles with a number for each corner, equal for equal positions.
fn facets(triangles: &[[Vec3; 3]]) -> Vec<Facet> {
    let mut numbers = HashMap::with_capacity(triangles.len());
    let mut number = |corner: Vec3| {
        let next = numbers.len() as u32;
        *numbers.entry(key(corner)).or_insert(next)
    };
    triangles.iter().map(|&corners| Facet { corners, numbers: corners.map(&mut number) }).collect()
}

/// A triangle's edge.
#[derive(Debug, Clone, Copy)]
struct Edge {
    /// Numbers of its ends, the lower first.
    ends: [u32; 2],
    triangle: u32,
    /// Whether the triangle runs from the lower to the higher.
    forwards: bool,
}

/// The edges of all triangles, those with the same ends side by side.
fn edges(facets: &[Facet]) -> Vec<Edge> {
    let of_triangle = |(triangle, facet): (usize, &Facet)| {
        let [a, b, c] = facet.numbers;
        [[a, b], [b, c], [c, a]].map(|[p, q]| Edge {
            ends: [p.min(q), p.max(q)],
            triangle: triangle as u32,
            forwards: p < q,
        })
    };
    let mut edges: Vec<_> = facets.iter().enumerate().flat_map(of_triangle).collect();
    edges.sort_unstable_by_key(|edge| (edge.ends, edge.triangle));
    edges
}

/// For each triangle its part, numbered in the order of their first triangles.
fn parts(triangles: usize, edges: &[Edge]) -> Vec<u32> {
    let mut above: Vec<u32> = (0..triangles as u32).collect();
    fn root(above: &mut [u32], mut t: u32) -> u32 {
        while above[t as usize] != t {
            // Every other step is shortened, which keeps the paths short.
            above[t as usize] = above[above[t as usize] as usize];
            t = above[t as usize];
        }
        t
    }
    for pair in edges.windows(2).filter(|pair| pair[0].ends == pair[1].ends) {
        let [p, q] = [pair[0].triangle, pair[1].triangle].map(|t| root(&mut above, t));
        // The lowest triangle stands for its part.
        above[p.max(q) as usize] = p.min(q);
    }
    let mut count = 0;
    let mut number = vec![0; triangles];
    (0..triangles as u32)
        .map(|t| {
            let first = root(&mut above, t) as usize;
            if first == t as usize {
                number[first] = count;
                count += 1;
            }
            number[first]
        })
        .collect()
}

/// The sign of the volume that closed triangles enclose, counted positive where normals point outwards.
///
/// Six times the volume is the sum of det(a - o, b - o, c - o) for any o. In f64 a determinant is wrong by
/// at most 8 roundoffs of the sum of its absolute terms, and a sum of n numbers by n roundoffs of theirs.
fn volume(triangles: &[[Vec3; 3]]) -> Sign {
    let Some(&[origin, ..]) = triangles.first() else { return Sign::Zero };
    let (sum, bound) = rounded_volume(triangles, origin);
    Sign::certain(sum, bound).unwrap_or_else(|| exact_volume(triangles, origin).sign())
}

/// Six times the volume in f64, and the bound of its error.
fn rounded_volume(triangles: &[[Vec3; 3]], origin: Vec3) -> (f64, f64) {
    let (mut sum, mut size) = (0.0, 0.0);
    for corners in triangles {
        let [a, b, c] = corners.map(|p| p.as_dvec3() - origin.as_dvec3());
        sum += a.dot(b.cross(c));
        let (b, c) = (b.abs(), c.abs());
        let terms = glam::DVec3::new(b.y * c.z + b.z * c.y, b.z * c.x + b.x * c.z, b.x * c.y + b.y * c.x);
        size += a.abs().dot(terms);
    }
    (sum, 2.0 * (triangles.len() as f64 + 8.0) * ROUNDOFF * size)
}

fn exact_volume(triangles: &[[Vec3; 3]], origin: Vec3) -> Expansion {
    triangles.iter().fold(Expansion::zero(), |sum, corners| {
        let [a, b, c] = corners.map(|p| expansion::difference(p, origin));
        &sum + &expansion::dot(&a, &expansion::cross(&b, &c))
    })
}
