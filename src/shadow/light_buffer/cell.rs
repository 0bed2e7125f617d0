//! One cell's list: sorted, cut off behind what covers the cell, emptied where nobody can ask.
//!
//! Rows 9, 10 and 11 of the notes on the 1986 paper, with the conditions that make them right.

use crate::shadow::Receivers;

/// A triangle in one cell while the cell's list is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// At most the nearest z' of the triangle in the cell.
    pub near: f32,
    /// At least the farthest z' of the triangle in the cell.
    pub far: f32,
    /// What it is there for.
    pub role: Role,
    /// How much of the cell its projection covers.
    pub cover: Cover,
    /// Whether it can shadow points of its own.
    pub self_shadow: SelfShadow,
}

/// Whether a primitive can block light that goes to itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SelfShadow {
    /// A flat one cannot.
    Never,
    /// A curved one perhaps, on the inside of its far side.
    Perhaps,
}

/// What a triangle is in a cell for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// To block: the caster with this index.
    Blocks(u32),
    /// To cover: a polygon inside of the caster with this index. It has no record.
    Covers(u32),
    /// To be asked about. It has no record, but shadows may fall on it.
    ReceivesOnly,
}

impl Role {
    /// The caster, if it is one.
    pub fn caster(self) -> Option<u32> {
        match self {
            Role::Blocks(caster) => Some(caster),
            Role::Covers(_) | Role::ReceivesOnly => None,
        }
    }
}

/// How much of a closed cell a projection covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cover {
    /// Certainly all of it.
    Whole,
    /// Perhaps not all.
    Part,
}

/// What became of a cell's candidates beside the list itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finished {
    /// The full-occlusion depth: whatever is deeper is dark. Infinite if there is none.
    pub full_occlusion: f32,
    /// Records cut off behind it.
    pub pruned: u32,
    /// What was left out because no receiver can need it.
    pub dropped: Dropped,
}

/// Simplifications that rest on all receivers being among the candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dropped {
    /// Nothing was left out.
    Nothing,
    /// A full-occlusion depth with nothing behind it (row 10).
    FullOcclusion,
    /// All that the cell holds lies in one plane: nothing else can receive its shadow (row 11).
    List,
}

/// Sorts and simplifies the candidates of a cell. `cover_depth` is the least farthest depth of all covers,
/// single triangles and convex objects, or infinite.
///
/// Behind a cover everything is dark, so a record whose nearest depth lies behind can go: what it blocks is
/// deeper still. A record exactly at that depth stays. What only receives decides with the others whether a
/// record is of use to anybody, and then goes. `in_one_plane` tells whether casters lie in one plane: the paper's
/// polygon is several triangles here.
pub fn finish(
    candidates: &mut Vec<Candidate>,
    cover_depth: f32,
    receivers: Receivers,
    in_one_plane: impl Fn(&[Candidate]) -> bool,
) -> Finished {
    candidates.sort_unstable_by(|a, b| a.near.total_cmp(&b.near).then(a.role.cmp(&b.role)));
    let kept = candidates.partition_point(|c| c.near <= cover_depth);
    let blocks = |candidate: &Candidate| candidate.role != Role::ReceivesOnly;
    let pruned = candidates[kept..].iter().filter(|c| blocks(c)).count() as u32;
    let is_nothing_behind = kept == candidates.len();
    candidates.truncate(kept);
    let mut finished = Finished { full_occlusion: cover_depth, pruned, dropped: Dropped::Nothing };
    if receivers == Receivers::Surfaces && is_nothing_behind {
        // Every receiver is on one of the candidates. A triangle shadows nothing in its own plane.
        let is_flat = |c: &Candidate| blocks(c) && c.self_shadow == SelfShadow::Never;
        let is_alone = match &candidates[..] {
            [] => false,
            [alone] => is_flat(alone),
            several => several.iter().all(is_flat) && in_one_plane(several),
        };
        if is_alone {
            candidates.clear();
            finished.full_occlusion = f32::INFINITY;
            finished.dropped = Dropped::List;
        } else if cover_depth < f32::INFINITY && candidates.iter().all(|c| c.far <= cover_depth) {
            finished.full_occlusion = f32::INFINITY;
            finished.dropped = Dropped::FullOcclusion;
        }
    }
    candidates.retain(blocks);
    finished
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(near: f32, far: f32, caster: u32) -> Candidate {
        let (role, cover) = (Role::Blocks(caster), Cover::Part);
        Candidate { near, far, role, cover, self_shadow: SelfShadow::Never }
    }

    fn receiver(near: f32, far: f32) -> Candidate {
        Candidate { role: Role::ReceivesOnly, ..candidate(near, far, 0) }
    }

    /// No two candidates lie in one plane.
    fn apart(_: &[Candidate]) -> bool {
        false
    }

    fn casters(candidates: &[Candidate]) -> Vec<u32> {
        candidates.iter().map(|c| c.role.caster().expect("only casters are kept")).collect()
    }

    #[test]
    fn records_are_sorted_by_depth_then_by_caster() {
        let mut list = vec![candidate(2.0, 3.0, 0), candidate(1.0, 9.0, 7), candidate(1.0, 2.0, 3)];
        finish(&mut list, f32::INFINITY, Receivers::Surfaces, apart);
        assert_eq!(casters(&list), [3, 7, 0]);
    }

    #[test]
    fn what_lies_behind_a_cover_is_cut_off_and_what_begins_on_it_stays() {
        let mut list =
            vec![candidate(1.0, 2.0, 0), candidate(2.0, 5.0, 1), candidate(2.0f32.next_up(), 5.0, 2)];
        let finished = finish(&mut list, 2.0, Receivers::Surfaces, apart);
        assert_eq!(casters(&list), [0, 1]);
        assert_eq!(finished, Finished { full_occlusion: 2.0, pruned: 1, dropped: Dropped::Nothing });
    }

    #[test]
    fn a_cover_with_nothing_behind_it_is_dropped_for_surfaces_only() {
        let list = vec![candidate(1.0, 2.0, 0), candidate(1.5, 2.0, 1)];
        let finished = finish(&mut list.clone(), 2.0, Receivers::Surfaces, apart);
        assert_eq!((finished.full_occlusion, finished.dropped), (f32::INFINITY, Dropped::FullOcclusion));
        assert_eq!(finish(&mut list.clone(), 2.0, Receivers::Anywhere, apart).full_occlusion, 2.0);
    }

    #[test]
    fn a_lone_polygon_is_dropped_unless_something_was_cut_off_behind_it() {
        let mut alone = vec![candidate(1.0, 2.0, 0)];
        assert_eq!(finish(&mut alone, 2.0, Receivers::Surfaces, apart).dropped, Dropped::List);
        assert!(alone.is_empty());
        let mut shadowing = vec![candidate(1.0, 2.0, 0), candidate(3.0, 4.0, 1)];
        finish(&mut shadowing, 2.0, Receivers::Surfaces, apart);
        assert_eq!(casters(&shadowing), [0]);
        let mut anywhere = vec![candidate(1.0, 2.0, 0)];
        finish(&mut anywhere, f32::INFINITY, Receivers::Anywhere, apart);
        assert_eq!(casters(&anywhere), [0]);
    }

    #[test]
    fn polygons_in_one_plane_are_dropped_as_one() {
        let pair = vec![candidate(1.0, 2.0, 0), candidate(1.0, 2.0, 1)];
        let finished = finish(&mut pair.clone(), 2.0, Receivers::Surfaces, |_| true);
        assert_eq!((finished.dropped, finished.full_occlusion), (Dropped::List, f32::INFINITY));
        let mut before = [&pair[..], &[receiver(3.0, 4.0)]].concat();
        finish(&mut before, f32::INFINITY, Receivers::Surfaces, |_| true);
        assert_eq!(casters(&before), [0, 1]);
        let mut curved = pair;
        curved[1].self_shadow = SelfShadow::Perhaps;
        finish(&mut curved, f32::INFINITY, Receivers::Surfaces, |_| true);
        assert_eq!(casters(&curved), [0, 1]);
    }

    #[test]
    fn what_only_receives_keeps_what_can_shadow_it_and_has_no_record() {
        let mut under_one = vec![receiver(3.0, 4.0), candidate(1.0, 2.0, 0)];
        let finished = finish(&mut under_one, f32::INFINITY, Receivers::Surfaces, apart);
        assert_eq!((casters(&under_one), finished.dropped), (vec![0], Dropped::Nothing));
        // Behind a cover, or reaching behind it: the full occlusion is of use.
        for behind in [receiver(2.5, 4.0), receiver(1.5, 2.5)] {
            let mut list = vec![candidate(1.0, 2.0, 0), candidate(1.5, 2.0, 1), behind];
            let finished = finish(&mut list, 2.0, Receivers::Surfaces, apart);
            assert_eq!(casters(&list), [0, 1]);
            assert_eq!(finished, Finished { full_occlusion: 2.0, pruned: 0, dropped: Dropped::Nothing });
        }
        let mut before = vec![candidate(1.0, 2.0, 0), candidate(1.5, 2.0, 1), receiver(1.0, 2.0)];
        assert_eq!(finish(&mut before, 2.0, Receivers::Surfaces, apart).dropped, Dropped::FullOcclusion);
        assert_eq!(casters(&before), [0, 1]);
        let mut alone = vec![receiver(1.0, 2.0)];
        assert_eq!(finish(&mut alone, f32::INFINITY, Receivers::Surfaces, apart).dropped, Dropped::Nothing);
        assert!(alone.is_empty());
    }
}
