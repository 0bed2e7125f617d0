//! Sierpinski's tetrahedron: each is made of four of half its size.

use super::{NO_SHINE, Viewpoint, studio, surface};
use crate::error::Result;
use crate::scene::Scene;
use crate::scene::procedural::shapes::Mesh;
use crate::scene::procedural::studio::Studio;
use glam::DVec3;

/// Every other corner of a cube.
const CORNERS: [[f64; 3]; 4] = [[-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 1.0]];

pub(in crate::scene::procedural) fn build(size: u32) -> Result<Scene> {
    let view = Viewpoint {
        from: [1.02285, -3.17715, -2.17451],
        at: [-0.004103, -0.004103, 0.216539],
        up: [-0.816497, -0.816497, 0.816497],
    };
    let mut studio = studio("tetra", &view, &[[2.0, -18.0, -5.0]]);
    let material = studio.material(surface("tetrahedron", [1.0, 0.2, 0.2], [1.0, 0.0, NO_SHINE]));
    let mut count = 0;
    divide(&mut studio, material, &mut count, CORNERS.map(DVec3::from), size - 1)?;
    Ok(studio.finish())
}

fn divide(
    studio: &mut Studio,
    material: u32,
    count: &mut u32,
    corners: [DVec3; 4],
    generations: u32,
) -> Result<()> {
    if generations == 0 {
        *count += 1;
        let faces = [[0, 1, 2], [3, 2, 1], [2, 3, 0], [1, 0, 3]];
        let mesh = Mesh::new(corners.to_vec(), faces.map(|face| face.to_vec()).to_vec());
        return studio.add(format!("tetrahedron {count}"), material, mesh);
    }
    for kept in corners {
        divide(studio, material, count, corners.map(|corner| (corner + kept) * 0.5), generations - 1)?;
    }
    Ok(())
}
