//! Rays that are aimed at what is hard. Each passes within a few ulps of an edge, a corner, a silhouette, a border of
//! cells, a seam of the cube or a tangent of a curved surface, or begins or ends within a few ulps of a triangle.
//!
//! Scenes are small and made anew for every thousand rays, at sizes and places where ulps are fine or coarse. Half
//! of them ask about bare points, the others about what an eye sees there. Random ray after random ray never comes as
//! near to an edge as one of these.

mod scenes;
mod targets;

use super::parts::{bare, seen};
use super::{Expected, Situation};
use crate::random::Random;
use glam::{DVec3, Vec3};
use scenes::Stage;
use targets::Alone;

/// What rays are aimed at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Points of edges that triangles share, or that are the border of a sheet.
    Edges,
    /// Corners of triangles.
    Corners,
    /// Edges of a closed mesh where the light grazes it.
    Silhouettes,
    /// Borders and corners of the cells of a light buffer.
    CellBorders,
    /// Where two or three faces of a light buffer's cube meet.
    CubeSeams,
    /// Lines through the light that touch curved surfaces, and rims.
    Tangents,
    /// Triangles at which segments begin or end.
    Ends,
}

/// Rays of a situation.
const RAYS: u64 = 1000;

/// Each coordinate of a point is moved by at most so many ulps.
const ULPS: i32 = 2;

impl Class {
    /// All of them.
    pub const ALL: [Class; 7] = [
        Class::Edges,
        Class::Corners,
        Class::Silhouettes,
        Class::CellBorders,
        Class::CubeSeams,
        Class::Tangents,
        Class::Ends,
    ];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Class::Edges => "edges",
            Class::Corners => "corners",
            Class::Silhouettes => "silhouettes",
            Class::CellBorders => "cell-borders",
            Class::CubeSeams => "cube-seams",
            Class::Tangents => "tangents",
            Class::Ends => "ends",
        }
    }

    /// About so many rays, a few more or less: points that face away from the light are no queries.
    pub fn situations(self, rays: u64) -> impl Iterator<Item = Situation> {
        (0..rays.div_ceil(RAYS)).map(move |number| self.situation(number))
    }

    fn situation(self, number: u64) -> Situation {
        let mut random = Random::new(number << 3 | self as u64);
        let stage = match self {
            Class::Silhouettes => Stage::ball(&mut random),
            Class::Tangents => Stage::curved(&mut random),
            _ => Stage::any(&mut random),
        };
        let light = match self {
            Class::Ends if number % 4 > 1 => {
                let triangle = random.pick(&stage.triangles);
                nudged(targets::inside(triangle, &mut random), &mut random)
            }
            _ => stage.light(&mut random),
        };
        let resolution = match number % 64 {
            // Fine buffers of large triangles take long to build.
            63 => 1000,
            _ => *random.pick(&[1, 2, 3, 7, 33, 64, 100]),
        };
        let from = light.as_dvec3();
        let points: Vec<Vec3> = self
            .aims(&stage, light, resolution, &mut random)
            .into_iter()
            .map(|aim| {
                // At the target itself, just behind it, or far.
                let behind = *random.pick(&[1.0, 1.0 + 1e-6, 1.25, 2.0, 4.0]);
                nudged(from + (aim - from) * behind, &mut random)
            })
            .filter(|point| point.is_finite())
            .collect();
        let points = match number % 2 {
            0 => bare(points),
            _ => seen(&stage.scene, stage.eye(&mut random), points),
        };
        let name = format!("{} {number}", self.name());
        Situation::new(name, stage.scene, light, points, Expected::AsTruth).at_resolution(resolution)
    }

    fn aims(self, stage: &Stage, light: Vec3, resolution: u32, random: &mut Random) -> Vec<DVec3> {
        let aim: Box<dyn Fn(&mut Random) -> DVec3> = match self {
            Class::Edges => {
                let edges = targets::edges(&stage.triangles);
                Box::new(move |random| targets::on_an_edge(*random.pick(&edges), random))
            }
            Class::Silhouettes => {
                let edges = targets::silhouettes(&stage.triangles, light);
                if edges.is_empty() {
                    return Vec::new();
                }
                Box::new(move |random| targets::on_an_edge(*random.pick(&edges), random))
            }
            Class::Corners => {
                let corners = stage.triangles.as_flattened();
                Box::new(|random| random.pick(corners).as_dvec3())
            }
            Class::Ends => Box::new(|random| targets::inside(random.pick(&stage.triangles), random)),
            Class::CellBorders => Box::new(|random| {
                targets::along(light, targets::border_direction(resolution, random), stage, random)
            }),
            Class::CubeSeams => {
                Box::new(|random| targets::along(light, targets::seam_direction(random), stage, random))
            }
            Class::Tangents => {
                let alone: Vec<Alone> = stage.shapes.iter().filter_map(Alone::new).collect();
                let shapes: Vec<_> = alone.iter().map(|shape| (shape, shape.hierarchy())).collect();
                return (0..RAYS)
                    .filter_map(|_| {
                        let (shape, hierarchy) = random.pick(&shapes);
                        shape.tangent(hierarchy, light, random)
                    })
                    .collect();
            }
        };
        (0..RAYS).map(|_| aim(random)).collect()
    }
}

/// The nearest point in f32, or one a few ulps beside it.
pub(super) fn nudged(point: DVec3, random: &mut Random) -> Vec3 {
    let move_by_ulps = |value: f32| {
        let ulps = (random.unit() * f64::from(2 * ULPS + 1)) as i32 - ULPS;
        (0..ulps.abs()).fold(value, |value, _| if ulps > 0 { value.next_up() } else { value.next_down() })
    };
    Vec3::from_array(point.as_vec3().to_array().map(move_by_ulps))
}
