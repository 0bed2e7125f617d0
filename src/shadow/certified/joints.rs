//! Which of the triangles of a cell own a regular edge together.

use super::edges::Edges;

/// In place of a triangle.
pub(super) const NONE: u32 = u32::MAX;

/// What joins the triangles of a tile, and the entries of one of its cells.
#[derive(Debug, Default)]
pub(super) struct Joints {
    /// For each triangle of the tile the others that own its edges 01, 12 and 20 with it, if these are regular.
    partners: Vec<[u32; 3]>,
    /// For each triangle of the tile a mark of the cell in which it was entered last, and its place there.
    entered: Vec<(u32, u32)>,
    mark: u32,
}

impl Joints {
    /// Takes in the edges of a tile's triangles, of which there are so many.
    pub fn begin(&mut self, edges: &Edges, triangles: usize) {
        self.partners.clear();
        self.partners.resize(triangles, [NONE; 3]);
        for [one, other] in edges.regular() {
            self.partners[one / 4][one % 4] = (other / 4) as u32;
            self.partners[other / 4][other % 4] = (one / 4) as u32;
        }
        self.entered.clear();
        self.entered.resize(triangles, (0, 0));
        self.mark = 0;
    }

    /// Goes over to a cell with these triangles.
    pub fn enter(&mut self, triangles: &[u32]) {
        self.mark += 1;
        for (place, &triangle) in (0..).zip(triangles) {
            self.entered[triangle as usize] = (self.mark, place);
        }
    }

    /// The place in the cell of the triangle that owns an edge of another with it, or [`NONE`] if the edge is not regular, or that triangle is not in the cell.
    #[inline(always)]
    pub fn partner(&self, triangle: usize, edge: usize) -> u32 {
        let partner = self.partners[triangle][edge];
        if partner == NONE {
            return NONE;
        }
        let (mark, place) = self.entered[partner as usize];
        if mark == self.mark { place } else { NONE }
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.partners.capacity() * size_of::<[u32; 3]>() + self.entered.capacity() * size_of::<(u32, u32)>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::facing::Facing;
    use super::*;

    #[test]
    fn partners_are_found_among_the_triangles_of_the_cell() {
        // A strip of four, a fifth at the end that faces away, and one that is alone.
        let strip = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5], [4, 5, 6], [7, 8, 9]];
        let mut facing = [Facing::Positive; 6];
        facing[4] = Facing::Negative;
        let mut edges = Edges::default();
        edges.find(&strip, &facing, &mut Vec::new());
        let mut joints = Joints::default();
        joints.begin(&edges, strip.len());
        let partners = |joints: &Joints, triangle| [0, 1, 2].map(|edge| joints.partner(triangle, edge));
        joints.enter(&[3, 5, 1, 4, 0]);
        assert_eq!(partners(&joints, 0), [NONE, 2, NONE]);
        assert_eq!(partners(&joints, 1), [4, NONE, NONE]);
        assert_eq!(partners(&joints, 3), [NONE; 3]);
        joints.enter(&[2, 1]);
        assert_eq!(partners(&joints, 1), [NONE, NONE, 0]);
        assert_eq!(partners(&joints, 2), [1, NONE, NONE]);
    }
}
