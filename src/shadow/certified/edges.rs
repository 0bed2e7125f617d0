//! Which edges of some triangles are regular (TRUTH, "Certified cells").

use super::facing::Facing;

/// The edges of the triangles of one tile. An edge is regular if exactly two of them own it and their third corners lie on
/// different sides of the plane through the edge and the light.
///
/// Triangles that are edge-on block nothing and own nothing. Those of one tile are enough. Where an edge meets a cell of the tile before the horizon, all its owners do, and
/// each is there; and certificates ask for nothing that is not before the horizon.
///
/// Edges are the same if their vertices have the same indices. Vertices at one place with different indices are different
/// ones, which makes an edge look like a boundary: no answer depends on it.
#[derive(Debug, Default)]
pub(super) struct Edges {
    /// Of a hash table: one more than a half-edge, 0 for none.
    slots: Vec<u32>,
    /// Of each half-edge that came first: one more than the second that makes it regular, 0 if it is alone so far, and [`MANY`]
    /// if nothing makes it regular any more.
    others: Vec<u32>,
}

/// In place of the second owner of an edge that has others.
const MANY: u32 = u32::MAX;

/// A triangle's number in the tile and its edge from corner 0, 1 or 2 to the next one, in two bits.
fn half_edge(triangle: usize, edge: usize) -> usize {
    4 * triangle + edge
}

#[inline(always)]
fn ends(triangles: &[[u32; 3]], half_edge: usize) -> (u32, u32) {
    let (triangle, edge) = (&triangles[half_edge / 4], half_edge % 4);
    (triangle[edge], triangle[if edge == 2 { 0 } else { edge + 1 }])
}

impl Edges {
    /// Sets `irregular[i]` to the edges 01, 12 and 20 of triangle i that are not regular, a bit each.
    pub fn find(&mut self, triangles: &[[u32; 3]], facing: &[Facing], irregular: &mut Vec<u8>) {
        irregular.clear();
        irregular.resize(triangles.len(), 0b111);
        let size = (4 * triangles.len()).next_power_of_two().max(16);
        self.slots.clear();
        self.slots.resize(size, 0);
        self.others.clear();
        self.others.resize(4 * triangles.len(), 0);
        for triangle in (0..triangles.len()).filter(|&t| facing[t] != Facing::Nothing) {
            for edge in 0..3 {
                self.enter(triangles, facing, half_edge(triangle, edge), irregular);
            }
        }
    }

    #[inline(always)]
    fn enter(&mut self, triangles: &[[u32; 3]], facing: &[Facing], this: usize, irregular: &mut [u8]) {
        let (a, b) = ends(triangles, this);
        let (low, high) = (a.min(b), a.max(b));
        let hash = (u64::from(low) << 32 | u64::from(high)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mask = self.slots.len() - 1;
        let mut slot = (hash >> 32) as usize & mask;
        while self.slots[slot] != 0 {
            let first = self.slots[slot] as usize - 1;
            let (c, d) = ends(triangles, first);
            if (c.min(d), c.max(d)) == (low, high) {
                let (one, other) = (facing[first / 4], facing[this / 4]);
                let mut mark = |half_edge: usize| irregular[half_edge / 4] ^= 1 << (half_edge % 4);
                self.others[first] = match self.others[first] {
                    // Two that run along it in opposite directions have their third corners on different sides exactly if both
                    // have the same orientation.
                    0 if (one == other) == (a != c) => {
                        mark(first);
                        mark(this);
                        this as u32 + 1
                    }
                    0 | MANY => MANY,
                    second => {
                        mark(first);
                        mark(second as usize - 1);
                        MANY
                    }
                };
                return;
            }
            slot = (slot + 1) & mask;
        }
        self.slots[slot] = this as u32 + 1;
    }

    /// The two half-edges of each edge that is regular among those that were looked at last: four times the number of the triangle and that of the edge.
    pub fn regular(&self) -> impl Iterator<Item = [usize; 2]> {
        let owners = self.others.iter().enumerate();
        owners
            .filter(|(_, other)| !matches!(**other, 0 | MANY))
            .map(|(first, &other)| [first, other as usize - 1])
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        (self.slots.capacity() + self.others.capacity()) * size_of::<u32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Facing::{Negative, Nothing, Positive};

    fn irregular(triangles: &[[u32; 3]], facing: &[Facing]) -> Vec<u8> {
        let mut irregular = Vec::new();
        Edges::default().find(triangles, facing, &mut irregular);
        irregular
    }

    #[test]
    fn an_edge_of_two_is_regular_if_they_lie_on_different_sides_of_it() {
        // The second triangle runs along edge 12 against the first: the same orientation unfolds it.
        let against = [[0, 1, 2], [2, 1, 3]];
        assert_eq!(irregular(&against, &[Positive, Positive]), [0b101, 0b110]);
        assert_eq!(irregular(&against, &[Negative, Negative]), [0b101, 0b110]);
        assert_eq!(irregular(&against, &[Positive, Negative]), [0b111, 0b111]);
        let along = [[0, 1, 2], [1, 2, 3]];
        assert_eq!(irregular(&along, &[Positive, Negative]), [0b101, 0b110]);
        assert_eq!(irregular(&along, &[Positive, Positive]), [0b111, 0b111]);
    }

    #[test]
    fn an_edge_on_neighbour_makes_an_edge_irregular() {
        assert_eq!(irregular(&[[0, 1, 2], [2, 1, 3]], &[Positive, Nothing]), [0b111, 0b111]);
        assert_eq!(irregular(&[[0, 1, 2], [2, 1, 3]], &[Nothing, Nothing]), [0b111, 0b111]);
        // Beside two others it is nobody.
        let three = [[0, 1, 2], [2, 1, 4], [2, 1, 3]];
        assert_eq!(irregular(&three, &[Positive, Nothing, Positive]), [0b101, 0b111, 0b110]);
    }

    #[test]
    fn a_third_and_a_fourth_owner_make_it_irregular_for_all() {
        let fan = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]];
        assert_eq!(irregular(&fan[..2], &[Positive; 2]), [0b110, 0b110]);
        assert_eq!(irregular(&fan[..3], &[Positive; 3]), [0b111; 3]);
        assert_eq!(irregular(&fan, &[Positive; 4]), [0b111; 4]);
        // The same triangle twice has a third owner at every edge that a neighbour has.
        assert_eq!(irregular(&[[0, 1, 2], [1, 0, 3], [0, 1, 2]], &[Positive; 3]), [0b111; 3]);
    }

    #[test]
    fn a_fan_around_one_vertex_is_closed() {
        let spokes = 1000;
        let fan: Vec<_> = (0..spokes).map(|i| [0, 1 + i, 1 + (i + 1) % spokes]).collect();
        assert_eq!(irregular(&fan, &vec![Positive; fan.len()]), vec![0b010; fan.len()]);
    }
}
