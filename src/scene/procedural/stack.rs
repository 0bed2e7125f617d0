//! Figures 12 to 17 of the t-buffer paper (Raghuvanshi and Dhande 2004): so many objects of one kind, "stacked on
//! top of each other so that they fill the viewport as much as possible", smaller the more they are.
//!
//! Where each of them is placed is not given. Here the viewport is cut into as many cells as there are objects, in
//! rows of as equal counts as can be, and each object is made so large that it covers its cell. Neighbours lie at
//! different depths, on the rays through their cells and scaled with their distance, so that they look as if they
//! were side by side and hide parts of each other. With spheres in two layers it is the face-centred stack of cannon
//! balls, seen along an axis of the cube: diagonal neighbours of a layer touch, and so do those of both layers.

use super::shapes::Body;
use super::studio::{Studio, glossy};
use crate::error::Result;
use crate::geometry::curved::Shape;
use crate::random::Random;
use crate::scene::{ImageSize, ObjectInput, Scene};
use glam::{DVec2, DVec3};

/// Three rows for every four columns.
const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

/// The viewport is so high where the nearest layer is, and the camera so far from there.
const HEIGHT: f64 = 6.0;
const DISTANCE: f64 = 12.0;

const COLOURS: [[f32; 3]; 6] = [
    [0.72, 0.16, 0.12],
    [0.85, 0.6, 0.16],
    [0.22, 0.5, 0.24],
    [0.14, 0.34, 0.62],
    [0.46, 0.24, 0.52],
    [0.7, 0.68, 0.62],
];

pub(super) fn spheres(count: u32) -> Result<Scene> {
    stack("stacked-spheres", count, |cell, _, material, studio| {
        let layer = (cell.row + cell.column) % 2;
        let far = scale(f64::from(layer) * cell.size.min_element());
        let centre = far * cell.on_screen(DVec2::ZERO);
        let radius = far * 0.5 * cell.size.length();
        studio.add(cell.name("sphere"), material, Body::from(Shape::sphere(centre.as_vec3(), radius as f32)))
    })
}

pub(super) fn triangles(count: u32) -> Result<Scene> {
    stack("stacked-triangles", count, |cell, random, material, studio| {
        // Twice as wide and high as its cell, a triangle covers it and parts of those beside and above.
        let layer = cell.row % 2 * 2 + cell.column % 2;
        let mut corner = |x: f64, y: f64| {
            let depth = (f64::from(layer) + 0.4 * random.signed()) * 0.6 * cell.size.min_element();
            scale(depth) * cell.on_screen(DVec2::new(x, y))
        };
        let corners = [corner(-1.0, -0.5), corner(1.0, -0.5), corner(0.0, 1.5)];
        let input =
            ObjectInput::new(cell.name("triangle"), corners.map(|p| p.as_vec3()).to_vec(), vec![[0, 1, 2]]);
        studio.add_input(ObjectInput { material, ..input })
    })
}

/// A part of the viewport.
struct Cell {
    number: u32,
    row: u32,
    column: u32,
    /// Its centre, from that of the viewport.
    centre: DVec2,
    /// Width and height.
    size: DVec2,
}

impl Cell {
    /// A point on the nearest layer, seen from the camera, so many widths and heights from the cell's centre.
    fn on_screen(&self, from_centre: DVec2) -> DVec3 {
        (self.centre + from_centre * self.size).extend(-DISTANCE)
    }

    fn name(&self, kind: &str) -> String {
        format!("{kind} {}", self.number + 1)
    }
}

/// How much larger something is that looks the same so far behind the nearest layer.
fn scale(behind: f64) -> f64 {
    1.0 + behind / DISTANCE
}

/// The camera is at the origin and looks along -z.
fn stack(
    name: &str,
    count: u32,
    mut add: impl FnMut(&Cell, &mut Random, u32, &mut Studio) -> Result<()>,
) -> Result<Scene> {
    let mut studio = Studio::new(name);
    let materials = COLOURS.map(|colour| studio.material(glossy("paint", colour, 0.25, 30.0)));
    let mut random = Random::new(2004);
    for cell in cells(count) {
        let material = materials[(random.unit() * COLOURS.len() as f64) as usize];
        add(&cell, &mut random, material, &mut studio)?;
    }
    studio.lamp("lamp", [-4.5, 5.0, -2.0], [1.0, 0.97, 0.92]);
    let degrees = 2.0 * libm::atan(0.5 * HEIGHT / DISTANCE).to_degrees();
    studio.camera([0.0; 3], [0.0, 0.0, -1.0], degrees, SIZE);
    Ok(studio.finish())
}

/// Rows from the top, of cells that are as square as their number allows.
fn cells(count: u32) -> impl Iterator<Item = Cell> {
    let width = HEIGHT * f64::from(SIZE.width) / f64::from(SIZE.height);
    let rows = ((f64::from(count) * HEIGHT / width).sqrt().round() as u32).clamp(1, count);
    let first = move |row: u32| (u64::from(row) * u64::from(count) / u64::from(rows)) as u32;
    (0..rows).flat_map(move |row| {
        let columns = first(row + 1) - first(row);
        let size = DVec2::new(width / f64::from(columns), HEIGHT / f64::from(rows));
        (0..columns).map(move |column| Cell {
            number: first(row) + column,
            row,
            column,
            centre: DVec2::new(
                (f64::from(column) + 0.5) * size.x - 0.5 * width,
                0.5 * HEIGHT - (f64::from(row) + 0.5) * size.y,
            ),
            size,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::visibility::{VisibleSurfaces, t_buffer};

    const SMALL: ImageSize = ImageSize { width: 64, height: 48 };

    #[test]
    fn cells_tile_the_viewport() {
        for count in [1, 2, 3, 7, 50, 997, 6000] {
            let cells: Vec<Cell> = cells(count).collect();
            assert!(cells.iter().map(|cell| cell.number).eq(0..count));
            let area: f64 = cells.iter().map(|cell| cell.size.x * cell.size.y).sum();
            assert!((area - HEIGHT * HEIGHT * 4.0 / 3.0).abs() < 1e-6, "{count}: {area}");
        }
    }

    #[test]
    fn the_viewport_is_filled_with_all_objects_in_view() {
        for (build, kind) in [(spheres as fn(u32) -> Result<Scene>, "sphere"), (triangles, "triangle")] {
            for count in [1, 2, 3, 10, 50, 333, 6000] {
                let scene = build(count).unwrap();
                let what = format!("{count} {kind}s");
                assert_eq!(scene.objects.len(), count as usize, "{what}");
                assert_eq!(scene.primitive_count(), count, "{what}");
                let camera = &scene.cameras[0];
                // A pixel for each of the many.
                let size = if count > 1000 { ImageSize { width: 320, height: 240 } } else { SMALL };
                let hits = t_buffer::first_hits(&scene, camera, size);
                let mut seen: Vec<u32> = hits.primitives.iter().flatten().copied().collect();
                assert!(
                    seen.len() * 100 >= size.pixels() * 99,
                    "{what}: {} of {}",
                    seen.len(),
                    size.pixels()
                );
                seen.sort_unstable();
                seen.dedup();
                // A triangle in the farthest layer may look out by less than a pixel.
                assert!(seen.len() * 1000 >= count as usize * 999, "{what}: {} are seen", seen.len());
            }
        }
    }

    #[test]
    fn a_good_part_is_lit_and_a_good_part_is_in_shadow() {
        use crate::shadow::{BuildInput, Queries, SceneIndex, ShadowTester, find};
        for build in [spheres as fn(u32) -> Result<Scene>, triangles] {
            for count in [50, 500] {
                let scene = build(count).unwrap();
                let hits = t_buffer::first_hits(&scene, &scene.cameras[0], SMALL);
                let visible = VisibleSurfaces::new(&scene, &scene.cameras[0], &hits);
                let light = &scene.lights[0];
                let queries = Queries::new(&scene, &visible, light);
                let index = SceneIndex::new(&scene);
                let input = BuildInput::new(&scene, &index, light.position());
                let tester: Box<dyn ShadowTester> = (find("light-buffer").unwrap().build)(&input).unwrap();
                let mut occluded = vec![false; queries.points.len()];
                tester.occluded(&queries.points, &mut occluded).unwrap();
                let shadowed = occluded.iter().filter(|&&o| o).count() as f64 / SMALL.pixels() as f64;
                let lit = occluded.iter().filter(|&&o| !o).count() as f64 / SMALL.pixels() as f64;
                assert!(lit > 0.4 && shadowed > 0.03, "{} {lit} {shadowed}", scene.name);
            }
        }
    }
}
