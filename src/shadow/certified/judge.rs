//! Verdicts on the triangles of a cell that no single pair of depths decides: each against all others in the cell.
//!
//! Where edges of a wall and the ground before it lie in a cell, depths of the two overlap, and as surfaces they are one with irregular edges. But
//! that the ground blocks nothing of the wall follows from the two planes, and that a roof covers the foot of another wall, from the roof alone.
//!
//! - A triangle is lit in the cell, if all others of the cell are harmless to it.
//! - It is dark in the cell, if some others are before it wherever both are in the same direction, and cover what it shares with the cell: one of them
//!   covers a direction inside of that, and of those that follow from it by going over edges that go through it, none has such an edge that is not
//!   regular, or that belongs to a triangle which may be behind or block nothing. Across a regular edge the other owner takes over; so
//!   as many of them cover every direction inside of it, off the edges, as cover the first, and with the edges, which belong to triangles, they cover all of it.
//!   An edge whose other owner is harmless does not go through it: at that edge both are at the same depth.

use super::by_triangle::{State, States};
use super::cell_lists::Item;
use super::edges::Edges;
use super::entries::{Cell, Entries};
use super::joints::{Joints, NONE};
use super::pyramids::{Base, LANES, Place, Pyramid, Pyramids, Relations};
use super::verdict::Verdict;
use crate::geometry::batch::InstructionSet;
use crate::geometry::masks::{Bits, bits};
use glam::DVec3;

/// Up to so many entries of a cell are judged.
pub(super) const MOST: usize = 128;
const CHUNKS: usize = MOST / LANES;

/// The places of one cell after the other.
pub(super) struct Judge {
    /// Whether the tile's triangles were looked at.
    is_prepared: bool,
    joints: Joints,
    /// Of the triangles of the tile.
    pyramids: Vec<Pyramid>,
    states: Vec<State>,
    /// Of the entries of the cell.
    sides: Vec<Pyramids>,
    triangles: Vec<u32>,
    place: Place,
}

/// A cell's entries that are judged.
pub(super) struct Judged<'a> {
    pub cell: &'a Cell<'a>,
    pub edges: &'a Edges,
    /// How many there are.
    pub count: usize,
}

/// One of the entries against the others, sixteen of them when somebody first asks.
struct Trial<'a> {
    set: InstructionSet,
    judge: &'a Judge,
    entries: &'a Entries,
    irregular: &'a [u8],
    count: usize,
    this: usize,
    known: u32,
    /// A bit for each of sixteen.
    before: [u32; CHUNKS],
    harmless: [u32; CHUNKS],
    cuts: [[u32; 3]; CHUNKS],
}

impl Judge {
    /// Of no tile.
    pub fn new() -> Judge {
        Judge {
            is_prepared: false,
            joints: Joints::default(),
            pyramids: Vec::new(),
            states: Vec::new(),
            sides: Vec::new(),
            triangles: Vec::new(),
            place: Place([0.0; 3]),
        }
    }

    /// Goes over to a tile with so many triangles.
    pub fn begin(&mut self, triangles: usize) {
        self.is_prepared = false;
        self.states.clear();
        self.states.resize(triangles, State::default());
    }

    /// Notes a verdict on the points that a triangle of the tile has in a cell.
    #[inline(always)]
    pub fn note(&mut self, item: Item, verdict: Verdict) {
        self.states[item.triangle() as usize].add(verdict);
    }

    /// Hands on what the cells of the tile say of the triangles, whose numbers in the scene these are.
    pub fn end(&self, numbers: &[u32], states: &States) {
        for (&number, &state) in numbers.iter().zip(&self.states) {
            states.add(number, state);
        }
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.joints.bytes()
            + self.pyramids.capacity() * size_of::<Pyramid>()
            + self.states.capacity() * size_of::<State>()
    }

    /// Judges entries whose verdict is open.
    #[inline(always)]
    pub fn judge(&mut self, set: InstructionSet, judged: &Judged<'_>, entries: &mut Entries) {
        let count = judged.count;
        if count > MOST {
            return;
        }
        if !self.is_prepared {
            self.prepare(judged);
        }
        self.gather(judged, entries);
        for this in 0..count {
            if entries.verdicts[this] == Verdict::Open {
                let trial = Trial {
                    set,
                    judge: self,
                    entries,
                    irregular: judged.cell.tile.irregular,
                    count,
                    this,
                    known: 0,
                    before: [0; CHUNKS],
                    harmless: [0; CHUNKS],
                    cuts: [[0; 3]; CHUNKS],
                };
                entries.verdicts[this] = trial.verdict();
            }
        }
    }

    /// Takes in the triangles of the tile.
    fn prepare(&mut self, judged: &Judged<'_>) {
        let tile = judged.cell.tile;
        let on_side = |v: DVec3| DVec3::from(tile.face.coordinates(v));
        let light = on_side(tile.projector.light.as_dvec3());
        self.joints.begin(judged.edges, tile.vertices.len());
        self.pyramids.clear();
        self.pyramids.extend(tile.vertices.iter().map(|&vertices| {
            let corners = vertices.map(|vertex| on_side(tile.scene.vertices[vertex as usize].as_dvec3()));
            Pyramid::new(Base { corners, light, indices: vertices })
        }));
        self.is_prepared = true;
    }

    /// Takes in the entries of the cell.
    #[inline(always)]
    fn gather(&mut self, judged: &Judged<'_>, entries: &Entries) {
        let resolution = judged.cell.tile.projector.resolution;
        let centre = |cell: u32| f64::from(2 * cell + 1) - f64::from(resolution);
        let [x, y] = judged.cell.at;
        self.place = Place([centre(x), centre(y), f64::from(resolution)]);
        self.triangles.clear();
        self.triangles.extend(entries.items[..judged.count].iter().map(|item| item.triangle()));
        while self.sides.len() * LANES < judged.count {
            self.sides.push(Pyramids::new());
        }
        for (entry, &triangle) in self.triangles.iter().enumerate() {
            self.sides[entry / LANES].set(entry % LANES, &self.pyramids[triangle as usize]);
        }
        self.joints.enter(&self.triangles);
    }
}

impl Trial<'_> {
    #[inline(always)]
    fn verdict(mut self) -> Verdict {
        let chunks = self.count.div_ceil(LANES);
        let mut others = [0; CHUNKS];
        for (chunk, others) in others.iter_mut().enumerate().take(chunks) {
            self.compare_depths(chunk);
            let here = u32::MAX >> (32 - (self.count - chunk * LANES).min(LANES));
            let this = if self.this / LANES == chunk { 1 << (self.this % LANES) } else { 0 };
            *others = here & !this & !self.harmless[chunk];
        }
        if others == [0; CHUNKS] {
            return Verdict::Lit;
        }
        let pyramid = self.pyramid();
        if let Some(at) = self.inside(pyramid) {
            let (mut covers, mut is_hidden) = ([0; LANES], false);
            for (chunk, &others) in others.iter().enumerate().filter(|(_, others)| **others != 0) {
                self.judge.sides[chunk].cover(at, &mut covers);
                for lane in Bits(bits(self.set, &covers) & others) {
                    if self.is_before(chunk * LANES + lane) {
                        if self.is_covered_from(chunk * LANES + lane) {
                            return Verdict::Dark;
                        }
                        is_hidden = true;
                    }
                }
            }
            if is_hidden {
                return Verdict::Open;
            }
        }
        for (chunk, &others) in others.iter().enumerate().filter(|(_, others)| **others != 0) {
            self.relate(chunk);
            if others & !self.harmless[chunk] != 0 {
                return Verdict::Open;
            }
        }
        Verdict::Lit
    }

    fn pyramid(&self) -> &Pyramid {
        &self.judge.pyramids[self.judge.triangles[self.this] as usize]
    }

    /// A direction inside of what this one shares with the cell, if there is one for certain.
    #[inline(always)]
    fn inside(&self, pyramid: &Pyramid) -> Option<[f64; 3]> {
        let item = self.entries.items[self.this];
        if item.has(Item::COVERS) {
            return Some(self.judge.place.0);
        }
        if item.has(Item::IN_SPACE) { None } else { pyramid.inside(&self.judge.place) }
    }

    /// What depths in the cell say of sixteen.
    #[inline(always)]
    fn compare_depths(&mut self, chunk: usize) {
        let (near, far) = (self.entries.near[self.this], self.entries.far[self.this]);
        let of_chunk = chunk * LANES..(chunk + 1) * LANES;
        let (nears, fars) = (&self.entries.near[of_chunk.clone()], &self.entries.far[of_chunk]);
        let (mut before, mut harmless) = ([0; LANES], [0; LANES]);
        for i in 0..LANES {
            before[i] = u32::from(fars[i] > near);
            harmless[i] = u32::from(nears[i] < far);
        }
        self.before[chunk] = bits(self.set, &before);
        self.harmless[chunk] = bits(self.set, &harmless);
    }

    /// What planes say of sixteen.
    #[inline(always)]
    fn relate(&mut self, chunk: usize) {
        if self.known >> chunk & 1 == 1 {
            return;
        }
        self.known |= 1 << chunk;
        let mut relations = Relations::default();
        self.judge.sides[chunk].relations(self.pyramid(), &self.judge.place, &mut relations);
        self.before[chunk] |= bits(self.set, &relations.before);
        self.harmless[chunk] |= bits(self.set, &relations.harmless);
        for edge in 0..3 {
            self.cuts[chunk][edge] = bits(self.set, &relations.cuts[edge]);
        }
    }

    /// Whether an entry is before this one where both are in the same direction.
    #[inline(always)]
    fn is_before(&mut self, entry: usize) -> bool {
        self.relate(entry / LANES);
        self.before[entry / LANES] >> (entry % LANES) & 1 == 1
    }

    /// Whether an entry that is before this one, and those that take over from it, cover all that this one shares with the cell.
    #[inline(always)]
    fn is_covered_from(&mut self, first: usize) -> bool {
        let (mut taken, mut left) = ([0u32; CHUNKS], [0u32; CHUNKS]);
        left[first / LANES] = 1 << (first % LANES);
        while let Some(chunk) = (0..CHUNKS).find(|&chunk| left[chunk] != 0) {
            let lane = left[chunk].trailing_zeros() as usize;
            left[chunk] &= left[chunk] - 1;
            taken[chunk] |= 1 << lane;
            let entry = chunk * LANES + lane;
            let triangle = self.judge.triangles[entry] as usize;
            let may_be_irregular = self.entries.items[entry].has(Item::IRREGULAR);
            for edge in 0..3 {
                if self.cuts[chunk][self.judge.pyramids[triangle].edge(edge)] >> lane & 1 == 0 {
                    continue;
                }
                if self.irregular[triangle] >> edge & 1 == 1 {
                    if may_be_irregular {
                        return false;
                    }
                    continue;
                }
                // An edge whose other owner is not in the cell does not meet it.
                let other = self.judge.joints.partner(triangle, edge);
                if other == NONE {
                    continue;
                }
                let other = other as usize;
                if self.is_before(other) {
                    left[other / LANES] |= 1 << (other % LANES) & !taken[other / LANES];
                } else if self.harmless[other / LANES] >> (other % LANES) & 1 == 0 {
                    return false;
                }
            }
        }
        true
    }
}
