//! Pairs of boxes with a common point, found through a hierarchy of boxes.

use glam::Vec3;

/// An axis-aligned closed box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Boxed {
    pub low: Vec3,
    pub high: Vec3,
}

/// What a search for a pair came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Search {
    /// Some pair is as wanted.
    Found,
    /// No pair is.
    Nothing,
    /// More boxes would have to be looked at than were allowed.
    GivenUp,
}

impl Boxed {
    /// The smallest box around points, of which there is at least one.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a Vec3>) -> Boxed {
        let start = Boxed { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };
        points.into_iter().fold(start, |b, &p| Boxed { low: b.low.min(p), high: b.high.max(p) })
    }

    fn join(self, other: Boxed) -> Boxed {
        Boxed { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn meets(&self, other: &Boxed) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// In f64, where neither sums nor differences overflow.
    fn twice_centre(&self, axis: usize) -> f64 {
        f64::from(self.low[axis]) + f64::from(self.high[axis])
    }
}

/// Looks for a pair of boxes with a common point that is as wanted; each pair is tried once, the lower index
/// first. At most `most` boxes are looked at.
pub(super) fn any(boxes: &[Boxed], most: u64, is_wanted: impl Fn(u32, u32) -> bool) -> Search {
    let mut hierarchy = Hierarchy { items: (0..boxes.len() as u32).collect(), nodes: Vec::new() };
    if boxes.is_empty() {
        return Search::Nothing;
    }
    hierarchy.divide(boxes, 0, boxes.len());
    let mut looked_at = 0;
    let mut stack = Vec::new();
    for (index, wanted) in boxes.iter().enumerate() {
        stack.push(0);
        while let Some(node) = stack.pop() {
            looked_at += 1;
            if looked_at > most {
                return Search::GivenUp;
            }
            let node = &hierarchy.nodes[node as usize];
            if !node.bounds.meets(wanted) {
                continue;
            }
            match node.content {
                Content::Nodes(children) => stack.extend(children),
                Content::Items { first, end } => {
                    looked_at += (end - first) as u64;
                    let others = hierarchy.items[first..end].iter();
                    let met = |&&other: &&u32| other as usize > index && boxes[other as usize].meets(wanted);
                    if others.filter(met).any(|&other| is_wanted(index as u32, other)) {
                        return Search::Found;
                    }
                }
            }
        }
    }
    Search::Nothing
}

/// Boxes of boxes; the root is the first node.
struct Hierarchy {
    items: Vec<u32>,
    nodes: Vec<Node>,
}

struct Node {
    bounds: Boxed,
    content: Content,
}

enum Content {
    Nodes([u32; 2]),
    Items { first: usize, end: usize },
}

impl Hierarchy {
    /// Makes the node of a run of items and all below, by halves along the longest side; its index.
    fn divide(&mut self, boxes: &[Boxed], first: usize, end: usize) -> u32 {
        const FEW: usize = 4;
        let members = &mut self.items[first..end];
        let of = |&item: &u32| boxes[item as usize];
        let bounds = members.iter().map(of).reduce(Boxed::join).expect("a node holds something");
        let node = self.nodes.len() as u32;
        self.nodes.push(Node { bounds, content: Content::Items { first, end } });
        if members.len() > FEW {
            let axis = (bounds.high * 0.5 - bounds.low * 0.5).max_position();
            let half = members.len() / 2;
            let centre = |item: &u32| boxes[*item as usize].twice_centre(axis);
            // Ties by index, so that the order is the same everywhere.
            members.select_nth_unstable_by(half, |a, b| centre(a).total_cmp(&centre(b)).then(a.cmp(b)));
            let children = [self.divide(boxes, first, first + half), self.divide(boxes, first + half, end)];
            self.nodes[node as usize].content = Content::Nodes(children);
        }
        node
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxed(low: [f32; 3], high: [f32; 3]) -> Boxed {
        Boxed { low: low.into(), high: high.into() }
    }

    #[test]
    fn boxes_meet_that_overlap_along_all_axes() {
        let unit = boxed([0.0; 3], [1.0; 3]);
        for axis in 0..3 {
            let moved = |by: f32| {
                let mut place = [0.0; 3];
                place[axis] = by;
                boxed(place, place.map(|x| x + 1.0))
            };
            assert_eq!(
                [-1.5, -1.0, 0.5, 1.0, 1.5].map(|by| unit.meets(&moved(by))),
                [false, true, true, true, false]
            );
            assert_eq!(moved(2.0).twice_centre(axis), 5.0);
        }
        assert_eq!(
            boxed([3e38; 3], [f32::MAX; 3]).twice_centre(0),
            f64::from(3e38_f32) + f64::from(f32::MAX)
        );
    }

    #[test]
    fn no_more_boxes_are_looked_at_than_allowed() {
        // For each of two a node and both items, of which the last are looked at without asking.
        let boxes = [boxed([0.0; 3], [1.0; 3]); 2];
        let search = |most: u64| any(&boxes, most, |_, _| false);
        assert_eq!([3, 4].map(search), [Search::GivenUp, Search::Nothing]);
        assert_eq!(any(&boxes, 4, |i, j| (i, j) == (0, 1)), Search::Found);
        assert_eq!(any(&[], 0, |_, _| true), Search::Nothing);
    }

    #[test]
    fn more_than_four_are_divided_along_their_longest_side() {
        let divided = |boxes: &[Boxed]| {
            let mut hierarchy = Hierarchy { items: (0..boxes.len() as u32).collect(), nodes: Vec::new() };
            hierarchy.divide(boxes, 0, boxes.len());
            hierarchy
        };
        let along = |count: u16, [x, width]: [f32; 2], [y, step]: [f32; 2]| -> Vec<Boxed> {
            // Every other one from the beginning of y, and every other one from its end.
            let place = |i: u16| y + step * f32::from(if i.is_multiple_of(2) { i } else { count - i });
            (0..count).map(|i| boxed([x, place(i), 0.0], [x + width, place(i), 0.0])).collect()
        };
        assert_eq!(divided(&along(4, [0.0, 1.0], [0.0, 1.0])).nodes.len(), 1);
        // From 10 on and from 100 on in x, from -101 on, and from 1 to 3, where its ends are in other proportions.
        for x in [[0.0, 1.0], [99.0, 2.0], [-101.0, 2.0], [1.0, 2.0]] {
            let boxes = along(8, x, [10.0, 2.0]);
            let hierarchy = divided(&boxes);
            assert_eq!(hierarchy.nodes.len(), 3, "{x:?}");
            assert!(hierarchy.nodes[1].bounds.high.y < hierarchy.nodes[2].bounds.low.y, "{x:?}");
        }
    }
}
