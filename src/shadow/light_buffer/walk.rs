//! A query goes through a cell's list, from the front until a primitive blocks or the next one begins behind
//! the point (rows 8, 15, 16 and 17 of the notes on the 1986 paper).

use super::groups::Group;
use super::{LightBuffer, Record};
use crate::geometry::occlusion::PreciseQuery;
use crate::geometry::volume::LightSegment;
use crate::geometry::{ExactPosition, Filtered, LightPoint};
use crate::scene::PrimitiveIndex;
use crate::shadow::Counters;
use crate::shadow::precise::{self, is_there};
use crate::visibility::SurfacePoint;
use glam::DVec3;

/// A query, made ready for many triangles.
pub(super) struct Asked<'q, F> {
    precise: &'q PreciseQuery<F>,
    rounded: DVec3,
    relative: LightPoint,
    base: Option<PrimitiveIndex>,
    /// The base, if it cannot block its own points (row 15): a curved surface may.
    untested: Option<PrimitiveIndex>,
    harmless: Option<u32>,
}

/// How a walk through a run of records ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Walk {
    /// At this caster, which blocks.
    Blocked(u32),
    /// At a record behind the point, and so are all that follow in the run.
    Behind,
    /// At the end of the run.
    Through,
}

impl<F> Asked<'_, F> {
    /// The point relative to the light.
    pub(super) fn relative(&self) -> &LightPoint {
        &self.relative
    }
}

impl LightBuffer<'_> {
    /// Makes a query ready.
    pub(super) fn asked<'q, F>(&self, point: &SurfacePoint, precise: &'q PreciseQuery<F>) -> Asked<'q, F> {
        let base = point.primitive();
        Asked {
            precise,
            rounded: point.position,
            relative: LightPoint::new(&self.casters.space, point.position),
            base,
            untested: base.filter(|&base| !self.scene.is_curved(base)),
            harmless: base.and_then(|base| self.harmless.of(base)),
        }
    }

    /// The caster of a list that blocks, if one does. `z_high` is at least the exact z' of the point.
    pub(super) fn blocking_caster<F: Fn() -> ExactPosition>(
        &self,
        list: &[Record],
        groups: &[Group],
        asked: &Asked<F>,
        z_high: f64,
        counters: &mut Counters,
    ) -> Option<u32> {
        let mut rest = list;
        if !groups.is_empty() {
            match self.walk_groups(list, groups, asked, z_high, counters) {
                (Walk::Blocked(caster), _) => return Some(caster),
                (Walk::Behind, _) => return None,
                (Walk::Through, behind_groups) => rest = behind_groups,
            }
        }
        match self.walk(rest, asked, z_high, counters) {
            Walk::Blocked(caster) => Some(caster),
            Walk::Behind | Walk::Through => None,
        }
    }

    /// Goes to the end of the last group, and returns the records behind it. Between groups, records and the
    /// first ones of groups are sorted by depth; records in a group are sorted among themselves.
    fn walk_groups<'l, F: Fn() -> ExactPosition>(
        &self,
        list: &'l [Record],
        groups: &[Group],
        asked: &Asked<F>,
        z_high: f64,
        counters: &mut Counters,
    ) -> (Walk, &'l [Record]) {
        let segment = LightSegment::new(&self.casters.space, asked.rounded);
        let mut next = 0;
        for group in groups {
            let single = &list[next..group.first as usize];
            match self.walk(single, asked, z_high, counters) {
                Walk::Through => {}
                ended => return (ended, &[]),
            }
            let members = group.members(list);
            if f64::from(members[0].near) >= z_high {
                return (Walk::Behind, &[]);
            }
            if self.is_met(group.object, asked, &segment, counters) {
                // A member behind the point ends its group alone: what follows the group may lie before it.
                match self.walk(members, asked, z_high, counters) {
                    Walk::Behind | Walk::Through => {}
                    blocked => return (blocked, &[]),
                }
            }
            next = group.end as usize;
        }
        (Walk::Through, &list[next..])
    }

    /// Whether a segment may meet an object's volume. The volume of the object that the point lies on is met,
    /// without a test, unless that object is harmless and may be skipped as a whole.
    fn is_met<F>(
        &self,
        object: u32,
        asked: &Asked<F>,
        segment: &LightSegment,
        counters: &mut Counters,
    ) -> bool {
        if asked.base.is_some_and(|base| self.scene.object_index(base) == object) {
            return asked.harmless != Some(object);
        }
        counters.volume_tests += 1;
        let volume = self.volumes[object as usize].expect("an object with records has a volume");
        volume.may_be_met_by(segment)
    }

    /// Goes through records that are in ascending order of a lower bound of their depth.
    fn walk<F: Fn() -> ExactPosition>(
        &self,
        records: &[Record],
        asked: &Asked<F>,
        z_high: f64,
        counters: &mut Counters,
    ) -> Walk {
        for record in records {
            // Nothing further on can lie before the point.
            if f64::from(record.near) >= z_high {
                return Walk::Behind;
            }
            if self.blocks(record.caster, asked, counters) {
                return Walk::Blocked(record.caster);
            }
        }
        Walk::Through
    }

    /// Whether a caster blocks.
    #[inline(always)]
    pub(super) fn blocks<F: Fn() -> ExactPosition>(
        &self,
        caster: u32,
        asked: &Asked<F>,
        counters: &mut Counters,
    ) -> bool {
        let primitive = self.casters.primitives[caster as usize];
        // Rows 15 and 16: neither the base surface nor its own convex object.
        let is_harmless = |object| self.scene.object_index(primitive) == object;
        if asked.untested == Some(primitive) || asked.harmless.is_some_and(is_harmless) {
            return false;
        }
        counters.tests += 1;
        match self.casters.planes[caster as usize].classify(&asked.relative) {
            Filtered::Blocks => is_there(self.scene, primitive, asked.precise),
            Filtered::Clear => false,
            Filtered::Undecided => {
                counters.undecided += u64::from(!self.scene.is_curved(primitive));
                precise::blocks(self.scene, primitive, asked.base, asked.precise, counters)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ObjectInput, Scene, SceneBuilder};
    use crate::shadow::{Basis, VolumeThreshold, testers};
    use crate::shadow::{BuildInput, ObjectCoherence, Receivers, Resolution, SceneIndex, ShadowTester};
    use glam::Vec3;

    /// A triangle across the z axis, `half` wide, moved aside by x.
    fn across(x: f32, z: f32, half: f32) -> [Vec3; 3] {
        [(-half, -half), (half, -half), (0.0, half)].map(|(dx, y)| Vec3::new(x + dx, y, z))
    }

    fn scene(objects: &[&[[Vec3; 3]]]) -> Scene {
        let mut builder = SceneBuilder::new("test");
        for triangles in objects {
            let corners = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            let positions = triangles.iter().flatten().copied().collect();
            builder.add_object(ObjectInput::new("o", positions, corners)).unwrap();
        }
        builder.finish()
    }

    /// Whether points in space see a light at the origin, by a buffer of one cell a side.
    fn ask(
        scene: &Scene,
        input: impl Fn(BuildInput<'_>) -> BuildInput<'_>,
        points: &[Vec3],
    ) -> (Vec<bool>, Counters) {
        let index = SceneIndex::new(scene);
        let usual = BuildInput {
            resolution: Resolution::Cells(1),
            receivers: Receivers::Anywhere,
            ..BuildInput::new(scene, &index, Vec3::ZERO)
        };
        let buffer = LightBuffer::new(&input(usual)).unwrap();
        buffer.validate().unwrap();
        let points: Vec<_> = points.iter().map(|&p| SurfacePoint::bare(p).unwrap()).collect();
        let mut answers = vec![false; points.len()];
        let counters = buffer.occluded(&points, &mut answers).unwrap();
        (answers, counters)
    }

    fn grouped(most_single: u32) -> impl Fn(BuildInput<'_>) -> BuildInput<'_> {
        move |input| BuildInput { bounding_volumes: VolumeThreshold::MoreThan(most_single), ..input }
    }

    #[test]
    fn what_follows_a_group_is_looked_at_when_a_member_lies_behind_the_point() {
        // The first object reaches from before the second to far behind it.
        let scene = scene(&[&[across(0.8, 2.0, 0.125), across(0.0, 10.0, 0.5)], &[across(0.0, 3.0, 0.5)]]);
        let (answers, counters) =
            ask(&scene, grouped(1), &[Vec3::new(0.01, 0.0, 5.0), Vec3::new(0.01, 0.0, 2.5)]);
        assert_eq!(answers, [true, false]);
        // Both points meet the volume and its first triangle; only the first one gets to the second object.
        assert_eq!((counters.volume_tests, counters.tests), (2, 3));
    }

    #[test]
    fn a_group_whose_volume_is_missed_is_skipped() {
        let aside: Vec<_> = (0..5).map(|i| across(0.8, 1.0 + i as f32 * 0.125, 0.125)).collect();
        let scene = scene(&[&aside, &[across(0.0, 3.0, 0.5)]]);
        let point = [Vec3::new(0.01, 0.0, 5.0)];
        let (answers, counters) = ask(&scene, grouped(4), &point);
        assert_eq!((answers, counters.volume_tests, counters.tests), (vec![true], 1, 1));
        let (answers, counters) = ask(&scene, grouped(5), &point);
        assert_eq!((answers, counters.volume_tests, counters.tests), (vec![true], 0, 6));
        let (answers, counters) = ask(&scene, |input| input, &point);
        assert_eq!((answers, counters.volume_tests, counters.tests), (vec![true], 0, 6));
    }

    #[test]
    fn the_volume_of_the_object_that_a_point_lies_on_is_met_without_a_test() {
        // Two triangles in one plane, and a third that makes the object no convex one.
        let own = [across(0.0, 4.0, 1.0), across(2.5, 4.0, 1.0), across(0.0, 3.0, 0.25)];
        let scene = scene(&[&own]);
        let index = SceneIndex::new(&scene);
        let input = grouped(2)(BuildInput {
            resolution: Resolution::Cells(1),
            ..BuildInput::new(&scene, &index, Vec3::ZERO)
        });
        let buffer = LightBuffer::new(&input).unwrap();
        assert_eq!(buffer.counts().bounding_volumes, 1);
        let points = [0.0, 0.5].map(|x| SurfacePoint::on_ray(&scene, Vec3::ZERO, Vec3::new(x, -0.5, 4.0), 0));
        let mut answers = [false; 2];
        let counters = buffer.occluded(&points, &mut answers).unwrap();
        assert_eq!((answers, counters.volume_tests), ([false, false], 0));
        let behind = SurfacePoint::on_ray(&scene, Vec3::ZERO, Vec3::new(0.01, 0.01, 4.0), 0);
        buffer.occluded(&[behind], &mut answers[..1]).unwrap();
        assert!(answers[0]);
    }

    fn coherent(input: BuildInput<'_>) -> BuildInput<'_> {
        BuildInput { object_coherence: ObjectCoherence::LastOccluder, ..input }
    }

    #[test]
    fn the_last_occluder_answers_for_neighbours_until_it_does_not_block() {
        let scene = scene(&[&[across(0.0, 3.0, 0.5)], &[across(1.5, 3.0, 0.5)]]);
        let x = |x: f32| Vec3::new(x, 0.0, 4.0);
        let points = [x(0.0), x(0.01), x(0.02), x(2.0), x(2.01), x(1.0), x(2.0), Vec3::new(0.0, 0.0, 2.0)];
        let (answers, counters) = ask(&scene, coherent, &points);
        assert_eq!(answers, [true, true, true, true, true, false, true, false]);
        assert_eq!(counters.coherence_hits, 3);
        assert_eq!(ask(&scene, |input| input, &points).0, answers);
    }

    #[test]
    fn the_last_occluder_does_not_shadow_itself() {
        // A point under a triangle, then points on that triangle: once the base surface, once a convex object.
        let tips = [
            Vec3::new(0.0, 0.0, 2.0),
            Vec3::new(2.0, 0.0, 4.0),
            Vec3::new(-1.0, 2.0, 4.0),
            Vec3::new(-1.0, -2.0, 4.0),
        ];
        let solid = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 2, 3]].map(|t| t.map(|i: usize| tips[i]));
        let floor = across(0.0, 9.0, 20.0);
        let scene = scene(&[&solid, &[floor]]);
        let index = SceneIndex::new(&scene);
        let input = coherent(BuildInput {
            resolution: Resolution::Cells(9),
            ..BuildInput::new(&scene, &index, Vec3::ZERO)
        });
        let on = |x: f32, y: f32, t: u32| SurfacePoint::on_ray(&scene, Vec3::ZERO, Vec3::new(x, y, 3.0), t);
        // Beside the middle, where no cover of a cell answers.
        let points = [on(0.9, 0.35, 4), on(0.9, 0.35, 0), on(0.9, 0.35, 4), on(-0.9, 0.0, 1)];
        let buffer = LightBuffer::new(&input).unwrap();
        let mut answers = [false; 4];
        let counters = buffer.occluded(&points, &mut answers).unwrap();
        assert_eq!(answers, [true, false, true, false]);
        assert_eq!(counters.coherence_hits, 0);
        for entry in testers().filter(|entry| entry.basis == Basis::Truth) {
            let mut truth = [false; 4];
            (entry.build)(&input).unwrap().occluded(&points, &mut truth).unwrap();
            assert_eq!(truth, answers);
        }
    }
}
