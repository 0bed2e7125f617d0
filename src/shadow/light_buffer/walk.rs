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
