//! Ray trees (row 22 of the notes on the 1986 paper): what mirrors and transparent surfaces show, level by level.
//!
//! A tree grows without asking who sees a light, so a forest, a tree a pixel, is complete before any shadow is
//! tested. The points of all its levels then are queries of the same testers.

mod branch;
mod spawn;

pub use branch::{reflected, refracted};
pub use spawn::{Branch, Kind, branches};

use crate::error::Result;
use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::scene::{Material, Scene};
use crate::visibility::hierarchy::{FirstHit, Hierarchy, Ray};
use crate::visibility::{SurfacePoint, VisibleSurfaces};
use rayon::prelude::*;

/// How deep trees are unless something else is asked for: as deep as those of the 1986 paper.
pub const USUAL_DEPTH: u32 = 5;

/// Whether rays of a kind are followed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Following {
    /// They are.
    #[default]
    On,
    /// Nothing is computed for them.
    Off,
}

/// How trees grow. Reflections can be switched as in REALITY (2004 paper, section IV).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TreeRules {
    /// The most rays one behind the other: with 1 a tree is what the camera sees.
    pub depth: u32,
    /// Rays of mirrors and of total reflection.
    pub reflections: Following,
    /// Rays that pass through transparent surfaces.
    pub refractions: Following,
}

impl TreeRules {
    /// Everything is followed, so many rays one behind the other.
    pub fn of_depth(depth: u32) -> TreeRules {
        TreeRules { depth, reflections: Following::On, refractions: Following::On }
    }

    /// Whether a surface of a material sends rays on.
    fn follow(&self, material: &Material) -> bool {
        let mirrors = self.reflections == Following::On && material.mirror != [0.0; 3];
        mirrors || (self.refractions == Following::On && material.transmission.is_some())
    }
}

/// Rays and hits of all trees of a picture.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct TreeStatistics {
    /// Rays from the eye.
    pub eye_rays: u64,
    /// Those that hit something.
    pub eye_hits: u64,
    /// Rays that mirrors made, and those of total reflection.
    pub reflection_rays: u64,
    /// Rays that passed through a transparent surface.
    pub refraction_rays: u64,
    /// Rays of total reflection, counted above.
    pub total_reflections: u64,
    /// Rays that rounding or a bent shading normal left on the wrong side of their surface, or on a line beside it;
    /// not counted above.
    pub dropped: u64,
    /// Points where rays of any level hit something.
    pub nodes: u64,
    /// The most rays one behind the other, that from the eye included.
    pub depth: u32,
}

impl TreeStatistics {
    /// The paper's average tree size: points a ray from the eye.
    pub fn average_tree(&self) -> f64 {
        if self.eye_rays == 0 { 0.0 } else { self.nodes as f64 / self.eye_rays as f64 }
    }
}

/// The trees of all pixels of a picture.
#[derive(Debug, Clone)]
pub struct RayForest {
    /// The points of all trees, level by level; those that the camera sees come first.
    pub nodes: VisibleSurfaces,
    /// The number of the first node of each level, from that of the rays from the eye on.
    pub levels: Vec<u32>,
    /// The share of each node's radiance that reaches its pixel, linear Rec. 709.
    pub weights: Vec<[f32; 3]>,
    /// Pixels with rays that leave the scene, and the shares that those have.
    pub sky: Vec<(u32, [f32; 3])>,
    /// What grew.
    pub statistics: TreeStatistics,
}

/// A ray that is to be traced.
struct Twig {
    pixel: u32,
    weight: [f32; 3],
    ray: Ray,
}

impl RayForest {
    /// Grows the trees of what a camera sees, of `eye_rays` rays.
    pub fn grow(scene: &Scene, seen: VisibleSurfaces, eye_rays: u64, rules: TreeRules) -> RayForest {
        RayForest::grow_within(scene, seen, eye_rays, rules, &|_| Ok(())).expect("every size is allowed")
    }

    /// The same, where `room` is asked before each level whether there may be so many points: between mirrors and
    /// panes of glass their number doubles with every level.
    ///
    /// # Errors
    /// That of `room`.
    pub fn grow_within(
        scene: &Scene,
        seen: VisibleSurfaces,
        eye_rays: u64,
        rules: TreeRules,
        room: &dyn Fn(u64) -> Result<()>,
    ) -> Result<RayForest> {
        let _floats = StandardFloats::new();
        let hits = seen.points.len();
        let statistics =
            TreeStatistics { eye_rays, eye_hits: hits as u64, depth: 1, ..TreeStatistics::default() };
        let (weights, levels) = (vec![[1.0; 3]; hits], vec![0]);
        let mut forest = RayForest { weights, levels, nodes: seen, sky: Vec::new(), statistics };
        if scene.materials.iter().any(|material| rules.follow(material)) {
            let hierarchy = Hierarchy::new(scene);
            let mut first = 0;
            for _ in 1..rules.depth {
                let twigs = forest.sprout(scene, first, &rules);
                first = forest.nodes.points.len();
                if twigs.is_empty() {
                    break;
                }
                room((first + twigs.len()) as u64)?;
                forest.statistics.depth += 1;
                forest.levels.push(first as u32);
                forest.trace(scene, &hierarchy, &twigs);
            }
        }
        forest.statistics.nodes = forest.nodes.points.len() as u64;
        Ok(forest)
    }

    /// The rays that leave the nodes from a number on, in their order.
    fn sprout(&mut self, scene: &Scene, first: usize, rules: &TreeRules) -> Vec<Twig> {
        let points = self.nodes.points[first..].par_iter();
        let sprouted: Vec<(Vec<Twig>, TreeStatistics)> = points
            .enumerate()
            .in_standard_floats()
            .map(|(i, point)| {
                let node = first + i;
                let (pixel, weight) = (self.nodes.pixels[node], self.weights[node]);
                let mut counts = TreeStatistics::default();
                let mut twigs = Vec::new();
                for branch in branches(scene, point, rules) {
                    let weight = std::array::from_fn(|c| weight[c] * branch.share[c]);
                    match branch.ray {
                        Some(ray) => {
                            counts.count(branch.kind);
                            twigs.push(Twig { pixel, weight, ray });
                        }
                        None => counts.dropped += 1,
                    }
                }
                (twigs, counts)
            })
            .collect();
        let mut all = Vec::new();
        for (twigs, counts) in sprouted {
            all.extend(twigs);
            self.statistics.reflection_rays += counts.reflection_rays;
            self.statistics.refraction_rays += counts.refraction_rays;
            self.statistics.total_reflections += counts.total_reflections;
            self.statistics.dropped += counts.dropped;
        }
        all
    }

    fn trace(&mut self, scene: &Scene, hierarchy: &Hierarchy, twigs: &[Twig]) {
        let point = |ray: &Ray, FirstHit { primitive, crossing }: FirstHit| match crossing {
            Some(crossing) => SurfacePoint::on_curved(scene, ray.origin, ray.direction, primitive, crossing),
            None => SurfacePoint::on_ray(scene, ray.origin, ray.direction, primitive),
        };
        let hits: Vec<_> = twigs
            .par_iter()
            .in_standard_floats()
            .map(|twig| Some(point(&twig.ray, hierarchy.first_hit(&twig.ray)?)))
            .collect();
        for (twig, hit) in twigs.iter().zip(hits) {
            match hit {
                Some(point) => {
                    self.nodes.points.push(point);
                    self.nodes.pixels.push(twig.pixel);
                    self.weights.push(twig.weight);
                }
                None => self.sky.push((twig.pixel, twig.weight)),
            }
        }
    }
}

impl TreeStatistics {
    fn count(&mut self, kind: Kind) {
        match kind {
            Kind::Reflection => self.reflection_rays += 1,
            Kind::Refraction => self.refraction_rays += 1,
            Kind::TotalReflection => {
                self.reflection_rays += 1;
                self.total_reflections += 1;
            }
        }
    }
}
