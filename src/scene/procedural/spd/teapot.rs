//! Newell's teapot on a chequered ground: 32 bicubic patches, each cut into size by size cells of two
//! triangles, and size by size squares.

mod patches;

use self::patches::{Patch, patches};
use super::{studio, surface, upright};
use crate::error::Result;
use crate::scene::{ObjectInput, Scene, SmoothNormals};
use glam::{DVec3, Vec3};

pub(in crate::scene::procedural) fn build(size: u32) -> Result<Scene> {
    let view = upright([4.86, 7.2, 5.4], [0.0; 3]);
    let mut studio = studio("teapot", &view, &[[-3.1, 9.8, 12.1], [11.3, 5.1, 8.8]]);
    for (name, grey, odd) in [("light squares", 1.0, 1), ("dark squares", 0.5, 0)] {
        let material = studio.material(surface(name, [grey; 3], [0.5, 0.5, 4.81884]));
        studio.add_input(ObjectInput { material, ..squares(name, size, odd) })?;
    }
    let copper = studio.material(surface("teapot", [1.0, 0.5, 0.1], [0.75, 0.25, 3.0827]));
    for (name, patches) in patches() {
        let mut part = Part::default();
        patches.iter().for_each(|patch| part.add(patch, size));
        studio.add_input(part.object(name, copper))?;
    }
    Ok(studio.finish())
}

/// Every other square of the ground.
fn squares(name: &str, size: u32, odd: u32) -> ObjectInput {
    let edge = |number: u32| (-4.0 + 8.0 * f64::from(number) / f64::from(size)) as f32;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (x, y) in (0..size).flat_map(|x| (0..size).map(move |y| (x, y))) {
        if (x + y) % 2 == odd {
            let base = positions.len() as u32;
            for (x, y) in [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)] {
                positions.push(Vec3::new(edge(x), edge(y), 0.0));
            }
            triangles.extend([[0, 1, 2], [0, 2, 3]].map(|triangle| triangle.map(|corner| base + corner)));
        }
    }
    let polygons = Some(triangles.len() as u32 / 2);
    ObjectInput { polygons, ..ObjectInput::new(name, positions, triangles) }
}

/// A part of the teapot in the making.
#[derive(Default)]
struct Part {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Part {
    fn add(&mut self, patch: &Patch, size: u32) {
        let base = self.positions.len() as u32;
        for row in 0..=size {
            for column in 0..=size {
                let (point, normal) =
                    patch.at(f64::from(row) / f64::from(size), f64::from(column) / f64::from(size));
                self.positions.push(point.as_vec3());
                self.normals.push(normal.as_vec3());
            }
        }
        let corner = |row: u32, column: u32| base + row * (size + 1) + column;
        for row in 0..size {
            for column in 0..size {
                let (near, far) = (corner(row, column), corner(row + 1, column + 1));
                for triangle in [[near, corner(row, column + 1), far], [far, corner(row + 1, column), near]] {
                    // Where a patch comes to a point, one of the two is nothing.
                    let [a, b, c] = triangle.map(|index| self.positions[index as usize]);
                    if a != b && b != c && c != a {
                        self.triangles.push(triangle);
                    }
                }
            }
        }
    }

    fn object(self, name: &str, material: u32) -> ObjectInput {
        let normals = Some(SmoothNormals { normals: self.normals, corners: self.triangles.clone() });
        ObjectInput { material, normals, ..ObjectInput::new(name, self.positions, self.triangles) }
    }
}

/// Weights of the four points of a cubic, and of their differences.
fn bernstein(t: f64) -> ([f64; 4], [f64; 4]) {
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    let slopes = [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t];
    (weights, slopes)
}

impl Patch {
    /// The point and a unit normal at (u, v), u along the rows.
    fn at(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let sum = |row: &[f64; 4], column: &[f64; 4]| -> DVec3 {
            (0..16).map(|i| self.points[i / 4][i % 4] * (row[i / 4] * column[i % 4])).sum()
        };
        let ((row, row_slope), (column, column_slope)) = (bernstein(u), bernstein(v));
        let point = sum(&row, &column);
        let normal = sum(&row, &column_slope).cross(sum(&row_slope, &column));
        // At a point where all columns meet the surface is level: lid and bottom.
        (point, normal.try_normalize().unwrap_or(DVec3::Z))
    }
}
