//! The arbiter's own culling: a hierarchy of boxes that a segment may meet.
//!
//! Boxes are never too small. A box is skipped only if an interval says so, or if the
//! segment's line passes it by more than a slack far above f64 rounding.

use super::bounds::Bounds;
use super::interval::{Box3, Interval};
use crate::geometry::LightPosition;
use glam::{DVec3, Vec3};

/// Most primitives of a leaf.
const LEAF: usize = 4;

/// Relative error of a few f64 operations in a row: a box's centre is wrong by 3 roundoffs of its corners and the
/// anchor, the direction by 3 of the point and the light, a product of the two and a difference by 2 more, and the
/// slack by 5 of itself. This is 32 of each, and the slack counts twice.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

#[derive(Debug, Clone)]
struct Node {
    low: Vec3,
    high: Vec3,
    content: Content,
}

#[derive(Debug, Clone)]
enum Content {
    /// A range of the reordered primitives.
    Leaf(std::ops::Range<u32>),
    /// Two nodes.
    Inner(u32, u32),
}

/// Primitives ordered into a tree of boxes.
#[derive(Debug)]
pub struct Hierarchy {
    nodes: Vec<Node>,
    /// Indices of the primitives, leaf by leaf.
    order: Vec<u32>,
}

impl Hierarchy {
    /// Builds the tree by halving along the longest axis of the centres.
    pub fn new(boxes: &[Bounds]) -> Hierarchy {
        let mut hierarchy = Hierarchy { nodes: Vec::new(), order: (0..boxes.len() as u32).collect() };
        if !boxes.is_empty() {
            let mut order = std::mem::take(&mut hierarchy.order);
            hierarchy.add(boxes, &mut order, 0);
            hierarchy.order = order;
        }
        hierarchy
    }

    fn add(&mut self, boxes: &[Bounds], order: &mut [u32], first: usize) -> u32 {
        let low = order.iter().map(|&i| boxes[i as usize].0).fold(Vec3::INFINITY, Vec3::min);
        let high = order.iter().map(|&i| boxes[i as usize].1).fold(Vec3::NEG_INFINITY, Vec3::max);
        let index = self.nodes.len();
        let leaf = Content::Leaf(first as u32..(first + order.len()) as u32);
        self.nodes.push(Node { low, high, content: leaf });
        if order.len() > LEAF {
            let axis = (high * 0.5 - low * 0.5).max_position();
            let centre = |&i: &u32| {
                let (low, high) = boxes[i as usize];
                f64::from(low[axis]) + f64::from(high[axis])
            };
            let middle = order.len() / 2;
            order.select_nth_unstable_by(middle, |a, b| centre(a).total_cmp(&centre(b)));
            let (left, right) = order.split_at_mut(middle);
            let left = self.add(boxes, left, first);
            let right = self.add(boxes, right, first + middle);
            self.nodes[index].content = Content::Inner(left, right);
        }
        index as u32
    }

    /// Calls `visit` with every primitive whose box the segment from the light to the point may meet, until
    /// it returns [`Visit::Stop`].
    pub fn walk(&self, light: LightPosition, point: &Box3, mut visit: impl FnMut(u32) -> Visit) {
        if self.nodes.is_empty() {
            return;
        }
        let segment = Segment::new(light, point);
        let mut stack = vec![0u32];
        while let Some(node) = stack.pop() {
            let node = &self.nodes[node as usize];
            if segment.passes(node.low.as_dvec3(), node.high.as_dvec3()) {
                continue;
            }
            match &node.content {
                Content::Inner(left, right) => stack.extend([*left, *right]),
                Content::Leaf(range) => {
                    for &primitive in &self.order[range.start as usize..range.end as usize] {
                        if visit(primitive) == Visit::Stop {
                            return;
                        }
                    }
                }
            }
        }
    }
}

impl Hierarchy {
    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>() + self.order.len() * size_of::<u32>()
    }
}

/// Whether a walk goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Visit {
    Continue,
    Stop,
}

/// A segment from a light to a point that is known within a box.
struct Segment {
    /// A box around it, infinite where the light is infinitely far away.
    low: DVec3,
    high: DVec3,
    /// A point of its line: the light, or somewhere in the point's box if that is infinitely far away.
    anchor: DVec3,
    /// How far the anchor may be off, coordinate by coordinate.
    anchor_doubt: DVec3,
    /// Along the line.
    direction: DVec3,
    /// How far the direction may be off, coordinate by coordinate.
    doubt: DVec3,
}

impl Segment {
    fn new(light: LightPosition, point: &Box3) -> Segment {
        let ends = |end: fn(&Interval) -> f64| DVec3::new(end(&point[0]), end(&point[1]), end(&point[2]));
        let (low, high) = (ends(|i| i.low), ends(|i| i.high));
        let middle = low * 0.5 + high * 0.5;
        match light {
            LightPosition::At(light) => {
                let light = light.as_dvec3();
                let doubt = (high - low) + (low.abs().max(high.abs()) + light.abs()) * ROUNDING;
                Segment {
                    low: low.min(light),
                    high: high.max(light),
                    anchor: light,
                    anchor_doubt: DVec3::ZERO,
                    direction: middle - light,
                    doubt,
                }
            }
            LightPosition::Towards(direction) => {
                let direction = direction.as_dvec3();
                let infinite = DVec3::INFINITY;
                Segment {
                    low: DVec3::select(direction.cmplt(DVec3::ZERO), -infinite, low),
                    high: DVec3::select(direction.cmpgt(DVec3::ZERO), infinite, high),
                    anchor: middle,
                    anchor_doubt: (high - low) + low.abs().max(high.abs()) * ROUNDING,
                    direction,
                    doubt: DVec3::ZERO,
                }
            }
        }
    }

    /// Whether the segment certainly does not meet a box.
    fn passes(&self, low: DVec3, high: DVec3) -> bool {
        if self.high.cmplt(low).any() || self.low.cmpgt(high).any() {
            return true;
        }
        let centre = low * 0.5 + high * 0.5 - self.anchor;
        let half = (high - low) * 0.5;
        // Largest coordinates of the box relative to the anchor, and what rounding does to its centre.
        let far = centre.abs() + half;
        let centre_error = (low.abs() + high.abs() + self.anchor.abs()) * ROUNDING + self.anchor_doubt;
        [(0, 1), (1, 2), (2, 0)].into_iter().any(|(i, j)| {
            let (di, dj) = (self.direction[i].abs(), self.direction[j].abs());
            let distance = (self.direction[i] * centre[j] - self.direction[j] * centre[i]).abs();
            let reach = di * half[j] + dj * half[i];
            let slack = di * (centre_error[j] + far[j] * ROUNDING)
                + dj * (centre_error[i] + far[i] * ROUNDING)
                + self.doubt[i] * far[j]
                + self.doubt[j] * far[i];
            distance > reach + 2.0 * slack
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_primitive_is_in_one_leaf() {
        let boxes: Vec<_> = (0..100).map(|i| (Vec3::splat(i as f32), Vec3::splat(i as f32 + 2.0))).collect();
        let hierarchy = Hierarchy::new(&boxes);
        let mut order = hierarchy.order.clone();
        order.sort_unstable();
        assert_eq!(order, (0..100).collect::<Vec<u32>>());
    }
}
