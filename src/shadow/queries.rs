//! Who is asked: the shadow queries of one light.

use super::Crossings;
use super::facing::{Facing, Sides};
use crate::float_environment::StandardFloats;
use crate::scene::{Light, Scene};
use crate::visibility::{SurfacePoint, VisibleSurfaces};
use rayon::prelude::*;

/// The shadow queries of one light: points of an image that face it or that it shines through, inside its cone if
/// it has one, on objects that receive shadows.
#[derive(Debug, Clone, Default)]
pub struct Queries {
    /// The points.
    pub points: Vec<SurfacePoint>,
    /// The number of each point among those of the image; all lists here are in ascending order.
    pub nodes: Vec<u32>,
    /// Those of the queries, by their places in `points`, that are on a transparent surface which the
    /// light reaches from behind: it passes through that surface too.
    pub from_behind: Vec<u32>,
    /// Points of the image whose surface faces away from the light: dark without a query.
    pub facing_away: Vec<u32>,
    /// Points whose surface faces it and is outside its cone: dark without a query.
    pub outside_cone: Vec<u32>,
    /// Points on objects that receive no shadows and would otherwise be queries: lit without one.
    pub not_receiving: Vec<u32>,
    /// Places in `points` where a run begins, but for the first: queries of two runs are never asked together. None
    /// unless [`in_runs`](Queries::in_runs) says so.
    pub runs: Vec<usize>,
}

impl Queries {
    /// Splits the points of an image.
    pub fn new(scene: &Scene, visible: &VisibleSurfaces, light: &Light) -> Queries {
        let _floats = StandardFloats::new();
        let sides = Sides::of(scene, light.position());
        let cone = light.lit_cone();
        let is_lit =
            |point: &SurfacePoint| cone.is_none_or(|cone| cone.holds(point.position, || point.exact(scene)));
        let receives =
            |point: &SurfacePoint| point.primitive().is_none_or(|p| scene.object(p).shadowing.receives);
        let facing: Vec<Facing> = visible.points.par_iter().map(|p| sides.facing(scene, p)).collect();
        let lets_light_through =
            |point: &SurfacePoint| point.primitive().is_some_and(|p| scene.is_transparent(p));
        let mut queries = Queries::default();
        for ((point, node), &facing) in visible.points.iter().zip(0..).zip(&facing) {
            let from_behind = facing == Facing::Away && lets_light_through(point);
            if facing != Facing::Towards && !from_behind {
                queries.facing_away.push(node);
            } else if !is_lit(point) {
                queries.outside_cone.push(node);
            } else if !receives(point) {
                queries.not_receiving.push(node);
            } else {
                if from_behind {
                    queries.from_behind.push(queries.points.len() as u32);
                }
                queries.points.push(*point);
                queries.nodes.push(node);
            }
        }
        queries
    }

    /// The same queries, of which those of a level of the ray trees and of so many pixels one after the other are a run.
    ///
    /// Embree traverses the rays of a packet together, and what it does at an edge may depend on who else is in there. So
    /// that no answer depends on which rows of a picture a process draws, packets end where blocks of rows do.
    ///
    /// `visible` is what they were made of, and `levels` has the first of its points of each level.
    pub fn in_runs(self, visible: &VisibleSurfaces, levels: &[u32], pixels: u32) -> Queries {
        let run = |&node: &u32| {
            let level = levels.partition_point(|&first| first <= node);
            (level, visible.pixels[node as usize] / pixels.max(1))
        };
        let runs: Vec<_> = self.nodes.iter().map(run).collect();
        let runs = (1..runs.len()).filter(|&query| runs[query] != runs[query - 1]).collect();
        Queries { runs, ..self }
    }

    /// The share of the light that arrives at each of the `points` of the image, where it faces the light or lets
    /// it through: from the answers to the queries, and from what transparent surfaces their segments cross.
    pub fn arriving(
        &self,
        scene: &Scene,
        points: usize,
        occluded: &[bool],
        crossings: Option<&Crossings>,
    ) -> Vec<[f32; 3]> {
        self.arriving_by(scene, points, |query| match occluded[query] {
            true => [0.0; 3],
            false => crossings.map_or([1.0; 3], |c| c.transmittance(scene, query)),
        })
    }

    /// The same from what arrives at each query.
    pub fn arriving_by(
        &self,
        scene: &Scene,
        points: usize,
        at_query: impl Fn(usize) -> [f32; 3],
    ) -> Vec<[f32; 3]> {
        let mut shares = vec![[0.0; 3]; points];
        for (query, &node) in self.nodes.iter().enumerate() {
            shares[node as usize] = at_query(query);
        }
        for &query in &self.from_behind {
            let (node, point) = (self.nodes[query as usize], &self.points[query as usize]);
            let own = point.primitive().and_then(|p| scene.material(p).transmission);
            if let Some(own) = own {
                let share = &mut shares[node as usize];
                *share = std::array::from_fn(|channel| share[channel] * own.transmittance[channel]);
            }
        }
        for &node in &self.not_receiving {
            shares[node as usize] = [1.0; 3];
        }
        shares
    }
}
