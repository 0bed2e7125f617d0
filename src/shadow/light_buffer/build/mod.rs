//! Casting: every primitive into every cell that its projection can touch, then one list a cell.
//!
//! Sides are made only where triangles project, and of a side only the rectangle of cells that they touch.
//! Lists stand end to end in one array (compressed rows), their starts and the full-occlusion depths in
//! another.

use super::cell::{self, Candidate, Cover, Dropped, Role, SelfShadow};
use super::cells::{Cells, side_grid};
use super::convex_cover::ConvexObjects;
use super::cube_coherence::SideBits;
use super::curved_cast;
use super::flatness::Flatness;
use super::groups::{CellGroups, Group, Grouping};
use super::{Header, Record, SideLists, Statistics};
use crate::error::{Error, Result};
use crate::float_environment::InStandardFloats;
use crate::geometry::footprint::{Footprint, Frame, Grid};
use crate::geometry::planes::{OrientedPlanes, oriented};
use crate::scene::{Primitive, PrimitiveIndex};
use crate::shadow::{BuildInput, Casters, Receivers, VolumeThreshold};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

#[cfg(test)]
mod tests;

/// A triangle's projection on one side: of a primitive, or of what stands for a curved one.
pub(super) struct Cast {
    pub role: Role,
    /// The most of a cell that it can cover: not all for what has holes, or only receives.
    most: Cover,
    pub stands_for: StandsFor,
    pub footprint: Footprint,
}

/// What is cast by a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum StandsFor {
    /// Itself.
    Itself,
    /// A curved surface inside of the triangle's hull.
    Hull,
    /// The same, with the light inside of the hull too.
    HullAroundLight,
    /// A curved surface at most so far behind the triangle.
    Inner {
        /// In z'.
        margin: f64,
    },
}

/// The part of a side that casters project on: first and last column, first and last row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub columns: [u32; 2],
    pub rows: [u32; 2],
}

impl Window {
    fn around(casts: &[Cast]) -> Window {
        let join = |a: [u32; 2], b: [u32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let empty = Window { columns: [u32::MAX, 0], rows: [u32::MAX, 0] };
        casts.iter().filter(|cast| cast.role.caster().is_some()).fold(empty, |w, cast| Window {
            columns: join(w.columns, cast.footprint.columns()),
            rows: join(w.rows, cast.footprint.rows()),
        })
    }

    /// Nothing in it, not even one cell.
    fn is_empty(&self) -> bool {
        self.columns[0] > self.columns[1]
    }

    fn width(&self) -> usize {
        (self.columns[1] - self.columns[0] + 1) as usize
    }

    fn height(&self) -> usize {
        (self.rows[1] - self.rows[0] + 1) as usize
    }
}

/// Casts all casters, and triangles that only receive, on all sides.
pub(super) fn build(
    input: &BuildInput,
    casters: &Casters,
    receiving_only: &[PrimitiveIndex],
    cells: &Cells,
    resolution: u32,
) -> Result<(Vec<Option<SideLists>>, Statistics)> {
    let touched = |corners| cells.touched_sides(&casters.space, corners);
    build_on(input, casters, receiving_only, cells, resolution, touched)
}

/// A triangle and the sides that it may project on.
pub(super) struct Part {
    pub corners: [DVec3; 3],
    pub role: Role,
    pub most: Cover,
    pub stands_for: StandsFor,
}

/// Casts every triangle on the sides that `touched` says, which are at least those that it has a footprint on.
pub(super) fn build_on(
    input: &BuildInput,
    casters: &Casters,
    receiving_only: &[PrimitiveIndex],
    cells: &Cells,
    resolution: u32,
    touched: impl Fn([DVec3; 3]) -> SideBits + Sync,
) -> Result<(Vec<Option<SideLists>>, Statistics)> {
    let blocking = casters.primitives.par_iter().enumerate();
    let blocking = blocking.flat_map_iter(|(caster, &p)| parts(input, p, Role::Blocks(caster as u32)));
    let receiving = receiving_only.par_iter().flat_map_iter(|&p| parts(input, p, Role::ReceivesOnly));
    let sided = |part: Part| (touched(part.corners), part);
    let parts: Vec<(SideBits, Part)> = blocking.chain(receiving).map(sided).in_standard_floats().collect();
    let curved = parts.iter().any(|(_, part)| part.stands_for != StandsFor::Itself);
    let grid = side_grid(resolution);
    let rules = Rules {
        flatness: Flatness { scene: input.scene, casters },
        convex: ConvexObjects::new(input, casters),
        grouping: Grouping::new(input, casters),
        curved: if curved { Curved::Some } else { Curved::None },
    };
    let receivers = receivers(input);
    let mut statistics = Statistics { resolution, ..Statistics::default() };
    let mut sides = Vec::with_capacity(cells.sides());
    for side in 0..cells.sides() {
        let casts = project(casters, &parts, side, &cells.frame(side), &grid);
        let window = Window::around(&casts);
        if window.is_empty() {
            sides.push(None);
            continue;
        }
        check_memory(&casts, &grid, resolution, input)?;
        let bands = bands(&window);
        let lists: Vec<Band> = bands
            .into_par_iter()
            .in_standard_floats()
            .map(|rows| fill_band(&casts, &grid, &window, rows, receivers, &rules))
            .collect();
        sides.push(Some(join(&window, lists, &mut statistics)?));
    }
    Ok((sides, statistics))
}

/// What the lists of all sides are made by.
struct Rules<'a> {
    flatness: Flatness<'a>,
    convex: ConvexObjects,
    grouping: Option<Grouping>,
    curved: Curved,
}

/// Whether any of the casts stand for curved surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Curved {
    None,
    Some,
}

/// Where queries come from: a plane without end is a receiver that no cell's list holds, so that nothing may
/// be left out on its account.
fn receivers(input: &BuildInput) -> Receivers {
    let endless = input.scene.curved.iter().any(|curved| curved.shape.is_endless());
    if endless { Receivers::Anywhere } else { input.receivers }
}

/// The triangles that are cast for a primitive; none for a plane without end.
fn parts(input: &BuildInput, primitive: PrimitiveIndex, role: Role) -> Vec<Part> {
    match input.scene.primitive(primitive) {
        Primitive::Triangle(corners) => {
            let has_gaps = role == Role::ReceivesOnly
                || input.scene.masked(primitive).is_some()
                || input.scene.is_transparent(primitive);
            let most = if has_gaps { Cover::Part } else { Cover::Whole };
            let corners = oriented(input.light, corners);
            let corners = corners.map(|corners| corners.map(Vec3::as_dvec3));
            let part = |corners| Part { corners, role, most, stands_for: StandsFor::Itself };
            corners.map(part).into_iter().collect()
        }
        Primitive::Curved(shape) => {
            let mut parts = curved_cast::parts(shape, input.light, role);
            if let (Role::Blocks(caster), false) = (role, input.scene.is_transparent(primitive)) {
                parts.extend(curved_cast::inner_parts(shape, input.light, caster));
            }
            parts
        }
    }
}

fn project(
    casters: &Casters,
    parts: &[(SideBits, Part)],
    side: usize,
    frame: &Frame,
    grid: &Grid,
) -> Vec<Cast> {
    let cast = |(_, part): &(SideBits, Part)| {
        let planes = match part.stands_for {
            StandsFor::Itself => OrientedPlanes::new(&casters.space, part.corners),
            _ => OrientedPlanes::of_hull_for(&casters.space, part.corners)?,
        };
        let footprint = Footprint::new(grid, frame, &planes)?;
        Some(Cast { role: part.role, most: part.most, stands_for: part.stands_for, footprint })
    };
    parts
        .par_iter()
        .filter(|(sides, _)| sides >> side & 1 == 1)
        .in_standard_floats()
        .filter_map(cast)
        .collect()
}

/// The cells of the box around a footprint.
fn cells_around(footprint: &Footprint) -> u64 {
    let ([left, right], [top, bottom]) = (footprint.columns(), footprint.rows());
    u64::from(right - left + 1) * u64::from(bottom - top + 1)
}

/// Checks what the lists of one side can need before they are made: an entry and its place in the order for
/// every cell of every cast.
fn check_memory(casts: &[Cast], grid: &Grid, resolution: u32, input: &BuildInput) -> Result<()> {
    const ENTRY_BYTES: u64 = (size_of::<(u32, u32)>() + size_of::<u32>() + size_of::<Record>()) as u64;
    let limit = input.memory;
    // A group has at least one record.
    let entry_bytes = match input.bounding_volumes {
        VolumeThreshold::Off => ENTRY_BYTES,
        VolumeThreshold::MoreThan(_) => ENTRY_BYTES + size_of::<Group>() as u64,
    };
    let what = || format!("the lists of a light buffer of {resolution} cells along an edge");
    // The boxes around the footprints are quick to count; rows are looked at only if those are too many.
    if limit
        .check(
            what(),
            entry_bytes.saturating_mul(casts.iter().map(|cast| cells_around(&cast.footprint)).sum()),
        )
        .is_ok()
    {
        return Ok(());
    }
    let row_by_row = |cast: &Cast| -> u64 {
        let [top, bottom] = cast.footprint.rows();
        let spans = (top..=bottom).filter_map(|row| cast.footprint.span(grid, row));
        spans.map(|[left, right]| u64::from(right - left + 1)).sum()
    };
    limit.check(
        what(),
        entry_bytes.saturating_mul(casts.par_iter().in_standard_floats().map(row_by_row).sum()),
    )
}

/// Rows in pieces of about equal numbers of cells.
fn bands(window: &Window) -> Vec<[u32; 2]> {
    const CELLS: usize = 1 << 16;
    let rows = (CELLS / window.width()).clamp(1, window.height().div_ceil(16).max(1)) as u32;
    (window.rows[0]..=window.rows[1])
        .step_by(rows as usize)
        .map(|first| [first, (first + rows - 1).min(window.rows[1])])
        .collect()
}

/// The lists of some rows, headers relative to the band's own records.
struct Band {
    headers: Vec<Header>,
    records: Vec<Record>,
    groups: CellGroups,
    statistics: Statistics,
}

fn fill_band(
    casts: &[Cast],
    grid: &Grid,
    window: &Window,
    rows: [u32; 2],
    receivers: Receivers,
    rules: &Rules<'_>,
) -> Band {
    let width = window.width();
    let cells = width * Window { rows, ..*window }.height();
    let cell_of =
        |column: u32, row: u32| (row - rows[0]) as usize * width + (column - window.columns[0]) as usize;
    let entries = touched_cells(casts, grid, window, rows, cell_of);
    let starts = starts(cells, &entries);
    let mut order = vec![0u32; entries.len()];
    let mut next = starts.clone();
    for (index, &(cell, _)) in entries.iter().enumerate() {
        order[next[cell as usize] as usize] = index as u32;
        next[cell as usize] += 1;
    }
    let mut band = Band {
        headers: Vec::with_capacity(cells),
        records: Vec::new(),
        groups: CellGroups::default(),
        statistics: Statistics::default(),
    };
    let mut candidates = Vec::new();
    for row in rows[0]..=rows[1] {
        for column in window.columns[0]..=window.columns[1] {
            let cell = cell_of(column, row);
            let members = &order[starts[cell] as usize..starts[cell + 1] as usize];
            candidates.clear();
            candidates.extend(members.iter().map(|&index| {
                let cast = &casts[entries[index as usize].1 as usize];
                candidate(cast, grid, column, row)
            }));
            let footprint = |k: usize| &casts[entries[members[k] as usize].1 as usize].footprint;
            let single = candidates
                .iter()
                .filter(|c| c.cover == Cover::Whole)
                .map(|c| c.far)
                .fold(f32::INFINITY, f32::min);
            let mut cover = single.min(rules.convex.cover_depth(&candidates, footprint, grid, column, row));
            if rules.curved == Curved::Some {
                cover = cover.min(curved_cast::cover_depth(&candidates, footprint, grid, column, row));
                curved_cast::join(&mut candidates);
            }
            let touching = candidates.iter().filter(|c| c.role.caster().is_some()).count();
            let in_one_plane = |candidates: &[Candidate]| rules.flatness.in_one_plane(candidates);
            let finished = cell::finish(&mut candidates, cover, receivers, in_one_plane);
            let start = band.records.len();
            band.headers.push(Header { start: start as u32, full_occlusion: finished.full_occlusion });
            let record = |c: &Candidate| Some(Record { near: c.near, caster: c.role.caster()? });
            band.records.extend(candidates.iter().filter_map(record));
            band.statistics.add_cell(touching, &candidates, finished);
            if let Some(grouping) = &rules.grouping {
                let groups = grouping.group(&mut band.records[start..]);
                band.statistics.bounding_volumes += groups.len() as u64;
                band.groups.push_cell(groups);
            }
        }
    }
    debug_assert_eq!(band.headers.len(), cells, "a header for each cell that there is room for");
    band
}

/// Pairs of cell and cast for every cell of the window's rows that a cast can touch.
fn touched_cells(
    casts: &[Cast],
    grid: &Grid,
    window: &Window,
    rows: [u32; 2],
    cell_of: impl Fn(u32, u32) -> usize,
) -> Vec<(u32, u32)> {
    let mut entries = Vec::new();
    for (index, cast) in casts.iter().enumerate() {
        let [top, bottom] = cast.footprint.rows();
        for row in top.max(rows[0])..=bottom.min(rows[1]) {
            let Some([left, right]) = cast.footprint.span(grid, row) else { continue };
            // What only receives may reach beyond what is cast.
            let (left, right) = (left.max(window.columns[0]), right.min(window.columns[1]));
            if left <= right {
                let first = cell_of(left, row) as u32;
                entries.extend((first..=first + (right - left)).map(|cell| (cell, index as u32)));
            }
        }
    }
    entries
}

/// Start of each cell's entries, and the end of the last.
fn starts(cells: usize, entries: &[(u32, u32)]) -> Vec<u32> {
    let mut starts = vec![0u32; cells + 1];
    for &(cell, _) in entries {
        starts[cell as usize + 1] += 1;
    }
    for i in 0..cells {
        starts[i + 1] += starts[i];
    }
    starts
}

fn candidate(cast: &Cast, grid: &Grid, column: u32, row: u32) -> Candidate {
    let [mut near, mut far] = cast.footprint.z_bounds(grid, column, row);
    match cast.stands_for {
        StandsFor::Itself | StandsFor::Hull => {}
        StandsFor::HullAroundLight => near = 0.0,
        StandsFor::Inner { margin } => far += margin,
    }
    let self_shadow =
        if cast.stands_for == StandsFor::Itself { SelfShadow::Never } else { SelfShadow::Perhaps };
    let covers = cast.most == Cover::Whole && cast.footprint.covers(grid, column, row);
    let cover = if covers { Cover::Whole } else { Cover::Part };
    Candidate { near: round_down(near), far: round_up(far), role: cast.role, cover, self_shadow }
}

/// The largest f32 not above a number.
pub(super) fn round_down(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) > value { rounded.next_down() } else { rounded }
}

/// The smallest f32 not below a number.
pub(super) fn round_up(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value { rounded.next_up() } else { rounded }
}

/// Bands end to end.
fn join(window: &Window, bands: Vec<Band>, statistics: &mut Statistics) -> Result<SideLists> {
    let records: usize = bands.iter().map(|b| b.records.len()).sum();
    if u32::try_from(records).is_err() {
        return Err(Error::Usage(format!(
            "light buffer: {records} records on one side; choose a lower --resolution"
        )));
    }
    let mut lists = SideLists {
        first: [window.columns[0], window.rows[0]],
        count: [window.width() as u32, window.height() as u32],
        headers: Vec::with_capacity(window.width() * window.height() + 1),
        records: Vec::with_capacity(records),
        groups: CellGroups::default(),
    };
    for band in bands {
        let base = lists.records.len() as u32;
        lists.headers.extend(band.headers.iter().map(|h| Header { start: base + h.start, ..*h }));
        lists.records.extend(band.records);
        lists.groups.append(band.groups);
        statistics.join(&band.statistics);
    }
    lists.headers.push(Header { start: lists.records.len() as u32, full_occlusion: f32::INFINITY });
    statistics.sides += 1;
    Ok(lists)
}

impl Statistics {
    fn add_cell(&mut self, touched: usize, kept: &[Candidate], finished: cell::Finished) {
        self.cells += 1;
        self.touched_cells += u64::from(touched > 0);
        self.non_empty += u64::from(!kept.is_empty());
        self.records += kept.len() as u64;
        self.longest_list = self.longest_list.max(kept.len() as u64);
        self.pruned += u64::from(finished.pruned);
        self.full_occlusions += u64::from(finished.full_occlusion < f32::INFINITY);
        self.dropped_lists += u64::from(finished.dropped == Dropped::List);
        self.dropped_full_occlusions += u64::from(finished.dropped == Dropped::FullOcclusion);
    }

    fn join(&mut self, other: &Statistics) {
        self.cells += other.cells;
        self.touched_cells += other.touched_cells;
        self.non_empty += other.non_empty;
        self.records += other.records;
        self.bounding_volumes += other.bounding_volumes;
        self.longest_list = self.longest_list.max(other.longest_list);
        self.pruned += other.pruned;
        self.full_occlusions += other.full_occlusions;
        self.dropped_lists += other.dropped_lists;
        self.dropped_full_occlusions += other.dropped_full_occlusions;
    }
}
