//! Where the errors of a sampled tester lie: a shadow-buffer may be wrong within a cell of an edge, and nowhere else.

use crate::geometry::curved::RayStart;
use crate::geometry::ray_triangle::RayTriangle;
use crate::scene::{ImageSize, Object, Primitive, Scene};
use crate::shadow::Queries;
use crate::visibility::{SurfacePoint, VisibleSurfaces};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Rays of the ring around a direction that looks for the receiver's silhouette.
const RING: u32 = 32;

/// Wrong answers, and those of them near an edge.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EdgeCounts {
    /// Pixels with a wrong answer.
    pub wrong: u64,
    /// Those of them within the angle of an edge.
    pub near_an_edge: u64,
}

/// Edges between light and shadow as the light sees them, for the pixels of an image.
pub struct ShadowEdges<'a> {
    scene: &'a Scene,
    light: Vec3,
    /// Unit directions from the light to where neighbouring samples differ.
    directions: Vec<DVec3>,
}

impl<'a> ShadowEdges<'a> {
    /// The edges of a point light in an image, from the truth about its queries. Between two neighbouring samples
    /// on one object is an edge if one of them is lit and the other is not: occluded, or dark without a query, as
    /// it is beyond the line where a surface turns away from the light.
    pub fn new(
        scene: &'a Scene,
        light: Vec3,
        size: ImageSize,
        visible: &VisibleSurfaces,
        queries: &Queries,
        truth: &[bool],
    ) -> ShadowEdges<'a> {
        let mut samples: Vec<Option<(&SurfacePoint, bool)>> = vec![None; size.pixels()];
        for (point, &pixel) in visible.points[..visible.seen].iter().zip(&visible.pixels) {
            samples[pixel as usize] = Some((point, false));
        }
        let lit = queries.nodes.iter().zip(truth).filter(|(_, occluded)| !**occluded).map(|(node, _)| node);
        for &node in lit.chain(&queries.not_receiving) {
            let Some(pixel) = visible.pixel_seen(node) else { continue };
            if let Some((_, is_lit)) = &mut samples[pixel as usize] {
                *is_lit = true;
            }
        }
        let width = size.width as usize;
        let object = |point: &SurfacePoint| point.primitive().map(|p| scene.object_index(p));
        let towards = |p: DVec3| (p - light.as_dvec3()).normalize_or_zero();
        let edge = |&(here, there): &(usize, usize)| {
            let ((a, a_lit), (b, b_lit)) = (samples[here]?, samples[there]?);
            let is_edge = a_lit != b_lit && object(a) == object(b);
            is_edge.then(|| [a.position, (a.position + b.position) / 2.0, b.position].map(towards))
        };
        let pairs = (0..size.pixels()).flat_map(|here| {
            let right = (here % width + 1 < width).then_some((here, here + 1));
            let below = (here + width < size.pixels()).then_some((here, here + width));
            right.into_iter().chain(below)
        });
        let directions = pairs.filter_map(|pair| edge(&pair)).flatten().collect();
        ShadowEdges { scene, light, directions }
    }

    /// Whether an edge is within an angle of a point as the light sees it, or the silhouette of the point's object.
    pub fn are_near(&self, point: &SurfacePoint, angle: f64) -> bool {
        let direction = (point.position - self.light.as_dvec3()).normalize_or_zero();
        // Chords compare as angles do, and keep their digits where these are small.
        let chord = 2.0 * libm::sin(angle.min(std::f64::consts::PI) / 2.0);
        let is_near = |edge: &DVec3| edge.distance_squared(direction) <= chord * chord;
        self.directions.iter().any(is_near) || self.is_silhouette_near(point, direction, angle)
    }

    /// Whether a ray at an angle from the direction of a point misses its object.
    fn is_silhouette_near(&self, point: &SurfacePoint, direction: DVec3, angle: f64) -> bool {
        let Some(primitive) = point.primitive() else { return false };
        let object = self.scene.object(primitive);
        let (u, v) = direction.any_orthonormal_pair();
        (0..RING).any(|i| {
            let turn = TAU * f64::from(i) / f64::from(RING);
            let across = u * libm::cos(turn) + v * libm::sin(turn);
            let ray = direction * libm::cos(angle) + across * libm::sin(angle);
            !is_hit(self.scene, object, self.light, ray.as_vec3())
        })
    }

    /// How many wrong answers lie within an angle of an edge, among the pixels of the image.
    pub fn wrong_answers(
        &self,
        visible: &VisibleSurfaces,
        queries: &Queries,
        [answers, truth]: [&[bool]; 2],
        angle: f64,
    ) -> EdgeCounts {
        let in_image = queries.nodes.iter().take_while(|&&node| visible.pixel_seen(node).is_some()).count();
        let wrong: Vec<usize> = (0..in_image).filter(|&i| answers[i] != truth[i]).collect();
        let near = wrong.par_iter().filter(|&&i| self.are_near(&queries.points[i], angle)).count();
        EdgeCounts { wrong: wrong.len() as u64, near_an_edge: near as u64 }
    }
}

/// Whether a ray from the light meets an object.
fn is_hit(scene: &Scene, object: &Object, light: Vec3, direction: Vec3) -> bool {
    let first_curved = scene.triangles.len() as u32 + object.first_curved;
    let flat = object.first..object.first + object.count;
    let curved = first_curved..first_curved + object.curved_count;
    flat.chain(curved).any(|primitive| match scene.primitive(primitive) {
        Primitive::Triangle(corners) => {
            RayTriangle::new(light, corners).is_some_and(|triangle| triangle.hit(direction).is_some())
        }
        Primitive::Curved(shape) => shape.first_hit(light, direction, &RayStart::origin()).is_some(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::{InfinitePlane, Shape};
    use crate::scene::{Camera, Falloff, Light, ObjectInput, PointLight, SceneBuilder};
    use crate::shadow::exact::{Arbiter, Occlusion};
    use crate::shadow::shadow_buffer::sphere::Sphere;
    use crate::shadow::shadow_buffer::{DepthBias, Lookup, ShadowBuffer, ShadowBufferSettings};
    use crate::shadow::{BuildInput, SceneIndex, ShadowTester};
    use crate::visibility::{PointSource, t_buffer};

    const LIGHT: Vec3 = Vec3::new(5.0, 8.0, 4.0);
    const SIZE: ImageSize = ImageSize { width: 240, height: 160 };

    /// Three spheres on top of each other on an endless ground, as in figures 9 to 11 of the 2004 paper.
    fn stacked_spheres() -> Scene {
        let mut builder = SceneBuilder::new("stacked spheres");
        let mut add = |name: &str, shape: Shape| {
            let object = ObjectInput { curved: vec![shape], ..ObjectInput::new(name, vec![], vec![]) };
            builder.add_object(object).unwrap();
        };
        add("ground", Shape::Plane(InfinitePlane { point: Vec3::ZERO, normal: Vec3::Y }));
        add("low", Shape::sphere(Vec3::new(0.0, 1.0, 0.0), 1.0));
        add("middle", Shape::sphere(Vec3::new(0.0, 2.75, 0.0), 0.75));
        add("high", Shape::sphere(Vec3::new(0.0, 4.0, 0.0), 0.5));
        builder.finish()
    }

    /// Errors of a buffer of so many rows and twice as many columns.
    struct Judged {
        counts: EdgeCounts,
        /// Share of all queries, right or wrong, near an edge.
        near_share: f64,
        queries: usize,
    }

    fn judge(rows: &[u32], lookup: Lookup) -> Vec<Judged> {
        let scene = stacked_spheres();
        let camera = Camera::look_at("c", Vec3::new(-1.0, 4.0, 9.0), Vec3::new(0.0, 1.5, 0.0), Vec3::Y, 50.0);
        let hits = t_buffer::first_hits(&scene, &camera, SIZE);
        let visible = VisibleSurfaces::new(&scene, &camera, &hits);
        let lamp = PointLight { position: LIGHT, intensity: [1.0; 3], falloff: Falloff::Constant };
        let queries = Queries::new(&scene, &visible, &Light::point("lamp", lamp));
        let index = SceneIndex::new(&scene);
        let input = BuildInput::new(&scene, &index, LIGHT);
        let arbiter = Arbiter::new(&input);
        let decide = |point| arbiter.decide(point).occlusion == Occlusion::Occluded;
        let truth: Vec<bool> = queries.points.par_iter().map(decide).collect();
        let edges = ShadowEdges::new(&scene, LIGHT, SIZE, &visible, &queries, &truth);
        let judge = |&rows: &u32| {
            let columns = 2 * rows;
            let usual = ShadowBufferSettings::default();
            let shadow_buffer =
                ShadowBufferSettings { rows, columns, lookup, bias: DepthBias::CellWidth, ..usual };
            let buffer = ShadowBuffer::new(&BuildInput { shadow_buffer, ..input }).unwrap();
            let mut answers = vec![false; truth.len()];
            buffer.occluded(&queries.points, &mut answers).unwrap();
            let width = Sphere::new(rows, columns).unwrap().cell_width();
            let counts = edges.wrong_answers(&visible, &queries, [&answers, &truth], width);
            let sample = || queries.points.iter().step_by(7);
            let near = sample().filter(|point| edges.are_near(point, width)).count();
            let near_share = near as f64 / sample().count() as f64;
            Judged { counts, near_share, queries: truth.len() }
        };
        rows.iter().map(judge).collect()
    }

    #[test]
    fn a_shadow_buffer_is_wrong_at_edges_and_less_so_the_finer_it_is() {
        let judged = judge(&[100, 200, 400, 800], Lookup::Identity);
        let wrong: Vec<u64> = judged.iter().map(|j| j.counts.wrong).collect();
        println!("{wrong:?} wrong of {}", judged[0].queries);
        assert!(wrong.windows(2).all(|pair| pair[1] < pair[0]), "{wrong:?}");
        // Errors lie along lines, so they fall about as a cell's width does.
        assert!(wrong[3] * 4 < wrong[0], "{wrong:?}");
        for (judged, rows) in judged.iter().zip([100, 200, 400, 800]) {
            let EdgeCounts { wrong, near_an_edge } = judged.counts;
            println!("{rows} rows: {near_an_edge} of {wrong} near an edge, {:.3} of all", judged.near_share);
            // If everything were near an edge, that would say nothing.
            assert!(judged.near_share < 0.5 && (rows < 400 || judged.near_share < 0.1), "{rows} rows");
            assert!(wrong > 20 && wrong < judged.queries as u64 / 4, "{rows} rows: {wrong} wrong");
            assert!(near_an_edge * 100 >= wrong * 99, "{rows} rows: {near_an_edge} of {wrong} near an edge");
        }
    }

    #[test]
    fn by_depth_it_is_less_wrong_the_finer_it_is() {
        let judged = judge(&[100, 800], Lookup::Depth);
        let [coarse, fine] = [judged[0].counts.wrong, judged[1].counts.wrong];
        println!("by depth: {coarse} and {fine} wrong of {}", judged[0].queries);
        assert!(fine * 3 < coarse * 2, "{coarse} and {fine}");
    }

    #[test]
    fn what_is_far_from_every_edge_is_not_near_one() {
        let scene = stacked_spheres();
        let visible = VisibleSurfaces { points: Vec::new(), pixels: Vec::new(), seen: 0 };
        let edges = ShadowEdges::new(&scene, LIGHT, SIZE, &visible, &Queries::default(), &[]);
        let on = |aim: Vec3| {
            let hierarchy = crate::visibility::hierarchy::Hierarchy::new(&scene);
            let ray = crate::visibility::hierarchy::Ray {
                origin: LIGHT,
                direction: aim - LIGHT,
                start: RayStart::origin(),
            };
            SurfacePoint::on_ray(&scene, LIGHT, aim - LIGHT, hierarchy.first_hit(&ray).unwrap().primitive)
        };
        // In the middle of the highest ball, and beside its silhouette.
        assert!(!edges.are_near(&on(Vec3::new(0.0, 4.0, 0.0)), 0.01));
        assert!(edges.are_near(&on(Vec3::new(0.0, 4.0, 0.0)), 0.1));
        assert!(edges.are_near(&on(Vec3::new(-0.33, 4.33, 0.0)), 0.02));
        assert!(!edges.are_near(&on(Vec3::new(-3.0, 0.0, 3.0)), 0.1));
    }

    /// An edge in the direction z and nothing else, as a light at [`LIGHT`] sees it.
    fn one_edge(scene: &Scene) -> ShadowEdges<'_> {
        ShadowEdges { scene, light: LIGHT, directions: vec![DVec3::Z] }
    }

    #[test]
    fn an_edge_is_near_up_to_the_angle_between_directions() {
        let scene = SceneBuilder::new("nothing").finish();
        let edges = one_edge(&scene);
        let at = |position: DVec3| SurfacePoint { position, source: PointSource::Bare };
        for between in [1e-6, 0.01, 0.5, 1.5, 2.5, 3.1] {
            let direction = DVec3::new(libm::sin(between), 0.0, libm::cos(between));
            let point = at(LIGHT.as_dvec3() + 7.0 * direction);
            // Coordinates of a few metres are known within 1e-15, and chords near half a turn hardly tell angles apart.
            let (less, more) = (between * (1.0 - 1e-6), between * (1.0 + 1e-6));
            assert!(!edges.are_near(&point, less) && edges.are_near(&point, more), "{between}");
        }
        // Nothing is farther than half a turn.
        let opposite = at(LIGHT.as_dvec3() - DVec3::Z);
        assert!(!edges.are_near(&opposite, 3.0) && edges.are_near(&opposite, 4.0));
    }

    #[test]
    fn a_silhouette_is_near_up_to_the_angle_on_whatever_side_it_is() {
        for (turn, angle) in (0..50).flat_map(|turn| [(turn, 0.01), (turn, 0.5)]) {
            let turn = TAU * f64::from(turn) / 50.0;
            let (across, along) = (
                DVec3::new(libm::cos(turn), libm::sin(turn), 0.0),
                DVec3::new(-libm::sin(turn), libm::cos(turn), 0.0),
            );
            // A triangle five before the light whose one side passes by its middle in the direction `across`.
            let near = |share: f64| {
                let side = 5.0 * libm::tan(angle) * share;
                let corner =
                    |a: f64, b: f64| (LIGHT.as_dvec3() + across * a + along * b + 5.0 * DVec3::Z).as_vec3();
                let corners = vec![corner(side, -9.0), corner(side, 9.0), corner(-20.0, 0.0)];
                let mut builder = SceneBuilder::new("test");
                builder.add_object(ObjectInput::new("t", corners, vec![[0, 1, 2]])).unwrap();
                let scene = builder.finish();
                let edges = ShadowEdges { directions: Vec::new(), ..one_edge(&scene) };
                edges.are_near(&SurfacePoint::on_ray(&scene, LIGHT, Vec3::Z, 0), angle)
            };
            // The ring has 32 rays: one of them is within a 64th of a turn of every side, and cos(tau / 64) > 0.995.
            assert!(near(0.99) && !near(1.01), "{turn} {angle}");
        }
    }

    #[test]
    fn an_object_is_hit_where_its_own_primitives_are() {
        // Three objects of three triangles and three balls each, all of them in directions of their own.
        let aim = |i: u32| Vec3::new(i as f32 - 9.0, 0.0, 20.0);
        let mut builder = SceneBuilder::new("test");
        for object in 0..3 {
            let own = |k: u32| LIGHT + aim(6 * object + k);
            let corners =
                (0..3).flat_map(|k| [Vec3::X, Vec3::Y, Vec3::NEG_ONE].map(|side| own(k) + 0.25 * side));
            let triangles = vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]];
            let curved = (3..6).map(|k| Shape::sphere(own(k), 0.25)).collect();
            let input = ObjectInput { curved, ..ObjectInput::new("o", corners.collect(), triangles) };
            builder.add_object(input).unwrap();
        }
        let scene = builder.finish();
        for (number, object) in (0..).zip(&scene.objects) {
            let hit: Vec<u32> = (0..18).filter(|&i| is_hit(&scene, object, LIGHT, aim(i))).collect();
            assert_eq!(hit, (6 * number..6 * number + 6).collect::<Vec<u32>>());
        }
    }
}
