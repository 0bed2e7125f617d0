//! Some rows of the t-buffer: what is nearest at each pixel so far, and how near.

use super::bins::Touched;
use super::view::{BAND_ROWS, View};
use crate::geometry::batch::LANES;
use crate::geometry::curved::RayStart;
use crate::geometry::fetch::fetch;
use crate::geometry::ray_triangle::RayTriangle;
use crate::scene::PrimitiveIndex;
use crate::visibility::hit::{Hit, is_there, keep_nearer};
use glam::Vec3;

/// Rows and columns of a block, over which the least nearness is known.
const BLOCK: [usize; 2] = [8, LANES];

/// So many pixels of a block have to change before it is worth a look: at first all; later, of one that had an empty
/// pixel and of one that had none.
const WORTH_A_LOOK: [i16; 3] = [(BLOCK[0] * BLOCK[1]) as i16, 2, 1];

/// A band. Nearness is 1 / depth, which is positive; an item is two bounds of it and a primitive, and all three are 0 if it
/// is empty.
pub(super) struct Band {
    pub first_row: u32,
    rows: u32,
    /// Items from one row to the next: the width of the picture, and so many more that sixteen items from any pixel on
    /// are there. Those are as near as can be, so that they hide nothing and nobody minds them.
    pitch: usize,
    pub least: Vec<f32>,
    pub most: Vec<f32>,
    /// As [`Band::item`] makes them.
    pub items: Vec<u32>,
    /// Of each block no more than the least nearness, from when it was last looked at. What is drawn later is nearer.
    blocks: Vec<f32>,
    /// How many of its pixels have to change before it is worth a look.
    changes: Vec<i16>,
    /// Rays that were tested.
    pub tests: u64,
}

impl Band {
    /// The band of a picture with this number, empty.
    pub fn new(view: &View, number: usize) -> Band {
        let mut band = Band {
            first_row: 0,
            rows: 0,
            pitch: view.grid.count[0] as usize + LANES,
            least: Vec::new(),
            most: Vec::new(),
            items: Vec::new(),
            blocks: Vec::new(),
            changes: Vec::new(),
            tests: 0,
        };
        band.begin(view, number);
        band
    }

    /// Becomes the band with this number, empty.
    pub fn begin(&mut self, view: &View, number: usize) {
        let [width, height] = view.grid.count;
        self.first_row = (number * BAND_ROWS) as u32;
        self.rows = (height - self.first_row).min(BAND_ROWS as u32);
        self.tests = 0;
        let items = self.rows as usize * self.pitch;
        empty(&mut self.least, items, 0.0);
        empty(&mut self.most, items, 0.0);
        empty(&mut self.items, items, 0);
        for row in self.least.chunks_exact_mut(self.pitch) {
            row[width as usize..].fill(f32::INFINITY);
        }
        let blocks = (self.rows as usize).div_ceil(BLOCK[0]) * (width as usize).div_ceil(BLOCK[1]);
        empty(&mut self.blocks, blocks, 0.0);
        empty(&mut self.changes, blocks, WORTH_A_LOOK[0]);
    }

    /// The number of the band among those of the picture.
    pub fn number(&self) -> usize {
        self.first_row as usize / BAND_ROWS
    }

    /// First row, and the one after the last.
    pub fn rows(&self) -> [u32; 2] {
        [self.first_row, self.first_row + self.rows]
    }

    /// What an item holds of a primitive.
    #[inline(always)]
    pub fn item(primitive: PrimitiveIndex) -> u32 {
        primitive + 1
    }

    fn primitive(item: u32) -> Option<PrimitiveIndex> {
        item.checked_sub(1)
    }

    /// Writes what is nearest at each pixel, row by row.
    pub fn write(&self, hits: &mut [Option<PrimitiveIndex>]) {
        for (items, hits) in self.items.chunks_exact(self.pitch).zip(hits.chunks_exact_mut(self.width())) {
            for (hit, &item) in hits.iter_mut().zip(items) {
                *hit = Band::primitive(item);
            }
        }
    }

    fn width(&self) -> usize {
        self.pitch - LANES
    }

    /// Where the item of a pixel is.
    #[inline(always)]
    pub fn place(&self, [column, row]: [u32; 2]) -> usize {
        (row - self.first_row) as usize * self.pitch + column as usize
    }

    /// Whether everything in the pixels around a triangle is nearer than it.
    #[inline(always)]
    pub fn hides(&mut self, touched: &Touched) -> bool {
        let across = self.width().div_ceil(BLOCK[1]);
        let [top, bottom] =
            [usize::from(touched.rows[0]) / BLOCK[0], usize::from(touched.rows[1]) / BLOCK[0]];
        let [left, right] = [touched.columns[0] as usize / BLOCK[1], touched.columns[1] as usize / BLOCK[1]];
        for down in top..=bottom {
            for block in down * across + left..=down * across + right {
                if self.blocks[block] <= touched.nearness && self.changes[block] <= 0 {
                    self.look(block, across);
                }
                if self.blocks[block] <= touched.nearness {
                    return false;
                }
            }
        }
        true
    }

    /// Fetches the items that a small triangle may need.
    #[inline(always)]
    pub fn fetch(&self, touched: &Touched) {
        let first = self.place([touched.columns[0], touched.rows_from(self.first_row)[0]]);
        for place in [first, (first + self.pitch).min(self.items.len() - 1)] {
            fetch(&self.least[place]);
            fetch(&self.most[place]);
            fetch(&self.items[place]);
        }
    }

    /// Finds the least nearness of a block.
    #[inline(always)]
    fn look(&mut self, block: usize, across: usize) {
        let (down, right) = (block / across, block % across);
        let rows = down * BLOCK[0]..(self.rows as usize).min((down + 1) * BLOCK[0]);
        let mut least = [f32::INFINITY; LANES];
        for row in rows {
            let first = row * self.pitch + right * BLOCK[1];
            for (least, &other) in least.iter_mut().zip(&self.least[first..first + LANES]) {
                *least = if other < *least { other } else { *least };
            }
        }
        for half in [8, 4, 2, 1] {
            for i in 0..half {
                let (one, other) = (least[i], least[i + half]);
                least[i] = if other < one { other } else { one };
            }
        }
        self.blocks[block] = least[0];
        self.changes[block] = WORTH_A_LOOK[if least[0] > 0.0 { 2 } else { 1 }];
    }

    /// Tries the ray of a pixel on a triangle.
    #[inline(never)]
    pub fn ask(&mut self, view: &View, primitive: PrimitiveIndex, pixel: [u32; 2]) {
        let direction = view.direction(pixel[0], pixel[1]);
        if let Some(hit) = hit(view, primitive, direction) {
            self.offer(view, hit, direction, pixel);
        }
    }

    /// Keeps a hit of a pixel's ray if it is the nearest.
    pub fn offer(&mut self, view: &View, hit: Hit, direction: Vec3, pixel: [u32; 2]) {
        let place = self.place(pixel);
        let [mut least, most] = view.nearness(hit.parameter);
        if most < self.least[place] {
            return;
        }
        if least <= self.most[place] {
            let mut nearest =
                Band::primitive(self.items[place]).and_then(|stored| again(view, stored, direction));
            keep_nearer(&mut nearest, hit, view.scene, view.camera.origin, direction);
            if nearest.is_none_or(|nearest| nearest.primitive != hit.primitive) {
                return;
            }
            // It is no farther than what was there.
            least = least.max(self.least[place]);
        }
        (self.least[place], self.most[place]) = (least, most);
        self.items[place] = Band::item(hit.primitive);
        self.mark(pixel, [1, 1], 1);
    }

    /// Says that so many pixels changed in a box of so many columns and rows, no larger than a block.
    #[inline(always)]
    pub fn mark(&mut self, [column, row]: [u32; 2], count: [u32; 2], changes: u32) {
        let across = self.width().div_ceil(BLOCK[1]);
        let row = (row - self.first_row) as usize;
        let [top, bottom] = [row / BLOCK[0], (row + count[1] as usize - 1) / BLOCK[0]];
        let [left, right] = [column as usize / BLOCK[1], (column + count[0] - 1) as usize / BLOCK[1]];
        for down in top..=bottom {
            for block in down * across + left..=down * across + right {
                self.changes[block] = self.changes[block].saturating_sub(changes as i16);
            }
        }
    }
}

/// Makes a vector that long, and all of it one value.
fn empty<T: Copy>(vector: &mut Vec<T>, length: usize, value: T) {
    vector.clear();
    vector.resize(length, value);
}

/// Where a ray hits a triangle.
fn hit(view: &View, primitive: PrimitiveIndex, direction: Vec3) -> Option<Hit> {
    let triangle = RayTriangle::new(view.camera.origin, view.scene.corners(primitive))?;
    let parameter = triangle.hit(direction)?;
    is_there(view.scene, primitive, &triangle, direction).then_some(Hit::flat(primitive, parameter))
}

/// The hit that an item stands for.
fn again(view: &View, primitive: PrimitiveIndex, direction: Vec3) -> Option<Hit> {
    if view.scene.is_curved(primitive) {
        return Hit::curved(view.scene, primitive, view.camera.origin, direction, &RayStart::origin());
    }
    hit(view, primitive, direction)
}
