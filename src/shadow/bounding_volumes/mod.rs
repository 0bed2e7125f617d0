//! The control of the 1986 paper's timings (row 22 of its notes): a volume around each object that casts,
//! hierarchical clusters of these volumes, and every polygon of an object whose volume is met.
//!
//! Volumes are boxes or spheres, whichever has the smaller surface. Inside an object nothing is skipped, as
//! in the paper: what that costs is what the light buffer is held against.

mod hierarchy;

use super::brute_force::{Batch, BruteForce};
use super::{Basis, BuildInput, Counters, ShadowTester, TesterEntry};
use crate::error::Result;
use crate::geometry::batch::{InstructionSet, LANES};
use crate::geometry::volume::{LightSegment, Volume};
use crate::scene::{PrimitiveIndex, Scene};
use crate::visibility::SurfacePoint;
use hierarchy::{Hierarchy, Member, Node};
use std::ops::Range;

/// `bounding-volumes` in the registry.
pub const ENTRY: TesterEntry = TesterEntry {
    name: "bounding-volumes",
    basis: Basis::Exact,
    build: &|input| Ok(Box::new(BoundingVolumes::new(input, InstructionSet::best()))),
    // In the worst case all triangles are one object, which every segment meets.
    expected_tests: |casters, queries| casters * queries,
};

/// An object that casts, as one light sees it.
pub(super) struct CastObject {
    /// Its index in the scene.
    pub object: u32,
    /// Its casters.
    pub casters: Range<usize>,
    /// Around the triangles of these.
    pub volume: Volume,
}

/// The objects that some casters belong to, and volumes around them. `primitives` are the casters' triangles
/// in the order of the scene, so that those of one object follow each other.
pub(super) fn cast_objects(scene: &Scene, primitives: &[PrimitiveIndex]) -> Vec<CastObject> {
    let object = |primitive: PrimitiveIndex| scene.triangles[primitive as usize].object;
    let mut end = 0;
    let around = |of_one: &[PrimitiveIndex]| {
        let first = end;
        end += of_one.len();
        let corners = of_one.iter().flat_map(|&t| scene.corners(t));
        let volume = Volume::around(corners).expect("an object has triangles");
        CastObject { object: object(of_one[0]), casters: first..end, volume }
    };
    primitives.chunk_by(|&a, &b| object(a) == object(b)).map(around).collect()
}

/// The volumes of a scene's objects as one light sees them.
pub struct BoundingVolumes<'a> {
    /// All casters, object by object.
    casters: BruteForce<'a>,
    /// Casters of each object that has some.
    objects: Vec<Range<usize>>,
    hierarchy: Hierarchy,
}

impl<'a> BoundingVolumes<'a> {
    /// Puts volumes around the objects and clusters them; `instruction_set` must be available.
    pub fn new(input: &BuildInput<'a>, instruction_set: InstructionSet) -> BoundingVolumes<'a> {
        let casters = BruteForce::new(input, instruction_set);
        let objects = cast_objects(input.scene, &casters.casters.primitives);
        let member = |o: &CastObject| Member { volume: o.volume, cost: o.casters.len() as f64 };
        let members: Vec<Member> = objects.iter().map(member).collect();
        let objects = objects.into_iter().map(|object| object.casters).collect();
        BoundingVolumes { casters, objects, hierarchy: Hierarchy::new(&members) }
    }

    /// A bit for each point of a batch that is occluded.
    fn occluded_batch(&self, batch: &Batch, segments: &[LightSegment], counters: &mut Counters) -> u16 {
        let mut live = batch.all;
        let mut pending: Vec<(&Node, u16)> =
            self.hierarchy.root().map(|root| (root, live)).into_iter().collect();
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
                    let object = self.objects[object as usize].clone();
                    live &= !self.casters.blocked(batch, object, met, counters);
                }
                hierarchy::Content::Cluster(parts) => {
                    pending.extend(parts.iter().map(|&part| (self.hierarchy.node(part), met)));
                }
            }
        }
        batch.all & !live
    }
}

impl ShadowTester for BoundingVolumes<'_> {
    fn occluded(&self, points: &[SurfacePoint], answers: &mut [bool]) -> Result<Counters> {
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

    fn bytes(&self) -> usize {
        self.casters.bytes() + self.objects.len() * size_of::<Range<usize>>() + self.hierarchy.bytes()
    }

    fn statistics(&self) -> Vec<(&'static str, String)> {
        vec![
            ("objects", self.objects.len().to_string()),
            ("bounding volumes", self.hierarchy.count().to_string()),
            ("of them spheres", self.hierarchy.spheres().to_string()),
            ("deepest volume", self.hierarchy.depth().to_string()),
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
        assert_eq!((tester.objects.len(), tester.hierarchy.count()), (4, 7));
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
}
