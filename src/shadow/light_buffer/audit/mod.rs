//! Checks a finished buffer against its own definition.

use super::{Group, LightBuffer, Record, SideLists};
use crate::geometry::ExactPosition;
use crate::geometry::occlusion::PreciseQuery;
use glam::Vec3;

#[cfg(test)]
mod tests;

/// What an audit looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Audit {
    /// Cells whose lists were checked.
    pub cells: u64,
    /// Records that were checked.
    pub records: u64,
    /// Directions to corners of triangles whose cell was looked up.
    pub directions: u64,
}

impl LightBuffer<'_> {
    /// Checks the invariants of the structure: headers in order, records ascending and of existing casters,
    /// nothing behind a full occlusion, and every triangle present in the cells of its corners unless these cells
    /// may leave it out.
    ///
    /// # Errors
    /// The first violation, in words.
    pub fn validate(&self) -> Result<Audit, String> {
        let mut audit = Audit { cells: 0, records: 0, directions: 0 };
        for lists in self.sides.iter().flatten() {
            self.validate_lists(lists, &mut audit)?;
        }
        for caster in 0..self.casters.primitives.len() as u32 {
            let primitive = self.casters.primitives[caster as usize];
            if self.scene.is_curved(primitive) {
                continue;
            }
            for corner in self.scene.corners(primitive) {
                self.validate_presence(caster, corner)?;
                audit.directions += 1;
            }
        }
        Ok(audit)
    }

    fn validate_lists(&self, lists: &SideLists, audit: &mut Audit) -> Result<(), String> {
        let cells = lists.count[0] as usize * lists.count[1] as usize;
        if lists.headers.len() != cells + 1 || lists.headers[cells].start as usize != lists.records.len() {
            return Err("headers do not span the records".into());
        }
        for cell in 0..cells {
            if lists.headers[cell].start > lists.headers[cell + 1].start {
                return Err(format!("cell {cell}: its list ends before it begins"));
            }
            let (full_occlusion, list) = lists.list(cell);
            let groups = lists.groups.of(cell);
            self.validate_order(list, groups).map_err(|what| format!("cell {cell}: {what}"))?;
            let casters = self.casters.planes.len();
            let is_sound = |r: &Record| r.near.is_finite() && (r.caster as usize) < casters;
            if !list.iter().all(is_sound) {
                return Err(format!("cell {cell}: a record without depth or caster"));
            }
            if list.iter().any(|r| r.near > full_occlusion) {
                return Err(format!("cell {cell}: a record behind the full occlusion"));
            }
            audit.cells += 1;
            audit.records += list.len() as u64;
        }
        Ok(())
    }

    /// Records outside of groups and the first ones of groups ascend, and so do those of each group, which
    /// belong to one object that has a volume.
    fn validate_order(&self, list: &[Record], groups: &[Group]) -> Result<(), String> {
        let ascend = |records: &[Record]| records.is_sorted_by(|a, b| a.near <= b.near);
        let mut outside = Vec::new();
        let mut next = 0;
        for group in groups {
            if (group.first as usize) < next || group.end <= group.first || group.end as usize > list.len() {
                return Err("groups out of order".into());
            }
            outside.extend_from_slice(&list[next..=group.first as usize]);
            let members = group.members(list);
            let is_own = |r: &Record| {
                let primitive = self.casters.primitives.get(r.caster as usize);
                primitive.is_some_and(|&t| self.scene.triangles[t as usize].object == group.object)
            };
            if !ascend(members)
                || !members.iter().all(is_own)
                || self.volumes[group.object as usize].is_none()
            {
                return Err(format!("records of object {} are no group", group.object));
            }
            next = group.end as usize;
        }
        outside.extend_from_slice(&list[next..]);
        if ascend(&outside) { Ok(()) } else { Err("records out of order".into()) }
    }

    /// A corner of a triangle lies in a cell that lists it, cuts it off behind a full occlusion, or has no list
    /// because the triangle is alone there.
    fn validate_presence(&self, caster: u32, point: Vec3) -> Result<(), String> {
        let space = &self.casters.space;
        let query = PreciseQuery::new(space, point.as_dvec3(), || ExactPosition::Bare(point));
        let resolution = self.statistics.resolution;
        let Some((at, _)) = self.cells.locate(space, point.as_dvec3(), resolution, &query) else {
            return Ok(());
        };
        let missing = || format!("caster {caster}: missing at {point} in cell {} {}", at.column, at.row);
        let lists = self.sides[at.side].as_ref();
        let Some((lists, cell)) = lists.and_then(|l| Some((l, l.cell(at.column, at.row)?))) else {
            return Err(missing());
        };
        let (full_occlusion, list) = lists.list(cell);
        let listed = list.iter().find(|r| r.caster == caster);
        let excused = list.is_empty() || full_occlusion < f32::INFINITY;
        match listed {
            Some(record) if f64::from(record.near) > at.z_high => {
                Err(format!("caster {caster}: depth {} behind its own corner {point}", record.near))
            }
            None if !excused => Err(missing()),
            _ => Ok(()),
        }
    }
}
