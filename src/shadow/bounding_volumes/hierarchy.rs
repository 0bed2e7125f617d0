//! Clusters of volumes, halved from above where the halves have the least surface.
//!
//! A segment that meets a cluster meets a part of it the oftener the larger the part's surface is, so a
//! cluster is cut along the axis and at the place where surface times cost, summed over both sides, is least.
//! (The 1986 paper only says that its hierarchy is automatic.)

use crate::geometry::volume::Volume;
use glam::Vec3;

/// What is clustered.
#[derive(Debug, Clone, Copy)]
pub struct Member {
    /// Around all of it.
    pub volume: Volume,
    /// What it costs to look inside, in any unit; positive.
    pub cost: f64,
}

/// A volume and what it holds.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    pub volume: Volume,
    pub content: Content,
}

/// What a volume holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// The member with this index.
    Object(u32),
    /// Two nodes, by index.
    Cluster([u32; 2]),
}

/// Levels below which clusters are cut in the middle, so that the hierarchy is never deep.
const LEVELS_BY_SURFACE: u32 = 48;

/// A binary hierarchy with one member a leaf.
pub struct Hierarchy {
    /// Parts before what holds them; the root is the last.
    nodes: Vec<Node>,
    depth: u32,
}

impl Hierarchy {
    /// Clusters some members; the same ones in the same order give the same hierarchy.
    pub fn new(members: &[Member]) -> Hierarchy {
        let mut hierarchy = Hierarchy { nodes: Vec::with_capacity(2 * members.len()), depth: 0 };
        let mut order: Vec<u32> = (0..members.len() as u32).collect();
        if !order.is_empty() {
            hierarchy.cluster(members, &mut order, 0);
        }
        hierarchy
    }

    /// The node around everything, unless there is nothing.
    pub fn root(&self) -> Option<&Node> {
        self.nodes.last()
    }

    /// A part of a cluster.
    pub fn node(&self, index: u32) -> &Node {
        &self.nodes[index as usize]
    }

    /// Volumes of members and clusters.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// How many of these are spheres.
    pub fn spheres(&self) -> usize {
        self.nodes.iter().filter(|node| matches!(node.volume, Volume::Sphere { .. })).count()
    }

    /// Volumes around the deepest member but its own.
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>()
    }

    fn cluster(&mut self, members: &[Member], order: &mut [u32], depth: u32) -> u32 {
        self.depth = self.depth.max(depth);
        let volumes = order.iter().map(|&m| members[m as usize].volume);
        let node = if let [member] = *order {
            Node { volume: members[member as usize].volume, content: Content::Object(member) }
        } else {
            let volume = Volume::around_volumes(volumes).expect("a cluster has members");
            let cut = if depth < LEVELS_BY_SURFACE { cut(members, order) } else { order.len() / 2 };
            let (one, other) = order.split_at_mut(cut);
            let parts = [one, other].map(|part| self.cluster(members, part, depth + 1));
            Node { volume, content: Content::Cluster(parts) }
        };
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }
}

/// Sorts the members of a cluster along the best axis; those before the returned place are one half.
fn cut(members: &[Member], order: &mut [u32]) -> usize {
    let mut best = (f64::INFINITY, 0, order.len() / 2);
    for axis in 0..3 {
        sort(members, order, axis);
        let behind = costs(members, order.iter().rev());
        let before = costs(members, order.iter());
        for place in 1..order.len() {
            let cost = before[place - 1] + behind[order.len() - place - 1];
            if cost < best.0 {
                best = (cost, axis, place);
            }
        }
    }
    sort(members, order, best.1);
    best.2
}

fn sort(members: &[Member], order: &mut [u32], axis: usize) {
    let centre = |m: u32| members[m as usize].volume.centre()[axis];
    order.sort_unstable_by(|&a, &b| centre(a).total_cmp(&centre(b)).then(a.cmp(&b)));
}

/// Surface times cost of the first, the first two and so on.
fn costs<'a>(members: &[Member], order: impl Iterator<Item = &'a u32>) -> Vec<f64> {
    let (mut low, mut high, mut cost) = (Vec3::MAX, Vec3::MIN, 0.0);
    let with = |&m: &u32| {
        let member = &members[m as usize];
        let (member_low, member_high) = member.volume.corners();
        (low, high, cost) = (low.min(member_low), high.max(member_high), cost + member.cost);
        Volume::Box { low, high }.surface() * cost
    };
    order.map(with).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn member(x: f32, half: f32) -> Member {
        let volume = Volume::Box { low: Vec3::new(x - half, 0.0, 0.0), high: Vec3::new(x + half, 1.0, 1.0) };
        Member { volume, cost: 2.0 }
    }

    /// Members below a node, and that they lie within the boxes of all above.
    fn below(hierarchy: &Hierarchy, node: &Node) -> Vec<u32> {
        match node.content {
            Content::Object(member) => vec![member],
            Content::Cluster(parts) => parts
                .iter()
                .flat_map(|&part| {
                    let part = hierarchy.node(part);
                    let ((low, high), (outer_low, outer_high)) =
                        (part.volume.corners(), node.volume.corners());
                    assert!(outer_low.cmple(low).all() && outer_high.cmpge(high).all());
                    below(hierarchy, part)
                })
                .collect(),
        }
    }

    #[test]
    fn every_member_is_a_leaf_once() {
        let members: Vec<_> = (0..1000).map(|i| member((i * 7919 % 1000) as f32, 0.4)).collect();
        let hierarchy = Hierarchy::new(&members);
        let mut found = below(&hierarchy, hierarchy.root().unwrap());
        found.sort_unstable();
        assert_eq!(found, (0..1000).collect::<Vec<_>>());
        assert_eq!(hierarchy.count(), 1999);
        assert!((9..30).contains(&hierarchy.depth()), "{}", hierarchy.depth());
    }

    #[test]
    fn neighbours_are_clustered() {
        let hierarchy = Hierarchy::new(&[member(0.0, 0.5), member(100.0, 0.5), member(1.0, 0.5)]);
        let Content::Cluster(parts) = hierarchy.root().unwrap().content else { panic!("a cluster") };
        let mut halves = parts.map(|part| below(&hierarchy, hierarchy.node(part)));
        halves.sort();
        assert_eq!(halves, [vec![0, 2], vec![1]]);
    }

    #[test]
    fn sizes_that_double_do_not_make_it_deep() {
        // Each holds all smaller ones, so that surfaces cut off one at a time.
        let members: Vec<_> = (0..5000).map(|i| member(2f32.powf(i as f32 / 50.0), 0.0)).collect();
        assert!(Hierarchy::new(&members).depth() <= LEVELS_BY_SURFACE + 13);
        let equal = vec![member(0.0, 0.5); 5000];
        assert!(Hierarchy::new(&equal).depth() <= LEVELS_BY_SURFACE + 13);
    }
}
