//! Mountains in the last light: a field of heights, lit from so low that shadows are long and most segments pass close
//! over the ground.

use super::relief::Relief;
use super::skin::Skin;
use super::{SIZE, studio};
use crate::error::Result;
use crate::scene::Scene;
use crate::scene::procedural::studio::matt;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

const RIDGES: Relief = Relief { frequency: 1.3, octaves: 10, gain: 0.47, seed: 1986 };
const PLAINS: Relief = Relief { frequency: 0.9, octaves: 3, gain: 0.5, seed: 2004 };

/// So many cells along each side, two triangles each.
pub(in crate::scene::procedural) fn build(cells: u32) -> Result<Scene> {
    let mut studio = studio("terrain", [0.5, 0.55, 0.65], [-2.3, 0.66, 1.1]);
    let rock = studio.material(matt("rock", [0.62, 0.54, 0.44]));
    studio.add_input(land(cells).into_object("land", rock))?;
    studio.camera([0.25, 0.95, 1.5], [0.0, 0.0, 0.1], 42.0, SIZE);
    Ok(studio.finish())
}

/// Over the square from -1 to 1.
fn land(cells: u32) -> Skin {
    let row = cells + 1;
    let coordinate = |number: u32| -1.0 + 2.0 * f64::from(number) / f64::from(cells);
    let corner = |i: u32| {
        let place = DVec2::new(coordinate(i % row), coordinate(i / row));
        DVec3::new(place.x, height(place), place.y)
    };
    let points = (0..row * row).into_par_iter().map(corner).collect();
    let cell = |i: u32| {
        let first = i / cells * row + i % cells;
        let [a, b, c, d] = [first, first + row, first + row + 1, first + 1];
        [[a, b, c], [a, c, d]]
    };
    Skin { points, triangles: (0..cells * cells).flat_map(cell).collect() }
}

fn height(place: DVec2) -> f64 {
    let plain = 0.5 + 0.5 * PLAINS.rolling(place + DVec2::splat(3.0));
    0.4 * plain * RIDGES.ridged(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_land_looks_up_and_only_its_border_is_open() {
        let land = land(30);
        assert_eq!(land.open_edges(), 4 * 30);
        for t in &land.triangles {
            let [a, b, c] = t.map(|i| land.points[i as usize]);
            assert!((b - a).cross(c - a).y > 0.0);
        }
    }

    #[test]
    fn finer_land_is_the_same_land() {
        let (coarse, fine) = (land(10), land(20));
        assert_eq!(coarse.points[11 + 1], fine.points[2 * 21 + 2]);
    }
}
