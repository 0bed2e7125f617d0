//! Which triangle lies across each edge. It belongs to the scene, and serves every light.

use crate::scene::Triangle;

/// What lies across an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Across(u32);

impl Across {
    const NOTHING: Across = Across(u32::MAX);

    /// The only other triangle that has this edge, and whether both run along it in the same direction; `None` if there
    /// is none, or more than one.
    #[inline(always)]
    pub fn triangle(self) -> Option<(u32, bool)> {
        (self != Across::NOTHING).then_some((self.0 >> 1, self.0 & 1 == 1))
    }
}

/// For each triangle what lies across the edges between its corners 0 and 1, 1 and 2, 2 and 0.
///
/// Edges are the same if their vertices have the same indices. Vertices at one place with different indices are
/// different ones, which makes an edge look like a boundary: no answer depends on it.
#[derive(Debug, Clone, Default)]
pub struct Adjacency {
    across: Vec<[Across; 3]>,
}

/// An edge as one triangle has it, filed under the smaller of its vertices.
#[derive(Debug, Clone, Copy, Default)]
struct HalfEdge {
    larger: u32,
    /// The triangle, the edge in two bits, and whether it runs from the smaller vertex to the larger.
    owner: u32,
}

/// Triangles whose number, with three more bits, is one of 32.
const MOST_TRIANGLES: usize = 1 << 29;

impl Adjacency {
    /// Of a mesh with so many vertices: counting sort by the smaller vertex of each edge. A mesh of more than 2^29
    /// triangles has none.
    pub fn new(vertices: usize, triangles: &[Triangle]) -> Adjacency {
        if triangles.len() > MOST_TRIANGLES {
            return Adjacency { across: vec![[Across::NOTHING; 3]; triangles.len()] };
        }
        let edges = |t: &Triangle| [0, 1, 2].map(|i| (t.vertices[i], t.vertices[(i + 1) % 3]));
        // Two places further on: filling moves each start to its end, which is then the start of the next.
        let mut starts = vec![0u32; vertices + 2];
        for (a, b) in triangles.iter().flat_map(edges) {
            starts[a.min(b) as usize + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut half_edges = vec![HalfEdge::default(); 3 * triangles.len()];
        for (number, triangle) in (0u32..).zip(triangles) {
            for (edge, (a, b)) in (0u32..).zip(edges(triangle)) {
                let next = &mut starts[a.min(b) as usize + 1];
                let owner = number << 3 | edge << 1 | u32::from(a < b);
                half_edges[*next as usize] = HalfEdge { larger: a.max(b), owner };
                *next += 1;
            }
        }
        let mut across = vec![[Across::NOTHING; 3]; triangles.len()];
        for range in starts.windows(2) {
            pair(&mut half_edges[range[0] as usize..range[1] as usize], &mut across);
        }
        Adjacency { across }
    }

    /// What lies across the edges of a triangle.
    #[inline(always)]
    pub fn of(&self, triangle: u32) -> [Across; 3] {
        self.across[triangle as usize]
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.across[..])
    }
}

/// Pairs the half-edges of one vertex that end in the same other one, where there are two.
fn pair(half_edges: &mut [HalfEdge], across: &mut [[Across; 3]]) {
    // Insertion for the usual handful, so that no vertex with many edges takes the square of their number.
    if half_edges.len() <= 20 {
        for i in 1..half_edges.len() {
            let mut j = i;
            while j > 0 && half_edges[j - 1].larger > half_edges[j].larger {
                half_edges.swap(j - 1, j);
                j -= 1;
            }
        }
    } else {
        half_edges.sort_unstable_by_key(|half_edge| half_edge.larger);
    }
    for same in half_edges.chunk_by(|a, b| a.larger == b.larger) {
        let [a, b] = same else { continue };
        let same_direction = u32::from(a.owner & 1 == b.owner & 1);
        for (one, other) in [(a, b), (b, a)] {
            let neighbour = Across((other.owner >> 3) << 1 | same_direction);
            across[(one.owner >> 3) as usize][(one.owner >> 1 & 3) as usize] = neighbour;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn across(triangles: &[[u32; 3]]) -> Vec<[Option<(u32, bool)>; 3]> {
        let vertices = triangles.iter().flatten().max().map_or(0, |&v| v as usize + 1);
        let triangles: Vec<_> = triangles.iter().map(|&vertices| Triangle { vertices, object: 0 }).collect();
        let adjacency = Adjacency::new(vertices, &triangles);
        (0..triangles.len() as u32).map(|t| adjacency.of(t).map(Across::triangle)).collect()
    }

    #[test]
    fn two_owners_of_an_edge_are_each_others_neighbours_and_three_are_nobodys() {
        let found = across(&[[0, 1, 2], [2, 1, 3], [0, 2, 4], [5, 1, 0], [0, 1, 6]]);
        assert_eq!(found[0], [None, Some((1, false)), Some((2, false))]);
        assert_eq!(found[1], [Some((0, false)), None, None]);
        assert_eq!(found[2][0], Some((0, false)));
        assert_eq!((found[3][1], found[4][0]), (None, None));
    }

    #[test]
    fn the_direction_along_the_edge_is_told() {
        assert_eq!(across(&[[0, 1, 2], [0, 1, 3]])[0][0], Some((1, true)));
        assert_eq!(across(&[[0, 1, 2], [1, 0, 3]])[0][0], Some((1, false)));
    }

    #[test]
    fn a_fan_around_one_vertex_is_closed() {
        let spokes = 1000;
        let fan: Vec<_> = (0..spokes).map(|i| [0, 1 + i, 1 + (i + 1) % spokes]).collect();
        for (i, neighbours) in across(&fan).into_iter().enumerate() {
            let i = i as u32;
            assert_eq!(neighbours[0], Some(((i + spokes - 1) % spokes, false)));
            assert_eq!(neighbours[1], None);
            assert_eq!(neighbours[2], Some(((i + 1) % spokes, false)));
        }
    }
}
