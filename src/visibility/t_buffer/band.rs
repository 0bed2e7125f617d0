//! Some rows of the t-buffer: what is nearest at each pixel so far, and how near.

use super::cast::{Cast, LANE};
use super::view::View;
use crate::geometry::batch::{InstructionSet, LANES};
use crate::geometry::curved::RayStart;
use crate::geometry::masks::{bits, each_bit};
use crate::geometry::ray_triangle::RayTriangle;
use crate::scene::PrimitiveIndex;
use crate::visibility::hit::{Hit, is_there, keep_nearer};
use glam::Vec3;

/// Rows of a band.
pub(super) const BAND_ROWS: usize = 32;

/// Rows and columns of a block, over which the least nearness is known.
const BLOCK: [usize; 2] = [8, LANES];

/// In place of a primitive where there is none.
pub(super) const NOTHING: PrimitiveIndex = PrimitiveIndex::MAX;

/// A band. Nearness is 1 / depth, by bounds.
pub(super) struct Band {
    pub first_row: u32,
    rows: u32,
    /// Items from one row to the next: the width of the picture, and so many more that sixteen items from any pixel on
    /// are there.
    pitch: usize,
    least: Vec<f32>,
    most: Vec<f32>,
    primitives: Vec<PrimitiveIndex>,
    /// Of each block no more than the least nearness, from when it was last looked at. What is drawn later is nearer.
    blocks: Vec<f32>,
    /// Whether something was drawn there since.
    is_stale: Vec<bool>,
    /// Rays that were tested.
    pub tests: u64,
}

impl Band {
    /// All bands of a picture, empty.
    pub fn all(view: &View) -> Vec<Band> {
        let [width, height] = view.grid.count;
        let pitch = width as usize + LANES;
        let band = |first_row: u32| {
            let rows = (height - first_row).min(BAND_ROWS as u32);
            let items = rows as usize * pitch;
            let blocks = (rows as usize).div_ceil(BLOCK[0]) * (width as usize).div_ceil(BLOCK[1]);
            Band {
                first_row,
                rows,
                pitch,
                least: vec![f32::NEG_INFINITY; items],
                most: vec![f32::NEG_INFINITY; items],
                primitives: vec![NOTHING; items],
                blocks: vec![f32::NEG_INFINITY; blocks],
                is_stale: vec![false; blocks],
                tests: 0,
            }
        };
        (0..height).step_by(BAND_ROWS).map(band).collect()
    }

    /// First row, and the one after the last.
    pub fn rows(&self) -> [u32; 2] {
        [self.first_row, self.first_row + self.rows]
    }

    /// What is nearest at each pixel, a row at a time, or [`NOTHING`].
    pub fn lines(&self) -> impl Iterator<Item = &[PrimitiveIndex]> {
        self.primitives.chunks_exact(self.pitch).map(|row| &row[..row.len() - LANES])
    }

    fn width(&self) -> usize {
        self.pitch - LANES
    }

    /// Whether everything in a box of pixels is nearer than something.
    #[inline(always)]
    pub fn hides(&mut self, columns: [u32; 2], rows: [u32; 2], nearness: f32) -> bool {
        let across = self.width().div_ceil(BLOCK[1]);
        let [top, bottom] =
            [(rows[0] - self.first_row) as usize / BLOCK[0], (rows[1] - self.first_row) as usize / BLOCK[0]];
        let [left, right] = [columns[0] as usize / BLOCK[1], columns[1] as usize / BLOCK[1]];
        for down in top..=bottom {
            for block in down * across + left..=down * across + right {
                if self.is_stale[block] && self.blocks[block] <= nearness {
                    self.look(block, across);
                }
                if self.blocks[block] <= nearness {
                    return false;
                }
            }
        }
        true
    }

    /// Finds the least nearness of a block.
    #[inline(always)]
    fn look(&mut self, block: usize, across: usize) {
        let (down, right) = (block / across, block % across);
        let rows = down * BLOCK[0]..(self.rows as usize).min((down + 1) * BLOCK[0]);
        let columns = self.width().min((right + 1) * BLOCK[1]) - right * BLOCK[1];
        let mut least = [f32::INFINITY; LANES];
        for row in rows {
            let first = row * self.pitch + right * BLOCK[1];
            for (least, &other) in least.iter_mut().zip(&self.least[first..first + LANES]) {
                *least = if other < *least { other } else { *least };
            }
        }
        self.blocks[block] = least[..columns].iter().fold(f32::INFINITY, |least, &other| least.min(other));
        self.is_stale[block] = false;
    }

    /// Draws the part of a triangle that may be in a box of pixels, which is in this band.
    #[inline(always)]
    pub fn draw(&mut self, set: InstructionSet, view: &View, cast: &Cast, columns: [u32; 2], rows: [u32; 2]) {
        let is_wide = columns[1] - columns[0] >= LANES as u32;
        let certainty = view.scene.masked(cast.primitive).is_none();
        for row in rows[0]..=rows[1] {
            let y = view.grid.origin[1] + view.grid.step[1] * f64::from(row);
            let [s, t, u] = &cast.sides;
            let of_row = [s.ramp.of_row(y), t.ramp.of_row(y), u.ramp.of_row(y)];
            let nearness_of_row = cast.nearness.of_row(y);
            let span = if is_wide { cast.span(view, &of_row, columns) } else { Some(columns) };
            let Some([mut first, last]) = span else { continue };
            while first <= last {
                let x = view.grid.origin[0] + view.grid.step[0] * f64::from(first);
                let count = LANES.min((last - first + 1) as usize);
                let run = Run {
                    cast,
                    starts: [
                        s.ramp.at(of_row[0], x) as f32,
                        t.ramp.at(of_row[1], x) as f32,
                        u.ramp.at(of_row[2], x) as f32,
                    ],
                    nearness: cast.nearness.at(nearness_of_row, x) as f32,
                    count: count as f32,
                    certainty,
                };
                let place = (row - self.first_row) as usize * self.pitch + first as usize;
                let drawn = self.run(set, &run, place);
                self.tests += u64::from(drawn.touched.count_ones());
                each_bit(drawn.undecided, |lane| {
                    self.ask(view, cast.primitive, [first + lane as u32, row]);
                });
                if drawn.changed != 0 {
                    self.mark(row, first, count);
                }
                first += LANES as u32;
            }
        }
    }

    /// Sixteen pixels of a row, of which the first `count` may be hit.
    #[inline(always)]
    fn run(&mut self, set: InstructionSet, run: &Run, place: usize) -> Drawn {
        let lanes = place..place + LANES;
        let least: &mut [f32; LANES] = (&mut self.least[lanes.clone()]).try_into().expect("sixteen");
        let most: &mut [f32; LANES] = (&mut self.most[lanes.clone()]).try_into().expect("sixteen");
        let primitives: &mut [u32; LANES] = (&mut self.primitives[lanes]).try_into().expect("sixteen");
        let Run { cast, starts, nearness, count, certainty } = *run;
        let [s, t, u] = [&cast.sides[0].ramp, &cast.sides[1].ramp, &cast.sides[2].ramp];
        let w = &cast.nearness;
        let (mut touched, mut undecided, mut changed) = ([0; LANES], [0; LANES], [0; LANES]);
        for i in 0..LANES {
            let a = (starts[0] + s.step * LANE[i]) * CERTAIN;
            let b = (starts[1] + t.step * LANE[i]) * CERTAIN;
            let c = (starts[2] + u.step * LANE[i]) * CERTAIN;
            // With NaN, nothing is certain.
            let is_outside = (a < -s.slack) | (b < -t.slack) | (c < -u.slack);
            let is_inside = (a > s.slack) & (b > t.slack) & (c > u.slack);
            let here = nearness + w.step * LANE[i];
            let around = here.abs() * ALLOWANCE + w.slack;
            let (low, high) = (here - around, here + around);
            let is_touched = !is_outside & (LANE[i] < count);
            let may_show = is_touched & !(high < least[i]);
            let shows = may_show & is_inside & (low > most[i]) & certainty;
            touched[i] = u32::from(is_touched);
            undecided[i] = u32::from(may_show & !shows);
            changed[i] = u32::from(shows);
            least[i] = if shows { low } else { least[i] };
            most[i] = if shows { high } else { most[i] };
            primitives[i] = if shows { cast.primitive } else { primitives[i] };
        }
        Drawn { touched: bits(set, &touched), undecided: bits(set, &undecided), changed: bits(set, &changed) }
    }

    /// Tries the ray of a pixel on a triangle.
    #[inline(never)]
    fn ask(&mut self, view: &View, primitive: PrimitiveIndex, pixel: [u32; 2]) {
        let direction = view.direction(pixel[0], pixel[1]);
        if let Some(hit) = hit(view, primitive, direction) {
            self.offer(view, hit, direction, pixel);
        }
    }

    /// Keeps a hit of a pixel's ray if it is the nearest.
    pub fn offer(&mut self, view: &View, hit: Hit, direction: Vec3, [column, row]: [u32; 2]) {
        let place = (row - self.first_row) as usize * self.pitch + column as usize;
        let [mut least, most] = view.nearness(hit.parameter);
        if most < self.least[place] {
            return;
        }
        if least <= self.most[place] {
            let mut nearest = again(view, self.primitives[place], direction);
            keep_nearer(&mut nearest, hit, view.scene, view.camera.origin, direction);
            if nearest.is_none_or(|nearest| nearest.primitive != hit.primitive) {
                return;
            }
            // It is no farther than what was there.
            least = least.max(self.least[place]);
        }
        (self.least[place], self.most[place]) = (least, most);
        self.primitives[place] = hit.primitive;
        self.mark(row, column, 1);
    }

    /// Marks the blocks of some pixels of a row as stale.
    #[inline(always)]
    fn mark(&mut self, row: u32, first: u32, count: usize) {
        let across = self.width().div_ceil(BLOCK[1]);
        let down = (row - self.first_row) as usize / BLOCK[0] * across;
        let last = first as usize + count - 1;
        self.is_stale[down + first as usize / BLOCK[1]] = true;
        self.is_stale[down + last / BLOCK[1]] = true;
    }
}

/// Where a triangle's functions start, and who takes part.
#[derive(Clone, Copy)]
struct Run<'a> {
    cast: &'a Cast,
    starts: [f32; 3],
    nearness: f32,
    /// How many pixels, as a number of lanes.
    count: f32,
    /// Whether what is inside is there: triangles with holes leave that to [`is_there`].
    certainty: bool,
}

/// A bit for each of sixteen pixels.
struct Drawn {
    /// Not certainly outside.
    touched: u32,
    /// It has to be asked whether and what it changes.
    undecided: u32,
    /// Changed.
    changed: u32,
}

/// Takes off more than a [`Ramp`](super::cast::Ramp) may be wrong by of itself.
const CERTAIN: f32 = 1.0 - ALLOWANCE;
const ALLOWANCE: f32 = 1.0 / 2_097_152.0;

/// Where a ray hits a triangle.
fn hit(view: &View, primitive: PrimitiveIndex, direction: Vec3) -> Option<Hit> {
    let triangle = RayTriangle::new(view.camera.origin, view.scene.corners(primitive))?;
    let parameter = triangle.hit(direction)?;
    is_there(view.scene, primitive, &triangle, direction).then_some(Hit::flat(primitive, parameter))
}

/// The hit that an item stands for; `None` for an empty one.
fn again(view: &View, primitive: PrimitiveIndex, direction: Vec3) -> Option<Hit> {
    if primitive == NOTHING {
        return None;
    }
    if view.scene.is_curved(primitive) {
        return Hit::curved(view.scene, primitive, view.camera.origin, direction, &RayStart::origin());
    }
    hit(view, primitive, direction)
}
