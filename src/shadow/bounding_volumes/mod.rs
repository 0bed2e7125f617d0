//! The control of the 1986 paper's timings (row 22 of its notes): a volume around each object that casts,
//! hierarchical clusters of these volumes, and every polygon of an object whose volume is met.
//!
//! Volumes are boxes or spheres, whichever has the smaller surface. Inside an object nothing is skipped, as
//! in the paper: what that costs is what the light buffer is held against.

mod hierarchy;

use super::brute_force::{Batch, BruteForce};
use super::precise::crossed_among;
use super::{Basis, BuildInput, Counters, Crossings, Lights, ShadowTester, TesterEntry};
use crate::error::Result;
use crate::float_environment::StandardFloats;
use crate::geometry::batch::{InstructionSet, LANES};
use crate::geometry::curved::Shape;
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::volume::{LightSegment, Volume};
use crate::scene::{Primitive, PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;
use glam::Vec3;
use hierarchy::{Hierarchy, Member, Node};
use std::ops::Range;

/// `bounding-volumes` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "bounding-volumes",
    basis: Basis::Exact,
    lights: Lights::All,
    of_scene: None,
    build: &|input| {
        let _floats = StandardFloats::new();
        Ok(Box::new(BoundingVolumes::new(input, input.instruction_set)))
    },
    // In the worst case all triangles are one object, which every segment meets.
    expected_tests: |casters, queries| casters * queries,
};

/// Primitives of one object that cast, as one light sees them.
pub(super) struct CastObject {
    /// Its index in the scene.
    pub object: u32,
    /// Its casters, or those of one kind.
    pub casters: Range<usize>,
    /// Around these.
    pub volume: Volume,
}

/// The objects that some casters belong to, and volumes around them. `primitives` are the casters' in the order
/// of the scene: an object with triangles and curved surfaces is there once for each of the two. Planes without
/// end are in no volume and are left out.
pub(super) fn cast_objects(scene: &Scene, primitives: &[PrimitiveIndex]) -> Vec<CastObject> {
    let kind = |p: PrimitiveIndex| (scene.object_index(p), scene.is_curved(p), is_endless(scene, p));
    let mut end = 0;
    let around = |of_one: &[PrimitiveIndex]| {
        let first = end;
        end += of_one.len();
        let ends = of_one.iter().flat_map(|&p| match scene.primitive(p) {
            Primitive::Triangle(corners) => corners.to_vec(),
            // Two corners would do for a box around them, but not for a sphere.
            Primitive::Curved(shape) => shape.bounds().map_or(vec![], |ends| box_corners(ends).to_vec()),
        });
        let volume = Volume::around(ends)?;
        Some(CastObject { object: scene.object_index(of_one[0]), casters: first..end, volume })
    };
    primitives.chunk_by(|&a, &b| kind(a) == kind(b)).filter_map(around).collect()
}

/// All corners of a box, of which the lowest and the highest are given.
fn box_corners((low, high): (Vec3, Vec3)) -> [Vec3; 8] {
    let side = |corner: usize, axis: usize| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] };
    std::array::from_fn(|corner| Vec3::from_array([0, 1, 2].map(|axis| side(corner, axis))))
}

/// Whether no volume holds a primitive.
pub(super) fn is_endless(scene: &Scene, primitive: PrimitiveIndex) -> bool {
    scene.shape(primitive).is_some_and(Shape::is_endless)
}

/// Volumes around runs of casters, and clusters of them.
struct Clusters {
    /// Casters of each object that has some.
    objects: Vec<Range<usize>>,
    hierarchy: Hierarchy,
    /// Casters that no volume holds.
    endless: Vec<usize>,
}

impl Clusters {
    fn new(scene: &Scene, primitives: &[PrimitiveIndex]) -> Clusters {
        let objects = cast_objects(scene, primitives);
        let member = |o: &CastObject| Member { volume: o.volume, cost: o.casters.len() as f64 };
        let members: Vec<Member> = objects.iter().map(member).collect();
        Clusters {
            objects: objects.into_iter().map(|object| object.casters).collect(),
            hierarchy: Hierarchy::new(&members),
            endless: (0..primitives.len()).filter(|&i| is_endless(scene, primitives[i])).collect(),
        }
    }

    fn bytes(&self) -> usize {
        self.objects.len() * size_of::<Range<usize>>()
            + self.endless.len() * size_of::<usize>()
            + self.hierarchy.bytes()
    }
}

/// The volumes of a scene's objects as one light sees them.
pub struct BoundingVolumes<'a> {
    scene: &'a Scene,
    /// All opaque casters, object by object.
    casters: BruteForce<'a>,
    clusters: Clusters,
    /// Transparent ones, if there are any.
    transparent: Option<(&'a [PrimitiveIndex], Clusters)>,
}

impl<'a> BoundingVolumes<'a> {
    /// Puts volumes around the objects and clusters them; `instruction_set` must be available.
    pub fn new(input: &BuildInput<'a>, instruction_set: InstructionSet) -> BoundingVolumes<'a> {
        let casters = BruteForce::new(input, instruction_set);
        let clusters = Clusters::new(input.scene, &casters.casters.primitives);
        let transparent = &input.index.transparent[..];
        let transparent =
            (!transparent.is_empty()).then(|| (transparent, Clusters::new(input.scene, transparent)));
        BoundingVolumes { scene: input.scene, casters, clusters, transparent }
    }

    /// A bit for each point of a batch that is occluded.
    fn occluded_batch(&self, batch: &Batch, segments: &[LightSegment], counters: &mut Counters) -> u16 {
        let mut live = batch.all;
        for &caster in &self.clusters.endless {
            live &= !self.casters.blocked(batch, caster..caster + 1, live, counters);
        }
        let hierarchy = &self.clusters.hierarchy;
        let mut pending: Vec<(&Node, u16)> = hierarchy.root().map(|root| (root, live)).into_iter().collect();
        while let Some((node, lanes)) = pending.pop() {
            let lanes = lanes & live;
            let met = segments
                .iter()
                .enumerate()
                .filter(|&(i, segment)| lanes >> i & 1 == 1 && node.volume.may_be_met_by(segment))
                .fold(0, |met, (i, _)| met | 1 << i);
            counters.volume_tests += u64::from(lanes.count_ones());
            if met == 0 {
                continue;
            }
            match node.content {
                hierarchy::Content::Object(object) => {
                    let object = self.clusters.objects[object as usize].clone();
                    live &= !self.casters.blocked(batch, object, met, counters);
                }
                hierarchy::Content::Cluster(parts) => {
                    pending.extend(parts.iter().map(|&part| (hierarchy.node(part), met)));
                }
            }
        }
        batch.all & !live
    }

    /// The transparent casters in volumes that a segment may meet.
    fn transparent_near(&self, segment: &LightSegment, counters: &mut Counters) -> Vec<PrimitiveIndex> {
        let Some((primitives, clusters)) = &self.transparent else { return Vec::new() };
        let mut near: Vec<_> = clusters.endless.iter().map(|&i| primitives[i]).collect();
        let mut pending: Vec<&Node> = clusters.hierarchy.root().into_iter().collect();
        while let Some(node) = pending.pop() {
            counters.volume_tests += 1;
            if !node.volume.may_be_met_by(segment) {
                continue;
            }
            match node.content {
                hierarchy::Content::Object(object) => {
                    near.extend_from_slice(&primitives[clusters.objects[object as usize].clone()]);
                }
                hierarchy::Content::Cluster(parts) => {
                    pending.extend(parts.iter().map(|&part| clusters.hierarchy.node(part)));
                }
            }
        }
        near
    }
}

impl ShadowTester for BoundingVolumes<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
        let _floats = StandardFloats::new();
        let mut counters = Counters::default();
        let space = &self.casters.casters.space;
        for (points, answers) in points.chunks(LANES).zip(answers.chunks_mut(LANES)) {
            let batch = self.casters.batch(points);
            let segments: Vec<_> = points.iter().map(|p| LightSegment::new(space, p.position)).collect();
            let occluded = self.occluded_batch(&batch, &segments, &mut counters);
            for (i, answer) in answers.iter_mut().enumerate() {
                *answer = occluded >> i & 1 == 1;
            }
        }
        Ok(counters)
    }

    fn crossed(&self, points: &[SurfacePoint], crossings: &mut Crossings) -> Result<Counters> {
        let _floats = StandardFloats::new();
        let mut counters = Counters::default();
        let space = &self.casters.casters.space;
        for point in points {
            let query = PreciseQuery::new(space, point.position, || point.exact(self.scene));
            let segment = LightSegment::new(space, point.position);
            let near = self.transparent_near(&segment, &mut counters);
            crossings.push(crossed_among(self.scene, near, point.primitive(), &query, &mut counters));
        }
        Ok(counters)
    }

    fn bytes(&self) -> usize {
        let transparent = self.transparent.as_ref().map_or(0, |(_, clusters)| clusters.bytes());
        self.casters.bytes() + self.clusters.bytes() + transparent
    }

    fn statistics(&self) -> Vec<(&'static str, String)> {
        vec![
            ("objects", self.clusters.objects.len().to_string()),
            ("bounding volumes", self.clusters.hierarchy.count().to_string()),
            ("of them spheres", self.clusters.hierarchy.spheres().to_string()),
            ("deepest volume", self.clusters.hierarchy.depth().to_string()),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ObjectInput, SceneBuilder, Shadowing};
    use crate::shadow::SceneIndex;
    use glam::Vec3;

    /// Squares in the plane y = 1, of two triangles each, at some places along x; and one that casts nothing.
    fn squares(places: &[f32]) -> Scene {
        let mut builder = SceneBuilder::new("squares");
        let mut add = |x: f32, casts: bool| {
            let corner = |dx: f32, z: f32| Vec3::new(x + dx, 1.0, z);
            let positions = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
            let mut input = ObjectInput::new("square", positions, vec![[0, 1, 2], [0, 2, 3]]);
            input.shadowing = Shadowing { casts, receives: true };
            builder.add_object(input).unwrap();
        };
        places.iter().for_each(|&x| add(x, true));
        add(-50.0, false);
        builder.finish()
    }

    #[test]
    fn only_objects_whose_volume_is_met_are_tested() {
        let scene = squares(&[0.0, 10.0, 20.0, 30.0]);
        let index = SceneIndex::new(&scene);
        let input = BuildInput::new(&scene, &index, Vec3::new(20.5, 5.0, 0.5));
        let tester = BoundingVolumes::new(&input, InstructionSet::Portable);
        assert_eq!((tester.clusters.objects.len(), tester.clusters.hierarchy.count()), (4, 7));
        let points = [Vec3::new(20.5, 0.0, 0.25), Vec3::new(20.5, 2.0, 0.25), Vec3::new(25.0, 0.0, 0.5)]
            .map(|p| SurfacePoint::bare(p).unwrap());
        let mut answers = [false; 3];
        let counters = tester.occluded(&points, &mut answers).unwrap();
        assert_eq!(answers, [true, false, false]);
        assert!(counters.tests <= 2 && counters.volume_tests > 3, "{counters:?}");
    }

    #[test]
    fn a_scene_without_casters_darkens_nothing() {
        let scene = squares(&[]);
        let index = SceneIndex::new(&scene);
        let tester =
            BoundingVolumes::new(&BuildInput::new(&scene, &index, Vec3::Y), InstructionSet::Portable);
        let mut answers = [true];
        let counters = tester.occluded(&[SurfacePoint::bare(Vec3::ZERO).unwrap()], &mut answers).unwrap();
        assert_eq!((answers, counters), ([false], Counters::default()));
    }

    /// A sphere around the lowest and the highest corners of the boxes of both would leave out a piece of one.
    #[test]
    fn a_volume_holds_all_of_every_curved_surface() {
        let spheres = [Vec3::new(-4.0, -1172.0, -12.0), Vec3::new(-16.0, -1184.0, 12.0)];
        let mut builder = SceneBuilder::new("spheres");
        let curved = spheres.map(|centre| Shape::sphere(centre, 8.0)).to_vec();
        builder
            .add_object(ObjectInput { curved, ..ObjectInput::new("both", Vec::new(), Vec::new()) })
            .unwrap();
        let scene = builder.finish();
        let [both] = &cast_objects(&scene, &[0, 1])[..] else { panic!("one object") };
        for sphere in spheres {
            let is_inside = match both.volume {
                Volume::Sphere { centre, radius } => centre.distance(sphere) + 8.0 <= radius,
                Volume::Box { low, high } => (low.cmple(sphere - 8.0) & high.cmpge(sphere + 8.0)).all(),
            };
            assert!(is_inside, "{:?}", both.volume);
        }
    }
}
