//! Random scenes: the arbiter against the plain definition, and both against f64 where that is clear-cut.

use super::*;
use crate::geometry::ExactPosition;
use crate::geometry::curved::{Cone, Disc, Ellipsoid, InfinitePlane, Quadric};
use crate::shadow::exact::casters::{Caster, Casters};
use crate::shadow::exact::hierarchy::Visit;
use crate::shadow::exact::query::Query;
use crate::shadow::exact::{Meeting, integer_shape};
use proptest::prelude::*;

/// Random numbers of which many are small integers, so that what is degenerate turns up.
struct Numbers {
    state: u64,
    whole: bool,
}

impl Numbers {
    fn below(&mut self, end: u64) -> u64 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        (self.state >> 20) % end
    }

    fn number(&mut self) -> f32 {
        if self.whole { self.below(9) as f32 - 4.0 } else { self.below(1 << 24) as f32 / 2f32.powi(21) - 4.0 }
    }

    fn positive(&mut self) -> f32 {
        if self.whole { self.below(3) as f32 + 1.0 } else { (self.number() + 4.0) / 3.0 + 0.01 }
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number())
    }

    fn shape(&mut self) -> Shape {
        let shape = match self.below(6) {
            0 => Shape::sphere(self.vector(), self.positive()),
            1 => {
                let axes = [self.vector(), self.vector(), self.vector()].map(|axis| axis * 0.5);
                Shape::Ellipsoid(Ellipsoid { centre: self.vector(), axes })
            }
            2 => {
                let base_radius = self.positive();
                let apex_radius = [base_radius, 0.0, self.positive()][self.below(3) as usize];
                Shape::Cone(Cone { base: self.vector(), base_radius, apex: self.vector(), apex_radius })
            }
            3 => Shape::Disc(Disc { centre: self.vector(), normal: self.vector(), radius: self.positive() }),
            4 => Shape::Plane(InfinitePlane { point: self.vector(), normal: self.vector() }),
            _ => {
                let (low, size) = (self.vector(), self.positive());
                let mut second = [0.0; 6];
                second.fill_with(|| self.number());
                Shape::Quadric(Quadric {
                    reference: self.vector(),
                    second,
                    first: self.vector(),
                    constant: self.number(),
                    low,
                    high: low + size,
                })
            }
        };
        if shape.defect().is_none() { shape } else { self.shape() }
    }

    fn triangle(&mut self) -> [Vec3; 3] {
        let [a, b, c] = [self.vector(), self.vector(), self.vector()];
        let is_flat = (b.as_dvec3() - a.as_dvec3()).cross(c.as_dvec3() - a.as_dvec3()).length() < 1e-3;
        if is_flat { self.triangle() } else { [a, b, c] }
    }

    fn light(&mut self) -> LightPosition {
        let place = self.vector();
        if place == Vec3::ZERO || self.below(2) == 0 {
            LightPosition::At(place)
        } else {
            LightPosition::Towards(place)
        }
    }

    /// A point on something, if a ray happens to meet it, or in space.
    fn point(&mut self, scene: &Scene) -> SurfacePoint {
        let (origin, direction) = (self.vector(), self.vector());
        let primitive = self.below(scene.primitive_count().into()) as u32;
        let crossing = [Crossing::Entering, Crossing::Leaving][self.below(2) as usize];
        if direction == Vec3::ZERO || self.below(4) == 0 {
            return SurfacePoint::bare(origin).unwrap();
        }
        let position = ExactPosition::Bare(origin);
        match scene.shape(primitive) {
            Some(shape) => {
                let ray = LightPosition::Towards(direction);
                let meeting = integer_shape::meet(ray, shape, &position);
                // Where it passes through one, there are two, or the polynomial is of degree 1.
                if meeting.crossings > 0 {
                    on(primitive, origin, direction, crossing)
                } else {
                    self.point(scene)
                }
            }
            None => {
                let [a, b, c] = scene.corners(primitive).map(|corner| corner.as_dvec3());
                let slope = (b - a).cross(c - a).dot(direction.as_dvec3());
                let source = PointSource::Ray { origin, direction, primitive };
                let point = SurfacePoint { position: DVec3::ZERO, source };
                if slope.abs() > 1e-3 { point } else { self.point(scene) }
            }
        }
    }

    fn scene(&mut self) -> Scene {
        let mut world = World::new();
        for matter in [Matter::Opaque, Matter::Glass] {
            let triangles: Vec<_> = (0..self.below(3)).map(|_| self.triangle()).collect();
            let curved: Vec<_> = (0..self.below(2) + 1).map(|_| self.shape()).collect();
            world = world.with(matter, &triangles, &curved);
        }
        world.scene()
    }
}

/// The polynomial of a surface, and how far inside its bounds a point is.
fn evaluate(shape: &Shape, x: DVec3) -> (f64, f64) {
    match shape {
        Shape::Sphere(s) => ((x - s.centre.as_dvec3()).length() - f64::from(s.radius), 1.0),
        Shape::Ellipsoid(e) => {
            let [a, b, c] = e.axes.map(|axis| axis.as_dvec3());
            let image = glam::DMat3::from_cols(a, b, c).inverse() * (x - e.centre.as_dvec3());
            (image.length() - 1.0, 1.0)
        }
        Shape::Cone(c) => {
            let axis = c.apex.as_dvec3() - c.base.as_dvec3();
            let w = x - c.base.as_dvec3();
            let share = w.dot(axis) / axis.length_squared();
            let (base, apex) = (f64::from(c.base_radius), f64::from(c.apex_radius));
            let radius = base + (apex - base) * share;
            ((w - axis * share).length() - radius, share.min(1.0 - share))
        }
        Shape::Disc(d) => {
            let w = x - d.centre.as_dvec3();
            (w.dot(d.normal.as_dvec3()), f64::from(d.radius) - w.length())
        }
        Shape::Plane(p) => ((x - p.point.as_dvec3()).dot(p.normal.as_dvec3()), 1.0),
        Shape::Quadric(q) => {
            let w = x - q.reference.as_dvec3();
            let [xx, yy, zz, xy, yz, zx] = q.second.map(f64::from);
            let square = xx * w.x * w.x + yy * w.y * w.y + zz * w.z * w.z;
            let mixed = xy * w.x * w.y + yz * w.y * w.z + zx * w.z * w.x;
            let inside = (x - q.low.as_dvec3()).min(q.high.as_dvec3() - x).min_element();
            (square + mixed + q.first.as_dvec3().dot(w) + f64::from(q.constant), inside)
        }
    }
}

/// How often a segment crosses a surface by samples; `None` where that is not clear.
fn sampled(shape: &Shape, from: DVec3, to: DVec3) -> Option<usize> {
    const SAMPLES: u32 = 400;
    const CLEAR: f64 = 1e-4;
    let at = |place: f64| evaluate(shape, from + (to - from) * place);
    let mut count = 0;
    let (mut before, mut last) = (at(-1.0 / f64::from(SAMPLES)), at(0.0));
    if last.0.abs() < CLEAR {
        return None;
    }
    for i in 1..=SAMPLES {
        let next = at(f64::from(i) / f64::from(SAMPLES));
        if next.0.abs() < CLEAR {
            return None;
        }
        if (last.0 < 0.0) != (next.0 < 0.0) {
            // The bounds are left or entered no faster than this between two samples.
            let step = (to - from).length() / f64::from(SAMPLES) * 20.0;
            match (last.1, next.1) {
                (a, b) if a > step && b > step => count += 1,
                (a, b) if a < -step && b < -step => {}
                _ => return None,
            }
        } else if (2.0 * last.0 - before.0) * last.0 <= 0.0 {
            // Two roots could lie between. Otherwise not: along a line these functions are convex or concave.
            return None;
        }
        (before, last) = (last, next);
    }
    Some(count)
}

/// Where a ray passes through a surface, by samples and halving, if it does so clearly.
fn hit(shape: &Shape, origin: Vec3, direction: Vec3) -> Option<(DVec3, Crossing)> {
    let at = |t: f64| origin.as_dvec3() + direction.as_dvec3() * t;
    let value = |t: f64| evaluate(shape, at(t)).0;
    let steps: Vec<f64> = (0..=300).map(|i| f64::from(i) * 0.01).collect();
    let span = steps.windows(2).find(|w| value(w[0]) * value(w[1]) < 0.0)?;
    let (mut low, mut high) = (span[0], span[1]);
    let crossing = if value(low) > 0.0 { Crossing::Entering } else { Crossing::Leaving };
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if (value(middle) > 0.0) == (value(low) > 0.0) { low = middle } else { high = middle }
    }
    Some((at(low), crossing))
}

/// How often a segment from a point of a surface crosses that surface again.
fn sampled_again(shape: &Shape, from: DVec3, to: DVec3) -> Option<usize> {
    let value = |place: f64| evaluate(shape, from + (to - from) * place).0;
    let (soon, later) = (value(1e-4), value(0.01));
    // One other root is all there may be, and it is not before there.
    if soon.abs() < 1e-6 || soon * later <= 0.0 {
        return None;
    }
    sampled(shape, from + (to - from) * 0.01, to)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn the_arbiter_agrees_with_the_definition(seed in 1u64.., whole in prop::bool::weighted(0.7)) {
        let mut numbers = Numbers { state: seed, whole };
        let scene = numbers.scene();
        for _ in 0..3 {
            let light = numbers.light();
            let index = SceneIndex::new(&scene);
            let arbiter = Arbiter::new(&BuildInput::new(&scene, &index, light));
            let points: Vec<_> = (0..6).map(|_| numbers.point(&scene)).collect();
            let plain = PlainTest::new(&scene, light, &points);
            for point in &points {
                let truth = arbiter.decide(point);
                prop_assert_eq!(truth.occlusion, plain.decide(point), "{:?} {:?}", light, point);
                prop_assert_eq!(arbiter.crossed(point), plain.crossed(point), "{:?} {:?}", light, point);
                // What stops at a passage has met nothing that touches.
                let meetings = arbiter.meetings(point);
                let opaque = meetings.iter().filter(|(primitive, _)| !scene.is_transparent(*primitive));
                let blocked = opaque.clone().any(|(_, meeting)| *meeting != Meeting::EndsOn);
                prop_assert_eq!(blocked, truth.occlusion == Occlusion::Occluded);
            }
        }
    }

    #[test]
    fn what_is_clear_cut_in_f64_is_so_exactly(seed in 1u64..) {
        let mut numbers = Numbers { state: seed, whole: false };
        let shape = numbers.shape();
        let solid = curved(&[shape]);
        let glass = World::new().with(Matter::Glass, &[], &[shape]).scene();
        for _ in 0..8 {
            let (from, to) = (numbers.vector(), numbers.vector());
            let Some(count) = sampled(&shape, from.as_dvec3(), to.as_dvec3()) else { continue };
            let (point, light) = (SurfacePoint::bare(from).unwrap(), LightPosition::At(to));
            let expected = if count > 0 { OCCLUDED } else { LIT };
            prop_assert_eq!(truth(&solid, light, point), expected, "{:?} {:?} {:?}", shape, from, to);
            prop_assert_eq!(crossed(&glass, light, point).len(), count);
            // A light far beyond in the same direction sees no less of it.
            let far = LightPosition::Towards(to - from);
            let beyond = (to - from) * 1e3 + from;
            if to != from && crossed(&glass, LightPosition::At(beyond), point).len() == count {
                prop_assert!(crossed(&glass, far, point).len() >= count);
            }
        }
    }

    #[test]
    fn points_on_surfaces_are_where_f64_has_them(seed in 1u64..) {
        let mut numbers = Numbers { state: seed, whole: false };
        let shapes = [numbers.shape(), numbers.shape()];
        let scene = World::new().with(Matter::Glass, &[], &shapes).scene();
        for _ in 0..8 {
            let (origin, direction, light) = (numbers.vector(), numbers.vector(), numbers.vector());
            let Some((place, crossing)) = hit(&shapes[0], origin, direction) else { continue };
            let to = light.as_dvec3();
            let again = match shapes[0] {
                Shape::Disc(_) | Shape::Plane(_) => Some(0),
                _ => sampled_again(&shapes[0], place, to),
            };
            let (Some(own), Some(other)) = (again, sampled(&shapes[1], place, to)) else { continue };
            let expected: Vec<_> = [vec![0; own], vec![1; other]].concat();
            let point = on(0, origin, direction, crossing);
            let found = crossed(&scene, LightPosition::At(light), point);
            prop_assert_eq!(found, expected, "{:?} {:?} {:?} {:?}", shapes, origin, direction, light);
        }
    }

    #[test]
    fn what_intervals_decide_is_right(seed in 1u64..) {
        let mut numbers = Numbers { state: seed, whole: false };
        let scene = curved(&[numbers.shape(), numbers.shape()]);
        let light = numbers.light();
        let point = numbers.point(&scene);
        let query = Query::new(&scene, light, &point);
        let casters = Casters::new(&scene, light, vec![0, 1]);
        let exact = |caster: &Caster| {
            let shape = scene.shape(caster.primitive).unwrap();
            integer_shape::meet(light, shape, &query.position)
        };
        casters.walk_to_light(&query.absolute(), |caster| {
            let (certain, exact) = (query.certainly_crossed(caster), exact(caster));
            assert!(certain.is_none_or(|count| count == exact.crossings), "{certain:?} {exact:?}");
            Visit::Continue
        });
    }
}

#[test]
fn hardly_a_query_goes_past_intervals() {
    let mut numbers = Numbers { state: 0x9e37_79b9_7f4a_7c15, whole: false };
    let (mut asked, mut open) = (0, 0);
    for _ in 0..300 {
        let scene = curved(&[numbers.shape(), numbers.shape(), numbers.shape()]);
        let light = numbers.light();
        let casters = Casters::new(&scene, light, vec![0, 1, 2]);
        for _ in 0..10 {
            let query = Query::new(&scene, light, &numbers.point(&scene));
            casters.walk_to_light(&query.absolute(), |caster| {
                asked += 1;
                open += usize::from(query.certainly_crossed(caster).is_none());
                Visit::Continue
            });
        }
    }
    assert!(asked > 3000 && open * 500 < asked, "{open} of {asked}");
}
