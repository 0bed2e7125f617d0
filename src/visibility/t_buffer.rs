//! The t-buffer (Raghuvanshi and Dhande 2004, section II): first hits object by object, with only the
//! rays that an object's projection can cover.
//!
//! A triangle's footprint on the image is a superset made of boxes around the pixel centres, as wide as a
//! ray's rounding; exact edge signs then decide each ray, so that the paper's "bound to hit" holds but for
//! rays within that rounding of an edge.

use super::classical;
use super::curved_cast::CurvedCast;
use super::hit::{FirstHits, Hit, is_there, keep_nearer};
use crate::float_environment::{InStandardFloats, StandardFloats};
use crate::geometry::footprint::{Footprint, Frame, Grid};
use crate::geometry::ray_triangle::RayTriangle;
use crate::scene::{Camera, ImageSize, PrimitiveIndex, Raster, Scene};
use rayon::prelude::*;

/// Rows that one task fills.
const BAND_ROWS: usize = 16;

/// Triangles that are prepared at a time.
const CHUNK: usize = 1 << 14;

struct Cast {
    primitive: PrimitiveIndex,
    triangle: RayTriangle,
    footprint: Footprint,
}

/// The largest image at distance 1, from its centre, on which [`pixel_grid`] bounds the rays: their depth
/// is 1 within 2^-22 of their length.
const WIDEST_IMAGE: f64 = 1_048_576.0;

/// First hits by filling a t-buffer.
pub fn first_hits(scene: &Scene, camera: &Camera, size: ImageSize) -> FirstHits {
    let _floats = StandardFloats::new();
    let raster = camera.raster(size);
    // Beyond this a ray's rounding can turn it behind the image plane, where there are no footprints.
    if 1.0 + raster.x0.abs() + raster.y0.abs() > WIDEST_IMAGE {
        return classical::first_hits(scene, camera, size);
    }
    let grid = pixel_grid(&raster, size);
    let [x, y, z] = [camera.right, camera.up, camera.forward].map(|axis| axis.as_dvec3());
    let frame = Frame::perspective(x, y, z);
    let mut items: Vec<Option<Hit>> = vec![None; size.pixels()];
    let mut tests = 0;
    for chunk in chunks(scene) {
        let casts: Vec<Cast> = chunk
            .into_par_iter()
            .in_standard_floats()
            .filter_map(|primitive| {
                let triangle = RayTriangle::new(camera.origin, scene.corners(primitive))?;
                let footprint = Footprint::new(&grid, &frame, triangle.planes())?;
                Some(Cast { primitive, triangle, footprint })
            })
            .collect();
        tests += items
            .par_chunks_mut(BAND_ROWS * size.width as usize)
            .enumerate()
            .in_standard_floats()
            .map(|(band, items)| {
                let first_row = (band * BAND_ROWS) as u32;
                casts
                    .iter()
                    .map(|cast| fill(cast, scene, camera, &raster, &grid, first_row, items))
                    .sum::<u64>()
            })
            .sum::<u64>();
    }
    for chunk in CurvedCast::chunks(scene, camera, &grid, &frame) {
        tests += items
            .par_chunks_mut(BAND_ROWS * size.width as usize)
            .enumerate()
            .in_standard_floats()
            .map(|(band, items)| {
                let first_row = (band * BAND_ROWS) as u32;
                let casts = chunk.iter();
                casts.map(|cast| cast.fill(scene, camera, &raster, &grid, first_row, items)).sum::<u64>()
            })
            .sum::<u64>();
    }
    FirstHits {
        size,
        primitives: items.into_iter().map(|item| item.map(|hit| hit.primitive)).collect(),
        tests,
    }
}

/// Casts one triangle into a band of rows; returns the number of rays tested.
fn fill(
    cast: &Cast,
    scene: &Scene,
    camera: &Camera,
    raster: &Raster,
    grid: &Grid,
    first_row: u32,
    items: &mut [Option<Hit>],
) -> u64 {
    let width = grid.count[0] as usize;
    let end_row = first_row + (items.len() / width) as u32;
    let [top, bottom] = cast.footprint.rows();
    let mut tests = 0;
    for row in top.max(first_row)..(bottom + 1).min(end_row) {
        let Some([left, right]) = cast.footprint.span(grid, row) else { continue };
        tests += u64::from(right - left + 1);
        let line = &mut items[(row - first_row) as usize * width..][..width];
        for column in left..=right {
            let direction = camera.direction(raster, column, row);
            if let Some(t) = cast.triangle.hit(direction)
                && is_there(scene, cast.primitive, &cast.triangle, direction)
            {
                let item = &mut line[column as usize];
                keep_nearer(item, Hit::flat(cast.primitive, t), scene, camera.origin, direction);
            }
        }
    }
    tests
}

/// Pixel centres as boxes that hold the rounded rays: a ray's direction is within 2^-24 of each of its
/// coordinates, which on the image plane moves it by less than 2^-20 of (1 + distance from the centre)^2.
fn pixel_grid(raster: &Raster, size: ImageSize) -> Grid {
    let half = 1.0 + raster.x0.abs() + raster.y0.abs();
    let half = half * half / 1_048_576.0;
    Grid {
        origin: [raster.x0, raster.y0],
        step: [raster.step_x, raster.step_y],
        half: [half; 2],
        count: [size.width, size.height],
    }
}

/// The triangles of all objects, one after the other. The order is of no consequence: a tie is decided by what is
/// hit, and not by when.
fn chunks(scene: &Scene) -> impl Iterator<Item = std::ops::Range<PrimitiveIndex>> {
    let end = scene.triangles.len() as u32;
    (0..end).step_by(CHUNK).map(move |start| start..end.min(start + CHUNK as u32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curved::Shape;
    use crate::geometry::curved::tests as shapes;
    use crate::scene::{ObjectInput, SceneBuilder};
    use glam::Vec3;
    use proptest::prelude::*;

    fn scene(triangles: &[[Vec3; 3]]) -> Scene {
        scene_with(triangles, &[])
    }

    fn scene_with(triangles: &[[Vec3; 3]], shapes: &[Shape]) -> Scene {
        let mut builder = SceneBuilder::new("test");
        for triangle in triangles {
            let input = ObjectInput::new("t", triangle.to_vec(), vec![[0, 1, 2]]);
            builder.add_object(input).unwrap();
        }
        for &shape in shapes {
            let input = ObjectInput { curved: vec![shape], ..ObjectInput::new("s", vec![], vec![]) };
            builder.add_object(input).unwrap();
        }
        builder.finish()
    }

    /// Coordinates on a small grid make shared edges, coplanar faces and triangles behind, beside and
    /// around the camera.
    fn triangle() -> impl Strategy<Value = [Vec3; 3]> {
        let coordinate = || prop_oneof![(-4i32..5).prop_map(|x| x as f32 * 0.5), -3.0f32..3.0];
        prop::array::uniform3(prop::array::uniform3(coordinate()).prop_map(Vec3::from))
    }

    proptest! {
        #[test]
        fn curved_surfaces_are_seen_as_by_classical_ray_tracing(
            triangles in prop::collection::vec(triangle(), 0..3),
            mut shapes in prop::collection::vec(shapes::shape(), 1..6),
            eye in prop::array::uniform3(-3.0f32..3.0),
        ) {
            let camera = Camera::look_at("c", Vec3::from(eye), Vec3::ZERO, Vec3::Y, 70.0);
            let size = ImageSize { width: 37, height: 23 };
            let forward = scene_with(&triangles, &shapes);
            let filled = first_hits(&forward, &camera, size);
            let traced = classical::first_hits(&forward, &camera, size);
            prop_assert_eq!(&filled.primitives, &traced.primitives);
            shapes.reverse();
            let backward = scene_with(&triangles, &shapes);
            let reversed = first_hits(&backward, &camera, size);
            for (one, other) in filled.primitives.iter().zip(&reversed.primitives) {
                prop_assert_eq!(one.map(|p| forward.primitive(p)), other.map(|p| backward.primitive(p)));
            }
        }

        #[test]
        fn equals_classical_ray_tracing_in_any_object_order(
            triangles in prop::collection::vec(triangle(), 1..12),
            eye in prop::array::uniform3(-3.0f32..3.0),
        ) {
            let camera = Camera::look_at("c", Vec3::from(eye), Vec3::ZERO, Vec3::Y, 70.0);
            let size = ImageSize { width: 37, height: 23 };
            let corners = |scene: &Scene, hits: &FirstHits| -> Vec<_> {
                hits.primitives.iter().map(|hit| hit.map(|p| scene.corners(p))).collect()
            };
            let forward = scene(&triangles);
            let filled = first_hits(&forward, &camera, size);
            let traced = classical::first_hits(&forward, &camera, size);
            prop_assert_eq!(&filled.primitives, &traced.primitives);
            prop_assert!(filled.tests <= traced.tests);
            let backward = scene(&triangles.iter().rev().copied().collect::<Vec<_>>());
            let reversed = first_hits(&backward, &camera, size);
            prop_assert_eq!(corners(&forward, &filled), corners(&backward, &reversed));
        }
    }

    #[test]
    fn coplanar_faces_are_drawn_the_same_in_any_object_order() {
        // Overlapping in one plane: every ray that meets both meets them at the same t.
        let low = [Vec3::new(-2.0, 0.0, -2.0), Vec3::new(2.0, 0.0, -2.0), Vec3::new(0.0, 0.0, 2.0)];
        let high = [Vec3::new(-2.0, 0.0, 2.0), Vec3::new(2.0, 0.0, 2.0), Vec3::new(0.0, 0.0, -2.0)];
        let camera = Camera::look_at("c", Vec3::new(0.3, 3.0, 0.7), Vec3::ZERO, Vec3::Z, 70.0);
        let size = ImageSize { width: 32, height: 32 };
        let corners = |triangles: &[[Vec3; 3]]| -> Vec<_> {
            let scene = scene(triangles);
            let hits = first_hits(&scene, &camera, size).primitives;
            hits.into_iter().map(|hit| hit.map(|p| scene.corners(p))).collect()
        };
        let drawn = corners(&[low, high]);
        assert_eq!(drawn, corners(&[high, low]));
        assert!(drawn.contains(&Some(low)) && drawn.contains(&Some(high)) && drawn.contains(&None));
    }
}
