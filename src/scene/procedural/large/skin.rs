//! Many triangles that share their corners.
//!
//! [`Mesh`](crate::scene::procedural::shapes::Mesh) is for polygons by the thousand; this is for triangles by the million.

use crate::scene::ObjectInput;
use glam::{DAffine3, DVec3, Vec3};

/// Triangles over shared corners, each counter-clockwise from outside.
#[derive(Debug, Clone, Default)]
pub(super) struct Skin {
    /// Corners.
    pub points: Vec<DVec3>,
    /// Three of them each.
    pub triangles: Vec<[u32; 3]>,
}

impl Skin {
    /// A new corner by its number.
    pub fn point(&mut self, place: DVec3) -> u32 {
        self.points.push(place);
        self.points.len() as u32 - 1
    }

    /// A triangle.
    pub fn triangle(&mut self, a: u32, b: u32, c: u32) {
        self.triangles.push([a, b, c]);
    }

    /// Two triangles that share the edge from the first corner to the third.
    pub fn quadrangle(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    /// Two triangles between each two neighbours of two closed rings, the second beyond the first when its corners
    /// run counter-clockwise as seen from there.
    pub fn wall(&mut self, near: &[u32], far: &[u32]) {
        for i in 0..near.len() {
            let next = (i + 1) % near.len();
            self.quadrangle([near[i], near[next], far[next], far[i]]);
        }
    }

    /// A triangle from each two neighbours of a closed ring to a point, which sees them run counter-clockwise.
    pub fn fan(&mut self, ring: &[u32], tip: u32) {
        for i in 0..ring.len() {
            self.triangle(ring[i], ring[(i + 1) % ring.len()], tip);
        }
    }

    /// A tube of rings of as many corners each that ends in a point; its beginning is closed by triangles.
    pub fn spike(&mut self, rings: &[Vec<DVec3>], tip: DVec3) {
        let rings: Vec<Vec<u32>> =
            rings.iter().map(|ring| ring.iter().map(|&p| self.point(p)).collect()).collect();
        let first = &rings[0];
        for i in 2..first.len() {
            self.triangle(first[0], first[i], first[i - 1]);
        }
        for pair in rings.windows(2) {
            self.wall(&pair[0], &pair[1]);
        }
        let tip = self.point(tip);
        self.fan(&rings[rings.len() - 1], tip);
    }

    /// A box between two corners, closed.
    pub fn cuboid(&mut self, low: DVec3, high: DVec3) {
        let corner = |i: usize, y: f64| {
            let (x, z) = [(low.x, high.z), (high.x, high.z), (high.x, low.z), (low.x, low.z)][i];
            DVec3::new(x, y, z)
        };
        let bottom: [u32; 4] = std::array::from_fn(|i| self.point(corner(i, low.y)));
        let top: [u32; 4] = std::array::from_fn(|i| self.point(corner(i, high.y)));
        self.wall(&bottom, &top);
        self.quadrangle(top);
        self.quadrangle([bottom[3], bottom[2], bottom[1], bottom[0]]);
    }

    /// All of another one where a transform that does not mirror takes it.
    pub fn add(&mut self, other: &Skin, transform: &DAffine3) {
        let base = self.points.len() as u32;
        self.points.extend(other.points.iter().map(|&p| transform.transform_point3(p)));
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|corner| base + corner)));
    }

    /// It as an object.
    pub fn into_object(self, name: impl Into<String>, material: u32) -> ObjectInput {
        let positions: Vec<Vec3> = self.points.iter().map(|p| p.as_vec3()).collect();
        ObjectInput { material, ..ObjectInput::new(name, positions, self.triangles) }
    }
}

#[cfg(test)]
impl Skin {
    /// Edges that do not belong to exactly two triangles which run through them in opposite directions.
    pub fn open_edges(&self) -> usize {
        let mut edges = std::collections::HashMap::new();
        for &[a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from.min(to), from.max(to), from < to)).or_insert(0) += 1;
            }
        }
        let is_open = |&(&(low, high, forth), &count): &(&(u32, u32, bool), &i32)| {
            count != 1 || edges.get(&(low, high, !forth)) != Some(&1)
        };
        edges.iter().filter(is_open).count()
    }

    /// The volume inside; positive if the triangles look outwards.
    pub fn volume(&self) -> f64 {
        let [a, b, c] = [0, 1, 2].map(|i| move |t: &[u32; 3]| t[i] as usize);
        let of = |t: &[u32; 3]| {
            let at = |i: usize| self.points[i];
            at(a(t)).dot(at(b(t)).cross(at(c(t))))
        };
        self.triangles.iter().map(of).sum::<f64>() / 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_and_spikes_are_closed_and_look_outwards() {
        let mut cuboid = Skin::default();
        cuboid.cuboid(DVec3::ONE, DVec3::new(2.0, 3.0, 4.0));
        assert_eq!((cuboid.open_edges(), cuboid.triangles.len()), (0, 12));
        assert!((cuboid.volume() - 6.0).abs() < 1e-12);
        let mut spike = Skin::default();
        let ring = |y: f64| vec![DVec3::new(0.0, y, 1.0), DVec3::new(1.0, y, 0.0), DVec3::new(-1.0, y, -1.0)];
        spike.spike(&[ring(0.0), ring(1.0)], 2.0 * DVec3::Y);
        assert_eq!((spike.open_edges(), spike.triangles.len()), (0, 1 + 6 + 3));
        assert!(spike.volume() > 1.0, "{}", spike.volume());
    }
}
