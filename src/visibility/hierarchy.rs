//! First hits of any rays through a hierarchy of boxes: what rays of reflection and refraction ask (row 22 of
//! the notes on the 1986 paper).

use super::hit::{FirstHits, Hit, is_there_beyond, keep_nearer};
use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::geometry::curved::{Crossing, RayStart};
use crate::geometry::ray_triangle;
use crate::scene::{Camera, ImageSize, Primitive, PrimitiveIndex, Scene};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Most primitives of a leaf.
const LEAF: usize = 4;

/// Boxes are widened by this share of the numbers that go into a test, above f64 rounding: a difference of floats
/// loses 1 roundoff and the slack itself 2 more, a quotient 1; this is 64.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// A ray with the place where it begins.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// A point of the line, in world space.
    pub origin: Vec3,
    /// Not normalised, not zero.
    pub direction: Vec3,
    /// Where on the line it begins.
    pub start: RayStart,
}

/// What a ray hits first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstHit {
    /// The primitive.
    pub primitive: PrimitiveIndex,
    /// Of a curved surface, which of its points.
    pub crossing: Option<Crossing>,
}

struct Node {
    low: Vec3,
    high: Vec3,
    content: Content,
}

enum Content {
    /// A range of the reordered primitives.
    Leaf(std::ops::Range<u32>),
    /// Two nodes.
    Inner(u32, u32),
}

/// First hits of a camera's rays, one by one.
pub fn first_hits(scene: &Scene, camera: &Camera, size: ImageSize) -> FirstHits {
    let _floats = StandardFloats::new();
    let hierarchy = Hierarchy::new(scene);
    let raster = camera.raster(size);
    let found: Vec<(Option<FirstHit>, u64)> = (0..size.pixels() as u32)
        .into_par_iter()
        .in_standard_floats()
        .map(|pixel| {
            let direction = camera.direction(&raster, pixel % size.width, pixel / size.width);
            hierarchy.search(&Ray { origin: camera.origin, direction, start: RayStart::origin() })
        })
        .collect();
    let tests = found.iter().map(|(_, tests)| tests).sum();
    let primitives = found.into_iter().map(|(hit, _)| hit.map(|hit| hit.primitive)).collect();
    FirstHits { size, primitives, tests }
}

/// All primitives of a scene in a tree of boxes.
pub struct Hierarchy<'a> {
    scene: &'a Scene,
    nodes: Vec<Node>,
    order: Vec<PrimitiveIndex>,
    /// Planes without end, which no box holds.
    endless: Vec<PrimitiveIndex>,
}

impl<'a> Hierarchy<'a> {
    /// Builds the tree by halving along the longest axis of the centres.
    pub fn new(scene: &'a Scene) -> Hierarchy<'a> {
        let _floats = StandardFloats::new();
        let bounds: Vec<Option<(Vec3, Vec3)>> =
            (0..scene.primitive_count()).map(|p| scene.primitive_bounds(p)).collect();
        let (mut order, endless): (Vec<u32>, Vec<u32>) =
            (0..scene.primitive_count()).partition(|&p| bounds[p as usize].is_some());
        let boxes: Vec<(Vec3, Vec3)> = bounds.into_iter().map(Option::unwrap_or_default).collect();
        let mut hierarchy = Hierarchy { scene, nodes: Vec::new(), order: Vec::new(), endless };
        if !order.is_empty() {
            hierarchy.add(&boxes, &mut order, 0);
        }
        hierarchy.order = order;
        hierarchy
    }

    fn add(&mut self, boxes: &[(Vec3, Vec3)], order: &mut [u32], first: usize) -> u32 {
        let ends = order.iter().map(|&p| boxes[p as usize]);
        let join = |(low, high): (Vec3, Vec3), (l, h): (Vec3, Vec3)| (low.min(l), high.max(h));
        let (low, high) = ends.reduce(join).expect("a node holds something");
        let index = self.nodes.len();
        let leaf = Content::Leaf(first as u32..(first + order.len()) as u32);
        self.nodes.push(Node { low, high, content: leaf });
        if order.len() > LEAF {
            let axis = (high * 0.5 - low * 0.5).max_position();
            let centre = |&p: &u32| {
                let (low, high) = boxes[p as usize];
                f64::from(low[axis]) + f64::from(high[axis])
            };
            let middle = order.len() / 2;
            order.select_nth_unstable_by(middle, |a, b| centre(a).total_cmp(&centre(b)).then(a.cmp(b)));
            let (left, right) = order.split_at_mut(middle);
            let left = self.add(boxes, left, first);
            let right = self.add(boxes, right, first + middle);
            self.nodes[index].content = Content::Inner(left, right);
        }
        index as u32
    }

    /// What a ray hits first, by the rule of the t-buffer.
    pub fn first_hit(&self, ray: &Ray) -> Option<FirstHit> {
        let _floats = StandardFloats::new();
        self.search(ray).0
    }

    /// The same, and the number of primitives that were tested.
    fn search(&self, ray: &Ray) -> (Option<FirstHit>, u64) {
        let mut nearest = None;
        let mut tests = self.endless.len() as u64;
        for &primitive in &self.endless {
            self.try_primitive(ray, primitive, &mut nearest);
        }
        let slabs = Slabs::new(ray);
        let mut stack = Vec::with_capacity(64);
        let enters = |node: u32| {
            let Node { low, high, .. } = &self.nodes[node as usize];
            slabs.enters(low.as_dvec3(), high.as_dvec3())
        };
        stack.extend((!self.nodes.is_empty()).then_some(0).and_then(|root| Some((enters(root)?, root))));
        while let Some((entry, node)) = stack.pop() {
            if nearest.is_some_and(|hit: Hit| entry > hit.parameter.value + hit.parameter.error) {
                continue;
            }
            match &self.nodes[node as usize].content {
                Content::Leaf(range) => {
                    tests += range.len() as u64;
                    for &primitive in &self.order[range.start as usize..range.end as usize] {
                        self.try_primitive(ray, primitive, &mut nearest);
                    }
                }
                Content::Inner(left, right) => {
                    let children = [*left, *right].map(|child| Some((enters(child)?, child)));
                    match children {
                        // The nearer one is looked at first.
                        [Some(one), Some(other)] if one.0 <= other.0 => stack.extend([other, one]),
                        _ => stack.extend(children.into_iter().flatten()),
                    }
                }
            }
        }
        (nearest.map(|hit| FirstHit { primitive: hit.primitive, crossing: hit.crossing }), tests)
    }

    fn try_primitive(&self, ray: &Ray, primitive: PrimitiveIndex, nearest: &mut Option<Hit>) {
        let (scene, Ray { origin, direction, start }) = (self.scene, *ray);
        let hit = match scene.primitive(primitive) {
            Primitive::Triangle(corners) => ray_triangle::hit_beyond(origin, direction, corners, &start)
                .filter(|_| is_there_beyond(scene, primitive, origin, direction))
                .map(|parameter| Hit::flat(primitive, parameter)),
            Primitive::Curved(_) => Hit::curved(scene, primitive, origin, direction, &start),
        };
        if let Some(hit) = hit {
            keep_nearer(nearest, hit, scene, origin, direction);
        }
    }
}

/// A ray as boxes are tested against it.
struct Slabs {
    origin: DVec3,
    direction: DVec3,
    start: f64,
}

impl Slabs {
    fn new(ray: &Ray) -> Slabs {
        let start = ray.start.rounded();
        let start = if start.error.is_finite() { start.value - start.error } else { f64::NEG_INFINITY };
        Slabs { origin: ray.origin.as_dvec3(), direction: ray.direction.as_dvec3(), start }
    }

    /// At most the place where the ray enters a box, or `None` if it certainly passes by.
    fn enters(&self, low: DVec3, high: DVec3) -> Option<f64> {
        let (mut first, mut last) = (self.start, f64::INFINITY);
        for k in 0..3 {
            let (o, d) = (self.origin[k], self.direction[k]);
            let slack = (o.abs() + low[k].abs().max(high[k].abs())) * ROUNDING;
            let (near, far) = (low[k] - o - slack, high[k] - o + slack);
            if d == 0.0 {
                if near > 0.0 || far < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (near / d, far / d);
            let widen = |t: f64, sign: f64| t + sign * t.abs() * ROUNDING;
            first = first.max(widen(a.min(b), -1.0));
            last = last.min(widen(a.max(b), 1.0));
        }
        (first <= last).then_some(first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::tests as shapes;
    use crate::scene::{Camera, ImageSize, ObjectInput, SceneBuilder};
    use crate::visibility::classical;
    use proptest::prelude::*;

    fn coordinate() -> impl Strategy<Value = f32> {
        prop_oneof![(-4i32..5).prop_map(|x| x as f32 * 0.5), -3.0f32..3.0]
    }

    fn point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(coordinate()).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn camera_rays_hit_what_classical_ones_do(
            triangles in prop::collection::vec(prop::array::uniform3(point()), 0..8),
            shapes in prop::collection::vec(shapes::shape(), 0..8),
            eye in prop::array::uniform3(-3.0f32..3.0),
        ) {
            let mut builder = SceneBuilder::new("test");
            for triangle in triangles {
                builder.add_object(ObjectInput::new("t", triangle.to_vec(), vec![[0, 1, 2]])).unwrap();
            }
            let object = ObjectInput { curved: shapes, ..ObjectInput::new("s", vec![], vec![]) };
            builder.add_object(object).unwrap();
            let scene = builder.finish();
            let camera = Camera::look_at("c", Vec3::from(eye), Vec3::ZERO, Vec3::Y, 70.0);
            let size = ImageSize { width: 23, height: 17 };
            let expected = classical::first_hits(&scene, &camera, size);
            let found = first_hits(&scene, &camera, size);
            prop_assert_eq!(&found.primitives, &expected.primitives);
            prop_assert!(found.tests <= expected.tests);
        }

        /// From where a ray hits something, the rest of it does not hit that point again.
        #[test]
        fn what_is_behind_a_hit_is_found_from_there(
            triangles in prop::collection::vec(prop::array::uniform3(point()), 2..8),
            origin in point(),
            direction in point(),
        ) {
            prop_assume!(direction != Vec3::ZERO);
            let mut builder = SceneBuilder::new("test");
            for triangle in triangles {
                builder.add_object(ObjectInput::new("t", triangle.to_vec(), vec![[0, 1, 2]])).unwrap();
            }
            let scene = builder.finish();
            let hierarchy = Hierarchy::new(&scene);
            let mut ray = Ray { origin, direction, start: RayStart::origin() };
            let mut before = None;
            for _ in 0..8 {
                let Some(hit) = hierarchy.first_hit(&ray) else { break };
                let corners = scene.corners(hit.primitive);
                let place = ray_triangle::exact_parameter(origin, direction, corners);
                if let Some(before) = before {
                    prop_assert!(place.order(&before) == std::cmp::Ordering::Greater);
                }
                before = Some(place);
                ray.start = RayStart::on_triangle(origin, direction, corners);
            }
        }
    }
}
