//! A second look at triangles of a cell of which the first, on many cells at a time and in f32, could not say enough.

use super::cell_lists::Item;
use super::projection::{Projected, Projector};
use crate::scene::Scene;
use crate::shadow::light_buffer::cube::Face;

/// The triangles of a tile.
pub(super) struct TileTriangles<'a> {
    pub scene: &'a Scene,
    pub projector: &'a Projector,
    /// The scene's vertices.
    pub projected: &'a [Projected],
    /// The side of the tile.
    pub face: Face,
    /// The number of each in the scene.
    pub numbers: &'a [u32],
    /// Its vertices.
    pub vertices: &'a [[u32; 3]],
    /// Edges 01, 12 and 20 of each that are not regular, a bit each.
    pub irregular: &'a [u8],
}

impl TileTriangles<'_> {
    /// An entry of the cell in some column and row, with less doubt.
    #[cold]
    pub fn look_again(&self, item: Item, cell: [u32; 2]) -> Item {
        let (triangle, mut flags) = (item.triangle(), item.flags());
        // What lies on several sides has no place on this one.
        if item.has(Item::IN_SPACE) {
            return item;
        }
        if item.has(Item::IRREGULAR) && !self.may_be_irregular(triangle as usize, cell) {
            flags &= !Item::IRREGULAR;
        }
        if item.has(Item::MAY_COVER)
            && let Some(covers) = self.covers(triangle as usize, cell)
        {
            flags = flags & !Item::MAY_COVER | if covers { Item::COVERS } else { 0 };
        }
        Item::new(triangle, flags)
    }

    /// Whether one of a triangle's irregular edges may meet a cell: their limits overlap, as the cell and the line through the edge do.
    /// Coordinates are wrong by delta, and what a whole number with so little beside it is rounded by is less than delta / 5.
    fn may_be_irregular(&self, triangle: usize, cell: [u32; 2]) -> bool {
        let corners = self.vertices[triangle].map(|vertex| &self.projected[vertex as usize]);
        let slack = 1.25 * self.projector.delta;
        (0..3).filter(|edge| self.irregular[triangle] >> edge & 1 == 1).any(|edge| {
            let (p, q) = (corners[edge], corners[(edge + 1) % 3]);
            let overlaps = |p: f32, q: f32, cell: u32| {
                let (low, high) = (cell as f32 - slack, (cell + 1) as f32 + slack);
                !(p < low && q < low || p > high && q > high)
            };
            overlaps(p.u, q.u, cell[0]) && overlaps(p.v, q.v, cell[1])
        })
    }

    /// Whether a triangle of one side covers the centre of a cell, edges excluded, or `None` if f64 cannot tell: the centre's direction, in
    /// whole numbers, is on the same side of all three planes through the light and an edge.
    ///
    /// Differences of f32 numbers are wrong by 2^-53 of themselves in f64, their products by 3 2^-53, the differences of two
    /// products by 4 2^-53 of both, and the sum of three times whole numbers by 7 2^-53 of all; 16 are taken.
    fn covers(&self, triangle: usize, cell: [u32; 2]) -> Option<bool> {
        let light = self.projector.light.as_dvec3();
        let corners = self.vertices[triangle]
            .map(|vertex| self.face.coordinates(self.scene.vertices[vertex as usize].as_dvec3() - light));
        let resolution = f64::from(self.projector.resolution);
        let coordinate = |cell: u32| f64::from(2 * cell + 1) - resolution;
        let centre = [coordinate(cell[0]), coordinate(cell[1]), resolution];
        let (mut above, mut below, mut is_certain) = (false, false, true);
        for edge in 0..3 {
            let (p, q) = (corners[edge], corners[(edge + 1) % 3]);
            let (mut value, mut size) = (0.0, 0.0);
            for (i, along) in centre.into_iter().enumerate() {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let (one, other) = (p[j] * q[k], p[k] * q[j]);
                value += along * (one - other);
                size += along.abs() * (one.abs() + other.abs());
            }
            let error = size * (8.0 * f64::EPSILON);
            above |= value > error;
            below |= value < -error;
            is_certain &= value.abs() > error;
        }
        if above && below {
            Some(false)
        } else if is_certain {
            Some(true)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tiles::EDGE;
    use super::*;
    use crate::geometry::{Sign, planes};
    use crate::scene::{ObjectInput, SceneBuilder};
    use glam::Vec3;
    use proptest::prelude::*;

    const FLAGS: u32 = Item::IRREGULAR | Item::MAY_COVER;

    /// Triangles before the side that looks against z, some of them thin or with an edge through a cell's centre.
    fn corners() -> impl Strategy<Value = [Vec3; 3]> {
        let on_grid = (-7i8..8, -7i8..8).prop_map(|(x, y)| Vec3::new(f32::from(x), f32::from(y), -8.0));
        let place = (-1.0f32..1.0, -1.0f32..1.0).prop_map(|(x, y)| Vec3::new(x, y, -1.0));
        let place = (prop_oneof![on_grid, place], 0.5f32..2.0).prop_map(|(place, scale)| place * scale);
        let place = place.boxed();
        (place.clone(), place.clone(), place, prop::sample::select(vec![1.0f32, 1e-3, 1e-7]))
            .prop_map(|(a, b, c, width)| [a, b, a + 0.4 * (b - a) + width * (c - a)])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        #[test]
        fn what_is_no_longer_in_doubt_is_so(
            corners in corners(),
            resolution in prop::sample::select(vec![1u32, 8, 15, 64]),
            cell in [0.0f32..1.0, 0.0..1.0],
            irregular in 0u8..8,
        ) {
            let mut builder = SceneBuilder::new("second look");
            builder.add_object(ObjectInput::new("one", corners.to_vec(), vec![[0, 1, 2]])).expect("in range");
            let scene = builder.finish();
            prop_assume!(scene.triangles.len() == 1);
            let cell = cell.map(|at| (at * resolution as f32) as u32);
            let face = Face::ALL[5];
            let projector = Projector::new(Vec3::ZERO, resolution);
            let projected = corners.map(|p| projector.project(p.to_array()));
            prop_assume!(projected.iter().all(|p| p.side == 5));
            let (vertices, numbers, irregular) = ([[0, 1, 2]], [0], [irregular]);
            let tile = TileTriangles {
                scene: &scene, projector: &projector, projected: &projected, face,
                numbers: &numbers, vertices: &vertices, irregular: &irregular,
            };
            let found = tile.look_again(Item::new(0, FLAGS), cell);
            let along = |cell: u32| 2.0 * cell as f32 + 1.0 - resolution as f32;
            let centre = Vec3::new(along(cell[0]), along(cell[1]), -(resolution as f32));
            let signs = [0, 1, 2].map(|i| planes::orientation(Vec3::ZERO, [corners[i], corners[(i + 1) % 3], centre]));
            let covers = signs == [Sign::Positive; 3] || signs == [Sign::Negative; 3];
            let misses = signs.contains(&Sign::Positive) && signs.contains(&Sign::Negative);
            prop_assert!(!found.has(Item::COVERS) || covers);
            prop_assert!(found.has(Item::COVERS | Item::MAY_COVER) || misses);
            for edge in (0..3).filter(|edge| irregular[0] >> edge & 1 == 1) {
                let (p, q) = (corners[edge].as_dvec3(), corners[(edge + 1) % 3].as_dvec3());
                for step in 0..=64 {
                    let [x, y, z] = face.coordinates(p + (q - p) * (f64::from(step) / 64.0));
                    let is_in = |at: f64, cell: u32| {
                        let at = (at / z + 1.0) * f64::from(projector.half);
                        at >= f64::from(cell) && at <= f64::from(cell + 1)
                    };
                    prop_assert!(found.has(Item::IRREGULAR) || !(is_in(x, cell[0]) && is_in(y, cell[1])));
                }
            }
        }
    }

    #[test]
    fn what_lies_in_space_stays_in_doubt() {
        let scene = SceneBuilder::new("none").finish();
        let projector = Projector::new(Vec3::ZERO, EDGE);
        let tile = TileTriangles {
            scene: &scene,
            projector: &projector,
            projected: &[],
            face: Face::ALL[0],
            numbers: &[],
            vertices: &[],
            irregular: &[],
        };
        let item = Item::new(3, FLAGS | Item::IN_SPACE);
        assert_eq!(tile.look_again(item, [0, 0]), item);
    }
}
